// SPDX-License-Identifier: MIT OR Apache-2.0
package android.graphics;

import java.nio.ByteBuffer;

/**
 * A Bitmap of nothing but memory, which android/qemu/targets.c locks. It is not part of what ships.
 */
public final class Bitmap {
  /** The configurations that the tests need. */
  public enum Config {
    ALPHA_8,
    RGB_565,
    ARGB_8888
  }

  public final int width;
  public final int height;
  public final int strideBytes;
  public int nativeFormat;
  public final ByteBuffer memory;
  public int locks;
  public int unlocks;
  public int failLock;
  public int failUnlock;
  public boolean recycled;
  public boolean mutable = true;
  public int prepared;
  private final Config config;

  public Bitmap(int width, int height, int strideBytes, Config config) {
    this.width = width;
    this.height = height;
    this.strideBytes = strideBytes;
    this.config = config;
    nativeFormat = config == Config.ARGB_8888 ? 1 : config == Config.RGB_565 ? 4 : 8;
    memory = ByteBuffer.allocateDirect(strideBytes * height + 64);
    for (int at = 0; at < memory.capacity(); at++) {
      memory.put(at, (byte) 0xa5);
    }
  }

  public Config getConfig() {
    return config;
  }

  public boolean isRecycled() {
    return recycled;
  }

  public boolean isMutable() {
    return mutable;
  }

  public void prepareToDraw() {
    prepared++;
  }
}
