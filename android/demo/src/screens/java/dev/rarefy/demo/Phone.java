// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo;

import static org.robolectric.Shadows.shadowOf;

import android.graphics.Bitmap;
import android.graphics.Canvas;
import android.graphics.Color;
import android.graphics.Insets;
import android.graphics.Paint;
import android.graphics.PixelFormat;
import android.graphics.Rect;
import android.graphics.drawable.Drawable;
import android.os.Build;
import android.os.Bundle;
import android.os.Looper;
import android.os.Parcel;
import android.os.SystemClock;
import android.view.MotionEvent;
import android.view.SurfaceHolder;
import android.view.SurfaceView;
import android.view.View;
import android.view.ViewParent;
import android.view.WindowInsets;
import android.widget.TextView;
import dev.rarefy.RayTracer;
import dev.rarefy.demo.logic.SceneChoice;
import dev.rarefy.demo.logic.Settings;
import dev.rarefy.demo.logic.State;
import java.io.File;
import java.io.IOException;
import java.nio.ByteBuffer;
import java.nio.file.Files;
import java.util.LinkedHashMap;
import java.util.Map;
import java.util.function.Supplier;
import org.robolectric.Robolectric;
import org.robolectric.RuntimeEnvironment;
import org.robolectric.android.controller.ActivityController;

/** A phone with the app on it, for a test to look at and to touch. */
final class Phone implements AutoCloseable {
  /** Heights of the system's bars, in dp; a phone has no less. */
  static final int STATUS_BAR = 24;

  static final int NAVIGATION_BAR = 48;

  private static final long PATIENCE_NANOS = 120_000_000_000L;

  static {
    // A library is loaded once by each class loader, and each version of Android has its own.
    try {
      File copy = File.createTempFile("librarefy_jni", ".so");
      copy.deleteOnExit();
      File built = new File(System.getProperty("rarefy.screens.library"));
      Files.copy(built.toPath(), copy.toPath(), java.nio.file.StandardCopyOption.REPLACE_EXISTING);
      System.setProperty("dev.rarefy.library", copy.getPath());
      RayTracer.version();
    } catch (IOException e) {
      throw new AssertionError(e);
    }
  }

  /** Loads the library, as this class does. */
  static void needLibrary() {}

  private final ActivityController<MainActivity> controller;
  private BitmapHolder holder;

  private Phone(ActivityController<MainActivity> controller) {
    this.controller = controller;
  }

  /** The app as after its installation, but for settings and the scene that a user chose. */
  static Phone start(String scene, Settings settings) {
    AppOpener.device = "cpu";
    Saved.into(RuntimeEnvironment.getApplication(), settings, SceneChoice.fromText(scene));
    return start((Bundle) null);
  }

  /** The app's start, with what an earlier process left. */
  static Phone start(Bundle state) {
    ActivityController<MainActivity> controller = Robolectric.buildActivity(MainActivity.class);
    Phone phone = new Phone(controller);
    if (state == null) {
      controller.setup();
    } else {
      controller.setup(state);
    }
    phone.giveSurface();
    return phone;
  }

  MainActivity activity() {
    return controller.get();
  }

  ActivityController<MainActivity> controller() {
    return controller;
  }

  BitmapHolder holder() {
    return holder;
  }

  State state() {
    return activity().loop().state();
  }

  View decor() {
    return activity().getWindow().getDecorView();
  }

  <V extends View> V view(int id) {
    return activity().findViewById(id);
  }

  /** Gives the picture a surface of its size, as the system does once a window is shown. */
  void giveSurface() {
    idle();
    SurfaceView view = view(R.id.picture);
    holder = new BitmapHolder(Math.max(1, view.getWidth()), Math.max(1, view.getHeight()));
    for (SurfaceHolder.Callback callback :
        shadowOf(view)
            .getFakeSurfaceHolder()
            .getCallbacks()
            .toArray(new SurfaceHolder.Callback[0])) {
      callback.surfaceCreated(holder);
      callback.surfaceChanged(holder, PixelFormat.RGBA_8888, view.getWidth(), view.getHeight());
    }
  }

