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
public final class RenderLoop {
  private enum Task {
    OPEN,
    CLOSE,
    COARSE,
    REFINED,
    COMPOSE,
    MEASURE,
    BENCHMARK,
    QUIT
  }

  private final Opener opener;
  private final long idleMillis;
  private final Thread thread;
  private final Object lock = new Object();

  // What is wanted. All of these, and those below, are guarded by the lock.
  private SceneChoice scene;
  private Settings settings;
  private @Nullable Camera camera;
  private @Nullable Screen screen;
  private int screenWidth;
  private int screenHeight;
  private boolean running;
  private boolean moving;
  private boolean quit;
  private boolean close;
  private boolean retryCrashed;
  private int thermalStatus;
  private @Nullable Runnable listener;
  private Benchmark.@Nullable Plan plan;

  // What is there.
  private @Nullable RayTracer tracer;
  private @Nullable SceneChoice openScene;
  private @Nullable Cancellation opening;
  private @Nullable Camera start;
  private @Nullable DeviceInfo device;
  private @Nullable Failure failure;
  private @Nullable FrameInfo info;
  private Settings drawnSettings;
  private @Nullable Task task;
  private float progress;
  private @Nullable String benchmark;

  /** Counts what makes the frame another one; the frame on the screen has that of its start. */
  private int wanted = 1;

