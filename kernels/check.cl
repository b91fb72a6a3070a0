// SPDX-License-Identifier: MIT OR Apache-2.0
// check (paper, Steps II-a and III-a): similarity checks of each adaptive pixel of a grid against two opposite
// neighbours, left and right (A1) or upper and lower (A2); interpolates and shades where all succeed, marks for tracing
// where one fails.
// Inputs: frame, scene tables, attribute planes of the references. Outputs: attribute planes, class INTERPOLATED or
// PENDING with the fail mask, claim, colour of interpolated pixels.
// Invariant: every pixel of the grid gets a class; references are not written. Cost: two attribute vectors read, one
// written, one local shading per interpolated item; no rays.
// Twin: src/device/twin/check.rs.
#include "types.h"
#include "common/similarity.clh"

__kernel void check(SCENE_PARAMS, const StepParams step, __global uint *attributes, __global uint *out_color,
                    __global uint *out_counters) {
  const uint gx = get_global_id(0), gy = get_global_id(1);
  if (gx >= step.grid_width || gy >= step.grid_height) return;
  const uint pixel = grid_pixel(frame, &step, gx, gy), x = pixel & 0xffffu;
  if (x < frame->width) check_pixel(SCENE_ARGS, &step, x, pixel >> 16, attributes, out_color, out_counters);
}