  /** Takes the surface away. */
  void takeSurface() {
    SurfaceView view = view(R.id.picture);
    for (SurfaceHolder.Callback callback :
        shadowOf(view)
            .getFakeSurfaceHolder()
            .getCallbacks()
            .toArray(new SurfaceHolder.Callback[0])) {
      callback.surfaceDestroyed(holder);
    }
    // Whoever still draws on it breaks a rule that a phone punishes with a crash.
    holder.lose();
  }

  /** Turns the phone. */
  void rotate(String qualifier) {
    takeSurface();
    RuntimeEnvironment.setQualifiers(qualifier);
    controller.configurationChange();
    controller.visible();
    giveSurface();
  }

  /** What is saved when the system ends a process in the background, by way of a parcel. */
  Bundle die() {
    Bundle state = new Bundle();
    takeSurface();
    controller.pause().stop();
    controller.saveInstanceState(state);
    controller.destroy();
    Parcel parcel = Parcel.obtain();
    parcel.writeBundle(state);
    parcel.setDataPosition(0);
    return parcel.readBundle(MainActivity.class.getClassLoader());
  }

  static void idle() {
    shadowOf(Looper.getMainLooper()).idle();
  }

  /** Waits until the loop is there. */
  void await(State.Phase phase) {
    await("phase " + phase, () -> state().phase() == phase);
  }

  /** Waits until something is so. */
  void await(String what, Condition condition) {
    await(what, condition, () -> state().phase() + " " + state().failure());
  }

  /** Waits until something is so, or fails with what there is instead. */
  static void await(String what, Condition condition, Supplier<String> instead) {
    long end = System.nanoTime() + PATIENCE_NANOS;
    while (true) {
      idle();
      if (condition.holds()) {
        idle();
        return;
      }
      if (System.nanoTime() > end) {
        throw new AssertionError("never: " + what + "; " + instead.get());
      }
      try {
        Thread.sleep(2);
      } catch (InterruptedException e) {
        throw new AssertionError(e);
      }
    }
  }

  /** Something that a test waits for. */
  interface Condition {
    boolean holds();
  }

  /** Touches a view in its middle, as a finger does. */
  void tap(View view) {
    int[] at = new int[2];
    view.getLocationInWindow(at);
    float x = at[0] + view.getWidth() / 2f;
    float y = at[1] + view.getHeight() / 2f;
    long down = SystemClock.uptimeMillis();
    send(down, MotionEvent.ACTION_DOWN, x, y);
    send(down, MotionEvent.ACTION_UP, x, y);
    idle();
  }

  /** Drags one finger in steps, in pixels of the window. */
  void drag(float fromX, float fromY, float toX, float toY) {
    long down = SystemClock.uptimeMillis();
    send(down, MotionEvent.ACTION_DOWN, fromX, fromY);
    for (int step = 1; step <= 8; step++) {
      float share = step / 8f;
      send(
          down,
          MotionEvent.ACTION_MOVE,
          fromX + share * (toX - fromX),
          fromY + share * (toY - fromY));
    }
    send(down, MotionEvent.ACTION_UP, toX, toY);
    idle();
  }

  /** Sends fingers, two numbers each. */
  void send(long down, int action, float... places) {
    int count = places.length / 2;
    MotionEvent.PointerProperties[] fingers = new MotionEvent.PointerProperties[count];
    MotionEvent.PointerCoords[] coordinates = new MotionEvent.PointerCoords[count];
    for (int at = 0; at < count; at++) {
      fingers[at] = new MotionEvent.PointerProperties();
      fingers[at].id = at;
      fingers[at].toolType = MotionEvent.TOOL_TYPE_FINGER;
      coordinates[at] = new MotionEvent.PointerCoords();
      coordinates[at].x = places[2 * at];
      coordinates[at].y = places[2 * at + 1];
      coordinates[at].pressure = 1;
      coordinates[at].size = 1;
    }
    MotionEvent event =
        MotionEvent.obtain(
            down,
            SystemClock.uptimeMillis(),
            action,
            count,
            fingers,
            coordinates,
            0,
            0,
            1,
            1,
            0,
            0,
            android.view.InputDevice.SOURCE_TOUCHSCREEN,
            0);
    decor().dispatchTouchEvent(event);
    event.recycle();
  }

  private int pixels(int dp) {
    return pixels(decor(), dp);
  }

  static int pixels(View view, int dp) {
    return Math.round(dp * view.getResources().getDisplayMetrics().density);
  }

