// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo.logic;

import java.nio.charset.StandardCharsets;
import java.nio.file.Files;
import java.nio.file.Paths;

/**
 * The benchmark runs on the loop, can be ended, and gives JSON that the test who started this
 * reads.
 */
public final class BenchmarkTest {
  private BenchmarkTest() {}

  public static void main(String[] arguments) throws Exception {
    try (Stage stage = new Stage(Stage.SPHERES, Settings.defaults())) {
      stage.begin();
      State before = stage.done();
      stage.loop.benchmark(new Benchmark.Plan("spheres", 2000, 2000, 3));
      Check.until("it runs", () -> stage.loop.state().phase() == State.Phase.BENCHMARK);
      stage.loop.cancelBenchmark();
      stage.done();
      Check.that(stage.loop.state().benchmark() == null, "a cancelled one has no result");
      stage.loop.benchmark(new Benchmark.Plan("spheres", 96, 64, 2));
      stage.loop.pause();
      stage.loop.resume();
      stage.done();
      Check.that(stage.loop.state().benchmark() == null, "nor has one of the background");
      // One that takes another's place while that one runs.
      stage.loop.benchmark(new Benchmark.Plan("spheres", 2000, 2000, 3));
      Check.until("it runs", () -> stage.loop.state().progress() > 0);
      stage.loop.benchmark(new Benchmark.Plan("spheres", 96, 64, 2));
      Check.until("a result", () -> stage.loop.state().benchmark() != null);
      Benchmark.Result result = stage.loop.state().benchmark();
      Check.equal(3, result.lines().size());
      for (Benchmark.Line line : result.lines()) {
        Check.that(line.fullMillis > 0 && line.adaptiveMillis > 0, "times of " + line.method);
        Check.that(line.tracedShare > 0 && line.tracedShare < 1, "share of " + line.method);
      }
      stage.done();
      stage.shows(Stage.SPHERES, Settings.defaults(), before.camera(), 40, 30);
      Files.write(Paths.get(arguments[0]), result.json().getBytes(StandardCharsets.UTF_8));
      stage.loop.takeBenchmark();
      Check.that(stage.loop.state().benchmark() == null, "taken");
    }
    Stage.closeReferences();
    System.out.println("done");
  }
}
