// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy;

/**
 * The native methods of Rarefy, implemented in {@code android/jni}.
 *
 * <p>The library is loaded with this class. By default that is {@code librarefy_jni.so} from the app (or from
 * {@code java.library.path}); where the system property {@code dev.rarefy.library} is set, it is the file of that
 * absolute path, which is how tests on a desktop load the one they built. A library that cannot be loaded, or that
 * does not fit this class, gives an {@link UnsatisfiedLinkError} that says why.
 *
 * <p>Every native method reports an error as {@link IllegalStateException} and a defect of the library itself as
 * {@link Error}; both carry the full text. The process survives either.
 */
final class Native {
    static {
        String file = System.getProperty("dev.rarefy.library");
        if (file != null) {
            System.load(file);
        } else {
            System.loadLibrary("rarefy_jni");
        }
    }

    private Native() {}

    /** The version of the native library, such as {@code 0.1.0}. */
    static native String version();
}
