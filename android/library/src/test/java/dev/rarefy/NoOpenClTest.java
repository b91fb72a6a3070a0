// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy;

/**
 * A machine without OpenCL: what is asked for is refused, what is left open is drawn on the CPU.
 */
final class NoOpenClTest {
  private NoOpenClTest() {}

  public static void main(String[] arguments) {
    Check.coded(
        RayTracerException.Code.NO_OPENCL,
        "OpenCL",
        () -> RayTracer.open(SceneSource.builtin("wall"), Check.on("opencl")));
    byte[] wanted;
    try (RayTracer tracer = Check.cpu("wall")) {
      wanted = Check.draw(tracer, RenderOptions.defaults(), 32, 24);
    }
    try (RayTracer tracer = RayTracer.open(SceneSource.builtin("wall"))) {
      Check.equal("cpu", tracer.deviceInfo().getBackend());
      String notices = tracer.deviceInfo().getNotices().toString();
      Check.that(notices.contains("OpenCL"), notices);
      RayTracerException cause = tracer.deviceInfo().getPassedOver().get(0);
      Check.equal(RayTracerException.Code.NO_OPENCL, cause.getCode());
      OpenClReport report = OpenClReport.look(OpenOptions.defaults());
      Check.that(report.getDevices().isEmpty(), report.toString());
      Check.that(!report.getSkipped().isEmpty() || !report.getRefused().isEmpty(), "no reason");
      Check.same(wanted, Check.draw(tracer, RenderOptions.defaults(), 32, 24), "without OpenCL");
    }
    System.out.println("done");
  }
}
