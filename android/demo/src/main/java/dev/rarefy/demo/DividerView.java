// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo;

import android.content.Context;
import android.util.AttributeSet;
import android.view.View;
import org.jspecify.annotations.Nullable;

/** The line of the split view, which a finger drags. */
public final class DividerView extends View {
  public DividerView(Context context, @Nullable AttributeSet attributes) {
    super(context, attributes);
  }
}
