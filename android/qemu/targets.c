// SPDX-License-Identifier: MIT OR Apache-2.0
// Stand-ins for libjnigraphics and libandroid over the Java classes of android/library/src/fake, so that the shipped file draws
// into a Bitmap and a Surface. They count locks in fields of those classes, and fail when the fields say so.

extern void *malloc(unsigned long size);
extern void free(void *memory);

// JNI's functions by their numbers in its specification.
static void *function(void *env, int number) { return (*(void ***)env)[number]; }

static void *field(void *env, void *object, const char *name, const char *type) {
    void *class = ((void *(*)(void *, void *))function(env, 31))(env, object);
    return ((void *(*)(void *, void *, const char *, const char *))function(env, 94))(env, class, name, type);
}

static int get(void *env, void *object, const char *name) {
    return ((int (*)(void *, void *, void *))function(env, 100))(env, object, field(env, object, name, "I"));
}

static void set(void *env, void *object, const char *name, int value) {
    ((void (*)(void *, void *, void *, int))function(env, 109))(env, object, field(env, object, name, "I"), value);
}

static void *memory(void *env, void *object) {
    void *id = field(env, object, "memory", "Ljava/nio/ByteBuffer;");
    void *buffer = ((void *(*)(void *, void *, void *))function(env, 95))(env, object, id);
    return ((void *(*)(void *, void *))function(env, 230))(env, buffer);
}

struct bitmap_info {
    unsigned width, height, stride;
    int format;
    unsigned flags;
};

int AndroidBitmap_getInfo(void *env, void *bitmap, struct bitmap_info *info) {
    info->width = (unsigned)get(env, bitmap, "width");
    info->height = (unsigned)get(env, bitmap, "height");
    info->stride = (unsigned)get(env, bitmap, "strideBytes");
    info->format = get(env, bitmap, "nativeFormat");
    info->flags = 0;
    return 0;
}

int AndroidBitmap_lockPixels(void *env, void *bitmap, void **address) {
    if (get(env, bitmap, "failLock"))
        return -1;
    set(env, bitmap, "locks", get(env, bitmap, "locks") + 1);
    *address = memory(env, bitmap);
    return 0;
}

int AndroidBitmap_unlockPixels(void *env, void *bitmap) {
    set(env, bitmap, "unlocks", get(env, bitmap, "unlocks") + 1);
    return get(env, bitmap, "failUnlock") ? -3 : 0;
}

struct window {
    void *env;
    void *surface;
    int count;
};

struct window_buffer {
    int width, height, stride, format;
    void *bits;
    unsigned reserved[6];
};

struct window *ANativeWindow_fromSurface(void *env, void *surface) {
    struct window *window;
    if (get(env, surface, "released"))
        return 0;
    window = malloc(sizeof *window);
    window->env = env;
    window->surface = ((void *(*)(void *, void *))function(env, 21))(env, surface);
    window->count = 1;
    set(env, surface, "held", get(env, surface, "held") + 1);
    return window;
}

void ANativeWindow_acquire(struct window *window) { window->count++; }

void ANativeWindow_release(struct window *window) {
    if (--window->count)
        return;
    set(window->env, window->surface, "held", get(window->env, window->surface, "held") - 1);
    ((void (*)(void *, void *))function(window->env, 22))(window->env, window->surface);
    free(window);
}

int ANativeWindow_getWidth(struct window *window) { return get(window->env, window->surface, "width"); }
int ANativeWindow_getHeight(struct window *window) { return get(window->env, window->surface, "height"); }
int ANativeWindow_getFormat(struct window *window) { return get(window->env, window->surface, "format"); }

int ANativeWindow_setBuffersGeometry(struct window *window, int width, int height, int format) {
    if (get(window->env, window->surface, "released"))
        return -19;
    set(window->env, window->surface, "bufferWidth", width);
    set(window->env, window->surface, "bufferHeight", height);
    set(window->env, window->surface, "format", format);
    return 0;
}

int ANativeWindow_lock(struct window *window, struct window_buffer *buffer, void *bounds) {
    void *env = window->env, *surface = window->surface;
    (void)bounds;
    if (get(env, surface, "released") || get(env, surface, "failLock"))
        return -22;
    set(env, surface, "locks", get(env, surface, "locks") + 1);
    buffer->width = get(env, surface, "bufferWidth") + get(env, surface, "otherWidth");
    buffer->height = get(env, surface, "bufferHeight");
    // As on phones: a width of 1080 has a stride of 1088.
    buffer->stride = (buffer->width + 15) / 16 * 16;
    buffer->format = get(env, surface, "format");
    buffer->bits = memory(env, surface);
    return 0;
}

int ANativeWindow_unlockAndPost(struct window *window) {
    set(window->env, window->surface, "posts", get(window->env, window->surface, "posts") + 1);
    return get(window->env, window->surface, "failPost") ? -19 : 0;
}
