// SPDX-License-Identifier: MIT OR Apache-2.0
package app;

import dev.rarefy.Layer;
import dev.rarefy.OpenClReport;
import dev.rarefy.OpenOptions;
import dev.rarefy.RayTracer;
import dev.rarefy.RayTracerException;
import dev.rarefy.RenderOptions;
import dev.rarefy.SceneSource;
import java.io.ByteArrayInputStream;
import java.io.File;
import java.nio.ByteBuffer;

/**
 * An app of another developer's, which android/check.sh builds against the AAR, shrinks and runs.
 */
public final class Main {
  private Main() {}

  public static void main(String[] arguments) {
    OpenOptions cpu = OpenOptions.builder().device("cpu").progress((phase, share) -> {}).build();
    SceneSource[] none = {
      SceneSource.files(new File("none-such")),
      SceneSource.baked(new File("none-such")),
      SceneSource.baked(1 << 20, 0, 1),
      SceneSource.assets("a.obj", name -> new ByteArrayInputStream(new byte[0])),
    };
    for (SceneSource source : none) {
      try {
        RayTracer.open(source, cpu).close();
        throw new AssertionError("opened " + source);
      } catch (RayTracerException e) {
        System.out.println(e.getCode() + ": " + e.getMessage());
      }
    }
    try (RayTracer tracer = RayTracer.open(SceneSource.builtin("spheres"), cpu)) {
      int[] previews = {0};
      tracer.setPreviewListener((width, height, firstRow, argb) -> previews[0] += argb.length);
      tracer.setCamera(tracer.getCamera().orbit(10, 0));
      tracer.setLights(tracer.getLights());
      ByteBuffer pixels = RayTracer.allocate(32, 24);
      RenderOptions options = RenderOptions.builder().size(32, 24).keepLayer(Layer.DEPTH).build();
      System.out.println(tracer.render(options, pixels));
      System.out.println(tracer.layer(Layer.DEPTH) + ", " + previews[0] + " pixels of previews");
      System.out.println(tracer.deviceInfo() + ", version " + RayTracer.version());
      System.out.println(OpenClReport.look(cpu));
      tracer.cancel();
    }
    System.out.println("done");
  }
}
