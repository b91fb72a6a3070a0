// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy;

import java.io.File;
import java.util.ArrayList;
import java.util.List;
import org.jspecify.annotations.Nullable;

/** How a {@link RayTracer} is opened: on which device, with how much memory, watched by whom. */
public final class OpenOptions {
  private final List<String> settings;
  private final @Nullable ProgressListener progress;
  private final @Nullable Cancellation cancellation;

  private OpenOptions(Builder builder) {
    settings = new ArrayList<>(builder.settings);
    progress = builder.progress;
    cancellation = builder.cancellation;
  }

  /** The best device there is, nobody watching. */
  public static OpenOptions defaults() {
    return builder().build();
  }

  /** Options to be chosen. */
  public static Builder builder() {
    return new Builder();
  }

  /** Names and values in turn, as native code takes them. */
  String[] settings() {
    return settings.toArray(new String[0]);
  }

  @Nullable ProgressListener progress() {
    return progress;
  }

  @Nullable Cancellation cancellation() {
    return cancellation;
  }

  @Override
  public String toString() {
    return "OpenOptions" + settings;
  }

  /** Chooses options. */
  public static final class Builder {
    private final List<String> settings = new ArrayList<>();
    private @Nullable ProgressListener progress;
    private @Nullable Cancellation cancellation;

    private Builder() {}

    private Builder set(String name, Object value) {
      settings.add(name);
      settings.add(value.toString());
      return this;
    }

    /**
     * Which device draws: {@code auto} (the first usable OpenCL GPU, else packets of rays on the
     * CPU; the default), {@code cpu} (these packets), {@code twin} (one ray at a time), {@code
     * opencl} (the first usable OpenCL device or an exception), or {@code opencl:N}.
     */
    public Builder device(String device) {
      return set("device", device);
    }

    /**
     * Where compiled programs and what was learnt of drivers are kept: a folder of the app's own
     * within its cache folder. Without it every start compiles anew, which takes seconds.
     */
    public Builder cacheFolder(File folder) {
      return set("cacheFolder", folder.getPath());
    }

    /**
     * Most memory on the device, scene and frame together. Frames that do not fit are drawn in
     * bands, with the same picture.
     *
     * @param bytes bytes, above 0
     */
    public Builder memoryBudgetBytes(long bytes) {
      return set("memoryBudgetBytes", bytes);
    }

    /**
     * An OpenCL library to try before all others. The library is chosen once in a process, by the
     * first tracer or {@link OpenClReport}.
     */
    public Builder openclLibrary(File library) {
      return set("openclLibrary", library.getPath());
    }

    /**
     * Whether to do again what ended the process at an earlier start, and to build again what did
     * not build: for a user who asks for it, or after a system update.
     */
    public Builder retryCrashed(boolean retry) {
      return set("retryCrashed", retry);
    }

    /** Whether kernels give the CPU's picture bit for bit, in place of the device's fastest. */
    public Builder strict(boolean strict) {
      return set("strict", strict);
    }

    /**
     * Holds an OpenCL device to the limits of another one, such as {@code adreno-420}, to try what
     * that one would refuse.
     */
    public Builder profile(String name) {
      return set("profile", name);
    }

    /** Who hears how far the opening is. */
    public Builder progress(@Nullable ProgressListener listener) {
      progress = listener;
      return this;
    }

    /** What ends the opening from another thread. */
    public Builder cancellation(@Nullable Cancellation cancellation) {
      this.cancellation = cancellation;
      return this;
    }

    /** The options as chosen so far. */
    public OpenOptions build() {
      return new OpenOptions(this);
    }
  }
}
