// SPDX-License-Identifier: MIT OR Apache-2.0
// correct_tail (paper, post-correction): rounds of few sources, whole and up to TAIL_ROUNDS of them, by one work-group in
// one launch. The last rounds are many and small, and on a GPU each launch and each count read back costs more than they
// do. A program of its own, since it holds the ray tree once more and devices with cheap launches do without it.
// Ends when no pixel is wanted, a round has more than TAIL_SOURCES sources, or TAIL_ROUNDS are done.
// Inputs: frame, scene, attribute planes, colour, list entries [source_offset ..). Outputs: as correct.cl and trace.cl;
// in the sums where the next round's sources begin and end, how many rounds there were, and where the list ended after
// each.
// Invariant: lists and traces what correct.cl and trace.cl would, in their order. Cost: as theirs, by one work-group.
// Twin: src/device/twin/correct_tail.rs.
#include "types.h"
#include "common/correction.clh"
#include "common/pack.clh"
#include "common/ray_tree.clh"

__kernel void correct_tail(SCENE_PARAMS, const StepParams step, __global uint *attributes, __global uint *out_color,
                           __global uint *out_counters, __global uint *list, __global uint *out_sums,
                           __local uint *scratch) {
  const uint lane = get_local_id(0), lanes = get_local_size(0);
  StepParams round = step;
  uint rounds = 0u;
  for (; rounds < TAIL_ROUNDS && round.item_count != 0u && round.item_count <= 4u * TAIL_SOURCES; ++rounds) {
    for (uint i = lane; i < round.item_count; i += lanes) mark_item(frame, &round, attributes, list, out_color, i);
    barrier(CLK_GLOBAL_MEM_FENCE);
    // A lane's items are consecutive, so that the list keeps the order of the items.
    const uint share = (round.item_count + lanes - 1u) / lanes;
    const uint begin = lane * share, end = min(begin + share, round.item_count);
    uint wanted = 0u, total;
    for (uint i = begin; i < end; ++i) wanted += claimed_by(frame, &round, attributes, list, i) ? 1u : 0u;
    uint next = round.list_offset + inclusive_prefix(wanted, scratch, &total) - wanted;
    if (total > round.list_end - round.list_offset) break; // the same for all lanes; the host says what is wrong
    for (uint i = begin; i < end; ++i) {
      if (claimed_by(frame, &round, attributes, list, i)) list[next++] = target(frame, &round, attributes, list, i);
    }
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
    for (uint item = lane; item < total; item += lanes) {
      const uint pixel = list[round.list_offset + item], x = pixel & 0xffffu, y = pixel >> 16;
      if (needs_correction_ray(frame, &round, attributes, x, y))
        trace_pixel(SCENE_ARGS, x, y, CLASS_CORRECTED, &round, attributes, out_color, out_counters);
    }
    barrier(CLK_GLOBAL_MEM_FENCE);
    round.source_offset = round.list_offset;
    round.list_offset += total;
    round.item_count = 4u * total;
    if (lane == 0u) out_sums[TAIL_SUM_ENDS + rounds] = round.list_offset;
  }
  if (lane == 0u) {
    out_sums[TAIL_SUM_SOURCES] = round.source_offset;
    out_sums[TAIL_SUM_LIST] = round.list_offset;
    out_sums[TAIL_SUM_ROUNDS] = rounds;
  }
}
