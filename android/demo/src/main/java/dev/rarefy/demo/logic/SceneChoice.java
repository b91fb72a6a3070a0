// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo.logic;

import dev.rarefy.AssetReader;
import dev.rarefy.SceneSource;
import java.io.File;
import java.util.Arrays;
import java.util.Collections;
import java.util.List;
import java.util.Objects;
import org.jspecify.annotations.Nullable;

/** A scene that a user can choose. A value that does not change. */
public final class SceneChoice {
  /** Where it comes from. */
  public enum Kind {
    /** A folder of the app's assets. */
    ASSET,
    /** One that comes with the library. */
    BUILTIN,
    /** An OBJ file that the user opened, copied to the app's cache. */
    OBJ,
    /** A baked file that the user opened, copied likewise. */
    BAKED
  }

  /** Those of the list, in its order; the first one is what a new user sees. */
  public static final List<SceneChoice> LISTED =
      Collections.unmodifiableList(
          Arrays.asList(
              new SceneChoice(Kind.ASSET, "kitchen"),
              new SceneChoice(Kind.ASSET, "bathroom"),
              new SceneChoice(Kind.BUILTIN, "cafe"),
              new SceneChoice(Kind.BUILTIN, "spheres"),
              new SceneChoice(Kind.BUILTIN, "rods"),
              new SceneChoice(Kind.BUILTIN, "mirror-room"),
              new SceneChoice(Kind.BUILTIN, "wall")));

  private final Kind kind;
  private final String name;

  private SceneChoice(Kind kind, String name) {
    this.kind = kind;
    this.name = name;
  }

  /** A file that the user opened. */
  public static SceneChoice opened(File file, boolean baked) {
    return new SceneChoice(baked ? Kind.BAKED : Kind.OBJ, file.getPath());
  }

  /** Where it comes from. */
  public Kind kind() {
    return kind;
  }

  /** The name that the library knows it by: a folder, a scene's name, a path. */
  public String name() {
    return name;
  }

  /** The last part of the name, for a file that has no name in the app's languages. */
  public String shortName() {
    return new File(name).getName();
  }

  /** What the library opens. */
  public SceneSource source(AssetReader assets) {
    switch (kind) {
      case ASSET:
        return SceneSource.assets(name, assets);
      case BUILTIN:
        return SceneSource.builtin(name);
      case OBJ:
        return SceneSource.files(new File(name));
      case BAKED:
        return SceneSource.baked(new File(name));
    }
    throw new AssertionError(kind);
  }

  /** As text, to be saved. */
  public String toText() {
    return kind.name() + ' ' + name;
  }

  /** The choice that was saved; the first of the list for anything else. */
  public static SceneChoice fromText(@Nullable String text) {
    if (text != null) {
      for (SceneChoice listed : LISTED) {
        if (listed.toText().equals(text)) {
          return listed;
        }
      }
      for (Kind kind : new Kind[] {Kind.OBJ, Kind.BAKED}) {
        String path =
            text.startsWith(kind.name() + ' ') ? text.substring(kind.name().length() + 1) : "";
        if (!path.isEmpty()) {
          return new SceneChoice(kind, path);
        }
      }
    }
    return LISTED.get(0);
  }

  @Override
  public boolean equals(@Nullable Object other) {
    return other instanceof SceneChoice && ((SceneChoice) other).toText().equals(toText());
  }

  @Override
  public int hashCode() {
    return Objects.hash(kind, name);
  }

  @Override
  public String toString() {
    return toText();
  }
}
