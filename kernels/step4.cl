// SPDX-License-Identifier: MIT OR Apache-2.0
// step4 (paper, post-correction): from every traced adaptive pixel, hit information spreads to its four neighbours;
// an interpolated neighbour with another object (or, with STEP_COMPARE_SHADOW, other shadow bits) gets a ray, and if
// that finds something other than interpolation had, the pixel spreads in turn.
//
// `converged`: rounds of mark, count, scan, scatter, trace until no pixel is listed. A round looks only at the
// neighbours of the pixels that the last round traced, so the fired set is the least fixed point of the rule, the same
// for any order. `sweeps`: the paper's one round, each row there and back, then each column (step4_sweep).
// Inputs: frame, scene, attribute planes, list entries [source_offset ..). Outputs: attribute planes, class CORRECTED
// (changed) or CONFIRMED, colour, list entries from list_offset on.
// Invariant: only INTERPOLATED pixels are written, each once. Cost: 4 class and object words per source, one ray tree
// per listed pixel.
// Twin: src/twin/step4.rs.
#include "types.h"
#include "common/pack.clh"
#include "common/trace.clh"

// Does pixel `at` spread, and does its neighbour `to` hold something else?
static inline bool spreads(const StepParams *step, uint pitch, __global const uint *attributes, uint at, uint to) {
  const uint from_class = attributes[PLANE_CLASS * pitch + at] & CLASS_MASK;
  if (from_class != CLASS_TRACED && from_class != CLASS_CORRECTED) return false;
  if ((attributes[PLANE_CLASS * pitch + to] & CLASS_MASK) != CLASS_INTERPOLATED) return false;
  return attributes[PLANE_OBJECT * pitch + at] != attributes[PLANE_OBJECT * pitch + to] ||
         ((step->flags & STEP_COMPARE_SHADOW) &&
          attributes[PLANE_SHADOW * pitch + at] != attributes[PLANE_SHADOW * pitch + to]);
}

// Item i looks from source i / 4 in direction i % 4: left, right, up, down. NO_PIXEL beyond the picture.
static inline uint neighbour(__constant FrameParams *frame, const StepParams *step, __global const uint *list, uint i) {
  const uint source = list[step->source_offset + (i >> 2)];
  const uint x = source & 0xffffu, y = source >> 16;
  switch (i & 3u) {
  case 0u: return x > 0u ? source - 1u : NO_PIXEL;
  case 1u: return x + 1u < frame->width ? source + 1u : NO_PIXEL;
  case 2u: return y > 0u ? source - 0x10000u : NO_PIXEL;
  default: return y + 1u < frame->height ? source + 0x10000u : NO_PIXEL;
  }
}

static inline uint pixel_plane_index(__constant FrameParams *frame, uint pixel) {
  return plane_index(frame, pixel & 0xffffu, pixel >> 16);
}

// Only interpolated pixels have a claim that means anything: check_pixel resets it, other pixels hold what was there.
static inline bool claimed_by(__constant FrameParams *frame, const StepParams *step, __global const uint *attributes,
                              __global const uint *list, uint i) {
  const uint pixel = neighbour(frame, step, list, i);
  if (pixel == NO_PIXEL) return false;
  const uint pitch = frame->plane_pitch;
  const uint to = pixel_plane_index(frame, pixel);
  return attributes[PLANE_CLAIM * pitch + to] == i &&
         (attributes[PLANE_CLASS * pitch + to] & CLASS_MASK) == CLASS_INTERPOLATED;
}

#define PACK_FLAG(i) claimed_by(frame, &step, attributes, list, i)
#define PACK_PIXEL(i) neighbour(frame, &step, list, i)

// Several sources may want the same neighbour: the lowest item claims it.
__kernel void step4_mark(__constant FrameParams *frame, const StepParams step, __global uint *attributes,
                         __global const uint *list) {
  const uint i = get_global_id(0);
  if (i >= step.item_count) return;
  const uint pixel = neighbour(frame, &step, list, i);
  if (pixel == NO_PIXEL) return;
  const uint pitch = frame->plane_pitch;
  const uint at = pixel_plane_index(frame, list[step.source_offset + (i >> 2)]);
  const uint to = pixel_plane_index(frame, pixel);
  if (spreads(&step, pitch, attributes, at, to)) atomic_min(attributes + PLANE_CLAIM * pitch + to, i);
}

__kernel void step4_count(__constant FrameParams *frame, const StepParams step, __global const uint *attributes,
                          __global const uint *list, __global uint *out_masks, __global uint *out_sums) {
  const uint chunk = get_global_id(0);
  if (chunk * 32u < step.item_count) PACK_COUNT(chunk, step.item_count)
}

__kernel void step4_scan(const StepParams step, __global uint *sums, __local uint *scratch) {
  pack_scan(&step, sums, scratch);
}

__kernel void step4_scatter(__constant FrameParams *frame, const StepParams step, __global const uint *masks,
                            __global const uint *sums, __global const uint *list, __global uint *out_list) {
  const uint chunk = get_global_id(0), chunk_count = (step.item_count + 31u) / 32u;
  if (chunk < chunk_count) PACK_SCATTER(chunk, chunk_count)
}

__kernel void step4_trace(SCENE_PARAMS, const StepParams step, __global const uint *list,
                          __global uint *out_attributes, __global uint *out_color, __global uint *out_counters) {
  const uint item = get_global_id(0);
  if (item >= step.item_count) return;
  const uint pixel = list[step.list_offset + item];
  trace_pixel(SCENE_ARGS, pixel & 0xffffu, pixel >> 16, CLASS_CORRECTED, step.flags | STEP_STORE, out_attributes,
              out_color, out_counters);
}

// One work-item walks one line there and back: rows if step_x is 1, columns if step_y is 1.
__kernel void step4_sweep(SCENE_PARAMS, const StepParams step, __global uint *attributes, __global uint *out_color,
                          __global uint *out_counters) {
  const uint line = get_global_id(0);
  if (line >= step.item_count) return;
  const uint length = step.step_x ? frame->width : frame->height;
  for (uint k = 1u; k < 2u * length; ++k) {
    if (k == length) continue; // the turning point has no predecessor
    const uint from = k < length ? k - 1u : 2u * length - k;
    const uint to = k < length ? k : 2u * length - k - 1u;
    const uint at = step.step_x ? plane_index(frame, from, line) : plane_index(frame, line, from);
    const uint next = step.step_x ? plane_index(frame, to, line) : plane_index(frame, line, to);
    if (spreads(&step, frame->plane_pitch, attributes, at, next))
      trace_pixel(SCENE_ARGS, step.step_x ? to : line, step.step_x ? line : to, CLASS_CORRECTED,
                  step.flags | STEP_STORE, attributes, out_color, out_counters);
  }
}
