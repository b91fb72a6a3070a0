// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo;

import static org.junit.Assert.assertEquals;
import static org.junit.Assert.assertNotEquals;
import static org.junit.Assert.assertTrue;

import android.os.Bundle;
import android.view.View;
import dev.rarefy.demo.logic.Settings;
import dev.rarefy.demo.logic.State;
import org.junit.Test;
import org.junit.runner.RunWith;
import org.robolectric.RobolectricTestRunner;
import org.robolectric.annotation.Config;

/** Android 6. Robolectric has no pictures of it; what the app does is looked at all the same. */
@RunWith(RobolectricTestRunner.class)
@Config(sdk = 23, qualifiers = "w360dp-h640dp-port-mdpi")
public class OldestPhoneTest {
  @Test
  @SuppressWarnings("deprecation")
  public void everyStep() {
    Bundle state;
    String camera;
    try (Phone phone = Phone.start("BUILTIN spheres", Settings.defaults())) {
      phone.await(State.Phase.DONE);
      assertNotEquals(0, phone.holder().posts());
      phone.drag(100, 400, 190, 400);
      assertEquals(
          phone.activity().loop().startCamera().orbit(-45, 0).toString(),
          phone.state().camera().toString());
      phone.tap(phone.view(R.id.panel_open));
      assertEquals(View.VISIBLE, phone.view(R.id.panel).getVisibility());
      phone.activity().onBackPressed();
      assertEquals(View.GONE, phone.view(R.id.panel).getVisibility());
      phone.rotate("+land");
      phone.await(State.Phase.DONE);
      camera = phone.state().camera().toString();
      state = phone.die();
    }
    try (Phone phone = Phone.start(state)) {
      phone.await(State.Phase.DONE);
      assertEquals(camera, phone.state().camera().toString());
      assertTrue(phone.state().frame().stats().getTracedShare() < 0.9);
    }
  }
}
