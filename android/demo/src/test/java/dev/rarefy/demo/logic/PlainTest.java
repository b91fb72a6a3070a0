// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo.logic;

import dev.rarefy.Camera;
import java.io.ByteArrayInputStream;
import java.io.File;
import java.io.IOException;
import java.nio.ByteBuffer;
import java.nio.charset.StandardCharsets;
import java.nio.file.Files;
import java.util.Arrays;
import java.util.LinkedHashMap;
import java.util.Map;

/** What is small: cameras as text, scenes, files, pictures of pictures, heat, JSON. */
public final class PlainTest {
  private PlainTest() {}

  public static void main(String[] arguments) throws Exception {
    camerasAsText();
    scenesAsText();
    filesOfThePicker(new File(arguments[0]));
    picturesOfPictures();
    heatAndMemory();
    json();
    System.out.println("done");
  }

  private static void camerasAsText() {
    Camera camera = Camera.lookingAt(1, 2, 3, -4, 5.5f, 1e-7f).withUp(0, 2, 1).withFovYDegrees(33);
    Check.equal(camera, Cameras.fromText(Cameras.toText(camera)));
    for (String bad :
        new String[] {
          null,
          "",
          "1",
          "1 2 3 4 5 6 7 8 9 x",
          "1 2 3 1 2 3 0 1 0 45",
          "1 2 3 4 5 6 0 0 0 45",
          "1 2 3 4 5 6 0 1 0 180",
          "NaN 2 3 4 5 6 0 1 0 45",
          "1 2 3 4 5 6 0 1 0 45 7"
        }) {
      Check.that(Cameras.fromText(bad) == null, "a camera of: " + bad);
    }
  }

  private static void scenesAsText() {
    for (SceneChoice scene : SceneChoice.LISTED) {
      Check.equal(scene, SceneChoice.fromText(scene.toText()));
    }
    SceneChoice opened = SceneChoice.opened(new File("/a b/c.obj"), false);
    Check.equal(opened, SceneChoice.fromText(opened.toText()));
    Check.equal("c.obj", opened.shortName());
    for (String bad : new String[] {null, "", "ASSET", "ASSET ../secret", "BUILTIN x", "OBJ "}) {
      Check.equal(SceneChoice.LISTED.get(0), SceneChoice.fromText(bad));
    }
  }

  private static SceneChoice copied(File folder, String name, String text, long most)
      throws IOException {
    byte[] bytes = text.getBytes(StandardCharsets.ISO_8859_1);
    return OpenedFile.copy(new ByteArrayInputStream(bytes), name, folder, most);
  }

  private static void filesOfThePicker(File outer) throws Exception {
    File folder = new File(outer, "opened/scenes");
    SceneChoice obj = copied(folder, "chair.obj", "v 0 0 0\n", 100);
    Check.equal(SceneChoice.Kind.OBJ, obj.kind());
    Check.equal(new File(folder, "chair.obj").getPath(), obj.name());
    Check.equal("v 0 0 0\n", new String(Files.readAllBytes(new File(obj.name()).toPath())));
    SceneChoice baked = copied(folder, "x", "rarefy baked\r\n\032\n....", 100);
    Check.equal(SceneChoice.Kind.BAKED, baked.kind());
    Check.that(!new File(obj.name()).exists(), "the old copy is gone");
    for (String name :
        new String[] {"../../evil", "/etc/passwd", "", null, "..", ".hidden", "ä/ö?"}) {
      SceneChoice choice = copied(folder, name, "v", 100);
      File file = new File(choice.name());
      Check.equal(folder.getCanonicalFile(), file.getCanonicalFile().getParentFile());
      Check.that(file.isFile() && !file.isHidden(), choice.name());
    }
    Check.equal("b.obj", copied(folder, "a/b.obj", "v", 100).shortName());
    String before = folder.list()[0];
    Check.thrown(OpenedFile.TooLarge.class, () -> copied(folder, "large", "12345678901", 10));
    Check.equal(Arrays.asList(before), Arrays.asList(folder.list()));
    copied(folder, "fits", "1234567890", 10);
    File file = new File(outer, "file");
    Check.that(file.createNewFile(), "a file");
    Check.thrown(IOException.class, () -> copied(new File(file, "in"), "a", "v", 10));
  }

