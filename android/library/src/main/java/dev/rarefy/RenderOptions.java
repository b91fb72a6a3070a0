// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy;

import java.util.ArrayList;
import java.util.List;
import java.util.Locale;

/**
 * How a frame is drawn. Begin with a {@link Method}, and change what should differ. Values are
 * checked when a frame is drawn: one that is not allowed gives a {@link RayTracerException} of code
 * {@code INVALID_OPTION} that names the method of {@link Builder} and what it may be.
 */
public final class RenderOptions {
  /** Rules and tolerances that belong together. */
  public enum Method {
    /** Most of the picture's quality for a third of its rays. The default. */
    BALANCED,
    /**
     * Half the rays of {@link #BALANCED}, at less quality: starts from a sixteenth of the pixels.
     */
    FAST,
    /** The rules and tolerances of Kim et al., The Visual Computer 2016. */
    PAPER
  }

  /** Which pixels get rays. */
  public enum Mode {
    /** Those for which it is needed. The default. */
    ADAPTIVE,
    /** Every one. */
    FULL
  }

  /**
   * What is compared between a traced pixel and a rebuilt neighbour, to trace that one after all.
   */
  public enum Correction {
    /** Nothing. */
    OFF("off"),
    /** Objects. */
    OBJECT("object"),
    /** Objects and shadows. */
    OBJECT_AND_SHADOW("object+shadow"),
    /** Objects, shadows, normals and reflected light. */
    ALL("all");

    final String nativeName;

    Correction(String nativeName) {
      this.nativeName = nativeName;
    }
  }

  private final List<String> settings;

  private RenderOptions(List<String> settings) {
    this.settings = settings;
  }

  /** {@link Method#BALANCED} at the size of what is drawn into. */
  public static RenderOptions defaults() {
    return builder().build();
  }

  /** These options at a size. */
  public static RenderOptions ofSize(int width, int height) {
    return builder().size(width, height).build();
  }

  /** Options to be chosen. */
  public static Builder builder() {
    return new Builder(new ArrayList<>());
  }

  /** A builder that begins with these options. */
  public Builder toBuilder() {
    return new Builder(new ArrayList<>(settings));
  }

  /** Names and values in turn, as native code takes them. */
  String[] settings() {
    return settings.toArray(new String[0]);
  }

  @Override
  public String toString() {
    return "RenderOptions" + settings;
  }

  /** Chooses options. What is not chosen is as the method says. */
  public static final class Builder {
    private final List<String> settings;

    private Builder(List<String> settings) {
      this.settings = settings;
    }

    private Builder set(String name, Object value) {
      settings.add(name);
      settings.add(value.toString());
      return this;
    }

    private Builder levels(String name, float fine, float coarse) {
      return set(name, fine + "," + coarse);
    }

    /**
     * Rules and tolerances to begin with. Replaces whatever was chosen before of those below {@link
     * #depth}, so choose it first.
     */
    public Builder method(Method method) {
      return set("method", method.name().toLowerCase(Locale.ROOT));
    }

    /**
     * Size of the picture in pixels, 1 to 16384 each way. Without it a picture has the size of the
     * Bitmap or Surface.
     */
    public Builder size(int width, int height) {
      return set("size", width + "," + height);
    }

    /** Samples per pixel and axis: 1 (the default), 2 or 4, so 1, 4 or 16 a pixel. */
    public Builder samples(int samples) {
      return set("samples", samples);
    }

    /** Which pixels get rays. */
    public Builder mode(Mode mode) {
      return set("mode", mode.name().toLowerCase(Locale.ROOT));
    }

    /** Most reflections and refractions in a row, 0 to 64; 4 by default. */
    public Builder depth(int depth) {
      return set("depth", depth);
    }

    /** Side of the blocks of which one pixel is always traced: 2 or 4. */
    public Builder block(int pixels) {
      return set("block", pixels);
    }

    /** Switches a test off: pixels are rebuilt where it alone would have failed. */
    public Builder disableTest(Test test) {
      return set("disableTest", test.nativeName);
    }

    /** {@link Test#G2}: largest distance, as a share of the scene's size, 0 or more. */
    public Builder tPos(float share) {
      return tPos(share, share);
    }

    /** As {@link #tPos(float)}, for references two and four pixels apart. */
    public Builder tPos(float fine, float coarse) {
      return levels("tPos", fine, coarse);
    }

    /** {@link Test#G3}: least dot product of the normals, -1 to 2. */
    public Builder tNorm(float dotProduct) {
      return tNorm(dotProduct, dotProduct);
    }

    /** As {@link #tNorm(float)}, for references two and four pixels apart. */
    public Builder tNorm(float fine, float coarse) {
      return levels("tNorm", fine, coarse);
    }

    /** {@link Test#G4}: sine of the slope below which a surface counts as flat, 0 to 1. */
    public Builder tConv(float sine) {
      return tConv(sine, sine);
    }

    /** As {@link #tConv(float)}, for references two and four pixels apart. */
    public Builder tConv(float fine, float coarse) {
      return levels("tConv", fine, coarse);
    }

    /** {@link Test#TX}: how far apart texture coordinates may be, 0 to 1. */
    public Builder tTex(float share) {
      return tTex(share, share);
    }

    /** As {@link #tTex(float)}, for references two and four pixels apart. */
    public Builder tTex(float fine, float coarse) {
      return levels("tTex", fine, coarse);
    }

    /** {@link Test#GC}: largest distance of reflected colours, 0 or more. */
    public Builder tGcol(float distance) {
      return tGcol(distance, distance);
    }

    /** As {@link #tGcol(float)}, for references two and four pixels apart. */
    public Builder tGcol(float fine, float coarse) {
      return levels("tGcol", fine, coarse);
    }

    /** What post-correction compares. */
    public Builder correction(Correction correction) {
      return set("correction", correction.nativeName);
    }

    /** Keeps what a layer needs, so that {@link RayTracer#layer} can draw it after the frame. */
    public Builder keepLayer(Layer layer) {
      return set("keepLayer", layer.nativeName);
    }

    /** Whether rays and work are counted, which costs time: see {@link FrameStats#hasCounters}. */
    public Builder counters(boolean counters) {
      return set("counters", counters);
    }

    /** The options as chosen so far. */
    public RenderOptions build() {
      return new RenderOptions(new ArrayList<>(settings));
    }
  }
}
