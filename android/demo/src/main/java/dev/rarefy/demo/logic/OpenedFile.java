// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo.logic;

import java.io.File;
import java.io.FileOutputStream;
import java.io.IOException;
import java.io.InputStream;
import java.io.OutputStream;
import java.nio.charset.StandardCharsets;
import java.util.Arrays;
import org.jspecify.annotations.Nullable;

/**
 * Copies what the system's picker gives, since the right to read it may end with the process, and
 * the library reads files.
 */
public final class OpenedFile {
  /** The largest file that is taken. */
  public static final long MOST_BYTES = 512L << 20;

  /** What baked scenes begin with. */
  private static final byte[] BAKED = "rarefy baked".getBytes(StandardCharsets.US_ASCII);

  private OpenedFile() {}

  /** The file is larger than {@link #MOST_BYTES}. */
  public static final class TooLarge extends IOException {
    private static final long serialVersionUID = 1;

    TooLarge(long most) {
      super("more than " + (most >> 20) + " MiB");
    }
  }

  /**
   * Copies a scene into a folder, in which nothing else stays.
   *
   * @param stream the file; it is not closed
   * @param displayName its name as the picker gives it; whatever is in it, the copy stays in the
   *     folder
   * @param most more bytes than this are refused
   */
  public static SceneChoice copy(
      InputStream stream, @Nullable String displayName, File folder, long most) throws IOException {
    File part = new File(folder, "part");
    if (!folder.isDirectory() && !folder.mkdirs()) {
      throw new IOException("no folder " + folder);
    }
    boolean baked;
    try (OutputStream out = new FileOutputStream(part)) {
      byte[] buffer = new byte[1 << 16];
      byte[] start = new byte[BAKED.length];
      long copied = 0;
      for (int read = stream.read(buffer); read >= 0; read = stream.read(buffer)) {
        for (int at = 0; at < read && copied + at < start.length; at++) {
          start[(int) copied + at] = buffer[at];
        }
        copied += read;
        if (copied > most) {
          throw new TooLarge(most);
        }
        out.write(buffer, 0, read);
      }
      baked = Arrays.equals(start, BAKED);
    } catch (IOException | RuntimeException e) {
      // What is half there is of no use to anybody.
      part.delete();
      throw e;
    }
    File file = new File(folder, safe(displayName, baked));
    File[] old = folder.listFiles();
    for (File other : old == null ? new File[0] : old) {
      if (!other.equals(part)) {
        other.delete();
      }
    }
    if (!part.renameTo(file)) {
      throw new IOException("no file " + file);
    }
    return SceneChoice.opened(file, baked);
  }

  /** A file's name that stays in its folder. */
  private static String safe(@Nullable String displayName, boolean baked) {
    String name = displayName == null ? "" : new File(displayName).getName();
    StringBuilder clean = new StringBuilder();
    for (int at = 0; at < name.length() && clean.length() < 60; at++) {
      char c = name.charAt(at);
      clean.append(Character.isLetterOrDigit(c) || "-_. ".indexOf(c) >= 0 ? c : '_');
    }
    String ending = baked ? ".baked" : ".obj";
    String text = clean.toString();
    boolean hidden = text.isEmpty() || text.startsWith(".");
    text = hidden ? "scene" + text : text;
    return text.endsWith(ending) ? text : text + ending;
  }
}
