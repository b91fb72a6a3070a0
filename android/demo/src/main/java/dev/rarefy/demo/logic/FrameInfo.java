// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo.logic;

import dev.rarefy.Camera;
import dev.rarefy.FrameStats;
import org.jspecify.annotations.Nullable;

/** What is known of the frame on the screen. A value that does not change. */
public final class FrameInfo {
  private final Camera camera;
  private final FrameStats stats;
  private final boolean full;
  private final boolean refined;
  private final double fullMillis;
  private final long rays;

  FrameInfo(
      Camera camera,
      FrameStats stats,
      boolean full,
      boolean refined,
      double fullMillis,
      long rays) {
    this.camera = camera;
    this.stats = stats;
    this.full = full;
    this.refined = refined;
    this.fullMillis = fullMillis;
    this.rays = rays;
  }

  /** Where it was seen from. */
  public Camera camera() {
    return camera;
  }

  /** What it cost: the adaptive frame's figures where there is one. */
  public FrameStats stats() {
    return stats;
  }

  /** Whether there is a full frame only. */
  public boolean isFull() {
    return full;
  }

  /** Whether it has the resolution of the settings; else it is one of those of a moving finger. */
  public boolean isRefined() {
    return refined;
  }

  /** How many times as fast as full tracing it was; null while that is not known. */
  public @Nullable Double speedup() {
    boolean known = !full && fullMillis > 0 && stats.getFrameMillis() > 0;
    return known ? fullMillis / stats.getFrameMillis() : null;
  }

  /** Rays of all kinds; null while they are not counted. */
  public @Nullable Long rays() {
    return rays >= 0 ? rays : null;
  }

  FrameInfo measured(double fullMillis, long rays) {
    return new FrameInfo(camera, stats, full, refined, fullMillis, rays);
  }

  static long raysOf(FrameStats counted) {
    return counted.getPrimaryRays()
        + counted.getShadowRays()
        + counted.getReflectionRays()
        + counted.getRefractionRays();
  }
}
