// SPDX-License-Identifier: MIT OR Apache-2.0
// step3a (paper, Step III-a): similarity checks of each A2 pixel against its upper and lower neighbours; interpolate and shade
// where all succeed, mark for tracing where one fails.
// Inputs: frame, scene tables, attribute planes of the references. Outputs: attribute planes, class INTERPOLATED or
// PENDING with the fail mask, claim, colour of interpolated pixels.
// Invariant: every pixel of the grid gets a class; references are not written. Cost: two attribute vectors read, one
// written, one local shading per interpolated item; no rays.
// Twin: src/device/twin/step3a.rs.
#include "types.h"
#include "common/similarity.clh"

__kernel void step3a(SCENE_PARAMS, const StepParams step, __global uint *attributes, __global uint *out_color,
                     __global uint *out_counters) {
  const uint gx = get_global_id(0), gy = get_global_id(1);
  if (gx >= step.grid_width || gy >= step.grid_height) return;
  check_pixel(SCENE_ARGS, &step, step.origin_x + step.step_x * gx, step.origin_y + step.step_y * gy, attributes,
              out_color, out_counters);
}
