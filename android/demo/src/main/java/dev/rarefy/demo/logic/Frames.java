// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo.logic;

import dev.rarefy.Camera;
import dev.rarefy.FrameStats;
import dev.rarefy.Layer;
import dev.rarefy.RayTracer;
import dev.rarefy.RenderOptions;
import java.nio.ByteBuffer;
import org.jspecify.annotations.Nullable;

/**
 * Draws the frames that the settings ask for, and puts together what is shown. Used by one thread.
 */
final class Frames {
  private @Nullable ByteBuffer full;
  private @Nullable ByteBuffer adaptive;
  private @Nullable ByteBuffer shown;
  private @Nullable ByteBuffer scratch;
  private int width;
  private int height;
  private boolean ready;

  /** Frees the memory; the next frame takes some again. */
  void free() {
    full = null;
    adaptive = null;
    shown = null;
    scratch = null;
    ready = false;
  }

  /** Whether there is a picture to show. */
  boolean isReady() {
    return ready;
  }

  int width() {
    return width;
  }

  int height() {
    return height;
  }

  static boolean needsFull(Settings settings) {
    return settings.mode() == Settings.Mode.SPLIT
        || settings.shown() == Shown.DIFFERENCE
        || isFullAlone(settings);
  }

  /** Layers tell of the method, so that they are of an adaptive frame in every mode. */
  static boolean isFullAlone(Settings settings) {
    return settings.mode() == Settings.Mode.FULL && settings.shown() == Shown.PICTURE;
  }

  /** Draws; {@link #compose} shows it. */
  FrameInfo draw(
      RayTracer tracer, Camera camera, Settings settings, int width, int height, boolean refined) {
    ready = false;
    boolean fullAlone = isFullAlone(settings);
    FrameStats fullStats = null;
    FrameStats stats = null;
    if (needsFull(settings)) {
      full = fitting(full, width, height);
      fullStats = tracer.render(settings.options(width, height, true), full);
    }
    if (!fullAlone) {
      adaptive = fitting(adaptive, width, height);
      Layer layer = settings.shown().layer();
      RenderOptions options = settings.options(width, height, false);
      if (layer != null) {
        options = options.toBuilder().keepLayer(layer).build();
      }
      stats = tracer.render(options, adaptive);
      if (layer != null) {
        Composer.layer(tracer.layer(layer), adaptive, width, height);
      }
    }
    this.width = width;
    this.height = height;
    ready = true;
    FrameStats told = stats != null ? stats : fullStats;
    if (told == null) {
      throw new AssertionError(settings);
    }
    // A frame that keeps a layer costs more than one to look at: no speedup comes of it.
    boolean timed = fullStats != null && settings.shown().layer() == null;
    double fullMillis = timed && fullStats != null ? fullStats.getFrameMillis() : -1;
    return new FrameInfo(camera, told, fullAlone, refined, fullMillis, -1);
  }

  /** What is to be shown of the last frame. */
  ByteBuffer compose(Settings settings) {
    ByteBuffer full = this.full;
    ByteBuffer adaptive = this.adaptive;
    if (isFullAlone(settings) && full != null) {
      return full;
    }
    if (adaptive == null) {
      throw new AssertionError(settings);
    }
    ByteBuffer right = adaptive;
    if (settings.shown() == Shown.DIFFERENCE && full != null) {
      scratch = fitting(scratch, width, height);
      Composer.difference(full, adaptive, scratch, width, height);
      right = scratch;
    }
    if (settings.mode() != Settings.Mode.SPLIT || full == null) {
      return right;
    }
    shown = fitting(shown, width, height);
    Composer.split(full, right, shown, width, height, Math.round(settings.divider() * width));
    return shown;
  }

  /** Draws again what the last frame does not tell: rays, and the time of the other mode. */
  FrameInfo measure(RayTracer tracer, Settings settings, FrameInfo info) {
    int width = info.stats().getWidth();
    int height = info.stats().getHeight();
    ByteBuffer into = fitting(scratch, width, height);
    scratch = into;
    RenderOptions counted = settings.options(width, height, info.isFull());
    FrameStats rays = tracer.render(counted.toBuilder().counters(true).build(), into);
    double fullMillis = -1;
    if (!info.isFull() && settings.shown().layer() == null) {
      fullMillis = tracer.render(settings.options(width, height, true), into).getFrameMillis();
    }
    return info.measured(fullMillis, FrameInfo.raysOf(rays));
  }

  private static ByteBuffer fitting(@Nullable ByteBuffer old, int width, int height) {
    if (old != null && old.capacity() >= 4L * width * height) {
      return old;
    }
    return RayTracer.allocate(width, height);
  }
}