  private static ByteBuffer pixels(int... bytes) {
    ByteBuffer buffer = ByteBuffer.allocateDirect(bytes.length);
    for (int at = 0; at < bytes.length; at++) {
      buffer.put(at, (byte) bytes[at]);
    }
    return buffer;
  }

  private static void picturesOfPictures() {
    ByteBuffer one = pixels(1, 2, 3, 255, 5, 6, 7, 255, 9, 10, 11, 255, 13, 14, 15, 255);
    ByteBuffer other = pixels(1, 4, 3, 255, 50, 6, 7, 255, 9, 10, 0, 255, 13, 14, 15, 255);
    ByteBuffer into = ByteBuffer.allocateDirect(16);
    Composer.split(one, other, into, 2, 2, 1);
    Check.equal(pixels(1, 2, 3, 255, 50, 6, 7, 255, 9, 10, 11, 255, 13, 14, 15, 255), into);
    Composer.split(one, other, into, 2, 2, 0);
    Check.equal(other, into);
    Composer.split(one, other, into, 2, 2, 2);
    Check.equal(one, into);
    Composer.difference(one, other, into, 2, 2);
    Check.equal(pixels(0, 20, 0, 255, 255, 0, 0, 255, 0, 0, 110, 255, 0, 0, 0, 255), into);
    Check.equal(Double.POSITIVE_INFINITY, Composer.psnr(one, one, 4));
    double mean = (2 * 2 + 45 * 45 + 11 * 11) / 12.0;
    Check.near(10 * Math.log10(255 * 255 / mean), Composer.psnr(one, other, 4), 1e-9, "PSNR");
    Check.equal(0, one.position());
  }

  private static void heatAndMemory() {
    double last = 2;
    for (int status = 0; status <= 6; status++) {
      double scale = ThermalPolicy.scale(status);
      Check.that(scale > 0 && scale <= last && scale <= 1, "scale of " + status + ": " + scale);
      last = scale;
    }
    Check.equal(1.0, ThermalPolicy.scale(0));
    Check.equal(0.5, ThermalPolicy.scale(3));
    Check.equal(0.25, ThermalPolicy.scale(99));
    Check.equal(1.0, ThermalPolicy.scale(-1));
    Resolution resolution = new Resolution();
    for (int frame = 0; frame < 30; frame++) {
      // A device that draws a refined frame in 800 ms, and others in proportion to their pixels.
      resolution.took(800 * resolution.coarse() * resolution.coarse(), resolution.coarse());
    }
    Check.near(0.25, resolution.coarse(), 0.01, "a quarter of the sides take 50 ms");
    for (int frame = 0; frame < 30; frame++) {
      resolution.took(5, 1);
    }
    Check.equal(1.0, resolution.coarse());
    for (double strange : new double[] {0, -1, Double.NaN, Double.POSITIVE_INFINITY, 1e300}) {
      resolution.took(strange, 1);
      Check.that(resolution.coarse() >= 0.125 && resolution.coarse() <= 1, "after " + strange);
    }
    int shrunk = 0;
    while (resolution.shrink()) {
      shrunk++;
    }
    Check.equal(4, shrunk);
    Check.equal(1, Resolution.side(3, 0.01));
    Check.equal(16384, Resolution.side(100000, 1));
  }

  private static void json() {
    Map<String, Object> map = new LinkedHashMap<>();
    map.put("text", "a\"\\\n\u0001é\ud83d\ude00");
    map.put("list", Arrays.asList(1, 2.5, true, null, Double.NaN, Double.POSITIVE_INFINITY));
    map.put("empty", new LinkedHashMap<>());
    Check.equal(
        "{\n  \"text\": \"a\\\"\\\\\\u000a\\u0001é\\ud83d\\ude00\",\n  \"list\": [\n    1,\n"
            + "    2.5,\n    true,\n    null,\n    null,\n    null\n  ],\n  \"empty\": {\n  }\n}\n",
        Json.text(map));
  }
}
