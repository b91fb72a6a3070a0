// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo.logic;

import dev.rarefy.Camera;
import dev.rarefy.Handles;
import java.io.File;
import java.util.Random;

/**
 * Random fingers, settings and events of an Activity's life: whatever their order, the state makes
 * sense at every moment, and once all is quiet the screen shows what was wanted last.
 */
public final class SequencesTest {
  private static final SceneChoice[] SCENES = {
    Stage.WALL, Stage.RODS, SceneChoice.opened(new File("/nowhere/at all.obj"), false)
  };

  private final Random random;
  private final Stage stage;
  private final Gestures gestures = new Gestures(Stage.WIDTH, Stage.HEIGHT);
  private Settings settings = Settings.defaults();
  private SceneChoice scene;
  private int fingers;
  private final StringBuilder log = new StringBuilder();

  private SequencesTest(long seed) {
    random = new Random(seed);
    scene = SCENES[random.nextInt(2)];
    stage = new Stage(Stage::open, scene, settings, null, random.nextInt(3));
  }

  /**
   * Runs sequences.
   *
   * @param arguments how many, and the seed of the first one
   */
  public static void main(String[] arguments) throws Exception {
    int count = Integer.parseInt(arguments[0]);
    long first = Long.parseLong(arguments[1]);
    int done = 0;
    int failed = 0;
    for (int at = 0; at < count; at++) {
      SequencesTest test = new SequencesTest(first + at);
      try {
        test.run();
      } catch (AssertionError e) {
        throw new AssertionError("sequence " + (first + at) + ":" + test.log, e);
      } finally {
        test.stage.close();
      }
      done += test.scene.kind() == SceneChoice.Kind.OBJ ? 0 : 1;
      failed += test.scene.kind() == SceneChoice.Kind.OBJ ? 1 : 0;
    }
    Stage.closeReferences();
    Check.equal(0, Handles.open());
    System.out.println(done + " sequences end with a picture, " + failed + " with a message");
    System.out.println("done");
  }

  private void run() throws Exception {
    int steps = 10 + random.nextInt(40);
    for (int step = 0; step < steps; step++) {
      step();
      makesSense(stage.loop.state());
      if (random.nextInt(4) == 0) {
        Thread.sleep(random.nextInt(6));
      }
    }
    // All is quiet, and the user looks.
    log.append(" | quiet");
    stage.loop.setMoving(false);
    stage.loop.setThermalStatus(0);
    stage.loop.cancelBenchmark();
    stage.screen.lost(false);
    stage.begin();
    if (scene.kind() == SceneChoice.Kind.OBJ) {
      Check.equal(Failure.Kind.OPENING, stage.failed().kind());
      return;
    }
    stage.loop.retry(false);
    State state = stage.done();
    makesSense(state);
    Check.equal(scene, state.scene());
    double scale = settings.resolution() / 100.0;
    stage.shows(
        scene,
        settings,
        state.camera(),
        Resolution.side(Stage.WIDTH, scale),
        Resolution.side(Stage.HEIGHT, scale));
  }

  private static void makesSense(State state) {
    State.Phase phase = state.phase();
    FrameInfo frame = state.frame();
    Check.that((phase == State.Phase.FAILED) == (state.failure() != null), "failure in " + phase);
    Check.that(state.progress() >= 0 && state.progress() <= 1, "progress " + state.progress());
    if (phase == State.Phase.DONE) {
      Check.that(frame != null && frame.isRefined(), "done means a refined frame");
      Check.equal(state.camera(), frame.camera());
      Check.that(state.device() != null, "done means a device");
    }
    if (frame != null && frame.speedup() != null) {
      Check.that(frame.speedup() > 0, "speedup " + frame.speedup());
    }
  }

  private float[] places(int count, int most) {
    float[] places = new float[count];
    for (int at = 0; at < count; at++) {
      places[at] = random.nextFloat() * most;
    }
    return places;
  }

  private void step() {
    int kind = random.nextInt(20);
    log.append(' ').append(kind);
    RenderLoop loop = stage.loop;
    switch (kind) {
      case 0:
      case 1:
        fingers = 1 + random.nextInt(3);
        gestures.fingers(
            places(fingers, Stage.WIDTH), places(fingers, Stage.HEIGHT), random.nextInt());
        loop.setMoving(true);
        break;
      case 2:
      case 3:
      case 4:
      case 5:
        move();
        break;
      case 6:
        if (gestures.lifted(random.nextInt()) && loop.startCamera() != null) {
          loop.setCamera(loop.startCamera());
        }
        fingers = 0;
        loop.setMoving(false);
        break;
      case 7:
        gestures.cancelled();
        fingers = 0;
        loop.setMoving(false);
        break;
      case 8:
      case 9:
        settings = SettingsTest.random(random).withSamples(1 + random.nextInt(2));
        loop.setSettings(settings);
        break;
      case 10:
        settings = settings.withDivider(random.nextFloat());
        loop.setSettings(settings);
        break;
      case 11:
      case 12:
        stage.screen.lost(false);
        loop.setScreen(
            stage.screen, 1 + random.nextInt(Stage.WIDTH), 1 + random.nextInt(Stage.HEIGHT));
        break;
      case 13:
        stage.screen.lost(true);
        loop.loseScreen(stage.screen);
        Check.that(loop.state().phase() != State.Phase.DONE, "done without a screen");
        break;
      case 14:
        loop.pause();
        Check.that(loop.state().phase() != State.Phase.DRAWING, "draws in the background");
        break;
      case 15:
      case 16:
        loop.resume();
        break;
      case 17:
        loop.trimMemory(random.nextBoolean());
        break;
      case 18:
        loop.setThermalStatus(random.nextInt(7));
        break;
      default:
        rare();
    }
  }

  private void rare() {
    int kind = random.nextInt(4);
    log.append('.').append(kind);
    switch (kind) {
      case 0:
        scene = SCENES[random.nextInt(SCENES.length)];
        stage.loop.setScene(scene);
        break;
      case 1:
        stage.loop.retry(random.nextBoolean());
        break;
      case 2:
        stage.loop.benchmark(new Benchmark.Plan("x", 16, 16, 1));
        break;
      default:
        stage.loop.cancelBenchmark();
        stage.loop.takeBenchmark();
    }
  }

  private void move() {
    // Now and then with fingers that nobody announced.
    int count = random.nextInt(10) == 0 ? 1 + random.nextInt(3) : fingers;
    Camera start = stage.loop.startCamera();
    Camera camera = stage.loop.state().camera();
    if (start != null && camera != null && count > 0) {
      float[] xs = places(count, Stage.WIDTH);
      float[] ys = places(count, Stage.HEIGHT);
      stage.loop.setCamera(gestures.moved(camera, start, xs, ys));
    }
  }
}
