// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo;

import android.app.Activity;
import android.os.Bundle;
import org.jspecify.annotations.Nullable;

/** What this app is, and what devices the phone has. */
public final class AboutActivity extends Activity {
  @Override
  protected void onCreate(@Nullable Bundle state) {
    super.onCreate(state);
    setContentView(R.layout.about);
  }
}
