// SPDX-License-Identifier: MIT OR Apache-2.0
// step3c (paper, Step III-c): trace and shade the packed A2 pixels, as step1 does for base pixels.
// Inputs: frame, scene, list[list_offset .. list_offset + item_count). Outputs: attribute planes, class TRACED, colour.
// Invariant: exactly the listed pixels are written. Cost: one ray tree per item.
// Twin: src/device/twin/step3c.rs.
#include "types.h"
#include "common/trace.clh"

__kernel void step3c(SCENE_PARAMS, const StepParams step, __global const uint *list, __global uint *out_attributes,
                     __global uint *out_color, __global uint *out_counters) {
  const uint item = get_global_id(0);
  if (item >= step.item_count) return;
  const uint pixel = list[step.list_offset + item];
  trace_pixel(SCENE_ARGS, pixel & 0xffffu, pixel >> 16, CLASS_TRACED, &step, out_attributes, out_color, out_counters);
}
