// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy;

import java.io.ByteArrayOutputStream;
import java.io.FileNotFoundException;
import java.io.IOException;
import java.io.InputStream;
import java.nio.ByteBuffer;
import org.jspecify.annotations.Nullable;

/**
 * The native methods of Rarefy, implemented in {@code android/jni}.
 *
 * <p>The library is loaded with this class. By default that is {@code librarefy_jni.so} from the
 * app (or from {@code java.library.path}); where the system property {@code dev.rarefy.library} is
 * set, it is the file of that absolute path, which is how tests on a desktop load the one they
 * built. A library that cannot be loaded, or that does not fit these classes, gives an {@link
 * UnsatisfiedLinkError} that says why.
 *
 * <p>Every native method reports what went wrong as an exception and a defect of the library itself
 * as {@link Error}. The process survives either. A handle that was closed, or that never was one,
 * gives {@link IllegalStateException}.
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

  /** A handle of a new tracer, in which nothing is loaded. */
  static native long create();

  /** Cancels what the tracer does, waits for it, and frees all that it has. May be repeated. */
  static native void close(long handle);

  /** Frees a tracer that nobody uses any more; waits for nothing. May be repeated. */
  static native void release(long handle);

  /** How many handles are open. */
  static native int openCount();

  static native void cancel(long handle);

  static native void loadFiles(
      long handle, String path, String[] device, @Nullable ProgressListener progress);

  static native void loadBuiltin(
      long handle, String name, String[] device, @Nullable ProgressListener progress);

  static native void loadAssets(
      long handle,
      AssetReader reader,
      String name,
      String[] device,
      @Nullable ProgressListener progress);

  /** A baked scene; a length of -1 is the whole file. */
  static native void loadBaked(
      long handle,
      String path,
      long offset,
      long length,
      String[] device,
      @Nullable ProgressListener progress);

  static native void loadBakedDescriptor(
      long handle,
      int descriptor,
      long offset,
      long length,
      String[] device,
      @Nullable ProgressListener progress);

  static native FrameStats renderBuffer(
      long handle,
      String[] frame,
      ByteBuffer buffer,
      int offset,
      @Nullable ProgressListener progress,
      @Nullable PreviewListener preview);

  static native FrameStats renderBitmap(
      long handle,
      String[] frame,
      Object bitmap,
      @Nullable ProgressListener progress,
      @Nullable PreviewListener preview);

  static native FrameStats renderSurface(
      long handle,
      String[] frame,
      Object surface,
      @Nullable ProgressListener progress,
      @Nullable PreviewListener preview);

  static native Picture layer(long handle, String name);

  static native float[] camera(long handle);

  static native void setCamera(long handle, float[] camera);

  static native float[] lights(long handle);

  static native void setLights(long handle, float[] lights);

  static native DeviceInfo deviceInfo(long handle);

  static native OpenClReport openclReport(String[] device);

  /** The bytes of a file, or null if there is none of that name. Called by native code. */
  static byte @Nullable [] readAsset(AssetReader reader, String name) throws IOException {
    try (InputStream stream = reader.open(name)) {
      if (stream == null) {
        return null;
      }
      ByteArrayOutputStream bytes = new ByteArrayOutputStream(Math.max(stream.available(), 4096));
      byte[] part = new byte[65536];
      for (int read = stream.read(part); read >= 0; read = stream.read(part)) {
        bytes.write(part, 0, read);
      }
      return bytes.toByteArray();
    } catch (FileNotFoundException e) {
      return null;
    }
  }
}