  private int startedWith;
  private int drawn;
  private int measured;
  private boolean composed;
  private boolean dropBuffers;
  private long doneNanos;
  private final Resolution resolution = new Resolution();

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
    this.opener = opener;
    this.scene = scene;
    this.settings = settings;
    this.camera = camera;
    this.idleMillis = idleMillis;
    drawnSettings = settings;
    thread = new Thread(this::work, "rarefy-demo");
    thread.start();
  }

  /** Who is told, on any thread and without a lock held, that {@link #state} is another one. */
  public void setListener(@Nullable Runnable listener) {
    synchronized (lock) {
      this.listener = listener;
    }
  }

  /** A surface came, or changed its size. */
  public void setScreen(Screen screen, int width, int height) {
    synchronized (lock) {
      boolean resized = screenWidth != width || screenHeight != height;
      this.screen = screen;
      screenWidth = width;
      screenHeight = height;
      composed = false;
      changed(resized);
    }
  }

  /** The surface goes. The screen is not called any more once it forgets its surface itself. */
  public void loseScreen() {
    synchronized (lock) {
      screen = null;
      cancelFrame();
      changed(false);
    }
    tell();
  }

  /** The app is in the foreground. */
  public void resume() {
    synchronized (lock) {
      running = true;
      changed(false);
    }
    tell();
  }

  /** The app is not in the foreground any more. Opening goes on. */
  public void pause() {
    synchronized (lock) {
      running = false;
      moving = false;
      plan = null;
      cancelFrame();
      changed(false);
    }
    tell();
  }

  /** Another scene. */
  public void setScene(SceneChoice scene) {
    synchronized (lock) {
      if (scene.equals(this.scene) && failure == null) {
        return;
      }
      this.scene = scene;
      camera = null;
      start = null;
      failure = null;
      abandon();
      changed(true);
    }
    tell();
  }

  /** Other settings. */
  public void setSettings(Settings settings) {
    synchronized (lock) {
      boolean other = !settings.drawsAs(this.settings);
      composed &= settings.equals(this.settings);
      this.settings = settings;
      changed(other);
    }
  }

  /** Another camera. */
  public void setCamera(Camera camera) {
    synchronized (lock) {
      if (start != null && !camera.equals(this.camera)) {
        this.camera = camera;
        changed(true);
      }
    }
  }

  /** The camera that the scene brings; null while it is not open. */
  public @Nullable Camera startCamera() {
    synchronized (lock) {
      return start;
    }
  }

  /** A finger began or ended to move something: frames are coarse meanwhile. */
  public void setMoving(boolean moving) {
    synchronized (lock) {
      this.moving = moving;
      changed(false);
    }
  }

  /** A value of {@code PowerManager.THERMAL_STATUS_...}. */
  public void setThermalStatus(int status) {
    synchronized (lock) {
      boolean other = ThermalPolicy.scale(status) != ThermalPolicy.scale(thermalStatus);
      thermalStatus = status;
      changed(other);
    }
  }

  /**
   * The system has little memory.
   *
   * @param unseen whether the app is in the background: then all is freed, and opened again later
   */
  public void trimMemory(boolean unseen) {
    synchronized (lock) {
      if (unseen && !running) {
        abandon();
        close = true;
      } else if (info != null) {
        dropBuffers = true;
        resolution.shrink();
      }
      changed(true);
    }
    tell();
  }

  /**
   * After a failure: opens the scene anew.
   *
   * @param crashed whether to try a driver again that ended the process
   */
  public void retry(boolean crashed) {
    synchronized (lock) {
      failure = null;
      retryCrashed |= crashed;
      abandon();
      close = true;
      changed(true);
    }
    tell();
  }

  /** Measures instead of drawing; {@link State#benchmark} has the result. */
  public void benchmark(Benchmark.Plan plan) {
    synchronized (lock) {
      this.plan = plan;
      benchmark = null;
      cancelFrame();
      changed(false);
    }
    tell();
  }

  /** Ends a benchmark without a result. */
  public void cancelBenchmark() {
    synchronized (lock) {
      plan = null;
      cancelFrame();
      changed(false);
    }
    tell();
  }

  /** The result of the last benchmark was seen. */
  public void takeBenchmark() {
    synchronized (lock) {
      benchmark = null;
    }
    tell();
  }

  /** Ends the thread and frees all. Nothing may be asked of the loop afterwards but its state. */
  public void quit() {
    synchronized (lock) {
      quit = true;
      listener = null;
      abandon();
      changed(false);
    }
  }

  /** Waits for the end after {@link #quit}. */
  void join() throws InterruptedException {
    thread.join();
  }

  /** How far the loop is. */
  public State state() {
    synchronized (lock) {
      return new State(phase(), progress, scene, camera, info, device, failure, benchmark);
    }
  }

  private State.Phase phase() {
    if (failure != null) {
      return State.Phase.FAILED;
    } else if (task == Task.OPEN) {
      return State.Phase.OPENING;
    } else if (!running || quit || screen == null) {
      return State.Phase.RESTING;
    } else if (tracer == null) {
      return State.Phase.OPENING;
    } else if (plan != null) {
      return State.Phase.BENCHMARK;
    }
    return isDone() ? State.Phase.DONE : State.Phase.DRAWING;
  }

  private boolean isDone() {
    return drawn == wanted && composed && info != null && info.isRefined();
  }

  /** With the lock: the loop looks again at what is wanted. */
  private void changed(boolean otherFrame) {
    if (otherFrame) {
      wanted++;
      if (task == Task.REFINED || task == Task.MEASURE) {
        cancelFrame();
      }
    }
    lock.notifyAll();
  }

  /** With the lock: ends what the tracer does. */
  private void cancelFrame() {
    RayTracer now = tracer;
    if (now != null && task != null && task != Task.OPEN) {
      now.cancel();
    }
  }

  /** With the lock: as {@link #cancelFrame}, and opening too. */
  private void abandon() {
    plan = null;
    if (opening != null) {
      opening.cancel();
    }
    cancelFrame();
  }

  private void tell() {
    Runnable told;
    synchronized (lock) {
      told = listener;
    }
    if (told != null) {
      told.run();
    }
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

  private @Nullable Task find() {
    if (quit) {
      return Task.QUIT;
    } else if (close) {
      return Task.CLOSE;
    } else if (!running || failure != null) {
      return null;
    } else if (tracer == null || !scene.equals(openScene)) {
      return Task.OPEN;
    } else if (plan != null) {
      return Task.BENCHMARK;
    } else if (screen == null || screenWidth < 1 || screenHeight < 1) {
      return null;
    } else if (drawn != wanted) {
      return moving || resolution.coarse() < 1 ? Task.COARSE : Task.REFINED;
    } else if (!composed) {
      return Task.COMPOSE;
    } else if (!moving && info != null && !info.isRefined()) {
      return Task.REFINED;
    }
    boolean rests = moving || ThermalPolicy.restsInBackground(thermalStatus);
    return rests || measured == wanted ? null : Task.MEASURE;
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
      from = Objects.requireNonNull(camera);
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
      composed = false;
    }
    show();
  }

  /** Brings the last frame to the screen, if there is one. */
  private void show() {
    Screen on;
    Settings how;
    synchronized (lock) {
      on = screen;
      how = drawnSettings.withDivider(settings.divider());
      composed = true;
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
      from = Objects.requireNonNull(camera);
      what = Objects.requireNonNull(plan);
      progress = 0;
    }
    tell();
    on.setCamera(from);
    String json =
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
        benchmark = json;
      }
    }
  }
}
