// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo.logic;

import dev.rarefy.Camera;
import dev.rarefy.Handles;
import dev.rarefy.RayTracerException;
import dev.rarefy.RayTracerException.Code;
import java.io.ByteArrayInputStream;
import java.io.File;
import java.io.FileInputStream;
import java.io.InputStream;
import java.nio.charset.StandardCharsets;
import java.util.Arrays;
import java.util.List;
import java.util.concurrent.CopyOnWriteArrayList;
import java.util.concurrent.atomic.AtomicBoolean;
import java.util.concurrent.atomic.AtomicInteger;

/** The loop with the real library: what is wanted last is what is shown, whatever happens. */
public final class LoopTest {
  private LoopTest() {}

  private static final Settings PLAIN = Settings.defaults().withResolution(100);

  public static void main(String[] arguments) throws Exception {
    whatIsShownIsWhatTheSettingsSay();
    theLatestCameraWins();
    aRefinedFrameEndsWhenItIsNotWanted();
    theDividerMovesWithoutAFrame();
    surfacesComeAndGo();
    errorsAreStates();
    littleMemoryGivesSmallerPictures();
    heatGivesSmallerPictures();
    idleFramesAreMeasured();
    theBackgroundFreesAndKeepsTheCamera();
    wishesThatChangeAtOnceDoNoHarm();
    aListenerThatIsGoneIsToldNothing();
    quittingEndsWhateverGoesOn();
    openedFilesAreDrawn(new File(arguments[0]), new File(arguments[1]));
    Stage.closeReferences();
    Check.equal(0, Handles.open());
    System.out.println("done");
  }

  private static void whatIsShownIsWhatTheSettingsSay() throws Exception {
    try (Stage stage = new Stage(Stage.SPHERES, PLAIN)) {
      Check.equal(State.Phase.RESTING, stage.loop.state().phase());
      stage.begin();
      Camera camera = stage.done().camera();
      stage.shows(Stage.SPHERES, PLAIN, camera, Stage.WIDTH, Stage.HEIGHT);
      for (Settings.Mode mode : Settings.Mode.values()) {
        for (Shown shown : Shown.values()) {
          Settings settings = PLAIN.withMode(mode).withShown(shown).withDivider(0.3f);
          stage.loop.setSettings(settings);
          Check.that(!stage.done().frame().stats().isFellBack(), "adaptive drawing pays here");
          stage.shows(Stage.SPHERES, settings, camera, Stage.WIDTH, Stage.HEIGHT);
        }
      }
      Settings samples = PLAIN.withSamples(2).withShown(Shown.CLASS).withResolution(50);
      stage.loop.setSettings(samples);
      stage.done();
      stage.shows(Stage.SPHERES, samples, camera, Stage.WIDTH / 2, Stage.HEIGHT / 2);
      stage.loop.setScene(Stage.WALL);
      stage.loop.setSettings(PLAIN);
      State wall = stage.done();
      Check.that(!camera.equals(wall.camera()), "another scene has another camera");
      stage.shows(Stage.WALL, PLAIN, wall.camera(), Stage.WIDTH, Stage.HEIGHT);
    }
  }

  private static void theLatestCameraWins() throws Exception {
    try (Stage stage = new Stage(Stage.SPHERES, PLAIN)) {
      stage.begin();
      Camera camera = stage.done().camera();
      stage.loop.setMoving(true);
      for (int move = 0; move < 200; move++) {
        camera = camera.orbit(1, 0.1);
        stage.loop.setCamera(camera);
        if (move % 20 == 0) {
          Thread.sleep(5);
        }
      }
      stage.loop.setMoving(false);
      Check.equal(camera, stage.done().frame().camera());
      stage.shows(Stage.SPHERES, PLAIN, camera, Stage.WIDTH, Stage.HEIGHT);
      // One that cannot be drawn from changes nothing.
      Camera none = camera.withUp(1e-30f, 0, 0).dolly(1e30);
      stage.loop.setCamera(none);
      State state = stage.done();
      Check.that(state.camera().equals(camera) || state.camera().equals(none), "a camera");
    }
  }

