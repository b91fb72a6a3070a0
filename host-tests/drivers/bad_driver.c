// SPDX-License-Identifier: MIT OR Apache-2.0
// An OpenCL library with a fault: what it does not define itself, the system's OpenCL library does, which it is linked with.
// host-tests/tests/bad_drivers.rs builds it and names the fault in the variable BAD_DRIVER; docs/drivers.md says which
// report each of them is.
//
// Whatever the fault: a launch without work-items ends the process, and BAD_DRIVER_LOG names a file that gets a line for
// each program that is built.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef int32_t cl_int;
typedef uint32_t cl_uint;
typedef uint64_t cl_device_type;

enum {
  CL_SUCCESS = 0,
  CL_DEVICE_TYPE_GPU = 4,
  CL_DEVICE_TYPE = 0x1000,
  CL_PLATFORM_VERSION = 0x0901,
  CL_DEVICE_NAME = 0x102B,
  CL_DEVICE_VENDOR = 0x102C,
  CL_DRIVER_VERSION = 0x102D,
  CL_DEVICE_VERSION = 0x102F,
  CL_DEVICE_EXTENSIONS = 0x1030,
  CL_DEVICE_HALF_FP_CONFIG = 0x1033,
  CL_DEVICE_PRINTF_BUFFER_SIZE = 0x1049,
  CL_DEVICE_PREFERRED_LOCAL_ATOMIC_ALIGNMENT = 0x105A,
  CL_PROGRAM_SOURCE = 0x1164,
  CL_PROGRAM_BINARIES = 0x1166,
  CL_KERNEL_FUNCTION_NAME = 0x1190,
  CL_INVALID_VALUE = -30,
};

static int fault(const char *name) {
  const char *set = getenv("BAD_DRIVER");
  return set && !strcmp(set, name);
}

static void *real(const char *name) {
  static void *library;
  if (!library) library = dlopen("libOpenCL.so.1", RTLD_NOW | RTLD_LOCAL);
  void *function = library ? dlsym(library, name) : 0;
  if (!function) {
    fprintf(stderr, "bad_driver: the system's library has no %s\n", name);
    _Exit(99);
  }
  return function;
}

static void note(const char *line) {
  const char *path = getenv("BAD_DRIVER_LOG");
  FILE *file = path ? fopen(path, "a") : 0;
  if (!file) return;
  fprintf(file, "%s\n", line);
  fclose(file);
}

static cl_int answer(const char *text, size_t size, void *value, size_t *size_ret) {
  size_t length = strlen(text) + 1;
  if (size_ret) *size_ret = length;
  if (!value) return 0;
  if (size < length) return CL_INVALID_VALUE;
  memcpy(value, text, length);
  return 0;
}

cl_int clGetPlatformIDs(cl_uint count, void **platforms, cl_uint *found) {
  if (fault("dies-when-asked")) abort();
  cl_int (*call)(cl_uint, void **, cl_uint *) = real("clGetPlatformIDs");
  return call(count, platforms, found);
}

cl_int clGetPlatformInfo(void *platform, cl_uint name, size_t size, void *value, size_t *size_ret) {
  if (name == CL_PLATFORM_VERSION && (fault("newer-platform-2.0") || fault("newer-platform-1.2")))
    return answer("OpenCL 3.0 QUALCOMM build: 0", size, value, size_ret);
  cl_int (*call)(void *, cl_uint, size_t, void *, size_t *) = real("clGetPlatformInfo");
  return call(platform, name, size, value, size_ret);
}

cl_int clGetDeviceInfo(void *device, cl_uint name, size_t size, void *value, size_t *size_ret) {
  int is_20 = fault("newer-platform-2.0"), is_12 = fault("newer-platform-1.2");
  if (is_20 || is_12) {
    if (name == CL_DEVICE_VERSION)
      return answer(is_20 ? "OpenCL 2.0 Adreno(TM) 640" : "OpenCL 1.2 Adreno(TM) 420", size, value, size_ret);
    if (name == CL_DEVICE_EXTENSIONS) return answer("cl_khr_byte_addressable_store", size, value, size_ret);
    cl_uint last = is_20 ? CL_DEVICE_PREFERRED_LOCAL_ATOMIC_ALIGNMENT : CL_DEVICE_PRINTF_BUFFER_SIZE;
    if (name == CL_DEVICE_HALF_FP_CONFIG || (name > last && name < 0x2000)) {
      fprintf(stderr, "bad_driver: asked for %#x\n", name);
      abort();
    }
  }
  if (fault("only-qualcomm")) {
    if (name == CL_DEVICE_NAME || name == CL_DEVICE_VENDOR) return answer("QUALCOMM ", size, value, size_ret);
  }
  // A phone's device is a GPU.
  if (name == CL_DEVICE_TYPE) {
    if (size_ret) *size_ret = sizeof(cl_device_type);
    if (value && size < sizeof(cl_device_type)) return CL_INVALID_VALUE;
    if (value) *(cl_device_type *)value = CL_DEVICE_TYPE_GPU;
    return CL_SUCCESS;
  }
  const char *driver = getenv("BAD_DRIVER_VERSION");
  if (name == CL_DRIVER_VERSION && driver) return answer(driver, size, value, size_ret);
  cl_int (*call)(void *, cl_uint, size_t, void *, size_t *) = real("clGetDeviceInfo");
  return call(device, name, size, value, size_ret);
}

