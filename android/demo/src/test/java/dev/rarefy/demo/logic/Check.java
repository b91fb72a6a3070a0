// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo.logic;

import java.util.concurrent.Callable;

/** What the tests share: plain checks that throw, since there is no test framework here. */
final class Check {
  private Check() {}

  static void that(boolean truth, String what) {
    if (!truth) {
      throw new AssertionError(what);
    }
  }

  static void equal(Object wanted, Object got) {
    that(wanted.equals(got), "wanted " + wanted + ", got " + got);
  }

  static void near(double wanted, double got, double apart, String what) {
    that(Math.abs(wanted - got) <= apart, what + ": wanted " + wanted + ", got " + got);
  }

  static <T extends Throwable> T thrown(Class<T> wanted, Callable<?> call) {
    Object got;
    try {
      got = call.call();
    } catch (Throwable e) {
      if (wanted.isInstance(e)) {
        return wanted.cast(e);
      }
      throw new AssertionError("wanted " + wanted.getName() + ", got " + e, e);
    }
    throw new AssertionError("wanted " + wanted.getName() + ", got " + got);
  }

  /** Waits until something is so; a test that waits a minute has failed. */
  static void until(String what, Callable<Boolean> truth) throws Exception {
    for (int round = 0; round < 6000; round++) {
      if (truth.call()) {
        return;
      }
      Thread.sleep(10);
    }
    throw new AssertionError("after a minute still not: " + what);
  }
}
