// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo.logic;

import dev.rarefy.Camera;
import dev.rarefy.Cancellation;
import dev.rarefy.DeviceInfo;
import dev.rarefy.RayTracer;
import dev.rarefy.RayTracerException;
import dev.rarefy.RayTracerException.Code;
import java.util.Objects;
import org.jspecify.annotations.Nullable;

/**
 * Opens scenes and draws frames on a thread of its own. Its methods may be called from any thread,
 * and wait for nothing; what is wanted last wins. Nothing that goes wrong comes out of it but as a
 * {@link State}.
 *
 * <p>While a finger moves, frames are coarse and come to their end, so that the picture moves. A
 * refined frame, or one that measures, is cancelled as soon as it is not wanted any more.
 */
public final class RenderLoop extends Schedule {
  private final Opener opener;
  private final long idleMillis;
  private final Thread thread;

  /** Used by the loop's thread alone. */
  private final Frames frames = new Frames();

  /**
   * A loop that rests until it has a {@link #setScreen} and a {@link #resume}.
   *
   * @param camera from which to look; null for the scene's own
   * @param idleMillis how long a frame stands before it is measured
   */
  public RenderLoop(
      Opener opener,
      SceneChoice scene,
      Settings settings,
      @Nullable Camera camera,
      long idleMillis) {
    super(scene, settings, camera);
    this.opener = opener;
    this.idleMillis = idleMillis;
    thread = new Thread(this::work, "rarefy-demo");
    thread.start();
  }

  /** Waits for the end after {@link #quit}. */
  void join() throws InterruptedException {
    thread.join();
  }

  private void work() {
    boolean going = true;
    while (going) {
      Task next;
      synchronized (lock) {
        next = next();
        task = next;
      }
      going = perform(next);
      synchronized (lock) {
        task = null;
      }
      tell();
    }
  }

  /** With the lock: waits for something to do. */
  private Task next() {
    while (true) {
      long wait = 0;
      Task found = find();
      if (found == Task.MEASURE) {
        wait = idleMillis - (System.nanoTime() - doneNanos) / 1_000_000;
        if (wait <= 0) {
          return found;
        }
      } else if (found != null) {
        return found;
      }
      try {
        lock.wait(Math.max(0, wait));
      } catch (InterruptedException e) {
        // Nobody interrupts this thread for a reason of ours; it goes on.
      }
    }
  }

  /** Whether the loop goes on. */
  private boolean perform(Task now) {
    try {
      switch (now) {
        case OPEN:
          open();
          break;
        case CLOSE:
          closeTracer();
          break;
        case COARSE:
          draw(false);
          break;
        case REFINED:
          draw(true);
          break;
        case COMPOSE:
          show();
          break;
        case MEASURE:
          measure();
          break;
        case BENCHMARK:
          measurePlan();
          break;
        case QUIT:
          closeTracer();
          return false;
      }
    } catch (RayTracerException e) {
      failed(now, e);
    } catch (OutOfMemoryError e) {
      outOfMemory(e);
    } catch (RuntimeException | Error e) {
      // Of a defect the user hears as of everything else; the tracer is not to be used any more.
      fail(Failure.of(Failure.Kind.DEFECT, e));
      closeTracer();
    }
    return true;
  }

  private void failed(Task now, RayTracerException e) {
    if (e.getCode() == Code.CANCELLED) {
      return;
    } else if (e.getCode() == Code.OUT_OF_MEMORY || e.getCode() == Code.LIMIT_EXCEEDED) {
      if (now == Task.COARSE || now == Task.REFINED || now == Task.MEASURE) {
        outOfMemory(e);
        return;
      }
    }
    if (now == Task.BENCHMARK) {
      synchronized (lock) {
        plan = null;
      }
      fail(Failure.of(Failure.Kind.BENCHMARK, e));
    } else {
      fail(Failure.of(now == Task.OPEN ? Failure.Kind.OPENING : Failure.Kind.DRAWING, e));
    }
  }

  /** Goes on with smaller frames, as long as there are any. */
  private void outOfMemory(Throwable e) {
    frames.free();
    synchronized (lock) {
      plan = null;
      info = null;
      wanted++;
      if (resolution.shrink()) {
        return;
      }
    }
    fail(Failure.of(Failure.Kind.MEMORY, e));
  }

  private void fail(Failure why) {
    synchronized (lock) {
      failure = why;
    }
  }

  private void closeTracer() {
    RayTracer old;
    synchronized (lock) {
      close = false;
      old = tracer;
      tracer = null;
      openScene = null;
      device = null;
      info = null;
      wanted++;
    }
    frames.free();
    if (old != null) {
      try {
        old.close();
      } catch (RuntimeException | Error e) {
        fail(Failure.of(Failure.Kind.DEFECT, e));
      }
    }
  }

