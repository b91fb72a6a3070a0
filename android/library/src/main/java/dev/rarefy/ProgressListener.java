// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy;

/** Hears how far a call is. */
public interface ProgressListener {
  /**
   * Called from any thread, also from those that are not Java's; calls for one piece of work do not
   * overlap. The work waits for it, so it should return soon, and it may not open, draw or read a
   * layer. What it throws cancels the work, and comes out of the call that it watched.
   *
   * @param phase what is being done, such as {@code kd-tree} or {@code frame}
   * @param share the share that is done, from 0 to 1; an estimate
   */
  void onProgress(String phase, float share);
}
