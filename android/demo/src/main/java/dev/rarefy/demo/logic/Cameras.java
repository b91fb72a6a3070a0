// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo.logic;

import dev.rarefy.Camera;
import org.jspecify.annotations.Nullable;

/** Cameras as text, so that they outlive the process. */
public final class Cameras {
  private Cameras() {}

  /** Ten numbers, parted by blanks. */
  public static String toText(Camera camera) {
    StringBuilder text = new StringBuilder();
    for (float[] vector : new float[][] {camera.getEye(), camera.getLookAt(), camera.getUp()}) {
      for (float number : vector) {
        text.append(number).append(' ');
      }
    }
    return text.append(camera.getFovYDegrees()).toString();
  }

  /** The camera of {@link #toText}; null for any other text. */
  public static @Nullable Camera fromText(@Nullable String text) {
    if (text == null) {
      return null;
    }
    String[] parts = text.split(" ", -1);
    if (parts.length != 10) {
      return null;
    }
    float[] n = new float[10];
    try {
      for (int at = 0; at < 10; at++) {
        n[at] = Float.parseFloat(parts[at]);
      }
      return Camera.lookingAt(n[0], n[1], n[2], n[3], n[4], n[5])
          .withUp(n[6], n[7], n[8])
          .withFovYDegrees(n[9]);
    } catch (IllegalArgumentException e) {
      // No number, or numbers that are no camera.
      return null;
    }
  }
}
