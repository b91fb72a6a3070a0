// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo.logic;

import dev.rarefy.Camera;
import dev.rarefy.DeviceInfo;
import org.jspecify.annotations.Nullable;

/** How far the render loop is, for the screen. A value that does not change. */
public final class State {
  /** What the loop does. */
  public enum Phase {
    /** Nothing, since nobody looks: in the background, or without a surface. */
    RESTING,
    OPENING,
    DRAWING,
    /** The frame on the screen is the best that the settings give. */
    DONE,
    BENCHMARK,
    /** See {@link State#failure}; {@link RenderLoop#retry} goes on. */
    FAILED
  }

  private final Phase phase;
  private final float progress;
  private final SceneChoice scene;
  private final @Nullable Camera camera;
  private final @Nullable FrameInfo frame;
  private final @Nullable DeviceInfo device;
  private final @Nullable Failure failure;
  private final Benchmark.@Nullable Result benchmark;

  State(
      Phase phase,
      float progress,
      SceneChoice scene,
      @Nullable Camera camera,
      @Nullable FrameInfo frame,
      @Nullable DeviceInfo device,
      @Nullable Failure failure,
      Benchmark.@Nullable Result benchmark) {
    this.phase = phase;
    this.progress = progress;
    this.scene = scene;
    this.camera = camera;
    this.frame = frame;
    this.device = device;
    this.failure = failure;
    this.benchmark = benchmark;
  }

  /** What the loop does. */
  public Phase phase() {
    return phase;
  }

  /** How far opening or the benchmark is, from 0 to 1. */
  public float progress() {
    return progress;
  }

  /** The scene that is wanted. */
  public SceneChoice scene() {
    return scene;
  }

  /** The camera that is wanted; null before the first scene is open. */
  public @Nullable Camera camera() {
    return camera;
  }

  /** What is on the screen; null before the first frame. */
  public @Nullable FrameInfo frame() {
    return frame;
  }

  /** Who draws; null before the scene is open. */
  public @Nullable DeviceInfo device() {
    return device;
  }

  /** What went wrong; null if nothing did. */
  public @Nullable Failure failure() {
    return failure;
  }

  /** The result of a benchmark that came to its end and was not taken yet. */
  public Benchmark.@Nullable Result benchmark() {
    return benchmark;
  }
}
