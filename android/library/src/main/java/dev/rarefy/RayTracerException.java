// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy;

import org.jspecify.annotations.Nullable;

/** What kept Rarefy from doing what it was asked for: a code, a place, and a sentence. */
public final class RayTracerException extends RuntimeException {
  private static final long serialVersionUID = 1;

  /** What went wrong, for programs. */
  public enum Code {
    /** A file cannot be read; {@link #getCause} has what an {@link AssetReader} threw. */
    IO,
    /** A text file breaks its format at a known line. */
    SYNTAX,
    /** A scene, a part of one, or a camera makes no sense. */
    INVALID_SCENE,
    /** A picture file cannot be decoded. */
    INVALID_IMAGE,
    /** A setting has a value that it may not have. */
    INVALID_OPTION,
    /** An argument does not fit what it is for. */
    INVALID_ARGUMENT,
    /** A device profile breaks its format. */
    INVALID_PROFILE,
    /** A layer was asked for that the last frame did not keep. */
    MISSING_LAYER,
    /** Something is larger than the device, a budget or the library allows. */
    LIMIT_EXCEEDED,
    /** There is no more memory. */
    OUT_OF_MEMORY,
    /** OpenCL was asked for, and there is none. */
    NO_OPENCL,
    /** An OpenCL call failed. */
    OPENCL,
    /** The device's compiler does not take a kernel. */
    KERNEL_BUILD,
    /** The device computes wrong numbers. */
    SELF_TEST,
    /**
     * The driver ended the process at an earlier start, so that it is not tried again: see {@link
     * OpenOptions.Builder#retryCrashed}.
     */
    DRIVER_CRASHED,
    /** The device was lost while it drew, opened again, and lost again. */
    DEVICE_LOST,
    /** Somebody cancelled the work, or closed the tracer. */
    CANCELLED,
    /** A Bitmap or Surface cannot be drawn into, or not any more. */
    TARGET_LOST,
    /** A defect of this library. */
    INTERNAL,
    /** A code that these classes do not know: the native library is of another version. */
    OTHER;

    private static Code named(String name) {
      for (Code code : values()) {
        if (code.name().equals(name)) {
          return code;
        }
      }
      return OTHER;
    }
  }

  private final Code code;
  private final @Nullable String place;

  /** Called by native code. */
  RayTracerException(
      String code, @Nullable String place, String message, @Nullable Throwable cause) {
    super(message, cause);
    this.code = Code.named(code);
    this.place = place;
  }

  /** What went wrong, for programs. */
  public Code getCode() {
    return code;
  }

  /**
   * Where: a file with its line, a part of a scene, the method that set a value, a device. Null
   * where there is nothing to name; the message names it as well.
   */
  public @Nullable String getPlace() {
    return place;
  }
}
