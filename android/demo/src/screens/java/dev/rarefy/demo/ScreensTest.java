// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo;

import static org.junit.Assert.assertEquals;
import static org.junit.Assert.assertTrue;

import android.graphics.Bitmap;
import android.graphics.Canvas;
import android.view.View;
import android.widget.ScrollView;
import android.widget.TextView;
import dev.rarefy.demo.logic.Settings;
import dev.rarefy.demo.logic.Shown;
import dev.rarefy.demo.logic.State;
import dev.rarefy.demo.logic.Tolerance;
import java.util.List;
import java.util.Locale;
import org.junit.Test;
import org.junit.runner.RunWith;
import org.robolectric.Robolectric;
import org.robolectric.RobolectricTestRunner;
import org.robolectric.RuntimeEnvironment;
import org.robolectric.android.controller.ActivityController;
import org.robolectric.annotation.Config;
import org.robolectric.annotation.GraphicsMode;

/** All screens, in every kind of theme, language and phone. */
@RunWith(RobolectricTestRunner.class)
@GraphicsMode(GraphicsMode.Mode.NATIVE)
@Config(sdk = 34, qualifiers = "w360dp-h640dp-port-mdpi")
public class ScreensTest {
  private static final String SCENE = "BUILTIN mirror-room";

  private static Phone done(String scene, Settings settings) {
    Phone phone = Phone.start(scene, settings);
    phone.await(State.Phase.DONE);
    return phone;
  }

  private static Phone panel(Settings settings) {
    Phone phone = done(SCENE, settings);
    phone.tap(phone.view(R.id.panel_open));
    assertEquals(View.VISIBLE, phone.view(R.id.panel).getVisibility());
    return phone;
  }

  @Test
  public void split() {
    Settings settings =
        Settings.defaults().withMode(Settings.Mode.SPLIT).withShown(Shown.CLASS).withDivider(0.4f);
    try (Phone phone = done(SCENE, settings)) {
      assertEquals(View.VISIBLE, phone.view(R.id.divider).getVisibility());
      Look.at(phone, "split");
    }
  }

  @Test
  public void eachLayer() {
    for (Shown shown : Shown.values()) {
      try (Phone phone = done(SCENE, Settings.defaults().withShown(shown))) {
        Look.at(phone, "layer-" + shown.name().toLowerCase(Locale.ROOT));
      }
    }
  }

  @Test
  @Config(qualifiers = "+night")
  public void dark() {
    try (Phone phone = panel(Settings.defaults().withTolerance(Tolerance.T_POS, 0.02f))) {
      Look.at(phone, "dark");
    }
  }

  @Test
  public void panelToItsEnd() {
    try (Phone phone = panel(Settings.defaults().withTolerance(Tolerance.T_NORM, 0.9f))) {
      ScrollView scroll = phone.view(R.id.panel_scroll);
      scroll.scrollTo(0, scroll.getChildAt(0).getHeight() / 2);
      Look.at(phone, "panel-middle");
      scroll.scrollTo(0, scroll.getChildAt(0).getHeight());
      Look.at(phone, "panel-end");
    }
  }

  @Test
  @Config(qualifiers = "ar-rEG-ldrtl-w360dp-h640dp-port-xhdpi")
  public void rightToLeft() {
    try (Phone phone = panel(Settings.defaults())) {
      assertEquals(View.LAYOUT_DIRECTION_RTL, phone.decor().getLayoutDirection());
      Look.at(phone, "right-to-left");
      phone.<ScrollView>view(R.id.panel_scroll).scrollTo(0, 100000);
      Look.at(phone, "right-to-left-end");
    }
  }

  @Test
  @Config(qualifiers = "de-rDE-w360dp-h640dp-port-mdpi")
  public void german() {
    try (Phone phone = panel(Settings.defaults())) {
      Look.at(phone, "german");
    }
  }

