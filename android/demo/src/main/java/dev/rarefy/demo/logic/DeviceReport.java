// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo.logic;

import dev.rarefy.DeviceInfo;
import dev.rarefy.OpenClReport;
import dev.rarefy.RayTracerException;
import java.util.List;
import java.util.Map;
import org.jspecify.annotations.Nullable;

/** What a user can send to the project: in English, for those who read it there. */
public final class DeviceReport {
  private DeviceReport() {}

  /**
   * The report.
   *
   * @param phone names and values that Android gives
   * @param openCl what was found; null if the search itself failed
   * @param device who draws; null if no scene is open
   * @param failure what went wrong; null for nothing
   */
  public static String text(
      Map<String, String> phone,
      String version,
      @Nullable OpenClReport openCl,
      @Nullable DeviceInfo device,
      @Nullable Failure failure) {
    StringBuilder text = new StringBuilder();
    line(text, "rarefy", version);
    for (Map.Entry<String, String> entry : phone.entrySet()) {
      line(text, entry.getKey(), entry.getValue());
    }
    if (failure != null) {
      line(text, "failure", failure.toString());
    }
    if (device != null) {
      line(text, "draws", device.getName());
      line(text, "version", device.getVersion());
      line(text, "backend", device.getBackend());
      line(text, "profile", device.getProfile());
      lines(text, "notice", device.getNotices());
      for (RayTracerException passed : device.getPassedOver()) {
        line(text, "passed over", passed.getCode() + ": " + passed.getMessage());
      }
    }
    if (openCl != null) {
      String library = openCl.getLibrary();
      line(text, "OpenCL library", library == null ? "none" : library);
      lines(text, "refused", openCl.getRefused());
      lines(text, "device", openCl.getDevices());
      lines(text, "skipped", openCl.getSkipped());
    }
    return text.toString();
  }

  /** What each device says of its limits, as JSON, which the project keeps as a profile. */
  public static String profiles(@Nullable OpenClReport openCl) {
    StringBuilder text = new StringBuilder();
    if (openCl != null) {
      for (String profile : openCl.getProfiles()) {
        text.append("\nprofile:\n").append(profile).append('\n');
      }
    }
    return text.toString();
  }

  private static void lines(StringBuilder text, String name, List<String> values) {
    for (String value : values) {
      line(text, name, value);
    }
  }

  private static void line(StringBuilder text, String name, String value) {
    text.append(name).append(": ").append(value).append('\n');
  }
}