  private static void aRefinedFrameEndsWhenItIsNotWanted() throws Exception {
    // Heavy enough that a refined frame takes many times as long as a coarse one.
    Settings heavy = PLAIN.withSamples(4);
    try (Stage stage = new Stage(Stage.SPHERES, heavy)) {
      stage.loop.setScreen(stage.screen, 800, 600);
      stage.loop.resume();
      Check.until("a coarse frame", () -> stage.screen.count() > 0);
      Camera old = stage.loop.state().camera();
      Check.that(!stage.loop.state().frame().isRefined(), "coarse first");
      Camera next = old.orbit(10, 0);
      stage.loop.setMoving(true);
      stage.loop.setCamera(old.orbit(5, 0));
      // Most likely that frame is on its way now; it must not be taken for this one.
      Thread.sleep(20);
      stage.loop.setCamera(next);
      Check.until(
          "a coarse frame from there", () -> next.equals(stage.loop.state().frame().camera()));
      for (int at = 0; at < stage.screen.count(); at++) {
        Check.that(stage.screen.at(at).width < 800, "the refined frame was cancelled");
      }
      stage.loop.setSettings(PLAIN.withResolution(25));
      stage.loop.setMoving(false);
      stage.done();
      stage.shows(Stage.SPHERES, PLAIN, next, 200, 150);
    }
  }

  private static void theDividerMovesWithoutAFrame() throws Exception {
    Settings split = PLAIN.withMode(Settings.Mode.SPLIT);
    try (Stage stage = new Stage(Stage::open, Stage.SPHERES, split, null, 1 << 30)) {
      stage.begin();
      State before = stage.done();
      for (float place : new float[] {0, 0.1f, 0.77f, 1}) {
        stage.loop.setSettings(split.withDivider(place));
        stage.done();
        stage.shows(
            Stage.SPHERES, split.withDivider(place), before.camera(), Stage.WIDTH, Stage.HEIGHT);
        Check.that(stage.loop.state().frame() == before.frame(), "no other frame was drawn");
      }
      Check.that(before.frame().speedup() != null, "the split view knows its speedup");
      // A finger goes on while the divider is drawn where it was.
      Settings last = split.withDivider(0.4f);
      synchronized (stage.screen) {
        stage.screen.meanwhile = () -> stage.loop.setSettings(last);
      }
      stage.loop.setSettings(split.withDivider(0.6f));
      Check.until("both", () -> stage.loop.state().phase() == State.Phase.DONE);
      Check.until("the event", () -> stage.screen.meanwhile == null);
      stage.done();
      stage.shows(Stage.SPHERES, last, before.camera(), Stage.WIDTH, Stage.HEIGHT);
    }
  }

  private static void surfacesComeAndGo() throws Exception {
    try (Stage stage = new Stage(Stage.SPHERES, PLAIN)) {
      stage.begin();
      Camera camera = stage.done().camera();
      for (int round = 0; round < 5; round++) {
        stage.loop.setCamera(camera.orbit(round, 0));
        stage.screen.lost(true);
        stage.loop.loseScreen(stage.screen);
        Check.equal(State.Phase.RESTING, stage.loop.state().phase());
        stage.screen.forget();
        Thread.sleep(round);
        Check.equal(0, stage.screen.count());
        stage.screen.lost(false);
        stage.loop.setScreen(stage.screen, Stage.WIDTH + round, Stage.HEIGHT);
        stage.done();
        stage.shows(
            Stage.SPHERES, PLAIN, camera.orbit(round, 0), Stage.WIDTH + round, Stage.HEIGHT);
      }
      // The screen of before a turn goes after that of afterwards came.
      stage.loop.loseScreen(new Stage.Shows());
      stage.done();
      // The same size again shows the same frame again.
      stage.screen.forget();
      stage.loop.setScreen(stage.screen, Stage.WIDTH + 4, Stage.HEIGHT);
      Check.until("shown again", () -> stage.screen.count() > 0);
      stage.loop.setScreen(stage.screen, 0, 0);
      Thread.sleep(5);
      stage.begin();
      stage.done();
    }
  }

  private static void errorsAreStates() throws Exception {
    SceneChoice missing = SceneChoice.opened(new File("/nowhere/at all.obj"), false);
    try (Stage stage = new Stage(missing, PLAIN)) {
      stage.begin();
      Failure failure = stage.failed();
      Check.equal(Failure.Kind.OPENING, failure.kind());
      Check.equal(Code.INVALID_SCENE, failure.code());
      Check.that(failure.message().contains("at all.obj"), failure.message());
      stage.loop.retry(false);
      Check.equal(Failure.Kind.OPENING, stage.failed().kind());
      stage.loop.setScene(Stage.WALL);
      stage.done();
      stage.screen.broken = true;
      stage.loop.setSettings(PLAIN.withMode(Settings.Mode.FULL));
      failure = stage.failed();
      Check.equal(Failure.Kind.DEFECT, failure.kind());
      Check.that(failure.message().contains("broken screen"), failure.message());
      stage.screen.broken = false;
      stage.loop.retry(false);
      stage.done();
    }
    List<Boolean> retries = new CopyOnWriteArrayList<>();
    Opener fails =
        (scene, retry, progress, cancellation) -> {
          retries.add(retry);
          throw new UnsatisfiedLinkError("no rarefy_jni");
        };
    try (Stage stage = new Stage(fails, Stage.WALL, PLAIN, null, 0)) {
      stage.begin();
      Failure failure = stage.failed();
      Check.equal(Failure.Kind.DEFECT, failure.kind());
      Check.that(failure.message().contains("no rarefy_jni"), failure.message());
      stage.loop.retry(true);
      Check.until("tried again", () -> retries.size() == 2);
      stage.failed();
      stage.loop.retry(false);
      Check.until("tried once more", () -> retries.size() == 3);
      // Only when it is asked for, and once.
      Check.equal(Arrays.asList(false, true, false), retries);
    }
  }

