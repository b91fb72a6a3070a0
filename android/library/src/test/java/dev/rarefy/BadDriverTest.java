// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy;

import java.io.File;

/**
 * A start with an OpenCL library that may end the process: LIBRARY CACHE-FOLDER RETRY. Says who
 * drew and what was passed over; the picture is the CPU's in any case.
 */
final class BadDriverTest {
  private BadDriverTest() {}

  public static void main(String[] arguments) {
    byte[] wanted;
    try (RayTracer tracer = Check.cpu("wall")) {
      wanted = Check.draw(tracer, RenderOptions.defaults(), 32, 24);
    }
    OpenOptions options =
        OpenOptions.builder()
            .openclLibrary(new File(arguments[0]))
            .cacheFolder(new File(arguments[1]))
            .retryCrashed(Boolean.parseBoolean(arguments[2]))
            .strict(true)
            .build();
    try (RayTracer tracer = RayTracer.open(SceneSource.builtin("wall"), options)) {
      System.out.println("backend: " + tracer.deviceInfo().getBackend());
      for (RayTracerException cause : tracer.deviceInfo().getPassedOver()) {
        System.out.println("passed over: " + cause.getCode() + ": " + cause.getMessage());
      }
      System.out.println("library: " + OpenClReport.look(options).getLibrary());
      Check.same(wanted, Check.draw(tracer, RenderOptions.defaults(), 32, 24), "another device");
    }
    System.out.println("done");
  }
}
