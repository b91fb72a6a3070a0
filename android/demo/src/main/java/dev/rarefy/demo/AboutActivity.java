// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo;

import android.app.Activity;
import android.os.Bundle;
import android.view.View;
import android.widget.TextView;
import org.jspecify.annotations.Nullable;

/** What this app is, and what devices the phone has. */
public final class AboutActivity extends Activity {
  private static final String SUMMARY = "summary";
  private static final String ALL = "all";

  private Reports.@Nullable Report report;

  @Override
  protected void onCreate(@Nullable Bundle state) {
    super.onCreate(state);
    setContentView(R.layout.about);
    EdgeToEdge.draw(getWindow());
    EdgeToEdge.pad(findViewById(R.id.about_root));
    String summary = state == null ? null : state.getString(SUMMARY);
    String all = state == null ? null : state.getString(ALL);
    if (summary != null && all != null) {
      show(new Reports.Report(summary, all));
    } else {
      look();
    }
  }

  private void look() {
    Thread thread =
        new Thread(
            () -> {
              Reports.Report found = Reports.device(getApplicationContext(), null, null);
              runOnUiThread(() -> show(found));
            },
            "rarefy-report");
    thread.start();
  }

  private void show(Reports.Report found) {
    report = found;
    TextView view = findViewById(R.id.about_report);
    view.setText(found.summary);
    View share = findViewById(R.id.about_share);
    share.setEnabled(true);
    share.setOnClickListener(
        button -> Reports.share(this, getString(R.string.about_device), found.all));
  }

  @Override
  protected void onSaveInstanceState(Bundle state) {
    super.onSaveInstanceState(state);
    Reports.Report found = report;
    if (found != null) {
      state.putString(SUMMARY, found.summary);
      state.putString(ALL, found.all);
    }
  }
}
