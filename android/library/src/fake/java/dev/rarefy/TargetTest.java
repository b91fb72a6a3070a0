// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy;

import android.graphics.Bitmap;
import android.view.Surface;
import java.nio.ByteBuffer;
import org.jspecify.annotations.Nullable;

/** The shipped library draws into a Bitmap and onto a Surface, both fakes. */
final class TargetTest {
  private static final int RGBA_8888 = 1;
  private static final int RGBX_8888 = 2;
  private static final int RGB_565 = 4;

  private TargetTest() {}

  public static void main(String[] arguments) {
    try (RayTracer tracer = Check.cpu("spheres")) {
      bitmaps(tracer);
      surfaces(tracer);
      wide();
      lostSurfaces(tracer);
    }
    Check.equal(0, Native.openCount());
    System.out.println("done");
  }

  /** Compares memory with a picture: pixels, what is beyond them in a row, and what lies behind. */
  private static void shows(
      ByteBuffer memory, byte[] wanted, int width, int height, int strideBytes, boolean small) {
    int bytes = small ? 2 : 4;
    for (int y = 0; y < height; y++) {
      for (int x = 0; x < width; x++) {
        int at = y * strideBytes + x * bytes;
        int from = 4 * (y * width + x);
        if (small) {
          int word = (memory.get(at) & 255) | (memory.get(at + 1) & 255) << 8;
          Check.equal(Math.round((wanted[from] & 255) * 31 / 255f), word >> 11);
          Check.equal(Math.round((wanted[from + 1] & 255) * 63 / 255f), word >> 5 & 63);
          Check.equal(Math.round((wanted[from + 2] & 255) * 31 / 255f), word & 31);
        } else {
          for (int channel = 0; channel < 4; channel++) {
            Check.equal(wanted[from + channel], memory.get(at + channel));
          }
        }
      }
      for (int at = width * bytes; y + 1 < height && at < strideBytes; at++) {
        Check.equal((byte) 0xa5, memory.get(y * strideBytes + at));
      }
    }
    Check.equal((byte) 0xa5, memory.get((height - 1) * strideBytes + width * bytes));
  }

  private static void bitmaps(RayTracer tracer) {
    byte[] wanted = Check.draw(tracer, RenderOptions.defaults(), 40, 30);
    Bitmap.Config[] configs = {Bitmap.Config.ARGB_8888, Bitmap.Config.RGB_565};
    for (Bitmap.Config config : configs) {
      boolean small = config == Bitmap.Config.RGB_565;
      Bitmap bitmap = new Bitmap(40, 30, 192, config);
      FrameStats stats = tracer.render(RenderOptions.defaults(), BitmapTarget.of(bitmap));
      Check.equal(40, stats.getWidth());
      Check.equal(30, stats.getHeight());
      shows(bitmap.memory, wanted, 40, 30, 192, small);
      Check.that(bitmap.locks == 1 && bitmap.unlocks == 1 && bitmap.prepared == 1, "locks");
      bitmap.failUnlock = 1;
      tracer.render(RenderOptions.defaults(), BitmapTarget.of(bitmap));
      bitmap.failLock = 1;
      Check.coded(
          RayTracerException.Code.TARGET_LOST,
          "locked",
          () -> tracer.render(RenderOptions.defaults(), BitmapTarget.of(bitmap)));
      Check.that(bitmap.locks == 2 && bitmap.unlocks == 2, "locks");
    }
    Bitmap gray = new Bitmap(8, 8, 8, Bitmap.Config.ALPHA_8);
    Check.thrown(IllegalArgumentException.class, () -> BitmapTarget.of(gray));
    Bitmap other = new Bitmap(8, 8, 32, Bitmap.Config.ARGB_8888);
    other.nativeFormat = 8;
    Check.coded(
        RayTracerException.Code.TARGET_LOST,
        "RGB_565",
        () -> tracer.render(RenderOptions.defaults(), BitmapTarget.of(other)));
    other.mutable = false;
    Check.thrown(IllegalArgumentException.class, () -> BitmapTarget.of(other));
    other.recycled = true;
    Check.thrown(IllegalArgumentException.class, () -> BitmapTarget.of(other));
    Check.thrown(NullPointerException.class, () -> BitmapTarget.of(null));
    Check.thrown(
        NullPointerException.class, () -> Native.renderBitmap(0, new String[0], null, null, null));
    // A picture that is smaller than its Bitmap lies in the upper left, and the rest is black.
    Bitmap larger = new Bitmap(44, 30, 44 * 4, Bitmap.Config.ARGB_8888);
    tracer.render(RenderOptions.ofSize(40, 30), BitmapTarget.of(larger));
    Check.equal(wanted[4 * 40 * 29], larger.memory.get(4 * 44 * 29));
    Check.equal((byte) 0, larger.memory.get(4 * 43));
    Check.equal((byte) 255, larger.memory.get(4 * 43 + 3));
  }

