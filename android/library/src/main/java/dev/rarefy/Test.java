// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy;

/**
 * The tests that two traced pixels must pass before a pixel between them is rebuilt without a ray.
 */
public enum Test {
  /** Same object. */
  G1("g1"),
  /** Close positions. */
  G2("g2"),
  /** Similar normals. */
  G3("g3"),
  /** No fold between them. */
  G4("g4"),
  /** Same repetition of the texture. */
  TX("tx"),
  /** Same shadows. */
  SH("sh"),
  /** Similar reflected light. */
  GC("gc");

  final String nativeName;

  Test(String nativeName) {
    this.nativeName = nativeName;
  }
}
