// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo;

import android.content.res.Resources;
import android.view.LayoutInflater;
import android.view.View;
import android.view.ViewGroup;
import android.widget.AdapterView;
import android.widget.ArrayAdapter;
import android.widget.ImageButton;
import android.widget.SeekBar;
import android.widget.Spinner;
import android.widget.TextView;
import dev.rarefy.RenderOptions;
import dev.rarefy.demo.logic.Overlay;
import dev.rarefy.demo.logic.SceneChoice;
import dev.rarefy.demo.logic.Settings;
import dev.rarefy.demo.logic.Shown;
import dev.rarefy.demo.logic.Tolerance;
import java.util.ArrayList;
import java.util.EnumMap;
import java.util.List;
import java.util.Map;
import org.jspecify.annotations.Nullable;

/** The controls of the panel: they show the settings, and change them. */
final class Panel {
  /** Who hears of changes. */
  interface Listener {
    void changed(Settings settings);

    void chosen(SceneChoice scene);

    /** A slider is being dragged, or not any more. */
    void dragging(boolean dragging);
  }

  /** A choice of a list, by its place. */
  private interface Choice {
    void chosen(int at);
  }

  private final View root;
  private final Texts texts;
  private final Overlay overlay;
  private final Listener listener;
  private final List<SceneChoice> scenes = new ArrayList<>();
  private final Map<Tolerance, View> tolerances = new EnumMap<>(Tolerance.class);
  private Settings settings;

  Panel(View root, Texts texts, Settings settings, SceneChoice scene, Listener listener) {
    this.root = root;
    this.texts = texts;
    this.settings = settings;
    this.listener = listener;
    overlay = new Overlay(texts, texts.locale());
    lists();
    for (Tolerance tolerance : Tolerance.values()) {
      slider(tolerance);
    }
    show(settings);
    show(scene);
  }

  /** Shows other settings, which changes nothing but the controls. */
  void show(Settings settings) {
    this.settings = settings;
    select(R.id.mode, settings.mode().ordinal());
    select(R.id.method, settings.method().ordinal());
    select(R.id.layer, settings.shown().ordinal());
    select(R.id.samples, indexOf(Settings.SAMPLES, settings.samples()));
    RenderOptions.Correction correction = settings.correction();
    select(R.id.correction, correction == null ? 0 : correction.ordinal() + 1);
    select(R.id.resolution, indexOf(Settings.RESOLUTIONS, settings.resolution()));
    for (Tolerance tolerance : Tolerance.values()) {
      show(tolerance);
    }
  }

  /** Shows another scene; one that is not of the list is put at its end. */
  void show(SceneChoice scene) {
    if (!scenes.contains(scene)) {
      scenes.clear();
      scenes.addAll(SceneChoice.LISTED);
      if (!scenes.contains(scene)) {
        scenes.add(scene);
      }
      List<String> names = new ArrayList<>();
      for (SceneChoice each : scenes) {
        names.add(texts.scene(each));
      }
      list(R.id.scene, names, at -> listener.chosen(scenes.get(at)));
    }
    select(R.id.scene, scenes.indexOf(scene));
  }

  private void change(Settings changed) {
    if (!changed.equals(settings)) {
      show(changed);
      listener.changed(changed);
    }
  }

