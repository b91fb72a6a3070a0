// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo;

import static org.junit.Assert.assertEquals;
import static org.junit.Assert.assertFalse;
import static org.junit.Assert.assertNotEquals;
import static org.junit.Assert.assertTrue;

import android.os.SystemClock;
import android.view.KeyEvent;
import android.view.MotionEvent;
import android.view.View;
import android.widget.SeekBar;
import android.widget.Spinner;
import dev.rarefy.Camera;
import dev.rarefy.demo.logic.Settings;
import dev.rarefy.demo.logic.State;
import org.junit.Test;
import org.junit.runner.RunWith;
import org.robolectric.RobolectricTestRunner;
import org.robolectric.annotation.Config;
import org.robolectric.annotation.GraphicsMode;

/** What fingers and keys do. */
@RunWith(RobolectricTestRunner.class)
@GraphicsMode(GraphicsMode.Mode.NATIVE)
@Config(sdk = 34, qualifiers = "w360dp-h640dp-port-mdpi")
public class TouchTest {
  private static Phone spheres() {
    Phone phone = Phone.start("BUILTIN spheres", Settings.defaults());
    phone.await(State.Phase.DONE);
    return phone;
  }

  @Test
  public void twoFingersComeNearerAndADoubleTapResets() {
    try (Phone phone = spheres()) {
      Camera start = phone.activity().loop().startCamera();
      long down = SystemClock.uptimeMillis();
      phone.send(down, MotionEvent.ACTION_DOWN, 130, 400);
      int second = MotionEvent.ACTION_POINTER_DOWN | 1 << MotionEvent.ACTION_POINTER_INDEX_SHIFT;
      phone.send(down, second, 130, 400, 230, 400);
      phone.send(down, MotionEvent.ACTION_MOVE, 80, 400, 280, 400);
      int lifted = MotionEvent.ACTION_POINTER_UP | 1 << MotionEvent.ACTION_POINTER_INDEX_SHIFT;
      phone.send(down, lifted, 80, 400, 280, 400);
      phone.send(down, MotionEvent.ACTION_UP, 80, 400);
      Phone.idle();
      // Twice as far from each other: half the distance.
      assertEquals(
          start.getDistance() / 2,
          phone.state().camera().getDistance(),
          1e-4 * start.getDistance());
      phone.await(State.Phase.DONE);
      View picture = phone.view(R.id.picture);
      phone.tap(picture);
      assertNotEquals(start.toString(), phone.state().camera().toString());
      phone.tap(picture);
      assertEquals(start.toString(), phone.state().camera().toString());
    }
  }

  @Test
  public void keysMoveTheCamera() {
    try (Phone phone = spheres()) {
      View picture = phone.view(R.id.picture);
      picture.setFocusableInTouchMode(true);
      assertTrue(picture.requestFocus());
      Camera start = phone.state().camera();
      phone
          .decor()
          .dispatchKeyEvent(new KeyEvent(KeyEvent.ACTION_DOWN, KeyEvent.KEYCODE_DPAD_RIGHT));
      assertEquals(start.orbit(5, 0).toString(), phone.state().camera().toString());
    }
  }

  @Test
  public void thePanelTakesItsOwnTouches() {
    try (Phone phone = spheres()) {
      phone.tap(phone.view(R.id.panel_open));
      String before = phone.state().camera().toString();
      // From the label beside a list: nothing there may be touched, and nothing behind it either.
      View title = phone.view(R.id.panel_title);
      int[] at = new int[2];
      title.getLocationInWindow(at);
      phone.drag(at[0] + 5, at[1] + 5, at[0] + 100, at[1] + 40);
      assertEquals(before, phone.state().camera().toString());
      phone.tap(phone.view(R.id.panel_close));
      assertEquals(View.GONE, phone.view(R.id.panel).getVisibility());
      // The control: the same drag on the picture.
      phone.drag(at[0] + 5, at[1] + 5, at[0] + 100, at[1] + 40);
      assertNotEquals(before, phone.state().camera().toString());
    }
  }

  @Test
  public void choicesAndSlidersChangeTheFrame() {
    try (Phone phone = spheres()) {
      double adaptive = phone.state().frame().stats().getTracedShare();
      assertTrue("" + adaptive, adaptive < 0.9);
      phone.tap(phone.view(R.id.panel_open));
      SeekBar bar =
          phone.activity().findViewById(R.id.tolerances).findViewById(R.id.tolerance_value);
      bar.requestRectangleOnScreen(new android.graphics.Rect(0, 0, 1, bar.getHeight()), true);
      Phone.idle();
      int[] at = new int[2];
      bar.getLocationInWindow(at);
      float y = at[1] + bar.getHeight() / 2f;
      // To the least tolerance of positions: every pixel fails.
      phone.drag(at[0] + bar.getWidth() / 2f, y, at[0] + 1, y);
      phone.await("a frame of the new tolerance", () -> share(phone) > 0.95);
      View reset =
          phone.activity().findViewById(R.id.tolerances).findViewById(R.id.tolerance_reset);
      assertTrue(reset.isEnabled());
      phone.tap(reset);
      assertFalse(reset.isEnabled());
      phone.await("as before", () -> share(phone) == adaptive);
      Spinner mode = phone.view(R.id.mode);
      mode.setSelection(Settings.Mode.FULL.ordinal());
      phone.await("full", () -> share(phone) == 1);
      phone.tap(phone.view(R.id.panel_close));
      phone.await(State.Phase.DONE);
    }
  }

  private static double share(Phone phone) {
    return phone.state().phase() == State.Phase.DONE
        ? phone.state().frame().stats().getTracedShare()
        : Double.NaN;
  }

  @Test
  public void theDividerFollowsAFinger() {
    Settings settings = Settings.defaults().withMode(Settings.Mode.SPLIT);
    try (Phone phone = Phone.start("BUILTIN spheres", settings)) {
      phone.await(State.Phase.DONE);
      String camera = phone.state().camera().toString();
      View divider = phone.view(R.id.divider);
      assertEquals(180, divider.getX() + divider.getWidth() / 2f, 1);
      phone.drag(180, 500, 90, 500);
      assertEquals(90, divider.getX() + divider.getWidth() / 2f, 2);
      assertEquals(camera, phone.state().camera().toString());
      phone.await(State.Phase.DONE);
    }
  }
}
