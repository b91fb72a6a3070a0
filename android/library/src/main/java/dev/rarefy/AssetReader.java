// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy;

import java.io.IOException;
import java.io.InputStream;
import org.jspecify.annotations.Nullable;

/**
 * Opens the files of a scene by name, for scenes that do not lie in a folder. For the assets of an
 * app it is one line: {@code name -> getAssets().open("kitchen/" + name)}.
 */
public interface AssetReader {
  /**
   * Opens a file. Called on the thread that opens the {@link RayTracer}, which closes the stream.
   *
   * @param name the file's name as the scene gives it: folders are parted by {@code /}, and there
   *     is no {@code .} or {@code ..}
   * @return the file's bytes from its start, or null if there is no such file
   * @throws java.io.FileNotFoundException if there is no such file, as with null
   * @throws IOException if it cannot be read; opening the RayTracer then ends with a {@link
   *     RayTracerException} that has this as its cause
   */
  @Nullable InputStream open(String name) throws IOException;
}
