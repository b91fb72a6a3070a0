// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy;

import java.io.File;
import java.io.FileInputStream;
import java.io.RandomAccessFile;
import java.nio.ByteBuffer;
import java.nio.file.Files;
import java.util.Arrays;
import java.util.Collections;
import java.util.concurrent.atomic.AtomicInteger;

/**
 * Draws pictures for a comparison with the command line's: DEVICE SCENE-FOLDER BAKED-SCENE
 * OUTPUT-FOLDER.
 */
final class PictureTest {
  private PictureTest() {}

  public static void main(String[] arguments) throws Exception {
    String device = arguments[0];
    File folder = new File(arguments[1]);
    File baked = new File(arguments[2]);
    String out = arguments[3] + "/";
    try (RayTracer tracer = RayTracer.open(SceneSource.files(folder), Check.on(device))) {
      System.out.println("device: " + tracer.deviceInfo().getBackend());
      Check.equal(null == tracer.stats(), true);
      Check.that(tracer.deviceInfo().getPassedOver().isEmpty(), "something was passed over");
      OpenClReport report = OpenClReport.look(OpenOptions.defaults());
      boolean opencl = report.getLibrary() != null && !report.getDevices().isEmpty();
      Check.that(opencl || device.equals("cpu"), report.toString());
      Check.equal(report.getDevices().size(), report.getProfiles().size());
      for (int at = 0; at < report.getProfiles().size(); at++) {
        String name = report.getDevices().get(at).split(", ")[0];
        String profile = report.getProfiles().get(at);
        Check.that(profile.contains(name) && profile.contains("\"limits\": {"), profile);
      }
      byte[] balanced = Check.draw(tracer, RenderOptions.defaults(), 96, 64);
      Check.write(out + "balanced", balanced);
      RenderOptions fast =
          RenderOptions.builder().method(RenderOptions.Method.FAST).samples(2).build();
      Check.write(out + "fast", Check.draw(tracer, fast, 61, 43));
      RenderOptions paper =
          RenderOptions.builder()
              .method(RenderOptions.Method.PAPER)
              .tPos(0.01f)
              .tNorm(0.95f)
              .tConv(0.1f)
              .tTex(0.25f)
              .tGcol(0.1f)
              .disableTest(Test.GC)
              .correction(RenderOptions.Correction.OBJECT)
              .build();
      Check.write(out + "paper", Check.draw(tracer, paper, 96, 64));
      RenderOptions full =
          RenderOptions.builder()
              .mode(RenderOptions.Mode.FULL)
              .depth(2)
              .counters(true)
              .keepLayer(Layer.DEPTH)
              .keepLayer(Layer.RAYS)
              .build();
      Check.write(out + "full", Check.draw(tracer, full, 96, 64));
      statistics(tracer.stats());
      layers(tracer);
      view(tracer, balanced);
      assets(folder, device, balanced);
      baked(baked, device, balanced);
      slices(tracer, balanced);
      previews(tracer, balanced);
    }
    Check.equal(0, Native.openCount());
    System.out.println("done");
  }

  private static void statistics(FrameStats stats) {
    Check.equal(0L, stats.getInterpolated());
    Check.equal(96L * 64, stats.getPrimaryRays());
    Check.that(stats.hasCounters() && stats.getShadowRays() > 0, "rays");
    Check.that(stats.getTriangleTests() > 1000 && stats.getTraversalSteps() > 1000, "work");
    Check.equal(8, stats.getStagesMillis().size());
    Check.that(stats.getStagesMillis().get("step1") > 0, "stages");
    Check.that(stats.getFrameMillis() > 0 && stats.getTracedShare() == 1, "frame");
    Check.that(stats.toString().startsWith("96x64 in "), stats.toString());
  }

  private static void layers(RayTracer tracer) {
    Picture depth = tracer.layer(Layer.DEPTH);
    Check.equal(96 * 64, depth.getArgb().length);
    Check.equal(96, depth.getWidth());
    Check.that(Arrays.stream(depth.getArgb()).distinct().count() > 16, "a flat depth");
    for (int pixel : depth.getArgb()) {
      Check.equal(255, pixel >>> 24);
    }
    Check.that(tracer.layer(Layer.RAYS).getArgb().length == 96 * 64, "rays");
    RayTracerException e =
        Check.coded(
            RayTracerException.Code.MISSING_LAYER,
            "RenderOptions.Builder.keepLayer",
            () -> tracer.layer(Layer.CLASS));
    Check.equal(true, e.getPlace() == null);
    for (Layer layer : Layer.values()) {
      RenderOptions options = RenderOptions.builder().keepLayer(layer).build();
      Check.draw(tracer, options, 16, 12);
      Check.equal(16 * 12, tracer.layer(layer).getArgb().length);
    }
    // The class picture's colours are those of the documentation, red in the upper bytes.
    Check.draw(tracer, RenderOptions.builder().keepLayer(Layer.CLASS).build(), 32, 32);
    Check.equal(0xff6e6e6e, tracer.layer(Layer.CLASS).getArgb()[0]);
  }