  private static void littleMemoryGivesSmallerPictures() throws Exception {
    try (Stage stage = new Stage(Stage.WALL, PLAIN)) {
      stage.screen.most = 20;
      stage.begin();
      stage.done();
      Check.equal(20, stage.screen.last().width);
      stage.screen.most = 2;
      stage.loop.retry(false);
      Check.equal(Failure.Kind.MEMORY, stage.failed().kind());
      stage.screen.most = Integer.MAX_VALUE;
      stage.loop.retry(false);
      stage.done();
      Check.equal(Stage.WIDTH, stage.screen.last().width);
      stage.loop.trimMemory(false);
      stage.done();
      Check.equal(Stage.WIDTH / 2, stage.screen.last().width);
    }
  }

  private static void heatGivesSmallerPictures() throws Exception {
    try (Stage stage = new Stage(Stage.WALL, PLAIN)) {
      stage.begin();
      stage.done();
      stage.loop.setThermalStatus(ThermalPolicy.SEVERE);
      stage.done();
      Check.equal(Stage.WIDTH / 2, stage.screen.last().width);
      for (Settings.Mode mode : Settings.Mode.values()) {
        stage.loop.setSettings(PLAIN.withMode(mode));
        stage.done();
        Thread.sleep(200);
        Check.that(stage.loop.state().frame().rays() == null, "a hot phone measures nothing");
      }
      stage.loop.setThermalStatus(0);
      stage.done();
      Check.equal(Stage.WIDTH, stage.screen.last().width);
    }
  }

  private static void idleFramesAreMeasured() throws Exception {
    try (Stage stage = new Stage(Stage.SPHERES, PLAIN)) {
      stage.begin();
      stage.done();
      Check.until("rays", () -> stage.loop.state().frame().rays() != null);
      FrameInfo frame = stage.loop.state().frame();
      Check.that(frame.rays() > frame.stats().getTraced(), "rays: " + frame.rays());
      Check.that(frame.speedup() != null && frame.speedup() > 0, "speedup: " + frame.speedup());
      long adaptive = frame.rays();
      stage.loop.setSettings(PLAIN.withMode(Settings.Mode.FULL));
      stage.done();
      Check.until("rays of full", () -> stage.loop.state().frame().rays() != null);
      frame = stage.loop.state().frame();
      Check.that(frame.rays() > adaptive, "full has more rays: " + frame.rays());
      Check.that(frame.isFull() && frame.speedup() == null, "full is not faster than full");
    }
  }

  private static void theBackgroundFreesAndKeepsTheCamera() throws Exception {
    try (Stage stage = new Stage(Stage.WALL, PLAIN)) {
      int others = Handles.open();
      stage.begin();
      Camera camera = stage.done().camera().orbit(3, 3);
      stage.loop.setCamera(camera);
      stage.done();
      Check.equal(others + 1, Handles.open());
      stage.loop.pause();
      Check.equal(State.Phase.RESTING, stage.loop.state().phase());
      stage.loop.trimMemory(true);
      Check.until("all is freed", () -> Handles.open() == others);
      Check.equal(State.Phase.RESTING, stage.loop.state().phase());
      stage.loop.resume();
      Check.equal(camera, stage.done().camera());
      stage.shows(Stage.WALL, PLAIN, camera, Stage.WIDTH, Stage.HEIGHT);
    }
    Camera saved = Camera.lookingAt(0, 1, 5, 0, 0.5f, 0);
    try (Stage stage = new Stage(Stage::open, Stage.SPHERES, PLAIN, saved, 0)) {
      stage.begin();
      Check.equal(saved, stage.done().camera());
      Check.that(!saved.equals(stage.loop.startCamera()), "the scene has its own");
      stage.shows(Stage.SPHERES, PLAIN, saved, Stage.WIDTH, Stage.HEIGHT);
    }
  }

