// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo.logic;

import dev.rarefy.RenderOptions;
import dev.rarefy.RenderOptions.Correction;
import dev.rarefy.RenderOptions.Method;
import java.util.Arrays;
import java.util.Collections;
import java.util.EnumMap;
import java.util.LinkedHashMap;
import java.util.List;
import java.util.Locale;
import java.util.Map;
import java.util.Objects;
import org.jspecify.annotations.Nullable;

/** All that the panel sets. A value that does not change; {@code with...} gives another one. */
public final class Settings {
  /** Which frames are drawn. */
  public enum Mode {
    FULL,
    ADAPTIVE,
    /** Full on the left of the divider, adaptive on its right. */
    SPLIT
  }

  /** Samples per pixel and axis. */
  public static final List<Integer> SAMPLES = Collections.unmodifiableList(Arrays.asList(1, 2, 4));

  /** Percent of the screen's width and height that are drawn. */
  public static final List<Integer> RESOLUTIONS =
      Collections.unmodifiableList(Arrays.asList(25, 50, 75, 100));

  private static final Settings DEFAULTS =
      new Settings(
          Mode.ADAPTIVE,
          0.5f,
          Shown.PICTURE,
          Method.BALANCED,
          1,
          null,
          50,
          new EnumMap<Tolerance, Float>(Tolerance.class));

  private final Mode mode;
  private final float divider;
  private final Shown shown;
  private final Method method;
  private final int samples;
  private final @Nullable Correction correction;
  private final int resolution;
  private final EnumMap<Tolerance, Float> tolerances;

  private Settings(
      Mode mode,
      float divider,
      Shown shown,
      Method method,
      int samples,
      @Nullable Correction correction,
      int resolution,
      EnumMap<Tolerance, Float> tolerances) {
    this.mode = mode;
    this.divider = divider;
    this.shown = shown;
    this.method = method;
    this.samples = samples;
    this.correction = correction;
    this.resolution = resolution;
    this.tolerances = tolerances;
  }

  /** What a new user sees: adaptive, balanced, half the screen's resolution. */
  public static Settings defaults() {
    return DEFAULTS;
  }

  /** Which frames are drawn. */
  public Mode mode() {
    return mode;
  }

  /** Where the split view's divider is, from 0 (left) to 1. */
  public float divider() {
    return divider;
  }

  /** What of a frame is shown. */
  public Shown shown() {
    return shown;
  }

  /** The method that the others begin with. */
  public Method method() {
    return method;
  }

  /** Samples per pixel and axis. */
  public int samples() {
    return samples;
  }

  /** What correction compares; null for what the method says. */
  public @Nullable Correction correction() {
    return correction;
  }

  /** Percent of the screen's width and height. */
  public int resolution() {
    return resolution;
  }

  /** A tolerance's value, the method's own if it was not set. */
  public float tolerance(Tolerance tolerance) {
    Float value = tolerances.get(tolerance);
    return value != null ? value : tolerance.ofMethod(method, false);
  }

  /** Whether a tolerance was set. */
  public boolean isSet(Tolerance tolerance) {
    return tolerances.containsKey(tolerance);
  }

  /** Another mode. */
  public Settings withMode(Mode mode) {
    return new Settings(mode, divider, shown, method, samples, correction, resolution, tolerances);
  }

  /** Another place of the divider, from 0 to 1; what is outside goes to the border. */
  public Settings withDivider(float divider) {
    // NaN goes to the middle.
    float inside = Float.isNaN(divider) ? 0.5f : Math.max(0, Math.min(1, divider));
    return new Settings(mode, inside, shown, method, samples, correction, resolution, tolerances);
  }

  /** Something else of a frame. */
  public Settings withShown(Shown shown) {
    return new Settings(mode, divider, shown, method, samples, correction, resolution, tolerances);
  }

  /** Another method; tolerances that were set stay. */
  public Settings withMethod(Method method) {
    return new Settings(mode, divider, shown, method, samples, correction, resolution, tolerances);
  }

  /** Other samples; what is not one of {@link #SAMPLES} changes nothing. */
  public Settings withSamples(int samples) {
    int allowed = SAMPLES.contains(samples) ? samples : this.samples;
    return new Settings(mode, divider, shown, method, allowed, correction, resolution, tolerances);
  }

  /** Another correction; null for what the method says. */
  public Settings withCorrection(@Nullable Correction correction) {
    return new Settings(mode, divider, shown, method, samples, correction, resolution, tolerances);
  }

