// SPDX-License-Identifier: MIT OR Apache-2.0
// trace (paper, Steps I, II-c, III-c and post-correction): traces and shades the pixels of a grid or of a packed list.
// One kernel for all of them, because every copy of the ray tree costs a phone's compiler seconds. On a grid of stride 1
// this is full ray tracing.
// Inputs: frame, scene; `pixel_class` CLASS_BASE: the launch's grid; CLASS_TRACED or CLASS_CORRECTED:
// list[list_offset .. list_offset + item_count). Outputs: colour; attribute planes and class (base pixels: only with
// STEP_STORE). A listed pixel of step4 becomes CORRECTED if its ray changed it, else CONFIRMED.
// Invariant: exactly the grid's or the listed pixels are written, each once. Cost: one ray tree per item.
// Twin: src/device/twin/trace.rs.
#include "types.h"
#include "common/ray_tree.clh"

__kernel void trace(SCENE_PARAMS, const StepParams step, __global const uint *list, __global uint *out_attributes,
                    __global uint *out_color, __global uint *out_counters) {
  const uint gx = get_global_id(0), gy = get_global_id(1);
  uint x, y;
  if (step.pixel_class == CLASS_BASE) {
    if (gx >= step.grid_width || gy >= step.grid_height) return;
    const uint pixel = grid_pixel(frame, &step, gx, gy);
    x = pixel & 0xffffu;
    y = pixel >> 16;
    if (x >= frame->width) return;
  } else {
    // Lists come in one row of work-groups, whose items follow each other.
    const uint item = (gx / get_local_size(0) * get_local_size(1) + gy) * get_local_size(0) + gx % get_local_size(0);
    if (item >= step.item_count) return;
    const uint pixel = list[step.list_offset + item];
    x = pixel & 0xffffu;
    y = pixel >> 16;
    if (step.pixel_class == CLASS_CORRECTED && !needs_correction_ray(frame, &step, out_attributes, x, y)) return;
  }
  trace_pixel(SCENE_ARGS, x, y, step.pixel_class, &step, out_attributes, out_color, out_counters);
}
