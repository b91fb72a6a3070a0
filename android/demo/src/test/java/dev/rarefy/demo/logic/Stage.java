// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo.logic;

import dev.rarefy.Camera;
import dev.rarefy.Cancellation;
import dev.rarefy.OpenOptions;
import dev.rarefy.ProgressListener;
import dev.rarefy.RayTracer;
import dev.rarefy.RenderOptions;
import java.nio.ByteBuffer;
import java.util.ArrayList;
import java.util.Arrays;
import java.util.HashMap;
import java.util.List;
import java.util.Map;
import org.jspecify.annotations.Nullable;

/** What the tests of the loop share: a screen that remembers, and pictures to compare with. */
final class Stage implements AutoCloseable {
  static final SceneChoice SPHERES = SceneChoice.fromText("BUILTIN spheres");
  static final SceneChoice RODS = SceneChoice.fromText("BUILTIN rods");
  static final SceneChoice WALL = SceneChoice.fromText("BUILTIN wall");
  static final int WIDTH = 80;
  static final int HEIGHT = 60;

  final Shows screen = new Shows();
  final RenderLoop loop;

  private static final Map<SceneChoice, RayTracer> REFERENCES = new HashMap<>();

  Stage(SceneChoice scene, Settings settings) {
    this(Stage::open, scene, settings, null, 0);
  }

  Stage(
      Opener opener,
      SceneChoice scene,
      Settings settings,
      @Nullable Camera camera,
      long idleMillis) {
    loop = new RenderLoop(opener, scene, settings, camera, idleMillis);
  }

  /** Opens on the CPU, whatever else there is. */
  static RayTracer open(
      SceneChoice scene,
      boolean retryCrashed,
      ProgressListener progress,
      Cancellation cancellation) {
    OpenOptions options =
        OpenOptions.builder()
            .device("cpu")
            .retryCrashed(retryCrashed)
            .progress(progress)
            .cancellation(cancellation)
            .build();
    return RayTracer.open(
        scene.source(
            name -> {
              throw new java.io.FileNotFoundException(name);
            }),
        options);
  }

  /** In front of the user. */
  void begin() {
    loop.setScreen(screen, WIDTH, HEIGHT);
    loop.resume();
  }

  State done() throws Exception {
    try {
      Check.until("done", () -> loop.state().phase() == State.Phase.DONE);
    } catch (AssertionError e) {
      State state = loop.state();
      throw new AssertionError(state.phase() + ", " + state.failure() + ", " + loop.task, e);
    }
    return loop.state();
  }

  Failure failed() throws Exception {
    Check.until("failed", () -> loop.state().phase() == State.Phase.FAILED);
    Failure failure = loop.state().failure();
    Check.that(failure != null, "a failure says what it is");
    return failure;
  }

  /** What is on the screen is what other tracers draw of this scene, settings and camera. */
  void shows(SceneChoice scene, Settings settings, Camera camera, int width, int height) {
    Shown last = screen.last();
    Check.equal(width + "x" + height, last.width + "x" + last.height);
    FrameInfo frame = loop.state().frame();
    boolean full = frame != null && frame.stats().isFellBack();
    if (full && settings.shown().layer() != null) {
      // Whether a frame is drawn in full, and so has nothing in its layers, depends on those
      // before.
      return;
    }
    byte[] wanted = reference(scene, settings, camera, width, height, full);
    Check.that(Arrays.equals(wanted, last.bytes), "another picture of " + scene + ", " + settings);
  }

  private static RayTracer referenceTracer(SceneChoice scene) {
    RayTracer tracer = REFERENCES.get(scene);
    if (tracer == null) {
      tracer = open(scene, false, (phase, share) -> {}, new Cancellation());
      REFERENCES.put(scene, tracer);
    }
    return tracer;
  }

  static void closeReferences() {
    for (RayTracer tracer : REFERENCES.values()) {
      tracer.close();
    }
    REFERENCES.clear();
  }

