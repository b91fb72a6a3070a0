// SPDX-License-Identifier: MIT OR Apache-2.0
// step1 (paper, Step I): trace and shade every base pixel. At step 1 in both directions this is full ray tracing.
// Inputs: frame, scene. Outputs: colour; with STEP_STORE the attribute planes and class BASE.
// Invariant: every pixel origin + step * item of the grid is written once. Cost: one ray tree per item.
// Twin: src/device/twin/step1.rs.
#include "types.h"
#include "common/trace.clh"

__kernel void step1(SCENE_PARAMS, const StepParams step, __global uint *out_attributes, __global uint *out_color,
                    __global uint *out_counters) {
  const uint gx = get_global_id(0), gy = get_global_id(1);
  if (gx >= step.grid_width || gy >= step.grid_height) return;
  trace_pixel(SCENE_ARGS, step.origin_x + step.step_x * gx, step.origin_y + step.step_y * gy, CLASS_BASE, &step,
              out_attributes, out_color, out_counters);
}
