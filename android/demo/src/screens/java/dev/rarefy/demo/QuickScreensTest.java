// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo;

import static org.junit.Assert.assertEquals;
import static org.junit.Assert.assertFalse;
import static org.junit.Assert.assertNotEquals;
import static org.junit.Assert.assertSame;

import android.graphics.Bitmap;
import android.graphics.Color;
import android.view.View;
import android.widget.ImageButton;
import android.widget.TextView;
import dev.rarefy.demo.logic.RenderLoop;
import dev.rarefy.demo.logic.Settings;
import dev.rarefy.demo.logic.State;
import org.junit.Test;
import org.junit.runner.RunWith;
import org.robolectric.RobolectricTestRunner;
import org.robolectric.annotation.Config;
import org.robolectric.annotation.GraphicsMode;

/** The screens that a user sees first, and what a finger and turning the phone do. */
@RunWith(RobolectricTestRunner.class)
@GraphicsMode(GraphicsMode.Mode.NATIVE)
@Config(sdk = 34, qualifiers = "w360dp-h640dp-port-mdpi")
public class QuickScreensTest {
  @Test
  public void start() {
    try (Phone phone = Phone.start("BUILTIN cafe", Settings.defaults())) {
      phone.await(State.Phase.DONE);
      TextView overlay = phone.view(R.id.overlay);
      assertFalse(overlay.getText().toString(), overlay.getText().toString().isEmpty());
      Look.at(phone, "start");
    }
  }

  @Test
  public void panel() {
    try (Phone phone = Phone.start("BUILTIN cafe", Settings.defaults())) {
      phone.tap(phone.view(R.id.panel_open));
      assertEquals(View.VISIBLE, phone.view(R.id.panel).getVisibility());
      phone.await(State.Phase.DONE);
      Look.at(phone, "panel");
      // The controls: what the looks are there for is found.
      ImageButton close = phone.view(R.id.panel_close);
      close.setContentDescription(null);
      close.setMinimumWidth(0);
      close.getLayoutParams().width = 20;
      TextView title = phone.view(R.id.panel_title);
      title.setTextColor(Color.rgb(0xdd, 0xdd, 0xdd));
      title.getLayoutParams().height = 8;
      title.requestLayout();
      phone.layOut();
      Bitmap broken = phone.picture();
      String found = String.join("\n", Accessibility.findings(phone.decor(), broken));
      for (String check :
          new String[] {"SpeakableTextPresentCheck", "TouchTargetSizeCheck", "TextContrastCheck"}) {
        assertNotEquals(check + " in " + found, -1, found.indexOf(check));
      }
      found = String.join("\n", Look.problems(phone.decor()));
      assertNotEquals(found, -1, found.indexOf("cut off below: Settings"));
      phone.view(R.id.chrome).setPadding(0, 0, 0, 0);
      phone.layOut();
      found = String.join("\n", Look.problems(phone.decor()));
      assertNotEquals(found, -1, found.indexOf("under the system's bars"));
    }
  }

  @Test
  public void aFingerTurnsTheCameraAndARotationKeepsIt() {
    try (Phone phone = Phone.start("BUILTIN spheres", Settings.defaults())) {
      phone.await(State.Phase.DONE);
      phone.drag(100, 400, 190, 400);
      // 180 degrees are a drag across the shorter side.
      assertEquals(
          phone.activity().loop().startCamera().orbit(-45, 0).toString(),
          phone.state().camera().toString());
      phone.await(State.Phase.DONE);
      RenderLoop loop = phone.activity().loop();
      String camera = phone.state().camera().toString();
      phone.rotate("+land");
      phone.await(State.Phase.DONE);
      assertSame(loop, phone.activity().loop());
      assertEquals(camera, phone.state().camera().toString());
      assertEquals(320, phone.state().frame().stats().getWidth());
    }
  }
}
