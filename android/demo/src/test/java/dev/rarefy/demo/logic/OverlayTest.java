// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo.logic;

import java.util.Arrays;
import java.util.List;
import java.util.Locale;

/** The sentences over the picture, with the numbers of different regions. */
public final class OverlayTest {
  private OverlayTest() {}

  /** Which word, and what is put into it. */
  private static String plain(Words.Word word, Object... with) {
    return word + Arrays.toString(with);
  }

  public static void main(String[] arguments) throws Exception {
    Overlay english = new Overlay(OverlayTest::plain, Locale.ENGLISH);
    Overlay german = new Overlay(OverlayTest::plain, Locale.GERMAN);
    Settings settings = Settings.defaults().withResolution(100);
    try (Stage stage = new Stage(Stage::open, Stage.SPHERES, settings, null, 1 << 30)) {
      Check.that(english.lines(stage.loop.state()).isEmpty(), "nothing is known yet");
      stage.loop.setScreen(stage.screen, 1200, 10);
      stage.loop.resume();
      State state = stage.done();
      List<String> lines = english.lines(state);
      Check.equal(3, lines.size());
      Check.that(lines.get(0).startsWith("FRAME[1,200, 10, "), lines.get(0));
      Check.that(german.lines(state).get(0).startsWith("FRAME[1.200, 10, "), "German");
      Check.that(lines.get(1).matches("TRACED\\[\\d+%]"), lines.get(1));
      Check.that(lines.get(2).startsWith("CPU[CPU"), lines.get(2));
      stage.loop.setSettings(settings.withMode(Settings.Mode.FULL));
      Check.equal("TRACED[100%]", english.lines(stage.done()).get(1));
      stage.loop.setSettings(settings.withMode(Settings.Mode.SPLIT));
      String speedup = english.lines(stage.done()).get(2);
      Check.that(speedup.matches("SPEEDUP\\[\\d+(\\.\\d\\d?)?]"), speedup);
    }
    try (Stage stage = new Stage(Stage::open, Stage.SPHERES, settings, null, 0)) {
      stage.loop.setScreen(stage.screen, 120, 100);
      stage.loop.resume();
      stage.done();
      Check.until("rays", () -> stage.loop.state().frame().rays() != null);
      String rays = german.lines(stage.loop.state()).get(1);
      Check.that(rays.matches("RAYS\\[\\d+\\.\\d{3}]"), rays);
      String message = english.message(stage.loop.state(), "Spheres");
      Check.that(message == null, "the CPU that was asked for needs no message: " + message);
    }
    Check.equal("34%", english.percent(0.341));
    Check.equal("3.4%", english.percent(0.0341));
    Check.equal("0.123", english.tolerance(0.1234f));
    Check.equal("0,123", german.tolerance(0.1234f));
    messages(english);
    Stage.closeReferences();
    System.out.println("done");
  }

  private static State failed(Failure.Kind kind, Throwable thrown) {
    return new State(
        State.Phase.FAILED, 0, Stage.WALL, null, null, null, Failure.of(kind, thrown), null);
  }

  private static void messages(Overlay overlay) {
    RuntimeException plain = new IllegalStateException("odd");
    Check.equal(
        "DEFECT[java.lang.IllegalStateException: odd]",
        overlay.message(failed(Failure.Kind.DRAWING, plain), "Wall"));
    Check.equal(
        "MEMORY_FAILED[]",
        overlay.message(failed(Failure.Kind.MEMORY, new OutOfMemoryError()), "Wall"));
    try {
      Stage.open(
          SceneChoice.fromText("OBJ /nowhere.obj"),
          false,
          (phase, share) -> {},
          new dev.rarefy.Cancellation());
      throw new AssertionError("it opens");
    } catch (dev.rarefy.RayTracerException e) {
      String told = overlay.message(failed(Failure.Kind.OPENING, e), "Wall");
      Check.that(told.startsWith("OPENING_FAILED[Wall, /nowhere.obj: no such"), told);
    }
    String report =
        DeviceReport.text(
            new java.util.TreeMap<>(), "0.1", null, null, Failure.of(Failure.Kind.MEMORY, plain));
    Check.equal("rarefy: 0.1\nfailure: MEMORY: odd\n", report);
  }
}
