// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy;

import java.util.ArrayList;
import java.util.Arrays;
import java.util.Collections;
import java.util.List;

/** Who draws. A value that does not change. */
public final class DeviceInfo {
  private final String name;
  private final String version;
  private final String backend;
  private final String profile;
  private final List<String> notices;
  private final List<RayTracerException> passedOver;

  /** Called by native code. */
  DeviceInfo(
      String name,
      String version,
      String backend,
      String profile,
      String[] notices,
      String[] codes,
      String[] causes) {
    this.name = name;
    this.version = version;
    this.backend = backend;
    this.profile = profile;
    this.notices = Collections.unmodifiableList(Arrays.asList(notices));
    List<RayTracerException> errors = new ArrayList<>();
    for (int at = 0; at < codes.length; at++) {
      errors.add(new RayTracerException(codes[at], null, causes[at], null));
    }
    passedOver = Collections.unmodifiableList(errors);
  }

  /** The device's name. */
  public String getName() {
    return name;
  }

  /** Version of the device and its driver. */
  public String getVersion() {
    return version;
  }

  /** {@code opencl} or {@code cpu}. */
  public String getBackend() {
    return backend;
  }

  /** The profile whose limits it is held to, or {@code none}. */
  public String getProfile() {
    return profile;
  }

  /**
   * What a user should know of it, a sentence each: why OpenCL does not draw, when a device was
   * lost.
   */
  public List<String> getNotices() {
    return notices;
  }

  /**
   * Why a device, or a way of building its kernels, that would have come first does not draw; empty
   * if the first choice does. One of code {@code DRIVER_CRASHED} is what {@link
   * OpenOptions.Builder#retryCrashed} is for.
   */
  public List<RayTracerException> getPassedOver() {
    return passedOver;
  }

  @Override
  public String toString() {
    return name + " (" + backend + ", " + version + ")";
  }
}
