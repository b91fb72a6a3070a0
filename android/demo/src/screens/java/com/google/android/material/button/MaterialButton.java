// SPDX-License-Identifier: MIT OR Apache-2.0
package com.google.android.material.button;

import android.content.Context;
import android.widget.Button;

/** The accessibility checks ask whether a view is one of these; this app has none. */
public class MaterialButton extends Button {
  public MaterialButton(Context context) {
    super(context);
  }
}
