// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo;

import android.app.Activity;
import android.os.Bundle;
import org.jspecify.annotations.Nullable;

/** The only screen but one: the picture, and over it a panel of settings. */
public final class MainActivity extends Activity {
  @Override
  protected void onCreate(@Nullable Bundle state) {
    super.onCreate(state);
    setContentView(R.layout.main);
  }
}
