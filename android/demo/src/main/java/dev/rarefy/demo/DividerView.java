// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo;

import android.content.Context;
import android.graphics.Canvas;
import android.graphics.Paint;
import android.os.Bundle;
import android.util.AttributeSet;
import android.view.KeyEvent;
import android.view.MotionEvent;
import android.view.View;
import android.view.accessibility.AccessibilityNodeInfo;
import android.widget.SeekBar;
import org.jspecify.annotations.Nullable;

/** The line of the split view, which a finger, arrow keys or TalkBack move. */
public final class DividerView extends View {
  /** Who hears of it. */
  interface Listener {
    /** From 0 (left) to 1. */
    void moved(float place);
  }

  private static final float STEP = 0.05f;

  private final Paint line = new Paint(Paint.ANTI_ALIAS_FLAG);
  private @Nullable Listener listener;
  private float place = 0.5f;
  private float grabbed;

  /** Made by the layout. */
  public DividerView(Context context, @Nullable AttributeSet attributes) {
    super(context, attributes);
    line.setColor(context.getColor(R.color.on_scrim));
    line.setShadowLayer(4, 0, 0, context.getColor(R.color.scrim));
  }

  void setListener(Listener listener) {
    this.listener = listener;
  }

  /** Where the line is, from 0 (left) to 1. */
  void setPlace(float place) {
    this.place = place;
    follow();
  }

  private int across() {
    View parent = (View) getParent();
    return parent == null ? 0 : parent.getWidth();
  }

  private void follow() {
    setX(place * across() - getWidth() / 2f);
  }

  private void move(float to) {
    setPlace(Math.max(0, Math.min(1, to)));
    if (listener != null) {
      listener.moved(place);
    }
  }

  @Override
  protected void onLayout(boolean changed, int left, int top, int right, int bottom) {
    super.onLayout(changed, left, top, right, bottom);
    follow();
  }

  @Override
  protected void onDraw(Canvas canvas) {
    float middle = getWidth() / 2f;
    float thick = getResources().getDisplayMetrics().density;
    canvas.drawRect(middle - thick, 0, middle + thick, getHeight(), line);
    canvas.drawCircle(middle, getHeight() / 2f, 10 * thick, line);
  }

  @Override
  public boolean onTouchEvent(MotionEvent event) {
    switch (event.getActionMasked()) {
      case MotionEvent.ACTION_DOWN:
        grabbed = event.getX() - getWidth() / 2f;
        return true;
      case MotionEvent.ACTION_MOVE:
        if (across() > 0) {
          move((getX() + event.getX() - grabbed) / across());
        }
        return true;
      case MotionEvent.ACTION_UP:
        performClick();
        return true;
      default:
        return super.onTouchEvent(event);
    }
  }

  @Override
  public boolean performClick() {
    // A tap moves nothing; for those who have only clicks there are the actions below.
    return super.performClick();
  }

  @Override
  public boolean onKeyDown(int key, KeyEvent event) {
    if (key == KeyEvent.KEYCODE_DPAD_LEFT || key == KeyEvent.KEYCODE_DPAD_RIGHT) {
      move(place + (key == KeyEvent.KEYCODE_DPAD_LEFT ? -STEP : STEP));
      return true;
    }
    return super.onKeyDown(key, event);
  }

  @Override
  public void onInitializeAccessibilityNodeInfo(AccessibilityNodeInfo info) {
    super.onInitializeAccessibilityNodeInfo(info);
    info.setClassName(SeekBar.class.getName());
    info.addAction(AccessibilityNodeInfo.AccessibilityAction.ACTION_SCROLL_FORWARD);
    info.addAction(AccessibilityNodeInfo.AccessibilityAction.ACTION_SCROLL_BACKWARD);
  }

  @Override
  public boolean performAccessibilityAction(int action, @Nullable Bundle arguments) {
    if (action == AccessibilityNodeInfo.ACTION_SCROLL_FORWARD
        || action == AccessibilityNodeInfo.ACTION_SCROLL_BACKWARD) {
      move(place + (action == AccessibilityNodeInfo.ACTION_SCROLL_FORWARD ? STEP : -STEP));
      return true;
    }
    return super.performAccessibilityAction(action, arguments);
  }
}
