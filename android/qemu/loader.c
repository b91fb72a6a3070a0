// SPDX-License-Identifier: MIT OR Apache-2.0
// A JNI library that hands its JNI_OnLoad on to the file that a variable names. The file is opened so that its own
// libraries, the stand-ins for Android's, win over those of the Java VM.

extern void *dlopen(const char *file, int flags);
extern void *dlsym(void *handle, const char *name);
extern char *dlerror(void);
extern char *getenv(const char *name);
extern int puts(const char *text);

__attribute__((visibility("default"))) int JNI_OnLoad(void *vm, void *reserved) {
    const char *file = getenv(VARIABLE);
    void *library = file ? dlopen(file, 2 | 8) : 0; // RTLD_NOW | RTLD_DEEPBIND
    if (!library) {
        puts(file ? dlerror() : "the variable " VARIABLE " names no file");
        return -1;
    }
    int (*load)(void *, void *) = (int (*)(void *, void *))dlsym(library, "JNI_OnLoad");
    return load ? load(vm, reserved) : -1;
}
