// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo;

import android.graphics.Bitmap;
import android.graphics.BitmapFactory;
import android.graphics.Color;
import java.io.File;
import java.io.FileOutputStream;
import java.io.IOException;
import java.io.OutputStream;

/**
 * Stored pictures of screens, at half their size. A screen may differ by a little in few pixels:
 * another compiler rounds the scene's colours in another way. To renew them: {@code
 * android/screens.sh bless}; look at them before they are stored.
 */
final class Golden {
  /** Steps of 255 by which a channel of a pixel may differ. */
  private static final int MOST_STEPS = 24;

  /** Share of the pixels that may differ by more: less than a word has. */
  private static final double MOST_PIXELS = 0.0005;

  private static final File STORED = new File(System.getProperty("rarefy.screens.golden"));
  private static final File SEEN = new File(System.getProperty("rarefy.screens.out"));
  private static final boolean BLESS = Boolean.getBoolean("rarefy.screens.bless");

  private Golden() {}

  /** Keeps a screen in its full size, to be looked at. */
  static void keep(String name, Bitmap screen) {
    write(new File(SEEN, name + ".png"), screen);
  }

  /** Keeps a screen, and compares it with the stored one of this name. */
  static void check(String name, Bitmap screen) {
    keep(name, screen);
    Bitmap small = half(screen);
    File file = new File(STORED, name + ".png");
    if (BLESS) {
      write(file, small);
      return;
    }
    Bitmap stored = BitmapFactory.decodeFile(file.getPath());
    if (stored == null) {
      throw new AssertionError("no stored screen " + file + "; android/screens.sh bless makes it");
    }
    double share = differingShare(stored, small);
    if (share > MOST_PIXELS) {
      throw new AssertionError(
          name
              + ": "
              + 100 * share
              + " % of the pixels are not as stored; look at "
              + new File(SEEN, name + ".png")
              + ", and android/screens.sh bless if that is right");
    }
    // The control: the same screen with a word's worth of other pixels is not taken for it.
    Bitmap changed = small.copy(Bitmap.Config.ARGB_8888, true);
    int width = changed.getWidth() / 8;
    for (int y = 0; y < changed.getHeight() / 80; y++) {
      for (int x = 0; x < width; x++) {
        int at = changed.getPixel(x + width, y + changed.getHeight() / 2);
        changed.setPixel(x + width, y + changed.getHeight() / 2, at ^ 0x00808080);
      }
    }
    if (differingShare(stored, changed) <= MOST_PIXELS) {
      throw new AssertionError(name + ": a changed screen is not noticed");
    }
  }

  /** Share of the pixels that are not alike, from 0 to 1; 1 for pictures of different sizes. */
  static double differingShare(Bitmap a, Bitmap b) {
    int width = a.getWidth();
    int height = a.getHeight();
    if (b.getWidth() != width || b.getHeight() != height) {
      return 1;
    }
    int[] one = new int[width * height];
    int[] other = new int[width * height];
    a.getPixels(one, 0, width, 0, 0, width, height);
    b.getPixels(other, 0, width, 0, 0, width, height);
    int differing = 0;
    for (int at = 0; at < one.length; at++) {
      int steps =
          Math.max(
              Math.abs(Color.red(one[at]) - Color.red(other[at])),
              Math.max(
                  Math.abs(Color.green(one[at]) - Color.green(other[at])),
                  Math.abs(Color.blue(one[at]) - Color.blue(other[at]))));
      if (steps > MOST_STEPS) {
        differing++;
      }
    }
    return (double) differing / one.length;
  }

  /** Half the size, each pixel the mean of four. */
  private static Bitmap half(Bitmap screen) {
    int width = screen.getWidth() / 2;
    int height = screen.getHeight() / 2;
    int[] all = new int[screen.getWidth() * screen.getHeight()];
    screen.getPixels(all, 0, screen.getWidth(), 0, 0, screen.getWidth(), screen.getHeight());
    int[] means = new int[width * height];
    for (int y = 0; y < height; y++) {
      for (int x = 0; x < width; x++) {
        int mean = 0xff;
        for (int shift = 16; shift >= 0; shift -= 8) {
          int sum = 2;
          for (int part = 0; part < 4; part++) {
            int at = (2 * y + part / 2) * screen.getWidth() + 2 * x + part % 2;
            sum += (all[at] >> shift) & 0xff;
          }
          // Sixteen steps a channel: small files.
          mean = mean << 8 | ((sum / 4) & 0xf0);
        }
        means[y * width + x] = mean;
      }
    }
    return Bitmap.createBitmap(means, width, height, Bitmap.Config.ARGB_8888);
  }

  private static void write(File file, Bitmap picture) {
    try (OutputStream out = new FileOutputStream(file)) {
      picture.compress(Bitmap.CompressFormat.PNG, 100, out);
    } catch (IOException e) {
      throw new AssertionError(e);
    }
  }
}
