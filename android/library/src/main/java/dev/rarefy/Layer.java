// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy;

/** What of a frame can be looked at, see {@link RayTracer#layer}. */
public enum Layer {
  /** Base pixels grey, traced orange, interpolated dark blue, corrected red, confirmed yellow. */
  CLASS("class"),
  /** Each failed test in its own colour, added up. */
  FAIL_MASK("fail-mask"),
  /** White where {@link Test#G1} failed. */
  TEST_G1("test-g1"),
  /** White where {@link Test#G2} failed. */
  TEST_G2("test-g2"),
  /** White where {@link Test#G3} failed. */
  TEST_G3("test-g3"),
  /** White where {@link Test#G4} failed. */
  TEST_G4("test-g4"),
  /** White where {@link Test#TX} failed. */
  TEST_TX("test-tx"),
  /** White where {@link Test#SH} failed. */
  TEST_SH("test-sh"),
  /** White where {@link Test#GC} failed. */
  TEST_GC("test-gc"),
  /** A colour per object. */
  OBJECT("object"),
  /** The shading normal: red, green, blue for x, y, z from -1 to 1. */
  NORMAL("normal"),
  /** Distance from the eye: near is bright. */
  DEPTH("depth"),
  /** Share of lights that do not reach the point: white is fully lit. */
  SHADOW("shadow"),
  /** What a pixel cost: blue, green, yellow, red for more. */
  RAYS("rays");

  final String nativeName;

  Layer(String nativeName) {
    this.nativeName = nativeName;
  }
}
