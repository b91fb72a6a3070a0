// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo.logic;

import dev.rarefy.Camera;
import dev.rarefy.Cancellation;
import dev.rarefy.DeviceInfo;
import dev.rarefy.RayTracer;
import org.jspecify.annotations.Nullable;

/**
 * What is wanted of a {@link RenderLoop}, what it has, and what it is to do next. Methods may be
 * called from any thread, and wait for nothing; what is wanted last wins.
 */
abstract class Schedule {
  enum Task {
    OPEN,
    CLOSE,
    COARSE,
    REFINED,
    COMPOSE,
    MEASURE,
    BENCHMARK,
    QUIT
  }

  final Object lock = new Object();

  // What is wanted. All of these, and those below, are guarded by the lock.
  SceneChoice scene;
  Settings settings;
  @Nullable Camera camera;
  @Nullable Screen screen;
  int screenWidth;
  int screenHeight;
  boolean running;
  boolean moving;
  boolean quit;
  boolean close;
  boolean retryCrashed;
  int thermalStatus;
  Benchmark.@Nullable Plan plan;

  // What is there.
  @Nullable RayTracer tracer;
  @Nullable SceneChoice openScene;
  @Nullable Cancellation opening;
  @Nullable Camera start;
  @Nullable DeviceInfo device;
  @Nullable Failure failure;
  @Nullable FrameInfo info;
  Settings drawnSettings;
  @Nullable Task task;
  float progress;
  Benchmark.@Nullable Result benchmark;

  /** Counts what makes the frame another one; the frame on the screen has that of its start. */
  int wanted = 1;

  int startedWith;
  int drawn;
  int measured;

  /** Counts what makes the same frame look otherwise; likewise. */
  int composeWanted = 1;

  int composed;
  boolean dropBuffers;
  long doneNanos;
  final Resolution resolution = new Resolution();

  /** Held while the listener is told; it may look at the state, so that this comes first. */
  private final Object telling = new Object();

  /** Guarded by {@link #telling}. */
  private @Nullable Runnable listener;

  Schedule(SceneChoice scene, Settings settings, @Nullable Camera camera) {
    this.scene = scene;
    this.settings = settings;
    this.camera = camera;
    drawnSettings = settings;
  }

  /**
   * Who is told, on any thread, that {@link #state} is another one; it must wait for nothing. Once
   * this returns, the one before is told nothing any more: an activity that is gone stays so.
   */
  public void setListener(@Nullable Runnable listener) {
    synchronized (telling) {
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
      composeWanted++;
      changed(resized);
    }
  }

  /**
   * The surface goes. Another one that came meanwhile stays: the screens of a phone that is turned
   * come and go in any order.
   */
  public void loseScreen(Screen lost) {
    synchronized (lock) {
      if (screen != lost) {
        return;
      }
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
      composeWanted += settings.equals(this.settings) ? 0 : 1;
      if (settings.resolution() != this.settings.resolution()) {
        resolution.restore();
      }
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
      resolution.restore();
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
    setListener(null);
    synchronized (lock) {
      quit = true;
      abandon();
      changed(false);
    }
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
    // A task that draws or composes has not yet brought its picture to the screen.
    boolean shown = task == null || task == Task.MEASURE;
    return shown
        && drawn == wanted
        && composed == composeWanted
        && info != null
        && info.isRefined();
  }

  /** Without the lock. */
  void tell() {
    synchronized (telling) {
      if (listener != null) {
        listener.run();
      }
    }
  }

  /** With the lock: the loop looks again at what is wanted. */
  void changed(boolean otherFrame) {
    if (otherFrame) {
      wanted++;
      if (task == Task.REFINED || task == Task.MEASURE) {
        cancelFrame();
      }
    }
    lock.notifyAll();
  }

  /** With the lock: ends what the tracer does. */
  void cancelFrame() {
    RayTracer now = tracer;
    if (now != null && task != null && task != Task.OPEN) {
      now.cancel();
    }
  }

  /** With the lock: as {@link #cancelFrame}, and opening too. */
  void abandon() {
    plan = null;
    if (opening != null) {
      opening.cancel();
    }
    cancelFrame();
  }

  /** With the lock: what is to be done now; null for nothing. */
  @Nullable Task find() {
    if (quit) {
      return Task.QUIT;
    } else if (close) {
      return Task.CLOSE;
    } else if (!running || failure != null) {
      return null;
    } else if (tracer == null || camera == null || !scene.equals(openScene)) {
      // Without a camera: the user went to another scene and back.
      return Task.OPEN;
    } else if (plan != null) {
      return Task.BENCHMARK;
    } else if (screen == null || screenWidth < 1 || screenHeight < 1) {
      return null;
    } else if (drawn != wanted) {
      return moving || resolution.coarse() < 1 ? Task.COARSE : Task.REFINED;
    } else if (composed != composeWanted) {
      return Task.COMPOSE;
    } else if (!moving && info != null && !info.isRefined()) {
      return Task.REFINED;
    }
    boolean rests = moving || ThermalPolicy.restsInBackground(thermalStatus);
    return rests || measured == wanted ? null : Task.MEASURE;
  }
}
