// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo;

import android.annotation.TargetApi;
import android.os.Build;
import android.view.View;
import android.view.Window;
import android.view.WindowInsets;

/** Draws behind the system's bars, and keeps views clear of them. */
final class EdgeToEdge {
  private EdgeToEdge() {}

  /** The window's content goes to the edges of the screen. */
  static void draw(Window window) {
    if (Build.VERSION.SDK_INT >= Build.VERSION_CODES.R) {
      fitsNot(window);
    } else {
      drawBefore30(window);
    }
  }

  /** The view's padding keeps what is in it clear of bars and cut-outs. */
  static void pad(View view) {
    view.setOnApplyWindowInsetsListener(
        (padded, insets) -> {
          if (Build.VERSION.SDK_INT >= Build.VERSION_CODES.R) {
            padFrom30(padded, insets);
          } else {
            padBefore30(padded, insets);
          }
          return insets;
        });
  }

  @TargetApi(Build.VERSION_CODES.R)
  private static void fitsNot(Window window) {
    window.setDecorFitsSystemWindows(false);
  }

  @SuppressWarnings("deprecation") // What replaces it came with API 30.
  private static void drawBefore30(Window window) {
    window
        .getDecorView()
        .setSystemUiVisibility(
            View.SYSTEM_UI_FLAG_LAYOUT_STABLE
                | View.SYSTEM_UI_FLAG_LAYOUT_FULLSCREEN
                | View.SYSTEM_UI_FLAG_LAYOUT_HIDE_NAVIGATION);
  }

  @TargetApi(Build.VERSION_CODES.R)
  private static void padFrom30(View view, WindowInsets insets) {
    android.graphics.Insets clear =
        insets.getInsets(WindowInsets.Type.systemBars() | WindowInsets.Type.displayCutout());
    view.setPadding(clear.left, clear.top, clear.right, clear.bottom);
  }

  @SuppressWarnings("deprecation") // What replaces it came with API 30.
  private static void padBefore30(View view, WindowInsets insets) {
    view.setPadding(
        insets.getSystemWindowInsetLeft(),
        insets.getSystemWindowInsetTop(),
        insets.getSystemWindowInsetRight(),
        insets.getSystemWindowInsetBottom());
  }
}
