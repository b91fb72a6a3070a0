// SPDX-License-Identifier: MIT OR Apache-2.0
// What Android's libc and libdl are called or shaped like, on top of glibc: just as much as librarefy_jni.so asks for, to run
// that file in a Java VM of its ABI under qemu. It stands for bionic; it does not test bionic.

typedef unsigned long size_t;

extern int *__errno_location(void);
extern void *dlsym(void *handle, const char *name);
extern int __xpg_strerror_r(int code, char *text, size_t size);

// The next one after this library: glibc's.
#define NEXT(name) dlsym((void *)-1L, name)

int *__errno(void) { return __errno_location(); }

// No system properties: their value is empty.
int __system_property_get(const char *name, char *value) {
    (void)name;
    *value = 0;
    return 0;
}

// POSIX's version, which bionic has under this name, and not GNU's.
int strerror_r(int code, char *text, size_t size) { return __xpg_strerror_r(code, text, size); }

// Bionic numbers the questions differently: page size, and processors configured and online.
long sysconf(int question) {
    long (*real)(int) = (long (*)(int))NEXT("sysconf");
    switch (question) {
    case 0x27:
    case 0x28: return real(30);
    case 0x60: return real(83);
    case 0x61: return real(84);
    default: *__errno_location() = 22; return -1;
    }
}

// Bionic's attributes are smaller than glibc's, so that glibc may not write to them: they hold the stack's size here, and
// nothing else is ever asked for.
struct attributes {
    size_t stack_size;
};

int pthread_attr_init(struct attributes *attributes) {
    attributes->stack_size = 0;
    return 0;
}

int pthread_attr_destroy(struct attributes *attributes) {
    (void)attributes;
    return 0;
}

int pthread_attr_setstacksize(struct attributes *attributes, size_t size) {
    attributes->stack_size = size;
    return 0;
}

int pthread_create(void *thread, struct attributes *attributes, void *(*start)(void *), void *argument) {
    int (*create)(void *, void *, void *(*)(void *), void *) = (int (*)(void *, void *, void *(*)(void *), void *))NEXT("pthread_create");
    int (*init)(void *) = (int (*)(void *))NEXT("pthread_attr_init");
    int (*set_size)(void *, size_t) = (int (*)(void *, size_t))NEXT("pthread_attr_setstacksize");
    long real[16] = {0};
    init(real);
    if (attributes && attributes->stack_size)
        set_size(real, attributes->stack_size);
    return create(thread, real, start, argument);
}

#ifdef __arm__
// Bionic's structures of 32-bit systems are glibc's for large files.
int stat(const char *path, void *to) { return ((int (*)(const char *, void *))NEXT("stat64"))(path, to); }
int lstat(const char *path, void *to) { return ((int (*)(const char *, void *))NEXT("lstat64"))(path, to); }
int fstat(int file, void *to) { return ((int (*)(int, void *))NEXT("fstat64"))(file, to); }
int fstatat(int folder, const char *path, void *to, int flags) {
    return ((int (*)(int, const char *, void *, int))NEXT("fstatat64"))(folder, path, to, flags);
}
void *readdir(void *folder) { return ((void *(*)(void *))NEXT("readdir64"))(folder); }
#endif