void *clCreateProgramWithSource(void *context, cl_uint count, const char **texts, const size_t *lengths, cl_int *error) {
  void *(*call)(void *, cl_uint, const char **, const size_t *, cl_int *) = real("clCreateProgramWithSource");
  if (!fault("wrong-when-optimised") || count != 1) return call(context, count, texts, lengths, error);
  // Every sqrt(x) becomes bad_sqrt(x), which an option of the build makes wrong.
  const char head[] =
      "#ifdef BAD_DRIVER\n#define bad_sqrt(x) (sqrt(x) * 1.25f)\n#else\n#define bad_sqrt(x) sqrt(x)\n#endif\n";
  size_t length = lengths && lengths[0] ? lengths[0] : strlen(texts[0]);
  const char *from = texts[0], *end = from + length;
  char *text = malloc(sizeof head + 2 * length), *to = text;
  if (!text) abort();
  to = stpcpy(to, head);
  while (from < end) {
    int is_call = end - from > 5 && !strncmp(from, "sqrt(", 5);
    if (is_call && (from == texts[0] || !strchr("_abcdefghijklmnopqrstuvwxyz", from[-1]))) to = stpcpy(to, "bad_");
    *to++ = *from++;
  }
  const char *all = text;
  size_t changed = (size_t)(to - text);
  void *program = call(context, 1, &all, &changed, error);
  free(text);
  return program;
}

// The source of a program, to be freed; null if it was made of a binary.
static char *source_of(void *program) {
  cl_int (*info)(void *, cl_uint, size_t, void *, size_t *) = real("clGetProgramInfo");
  size_t size = 0;
  if (info(program, CL_PROGRAM_SOURCE, 0, 0, &size) || size < 2) return 0;
  char *source = malloc(size);
  if (!source || info(program, CL_PROGRAM_SOURCE, size, source, 0)) abort();
  return source;
}

// Whether the fault is of programs that hold the text BAD_DRIVER_PROGRAM; without the variable, of all.
static int is_meant(void *program) {
  const char *wanted = getenv("BAD_DRIVER_PROGRAM");
  char *source = wanted ? source_of(program) : 0;
  int meant = !wanted || (source && strstr(source, wanted));
  free(source);
  return meant;
}

cl_int clBuildProgram(void *program, cl_uint count, void *const *devices, const char *options,
                      void (*done)(void *, void *), void *user) {
  cl_int (*call)(void *, cl_uint, void *const *, const char *, void (*)(void *, void *), void *) = real("clBuildProgram");
  int careful = strstr(options, "-cl-opt-disable") != 0;
  char *source = source_of(program);
  note(!source ? "binary" : careful ? "careful build" : "build");
  free(source);
  if (is_meant(program)) {
    if (fault("compiler-aborts")) abort();
    if (fault("compiler-exits")) exit(7);
    if (fault("never-builds")) return -11;
    if (fault("builds-without-optimisation") && !careful) return -11;
    if (fault("out-of-host-memory") && !careful) return -6;
  }
  if (fault("wrong-when-optimised") && !careful) {
    char more[4096];
    if (snprintf(more, sizeof more, "%s -D BAD_DRIVER", options) >= (int)sizeof more) abort();
    return call(program, count, devices, more, done, user);
  }
  return call(program, count, devices, options, done, user);
}

// Programs whose kernels exist: the newest few.
static void *with_kernels[256];
static unsigned programs_with_kernels;

cl_int clCreateKernelsInProgram(void *program, cl_uint count, void **kernels, cl_uint *found) {
  cl_int (*call)(void *, cl_uint, void **, cl_uint *) = real("clCreateKernelsInProgram");
  if (fault("late-compiler-aborts") && kernels && is_meant(program)) abort();
  if (fault("late-compiler-fails") && kernels && is_meant(program)) return -6;
  if (kernels) with_kernels[programs_with_kernels++ % 256] = program;
  return call(program, count, kernels, found);
}

void *clCreateKernel(void *program, const char *name, cl_int *error) {
  void *(*call)(void *, const char *, cl_int *) = real("clCreateKernel");
  with_kernels[programs_with_kernels++ % 256] = program;
  return call(program, name, error);
}

cl_int clGetProgramInfo(void *program, cl_uint name, size_t size, void *value, size_t *size_ret) {
  cl_int (*call)(void *, cl_uint, size_t, void *, size_t *) = real("clGetProgramInfo");
  cl_int status = call(program, name, size, value, size_ret);
  if (status || name != CL_PROGRAM_BINARIES || !value || !fault("late-compiler")) return status;
  for (unsigned i = 0; i < 256; i++)
    if (with_kernels[i] == program) return status;
  // Nothing is compiled yet: a binary of no use.
  memset(*(unsigned char **)value, 'x', 16);
  return status;
}

cl_int clEnqueueNDRangeKernel(void *queue, void *kernel, cl_uint dimensions, const size_t *offset, const size_t *global,
                              const size_t *local, cl_uint waits, const void *wait, void **event) {
  for (cl_uint i = 0; i < dimensions; i++) {
    if (!global[i]) {
      fprintf(stderr, "bad_driver: a launch without work-items\n");
      abort();
    }
  }
  const char *wanted = getenv("BAD_DRIVER_KERNEL");
  if (wanted && fault("kernel-aborts")) {
    char name[64] = "";
    cl_int (*info)(void *, cl_uint, size_t, void *, size_t *) = real("clGetKernelInfo");
    if (!info(kernel, CL_KERNEL_FUNCTION_NAME, sizeof name - 1, name, 0) && !strcmp(name, wanted)) abort();
  }
  cl_int (*call)(void *, void *, cl_uint, const size_t *, const size_t *, const size_t *, cl_uint, const void *, void **) =
      real("clEnqueueNDRangeKernel");
  return call(queue, kernel, dimensions, offset, global, local, waits, wait, event);
}
