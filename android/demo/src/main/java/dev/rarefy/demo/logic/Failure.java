// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo.logic;

import dev.rarefy.RayTracerException;
import org.jspecify.annotations.Nullable;

/** What went wrong, as a value. */
public final class Failure {
  /** While what was done. */
  public enum Kind {
    OPENING,
    DRAWING,
    BENCHMARK,
    /** There is not enough memory even for a small picture. */
    MEMORY,
    /** A defect of the app or the library, or a native library that does not load. */
    DEFECT
  }

  private final Kind kind;
  private final RayTracerException.@Nullable Code code;
  private final String message;

  private Failure(Kind kind, RayTracerException.@Nullable Code code, String message) {
    this.kind = kind;
    this.code = code;
    this.message = message;
  }

  static Failure of(Kind kind, Throwable thrown) {
    String message = thrown.getMessage();
    String text = message == null || message.isEmpty() ? thrown.toString() : message;
    if (thrown instanceof RayTracerException) {
      return new Failure(kind, ((RayTracerException) thrown).getCode(), text);
    }
    boolean memory = kind == Kind.MEMORY;
    return new Failure(memory ? kind : Kind.DEFECT, null, memory ? text : thrown.toString());
  }

  /** While what was done. */
  public Kind kind() {
    return kind;
  }

  /** The library's code; null for what is not an error of the library's. */
  public RayTracerException.@Nullable Code code() {
    return code;
  }

  /** The library's sentence. */
  public String message() {
    return message;
  }

  @Override
  public String toString() {
    return kind + (code == null ? "" : " " + code) + ": " + message;
  }
}
