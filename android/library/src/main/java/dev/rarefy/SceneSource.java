// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy;

import java.io.File;
import java.util.Objects;
import org.jspecify.annotations.Nullable;

/** Where a scene comes from. Nothing is read before {@link RayTracer#open}. */
public abstract class SceneSource {
  private final String name;

  private SceneSource(String name) {
    this.name = name;
  }

  abstract void load(long handle, String[] device, @Nullable ProgressListener progress);

  /**
   * Files: a folder with {@code scene.obj} and {@code view.json}, or an OBJ file, whose camera and
   * light are fitted where there is no {@code view.json} beside it.
   */
  public static SceneSource files(File folderOrObj) {
    String path = folderOrObj.getPath();
    return new SceneSource(path) {
      @Override
      void load(long handle, String[] device, @Nullable ProgressListener progress) {
        Native.loadFiles(handle, path, device, progress);
      }
    };
  }

  /**
   * A scene that comes with the library: cafe, spheres, rods, mirror-room or wall. The desktop's
   * larger scenes, such as kitchen, are not in it; write them as files and make them assets.
   */
  public static SceneSource builtin(String name) {
    Objects.requireNonNull(name, "name");
    return new SceneSource(name) {
      @Override
      void load(long handle, String[] device, @Nullable ProgressListener progress) {
        Native.loadBuiltin(handle, name, device, progress);
      }
    };
  }

  /**
   * Files that an app opens by name, such as its assets.
   *
   * @param name name of the OBJ file, or of a folder with {@code scene.obj} ({@code ""} for the
   *     outermost); {@code view.json} is looked for beside it, MTL files and textures by the names
   *     that the files give
   * @param reader opens the files
   */
  public static SceneSource assets(String name, AssetReader reader) {
    Objects.requireNonNull(name, "name");
    Objects.requireNonNull(reader, "reader");
    return new SceneSource(name) {
      @Override
      void load(long handle, String[] device, @Nullable ProgressListener progress) {
        Native.loadAssets(handle, reader, name, device, progress);
      }
    };
  }

  /** A baked scene, made by {@code rarefy bake}: loads in a fraction of the time. */
  public static SceneSource baked(File file) {
    return baked(file, 0, -1);
  }

  /**
   * A baked scene that is a part of a larger file.
   *
   * @param offset where it begins, in bytes
   * @param length its length in bytes
   */
  public static SceneSource baked(File file, long offset, long length) {
    String path = file.getPath();
    return new SceneSource(path) {
      @Override
      void load(long handle, String[] device, @Nullable ProgressListener progress) {
        Native.loadBaked(handle, path, offset, length, device, progress);
      }
    };
  }

  /**
   * A baked scene that is a part of an open file, such as an asset of an app that is not
   * compressed: {@code AssetFileDescriptor} has all three numbers.
   *
   * @param descriptor number of the open file; it must stay open until the {@link RayTracer} is
   *     opened, and its position stays
   * @param offset where it begins, in bytes
   * @param length its length in bytes
   */
  public static SceneSource baked(int descriptor, long offset, long length) {
    return new SceneSource("descriptor " + descriptor) {
      @Override
      void load(long handle, String[] device, @Nullable ProgressListener progress) {
        Native.loadBakedDescriptor(handle, descriptor, offset, length, device, progress);
      }
    };
  }

  @Override
  public String toString() {
    return name;
  }
}
