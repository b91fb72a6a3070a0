// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo.logic;

import dev.rarefy.RenderOptions;
import java.util.Locale;

/**
 * A tolerance of the method as a slider has it: its range in equal steps, and what the methods say.
 */
public enum Tolerance {
  /** Largest distance, as a share of the scene's size. */
  T_POS(0, 0.3f, 0.06f, 0.03f, 0.03f),
  /** Least dot product of normals. */
  T_NORM(0, 1, 0.9f, 0.9f, 0.9f),
  /** Sine of the slope below which a surface counts as flat. */
  T_CONV(0, 1, 0.2f, 0.2f, 0.05f),
  /** How far apart texture coordinates may be. */
  T_TEX(0, 1, 0.5f, 0.5f, 0.3f),
  /** Largest distance of reflected colours. */
  T_GCOL(0, 0.5f, 0.05f, 0.09f, 0.15f);

  /** How many steps a slider has. */
  public static final int STEPS = 200;

  private final float least;
  private final float most;
  private final float fine;
  private final float coarse;
  private final float paper;

  Tolerance(float least, float most, float fine, float coarse, float paper) {
    this.least = least;
    this.most = most;
    this.fine = fine;
    this.coarse = coarse;
    this.paper = paper;
  }

  /** The name under which it is saved: {@code t_pos} and so on. */
  public String key() {
    return name().toLowerCase(Locale.ROOT);
  }

  /** The least value of the slider. */
  public float least() {
    return least;
  }

  /** The largest value of the slider. */
  public float most() {
    return most;
  }

  /**
   * What a method says for references two pixels apart, or, if {@code coarse}, four; the slider
   * sets both to one value.
   */
  public float ofMethod(RenderOptions.Method method, boolean coarse) {
    if (method == RenderOptions.Method.PAPER) {
      return paper;
    }
    return coarse ? this.coarse : fine;
  }

  /** The value at a step of the slider. */
  public float atStep(int step) {
    int inside = Math.max(0, Math.min(STEPS, step));
    return least + (most - least) * inside / STEPS;
  }

  /** The step that is nearest to a value. */
  public int stepOf(float value) {
    float inside = Math.max(least, Math.min(most, value));
    return Math.round((inside - least) / (most - least) * STEPS);
  }

  boolean allows(float value) {
    return value >= least && value <= most;
  }

  RenderOptions.Builder into(RenderOptions.Builder builder, float value) {
    switch (this) {
      case T_POS:
        return builder.tPos(value);
      case T_NORM:
        return builder.tNorm(value);
      case T_CONV:
        return builder.tConv(value);
      case T_TEX:
        return builder.tTex(value);
      case T_GCOL:
        return builder.tGcol(value);
    }
    throw new AssertionError(this);
  }
}
