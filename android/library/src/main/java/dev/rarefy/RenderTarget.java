// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy;

import org.jspecify.annotations.Nullable;

/**
 * Something of Android's that a frame is drawn into: a {@link BitmapTarget} or {@link
 * SurfaceTarget}.
 */
public abstract class RenderTarget {
  RenderTarget() {}

  abstract FrameStats render(
      long handle,
      String[] frame,
      @Nullable ProgressListener progress,
      @Nullable PreviewListener preview);
}
