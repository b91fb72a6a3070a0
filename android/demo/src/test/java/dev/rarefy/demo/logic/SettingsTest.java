// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo.logic;

import dev.rarefy.FrameStats;
import dev.rarefy.OpenOptions;
import dev.rarefy.RayTracer;
import dev.rarefy.RenderOptions;
import dev.rarefy.SceneSource;
import java.util.HashMap;
import java.util.Map;
import java.util.Random;

/**
 * Settings survive being saved, whatever became of the text, and mean to the library what they say.
 */
public final class SettingsTest {
  /** Large enough that no frame is drawn in full because adaptive drawing does not pay. */
  private static final int SIDE = 96;

  private SettingsTest() {}

  public static void main(String[] arguments) {
    whatIsSavedComesBack();
    damageGivesDefaults();
    slidersHitTheirSteps();
    theLibraryTakesWhatThePanelSets();
    for (Tolerance tolerance : Tolerance.values()) {
      for (RenderOptions.Method method : RenderOptions.Method.values()) {
        // The test that started this knows what the methods say.
        System.out.println(
            "default "
                + tolerance.key()
                + " "
                + method
                + " "
                + tolerance.ofMethod(method, false)
                + " "
                + tolerance.ofMethod(method, true));
      }
    }
    System.out.println("done");
  }

  private static <T> T one(Random random, T[] values) {
    return values[random.nextInt(values.length)];
  }

  static Settings random(Random random) {
    Settings settings =
        Settings.defaults()
            .withMode(one(random, Settings.Mode.values()))
            .withDivider(random.nextFloat())
            .withShown(one(random, Shown.values()))
            .withMethod(one(random, RenderOptions.Method.values()))
            .withSamples(Settings.SAMPLES.get(random.nextInt(3)))
            .withResolution(Settings.RESOLUTIONS.get(random.nextInt(4)));
    if (random.nextBoolean()) {
      settings = settings.withCorrection(one(random, RenderOptions.Correction.values()));
    }
    for (Tolerance tolerance : Tolerance.values()) {
      if (random.nextBoolean()) {
        settings = settings.withTolerance(tolerance, tolerance.atStep(random.nextInt(201)));
      }
    }
    return settings;
  }

  private static void whatIsSavedComesBack() {
    Random random = new Random(12);
    for (int round = 0; round < 1000; round++) {
      Settings settings = random(random);
      Settings back = Settings.fromMap(settings.toMap());
      Check.equal(settings, back);
      Check.equal(settings.hashCode(), back.hashCode());
      // And each part by itself, since being equal might be judged by the text.
      Check.equal(settings.options(8, 9, false).toString(), back.options(8, 9, false).toString());
      Check.equal(settings.mode(), back.mode());
      Check.equal(settings.shown(), back.shown());
      Check.equal(settings.divider(), back.divider());
      Check.equal(settings.resolution(), back.resolution());
    }
  }

  private static void damageGivesDefaults() {
    Check.equal(Settings.defaults(), Settings.fromMap(new HashMap<>()));
    String[] bad = {"", "x", "NaN", "Infinity", "-1e30", "1e30", "3", "99999999999", "ÄÖ", "null"};
    for (String key : Settings.defaults().toMap().keySet()) {
      for (String text : bad) {
        Map<String, String> map = new HashMap<>(Settings.defaults().toMap());
        map.put(key, text);
        Settings settings = Settings.fromMap(map);
        if (key.equals("divider")) {
          Check.that(settings.divider() >= 0 && settings.divider() <= 1, text);
          settings = settings.withDivider(0.5f);
        }
        Check.equal(Settings.defaults(), settings);
      }
    }
    Random random = new Random(13);
    for (int round = 0; round < 2000; round++) {
      Map<String, String> map = new HashMap<>(random(random).toMap());
      String key = one(random, map.keySet().toArray(new String[0]));
      StringBuilder text = new StringBuilder(map.get(key));
      text.insert(random.nextInt(text.length() + 1), (char) random.nextInt(256));
      map.put(key, text.toString());
      Settings settings = Settings.fromMap(map);
      for (Tolerance tolerance : Tolerance.values()) {
        float value = settings.tolerance(tolerance);
        Check.that(value >= tolerance.least() && value <= tolerance.most(), key + ": " + text);
      }
      Check.equal(settings, Settings.fromMap(settings.toMap()));
    }
  }

  private static void slidersHitTheirSteps() {
    for (Tolerance tolerance : Tolerance.values()) {
      for (int step = 0; step <= Tolerance.STEPS; step++) {
        Check.equal(step, tolerance.stepOf(tolerance.atStep(step)));
      }
      Check.equal(tolerance.least(), tolerance.atStep(-5));
      Check.equal(tolerance.most(), tolerance.atStep(1000));
      Settings set = Settings.defaults().withTolerance(tolerance, tolerance.atStep(7));
      Check.that(set.isSet(tolerance), "set");
      Check.equal(tolerance.atStep(7), set.tolerance(tolerance));
      Check.equal(Settings.defaults(), set.withTolerance(tolerance, null));
    }
  }

  private static void theLibraryTakesWhatThePanelSets() {
    OpenOptions cpu = OpenOptions.builder().device("cpu").build();
    try (RayTracer tracer = RayTracer.open(SceneSource.builtin("spheres"), cpu)) {
      Settings settings = Settings.defaults();
      FrameStats loose = draw(tracer, settings.withTolerance(Tolerance.T_POS, 0.3f));
      Check.that(!loose.isFellBack(), "the method pays here: " + loose);
      FrameStats strict = draw(tracer, settings.withTolerance(Tolerance.T_POS, 0f));
      Check.that(
          strict.getTraced() > loose.getTraced(),
          "the strictest distance traces more: " + strict + ", " + loose);
      FrameStats usual = draw(tracer, settings);
      FrameStats off = draw(tracer, settings.withCorrection(RenderOptions.Correction.OFF));
      Check.that(usual.getCorrected() > 0, "something is corrected: " + usual);
      Check.equal(0L, off.getCorrected());
      // All steps of all sliders are within what the library allows.
      for (Tolerance tolerance : Tolerance.values()) {
        for (int step : new int[] {0, Tolerance.STEPS}) {
          draw(tracer, settings.withTolerance(tolerance, tolerance.atStep(step)));
        }
      }
      Random random = new Random(14);
      for (int round = 0; round < 20; round++) {
        Settings any = random(random);
        FrameStats stats = draw(tracer, any);
        Check.equal(SIDE, stats.getWidth());
      }
      FrameStats full = draw(tracer, settings, true);
      Check.equal(1.0, full.getTracedShare());
    }
  }

  private static FrameStats draw(RayTracer tracer, Settings settings) {
    return draw(tracer, settings, false);
  }

  private static FrameStats draw(RayTracer tracer, Settings settings, boolean full) {
    return tracer.render(settings.options(SIDE, SIDE, full), RayTracer.allocate(SIDE, SIDE));
  }
}