  private static byte[] reference(
      SceneChoice scene,
      Settings settings,
      Camera camera,
      int width,
      int height,
      boolean fellBack) {
    RayTracer tracer = referenceTracer(scene);
    tracer.setCamera(camera);
    byte[] full = bytes(tracer, settings, width, height, true);
    // Other options, so that nothing of frames before makes this one full.
    tracer.render(RenderOptions.builder().size(1, 1).build(), RayTracer.allocate(1, 1));
    byte[] adaptive = fellBack ? full.clone() : bytes(tracer, settings, width, height, false);
    if (settings.mode() == Settings.Mode.FULL
        && settings.shown() == dev.rarefy.demo.logic.Shown.PICTURE) {
      return full;
    }
    byte[] right = adaptive;
    dev.rarefy.Layer layer = settings.shown().layer();
    if (layer != null) {
      tracer.render(RenderOptions.builder().size(1, 1).build(), RayTracer.allocate(1, 1));
      tracer.render(
          settings.options(width, height, false).toBuilder().keepLayer(layer).build(),
          RayTracer.allocate(width, height));
      int[] argb = tracer.layer(layer).getArgb();
      int samples = settings.samples();
      for (int at = 0; at < width * height; at++) {
        int x = at % width * samples;
        int y = at / width * samples;
        int pixel = argb[y * width * samples + x];
        right[4 * at] = (byte) (pixel >> 16);
        right[4 * at + 1] = (byte) (pixel >> 8);
        right[4 * at + 2] = (byte) pixel;
        right[4 * at + 3] = (byte) 255;
      }
    } else if (settings.shown() == dev.rarefy.demo.logic.Shown.DIFFERENCE) {
      for (int at = 0; at < right.length; at++) {
        int apart = Math.abs((full[at] & 255) - (right[at] & 255));
        right[at] = (byte) (at % 4 == 3 ? 255 : Math.min(255, 10 * apart));
      }
    }
    if (settings.mode() == Settings.Mode.SPLIT) {
      int column = Math.round(settings.divider() * width);
      for (int at = 0; at < width * height; at++) {
        if (at % width < column) {
          System.arraycopy(full, 4 * at, right, 4 * at, 4);
        }
      }
    }
    return right;
  }

  private static byte[] bytes(
      RayTracer tracer, Settings settings, int width, int height, boolean full) {
    ByteBuffer pixels = RayTracer.allocate(width, height);
    tracer.render(settings.options(width, height, full), pixels);
    byte[] bytes = new byte[pixels.remaining()];
    pixels.get(bytes);
    return bytes;
  }

  @Override
  public void close() throws Exception {
    loop.quit();
    loop.join();
  }

  /** A picture that was shown. */
  static final class Shown {
    final int width;
    final int height;
    final byte[] bytes;

    Shown(int width, int height, byte[] bytes) {
      this.width = width;
      this.height = height;
      this.bytes = bytes;
    }
  }

  /** A screen that remembers all, and that can have faults. */
  static final class Shows implements Screen {
    private final List<Shown> all = new ArrayList<>();
    private boolean lost;

    /** Wider pictures do not fit into memory. */
    volatile int most = Integer.MAX_VALUE;

    volatile boolean broken;

    /** What happens while the next picture is on its way. */
    @Nullable Runnable meanwhile;

    @Override
    public synchronized void show(ByteBuffer rgba, int width, int height) {
      if (width > most) {
        throw new OutOfMemoryError("no Bitmap of " + width);
      }
      if (broken) {
        throw new IllegalStateException("broken screen");
      }
      if (lost) {
        return;
      }
      byte[] bytes = new byte[width * height * 4];
      rgba.duplicate().get(bytes);
      all.add(new Shown(width, height, bytes));
      Runnable event = meanwhile;
      meanwhile = null;
      if (event != null) {
        event.run();
      }
    }

    /** As {@code surfaceDestroyed}: afterwards nothing arrives. */
    synchronized void lost(boolean lost) {
      this.lost = lost;
    }

    synchronized int count() {
      return all.size();
    }

    synchronized Shown at(int at) {
      return all.get(at);
    }

    synchronized Shown last() {
      Check.that(!all.isEmpty(), "something is shown");
      return all.get(all.size() - 1);
    }

    synchronized void forget() {
      all.clear();
    }
  }
}
