// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo;

import android.view.KeyEvent;
import android.view.MotionEvent;
import android.view.View;
import dev.rarefy.Camera;
import dev.rarefy.demo.logic.Gestures;
import dev.rarefy.demo.logic.RenderLoop;

/** Fingers and keys on the picture move the camera. */
final class PictureInput implements View.OnTouchListener, View.OnKeyListener {
  private static final double KEY_DEGREES = 5;
  private static final double KEY_FACTOR = 0.9;

  private final RenderLoop loop;
  private Gestures gestures = new Gestures(1, 1);
  private int width;
  private int height;

  PictureInput(RenderLoop loop) {
    this.loop = loop;
  }

  @Override
  public boolean onTouch(View view, MotionEvent event) {
    if (view.getWidth() != width || view.getHeight() != height) {
      width = view.getWidth();
      height = view.getHeight();
      gestures = new Gestures(width, height);
    }
    switch (event.getActionMasked()) {
      case MotionEvent.ACTION_DOWN:
      case MotionEvent.ACTION_POINTER_DOWN:
        gestures.fingers(
            positions(event, true, -1), positions(event, false, -1), event.getEventTime());
        loop.setMoving(true);
        break;
      case MotionEvent.ACTION_POINTER_UP:
        int gone = event.getActionIndex();
        gestures.fingers(
            positions(event, true, gone), positions(event, false, gone), event.getEventTime());
        break;
      case MotionEvent.ACTION_MOVE:
        move(positions(event, true, -1), positions(event, false, -1));
        break;
      case MotionEvent.ACTION_UP:
        if (gestures.lifted(event.getEventTime())) {
          reset();
        }
        loop.setMoving(false);
        view.performClick();
        break;
      case MotionEvent.ACTION_CANCEL:
        gestures.cancelled();
        loop.setMoving(false);
        break;
      default:
        return false;
    }
    return true;
  }

  private static float[] positions(MotionEvent event, boolean horizontal, int without) {
    int count = event.getPointerCount() - (without < 0 ? 0 : 1);
    float[] positions = new float[count];
    int into = 0;
    for (int at = 0; at < event.getPointerCount(); at++) {
      if (at != without) {
        positions[into++] = horizontal ? event.getX(at) : event.getY(at);
      }
    }
    return positions;
  }

  private void move(float[] xs, float[] ys) {
    Camera start = loop.startCamera();
    Camera camera = loop.state().camera();
    if (start != null && camera != null) {
      loop.setCamera(gestures.moved(camera, start, xs, ys));
    }
  }

  /** Back to the scene's own camera. */
  void reset() {
    Camera start = loop.startCamera();
    if (start != null) {
      loop.setCamera(start);
    }
  }

  @Override
  public boolean onKey(View view, int key, KeyEvent event) {
    Camera start = loop.startCamera();
    Camera camera = loop.state().camera();
    if (event.getAction() != KeyEvent.ACTION_DOWN || start == null || camera == null) {
      return false;
    }
    switch (key) {
      case KeyEvent.KEYCODE_DPAD_LEFT:
        loop.setCamera(camera.orbit(-KEY_DEGREES, 0));
        return true;
      case KeyEvent.KEYCODE_DPAD_RIGHT:
        loop.setCamera(camera.orbit(KEY_DEGREES, 0));
        return true;
      case KeyEvent.KEYCODE_DPAD_UP:
        loop.setCamera(camera.orbit(0, KEY_DEGREES));
        return true;
      case KeyEvent.KEYCODE_DPAD_DOWN:
        loop.setCamera(camera.orbit(0, -KEY_DEGREES));
        return true;
      case KeyEvent.KEYCODE_PLUS:
      case KeyEvent.KEYCODE_EQUALS:
      case KeyEvent.KEYCODE_NUMPAD_ADD:
        loop.setCamera(Gestures.dollied(camera, start, KEY_FACTOR));
        return true;
      case KeyEvent.KEYCODE_MINUS:
      case KeyEvent.KEYCODE_NUMPAD_SUBTRACT:
        loop.setCamera(Gestures.dollied(camera, start, 1 / KEY_FACTOR));
        return true;
      default:
        return false;
    }
  }
}
