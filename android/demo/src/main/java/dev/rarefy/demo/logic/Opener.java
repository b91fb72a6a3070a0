// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo.logic;

import dev.rarefy.Cancellation;
import dev.rarefy.ProgressListener;
import dev.rarefy.RayTracer;

/** Opens scenes: the app's way of it, or a test's. */
public interface Opener {
  /**
   * Opens a scene on the best device.
   *
   * @param retryCrashed whether to try a driver again that ended the process
   */
  RayTracer open(
      SceneChoice scene,
      boolean retryCrashed,
      ProgressListener progress,
      Cancellation cancellation);
}
