// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy;

/** The camera's functions; needs no native library. */
final class CameraTest {
  private CameraTest() {}

  private static void near(Camera camera, double[] eye, double[] lookAt) {
    for (int axis = 0; axis < 3; axis++) {
      boolean close =
          Math.abs(camera.getEye()[axis] - eye[axis]) < 1e-5
              && Math.abs(camera.getLookAt()[axis] - lookAt[axis]) < 1e-5;
      Check.that(close, camera + ", axis " + axis);
    }
  }

  private static double[] at(double x, double y, double z) {
    return new double[] {x, y, z};
  }

  public static void main(String[] arguments) {
    Camera camera = Camera.lookingAt(0, 0, 2, 0, 0, 0);
    double[] middle = at(0, 0, 0);
    double r = Math.sqrt(2);
    near(camera.orbit(0, 0), at(0, 0, 2), middle);
    near(camera.orbit(90, 0), at(2, 0, 0), middle);
    near(camera.orbit(-45, 0), at(-r, 0, r), middle);
    near(camera.orbit(0, 45), at(0, r, r), middle);
    near(camera.orbit(360, 0), at(0, 0, 2), middle);
    near(camera.turn(90, 0), at(0, 0, 2), at(2, 0, 2));
    near(camera.turn(0, 45), at(0, 0, 2), at(0, r, 2 - r));
    near(camera.pan(0.5, 0.25), at(0.5, 0.25, 2), at(0.5, 0.25, 0));
    near(camera.dolly(0.5), at(0, 0, 1), middle);
    near(camera.walk(1, 0), at(0, 0, 1), at(0, 0, -1));
    near(camera.walk(0, 1), at(1, 0, 2), at(1, 0, 0));
    // On a slope one walks level all the same.
    near(camera.orbit(0, 45).walk(1, 0), at(0, r, r - 1), at(0, 0, -1));
    // Another upward direction is another ground.
    Camera zUp = Camera.lookingAt(0, -2, 0, 0, 0, 0).withUp(0, 0, 3);
    near(zUp.orbit(90, 0), at(2, 0, 0), middle);
    near(zUp.walk(1, 0), at(0, -1, 0), at(0, 1, 0));
    steep(camera);
    values(camera);
    System.out.println("done");
  }

  /** However far it is dragged, it ends before straight above, and comes back. */
  private static void steep(Camera camera) {
    Camera above = camera.orbit(0, 1000);
    Check.that(above.getEye()[1] < 2 && above.getEye()[1] > 1.99, above.toString());
    Check.that(above.getEye()[2] > 0, "over the top: " + above);
    near(above.orbit(0, -89), at(0, 0, 2), at(0, 0, 0));
    Check.that(camera.turn(0, -1000).getLookAt()[1] > -2, "down");
    Check.that(Math.abs(above.getDistance() - 2) < 1e-5, "distance");
    // One that begins straight above has no direction of its own, and still moves.
    Camera straight = Camera.lookingAt(0, 2, 0, 0, 0, 0);
    Check.that(Math.abs(straight.orbit(30, -40).getDistance() - 2) < 1e-5, "straight above");
    Check.that(Math.abs(straight.pan(1, 0).getDistance() - 2) < 1e-5, "straight above");
    Check.that(Math.abs(straight.walk(1, 1).getDistance() - 2) < 1e-5, "straight above");
    // Many small steps end where one large one does.
    Camera stepped = camera;
    for (int step = 0; step < 3600; step++) {
      stepped = stepped.orbit(0.1, 0);
    }
    near(stepped, at(0, 0, 2), at(0, 0, 0));
  }

  private static void values(Camera camera) {
    Check.equal(camera, Camera.lookingAt(0, 0, 2, 0, 0, 0));
    Check.equal(camera.hashCode(), Camera.lookingAt(0, 0, 2, 0, 0, 0).hashCode());
    Check.that(!camera.equals(camera.withFovYDegrees(30)), "another field of view");
    camera.getEye()[0] = 7;
    Check.equal(0f, camera.getEye()[0]);
    for (Runnable wrong :
        new Runnable[] {
          () -> Camera.lookingAt(1, 1, 1, 1, 1, 1),
          () -> Camera.lookingAt(Float.NaN, 1, 1, 0, 0, 0),
          () -> camera.withUp(0, 0, 0),
          () -> camera.withFovYDegrees(180),
          () -> camera.withFovYDegrees(Float.NaN),
          () -> camera.dolly(0),
          () -> camera.dolly(Double.NaN),
          () -> camera.walk(Double.POSITIVE_INFINITY, 0)
        }) {
      Check.thrown(IllegalArgumentException.class, Check.call(wrong));
    }
    Check.equal(new Light(1, 2, 3, 4, 5, 6), new Light(1, 2, 3, 4, 5, 6));
    Check.that(!new Light(1, 2, 3, 4, 5, 6).equals(new Light(1, 2, 3, 4, 5, 7)), "lights");
  }
}
