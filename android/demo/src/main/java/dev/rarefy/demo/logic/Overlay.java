// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo.logic;

import dev.rarefy.DeviceInfo;
import dev.rarefy.FrameStats;
import dev.rarefy.RayTracerException;
import dev.rarefy.RenderOptions;
import java.text.NumberFormat;
import java.util.ArrayList;
import java.util.List;
import java.util.Locale;
import org.jspecify.annotations.Nullable;

/** What the loop knows, in sentences: the lines over the picture, and the messages. */
public final class Overlay {
  private final Words words;
  private final Locale locale;

  /** Sentences in a language, with the numbers of a region. */
  public Overlay(Words words, Locale locale) {
    this.words = words;
    this.locale = locale;
  }

  /** The lines over the picture; what is not known yet has none. */
  public List<String> lines(State state) {
    List<String> lines = new ArrayList<>();
    FrameInfo frame = state.frame();
    if (frame != null) {
      FrameStats stats = frame.stats();
      Words.Word word = frame.isRefined() ? Words.Word.FRAME : Words.Word.COARSE_FRAME;
      lines.add(
          words.say(
              word,
              number(stats.getWidth(), 0),
              number(stats.getHeight(), 0),
              number(stats.getFrameMillis(), stats.getFrameMillis() < 100 ? 1 : 0)));
      Long rays = frame.rays();
      if (rays != null) {
        lines.add(words.say(Words.Word.RAYS, number(rays, 0)));
      }
      if (stats.isFellBack() && !frame.isFull()) {
        lines.add(words.say(Words.Word.FELL_BACK));
      } else {
        lines.add(
            words.say(Words.Word.TRACED, percent(frame.isFull() ? 1 : stats.getTracedShare())));
      }
      Double speedup = frame.speedup();
      if (speedup != null) {
        lines.add(words.say(Words.Word.SPEEDUP, number(speedup, 2)));
      }
    }
    DeviceInfo device = state.device();
    if (device != null) {
      lines.add(
          isCpu(device)
              ? words.say(Words.Word.CPU, device.getName())
              : words.say(Words.Word.DEVICE, device.getName(), device.getVersion()));
    }
    return lines;
  }

  /** Whether no OpenCL device draws. */
  public static boolean isCpu(DeviceInfo device) {
    return device.getBackend().equals("cpu");
  }

  /** A driver that ended the process at an earlier start, so that another device draws. */
  public static @Nullable RayTracerException crashed(DeviceInfo device) {
    for (RayTracerException passed : device.getPassedOver()) {
      if (passed.getCode() == RayTracerException.Code.DRIVER_CRASHED) {
        return passed;
      }
    }
    return null;
  }

  /**
   * What a user should be told: what went wrong, or why OpenCL does not draw though it is there.
   * Null if there is nothing.
   */
  public @Nullable String message(State state, String sceneName) {
    Failure failure = state.failure();
    if (failure != null) {
      return sentence(failure, sceneName);
    }
    DeviceInfo device = state.device();
    if (device == null) {
      return null;
    }
    RayTracerException crash = crashed(device);
    if (crash != null) {
      return words.say(Words.Word.DRIVER_CRASHED, sentence(crash));
    }
    for (RayTracerException passed : device.getPassedOver()) {
      if (passed.getCode() != RayTracerException.Code.NO_OPENCL) {
        return words.say(Words.Word.DRIVER_FAILED, sentence(passed));
      }
    }
    return null;
  }

  /** What a benchmark found, a line for each method. */
  public String benchmark(Benchmark.Result result) {
    StringBuilder text = new StringBuilder();
    for (Benchmark.Line line : result.lines()) {
      text.append(text.length() == 0 ? "" : "\n")
          .append(
              words.say(
                  Words.Word.BENCHMARK_ROW,
                  words.say(name(line.method)),
                  number(line.fullMillis, 1),
                  number(line.adaptiveMillis, 1),
                  number(line.fullMillis / line.adaptiveMillis, 2),
                  percent(line.tracedShare)));
    }
    return text.toString();
  }

  private static Words.Word name(RenderOptions.Method method) {
    switch (method) {
      case BALANCED:
        return Words.Word.METHOD_BALANCED;
      case FAST:
        return Words.Word.METHOD_FAST;
      case PAPER:
        return Words.Word.METHOD_PAPER;
    }
    throw new AssertionError(method);
  }

  /** The library's exceptions always have one, which Java does not know. */
  private static String sentence(RayTracerException e) {
    return String.valueOf(e.getMessage());
  }

  private String sentence(Failure failure, String sceneName) {
    switch (failure.kind()) {
      case OPENING:
        return words.say(Words.Word.OPENING_FAILED, sceneName, failure.message());
      case DRAWING:
        return words.say(Words.Word.DRAWING_FAILED, failure.message());
      case BENCHMARK:
        return words.say(Words.Word.BENCHMARK_FAILED, failure.message());
      case MEMORY:
        return words.say(Words.Word.MEMORY_FAILED);
      case DEFECT:
        return words.say(Words.Word.DEFECT, failure.message());
    }
    throw new AssertionError(failure);
  }

  /** A tolerance as the panel shows it. */
  public String tolerance(float value) {
    return number(value, 3);
  }

  /** A share, such as 34 %. */
  public String percent(double share) {
    NumberFormat format = NumberFormat.getPercentInstance(locale);
    format.setMaximumFractionDigits(share < 0.1 ? 1 : 0);
    return format.format(share);
  }

  private String number(double value, int digits) {
    NumberFormat format = NumberFormat.getInstance(locale);
    format.setMinimumFractionDigits(digits == 1 ? 1 : 0);
    format.setMaximumFractionDigits(digits);
    return format.format(value);
  }
}
