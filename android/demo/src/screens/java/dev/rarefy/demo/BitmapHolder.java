// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo;

import android.graphics.Bitmap;
import android.graphics.Canvas;
import android.graphics.Rect;
import android.view.Surface;
import android.view.SurfaceHolder;

/**
 * A surface in memory, since Robolectric's SurfaceView never gets one. Whoever draws must lock and
 * post in turn.
 */
final class BitmapHolder implements SurfaceHolder {
  private final Bitmap drawn;
  private Bitmap shown;
  private boolean locked;
  private boolean lost;
  private int posts;

  BitmapHolder(int width, int height) {
    drawn = Bitmap.createBitmap(width, height, Bitmap.Config.ARGB_8888);
    shown = drawn.copy(Bitmap.Config.ARGB_8888, false);
  }

  /** What was posted last. */
  synchronized Bitmap shown() {
    return shown;
  }

  /** How often something was posted. */
  synchronized int posts() {
    return posts;
  }

  /** Takes the surface away: from now on there is no canvas. */
  synchronized void lose() {
    lost = true;
  }

  @Override
  public synchronized Canvas lockCanvas() {
    if (lost) {
      return null;
    }
    if (locked) {
      throw new IllegalStateException("locked twice");
    }
    locked = true;
    return new Canvas(drawn);
  }

  @Override
  public Canvas lockCanvas(Rect dirty) {
    return lockCanvas();
  }

  @Override
  public synchronized void unlockCanvasAndPost(Canvas canvas) {
    if (!locked) {
      throw new IllegalStateException("posted without a lock");
    }
    locked = false;
    posts++;
    shown = drawn.copy(Bitmap.Config.ARGB_8888, false);
  }

  @Override
  public Rect getSurfaceFrame() {
    return new Rect(0, 0, drawn.getWidth(), drawn.getHeight());
  }

  @Override
  public Surface getSurface() {
    return null;
  }

  @Override
  public void addCallback(Callback callback) {}

  @Override
  public void removeCallback(Callback callback) {}

  @Override
  public boolean isCreating() {
    return false;
  }

  @Override
  @Deprecated
  public void setType(int type) {}

  @Override
  public void setFixedSize(int width, int height) {}

  @Override
  public void setSizeFromLayout() {}

  @Override
  public void setFormat(int format) {}

  @Override
  public void setKeepScreenOn(boolean screenOn) {}
}
