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
import java.util.Arrays;
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

  /** What a value of a list is called. */
  private interface Naming<T extends @Nullable Object> {
    String name(T value);
  }

  /** A value of a list was chosen. */
  private interface Choice<T extends @Nullable Object> {
    void chosen(T value);
  }

  private static final List<Settings.Mode> MODES = Arrays.asList(Settings.Mode.values());
  private static final List<RenderOptions.Method> METHODS =
      Arrays.asList(RenderOptions.Method.values());
  private static final List<Shown> LAYERS = Arrays.asList(Shown.values());

  /** First null, for what the method says. */
  private static final List<RenderOptions.@Nullable Correction> CORRECTIONS = corrections();

  private static List<RenderOptions.@Nullable Correction> corrections() {
    List<RenderOptions.@Nullable Correction> corrections = new ArrayList<>();
    corrections.add(null);
    corrections.addAll(Arrays.asList(RenderOptions.Correction.values()));
    return corrections;
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
    select(R.id.mode, MODES.indexOf(settings.mode()));
    select(R.id.method, METHODS.indexOf(settings.method()));
    select(R.id.layer, LAYERS.indexOf(settings.shown()));
    select(R.id.samples, Settings.SAMPLES.indexOf(settings.samples()));
    select(R.id.correction, CORRECTIONS.indexOf(settings.correction()));
    select(R.id.resolution, Settings.RESOLUTIONS.indexOf(settings.resolution()));
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
      list(R.id.scene, new ArrayList<>(scenes), texts::scene, listener::chosen);
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
    list(R.id.mode, MODES, texts::mode, mode -> change(settings.withMode(mode)));
    list(R.id.method, METHODS, texts::method, method -> change(settings.withMethod(method)));
    list(R.id.layer, LAYERS, texts::shown, shown -> change(settings.withShown(shown)));
    list(
        R.id.samples,
        Settings.SAMPLES,
        each -> String.format(texts.locale(), "%d", each * each),
        each -> change(settings.withSamples(each)));
    list(
        R.id.correction,
        CORRECTIONS,
        texts::correction,
        correction -> change(settings.withCorrection(correction)));
    list(
        R.id.resolution,
        Settings.RESOLUTIONS,
        percent -> overlay.percent(percent / 100.0),
        percent -> change(settings.withResolution(percent)));
  }

  private <T extends @Nullable Object> void list(
      int id, List<T> values, Naming<T> naming, Choice<T> choice) {
    List<String> names = new ArrayList<>();
    for (T value : values) {
      names.add(naming.name(value));
    }
    Spinner spinner = root.findViewById(id);
    ArrayAdapter<String> adapter = new ArrayAdapter<>(root.getContext(), R.layout.choice, names);
    adapter.setDropDownViewResource(R.layout.choice_listed);
    spinner.setAdapter(adapter);
    spinner.setOnItemSelectedListener(
        new AdapterView.OnItemSelectedListener() {
          @Override
          public void onItemSelected(AdapterView<?> parent, @Nullable View view, int at, long row) {
            choice.chosen(values.get(at));
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
}
