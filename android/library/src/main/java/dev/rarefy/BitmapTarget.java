// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy;

import android.graphics.Bitmap;
import org.jspecify.annotations.Nullable;

/**
 * Draws into a {@link Bitmap}: {@code tracer.render(options, BitmapTarget.of(bitmap))}. Nobody may
 * recycle the Bitmap or draw into it meanwhile.
 */
public final class BitmapTarget extends RenderTarget {
  private final Bitmap bitmap;

  private BitmapTarget(Bitmap bitmap) {
    this.bitmap = bitmap;
  }

  /**
   * A Bitmap as a target. A picture that is smaller than the Bitmap is drawn to its upper left.
   *
   * @param bitmap mutable, of {@code ARGB_8888} or {@code RGB_565}
   * @throws IllegalArgumentException for another one
   */
  public static BitmapTarget of(Bitmap bitmap) {
    if (bitmap.isRecycled()) {
      throw new IllegalArgumentException("the Bitmap was recycled");
    }
    if (!bitmap.isMutable()) {
      throw new IllegalArgumentException("the Bitmap is immutable; make a copy that is not");
    }
    Bitmap.Config config = bitmap.getConfig();
    if (config != Bitmap.Config.ARGB_8888 && config != Bitmap.Config.RGB_565) {
      throw new IllegalArgumentException(
          "a Bitmap must be ARGB_8888 or RGB_565, this one is " + config);
    }
    return new BitmapTarget(bitmap);
  }

  @Override
  FrameStats render(
      long handle,
      String[] frame,
      @Nullable ProgressListener progress,
      @Nullable PreviewListener preview) {
    FrameStats stats = Native.renderBitmap(handle, frame, bitmap, progress, preview);
    // Pixels that native code wrote are not known to the views that show them before.
    bitmap.prepareToDraw();
    return stats;
  }
}
