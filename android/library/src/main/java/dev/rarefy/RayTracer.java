// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy;

import java.nio.ByteBuffer;
import java.nio.ByteOrder;
import java.nio.ReadOnlyBufferException;
import java.util.ArrayList;
import java.util.List;
import java.util.Objects;
import org.jspecify.annotations.Nullable;

/**
 * A scene on a device, ready to draw frames.
 *
 * <pre>{@code
 * try (RayTracer tracer = RayTracer.open(SceneSource.builtin("spheres"))) {
 *   ByteBuffer pixels = RayTracer.allocate(640, 480);
 *   FrameStats stats = tracer.render(RenderOptions.ofSize(640, 480), pixels);
 * }
 * }</pre>
 *
 * <p>Threads: every method may be called from any thread, but for what a listener may not do. Calls
 * that load, draw or read a layer wait for each other; {@link #cancel}, {@link #close}, {@link
 * #stats} and those for camera and lights do not. Opening and drawing take long: keep them off the
 * main thread.
 *
 * <p>Errors: {@link RayTracerException} for whatever goes wrong; {@link IllegalStateException}
 * after {@link #close}; {@link Error} for a defect of the library, after which this tracer must be
 * closed. None of them ends the process.
 */
public final class RayTracer implements AutoCloseable {
  /** Native code refuses more than 32; this many do no harm on their way to it. */
  private static final int MOST_LIGHTS_SENT = 1000;

  private final long handle;
  private final LeakNet.Entry leakNet;
  private volatile @Nullable ProgressListener progressListener;
  private volatile @Nullable PreviewListener previewListener;
  private volatile @Nullable FrameStats stats;

  private RayTracer(long handle) {
    this.handle = handle;
    leakNet = LeakNet.add(this, handle);
  }

  /** The version of the native library, such as {@code 0.1.0}. */
  public static String version() {
    return Native.version();
  }

  /** As {@link #open(SceneSource, OpenOptions)}, on the best device there is. */
  public static RayTracer open(SceneSource scene) {
    return open(scene, OpenOptions.defaults());
  }

  /**
   * Loads a scene, prepares it, and puts it on a device. At a driver's first use this compiles
   * kernels, which takes seconds; give a {@link OpenOptions.Builder#cacheFolder} to do so once.
   *
   * @throws RayTracerException for a scene that cannot be read or a device that cannot be had
   */
  public static RayTracer open(SceneSource scene, OpenOptions options) {
    Objects.requireNonNull(scene, "scene");
    Objects.requireNonNull(options, "options");
    RayTracer tracer = new RayTracer(Native.create());
    Cancellation cancellation = options.cancellation();
    boolean opened = false;
    try {
      if (cancellation == null) {
        scene.load(tracer.handle, options.settings(), options.progress());
      } else {
        ProgressListener progress = options.progress();
        cancellation.watch(tracer.handle);
        // One that was cancelled before the work began is noticed by its first step.
        scene.load(
            tracer.handle,
            options.settings(),
            (phase, share) -> {
              if (cancellation.isCancelled()) {
                cancellation.cancel();
              } else if (progress != null) {
                progress.onProgress(phase, share);
              }
            });
      }
      opened = true;
      return tracer;
    } finally {
      if (cancellation != null) {
        cancellation.watch(0);
      }
      if (!opened) {
        tracer.close();
      }
    }
  }

  /** A buffer that {@link #render(RenderOptions, ByteBuffer)} takes, for a picture of this size. */
  public static ByteBuffer allocate(int width, int height) {
    if (width < 1 || height < 1) {
      throw new IllegalArgumentException("a picture of " + width + "x" + height + " pixels");
    }
    long pixels = (long) width * height;
    if (pixels > Integer.MAX_VALUE / 4) {
      throw new IllegalArgumentException(
          width + "x" + height + " pixels take more than a ByteBuffer holds");
    }
    return ByteBuffer.allocateDirect((int) pixels * 4).order(ByteOrder.nativeOrder());
  }

