// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo.logic;

import dev.rarefy.Picture;
import java.nio.Buffer;
import java.nio.ByteBuffer;

/** Pictures made of two pictures. All have four bytes a pixel: red, green, blue, alpha. */
public final class Composer {
  private static final int GAIN = 10;

  private Composer() {}

  /**
   * The left picture up to a column, the right one from there on.
   *
   * @param column from 0 (all is {@code right}) to {@code width}
   */
  public static void split(
      ByteBuffer left, ByteBuffer right, ByteBuffer into, int width, int height, int column) {
    byte[] row = new byte[width * 4];
    for (int y = 0; y < height; y++) {
      int at = y * row.length;
      copy(left, at, row, 0, column * 4);
      copy(right, at + column * 4, row, column * 4, row.length - column * 4);
      put(into, at, row);
    }
  }

  /** Ten times the difference of each channel, limited to white. */
  public static void difference(
      ByteBuffer one, ByteBuffer other, ByteBuffer into, int width, int height) {
    byte[] row = new byte[width * 4];
    byte[] second = new byte[width * 4];
    for (int y = 0; y < height; y++) {
      int at = y * row.length;
      copy(one, at, row, 0, row.length);
      copy(other, at, second, 0, row.length);
      for (int x = 0; x < row.length; x++) {
        int apart = Math.abs((row[x] & 255) - (second[x] & 255)) * GAIN;
        row[x] = (byte) ((x & 3) == 3 ? 255 : Math.min(255, apart));
      }
      put(into, at, row);
    }
  }

  /** A layer at the size of a frame, of whose pixels it may have several samples. */
  public static void layer(Picture layer, ByteBuffer into, int width, int height) {
    int[] argb = layer.getArgb();
    byte[] row = new byte[width * 4];
    for (int y = 0; y < height; y++) {
      int line = (int) ((long) y * layer.getHeight() / height) * layer.getWidth();
      for (int x = 0; x < width; x++) {
        int pixel = argb[line + (int) ((long) x * layer.getWidth() / width)];
        row[4 * x] = (byte) (pixel >> 16);
        row[4 * x + 1] = (byte) (pixel >> 8);
        row[4 * x + 2] = (byte) pixel;
        row[4 * x + 3] = (byte) (pixel >>> 24);
      }
      put(into, y * row.length, row);
    }
  }

  /** Peak signal-to-noise ratio in decibel, three channels pooled; infinite for equal pictures. */
  public static double psnr(ByteBuffer one, ByteBuffer other, int pixels) {
    byte[] first = new byte[pixels * 4];
    byte[] second = new byte[pixels * 4];
    copy(one, 0, first, 0, first.length);
    copy(other, 0, second, 0, second.length);
    double squares = 0;
    for (int at = 0; at < first.length; at++) {
      int apart = (at & 3) == 3 ? 0 : (first[at] & 255) - (second[at] & 255);
      squares += (double) apart * apart;
    }
    double mean = squares / (3.0 * pixels);
    return mean == 0 ? Double.POSITIVE_INFINITY : 10 * Math.log10(255.0 * 255.0 / mean);
  }

  // Buffer's method, not ByteBuffer's own: old versions of Android do not have that one.
  private static void goTo(Buffer buffer, int at) {
    buffer.position(at);
  }

  private static void copy(ByteBuffer from, int at, byte[] into, int offset, int length) {
    ByteBuffer view = from.duplicate();
    goTo(view, at);
    view.get(into, offset, length);
  }

  private static void put(ByteBuffer into, int at, byte[] row) {
    ByteBuffer view = into.duplicate();
    goTo(view, at);
    view.put(row);
  }
}
