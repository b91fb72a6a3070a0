// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo;

import android.annotation.SuppressLint;
import android.app.Activity;
import android.content.Intent;
import android.graphics.PixelFormat;
import android.net.Uri;
import android.os.Bundle;
import android.os.Handler;
import android.os.Looper;
import android.view.SurfaceHolder;
import android.view.SurfaceView;
import android.view.View;
import dev.rarefy.demo.logic.Benchmark;
import dev.rarefy.demo.logic.RenderLoop;
import dev.rarefy.demo.logic.SceneChoice;
import dev.rarefy.demo.logic.Settings;
import dev.rarefy.demo.logic.State;
import java.util.concurrent.atomic.AtomicBoolean;
import org.jspecify.annotations.Nullable;

/**
 * The picture, and over it a panel of settings. What lasts longer than this screen, such as the
 * open scene, is in the {@link RenderLoop}, which the screen hands on when the phone is turned.
 */
public final class MainActivity extends Activity implements SurfaceHolder.Callback, Panel.Listener {
  /** How long a frame stands before it is measured against full tracing. */
  static volatile long idleMillis = 1500;

  private static final int BENCHMARK_FRAMES = 5;

  private static final String CLOSED = "closed";

  private final SurfaceScreen screen = new SurfaceScreen();
  private final Handler main = new Handler(Looper.getMainLooper());
  private final AtomicBoolean updating = new AtomicBoolean();
  private boolean handedOn;

  // Set by onCreate, before anything else is called.
  @SuppressWarnings("NullAway.Init")
  private RenderLoop loop;

  @SuppressWarnings("NullAway.Init")
  private Settings settings;

  @SuppressWarnings("NullAway.Init")
  private Panel panel;

  @SuppressWarnings("NullAway.Init")
  private Messages messages;

  @SuppressWarnings("NullAway.Init")
  private Heat heat;

  @SuppressWarnings("NullAway.Init")
  private Back back;

  @SuppressWarnings("NullAway.Init")
  private DividerView divider;

  @SuppressWarnings("NullAway.Init")
  private View panelView;

  @SuppressWarnings("NullAway.Init")
  private PictureInput input;

  @Override
  protected void onCreate(@Nullable Bundle state) {
    super.onCreate(state);
    setContentView(R.layout.main);
    EdgeToEdge.draw(getWindow());
    EdgeToEdge.pad(findViewById(R.id.chrome));
    Saved saved = new Saved(this, state);
    settings = saved.settings;
    Object kept = getLastNonConfigurationInstance();
    loop =
        kept instanceof RenderLoop
            ? (RenderLoop) kept
            : new RenderLoop(new AppOpener(this), saved.scene, settings, saved.camera, idleMillis);
    Texts texts = new Texts(getResources());
    panelView = findViewById(R.id.panel);
    panel = new Panel(panelView, texts, settings, loop.state().scene(), this);
    messages = new Messages(this, loop, texts, state == null ? "" : state.getString(CLOSED, ""));
    heat = new Heat(this, loop::setThermalStatus);
    back = new Back(this, () -> showPanel(false));
    input = new PictureInput(loop);
    divider = findViewById(R.id.divider);
    divider.setListener(place -> changed(settings.withDivider(place)));
    SurfaceView picture = findViewById(R.id.picture);
    picture.setOnTouchListener(input);
    picture.setOnKeyListener(input);
    // What a surface has else may be 16 bits, in which skies have bands.
    picture.getHolder().setFormat(PixelFormat.RGBX_8888);
    picture.getHolder().addCallback(this);
    buttons();
    showPanel(saved.panel);
    loop.setSettings(settings);
    loop.setListener(this::updateSoon);
    update();
  }

  /** What draws. */
  RenderLoop loop() {
    return loop;
  }

  private void buttons() {
    click(R.id.panel_open, () -> showPanel(panelView.getVisibility() != View.VISIBLE));
    click(R.id.panel_close, () -> showPanel(false));
    click(R.id.open_file, () -> Picker.ask(this));
    click(R.id.reset_view, input::reset);
    click(
        R.id.reset_settings,
        () -> {
          panel.show(Settings.defaults());
          changed(Settings.defaults());
        });
    click(R.id.benchmark, this::benchmark);
    click(R.id.about, () -> startActivity(new Intent(this, AboutActivity.class)));
  }

