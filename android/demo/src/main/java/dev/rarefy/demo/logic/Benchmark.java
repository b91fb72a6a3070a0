// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo.logic;

import dev.rarefy.DeviceInfo;
import dev.rarefy.FrameStats;
import dev.rarefy.Layer;
import dev.rarefy.Picture;
import dev.rarefy.RayTracer;
import dev.rarefy.RenderOptions;
import java.nio.ByteBuffer;
import java.util.ArrayList;
import java.util.Arrays;
import java.util.LinkedHashMap;
import java.util.List;
import java.util.Locale;
import java.util.Map;
import org.jspecify.annotations.Nullable;

/**
 * Full against adaptive tracing of each method, one sample a pixel. Its JSON has the names of
 * {@code rarefy compare --json}; what the library does not tell here is null. Where the method does
 * not pay, the library draws adaptive frames in full, as it does for the user: {@code fell_back}
 * says so.
 */
public final class Benchmark {
  private static final Layer[] TESTS = {
    Layer.TEST_G1,
    Layer.TEST_G2,
    Layer.TEST_G3,
    Layer.TEST_G4,
    Layer.TEST_TX,
    Layer.TEST_SH,
    Layer.TEST_GC
  };

  private static final int WHITE = 0xffffff;

  private final RayTracer tracer;
  private final Plan plan;
  private final Watch watch;
  private final List<Line> lines = new ArrayList<>();
  private int done;

  private Benchmark(RayTracer tracer, Plan plan, Watch watch) {
    this.tracer = tracer;
    this.plan = plan;
    this.watch = watch;
  }

  /** What is measured. A value that does not change. */
  public static final class Plan {
    private final String scene;
    private final int width;
    private final int height;
    private final int frames;

    /**
     * A plan.
     *
     * @param scene the scene's name, for the report
     * @param width size of the picture in pixels
     * @param height likewise
     * @param frames how many frames of each kind are timed; their median counts
     */
    public Plan(String scene, int width, int height, int frames) {
      this.scene = scene;
      this.width = width;
      this.height = height;
      this.frames = Math.max(1, frames);
    }
  }

  /** What came of it. */
  public static final class Result {
    private final String json;
    private final List<Line> lines;

    Result(String json, List<Line> lines) {
      this.json = json;
      this.lines = lines;
    }

    /** All figures, to be shared. */
    public String json() {
      return json;
    }

    /** The most important ones, a line for each method. */
    public List<Line> lines() {
      return lines;
    }
  }

  /** A method's figures. */
  public static final class Line {
    final RenderOptions.Method method;
    final double fullMillis;
    final double adaptiveMillis;
    final double tracedShare;

    Line(
        RenderOptions.Method method, double fullMillis, double adaptiveMillis, double tracedShare) {
      this.method = method;
      this.fullMillis = fullMillis;
      this.adaptiveMillis = adaptiveMillis;
      this.tracedShare = tracedShare;
    }
  }

  /** Hears how far the benchmark is. */
  interface Watch {
    /** From 0 to 1. Whether to go on. */
    boolean goesOn(float share);
  }

  private static final class Stopped extends RuntimeException {
    private static final long serialVersionUID = 1;
  }

  /** The result; null if the watch said stop. */
  static @Nullable Result run(RayTracer tracer, Plan plan, Watch watch) {
    Benchmark benchmark = new Benchmark(tracer, plan, watch);
    List<Object> rows = new ArrayList<>();
    try {
      for (RenderOptions.Method method : RenderOptions.Method.values()) {
        rows.add(benchmark.row(method));
      }
    } catch (Stopped e) {
      return null;
    }
    Map<String, @Nullable Object> all = new LinkedHashMap<>();
    all.put("rarefy", RayTracer.version());
    all.put("rows", rows);
    return new Result(Json.text(all), benchmark.lines);
  }

  /** Frames of a kind, and what they cost. */
  private final class Timed {
    private final RenderOptions options;
    private final ByteBuffer pixels = RayTracer.allocate(plan.width, plan.height);
    private final List<Double> millis = new ArrayList<>();
    private final Map<String, List<Double>> stages = new LinkedHashMap<>();

    Timed(RenderOptions options) {
      this.options = options;
    }

    void time() {
      FrameStats stats = draw(options, pixels);
      millis.add(stats.getFrameMillis());
      double other = stats.getFrameMillis();
      for (Map.Entry<String, Double> stage : stats.getStagesMillis().entrySet()) {
        add(stage.getKey(), stage.getValue());
        other -= stage.getValue();
      }
      add("other", other);
    }

    private void add(String stage, double took) {
      List<Double> times = stages.get(stage);
      if (times == null) {
        times = new ArrayList<>();
        stages.put(stage, times);
      }
      times.add(took);
    }

    double frameMillis() {
      return median(millis);
    }
  }

  private FrameStats draw(RenderOptions options, ByteBuffer pixels) {
    // Of each method: a first frame, the timed ones, a counted one; twice, for full and adaptive.
    int all = RenderOptions.Method.values().length * 2 * (plan.frames + 2);
    if (!watch.goesOn((float) done / all)) {
      throw new Stopped();
    }
    done++;
    return tracer.render(options, pixels);
  }

