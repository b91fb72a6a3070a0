// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy;

import java.util.Arrays;
import java.util.Collections;
import java.util.List;
import org.jspecify.annotations.Nullable;

/**
 * What OpenCL there is, what was tried and why it does not do: for a page of settings, or a report
 * of an error. A value that does not change.
 */
public final class OpenClReport {
  private final @Nullable String library;
  private final List<String> refused;
  private final List<String> devices;
  private final List<String> skipped;
  private final List<String> profiles;

  /** Called by native code. */
  OpenClReport(
      @Nullable String library,
      String[] refused,
      String[] devices,
      String[] skipped,
      String[] profiles) {
    this.library = library;
    this.refused = Collections.unmodifiableList(Arrays.asList(refused));
    this.devices = Collections.unmodifiableList(Arrays.asList(devices));
    this.skipped = Collections.unmodifiableList(Arrays.asList(skipped));
    this.profiles = Collections.unmodifiableList(Arrays.asList(profiles));
  }

  /** Looks for OpenCL as {@link RayTracer#open} does with these options; opens nothing. */
  public static OpenClReport look(OpenOptions options) {
    return Native.openclReport(options.settings());
  }

  /** The library in use, a path or a name; null if there is none, and the CPU draws. */
  public @Nullable String getLibrary() {
    return library;
  }

  /** Libraries that were tried before, in order, each with the reason why it does not do. */
  public List<String> getRefused() {
    return refused;
  }

  /** Devices that can draw, best first: {@code opencl:0}, {@code opencl:1} and so on. */
  public List<String> getDevices() {
    return devices;
  }

  /** Platforms and devices that cannot draw, each with the reason. */
  public List<String> getSkipped() {
    return skipped;
  }

  /**
   * All that each device says of its limits, in the order of {@link #getDevices}: JSON in the
   * format of {@code rarefy devices --json}. A file with one of these texts is a profile, so that a
   * phone can be imitated on a desktop.
   */
  public List<String> getProfiles() {
    return profiles;
  }

  @Override
  public String toString() {
    return "library: "
        + library
        + "\nrefused: "
        + refused
        + "\ndevices: "
        + devices
        + "\nskipped: "
        + skipped;
  }
}
