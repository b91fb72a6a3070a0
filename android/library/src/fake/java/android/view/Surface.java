// SPDX-License-Identifier: MIT OR Apache-2.0
package android.view;

import java.nio.ByteBuffer;

/**
 * A Surface of nothing but memory, which android/qemu/targets.c locks. It is not part of what
 * ships.
 */
public final class Surface {
  public final int width;
  public final int height;
  public int format;
  public final ByteBuffer memory;
  public int bufferWidth;
  public int bufferHeight;

  /** How much wider a buffer is than it was asked to be. */
  public int otherWidth;

  public int held;
  public int locks;
  public int posts;
  public int released;
  public int failLock;
  public int failPost;

  public Surface(int width, int height, int format) {
    this.width = width;
    this.height = height;
    this.format = format;
    bufferWidth = width;
    bufferHeight = height;
    memory = ByteBuffer.allocateDirect((width + 64) * (height + 16) * 4);
    for (int at = 0; at < memory.capacity(); at++) {
      memory.put(at, (byte) 0xa5);
    }
  }
}
