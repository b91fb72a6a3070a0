// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy;

import java.lang.ref.PhantomReference;
import java.lang.ref.ReferenceQueue;
import java.util.Collections;
import java.util.Set;
import java.util.concurrent.ConcurrentHashMap;

/**
 * Frees tracers that nobody closed, some time after the garbage collector found that nobody can
 * reach them. On a thread of its own: to free memory of a device may wait for that device.
 */
final class LeakNet {
  private static final ReferenceQueue<Object> QUEUE = new ReferenceQueue<>();

  /** Without it the references themselves would be collected. */
  private static final Set<Entry> ENTRIES =
      Collections.newSetFromMap(new ConcurrentHashMap<Entry, Boolean>());

  static {
    Thread thread = new Thread(LeakNet::watch, "rarefy-leak-net");
    thread.setDaemon(true);
    thread.start();
  }

  private LeakNet() {}

  /** A handle that is freed once its owner is gone. */
  static final class Entry extends PhantomReference<Object> {
    private final long handle;

    private Entry(Object owner, long handle) {
      super(owner, QUEUE);
      this.handle = handle;
    }

    /** The owner was closed: there is nothing to watch any more. */
    void remove() {
      ENTRIES.remove(this);
      clear();
    }
  }

  static Entry add(Object owner, long handle) {
    Entry entry = new Entry(owner, handle);
    ENTRIES.add(entry);
    return entry;
  }

  private static void watch() {
    while (true) {
      try {
        Entry entry = (Entry) QUEUE.remove();
        entry.remove();
        Native.release(entry.handle);
      } catch (InterruptedException e) {
        // Nobody interrupts this thread for a reason of ours; it goes on.
      }
    }
  }
}
