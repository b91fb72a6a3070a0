// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo.logic;

/** Sentences in the user's language. */
public interface Words {
  /** What there are sentences for, each with what is put into it. */
  enum Word {
    /** Width, height, milliseconds. */
    FRAME,
    /** The same, for a frame of a moving finger. */
    COARSE_FRAME,
    /** A number. */
    RAYS,
    /** A share. */
    TRACED,
    /** All pixels have rays, since the method would not pay here. */
    FELL_BACK,
    /** A factor. */
    SPEEDUP,
    /** Name and driver of a device. */
    DEVICE,
    /** No OpenCL draws: name of the processor. */
    CPU,
    /** A scene and a sentence of the library. */
    OPENING_FAILED,
    /** A sentence of the library. */
    DRAWING_FAILED,
    /** Likewise. */
    BENCHMARK_FAILED,
    /** Nothing. */
    MEMORY_FAILED,
    /** A sentence of the library or of Java. */
    DEFECT,
    /** A sentence of the library. */
    DRIVER_CRASHED,
    /** A sentence of the library. */
    DRIVER_FAILED,
    /** A method's name, milliseconds of full and of adaptive tracing, a factor, a share. */
    BENCHMARK_ROW,
    METHOD_BALANCED,
    METHOD_FAST,
    METHOD_PAPER
  }

  /** The sentence with these in it. */
  String say(Word word, Object... with);
}
