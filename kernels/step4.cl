// SPDX-License-Identifier: MIT OR Apache-2.0
// step4 (paper, post-correction): from every traced adaptive pixel, hit information spreads to its four neighbours;
// an interpolated neighbour with another object (or, with STEP_COMPARE_SHADOW, other shadow bits; with
// STEP_COMPARE_SHADING, another normal or reflected colour; where they look different) gets a ray, and if that finds something other than
// interpolation had, the pixel spreads in turn.
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

// Does pixel (x, y) spread to its neighbour (nx, ny): is it a source, is that interpolated, and is it something else?
static inline bool spreads(__constant FrameParams *frame, const StepParams *step, __global const uint *attributes,
                           __global const uint *color, uint x, uint y, uint nx, uint ny) {
  const uint pitch = frame->plane_pitch, at = plane_index(frame, x, y), to = plane_index(frame, nx, ny);
  const uint from_class = attributes[PLANE_CLASS * pitch + at] & CLASS_MASK;
  if (from_class != CLASS_TRACED && from_class != CLASS_CORRECTED) return false;
  if ((attributes[PLANE_CLASS * pitch + to] & CLASS_MASK) != CLASS_INTERPOLATED) return false;
  const Attributes a = load_attributes(attributes, pitch, at), b = load_attributes(attributes, pitch, to);
  return hits_differ(step, &a, &b, color[color_index(frame, x, y)], color[color_index(frame, nx, ny)]);
}

// Item i looks from source i / 4 in direction i % 4: left, right, up, down. NO_PIXEL beyond the window.
static inline uint neighbour(__constant FrameParams *frame, const StepParams *step, __global const uint *list, uint i) {
  const uint source = list[step->source_offset + (i >> 2)];
  const uint x = source & 0xffffu, y = source >> 16;
  switch (i & 3u) {
  case 0u: return x > 0u ? source - 1u : NO_PIXEL;
  case 1u: return x + 1u < frame->width ? source + 1u : NO_PIXEL;
  case 2u: return y > frame->window_begin ? source - 0x10000u : NO_PIXEL;
  default: return y + 1u < frame->window_end ? source + 0x10000u : NO_PIXEL;
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
                         __global const uint *list, __global const uint *color) {
  const uint i = get_global_id(0);
  if (i >= step.item_count) return;
  const uint pixel = neighbour(frame, &step, list, i);
  if (pixel == NO_PIXEL) return;
  const uint source = list[step.source_offset + (i >> 2)];
  if (spreads(frame, &step, attributes, color, source & 0xffffu, source >> 16, pixel & 0xffffu, pixel >> 16))
    atomic_min(attributes + PLANE_CLAIM * frame->plane_pitch + pixel_plane_index(frame, pixel), i);
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

// A pixel outside of the interior belongs to another window, which traces it; with STEP_SETTLE all listed pixels had
// their rays when this window was drawn before. Such a pixel is only taken out of the game: it neither fires nor spreads.
__kernel void step4_trace(SCENE_PARAMS, const StepParams step, __global const uint *list,
                          __global uint *out_attributes, __global uint *out_color, __global uint *out_counters) {
  const uint item = get_global_id(0);
  if (item >= step.item_count) return;
  const uint pixel = list[step.list_offset + item], y = pixel >> 16;
  if ((step.flags & STEP_SETTLE) || y < frame->interior_begin || y >= frame->interior_end) {
    const uint at = PLANE_CLASS * frame->plane_pitch + pixel_plane_index(frame, pixel);
    out_attributes[at] = (out_attributes[at] & ~CLASS_MASK) | CLASS_CONFIRMED;
    return;
  }
  trace_pixel(SCENE_ARGS, pixel & 0xffffu, y, CLASS_CORRECTED, &step, out_attributes, out_color, out_counters);
}

// One work-item walks one line of a frame that is one window there and back: rows if step_x is 1, columns if step_y is 1.
__kernel void step4_sweep(SCENE_PARAMS, const StepParams step, __global uint *attributes, __global uint *out_color,
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