  private void lists() {
    List<String> modes = new ArrayList<>();
    for (Settings.Mode mode : Settings.Mode.values()) {
      modes.add(texts.mode(mode));
    }
    list(R.id.mode, modes, at -> change(settings.withMode(Settings.Mode.values()[at])));
    List<String> methods = new ArrayList<>();
    for (RenderOptions.Method method : RenderOptions.Method.values()) {
      methods.add(texts.method(method));
    }
    list(
        R.id.method, methods, at -> change(settings.withMethod(RenderOptions.Method.values()[at])));
    List<String> layers = new ArrayList<>();
    for (Shown shown : Shown.values()) {
      layers.add(texts.shown(shown));
    }
    list(R.id.layer, layers, at -> change(settings.withShown(Shown.values()[at])));
    List<String> samples = new ArrayList<>();
    for (int each : Settings.SAMPLES) {
      samples.add(String.format(texts.locale(), "%d", each * each));
    }
    list(R.id.samples, samples, at -> change(settings.withSamples(Settings.SAMPLES[at])));
    List<String> corrections = new ArrayList<>();
    corrections.add(texts.correction(null));
    for (RenderOptions.Correction correction : RenderOptions.Correction.values()) {
      corrections.add(texts.correction(correction));
    }
    list(
        R.id.correction,
        corrections,
        at ->
            change(
                settings.withCorrection(
                    at == 0 ? null : RenderOptions.Correction.values()[at - 1])));
    List<String> resolutions = new ArrayList<>();
    for (int percent : Settings.RESOLUTIONS) {
      resolutions.add(overlay.percent(percent / 100.0));
    }
    list(
        R.id.resolution,
        resolutions,
        at -> change(settings.withResolution(Settings.RESOLUTIONS[at])));
  }

  private void list(int id, List<String> names, Choice choice) {
    Spinner spinner = root.findViewById(id);
    ArrayAdapter<String> adapter = new ArrayAdapter<>(root.getContext(), R.layout.choice, names);
    adapter.setDropDownViewResource(R.layout.choice_listed);
    spinner.setAdapter(adapter);
    spinner.setOnItemSelectedListener(
        new AdapterView.OnItemSelectedListener() {
          @Override
          public void onItemSelected(AdapterView<?> parent, @Nullable View view, int at, long row) {
            choice.chosen(at);
          }

          @Override
          public void onNothingSelected(AdapterView<?> parent) {}
        });
  }

  private void select(int id, int at) {
    Spinner spinner = root.findViewById(id);
    if (spinner.getSelectedItemPosition() != at) {
      spinner.setSelection(at, false);
    }
  }

  private void slider(Tolerance tolerance) {
    ViewGroup list = root.findViewById(R.id.tolerances);
    View row = LayoutInflater.from(root.getContext()).inflate(R.layout.tolerance, list, false);
    // The rows come from one file, so that their views must not be restored by their ids.
    row.setSaveFromParentEnabled(false);
    list.addView(row);
    tolerances.put(tolerance, row);
    SeekBar bar = row.findViewById(R.id.tolerance_value);
    bar.setMax(Tolerance.STEPS);
    bar.setOnSeekBarChangeListener(
        new SeekBar.OnSeekBarChangeListener() {
          @Override
          public void onProgressChanged(SeekBar bar, int step, boolean user) {
            if (user) {
              change(settings.withTolerance(tolerance, tolerance.atStep(step)));
            }
          }

          @Override
          public void onStartTrackingTouch(SeekBar bar) {
            listener.dragging(true);
          }

          @Override
          public void onStopTrackingTouch(SeekBar bar) {
            listener.dragging(false);
          }
        });
    Resources resources = root.getResources();
    ImageButton reset = row.findViewById(R.id.tolerance_reset);
    reset.setContentDescription(resources.getString(R.string.reset_of, texts.tolerance(tolerance)));
    reset.setOnClickListener(view -> change(settings.withTolerance(tolerance, null)));
  }

  private void show(Tolerance tolerance) {
    View row = tolerances.get(tolerance);
    if (row == null) {
      return;
    }
    boolean set = settings.isSet(tolerance);
    String value = overlay.tolerance(settings.tolerance(tolerance));
    int id = set ? R.string.tolerance_set : R.string.tolerance_default;
    String text = root.getResources().getString(id, texts.tolerance(tolerance), value);
    TextView label = row.findViewById(R.id.tolerance_label);
    label.setText(text);
    SeekBar bar = row.findViewById(R.id.tolerance_value);
    bar.setContentDescription(text);
    bar.setProgress(tolerance.stepOf(settings.tolerance(tolerance)));
    row.findViewById(R.id.tolerance_reset).setEnabled(set);
  }

  private static int indexOf(int[] values, int value) {
    for (int at = 0; at < values.length; at++) {
      if (values[at] == value) {
        return at;
      }
    }
    return 0;
  }
}
