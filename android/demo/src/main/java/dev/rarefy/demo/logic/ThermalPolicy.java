// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo.logic;

/** What heat does to the resolution, before the phone slows down by itself. */
public final class ThermalPolicy {
  /** The values of {@code PowerManager.THERMAL_STATUS_...}. */
  static final int MODERATE = 2;

  static final int SEVERE = 3;
  static final int CRITICAL = 4;

  private ThermalPolicy() {}

  /** What width and height are multiplied with; unknown values count as the nearest known one. */
  public static double scale(int status) {
    if (status >= CRITICAL) {
      return 0.25;
    } else if (status >= SEVERE) {
      return 0.5;
    }
    return status >= MODERATE ? 0.75 : 1;
  }

  /** Whether the phone is so hot that nothing is drawn but what the user asks for. */
  public static boolean restsInBackground(int status) {
    return status >= MODERATE;
  }
}