  /** Tells the window of the system's bars, under which an app of today lies. */
  void showBars() {
    showBars(decor());
  }

  static void showBars(View decor) {
    if (Build.VERSION.SDK_INT >= 30) {
      WindowInsets insets =
          new WindowInsets.Builder()
              .setInsets(
                  WindowInsets.Type.statusBars(), Insets.of(0, pixels(decor, STATUS_BAR), 0, 0))
              .setInsets(
                  WindowInsets.Type.navigationBars(),
                  Insets.of(0, 0, 0, pixels(decor, NAVIGATION_BAR)))
              .build();
      decor.dispatchApplyWindowInsets(insets);
    }
    layOut(decor);
  }

  /** Lays the window out again, at its size. */
  void layOut() {
    layOut(decor());
  }

  private static void layOut(View decor) {
    decor.measure(
        View.MeasureSpec.makeMeasureSpec(decor.getWidth(), View.MeasureSpec.EXACTLY),
        View.MeasureSpec.makeMeasureSpec(decor.getHeight(), View.MeasureSpec.EXACTLY));
    decor.layout(0, 0, decor.getWidth(), decor.getHeight());
    idle();
  }

  /** Replaces times and the processor's name, which are others on every machine. */
  void standStill() {
    activity().loop().setListener(null);
    idle();
    TextView overlay = view(R.id.overlay);
    if (overlay.getVisibility() == View.VISIBLE) {
      overlay.setText("180 × 320 in 12.3 ms\n34 % traced\nCPU");
      layOut();
    }
  }

  /** The screen as a user sees it: the surface, the window over it, the system's bars on top. */
  Bitmap picture() {
    View decor = decor();
    Bitmap screen =
        Bitmap.createBitmap(decor.getWidth(), decor.getHeight(), Bitmap.Config.ARGB_8888);
    Canvas canvas = new Canvas(screen);
    canvas.drawColor(Color.BLACK);
    SurfaceView view = view(R.id.picture);
    int[] at = new int[2];
    view.getLocationInWindow(at);
    Rect place = new Rect(at[0], at[1], at[0] + view.getWidth(), at[1] + view.getHeight());
    canvas.drawBitmap(asOnPhones(holder.shown()), null, place, null);
    // On a phone, the view cuts a hole into the window where its surface is.
    Map<View, Drawable> backgrounds = new LinkedHashMap<>();
    for (ViewParent parent = view.getParent();
        parent instanceof View;
        parent = parent.getParent()) {
      backgrounds.put((View) parent, ((View) parent).getBackground());
      ((View) parent).setBackground(null);
    }
    decor.draw(canvas);
    for (Map.Entry<View, Drawable> entry : backgrounds.entrySet()) {
      entry.getKey().setBackground(entry.getValue());
    }
    Paint bar = new Paint();
    bar.setColor(0x40808080);
    canvas.drawRect(0, 0, screen.getWidth(), pixels(STATUS_BAR), bar);
    canvas.drawRect(
        0, screen.getHeight() - pixels(NAVIGATION_BAR), screen.getWidth(), screen.getHeight(), bar);
    return screen;
  }

  /**
   * Robolectric keeps pixels as blue, green, red; phones as red, green, blue, which is what the app
   * copies into a Bitmap.
   */
  private static Bitmap asOnPhones(Bitmap drawn) {
    Bitmap probe = Bitmap.createBitmap(1, 1, Bitmap.Config.ARGB_8888);
    probe.copyPixelsFromBuffer(ByteBuffer.wrap(new byte[] {1, 2, 3, (byte) 255}));
    if (probe.getPixel(0, 0) == Color.rgb(1, 2, 3)) {
      return drawn;
    }
    int width = drawn.getWidth();
    int[] pixels = new int[width * drawn.getHeight()];
    drawn.getPixels(pixels, 0, width, 0, 0, width, drawn.getHeight());
    for (int at = 0; at < pixels.length; at++) {
      pixels[at] =
          Color.argb(
              Color.alpha(pixels[at]),
              Color.blue(pixels[at]),
              Color.green(pixels[at]),
              Color.red(pixels[at]));
    }
    return Bitmap.createBitmap(pixels, width, drawn.getHeight(), Bitmap.Config.ARGB_8888);
  }

  @Override
  public void close() {
    controller.close();
  }
}