  private static void surfaces(RayTracer tracer) {
    byte[] wanted = Check.draw(tracer, RenderOptions.defaults(), 40, 30);
    for (int format : new int[] {RGBA_8888, RGBX_8888, RGB_565}) {
      Surface surface = new Surface(40, 30, format);
      for (int round = 1; round <= 2; round++) {
        tracer.render(RenderOptions.defaults(), SurfaceTarget.of(surface));
        int bytes = format == RGB_565 ? 2 : 4;
        shows(surface.memory, wanted, 40, 30, 48 * bytes, format == RGB_565);
        Check.that(surface.locks == round && surface.posts == round && surface.held == 0, "locks");
      }
      Check.equal(format, surface.format);
    }
    // A format that is none of ours is changed, and a size that is not the Surface's is scaled.
    Surface odd = new Surface(80, 60, 22);
    tracer.render(RenderOptions.ofSize(40, 30), SurfaceTarget.of(odd));
    Check.that(odd.format == RGBA_8888 && odd.bufferWidth == 40 && odd.bufferHeight == 30, "size");
    shows(odd.memory, wanted, 40, 30, 48 * 4, false);
    // A buffer of another size than was asked for, as while a Surface is being resized.
    Surface resized = new Surface(40, 30, RGBA_8888);
    resized.otherWidth = 3;
    tracer.render(RenderOptions.defaults(), SurfaceTarget.of(resized));
    Check.equal(wanted[4 * 40 * 29], resized.memory.get(4 * 48 * 29));
    Check.equal((byte) 0, resized.memory.get(4 * 42));
    resized.otherWidth = -8;
    tracer.render(RenderOptions.defaults(), SurfaceTarget.of(resized));
    Check.equal(wanted[4 * 40 * 29], resized.memory.get(4 * 32 * 29));
  }

  /** The stride that is well known: 1088 for 1080 pixels. */
  private static void wide() {
    try (RayTracer tracer = Check.cpu("wall")) {
      byte[] wanted = Check.draw(tracer, RenderOptions.defaults(), 1080, 8);
      Surface surface = new Surface(1080, 8, RGBA_8888);
      tracer.render(RenderOptions.defaults(), SurfaceTarget.of(surface));
      shows(surface.memory, wanted, 1080, 8, 1088 * 4, false);
    }
  }

  private static void lost(RayTracer tracer, Surface surface, @Nullable Runnable during) {
    tracer.setProgressListener(
        (phase, share) -> {
          if (during != null) {
            during.run();
          }
        });
    Check.coded(
        RayTracerException.Code.TARGET_LOST,
        "Surface",
        () -> tracer.render(RenderOptions.defaults(), SurfaceTarget.of(surface)));
    tracer.setProgressListener(null);
    Check.that(surface.locks == surface.posts && surface.held == 0, "locks");
  }

  private static void lostSurfaces(RayTracer tracer) {
    Surface surface = new Surface(40, 30, RGBA_8888);
    surface.failLock = 1;
    lost(tracer, surface, null);
    surface.failLock = 0;
    // Lost while its frame is drawn.
    lost(tracer, surface, () -> surface.released = 1);
    // Lost before.
    lost(tracer, surface, null);
    Check.thrown(NullPointerException.class, () -> SurfaceTarget.of(null));
    Check.thrown(
        NullPointerException.class, () -> Native.renderSurface(0, new String[0], null, null, null));
    // Lost while its picture is shown: nothing to be seen any more, and no harm.
    Surface late = new Surface(40, 30, RGBA_8888);
    late.failPost = 1;
    tracer.render(RenderOptions.defaults(), SurfaceTarget.of(late));
    // The tracer is as it was: the next Surface gets its picture.
    Surface next = new Surface(40, 30, RGBA_8888);
    tracer.render(RenderOptions.defaults(), SurfaceTarget.of(next));
    byte[] wanted = Check.draw(tracer, RenderOptions.defaults(), 40, 30);
    shows(next.memory, wanted, 40, 30, 48 * 4, false);
  }
}
