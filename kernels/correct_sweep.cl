// SPDX-License-Identifier: MIT OR Apache-2.0
// correct_sweep (paper, post-correction): the paper's one round of post-correction, each row there and back, then each
// column. One work-item walks one line of a frame that is one window: rows if step_x is 1, columns if step_y is 1. For
// comparison with the paper only, hence a program of its own that no other frame builds.
// Inputs: frame, scene, attribute planes, colour. Outputs: attribute planes, class CORRECTED (changed) or CONFIRMED,
// colour.
// Invariant: only INTERPOLATED pixels are written, each once; lines run side by side, so that what lies beside a line may
// be changing. Cost: 2 class words per pixel and direction, one ray tree per pixel that is spread to.
// Twin: src/device/twin/correct_sweep.rs.
#include "types.h"
#include "common/correction.clh"
#include "common/ray_tree.clh"

__kernel void correct_sweep(SCENE_PARAMS, const StepParams step, __global uint *attributes, __global uint *out_color,
                            __global uint *out_counters) {
  const uint line = get_global_id(0);
  if (line >= step.item_count) return;
  const uint length = step.step_x ? frame->width : frame->height;
  for (uint k = 1u; k < 2u * length; ++k) {
    if (k == length) continue; // the turning point has no predecessor
    const uint from = k < length ? k - 1u : 2u * length - k;
    const uint to = k < length ? k : 2u * length - k - 1u;
    const uint x = step.step_x ? from : line, y = step.step_x ? line : from;
    const uint nx = step.step_x ? to : line, ny = step.step_x ? line : to;
    if (spreads(frame, &step, attributes, out_color, x, y, nx, ny))
      trace_pixel(SCENE_ARGS, nx, ny, CLASS_CORRECTED, &step, attributes, out_color, out_counters);
  }
}
