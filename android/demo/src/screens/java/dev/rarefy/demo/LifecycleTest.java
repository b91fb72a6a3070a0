// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo;

import static org.junit.Assert.assertEquals;
import static org.junit.Assert.assertNotEquals;
import static org.junit.Assert.assertNull;

import android.content.ComponentCallbacks2;
import android.os.Bundle;
import android.view.View;
import android.widget.Spinner;
import dev.rarefy.demo.logic.Settings;
import dev.rarefy.demo.logic.Shown;
import dev.rarefy.demo.logic.State;
import dev.rarefy.demo.logic.Tolerance;
import org.junit.Test;
import org.junit.runner.RunWith;
import org.robolectric.RobolectricTestRunner;
import org.robolectric.annotation.Config;
import org.robolectric.annotation.GraphicsMode;

/** What Android does to an app. */
@RunWith(RobolectricTestRunner.class)
@GraphicsMode(GraphicsMode.Mode.NATIVE)
@Config(sdk = 34, qualifiers = "w360dp-h640dp-port-mdpi")
public class LifecycleTest {
  private static Phone spheres() {
    Phone phone = Phone.start("BUILTIN spheres", Settings.defaults());
    phone.await(State.Phase.DONE);
    return phone;
  }

  @Test
  public void inTheBackgroundNothingIsDrawn() {
    try (Phone phone = spheres()) {
      phone.drag(100, 400, 150, 420);
      String camera = phone.state().camera().toString();
      phone.takeSurface();
      phone.controller().pause().stop();
      phone.await(State.Phase.RESTING);
      phone.controller().restart().resume();
      phone.giveSurface();
      phone.await(State.Phase.DONE);
      assertEquals(camera, phone.state().camera().toString());
      assertNotEquals(0, phone.holder().posts());
    }
  }

  @Test
  public void theEndOfTheProcessForgetsNothing() {
    Bundle state;
    String camera;
    Settings settings =
        Settings.defaults().withShown(Shown.CLASS).withTolerance(Tolerance.T_POS, 0.02f);
    try (Phone phone = Phone.start("BUILTIN rods", settings)) {
      phone.await(State.Phase.DONE);
      phone.drag(100, 400, 60, 380);
      phone.tap(phone.view(R.id.panel_open));
      camera = phone.state().camera().toString();
      state = phone.die();
    }
    try (Phone phone = Phone.start(state)) {
      phone.await(State.Phase.DONE);
      assertEquals(camera, phone.state().camera().toString());
      assertEquals("BUILTIN rods", phone.state().scene().toText());
      assertEquals(View.VISIBLE, phone.view(R.id.panel).getVisibility());
      Spinner layer = phone.view(R.id.layer);
      assertEquals(Shown.CLASS.ordinal(), layer.getSelectedItemPosition());
    }
    // A start without that state has settings and scene, and the scene's own camera.
    try (Phone phone = Phone.start((Bundle) null)) {
      phone.await(State.Phase.DONE);
      assertEquals("BUILTIN rods", phone.state().scene().toText());
      assertEquals(
          phone.activity().loop().startCamera().toString(), phone.state().camera().toString());
    }
  }

  @Test
  public void aLostSurfaceIsNotTouchedAnyMore() {
    try (Phone phone = Phone.start("BUILTIN cafe", Settings.defaults())) {
      for (int round = 0; round < 5; round++) {
        phone.drag(100, 300, 120 + 10 * round, 310);
        phone.takeSurface();
        int posts = phone.holder().posts();
        BitmapHolder old = phone.holder();
        phone.giveSurface();
        phone.await(State.Phase.DONE);
        assertEquals(posts, old.posts());
      }
    }
  }

  @Test
  public void aSurfaceWithoutACanvasIsSurvived() {
    try (Phone phone = spheres()) {
      phone.holder().lose();
      phone.drag(100, 300, 160, 310);
      phone.await(State.Phase.DONE);
      assertNull(phone.state().failure());
    }
  }

  @Test
  public void littleMemoryTakesResolutionAndThenTheScene() {
    try (Phone phone = spheres()) {
      int width = phone.state().frame().stats().getWidth();
      phone.activity().onTrimMemory(ComponentCallbacks2.TRIM_MEMORY_RUNNING_CRITICAL);
      phone.await("smaller frames", () -> smaller(phone, width));
      phone.takeSurface();
      phone.controller().pause().stop();
      phone.activity().onLowMemory();
      phone.await("the scene is closed", () -> phone.state().device() == null);
      phone.controller().restart().resume();
      phone.giveSurface();
      phone.await(State.Phase.DONE);
    }
  }

  private static boolean smaller(Phone phone, int width) {
    State state = phone.state();
    return state.phase() == State.Phase.DONE && state.frame().stats().getWidth() < width;
  }

  @Test
  @SuppressWarnings("deprecation")
  public void backClosesThePanelFirst() {
    try (Phone phone = spheres()) {
      phone.tap(phone.view(R.id.panel_open));
      phone.activity().onBackPressed();
      assertEquals(View.GONE, phone.view(R.id.panel).getVisibility());
      assertEquals(false, phone.activity().isFinishing());
      phone.activity().onBackPressed();
      Phone.idle();
      assertEquals(true, phone.activity().isFinishing());
    }
  }
}
