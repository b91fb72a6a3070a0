// SPDX-License-Identifier: MIT OR Apache-2.0
// pack (paper, Steps II-b and III-b): packs the addresses of a grid's pixels that must be traced, by a parallel prefix
// scan. The scan also serves post-correction (correct.cl).
// Inputs: frame, class plane. Outputs: list entries from list_offset on, in the order of kernels/common/pack_order.clh;
// the number of them as the last word of the scan's last level.
// Invariant: every PENDING pixel of the grid is listed once. Cost: one class word read per grid item, and per 32 items
// one mask word and a logarithmic scan.
// Twin: src/device/twin/pack.rs.
#include "types.h"
#include "common/pack_order.clh"
#include "common/pack.clh"

#define PACK_FLAG(i) grid_item_is_pending(frame, &step, attributes, i)
#define PACK_PIXEL(i) grid_item_pixel(frame, &step, i)

__kernel void pack_count(__constant FrameParams *frame, const StepParams step, __global const uint *attributes,
                         __global uint *out_masks, __global uint *out_sums) {
  const uint chunk = get_global_id(0);
  if (chunk * 32u < step.item_count) PACK_COUNT(chunk, step.item_count)
}

__kernel void pack_scan(const StepParams step, __global uint *sums, __local uint *scratch) {
  scan_level(&step, sums, scratch);
}

__kernel void pack_scatter(__constant FrameParams *frame, const StepParams step, __global const uint *masks,
                           __global const uint *sums, __global uint *out_list) {
  const uint chunk = get_global_id(0), chunk_count = (step.item_count + 31u) / 32u;
  if (chunk < chunk_count) PACK_SCATTER(chunk, chunk_count)
}
