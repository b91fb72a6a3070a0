// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy;

/**
 * Ends the opening of a {@link RayTracer} from another thread, see {@link
 * OpenOptions.Builder#cancellation}. One that was cancelled stays so.
 */
public final class Cancellation {
  private boolean cancelled;
  private long handle;

  /** Ends the opening with a {@link RayTracerException} of code {@code CANCELLED}. */
  public synchronized void cancel() {
    cancelled = true;
    if (handle != 0) {
      Native.cancel(handle);
    }
  }

  /** Whether it was cancelled. */
  public synchronized boolean isCancelled() {
    return cancelled;
  }

  /** From here on this is what is cancelled. */
  synchronized void watch(long handle) {
    this.handle = handle;
  }
}
