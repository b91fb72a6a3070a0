// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy;

import java.util.ArrayList;
import java.util.List;
import java.util.concurrent.ExecutorService;
import java.util.concurrent.Executors;
import java.util.concurrent.Future;

/** Eight threads at once, and many rounds: DEVICE ROUNDS. */
final class ThreadsTest {
  private ThreadsTest() {}

  public static void main(String[] arguments) throws Exception {
    String device = arguments[0];
    eight(device);
    rounds(device, Integer.parseInt(arguments[1]));
    System.out.println("done");
  }

  private static void eight(String device) throws Exception {
    ExecutorService pool = Executors.newFixedThreadPool(8);
    try (RayTracer shared = RayTracer.open(SceneSource.builtin("spheres"), Check.on(device))) {
      byte[] wanted = Check.draw(shared, RenderOptions.defaults(), 48, 32);
      List<Future<?>> all = new ArrayList<>();
      for (int at = 0; at < 8; at++) {
        int number = at;
        all.add(
            pool.submit(
                () -> {
                  for (int round = 0; round < 3; round++) {
                    Check.same(
                        wanted, Check.draw(shared, RenderOptions.defaults(), 48, 32), "shared");
                    shared.setCamera(shared.getCamera());
                    shared.stats();
                    shared.deviceInfo();
                  }
                  if (number % 2 == 0) {
                    try (RayTracer own =
                        RayTracer.open(SceneSource.builtin("spheres"), Check.on(device))) {
                      Check.same(wanted, Check.draw(own, RenderOptions.defaults(), 48, 32), "own");
                    }
                  }
                  return null;
                }));
      }
      for (Future<?> one : all) {
        one.get();
      }
    }
    pool.shutdown();
    Check.equal(0, Native.openCount());
  }

  private static void rounds(String device, int rounds) throws Exception {
    int threads = 0;
    long kib = 0;
    byte[] wanted = null;
    for (int round = 0; round < rounds; round++) {
      try (RayTracer tracer = RayTracer.open(SceneSource.builtin("wall"), Check.on(device))) {
        tracer.setProgressListener((phase, share) -> {});
        byte[] drawn = Check.draw(tracer, RenderOptions.defaults(), 24, 16);
        wanted = wanted == null ? drawn : wanted;
        Check.same(wanted, drawn, "round " + round);
      }
      Check.equal(0, Native.openCount());
      if (round == rounds / 2) {
        System.gc();
        threads = Check.threads();
        kib = Check.residentKib();
      }
    }
    System.gc();
    // The collector and the compiler of the Java VM have threads of their own that come and go.
    Check.that(
        Check.threads() <= threads + 4, "threads: " + threads + ", later " + Check.threads());
    long grown = Check.residentKib() - kib;
    System.out.println("memory: grown by " + grown + " KiB in " + rounds / 2 + " rounds");
    long most = device.equals("cpu") ? 16 << 10 : 256 << 10;
    Check.that(grown <= most, "memory grew by " + grown + " KiB");
  }
}
