// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo;

import android.annotation.TargetApi;
import android.content.Context;
import android.os.Build;
import android.os.PowerManager;
import org.jspecify.annotations.Nullable;

/** Listens to how hot the phone is, where Android tells it (10 and later). */
final class Heat {
  /** Who hears of it. */
  interface Listener {
    /** A value of {@code PowerManager.THERMAL_STATUS_...}. */
    void status(int status);
  }

  private final Context context;
  private final Listener listener;
  private @Nullable Object registered;

  Heat(Context context, Listener listener) {
    this.context = context;
    this.listener = listener;
  }

  void start() {
    if (Build.VERSION.SDK_INT >= Build.VERSION_CODES.Q) {
      listen();
    }
  }

  void stop() {
    if (Build.VERSION.SDK_INT >= Build.VERSION_CODES.Q) {
      silence();
    }
  }

  @TargetApi(Build.VERSION_CODES.Q)
  private void listen() {
    PowerManager power = context.getSystemService(PowerManager.class);
    if (power != null && registered == null) {
      PowerManager.OnThermalStatusChangedListener heard = listener::status;
      power.addThermalStatusListener(heard);
      registered = heard;
    }
  }

  @TargetApi(Build.VERSION_CODES.Q)
  private void silence() {
    PowerManager power = context.getSystemService(PowerManager.class);
    Object heard = registered;
    registered = null;
    if (power != null && heard instanceof PowerManager.OnThermalStatusChangedListener) {
      power.removeThermalStatusListener((PowerManager.OnThermalStatusChangedListener) heard);
    }
  }
}
