// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy;

import java.util.Arrays;
import org.jspecify.annotations.Nullable;

/**
 * A point light whose light falls off with the square of the distance. A value that does not
 * change.
 */
public final class Light {
  private final float x;
  private final float y;
  private final float z;
  private final float red;
  private final float green;
  private final float blue;

  /**
   * A light.
   *
   * @param x position, scene units
   * @param y position, scene units
   * @param z position, scene units
   * @param red intensity, linear, times squared scene units; 0 or more
   * @param green intensity, likewise
   * @param blue intensity, likewise
   */
  public Light(float x, float y, float z, float red, float green, float blue) {
    this.x = x;
    this.y = y;
    this.z = z;
    this.red = red;
    this.green = green;
    this.blue = blue;
  }

  /** Position, scene units. */
  public float getX() {
    return x;
  }

  /** Position, scene units. */
  public float getY() {
    return y;
  }

  /** Position, scene units. */
  public float getZ() {
    return z;
  }

  /** Intensity, linear, times squared scene units. */
  public float getRed() {
    return red;
  }

  /** Intensity, linear, times squared scene units. */
  public float getGreen() {
    return green;
  }

  /** Intensity, linear, times squared scene units. */
  public float getBlue() {
    return blue;
  }

  /** The six numbers as native code takes them. */
  float[] numbers() {
    return new float[] {x, y, z, red, green, blue};
  }

  @Override
  public boolean equals(@Nullable Object other) {
    return other instanceof Light && Arrays.equals(numbers(), ((Light) other).numbers());
  }

  @Override
  public int hashCode() {
    return Arrays.hashCode(numbers());
  }

  @Override
  public String toString() {
    return "Light" + Arrays.toString(numbers());
  }
}
