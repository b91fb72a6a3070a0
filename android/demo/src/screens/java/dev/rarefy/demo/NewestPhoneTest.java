// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo;

import dev.rarefy.demo.logic.Settings;
import dev.rarefy.demo.logic.State;
import org.junit.Test;
import org.junit.runner.RunWith;
import org.robolectric.RobolectricTestRunner;
import org.robolectric.annotation.Config;
import org.robolectric.annotation.GraphicsMode;

/** Android 15, which puts every app behind the system's bars. */
@RunWith(RobolectricTestRunner.class)
@GraphicsMode(GraphicsMode.Mode.NATIVE)
@Config(sdk = 35, qualifiers = "w360dp-h640dp-port-mdpi")
public class NewestPhoneTest {
  @Test
  public void panel() {
    try (Phone phone = Phone.start("BUILTIN mirror-room", Settings.defaults())) {
      phone.await(State.Phase.DONE);
      Look.at(phone, "android-15");
      phone.tap(phone.view(R.id.panel_open));
      Look.at(phone, "android-15-panel");
    }
  }
}
