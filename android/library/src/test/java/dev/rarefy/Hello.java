// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy;

import java.nio.ByteBuffer;

/** The example of README.md, which a test holds to be the same. */
final class Hello {
  private Hello() {}

  public static void main(String[] arguments) {
    try (RayTracer tracer = RayTracer.open(SceneSource.builtin("spheres"))) {
      ByteBuffer pixels = RayTracer.allocate(640, 480);
      FrameStats stats = tracer.render(RenderOptions.ofSize(640, 480), pixels);
      System.out.println(stats);
    }
  }
}
