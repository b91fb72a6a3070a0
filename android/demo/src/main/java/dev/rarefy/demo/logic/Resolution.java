// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo.logic;

/** How large frames are: the screen's size, less what the settings, heat and memory take off. */
final class Resolution {
  /** What a frame may take while a finger moves. */
  static final double COARSE_MILLIS = 50;

  private static final double STEPS = 16;
  private static final double LEAST_COARSE = 0.125;
  private static final double LEAST_MEMORY = 1.0 / 16;

  private double coarse = 0.5;
  private double memory = 1;

  /** The size of a side in pixels. */
  static int side(int screen, double scale) {
    return Math.max(1, Math.min(16384, (int) Math.round(screen * scale)));
  }

  /** The share of a refined frame's sides that is drawn while a finger moves. */
  double coarse() {
    // In steps, so that not every frame has a size of its own, and memory of its own with it.
    return Math.max(LEAST_COARSE, Math.round(coarse * STEPS) / STEPS);
  }

  /** What memory leaves of the sides. */
  double memory() {
    return memory;
  }

  /** A frame took this long at {@code scale} of a refined one's sides. */
  void took(double millis, double scale) {
    if (!(millis > 0)) {
      return;
    }
    double fitting = scale * Math.sqrt(COARSE_MILLIS / millis);
    // Half way each time, so that one slow frame does not make the picture jump.
    coarse = Math.max(LEAST_COARSE, Math.min(1, (coarse + fitting) / 2));
  }

  /** There was not enough memory. Whether a smaller frame can be tried. */
  boolean shrink() {
    if (memory <= LEAST_MEMORY) {
      return false;
    }
    memory /= 2;
    return true;
  }

  /** The user chose anew: memory is tried anew, too. */
  void restore() {
    memory = 1;
  }
}
