// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo;

import android.content.Context;
import android.content.SharedPreferences;
import android.os.Bundle;
import dev.rarefy.Camera;
import dev.rarefy.demo.logic.Cameras;
import dev.rarefy.demo.logic.SceneChoice;
import dev.rarefy.demo.logic.Settings;
import java.util.HashMap;
import java.util.Map;
import org.jspecify.annotations.Nullable;

/** What outlives the process: settings and scene for ever, the camera until the user leaves. */
final class Saved {
  private static final String SCENE = "scene";
  private static final String CAMERA = "camera";
  private static final String PANEL = "panel";

  final Settings settings;
  final SceneChoice scene;
  final @Nullable Camera camera;
  final boolean panel;

  /** What was saved in a state that Android gives back, else in the preferences. */
  Saved(Context context, @Nullable Bundle state) {
    if (state != null) {
      Map<String, String> map = new HashMap<>();
      for (String key : Settings.defaults().toMap().keySet()) {
        String value = state.getString(key);
        if (value != null) {
          map.put(key, value);
        }
      }
      settings = Settings.fromMap(map);
      scene = SceneChoice.fromText(state.getString(SCENE));
      camera = Cameras.fromText(state.getString(CAMERA));
      panel = state.getBoolean(PANEL);
    } else {
      Map<String, String> map = new HashMap<>();
      for (Map.Entry<String, ?> entry : preferences(context).getAll().entrySet()) {
        if (entry.getValue() instanceof String) {
          map.put(entry.getKey(), (String) entry.getValue());
        }
      }
      settings = Settings.fromMap(map);
      scene = SceneChoice.fromText(map.get(SCENE));
      camera = null;
      panel = false;
    }
  }

  static void into(
      Bundle state, Settings settings, SceneChoice scene, @Nullable Camera camera, boolean panel) {
    for (Map.Entry<String, String> entry : settings.toMap().entrySet()) {
      state.putString(entry.getKey(), entry.getValue());
    }
    state.putString(SCENE, scene.toText());
    state.putString(CAMERA, camera == null ? null : Cameras.toText(camera));
    state.putBoolean(PANEL, panel);
  }

  static void into(Context context, Settings settings, SceneChoice scene) {
    SharedPreferences.Editor editor = preferences(context).edit();
    for (Map.Entry<String, String> entry : settings.toMap().entrySet()) {
      editor.putString(entry.getKey(), entry.getValue());
    }
    editor.putString(SCENE, scene.toText()).apply();
  }

  private static SharedPreferences preferences(Context context) {
    return context.getSharedPreferences("settings", Context.MODE_PRIVATE);
  }
}
