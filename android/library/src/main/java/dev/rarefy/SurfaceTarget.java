// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy;

import android.view.Surface;
import org.jspecify.annotations.Nullable;

/**
 * Draws onto a {@link Surface} and shows the picture: {@code tracer.render(options,
 * SurfaceTarget.of(holder.getSurface()))}. Nobody else may draw onto that Surface meanwhile.
 *
 * <p>A picture of another size than the Surface's is scaled by Android. A Surface that goes away
 * while a frame is drawn makes the call end with a {@link RayTracerException} of code {@code
 * TARGET_LOST}; the {@link RayTracer} stays as it was, ready for the next Surface. In {@code
 * surfaceDestroyed} call {@link RayTracer#cancel} and wait for the thread that draws.
 */
public final class SurfaceTarget extends RenderTarget {
  private final Surface surface;

  private SurfaceTarget(Surface surface) {
    this.surface = surface;
  }

  /** A Surface as a target; it may be lost at any time. */
  public static SurfaceTarget of(Surface surface) {
    // Its own words for null are "Attempt to invoke ...": say which argument.
    return new SurfaceTarget(java.util.Objects.requireNonNull(surface, "surface"));
  }

  @Override
  FrameStats render(
      long handle,
      String[] frame,
      @Nullable ProgressListener progress,
      @Nullable PreviewListener preview) {
    return Native.renderSurface(handle, frame, surface, progress, preview);
  }
}
