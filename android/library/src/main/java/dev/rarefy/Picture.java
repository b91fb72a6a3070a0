// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy;

/** A picture of what a frame knew, see {@link RayTracer#layer}. */
public final class Picture {
  private final int width;
  private final int height;
  private final int[] argb;

  /** Called by native code. */
  Picture(int width, int height, int[] argb) {
    this.width = width;
    this.height = height;
    this.argb = argb;
  }

  /** Width in pixels. */
  public int getWidth() {
    return width;
  }

  /** Height in pixels. */
  public int getHeight() {
    return height;
  }

  /**
   * The pixels, rows from the top, as {@code android.graphics.Bitmap.setPixels} takes them: alpha
   * (255) in the highest byte, then red, green, blue; sRGB. The array itself, not a copy.
   */
  public int[] getArgb() {
    return argb;
  }

  @Override
  public String toString() {
    return "Picture of " + width + "x" + height;
  }
}
