// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo;

import android.graphics.Bitmap;
import android.view.View;
import android.view.ViewGroup;
import android.widget.TextView;
import com.google.android.apps.common.testing.accessibility.framework.AccessibilityCheckPreset;
import com.google.android.apps.common.testing.accessibility.framework.AccessibilityCheckResult.AccessibilityCheckResultType;
import com.google.android.apps.common.testing.accessibility.framework.AccessibilityHierarchyCheck;
import com.google.android.apps.common.testing.accessibility.framework.AccessibilityHierarchyCheckResult;
import com.google.android.apps.common.testing.accessibility.framework.Parameters;
import com.google.android.apps.common.testing.accessibility.framework.ResultMetadata;
import com.google.android.apps.common.testing.accessibility.framework.checks.DuplicateSpeakableTextCheck;
import com.google.android.apps.common.testing.accessibility.framework.checks.RedundantDescriptionCheck;
import com.google.android.apps.common.testing.accessibility.framework.checks.TextContrastCheck;
import com.google.android.apps.common.testing.accessibility.framework.uielement.AccessibilityHierarchyAndroid;
import com.google.android.apps.common.testing.accessibility.framework.utils.contrast.BitmapImage;
import java.util.ArrayList;
import java.util.List;

/** Google's accessibility checks: names for what can be touched, sizes of targets, contrasts. */
final class Accessibility {
  private Accessibility() {}

  /** What is wrong with a screen, a line each. */
  static List<String> findings(View screen, Bitmap picture) {
    AccessibilityHierarchyAndroid hierarchy =
        AccessibilityHierarchyAndroid.newBuilder(screen).build();
    Parameters parameters = new Parameters();
    parameters.putScreenCapture(new BitmapImage(picture));
    List<String> findings = new ArrayList<>();
    for (AccessibilityHierarchyCheck check :
        AccessibilityCheckPreset.getAccessibilityHierarchyChecksForPreset(
            AccessibilityCheckPreset.LATEST)) {
      if (check instanceof RedundantDescriptionCheck) {
        // Its words are in a file that the package lacks.
        continue;
      }
      for (AccessibilityHierarchyCheckResult result :
          check.runCheckOnHierarchy(hierarchy, null, parameters)) {
        AccessibilityCheckResultType type = result.getType();
        if (check instanceof DuplicateSpeakableTextCheck && !confuses(screen, result)) {
          continue;
        }
        if (isAtScrollableEdge(result)) {
          // Cut by the edge of what scrolls, where its colours tell nothing.
          continue;
        }
        if (type == AccessibilityCheckResultType.ERROR
            || type == AccessibilityCheckResultType.WARNING) {
          String where = result.getElement() == null ? "" : " " + result.getElement();
          findings.add(
              check.getClass().getSimpleName()
                  + " "
                  + result.getResultId()
                  + " "
                  + result.getMetadata()
                  + where);
        }
      }
    }
    return findings;
  }

  /**
   * A control that is called as its label or heading is as it should be; two controls of one name
   * are not.
   */
  private static boolean confuses(View screen, AccessibilityHierarchyCheckResult result) {
    ResultMetadata metadata = result.getMetadata();
    return metadata == null
        || controls(screen, metadata.getString(DuplicateSpeakableTextCheck.KEY_SPEAKABLE_TEXT)) > 1;
  }

  private static boolean isAtScrollableEdge(AccessibilityHierarchyCheckResult result) {
    ResultMetadata metadata = result.getMetadata();
    return metadata != null
        && metadata.getBoolean(TextContrastCheck.KEY_IS_AGAINST_SCROLLABLE_EDGE, false);
  }

  private static int controls(View view, String name) {
    if (view.getVisibility() != View.VISIBLE) {
      return 0;
    }
    CharSequence own = view.getContentDescription();
    if (own == null && view instanceof TextView) {
      own = ((TextView) view).getText();
    }
    int count = view.isClickable() && own != null && name.contentEquals(own) ? 1 : 0;
    if (view instanceof ViewGroup) {
      ViewGroup group = (ViewGroup) view;
      for (int at = 0; at < group.getChildCount(); at++) {
        count += controls(group.getChildAt(at), name);
      }
    }
    return count;
  }
}