  /**
   * Draws a frame into memory: four bytes a pixel (red, green, blue, alpha 255; sRGB), rows from
   * the top without gaps, from the buffer's position on. Position and limit stay. No thread may use
   * the buffer's memory meanwhile.
   *
   * @param options how; its size must be set
   * @param pixels a direct buffer with four bytes left for every pixel, see {@link #allocate}
   * @return what it cost
   * @throws RayTracerException if it cannot be drawn
   * @throws IllegalArgumentException for a buffer that is too small or not direct
   */
  public FrameStats render(RenderOptions options, ByteBuffer pixels) {
    if (pixels.isReadOnly()) {
      throw new ReadOnlyBufferException();
    }
    if (!pixels.isDirect()) {
      throw new IllegalArgumentException(
          "the ByteBuffer must be direct: RayTracer.allocate makes one");
    }
    // A slice has the capacity that is left, so that native code cannot write beyond the limit.
    ByteBuffer rest = pixels.slice();
    FrameStats drawn =
        Native.renderBuffer(handle, options.settings(), rest, 0, progressListener, previewListener);
    stats = drawn;
    return drawn;
  }

  /**
   * Draws a frame into a Bitmap or onto a Surface. No one else may use that meanwhile.
   *
   * @param options how; without a size the picture has the target's
   * @param target {@link BitmapTarget} or {@link SurfaceTarget}
   * @return what it cost
   * @throws RayTracerException if it cannot be drawn, or the target is lost
   */
  public FrameStats render(RenderOptions options, RenderTarget target) {
    FrameStats drawn = target.render(handle, options.settings(), progressListener, previewListener);
    stats = drawn;
    return drawn;
  }

  /** What the last frame cost; null before the first one. */
  public @Nullable FrameStats stats() {
    return stats;
  }

  /**
   * A picture of what the last frame knew or did, a pixel a sample. Waits for a frame that is being
   * drawn.
   *
   * @param layer one that the frame kept: {@link RenderOptions.Builder#keepLayer}
   * @throws RayTracerException of code {@code MISSING_LAYER} if it did not
   */
  public Picture layer(Layer layer) {
    return Native.layer(handle, layer.nativeName);
  }

  /** The camera that the next frame is drawn from. */
  public Camera getCamera() {
    return Camera.ofNumbers(Native.camera(handle));
  }

  /**
   * Moves the camera for the frames that begin from now on.
   *
   * @throws RayTracerException for one that cannot be drawn from; the old one then stays
   */
  public void setCamera(Camera camera) {
    Native.setCamera(handle, camera.numbers());
  }

  /** The lights of the next frame. A copy. */
  public List<Light> getLights() {
    float[] numbers = Native.lights(handle);
    List<Light> lights = new ArrayList<>();
    for (int at = 0; at < numbers.length; at += 6) {
      lights.add(
          new Light(
              numbers[at],
              numbers[at + 1],
              numbers[at + 2],
              numbers[at + 3],
              numbers[at + 4],
              numbers[at + 5]));
    }
    return lights;
  }

  /**
   * Changes the lights for the frames that begin from now on.
   *
   * @param lights at most 32
   * @throws RayTracerException for lights that cannot be; the old ones then stay
   */
  public void setLights(List<Light> lights) {
    if (lights.size() > MOST_LIGHTS_SENT) {
      throw new IllegalArgumentException(lights.size() + " lights, of which there may be 32");
    }
    float[] numbers = new float[lights.size() * 6];
    int at = 0;
    for (Light light : lights) {
      System.arraycopy(light.numbers(), 0, numbers, at, 6);
      at += 6;
    }
    Native.setLights(handle, numbers);
  }

  /** Who hears how far the next frames are; null for nobody. */
  public void setProgressListener(@Nullable ProgressListener listener) {
    progressListener = listener;
  }

  /** Who sees the next frames in low resolution first; null for nobody, which is faster. */
  public void setPreviewListener(@Nullable PreviewListener listener) {
    previewListener = listener;
  }

  /** Who draws. Waits for a frame that is being drawn. */
  public DeviceInfo deviceInfo() {
    return Native.deviceInfo(handle);
  }

  /**
   * Ends every call of this tracer that has begun, within some milliseconds, with a {@link
   * RayTracerException} of code {@code CANCELLED}. What is called afterwards is not affected; nor
   * is what the last frame kept.
   */
  public void cancel() {
    Native.cancel(handle);
  }

  /**
   * Cancels what this tracer does, waits for its end, and frees all that it has. May be called
   * again, and while another thread draws; within a listener it does not wait.
   */
  @Override
  public void close() {
    leakNet.remove();
    Native.close(handle);
  }
}
