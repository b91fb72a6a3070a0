// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy;

import java.util.Collections;
import java.util.LinkedHashMap;
import java.util.Locale;
import java.util.Map;

/** What a frame cost, and how many of its samples went which way. A value that does not change. */
public final class FrameStats {
  private final int width;
  private final int height;
  private final double frameMillis;
  private final Map<String, Double> stagesMillis;
  private final long[] counts;
  private final long[] sums;

  /**
   * Called by native code.
   *
   * @param counts base, traced, interpolated, corrected, fell back (1 or 0)
   * @param sums nothing, or primary, shadow, reflection, refraction rays, traversal steps, triangle
   *     tests, shaded points
   */
  FrameStats(
      int width,
      int height,
      double frameMillis,
      String[] stages,
      double[] stagesMillis,
      long[] counts,
      long[] sums) {
    this.width = width;
    this.height = height;
    this.frameMillis = frameMillis;
    Map<String, Double> byName = new LinkedHashMap<>();
    for (int at = 0; at < stages.length; at++) {
      byName.put(stages[at], stagesMillis[at]);
    }
    this.stagesMillis = Collections.unmodifiableMap(byName);
    this.counts = counts;
    this.sums = sums;
  }

  /** Width of the picture in pixels. */
  public int getWidth() {
    return width;
  }

  /** Height of the picture in pixels. */
  public int getHeight() {
    return height;
  }

  /** The whole frame, until its pixels are in the library's memory, in milliseconds. */
  public double getFrameMillis() {
    return frameMillis;
  }

  /** The device's time in each stage, in milliseconds, in the order in which they come. */
  public Map<String, Double> getStagesMillis() {
    return stagesMillis;
  }

  /** Samples that are always traced. */
  public long getBase() {
    return counts[0];
  }

  /** Samples that were traced because a test failed. */
  public long getTraced() {
    return counts[1];
  }

  /** Samples that were rebuilt from their neighbours. */
  public long getInterpolated() {
    return counts[2];
  }

  /** Samples that post-correction traced. */
  public long getCorrected() {
    return counts[3];
  }

  /** Share of the samples that had rays, from 0 to 1, correction included. */
  public double getTracedShare() {
    long traced = counts[0] + counts[1] + counts[3];
    return (double) traced / Math.max(1, traced + counts[2]);
  }

  /**
   * Whether every pixel had rays although the frame was to be adaptive: that is cheaper here, or
   * detail might have been lost.
   */
  public boolean isFellBack() {
    return counts[4] != 0;
  }

  /** Whether rays and work were counted: {@link RenderOptions.Builder#counters}. */
  public boolean hasCounters() {
    return sums.length != 0;
  }

  private long sum(int at) {
    if (!hasCounters()) {
      throw new IllegalStateException(
          "this frame was drawn without RenderOptions.Builder.counters(true)");
    }
    return sums[at];
  }

  /**
   * Rays from the eye.
   *
   * @throws IllegalStateException without counters
   */
  public long getPrimaryRays() {
    return sum(0);
  }

  /**
   * Rays towards lights.
   *
   * @throws IllegalStateException without counters
   */
  public long getShadowRays() {
    return sum(1);
  }

  /**
   * Rays off mirrors and glass.
   *
   * @throws IllegalStateException without counters
   */
  public long getReflectionRays() {
    return sum(2);
  }

  /**
   * Rays through glass.
   *
   * @throws IllegalStateException without counters
   */
  public long getRefractionRays() {
    return sum(3);
  }

  /**
   * Inner nodes of the kd-tree that rays visited.
   *
   * @throws IllegalStateException without counters
   */
  public long getTraversalSteps() {
    return sum(4);
  }

  /**
   * Triangles that were tested against rays.
   *
   * @throws IllegalStateException without counters
   */
  public long getTriangleTests() {
    return sum(5);
  }

  /**
   * Surface points that were shaded.
   *
   * @throws IllegalStateException without counters
   */
  public long getShadedPoints() {
    return sum(6);
  }

  @Override
  public String toString() {
    return String.format(
        Locale.ROOT,
        "%dx%d in %.1f ms, %.1f %% traced",
        width,
        height,
        frameMillis,
        100 * getTracedShare());
  }
}
