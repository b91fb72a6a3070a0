// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy;

import java.util.EnumSet;

/** What the guard of the native methods makes of errors and panics; its natives are the probe's. */
final class GuardProbe {
  private GuardProbe() {}

  static native int fail(String text);

  static native int failWith(int kind);

  static native String failOnRustThread();

  static native int panic(String text);

  static native int callWithExceptionPending();

  public static void main(String[] arguments) {
    System.load(System.getProperty("dev.rarefy.probe"));
    if (arguments.length > 0) {
      // Breaks a rule of JNI, so that the test sees that it would be told.
      Check.thrown(IllegalStateException.class, GuardProbe::callWithExceptionPending);
      return;
    }
    // Text comes through whole, whatever its letters.
    String text = "gr\u00fcn \ud83d\ude42";
    for (int round = 0; round < 2; round++) {
      RayTracerException e =
          Check.coded(RayTracerException.Code.INVALID_ARGUMENT, text, () -> fail(text));
      Check.equal("--probe: " + text, e.getMessage());
      Check.equal("--probe", e.getPlace());
      Error panic = Check.thrown(Error.class, () -> panic("index 7 " + text));
      Check.equal(Error.class, panic.getClass());
      Check.equal("internal error in Rarefy: index 7 " + text, panic.getMessage());
      Check.thrown(NullPointerException.class, () -> fail(null));
    }
    everyKind();
    // Where these are an app's classes, threads of Rust's do not find them.
    boolean ofAnApp = GuardProbe.class.getClassLoader() != ClassLoader.getSystemClassLoader();
    String lookedUp = ofAnApp ? "lost " : "found ";
    Check.equal(lookedUp + "dev.rarefy.RayTracerException: P: T", failOnRustThread());
    System.out.println("done");
  }

  private static void everyKind() {
    EnumSet<RayTracerException.Code> seen = EnumSet.noneOf(RayTracerException.Code.class);
    // Which place a kind of error has, in the order of the probe's list.
    String[] places = {
      "F",
      "F:7",
      "P",
      "F",
      "RenderOptions.Builder.tPos",
      "A",
      "P",
      null,
      "W",
      "W",
      null,
      "C",
      "D",
      "D",
      "D",
      "D",
      null,
      null,
      null
    };
    for (int kind = 0; kind < places.length; kind++) {
      int number = kind;
      RayTracerException e = Check.thrown(RayTracerException.class, () -> failWith(number));
      String place = e.getPlace();
      Check.that(
          places[kind] == null ? place == null : places[kind].equals(place), kind + ": " + place);
      Check.that(!e.getMessage().isEmpty(), "a code without a sentence");
      seen.add(e.getCode());
    }
    Check.equal(-1, failWith(places.length));
    // Those that the natives of Bitmap and Surface give, and the one for unknown words, remain.
    EnumSet<RayTracerException.Code> others = EnumSet.complementOf(seen);
    Check.equal(
        EnumSet.of(RayTracerException.Code.TARGET_LOST, RayTracerException.Code.OTHER), others);
    Check.equal(
        RayTracerException.Code.OTHER,
        new RayTracerException("NEW", null, "of a later version", null).getCode());
  }
}
