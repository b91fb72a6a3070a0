// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy;

/** Lets tests count what is open. */
public final class Handles {
  private Handles() {}

  /** How many tracers are open. */
  public static int open() {
    return Native.openCount();
  }
}
