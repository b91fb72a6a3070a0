// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo.logic;

import dev.rarefy.Layer;
import org.jspecify.annotations.Nullable;

/** What of a frame is shown. */
public enum Shown {
  PICTURE(null),
  CLASS(Layer.CLASS),
  FAIL_MASK(Layer.FAIL_MASK),
  TEST_G1(Layer.TEST_G1),
  TEST_G2(Layer.TEST_G2),
  TEST_G3(Layer.TEST_G3),
  TEST_G4(Layer.TEST_G4),
  TEST_TX(Layer.TEST_TX),
  TEST_SH(Layer.TEST_SH),
  TEST_GC(Layer.TEST_GC),
  /** Ten times the difference between the adaptive and the full picture. */
  DIFFERENCE(null);

  private final @Nullable Layer layer;

  Shown(@Nullable Layer layer) {
    this.layer = layer;
  }

  /** The library's layer; null for what is computed from pictures. */
  public @Nullable Layer layer() {
    return layer;
  }
}
