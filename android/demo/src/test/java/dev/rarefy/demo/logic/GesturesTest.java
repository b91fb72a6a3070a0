// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo.logic;

import dev.rarefy.Camera;

/** Fingers on a screen of 400x800 give cameras that are known by hand. */
public final class GesturesTest {
  private GesturesTest() {}

  private static final Camera START = Camera.lookingAt(0, 0, 10, 0, 0, 0);

  private static float[] at(float... values) {
    return values;
  }

  private static void eye(double x, double y, double z, Camera camera) {
    float[] eye = camera.getEye();
    Check.near(x, eye[0], 1e-4, "x of " + camera);
    Check.near(y, eye[1], 1e-4, "y of " + camera);
    Check.near(z, eye[2], 1e-4, "z of " + camera);
  }

  public static void main(String[] arguments) {
    oneFingerOrbits();
    twoFingersDollyAndPan();
    aDoubleTapIsTwoShortTapsAtOnePlace();
    fingersThatComeAndGoMoveNothing();
    nothingLeadsToACameraThatIsNone();
    System.out.println("done");
  }

  private static void oneFingerOrbits() {
    Gestures gestures = new Gestures(400, 800);
    gestures.fingers(at(100), at(400), 0);
    // Half the shorter side to the left is a quarter turn to the right.
    Camera right = gestures.moved(START, START, at(-100), at(400));
    eye(10, 0, 0, right);
    // A sixth of a half turn downwards lifts the eye by 30 degrees.
    gestures = new Gestures(400, 800);
    gestures.fingers(at(100), at(400), 0);
    Camera above = gestures.moved(START, START, at(100), at(400 + 400 / 6f));
    eye(0, 5, 10 * Math.cos(Math.toRadians(30)), above);
    // A drag in ten parts ends where one drag does.
    gestures = new Gestures(400, 800);
    gestures.fingers(at(100), at(400), 0);
    Camera parts = START;
    for (int part = 1; part <= 10; part++) {
      parts = gestures.moved(parts, START, at(100 - 20 * part), at(400));
    }
    eye(10, 0, 0, parts);
  }

  private static void twoFingersDollyAndPan() {
    Gestures gestures = new Gestures(400, 800);
    gestures.fingers(at(150, 250), at(400, 400), 0);
    Camera nearer = gestures.moved(START, START, at(100, 300), at(400, 400));
    eye(0, 0, 5, nearer);
    // Both to the right by a quarter of the height: the scene follows, so the eye goes left.
    Camera pan = gestures.moved(START, START, at(300, 500), at(400, 400));
    double unitsOfHeight = 2 * 10 * Math.tan(Math.toRadians(22.5));
    eye(-unitsOfHeight / 4, 0, 10, pan);
    Check.near(-unitsOfHeight / 4, pan.getLookAt()[0], 1e-4, "what it looks at goes along");
    Camera down = gestures.moved(START, START, at(300, 500), at(600, 600));
    eye(0, unitsOfHeight / 4, 10, down);
  }

  private static boolean tap(Gestures gestures, float x, float y, long down, long up) {
    gestures.fingers(at(x), at(y), down);
    return gestures.lifted(up);
  }

  private static void aDoubleTapIsTwoShortTapsAtOnePlace() {
    Gestures gestures = new Gestures(400, 800);
    Check.that(!tap(gestures, 100, 100, 1000, 1050), "one tap is none");
    Check.that(tap(gestures, 105, 100, 1200, 1250), "a double tap");
    Check.that(!tap(gestures, 105, 100, 1300, 1350), "the third begins anew");
    Check.that(tap(gestures, 105, 100, 1400, 1450), "and the fourth ends it");
    gestures = new Gestures(400, 800);
    tap(gestures, 100, 100, 1000, 1050);
    Check.that(!tap(gestures, 300, 100, 1200, 1250), "at another place");
    gestures = new Gestures(400, 800);
    tap(gestures, 100, 100, 1000, 1050);
    Check.that(!tap(gestures, 100, 100, 1600, 1650), "too late");
    gestures = new Gestures(400, 800);
    tap(gestures, 100, 100, 1000, 1050);
    Check.that(!tap(gestures, 100, 100, 1200, 1700), "a long press");
    gestures = new Gestures(400, 800);
    tap(gestures, 100, 100, 1000, 1050);
    gestures.fingers(at(100), at(100), 1200);
    Camera same = gestures.moved(START, START, at(104), at(100));
    Check.equal(START, same);
    Check.that(gestures.lifted(1250), "a finger that trembles taps, and turns nothing");
    tap(gestures, 100, 100, 2000, 2050);
    gestures.fingers(at(100), at(100), 2200);
    Camera moved = gestures.moved(START, START, at(200), at(100));
    Check.that(!moved.equals(START), "a drag");
    Check.that(!gestures.lifted(2250), "a drag is no tap");
    tap(gestures, 100, 100, 3000, 3050);
    gestures.fingers(at(100), at(100), 3200);
    gestures.fingers(at(100, 200), at(100, 200), 3210);
    gestures.fingers(at(100), at(100), 3220);
    Check.that(!gestures.lifted(3250), "two fingers are no tap");
    tap(gestures, 100, 100, 4000, 4050);
    gestures.fingers(at(100), at(100), 4100);
    gestures.cancelled();
    Check.that(!tap(gestures, 100, 100, 4200, 4250), "a gesture that the system took is no tap");
  }

  private static void fingersThatComeAndGoMoveNothing() {
    Gestures gestures = new Gestures(400, 800);
    gestures.fingers(at(100), at(400), 0);
    Camera camera = gestures.moved(START, START, at(0), at(400));
    gestures.fingers(at(0, 300), at(400, 700), 10);
    Check.equal(camera, gestures.moved(camera, START, at(0, 300), at(400, 700)));
    gestures.fingers(at(300), at(700), 20);
    Check.equal(camera, gestures.moved(camera, START, at(300), at(700)));
    // A move with other fingers than were announced is taken as their announcement.
    Check.equal(camera, gestures.moved(camera, START, at(10, 20, 30), at(1, 2, 3)));
  }

  private static void nothingLeadsToACameraThatIsNone() {
    Gestures gestures = new Gestures(400, 800);
    Camera camera = START;
    for (int round = 0; round < 200; round++) {
      gestures.fingers(at(0, 10), at(0, 0), round);
      camera = gestures.moved(camera, START, at(0, 400), at(0, 0));
    }
    Check.near(10 * Gestures.NEAREST, camera.getDistance(), 1e-3, "the nearest");
    for (int round = 0; round < 400; round++) {
      gestures.fingers(at(0, 400), at(0, 0), round);
      camera = gestures.moved(camera, START, at(0, 1), at(0, 0));
    }
    Check.near(10 * Gestures.FARTHEST, camera.getDistance(), 1, "the farthest");
    gestures.fingers(at(0), at(0), 0);
    Check.equal(camera, gestures.moved(camera, START, at(Float.NaN), at(0)));
    gestures.fingers(at(0, 0), at(0, 0), 0);
    gestures.moved(camera, START, at(0, 0), at(0, 0));
    Camera one = new Gestures(0, 0).moved(START, START, at(1), at(1));
    Check.equal(START, one);
  }
}