  @Test
  @Config(qualifiers = "de-rDE-w360dp-h640dp-port-mdpi", fontScale = 2.0f)
  public void largeFont() {
    try (Phone phone = panel(Settings.defaults())) {
      Look.at(phone, "large-font");
      phone.<ScrollView>view(R.id.panel_scroll).scrollTo(0, 100000);
      Look.at(phone, "large-font-end");
    }
  }

  @Test
  @Config(qualifiers = "w320dp-h480dp-port-mdpi")
  public void smallPhone() {
    try (Phone phone = panel(Settings.defaults())) {
      Look.at(phone, "small-phone");
    }
  }

  @Test
  @Config(qualifiers = "w800dp-h1280dp-port-mdpi")
  public void tablet() {
    try (Phone phone = panel(Settings.defaults().withShown(Shown.FAIL_MASK))) {
      Look.at(phone, "tablet");
    }
  }

  @Test
  @Config(qualifiers = "w640dp-h360dp-land-mdpi")
  public void landscape() {
    try (Phone phone = panel(Settings.defaults().withMode(Settings.Mode.SPLIT))) {
      Look.at(phone, "landscape");
    }
  }

  @Test
  public void aSceneThatIsNotThere() {
    try (Phone phone = Phone.start("OBJ /nowhere/lost.obj", Settings.defaults())) {
      phone.await(State.Phase.FAILED);
      TextView text = phone.view(R.id.message_text);
      assertTrue(text.getText().toString(), text.getText().toString().contains("lost.obj"));
      Look.at(phone, "failure");
    }
  }

  @Test
  public void about() {
    Phone.needLibrary();
    try (ActivityController<AboutActivity> controller =
        Robolectric.buildActivity(AboutActivity.class)) {
      controller.setup();
      View share = controller.get().findViewById(R.id.about_share);
      Phone.await("a report", share::isEnabled, () -> "");
      TextView report = controller.get().findViewById(R.id.about_report);
      assertTrue(report.getText().toString(), report.getText().length() > 20);
      View decor = controller.get().getWindow().getDecorView();
      Phone.showBars(decor);
      Bitmap picture =
          Bitmap.createBitmap(decor.getWidth(), decor.getHeight(), Bitmap.Config.ARGB_8888);
      decor.draw(new Canvas(picture));
      // Not compared with a stored one: it names this machine.
      Golden.keep("about", picture);
      List<String> problems = Look.problems(decor);
      problems.addAll(Accessibility.findings(decor, picture));
      assertEquals("", String.join("\n", problems));
    }
  }

  @Test
  public void aFrameIsMeasuredWhenItStands() {
    long before = MainActivity.idleMillis;
    MainActivity.idleMillis = 0;
    try (Phone phone = done("BUILTIN cafe", Settings.defaults())) {
      phone.await("measured", () -> phone.state().frame().rays() != null);
      Phone.idle();
      TextView overlay = phone.view(R.id.overlay);
      String rays = String.format(Locale.US, "%,d", phone.state().frame().rays());
      assertTrue(overlay.getText().toString(), overlay.getText().toString().contains(rays));
      phone.showBars();
      Golden.keep("measured", phone.picture());
      assertEquals("", String.join("\n", Look.problems(phone.decor())));
    } finally {
      MainActivity.idleMillis = before;
    }
  }

  @Test
  public void languagesHaveTheSameTexts() throws ReflectiveOperationException {
    // A sentence with another number of places would end in an exception when it is said.
    for (String language : new String[] {"en", "de", "ar"}) {
      RuntimeEnvironment.setQualifiers(language);
      for (java.lang.reflect.Field field : R.string.class.getFields()) {
        String english = places(field.getInt(null), "en");
        assertEquals(
            field.getName() + " " + language, english, places(field.getInt(null), language));
      }
    }
  }

  private static String places(int id, String language) {
    RuntimeEnvironment.setQualifiers(language);
    String text = RuntimeEnvironment.getApplication().getResources().getString(id);
    StringBuilder places = new StringBuilder();
    for (int at = 1; at <= 9; at++) {
      places.append(text.contains("%" + at + "$") ? at : "");
    }
    return places.toString();
  }
}