  private void open() {
    closeTracer();
    SceneChoice wantedScene;
    boolean crashed;
    Cancellation cancellation = new Cancellation();
    synchronized (lock) {
      wantedScene = scene;
      crashed = retryCrashed;
      retryCrashed = false;
      opening = cancellation;
      start = null;
      progress = 0;
      if (quit || close) {
        return;
      }
    }
    tell();
    RayTracer opened = null;
    try {
      opened = opener.open(wantedScene, crashed, (phase, share) -> progressed(share), cancellation);
      opened.setProgressListener((phase, share) -> cancelStale());
      DeviceInfo who = opened.deviceInfo();
      Camera its = opened.getCamera();
      synchronized (lock) {
        if (!wantedScene.equals(scene)) {
          // Too late to be cancelled; its camera must not be taken for that of the other scene.
          return;
        }
        tracer = opened;
        opened = null;
        openScene = wantedScene;
        device = who;
        start = its;
        if (camera == null) {
          camera = its;
        }
        wanted++;
      }
    } finally {
      synchronized (lock) {
        opening = null;
      }
      if (opened != null) {
        opened.close();
      }
    }
  }

  private void progressed(float share) {
    boolean visible;
    synchronized (lock) {
      // Often enough for an eye; thousands of calls would keep the screen's thread busy.
      visible = share - progress >= 0.01f || share < progress;
      progress = visible ? share : progress;
    }
    if (visible) {
      tell();
    }
  }

  /**
   * A call that came before the frame had begun cancelled nothing: the frame asks for itself, too.
   */
  private void cancelStale() {
    synchronized (lock) {
      boolean stale;
      if (task == Task.REFINED || task == Task.MEASURE) {
        stale = startedWith != wanted || !running || screen == null || plan != null;
      } else {
        stale = task == Task.BENCHMARK && plan == null;
      }
      if (stale || quit || close) {
        cancelFrame();
      }
    }
  }

  private void draw(boolean refined) {
    RayTracer on;
    Camera from;
    Settings how;
    int width;
    int height;
    double scale;
    boolean drop;
    synchronized (lock) {
      on = Objects.requireNonNull(tracer);
      from = camera;
      if (from == null) {
        // Another scene came since the loop looked.
        return;
      }
      how = settings;
      startedWith = wanted;
      scale = refined ? 1 : resolution.coarse();
      double all =
          scale * how.resolution() / 100 * ThermalPolicy.scale(thermalStatus) * resolution.memory();
      width = Resolution.side(screenWidth, all);
      height = Resolution.side(screenHeight, all);
      drop = dropBuffers;
      dropBuffers = false;
    }
    try {
      on.setCamera(from);
    } catch (RayTracerException e) {
      // One that cannot be drawn from: back to where the tracer still is.
      synchronized (lock) {
        camera = from.equals(camera) ? on.getCamera() : camera;
        wanted++;
      }
      return;
    }
    if (drop) {
      frames.free();
    }
    long began = System.nanoTime();
    FrameInfo drew = frames.draw(on, from, how, width, height, refined || scale == 1);
    double millis = (System.nanoTime() - began) / 1e6;
    synchronized (lock) {
      resolution.took(millis, scale);
      info = drew;
      drawnSettings = how;
      drawn = startedWith;
      composeWanted++;
    }
    show();
  }

  /** Brings the last frame to the screen, if there is one. */
  private void show() {
    Screen on;
    Settings how;
    int compose;
    synchronized (lock) {
      on = screen;
      how = drawnSettings.withDivider(settings.divider());
      compose = composeWanted;
    }
    if (!frames.isReady()) {
      // Cancelled midway: what was on the screen is half overwritten.
      synchronized (lock) {
        wanted++;
      }
    } else if (on != null) {
      on.show(frames.compose(how), frames.width(), frames.height());
    }
    synchronized (lock) {
      composed = compose;
      doneNanos = System.nanoTime();
    }
  }

  private void measure() {
    RayTracer on;
    FrameInfo what;
    Settings how;
    synchronized (lock) {
      on = Objects.requireNonNull(tracer);
      what = Objects.requireNonNull(info);
      how = drawnSettings;
      startedWith = wanted;
    }
    on.setCamera(what.camera());
    FrameInfo knows = frames.measure(on, how, what);
    synchronized (lock) {
      measured = startedWith;
      info = info == what ? knows : info;
    }
  }

  private void measurePlan() {
    RayTracer on;
    Benchmark.Plan what;
    Camera from;
    synchronized (lock) {
      on = Objects.requireNonNull(tracer);
      from = camera;
      what = plan;
      if (from == null || what == null) {
        // Cancelled since the loop looked.
        return;
      }
      progress = 0;
    }
    tell();
    on.setCamera(from);
    Benchmark.Result result =
        Benchmark.run(
            on,
            what,
            share -> {
              progressed(share);
              synchronized (lock) {
                return plan == what && !quit;
              }
            });
    synchronized (lock) {
      if (plan == what) {
        plan = null;
        benchmark = result;
      }
    }
  }
}
