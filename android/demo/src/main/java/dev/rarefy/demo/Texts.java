// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo;

import android.content.res.Resources;
import dev.rarefy.RenderOptions;
import dev.rarefy.demo.logic.SceneChoice;
import dev.rarefy.demo.logic.Settings;
import dev.rarefy.demo.logic.Shown;
import dev.rarefy.demo.logic.Tolerance;
import dev.rarefy.demo.logic.Words;
import java.util.Locale;
import org.jspecify.annotations.Nullable;

/** The app's texts for what the logic speaks of. */
final class Texts implements Words {
  private final Resources resources;

  Texts(Resources resources) {
    this.resources = resources;
  }

  /** The language and region of the texts. */
  @SuppressWarnings("deprecation") // The list of languages is newer than API 23.
  Locale locale() {
    return resources.getConfiguration().locale;
  }

  @Override
  public String say(Word word, Object... with) {
    return resources.getString(id(word), with);
  }

  private static int id(Word word) {
    switch (word) {
      case FRAME:
        return R.string.frame;
      case COARSE_FRAME:
        return R.string.frame_coarse;
      case RAYS:
        return R.string.frame_rays;
      case TRACED:
        return R.string.frame_traced;
      case FELL_BACK:
        return R.string.frame_fell_back;
      case SPEEDUP:
        return R.string.frame_speedup;
      case DEVICE:
        return R.string.device;
      case CPU:
        return R.string.device_cpu;
      case OPENING_FAILED:
        return R.string.opening_failed;
      case DRAWING_FAILED:
        return R.string.drawing_failed;
      case BENCHMARK_FAILED:
        return R.string.benchmark_failed;
      case MEMORY_FAILED:
        return R.string.memory_failed;
      case DEFECT:
        return R.string.defect;
      case DRIVER_CRASHED:
        return R.string.driver_crashed;
      case DRIVER_FAILED:
        return R.string.driver_failed;
      case BENCHMARK_ROW:
        return R.string.benchmark_row;
      case METHOD_BALANCED:
        return R.string.method_balanced;
      case METHOD_FAST:
        return R.string.method_fast;
      case METHOD_PAPER:
        return R.string.method_paper;
    }
    throw new AssertionError(word);
  }

  String mode(Settings.Mode mode) {
    switch (mode) {
      case FULL:
        return resources.getString(R.string.mode_full);
      case ADAPTIVE:
        return resources.getString(R.string.mode_adaptive);
      case SPLIT:
        return resources.getString(R.string.mode_split);
    }
    throw new AssertionError(mode);
  }

  String method(RenderOptions.Method method) {
    switch (method) {
      case BALANCED:
        return resources.getString(R.string.method_balanced);
      case FAST:
        return resources.getString(R.string.method_fast);
      case PAPER:
        return resources.getString(R.string.method_paper);
    }
    throw new AssertionError(method);
  }

  String shown(Shown shown) {
    return resources.getString(shownId(shown));
  }

  private static int shownId(Shown shown) {
    switch (shown) {
      case PICTURE:
        return R.string.layer_picture;
      case CLASS:
        return R.string.layer_class;
      case FAIL_MASK:
        return R.string.layer_fail_mask;
      case TEST_G1:
        return R.string.layer_test_g1;
      case TEST_G2:
        return R.string.layer_test_g2;
      case TEST_G3:
        return R.string.layer_test_g3;
      case TEST_G4:
        return R.string.layer_test_g4;
      case TEST_TX:
        return R.string.layer_test_tx;
      case TEST_SH:
        return R.string.layer_test_sh;
      case TEST_GC:
        return R.string.layer_test_gc;
      case DIFFERENCE:
        return R.string.layer_difference;
    }
    throw new AssertionError(shown);
  }

  String correction(RenderOptions.@Nullable Correction correction) {
    if (correction == null) {
      return resources.getString(R.string.correction_method);
    }
    switch (correction) {
      case OFF:
        return resources.getString(R.string.correction_off);
      case OBJECT:
        return resources.getString(R.string.correction_object);
      case OBJECT_AND_SHADOW:
        return resources.getString(R.string.correction_object_shadow);
      case ALL:
        return resources.getString(R.string.correction_all);
    }
    throw new AssertionError(correction);
  }

  String tolerance(Tolerance tolerance) {
    switch (tolerance) {
      case T_POS:
        return resources.getString(R.string.tolerance_t_pos);
      case T_NORM:
        return resources.getString(R.string.tolerance_t_norm);
      case T_CONV:
        return resources.getString(R.string.tolerance_t_conv);
      case T_TEX:
        return resources.getString(R.string.tolerance_t_tex);
      case T_GCOL:
        return resources.getString(R.string.tolerance_t_gcol);
    }
    throw new AssertionError(tolerance);
  }

  /** A scene's name; a file's own name for one that the user opened. */
  String scene(SceneChoice scene) {
    if (scene.kind() == SceneChoice.Kind.OBJ || scene.kind() == SceneChoice.Kind.BAKED) {
      return scene.shortName();
    }
    switch (scene.name()) {
      case "kitchen":
        return resources.getString(R.string.scene_kitchen);
      case "bathroom":
        return resources.getString(R.string.scene_bathroom);
      case "cafe":
        return resources.getString(R.string.scene_cafe);
      case "spheres":
        return resources.getString(R.string.scene_spheres);
      case "rods":
        return resources.getString(R.string.scene_rods);
      case "mirror-room":
        return resources.getString(R.string.scene_mirror_room);
      case "wall":
        return resources.getString(R.string.scene_wall);
      default:
        return scene.shortName();
    }
  }
}