  private void click(int id, Runnable action) {
    findViewById(id).setOnClickListener(view -> action.run());
  }

  private void benchmark() {
    showPanel(false);
    String scene = loop.state().scene().shortName();
    int side = Messages.BENCHMARK_SIDE;
    loop.benchmark(new Benchmark.Plan(scene, side, side, BENCHMARK_FRAMES));
  }

  private void showPanel(boolean open) {
    panelView.setVisibility(open ? View.VISIBLE : View.GONE);
    back.enable(open);
  }

  /** On any thread: the screen follows the loop as soon as it can, once for many changes. */
  private void updateSoon() {
    if (updating.compareAndSet(false, true)) {
      main.post(this::update);
    }
  }

  private void update() {
    updating.set(false);
    State state = loop.state();
    messages.show(state);
    panel.show(state.scene());
    boolean split = settings.mode() == Settings.Mode.SPLIT;
    divider.setVisibility(split ? View.VISIBLE : View.GONE);
    divider.setPlace(settings.divider());
  }

  @Override
  public void changed(Settings settings) {
    this.settings = settings;
    loop.setSettings(settings);
    update();
  }

  @Override
  public void chosen(SceneChoice scene) {
    if (!scene.equals(loop.state().scene())) {
      loop.setScene(scene);
    }
  }

  @Override
  public void dragging(boolean dragging) {
    loop.setMoving(dragging);
  }

  @Override
  protected void onStart() {
    super.onStart();
    heat.start();
    loop.resume();
  }

  @Override
  protected void onStop() {
    super.onStop();
    heat.stop();
    loop.pause();
    Saved.into(this, settings, loop.state().scene());
  }

  @Override
  protected void onSaveInstanceState(Bundle state) {
    super.onSaveInstanceState(state);
    State now = loop.state();
    boolean open = panelView.getVisibility() == View.VISIBLE;
    Saved.into(state, settings, now.scene(), now.camera(), open);
    state.putString(CLOSED, messages.closed());
  }

  @Override
  public Object onRetainNonConfigurationInstance() {
    handedOn = true;
    return loop;
  }

  @Override
  protected void onDestroy() {
    super.onDestroy();
    loop.setListener(null);
    main.removeCallbacksAndMessages(null);
    if (!handedOn) {
      loop.quit();
    }
  }

  @Override
  public void onTrimMemory(int level) {
    super.onTrimMemory(level);
    // The milder ones ask for what can be spared; there is nothing here that is not in use.
    if (level >= TRIM_MEMORY_RUNNING_CRITICAL) {
      loop.trimMemory(level >= TRIM_MEMORY_UI_HIDDEN);
    }
  }

  @Override
  public void onLowMemory() {
    super.onLowMemory();
    loop.trimMemory(true);
  }

  // Before Android 13; later ones ask Back.
  @Override
  @SuppressLint("GestureBackNavigation") // Back does it on Android that does not call this.
  @SuppressWarnings("deprecation")
  public void onBackPressed() {
    if (panelView.getVisibility() == View.VISIBLE) {
      showPanel(false);
    } else {
      super.onBackPressed();
    }
  }

  @Override
  protected void onActivityResult(int request, int result, @Nullable Intent data) {
    super.onActivityResult(request, result, data);
    Uri uri = data == null ? null : data.getData();
    if (request == Picker.REQUEST && result == RESULT_OK && uri != null) {
      Picker.take(this, uri, loop);
    }
  }

  @Override
  public void surfaceCreated(SurfaceHolder holder) {
    // surfaceChanged follows, and has the size.
  }

  @Override
  public void surfaceChanged(SurfaceHolder holder, int format, int width, int height) {
    screen.setHolder(holder);
    loop.setScreen(screen, width, height);
  }

  @Override
  public void surfaceDestroyed(SurfaceHolder holder) {
    screen.setHolder(null);
    loop.loseScreen(screen);
  }
}
