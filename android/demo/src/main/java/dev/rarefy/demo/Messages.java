// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo;

import android.app.Activity;
import android.view.View;
import android.widget.Button;
import android.widget.ProgressBar;
import android.widget.TextView;
import dev.rarefy.RayTracerException;
import dev.rarefy.demo.logic.Benchmark;
import dev.rarefy.demo.logic.Overlay;
import dev.rarefy.demo.logic.RenderLoop;
import dev.rarefy.demo.logic.State;

/** The lines over the picture, the progress, and the message with its buttons. */
final class Messages {
  /** Side of the benchmark's picture in pixels, as in the paper. */
  static final int BENCHMARK_SIDE = 1024;

  private final Activity activity;
  private final RenderLoop loop;
  private final Texts texts;
  private final Overlay overlay;
  private final TextView lines;
  private final View progress;
  private final TextView progressText;
  private final ProgressBar progressBar;
  private final View progressCancel;
  private final View message;
  private final TextView messageText;
  private final Button retry;
  private final Button share;
  private final View close;

  /** What the user has closed; it does not come again. */
  private String closed;

  Messages(Activity activity, RenderLoop loop, Texts texts, String closed) {
    this.activity = activity;
    this.loop = loop;
    this.texts = texts;
    this.closed = closed;
    overlay = new Overlay(texts, texts.locale());
    lines = activity.findViewById(R.id.overlay);
    progress = activity.findViewById(R.id.progress);
    progressText = activity.findViewById(R.id.progress_text);
    progressBar = activity.findViewById(R.id.progress_bar);
    progressCancel = activity.findViewById(R.id.progress_cancel);
    message = activity.findViewById(R.id.message);
    messageText = activity.findViewById(R.id.message_text);
    retry = activity.findViewById(R.id.message_retry);
    share = activity.findViewById(R.id.message_share);
    close = activity.findViewById(R.id.message_close);
    progressCancel.setOnClickListener(view -> loop.cancelBenchmark());
  }

  /** The message that the user closed. */
  String closed() {
    return closed;
  }

  void show(State state) {
    StringBuilder text = new StringBuilder();
    for (String line : overlay.lines(state)) {
      text.append(text.length() == 0 ? "" : "\n").append(line);
    }
    set(lines, text.toString());
    lines.setVisibility(visible(text.length() > 0));
    showProgress(state);
    Benchmark.Result result = state.benchmark();
    String told = overlay.message(state, texts.scene(state.scene()));
    if (state.failure() == null && result != null) {
      showBenchmark(result);
    } else if (told != null && !told.equals(closed)) {
      showTold(state, told);
    } else {
      message.setVisibility(View.GONE);
    }
  }

  private void showProgress(State state) {
    boolean opens = state.phase() == State.Phase.OPENING;
    boolean measures = state.phase() == State.Phase.BENCHMARK;
    progress.setVisibility(visible(opens || measures));
    progressCancel.setVisibility(visible(measures));
    progress.setKeepScreenOn(measures);
    int id = measures ? R.string.benchmark_running : R.string.opening;
    set(progressText, activity.getString(id, texts.scene(state.scene())));
    progressBar.setProgress(Math.round(state.progress() * progressBar.getMax()));
  }

  private void showTold(State state, String told) {
    boolean failed = state.failure() != null;
    boolean crash = state.device() != null && Overlay.crashed(state.device()) != null;
    message.setVisibility(View.VISIBLE);
    set(messageText, told);
    retry.setText(crash && !failed ? R.string.retry_driver : R.string.retry);
    retry.setVisibility(View.VISIBLE);
    retry.setOnClickListener(view -> loop.retry(isCrash(state)));
    share.setText(R.string.share_report);
    share.setOnClickListener(view -> shareReport(state));
    // A failure has nothing behind it to go back to.
    close.setVisibility(visible(!failed));
    close.setOnClickListener(
        view -> {
          closed = told;
          show(loop.state());
        });
  }

  private static boolean isCrash(State state) {
    if (state.failure() != null) {
      return state.failure().code() == RayTracerException.Code.DRIVER_CRASHED;
    }
    // Whatever the driver did wrong: asked for by the user, it is tried again.
    return true;
  }

  private void showBenchmark(Benchmark.Result result) {
    message.setVisibility(View.VISIBLE);
    String side = String.format(texts.locale(), "%d", BENCHMARK_SIDE);
    String title = activity.getString(R.string.benchmark_done, side);
    set(messageText, title + "\n\n" + overlay.benchmark(result));
    retry.setVisibility(View.GONE);
    share.setText(R.string.share_benchmark);
    share.setOnClickListener(
        view -> Reports.share(activity, activity.getString(R.string.benchmark), result.json()));
    close.setVisibility(View.VISIBLE);
    close.setOnClickListener(view -> loop.takeBenchmark());
  }

  private void shareReport(State state) {
    String subject = activity.getString(R.string.share_report);
    Thread thread =
        new Thread(
            () -> {
              String text = Reports.device(activity, state.device(), state.failure()).all;
              activity.runOnUiThread(() -> Reports.share(activity, subject, text));
            },
            "rarefy-report");
    thread.start();
  }

  /** Setting the same text again would make a screen reader read it again. */
  private static void set(TextView view, String text) {
    if (!text.contentEquals(view.getText())) {
      view.setText(text);
    }
  }

  private static int visible(boolean visible) {
    return visible ? View.VISIBLE : View.GONE;
  }
}
