// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo.logic;

import java.nio.ByteBuffer;

/** Where pictures are shown. Called on the loop's thread only. */
public interface Screen {
  /**
   * Shows a picture, scaled to the screen.
   *
   * @param rgba four bytes a pixel, rows from the top, from position 0 on; not to be kept
   */
  void show(ByteBuffer rgba, int width, int height);
}