  /** Another resolution; what is not one of {@link #RESOLUTIONS} changes nothing. */
  public Settings withResolution(int percent) {
    int allowed = RESOLUTIONS.contains(percent) ? percent : resolution;
    return new Settings(mode, divider, shown, method, samples, correction, allowed, tolerances);
  }

  /** A tolerance set to a value of its slider; null for what the method says. */
  public Settings withTolerance(Tolerance tolerance, @Nullable Float value) {
    EnumMap<Tolerance, Float> changed = new EnumMap<>(tolerances);
    if (value != null && tolerance.allows(value)) {
      changed.put(tolerance, value);
    } else {
      changed.remove(tolerance);
    }
    return new Settings(mode, divider, shown, method, samples, correction, resolution, changed);
  }

  /**
   * A full or an adaptive frame of this size. A full one differs only in its mode, so that the two
   * can be compared.
   */
  public RenderOptions options(int width, int height, boolean full) {
    RenderOptions.Builder builder =
        RenderOptions.builder()
            .method(method)
            .size(width, height)
            .samples(samples)
            .mode(full ? RenderOptions.Mode.FULL : RenderOptions.Mode.ADAPTIVE);
    for (Map.Entry<Tolerance, Float> entry : tolerances.entrySet()) {
      entry.getKey().into(builder, entry.getValue());
    }
    if (correction != null) {
      builder.correction(correction);
    }
    return builder.build();
  }

  /** Whether frames of the other settings cost and show the same but for the divider. */
  boolean drawsAs(Settings other) {
    return withDivider(0).equals(other.withDivider(0));
  }

  /** As text, to be saved. */
  public Map<String, String> toMap() {
    Map<String, String> map = new LinkedHashMap<>();
    map.put("mode", mode.name());
    map.put("divider", Float.toString(divider));
    map.put("shown", shown.name());
    map.put("method", method.name());
    map.put("samples", Integer.toString(samples));
    map.put("correction", correction == null ? "" : correction.name());
    map.put("resolution", Integer.toString(resolution));
    for (Tolerance tolerance : Tolerance.values()) {
      Float value = tolerances.get(tolerance);
      map.put(tolerance.key(), value == null ? "" : value.toString());
    }
    return map;
  }

  /** Settings that were saved. Whatever is missing or makes no sense is as in {@link #defaults}. */
  public static Settings fromMap(Map<String, String> map) {
    Settings settings =
        DEFAULTS
            .withMode(constant(Mode.class, map.get("mode"), DEFAULTS.mode))
            .withDivider(number(map.get("divider"), DEFAULTS.divider))
            .withShown(constant(Shown.class, map.get("shown"), DEFAULTS.shown))
            .withMethod(constant(Method.class, map.get("method"), DEFAULTS.method))
            .withSamples(whole(map.get("samples")))
            .withCorrection(constantOrNull(Correction.class, map.get("correction")))
            .withResolution(whole(map.get("resolution")));
    for (Tolerance tolerance : Tolerance.values()) {
      settings = settings.withTolerance(tolerance, number(map.get(tolerance.key()), Float.NaN));
    }
    return settings;
  }

  private static <E extends Enum<E>> E constant(Class<E> of, @Nullable String name, E otherwise) {
    E found = constantOrNull(of, name);
    return found != null ? found : otherwise;
  }

  private static <E extends Enum<E>> @Nullable E constantOrNull(
      Class<E> of, @Nullable String name) {
    for (E constant : Objects.requireNonNull(of.getEnumConstants())) {
      if (constant.name().equals(name)) {
        return constant;
      }
    }
    return null;
  }

  private static float number(@Nullable String text, float otherwise) {
    if (text == null) {
      return otherwise;
    }
    try {
      float number = Float.parseFloat(text);
      return Float.isNaN(number) ? otherwise : number;
    } catch (NumberFormatException e) {
      return otherwise;
    }
  }

  private static int whole(@Nullable String text) {
    if (text == null) {
      return 0;
    }
    try {
      return Integer.parseInt(text);
    } catch (NumberFormatException e) {
      return 0;
    }
  }

  @Override
  public boolean equals(@Nullable Object other) {
    return other instanceof Settings && ((Settings) other).toMap().equals(toMap());
  }

  @Override
  public int hashCode() {
    return toMap().hashCode();
  }

  @Override
  public String toString() {
    return String.format(Locale.ROOT, "Settings%s", Collections.unmodifiableMap(toMap()));
  }
}
