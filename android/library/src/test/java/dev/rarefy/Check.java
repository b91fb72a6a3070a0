// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy;

import java.io.IOException;
import java.nio.ByteBuffer;
import java.nio.file.Files;
import java.nio.file.Paths;
import java.util.Arrays;
import java.util.concurrent.Callable;

/** What the tests share: plain checks that throw, since there is no test framework here. */
final class Check {
  private Check() {}

  static void that(boolean truth, String what) {
    if (!truth) {
      throw new AssertionError(what);
    }
  }

  static void equal(Object wanted, Object got) {
    that(wanted.equals(got), "wanted " + wanted + ", got " + got);
  }

  /** What a call throws, which must be of this class. */
  static <T extends Throwable> T thrown(Class<T> wanted, Callable<?> call) {
    Object got;
    try {
      got = call.call();
    } catch (Throwable e) {
      if (wanted.isInstance(e)) {
        return wanted.cast(e);
      }
      throw new AssertionError("wanted " + wanted.getName() + ", got " + e, e);
    }
    throw new AssertionError("wanted " + wanted.getName() + ", got " + got);
  }

  static Callable<?> call(Runnable run) {
    return () -> {
      run.run();
      return "nothing";
    };
  }

  /** A RayTracerException of this code, whose message has this in it. */
  static RayTracerException coded(RayTracerException.Code code, String part, Callable<?> call) {
    RayTracerException e = thrown(RayTracerException.class, call);
    that(e.getCode() == code, "wanted " + code + ", got " + e.getCode() + ": " + e.getMessage());
    that(e.getMessage().contains(part), "no \"" + part + "\" in: " + e.getMessage());
    return e;
  }

  static OpenOptions on(String device) {
    return OpenOptions.builder().device(device).strict(true).build();
  }

  static RayTracer cpu(String builtin) {
    return RayTracer.open(SceneSource.builtin(builtin), on("cpu"));
  }

  /** A frame's bytes. */
  static byte[] draw(RayTracer tracer, RenderOptions options, int width, int height) {
    ByteBuffer pixels = RayTracer.allocate(width, height);
    FrameStats stats = tracer.render(options.toBuilder().size(width, height).build(), pixels);
    equal(width, stats.getWidth());
    equal(height, stats.getHeight());
    byte[] bytes = new byte[pixels.remaining()];
    pixels.get(bytes);
    return bytes;
  }

  static void same(byte[] wanted, byte[] got, String what) {
    that(Arrays.equals(wanted, got), what + ": another picture");
  }

  /** Gives a frame to the test that started this. */
  static void write(String file, byte[] bytes) throws IOException {
    Files.write(Paths.get(file), bytes);
  }

  /** Threads of this process, those that are not Java's included. */
  static int threads() {
    String[] tasks = new java.io.File("/proc/self/task").list();
    return tasks == null ? 0 : tasks.length;
  }

  /** Memory of this process in KiB. */
  static long residentKib() throws IOException {
    for (String line : Files.readAllLines(Paths.get("/proc/self/status"))) {
      if (line.startsWith("VmRSS:")) {
        return Long.parseLong(line.replaceAll("[^0-9]", ""));
      }
    }
    return 0;
  }
}
