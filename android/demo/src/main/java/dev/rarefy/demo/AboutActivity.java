// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo;

import android.app.Activity;
import android.os.Bundle;
import android.view.View;
import android.widget.TextView;
import org.jspecify.annotations.Nullable;

/** What this app is, and what devices the phone has. */
public final class AboutActivity extends Activity {
  private static final String REPORT = "report";

  private @Nullable String report;

  @Override
  protected void onCreate(@Nullable Bundle state) {
    super.onCreate(state);
    setContentView(R.layout.about);
    EdgeToEdge.draw(getWindow());
    EdgeToEdge.pad(findViewById(R.id.about_root));
    String kept = state == null ? null : state.getString(REPORT);
    if (kept != null) {
      show(kept);
    } else {
      look();
    }
  }

  private void look() {
    Thread thread =
        new Thread(
            () -> {
              String text = Reports.device(getApplicationContext(), null, null);
              runOnUiThread(() -> show(text));
            },
            "rarefy-report");
    thread.start();
  }

  private void show(String text) {
    report = text;
    TextView view = findViewById(R.id.about_report);
    view.setText(text);
    View share = findViewById(R.id.about_share);
    share.setEnabled(true);
    share.setOnClickListener(button -> Reports.share(this, getString(R.string.about_device), text));
  }

  @Override
  protected void onSaveInstanceState(Bundle state) {
    super.onSaveInstanceState(state);
    state.putString(REPORT, report);
  }
}
