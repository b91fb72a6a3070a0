// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo;

import android.annotation.TargetApi;
import android.app.Activity;
import android.os.Build;
import android.window.OnBackInvokedCallback;
import android.window.OnBackInvokedDispatcher;
import org.jspecify.annotations.Nullable;

/** What the back gesture does where Android asks for it beforehand (13 and later). */
final class Back {
  private final Activity activity;
  private final Runnable action;
  private @Nullable Object registered;

  Back(Activity activity, Runnable action) {
    this.activity = activity;
    this.action = action;
  }

  /** Whether back does the action; else it does what the system does. */
  void enable(boolean enabled) {
    if (Build.VERSION.SDK_INT >= Build.VERSION_CODES.TIRAMISU) {
      register(enabled);
    }
  }

  @TargetApi(Build.VERSION_CODES.TIRAMISU)
  private void register(boolean enabled) {
    OnBackInvokedDispatcher dispatcher = activity.getOnBackInvokedDispatcher();
    Object old = registered;
    if (enabled && old == null) {
      OnBackInvokedCallback callback = action::run;
      dispatcher.registerOnBackInvokedCallback(OnBackInvokedDispatcher.PRIORITY_DEFAULT, callback);
      registered = callback;
    } else if (!enabled && old instanceof OnBackInvokedCallback) {
      dispatcher.unregisterOnBackInvokedCallback((OnBackInvokedCallback) old);
      registered = null;
    }
  }
}
