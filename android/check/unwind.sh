# SPDX-License-Identifier: MIT OR Apache-2.0
# shellcheck shell=bash
# The unwinder, linked statically as an NDK does: LLVM's libunwind, from the source that the `ziglang` package on PyPI
# carries, with the musl headers beside it. Sourced by android/check.sh.

ziglang=0.17.1

musl() { case $1 in arm64-v8a) echo aarch64-linux-musl ;; armeabi-v7a) echo arm-linux-musl ;; x86_64) echo x86_64-linux-musl ;; esac; }

# Fetches the source once.
fetch_unwinder() {
    local tools=$work/tools wheel
    [ ! -d "$tools/zig-$ziglang/ziglang" ] || return 0
    need_packages "the unwinder's source" python3 python3-pip || fail "the unwinder's source needs python3 and pip"
    mkdir -p "$tools"
    python3 -m pip download --quiet --no-deps --disable-pip-version-check "ziglang==$ziglang" -d "$tools"
    wheel=$(ls "$tools"/ziglang-$ziglang-*.whl)
    rm -rf "$tools/zig.part"
    python3 - "$wheel" "$tools/zig.part" <<'PY'
import sys, zipfile
wheel, folder = sys.argv[1:]
parts = ["lib/libunwind/"] + ["lib/libc/include/%s/" % name for name in
         ("generic-musl", "aarch64-linux-musl", "arm-linux-musl", "x86_64-linux-musl")]
with zipfile.ZipFile(wheel) as archive:
    archive.extractall(folder, [n for n in archive.namelist() if any(p in n for p in parts)])
PY
    rm "$wheel"
    mv "$tools/zig.part" "$tools/zig-$ziglang"
}

make_unwinder() { # ABI FOLDER: libunwind.a
    local abi=$1 folder=$2 lib=$work/tools/zig-$ziglang/ziglang/lib source flags
    local include=$lib/libc/include
    [ ! -f "$folder/libunwind.a" ] || return 0
    mkdir -p "$folder/shim"
    # Nothing may be asked of `stderr`, a symbol since API 23 only; and a lock as large as bionic's largest.
    cat >"$folder/shim/stdio.h" <<'EOT'
#pragma once
#define stderr ((void *)0)
static inline int fprintf(void *file, const char *format, ...) { (void)file; (void)format; return 0; }
static inline int fflush(void *file) { (void)file; return 0; }
static inline int snprintf(char *text, unsigned long size, const char *format, ...) { (void)format; if (size) *text = 0; return 0; }
EOT
    cat >"$folder/shim/pthread.h" <<'EOT'
#pragma once
typedef struct { long words[64 / sizeof(long)]; } pthread_rwlock_t;
#define PTHREAD_RWLOCK_INITIALIZER {{0}}
#ifdef __cplusplus
extern "C" {
#endif
int pthread_rwlock_rdlock(pthread_rwlock_t *);
int pthread_rwlock_wrlock(pthread_rwlock_t *);
int pthread_rwlock_unlock(pthread_rwlock_t *);
#ifdef __cplusplus
}
#endif
EOT
    flags=(--target="$(clang_target "$abi")" -O2 -fPIC -fvisibility=hidden -D_LIBUNWIND_HIDE_SYMBOLS -DNDEBUG
        -D_LIBUNWIND_IS_NATIVE_ONLY -D_LIBUNWIND_USE_DLADDR=0 -D__errno_location=__errno -funwind-tables -nostdlibinc -w "-I$folder/shim"
        "-I$lib/libunwind/include" "-I$lib/libunwind/src" -isystem "$include/$(musl "$abi")" -isystem "$include/generic-musl")
    for source in libunwind.cpp Unwind-EHABI.cpp UnwindLevel1.c UnwindLevel1-gcc-ext.c UnwindRegistersSave.S UnwindRegistersRestore.S; do
        case $source in
        *.cpp) clang++ "${flags[@]}" -std=c++17 -fno-exceptions -fno-rtti -c "$lib/libunwind/src/$source" -o "$folder/$source.o" ;;
        *.c) clang "${flags[@]}" -fexceptions -c "$lib/libunwind/src/$source" -o "$folder/$source.o" ;;
        *.S) clang "${flags[@]}" -c "$lib/libunwind/src/$source" -o "$folder/$source.o" ;;
        esac
    done
    llvm-ar rcs "$folder/libunwind.a" "$folder"/*.o
}
