// SPDX-License-Identifier: MIT OR Apache-2.0
// correct (paper, post-correction): lists the interpolated pixels that a round of post-correction traces. From every
// source, a pixel that was traced, hit information spreads to its four neighbours: an interpolated neighbour with another
// object (or, with STEP_COMPARE_SHADOW, other shadow bits; with STEP_COMPARE_SHADING, another normal or reflected colour;
// where they look different) gets a ray, and if that finds something other than interpolation had, the pixel is a source
// of the next round.
//
// A round is correct_mark, correct_count, pack_scan, correct_scatter, trace. It looks only at the neighbours of the
// pixels that the last round traced, so the fired set is the least fixed point of the rule, the same for any order.
// correct_tail.cl does rounds of few sources in one launch; correct_sweep.cl is the paper's one round.
// Inputs: frame, attribute planes, colour, list entries [source_offset ..). Outputs: claims, list entries from
// list_offset on, the number of them as the last word of the scan's last level.
// Invariant: only INTERPOLATED pixels are listed, each once, in the order of the lowest item that claims it. Cost: 4 class
// words and up to 7 attribute vectors per source.
// Twin: src/device/twin/correct.rs.
#include "types.h"
#include "common/bridge.clh"
#include "common/correction.clh"
#include "common/pack.clh"

#define PACK_FLAG(i) claimed_by(frame, &step, attributes, list, i)
#define PACK_PIXEL(i) target(frame, &step, attributes, list, i)

__kernel void correct_mark(__constant FrameParams *frame, const StepParams step, __global uint *attributes,
                           __global const uint *list, __global const uint *color) {
  const uint i = get_global_id(0);
  if (i >= step.item_count) return;
  if (i % items_per_source(&step) == BRIDGE_ITEM) {
    find_bridge(frame, &step, attributes, color, list[step.source_offset + i / items_per_source(&step)]);
  }
  mark_item(frame, &step, attributes, list, color, i);
}

__kernel void correct_count(__constant FrameParams *frame, const StepParams step, __global const uint *attributes,
                            __global const uint *list, __global uint *out_masks, __global uint *out_sums) {
  const uint chunk = get_global_id(0);
  if (chunk * 32u < step.item_count) PACK_COUNT(chunk, step.item_count)
}

__kernel void correct_scatter(__constant FrameParams *frame, const StepParams step, __global const uint *attributes,
                              __global const uint *masks, __global const uint *sums, __global const uint *list,
                              __global uint *out_list) {
  const uint chunk = get_global_id(0), chunk_count = (step.item_count + 31u) / 32u;
  if (chunk < chunk_count) PACK_SCATTER(chunk, chunk_count)
}
