// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy;

import java.util.Arrays;
import org.jspecify.annotations.Nullable;

/**
 * A pinhole camera, right-handed. A value that does not change: {@link #orbit}, {@link #pan},
 * {@link #dolly}, {@link #walk} and {@link #turn} give a new one, and have no state between calls.
 * Lengths are in scene units, angles in degrees.
 */
public final class Camera {
  /** How near to straight up or down {@link #orbit} and {@link #turn} lead. */
  private static final double STEEPEST_DEGREES = 89;

  private final double[] eye;
  private final double[] lookAt;
  private final double[] up;
  private final float fovYDegrees;

  private Camera(double[] eye, double[] lookAt, double[] up, float fovYDegrees) {
    this.eye = eye;
    this.lookAt = lookAt;
    this.up = up;
    this.fovYDegrees = fovYDegrees;
  }

  /**
   * A camera at a place, looking at another, upright along the y axis.
   *
   * @throws IllegalArgumentException for a number that is not finite, or two places that are one
   */
  public static Camera lookingAt(
      float eyeX, float eyeY, float eyeZ, float lookAtX, float lookAtY, float lookAtZ) {
    return checked(
        new double[] {eyeX, eyeY, eyeZ},
        new double[] {lookAtX, lookAtY, lookAtZ},
        new double[] {0, 1, 0},
        45);
  }

  static Camera ofNumbers(float[] n) {
    return new Camera(
        new double[] {n[0], n[1], n[2]},
        new double[] {n[3], n[4], n[5]},
        new double[] {n[6], n[7], n[8]},
        n[9]);
  }

  private static Camera checked(double[] eye, double[] lookAt, double[] up, float fovYDegrees) {
    for (double[] vector : new double[][] {eye, lookAt, up}) {
      for (double number : vector) {
        if (Double.isNaN(number) || Double.isInfinite(number)) {
          throw new IllegalArgumentException("a camera's numbers must be finite, not " + number);
        }
      }
    }
    if (length(minus(lookAt, eye)) == 0) {
      throw new IllegalArgumentException("a camera cannot look at where it is");
    }
    if (length(up) == 0) {
      throw new IllegalArgumentException("up is a direction: not all of it may be 0");
    }
    if (!(fovYDegrees > 0 && fovYDegrees < 180)) {
      throw new IllegalArgumentException(
          "the field of view must be above 0 and below 180 degrees, not " + fovYDegrees);
    }
    return new Camera(eye, lookAt, up, fovYDegrees);
  }

  /** The ten numbers as native code takes them. */
  float[] numbers() {
    float[] numbers = new float[10];
    for (int axis = 0; axis < 3; axis++) {
      numbers[axis] = (float) eye[axis];
      numbers[axis + 3] = (float) lookAt[axis];
      numbers[axis + 6] = (float) up[axis];
    }
    numbers[9] = fovYDegrees;
    return numbers;
  }

  /** This camera with another direction that is roughly upwards. */
  public Camera withUp(float x, float y, float z) {
    return checked(eye, lookAt, new double[] {x, y, z}, fovYDegrees);
  }

  /**
   * This camera with another vertical field of view.
   *
   * @param degrees above 0 and below 180
   */
  public Camera withFovYDegrees(float degrees) {
    return checked(eye, lookAt, up, degrees);
  }

  /** Where the camera is: x, y, z. A copy. */
  public float[] getEye() {
    return Arrays.copyOfRange(numbers(), 0, 3);
  }

  /** The point in the middle of the picture: x, y, z. A copy. */
  public float[] getLookAt() {
    return Arrays.copyOfRange(numbers(), 3, 6);
  }

  /** The direction that is roughly upwards: x, y, z. A copy. */
  public float[] getUp() {
    return Arrays.copyOfRange(numbers(), 6, 9);
  }

  /** Vertical field of view in degrees. */
  public float getFovYDegrees() {
    return fovYDegrees;
  }

  /** How far the middle of the picture is, in scene units. */
  public float getDistance() {
    return (float) length(minus(lookAt, eye));
  }

  /**
   * Moves the eye around the point that it looks at, at the same distance.
   *
   * @param degreesRight to the right, around the upward direction
   * @param degreesUp upwards; it ends just before straight above or below
   */
  public Camera orbit(double degreesRight, double degreesUp) {
    double[] offset = rotated(minus(eye, lookAt), degreesRight, degreesUp);
    return checked(plus(lookAt, offset), lookAt, up, fovYDegrees);
  }