  /** Wishes that are gone before the loop comes to them, or while it does. */
  private static void wishesThatChangeAtOnceDoNoHarm() throws Exception {
    try (Stage stage = new Stage(Stage.WALL, PLAIN)) {
      stage.begin();
      Camera camera = stage.done().camera();
      Benchmark.Plan plan = new Benchmark.Plan("x", 16, 16, 1);
      for (int round = 0; round < 3000; round++) {
        stage.loop.benchmark(plan);
        if (round % 3 == 0) {
          Thread.yield();
        }
        stage.loop.cancelBenchmark();
      }
      Check.equal(camera, stage.done().camera());
      for (int round = 0; round < 1000; round++) {
        stage.loop.setCamera(camera.orbit(round, 0));
        if (round % 3 == 0) {
          Thread.yield();
        }
        stage.loop.setScene(Stage.RODS);
        stage.loop.setScene(Stage.WALL);
      }
      Check.equal(camera, stage.done().camera());
      stage.shows(Stage.WALL, PLAIN, camera, Stage.WIDTH, Stage.HEIGHT);
    }
  }

  /** Also not by the loop's thread that was about to tell it as it went. */
  private static void aListenerThatIsGoneIsToldNothing() throws Exception {
    Thread owner = Thread.currentThread();
    try (Stage stage = new Stage(Stage.WALL, PLAIN)) {
      stage.begin();
      Camera camera = stage.done().camera();
      AtomicBoolean told = new AtomicBoolean();
      AtomicBoolean gone = new AtomicBoolean();
      AtomicInteger late = new AtomicInteger();
      stage.loop.setListener(
          () -> {
            told.set(true);
            // The owner goes while it is told: it waits, or is gone too soon.
            while (owner.getState() != Thread.State.BLOCKED && !gone.get()) {
              Thread.yield();
            }
            late.addAndGet(gone.get() ? 1 : 0);
          });
      stage.loop.setCamera(camera.orbit(1, 0));
      Check.until("told", told::get);
      stage.loop.setListener(null);
      gone.set(true);
      stage.loop.setCamera(camera);
      stage.done();
      Check.equal(0, late.get());
    }
  }

  private static void quittingEndsWhateverGoesOn() throws Exception {
    int others = Handles.open();
    SceneChoice cafe = SceneChoice.fromText("BUILTIN cafe");
    AtomicInteger cancelled = new AtomicInteger();
    Opener opener =
        (scene, retry, progress, cancellation) -> {
          try {
            return Stage.open(scene, retry, progress, cancellation);
          } catch (RayTracerException e) {
            cancelled.addAndGet(e.getCode() == Code.CANCELLED ? 1 : 0);
            throw e;
          }
        };
    try (Stage stage = new Stage(opener, cafe, PLAIN.withSamples(4), null, 0)) {
      stage.begin();
      Check.until("opening", () -> stage.loop.state().progress() > 0);
      // Another scene ends the opening of this one.
      stage.loop.setScene(Stage.WALL);
      stage.done();
      Check.equal(1, cancelled.get());
      stage.loop.setScene(cafe);
      Check.until("opening again", () -> stage.loop.state().phase() == State.Phase.OPENING);
    }
    Check.equal(2, cancelled.get());
    Check.equal(others, Handles.open());
  }

  /** What the picker gives: a lonely OBJ file, and a baked scene whose name tells nothing. */
  private static void openedFilesAreDrawn(File folder, File baked) throws Exception {
    String obj = "mtllib none.mtl\nusemtl wood\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0.2\nf 1 2 3 4\n";
    InputStream text = new ByteArrayInputStream(obj.getBytes(StandardCharsets.US_ASCII));
    SceneChoice lonely = OpenedFile.copy(text, "chair.obj", new File(folder, "a"), 1000);
    try (Stage stage = new Stage(lonely, PLAIN)) {
      stage.begin();
      stage.shows(lonely, PLAIN, stage.done().camera(), Stage.WIDTH, Stage.HEIGHT);
      try (InputStream stream = new FileInputStream(baked)) {
        File other = new File(folder, "b");
        SceneChoice choice = OpenedFile.copy(stream, "download", other, baked.length());
        stage.loop.setScene(choice);
        stage.shows(Stage.SPHERES, PLAIN, stage.done().camera(), Stage.WIDTH, Stage.HEIGHT);
      }
      File[] copies = new File(folder, "b").listFiles();
      Check.that(copies != null && copies.length == 1, "one copy");
    }
  }
}
