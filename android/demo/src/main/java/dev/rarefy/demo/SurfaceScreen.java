// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo;

import android.graphics.Bitmap;
import android.graphics.Canvas;
import android.graphics.Paint;
import android.graphics.Rect;
import android.view.SurfaceHolder;
import dev.rarefy.demo.logic.Screen;
import java.nio.Buffer;
import java.nio.ByteBuffer;
import org.jspecify.annotations.Nullable;

/** Shows pictures on the surface that Android gave last. */
final class SurfaceScreen implements Screen {
  private final Paint smooth = new Paint(Paint.FILTER_BITMAP_FLAG);
  private @Nullable SurfaceHolder holder;
  private @Nullable Bitmap bitmap;

  /**
   * Another surface, or none: then the old one is not touched any more once this returns, as
   * Android wants it.
   */
  synchronized void setHolder(@Nullable SurfaceHolder holder) {
    this.holder = holder;
    if (holder == null) {
      bitmap = null;
    }
  }

  @Override
  public synchronized void show(ByteBuffer rgba, int width, int height) {
    SurfaceHolder to = holder;
    if (to == null) {
      return;
    }
    Bitmap picture = bitmap;
    if (picture == null || picture.getWidth() != width || picture.getHeight() != height) {
      picture = Bitmap.createBitmap(width, height, Bitmap.Config.ARGB_8888);
      bitmap = picture;
    }
    ByteBuffer pixels = rgba.duplicate();
    // A ByteBuffer's own rewind is newer than API 23.
    ((Buffer) pixels).rewind();
    picture.copyPixelsFromBuffer(pixels);
    Canvas canvas;
    try {
      canvas = to.lockCanvas();
    } catch (IllegalArgumentException | IllegalStateException e) {
      // The surface goes away; surfaceDestroyed follows.
      return;
    }
    if (canvas == null) {
      return;
    }
    try {
      Rect all = new Rect(0, 0, canvas.getWidth(), canvas.getHeight());
      canvas.drawBitmap(picture, null, all, smooth);
    } finally {
      to.unlockCanvasAndPost(canvas);
    }
  }
}