  /**
   * Turns the head: the eye stays, and looks at another point as far away.
   *
   * @param degreesRight to the right, around the upward direction
   * @param degreesUp upwards; it ends just before straight up or down
   */
  public Camera turn(double degreesRight, double degreesUp) {
    double[] sight = rotated(minus(lookAt, eye), -degreesRight, degreesUp);
    return checked(eye, plus(eye, sight), up, fovYDegrees);
  }

  /**
   * Moves the eye and what it looks at alike, in the plane of the picture.
   *
   * @param right scene units to the right
   * @param up scene units upwards
   */
  public Camera pan(double right, double up) {
    double[] sight = unit(minus(lookAt, eye));
    double[] sideways = sideways(sight);
    double[] upwards = cross(sideways, sight);
    return moved(plus(times(sideways, right), times(upwards, up)));
  }

  /**
   * Brings the eye nearer to the point that it looks at, or farther from it.
   *
   * @param factor what the distance is multiplied with, above 0: 0.5 halves it
   */
  public Camera dolly(double factor) {
    if (!(factor > 0) || Double.isInfinite(factor)) {
      throw new IllegalArgumentException("the factor must be above 0, not " + factor);
    }
    return checked(plus(lookAt, times(minus(eye, lookAt), factor)), lookAt, up, fovYDegrees);
  }

  /**
   * Walks on level ground: moves the eye and what it looks at alike, at right angles to the upward
   * direction.
   *
   * @param forward scene units forwards
   * @param right scene units to the right
   */
  public Camera walk(double forward, double right) {
    double[] sideways = sideways(unit(minus(lookAt, eye)));
    double[] ahead = cross(unit(up), sideways);
    return moved(plus(times(ahead, forward), times(sideways, right)));
  }

  private Camera moved(double[] by) {
    return checked(plus(eye, by), plus(lookAt, by), up, fovYDegrees);
  }

  /** Turns a vector around the upward direction, and towards it. */
  private double[] rotated(double[] vector, double degreesRight, double degreesUp) {
    double length = length(vector);
    double[] axis = unit(up);
    double height = Math.max(-1, Math.min(1, dot(vector, axis) / length));
    double[] level = minus(vector, times(axis, height * length));
    // Straight above there is no direction to keep; any other one will do.
    level = length(level) < 1e-9 * length ? cross(axis, leastAxis(axis)) : level;
    level = unit(level);
    double steepest = Math.toRadians(STEEPEST_DEGREES);
    double pitch = Math.asin(height);
    // One that is steeper already is not pulled back by looking around.
    double most = Math.max(steepest, Math.abs(pitch));
    pitch = Math.max(-most, Math.min(most, pitch + Math.toRadians(degreesUp)));
    double yaw = Math.toRadians(degreesRight);
    double[] turned = plus(times(level, Math.cos(yaw)), times(cross(axis, level), Math.sin(yaw)));
    double[] direction = plus(times(turned, Math.cos(pitch)), times(axis, Math.sin(pitch)));
    return times(direction, length);
  }

  /** To the right of somebody who looks along {@code sight}. */
  private double[] sideways(double[] sight) {
    double[] right = cross(sight, unit(up));
    return unit(length(right) < 1e-9 ? cross(sight, leastAxis(sight)) : right);
  }

  /** The axis that is farthest from a direction. */
  private static double[] leastAxis(double[] direction) {
    double[] axis = new double[3];
    int least = 0;
    for (int at = 1; at < 3; at++) {
      least = Math.abs(direction[at]) < Math.abs(direction[least]) ? at : least;
    }
    axis[least] = 1;
    return axis;
  }

  private static double[] plus(double[] a, double[] b) {
    return new double[] {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
  }

  private static double[] minus(double[] a, double[] b) {
    return new double[] {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  }

  private static double[] times(double[] a, double factor) {
    return new double[] {a[0] * factor, a[1] * factor, a[2] * factor};
  }

  private static double dot(double[] a, double[] b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }

  private static double[] cross(double[] a, double[] b) {
    return new double[] {
      a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]
    };
  }

  private static double length(double[] a) {
    return Math.sqrt(dot(a, a));
  }

  private static double[] unit(double[] a) {
    return times(a, 1 / length(a));
  }

  @Override
  public boolean equals(@Nullable Object other) {
    return other instanceof Camera && Arrays.equals(numbers(), ((Camera) other).numbers());
  }

  @Override
  public int hashCode() {
    return Arrays.hashCode(numbers());
  }

  @Override
  public String toString() {
    return "Camera at "
        + Arrays.toString(getEye())
        + " looking at "
        + Arrays.toString(getLookAt())
        + ", "
        + fovYDegrees
        + " degrees";
  }
}
