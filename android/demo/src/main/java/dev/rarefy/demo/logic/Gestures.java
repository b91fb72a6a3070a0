// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo.logic;

import dev.rarefy.Camera;

/**
 * Fingers on the picture move the camera: one orbits, two pan and dolly, a double tap resets. Knows
 * where the fingers were, and nothing of the camera but what it is given.
 */
public final class Gestures {
  /** What a drag across the shorter side of the screen turns. */
  static final double DEGREES_ACROSS = 180;

  /** A tap is shorter than this, and so is the pause between two. */
  static final long TAP_MILLIS = 300;

  /** How far from its start, as a share of the shorter side, a finger that taps may be. */
  static final double TAP_SHARE = 0.04;

  /** How much nearer to what it looks at, or farther from it, than at its start a camera may go. */
  static final double NEAREST = 1e-3;

  static final double FARTHEST = 1e2;

  private final int width;
  private final int height;
  private float[] xs = {};
  private float[] ys = {};
  private boolean mayTap;
  private long downMillis;
  private float downX;
  private float downY;
  private long lastTapMillis = Long.MIN_VALUE / 2;
  private float lastTapX;
  private float lastTapY;

  /**
   * Gestures on a screen.
   *
   * @param width its width in the unit of the positions
   * @param height its height
   */
  public Gestures(int width, int height) {
    this.width = Math.max(1, width);
    this.height = Math.max(1, height);
  }

  /**
   * Fingers came or went; nothing moves by that.
   *
   * @param xs where the fingers are that now touch the picture
   * @param ys likewise
   */
  public void fingers(float[] xs, float[] ys, long millis) {
    boolean first = this.xs.length == 0 && xs.length == 1;
    if (first) {
      downMillis = millis;
      downX = xs[0];
      downY = ys[0];
    }
    mayTap = first || (mayTap && xs.length == 1);
    this.xs = xs.clone();
    this.ys = ys.clone();
  }

  /** The last finger was lifted. Whether that was a double tap. */
  public boolean lifted(long millis) {
    boolean tap = mayTap && xs.length == 1 && millis - downMillis <= TAP_MILLIS;
    boolean second =
        tap
            && downMillis - lastTapMillis <= TAP_MILLIS
            && near(downX - lastTapX, downY - lastTapY, 3);
    cancelled();
    if (tap && !second) {
      lastTapMillis = millis;
      lastTapX = downX;
      lastTapY = downY;
    }
    return second;
  }

  /** The system took the gesture: as if it ended, without a tap. */
  public void cancelled() {
    xs = new float[0];
    ys = xs;
    mayTap = false;
    lastTapMillis = Long.MIN_VALUE / 2;
  }

  /**
   * Fingers moved. The camera that follows from it; the same one if nothing does.
   *
   * @param camera where the camera is
   * @param start where it was when the scene was opened
   */
  public Camera moved(Camera camera, Camera start, float[] xs, float[] ys) {
    if (xs.length != this.xs.length || xs.length == 0) {
      fingers(xs, ys, Long.MIN_VALUE / 2);
      mayTap = false;
      return camera;
    }
    if (mayTap && near(xs[0] - downX, ys[0] - downY, 1)) {
      return camera;
    }
    mayTap = false;
    float[] oldXs = this.xs;
    float[] oldYs = this.ys;
    this.xs = xs.clone();
    this.ys = ys.clone();
    try {
      return xs.length == 1
          ? orbited(camera, xs[0] - oldXs[0], ys[0] - oldYs[0])
          : pinched(camera, start, oldXs, oldYs);
    } catch (IllegalArgumentException e) {
      // Positions that are not finite, or a camera beyond all bounds: stay.
      return camera;
    }
  }

  private boolean near(float dx, float dy, double times) {
    return Math.hypot(dx, dy) <= times * TAP_SHARE * Math.min(width, height);
  }

  /** The scene follows the finger, so the eye goes the other way. */
  private Camera orbited(Camera camera, double dx, double dy) {
    double degrees = DEGREES_ACROSS / Math.min(width, height);
    return camera.orbit(-dx * degrees, dy * degrees);
  }

  private Camera pinched(Camera camera, Camera start, float[] oldXs, float[] oldYs) {
    double before = Math.max(1, Math.hypot(oldXs[1] - oldXs[0], oldYs[1] - oldYs[0]));
    double after = Math.max(1, Math.hypot(xs[1] - xs[0], ys[1] - ys[0]));
    Camera nearer = dollied(camera, start, before / after);
    // What was between the fingers stays there.
    double unitsPerPixel =
        2 * nearer.getDistance() * Math.tan(Math.toRadians(nearer.getFovYDegrees()) / 2) / height;
    double dx = (xs[0] + xs[1] - oldXs[0] - oldXs[1]) / 2;
    double dy = (ys[0] + ys[1] - oldYs[0] - oldYs[1]) / 2;
    return nearer.pan(-dx * unitsPerPixel, dy * unitsPerPixel);
  }

  /** Nearer or farther within bounds; beyond them cameras end as two places that are one. */
  public static Camera dollied(Camera camera, Camera start, double factor) {
    double distance = camera.getDistance();
    double wanted = distance * factor;
    double inside =
        Math.max(start.getDistance() * NEAREST, Math.min(start.getDistance() * FARTHEST, wanted));
    return camera.dolly(inside / distance);
  }
}