  private Map<String, @Nullable Object> row(RenderOptions.Method method) {
    RenderOptions adaptiveOptions =
        RenderOptions.builder().method(method).size(plan.width, plan.height).build();
    RenderOptions fullOptions = adaptiveOptions.toBuilder().mode(RenderOptions.Mode.FULL).build();
    Timed full = new Timed(fullOptions);
    Timed adaptive = new Timed(adaptiveOptions);
    // The first frame of a kind takes memory and wakes the device.
    draw(fullOptions, full.pixels);
    draw(adaptiveOptions, adaptive.pixels);
    for (int frame = 0; frame < plan.frames; frame++) {
      full.time();
      adaptive.time();
    }
    FrameStats fullCounts = draw(counted(fullOptions), full.pixels);
    // One layer of a test keeps what all of them need.
    FrameStats counts =
        draw(counted(adaptiveOptions).toBuilder().keepLayer(TESTS[0]).build(), adaptive.pixels);
    Map<String, @Nullable Object> row = new LinkedHashMap<>();
    row.put("scene", plan.scene);
    row.put("triangles", null);
    row.put("width", plan.width);
    row.put("height", plan.height);
    row.put("samples_per_axis", 1);
    row.put("method", method.name().toLowerCase(Locale.ROOT));
    row.put("block", method == RenderOptions.Method.FAST ? 4 : 2);
    row.put("frames", plan.frames);
    row.put("device", device());
    row.put("build", unknown("load_ms", "kdtree_ms", "upload_ms", "program_ms"));
    row.put("full", costs(full, fullCounts));
    row.put("adaptive", adaptive(adaptive, counts));
    double all = (double) plan.width * plan.height;
    double speedup = full.frameMillis() / adaptive.frameMillis();
    row.put("ray_traced_ratio", (counts.getBase() + counts.getTraced()) / all);
    row.put("ray_traced_ratio_with_correction", counts.getTracedShare());
    row.put("speedup", speedup);
    row.put("work_speedup", work(fullCounts) / work(counts));
    row.put("efficiency", speedup * counts.getTracedShare());
    row.put("psnr_db", Composer.psnr(full.pixels, adaptive.pixels, plan.width * plan.height));
    row.putAll(
        unknown(
            "ssim",
            "flip_mean",
            "flip_p99",
            "wrong_object_pixels",
            "wrong_shadow_pixels",
            "peak_device_bytes"));
    lines.add(
        new Line(method, full.frameMillis(), adaptive.frameMillis(), counts.getTracedShare()));
    return row;
  }

  private static Map<String, @Nullable Object> unknown(String... names) {
    Map<String, @Nullable Object> unknown = new LinkedHashMap<>();
    for (String name : names) {
      unknown.put(name, null);
    }
    return unknown;
  }

  private static RenderOptions counted(RenderOptions options) {
    return options.toBuilder().counters(true).build();
  }

  private static double work(FrameStats stats) {
    return (double) stats.getTraversalSteps() + stats.getTriangleTests();
  }

  private Map<String, Object> device() {
    DeviceInfo info = tracer.deviceInfo();
    Map<String, Object> device = new LinkedHashMap<>();
    device.put("name", info.getName());
    device.put("version", info.getVersion());
    device.put("backend", info.getBackend());
    device.put("profile", info.getProfile());
    return device;
  }

  private static Map<String, @Nullable Object> costs(Timed timed, FrameStats counts) {
    Map<String, @Nullable Object> rays = new LinkedHashMap<>();
    rays.put("primary", counts.getPrimaryRays());
    rays.put("shadow", counts.getShadowRays());
    rays.put("reflection", counts.getReflectionRays());
    rays.put("refraction", counts.getRefractionRays());
    Map<String, @Nullable Object> work = new LinkedHashMap<>();
    work.put("traversal_steps", counts.getTraversalSteps());
    work.put("triangle_tests", counts.getTriangleTests());
    work.put("shaded_pixels", counts.getShadedPoints());
    Map<String, @Nullable Object> costs = new LinkedHashMap<>();
    costs.put("frame_ms", timed.frameMillis());
    costs.put("rays", rays);
    costs.put("work", work);
    return costs;
  }

  private Map<String, @Nullable Object> adaptive(Timed timed, FrameStats counts) {
    Map<String, @Nullable Object> pixels = new LinkedHashMap<>();
    pixels.put("base", counts.getBase());
    pixels.put("traced", counts.getTraced());
    pixels.put("interpolated", counts.getInterpolated());
    pixels.put("corrected", counts.getCorrected());
    Map<String, @Nullable Object> stages = new LinkedHashMap<>();
    for (Map.Entry<String, List<Double>> stage : timed.stages.entrySet()) {
      stages.put(stage.getKey(), median(stage.getValue()));
    }
    Map<String, @Nullable Object> failed = new LinkedHashMap<>();
    for (Layer test : TESTS) {
      failed.put(test.name().substring("TEST_".length()).toLowerCase(Locale.ROOT), white(test));
    }
    Map<String, @Nullable Object> costs = costs(timed, counts);
    costs.put("pixels", pixels);
    costs.put("stages_ms", stages);
    costs.put("failed_tests", failed);
    costs.put("fell_back", counts.isFellBack());
    return costs;
  }

  /** How many pixels failed a test. */
  private int white(Layer test) {
    Picture picture = tracer.layer(test);
    int count = 0;
    for (int pixel : picture.getArgb()) {
      count += (pixel & WHITE) == WHITE ? 1 : 0;
    }
    return count;
  }

  private static double median(List<Double> values) {
    double[] sorted = new double[values.size()];
    for (int at = 0; at < sorted.length; at++) {
      sorted[at] = values.get(at);
    }
    Arrays.sort(sorted);
    int middle = sorted.length / 2;
    return sorted.length % 2 == 1 ? sorted[middle] : (sorted[middle - 1] + sorted[middle]) / 2;
  }
}
