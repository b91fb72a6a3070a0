// SPDX-License-Identifier: MIT OR Apache-2.0
package app;

import android.graphics.Bitmap;
import android.view.Surface;
import dev.rarefy.BitmapTarget;
import dev.rarefy.RayTracer;
import dev.rarefy.RenderOptions;
import dev.rarefy.SurfaceTarget;

/** What only a phone can run: a class of its own, since a desktop lacks the ones it names. */
public final class OnPhone {
  private OnPhone() {}

  public static void draw(RayTracer tracer, Bitmap bitmap, Surface surface) {
    tracer.render(RenderOptions.defaults(), BitmapTarget.of(bitmap));
    tracer.render(RenderOptions.defaults(), SurfaceTarget.of(surface));
  }
}
