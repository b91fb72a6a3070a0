// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo;

import static org.junit.Assert.assertEquals;

import android.graphics.Bitmap;
import android.graphics.Rect;
import android.text.Layout;
import android.view.View;
import android.view.ViewGroup;
import android.widget.ScrollView;
import android.widget.TextView;
import java.util.ArrayList;
import java.util.List;

/**
 * Looks at a screen as a user does: is anything cut off, hidden by the system's bars, unreadable?
 */
final class Look {
  private Look() {}

  /** The screen must be as stored, and have nothing that a user would complain of. */
  static void at(Phone phone, String name) {
    phone.showBars();
    phone.standStill();
    Bitmap picture = phone.picture();
    Golden.check(name, picture);
    List<String> problems = problems(phone.decor());
    problems.addAll(Accessibility.findings(phone.decor(), picture));
    assertEquals(name, "", String.join("\n", problems));
  }

  /** Texts that are cut off, and what lies under the system's bars. */
  static List<String> problems(View decor) {
    Rect clear =
        new Rect(
            0,
            Phone.pixels(decor, Phone.STATUS_BAR),
            decor.getWidth(),
            decor.getHeight() - Phone.pixels(decor, Phone.NAVIGATION_BAR));
    List<String> problems = new ArrayList<>();
    look(decor, clear, problems);
    return problems;
  }

  private static void look(View view, Rect clear, List<String> problems) {
    if (view.getVisibility() != View.VISIBLE) {
      return;
    }
    if (view instanceof TextView) {
      TextView text = (TextView) view;
      Layout layout = text.getLayout();
      if (layout != null && text.length() > 0) {
        int height = layout.getHeight() + text.getTotalPaddingTop() + text.getTotalPaddingBottom();
        if (height > text.getHeight() + 1) {
          problems.add("cut off below: " + text.getText());
        }
        for (int line = 0; line < layout.getLineCount(); line++) {
          if (layout.getEllipsisCount(line) > 0) {
            problems.add("shortened: " + text.getText());
          }
          if (layout.getLineMax(line) > layout.getWidth() + 1) {
            problems.add("cut off aside: " + text.getText());
          }
        }
      }
    }
    boolean said = view instanceof TextView || view.isClickable() && !(view instanceof ViewGroup);
    if (said && view.getId() != R.id.picture && view.getId() != R.id.divider && !scrolls(view)) {
      int[] at = new int[2];
      view.getLocationInWindow(at);
      Rect place = new Rect(at[0], at[1], at[0] + view.getWidth(), at[1] + view.getHeight());
      if (!clear.contains(place)) {
        problems.add("under the system's bars, or outside: " + view + " at " + place);
      }
    }
    if (view instanceof ViewGroup) {
      ViewGroup group = (ViewGroup) view;
      for (int at = 0; at < group.getChildCount(); at++) {
        look(group.getChildAt(at), clear, problems);
      }
    }
  }

  /** What a scroll view clips comes into view when it is scrolled. */
  private static boolean scrolls(View view) {
    for (Object parent = view.getParent(); parent instanceof View; ) {
      if (parent instanceof ScrollView) {
        return true;
      }
      parent = ((View) parent).getParent();
    }
    return false;
  }
}