  private static void view(RayTracer tracer, byte[] before) {
    Camera camera = tracer.getCamera();
    tracer.setCamera(camera.orbit(30, 10));
    byte[] moved = Check.draw(tracer, RenderOptions.defaults(), 96, 64);
    Check.that(!Arrays.equals(before, moved), "a moved camera shows the same");
    tracer.setCamera(camera);
    Check.equal(camera, tracer.getCamera());
    Check.same(
        before, Check.draw(tracer, RenderOptions.defaults(), 96, 64), "the camera of before");
    java.util.List<Light> lights = tracer.getLights();
    Check.that(!lights.isEmpty(), "no lights");
    tracer.setLights(Collections.emptyList());
    byte[] dark = Check.draw(tracer, RenderOptions.defaults(), 96, 64);
    Check.that(!Arrays.equals(before, dark), "no light shows the same");
    tracer.setLights(lights);
    Check.equal(lights, tracer.getLights());
    Check.same(
        before, Check.draw(tracer, RenderOptions.defaults(), 96, 64), "the lights of before");
  }

  private static void assets(File folder, String device, byte[] wanted) {
    AtomicInteger open = new AtomicInteger();
    AssetReader reader =
        name -> {
          open.incrementAndGet();
          return new FileInputStream(new File(folder, name)) {
            @Override
            public void close() throws java.io.IOException {
              open.decrementAndGet();
              super.close();
            }
          };
        };
    try (RayTracer tracer = RayTracer.open(SceneSource.assets("", reader), Check.on(device))) {
      Check.same(wanted, Check.draw(tracer, RenderOptions.defaults(), 96, 64), "assets");
    }
  }

  private static void baked(File file, String device, byte[] wanted) throws Exception {
    byte[] bytes = Files.readAllBytes(file.toPath());
    File larger = File.createTempFile("larger", null);
    try (RandomAccessFile open = new RandomAccessFile(larger, "rw")) {
      open.seek(777);
      open.write(bytes);
      open.write(new byte[99]);
      open.seek(5);
      int descriptor = descriptor(larger);
      SceneSource[] sources = {
        SceneSource.baked(file),
        SceneSource.baked(larger, 777, bytes.length),
        SceneSource.baked(descriptor, 777, bytes.length)
      };
      for (SceneSource source : sources) {
        try (RayTracer tracer = RayTracer.open(source, Check.on(device))) {
          byte[] drawn = Check.draw(tracer, RenderOptions.defaults(), 96, 64);
          Check.same(wanted, drawn, source.toString());
        }
      }
      Check.equal(5L, open.getFilePointer());
      for (SceneSource wrong :
          new SceneSource[] {
            SceneSource.baked(larger),
            SceneSource.baked(larger, 776, bytes.length),
            SceneSource.baked(larger, 777, bytes.length - 1),
            SceneSource.baked(descriptor, 778, bytes.length)
          }) {
        Check.thrown(RayTracerException.class, () -> RayTracer.open(wrong, Check.on(device)));
      }
      Check.thrown(
          IllegalArgumentException.class, () -> RayTracer.open(SceneSource.baked(larger, -1, 5)));
      Check.thrown(
          IllegalArgumentException.class, () -> RayTracer.open(SceneSource.baked(-1, 0, 5)));
      Check.coded(
          RayTracerException.Code.IO,
          "descriptor",
          () -> RayTracer.open(SceneSource.baked(1 << 20, 0, 5)));
    } finally {
      larger.delete();
    }
  }

  /** The number of an open file. */
  private static int descriptor(File file) throws Exception {
    for (File open : new File("/proc/self/fd").listFiles()) {
      // Those that were closed since lead nowhere.
      if (open.getCanonicalFile().equals(file.getCanonicalFile())) {
        return Integer.parseInt(open.getName());
      }
    }
    throw new AssertionError("no descriptor of " + file);
  }

  private static void slices(RayTracer tracer, byte[] wanted) {
    ByteBuffer large = RayTracer.allocate(96, 66);
    large.position(96 * 4).limit(96 * 65 * 4);
    tracer.render(RenderOptions.ofSize(96, 64), large);
    Check.equal(96 * 4, large.position());
    Check.equal(96 * 65 * 4, large.limit());
    byte[] bytes = new byte[wanted.length];
    large.get(bytes);
    Check.same(wanted, bytes, "from a position on");
    large.clear();
    for (int at = 0; at < 96 * 4; at++) {
      Check.equal((byte) 0, large.get(at));
      Check.equal((byte) 0, large.get(96 * 65 * 4 + at));
    }
  }

  private static void previews(RayTracer tracer, byte[] wanted) {
    int[][] seen = new int[1][];
    AtomicInteger steps = new AtomicInteger();
    float[] last = {0};
    tracer.setPreviewListener(
        (width, height, firstRow, argb) -> {
          Check.equal(48, width);
          Check.equal(32, height);
          Check.equal(0, firstRow);
          seen[0] = argb;
        });
    tracer.setProgressListener(
        (phase, share) -> {
          Check.equal("frame", phase);
          Check.that(share >= last[0] && share <= 1, "progress " + share);
          last[0] = share;
          steps.incrementAndGet();
        });
    Check.same(wanted, Check.draw(tracer, RenderOptions.defaults(), 96, 64), "a watched frame");
    tracer.setPreviewListener(null);
    tracer.setProgressListener(null);
    Check.that(steps.get() > 3 && last[0] == 1, "progress in " + steps + " steps to " + last[0]);
    Check.equal(48 * 32, seen[0].length);
    // The preview's first pixel is the picture's.
    int first = (wanted[0] & 255) << 16 | (wanted[1] & 255) << 8 | wanted[2] & 255 | 0xff000000;
    Check.equal(first, seen[0][0]);
  }
}
