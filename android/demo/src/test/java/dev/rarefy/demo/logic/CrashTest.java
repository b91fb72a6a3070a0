// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo.logic;

import dev.rarefy.OpenOptions;
import dev.rarefy.RayTracer;
import java.io.File;
import java.util.Arrays;
import java.util.Locale;

/**
 * A start of the app with a driver that may end the process; what the user is told, and a retry.
 */
public final class CrashTest {
  private CrashTest() {}

  /**
   * Starts.
   *
   * @param arguments an OpenCL library, a cache folder, whether the user asks for a retry
   */
  public static void main(String[] arguments) throws Exception {
    Opener opener =
        (scene, retryCrashed, progress, cancellation) ->
            RayTracer.open(
                scene.source(name -> null),
                OpenOptions.builder()
                    .openclLibrary(new File(arguments[0]))
                    .cacheFolder(new File(arguments[1]))
                    .retryCrashed(retryCrashed)
                    .progress(progress)
                    .cancellation(cancellation)
                    .build());
    Settings settings = Settings.defaults().withMode(Settings.Mode.FULL);
    try (Stage stage = new Stage(opener, Stage.WALL, settings, null, 1 << 30)) {
      stage.begin();
      tell("start", stage.done());
      if (Boolean.parseBoolean(arguments[2])) {
        stage.loop.retry(true);
        tell("retry", stage.done());
      }
    }
    System.out.println("done");
  }

  private static void tell(String when, State state) {
    Overlay overlay = new Overlay((word, with) -> word + Arrays.toString(with), Locale.ENGLISH);
    System.out.println(when + ": " + state.device().getBackend());
    System.out.println(when + ": " + overlay.message(state, "Wall"));
  }
}
