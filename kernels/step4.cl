// SPDX-License-Identifier: MIT OR Apache-2.0
// step4 (paper, post-correction): from every traced adaptive pixel, hit information spreads to its four neighbours;
// an interpolated neighbour with another object (or, with STEP_COMPARE_SHADOW, other shadow bits; with
// STEP_COMPARE_SHADING, another normal or reflected colour; where they look different) gets a ray, and if that finds
// something other than interpolation had, the pixel spreads in turn. With STEP_THIN_ONLY the edges of thick things do not
// spread: only the sources of the first round are asked, before any pixel is corrected, so that order decides nothing.
//
// `converged`: rounds of mark, count, scan, scatter, trace until no pixel is listed. A round looks only at the
// neighbours of the pixels that the last round traced, so the fired set is the least fixed point of the rule, the same
// for any order. The last rounds have few sources and are many: step4_tail does up to TAIL_ROUNDS of them in one launch
// of one work-group. `sweeps`: the paper's one round, each row there and back, then each column (step4_sweep).
// Inputs: frame, scene, attribute planes, list entries [source_offset ..). Outputs: attribute planes, class CORRECTED
// (changed) or CONFIRMED, colour, list entries from list_offset on.
// Invariant: only INTERPOLATED pixels are written, each once. Cost: 4 class words and up to 7 attribute vectors per
// source, one ray tree per listed pixel.
// Twin: src/device/twin/step4.rs.
#include "types.h"
#include "common/bridge.clh"
#include "common/pack.clh"
#include "common/trace.clh"

// Does what pixel (x, y) hit, by the looks of the pixels around, pass (nx, ny) by? An edge or a line is taken to be
// straight. What fills the three pixels on the far side from (nx, ny) and one beside it is thick and ends here: the
// references of (nx, ny) would have met it otherwise. (With neither pixel beside it, (x, y) may be where something thin
// begins. Reflected patterns, which differ in colours alone, have no such edges.) What fills both pixels beside (x, y)
// but not the far one is a line that runs along.
static inline bool passes_by(__constant FrameParams *frame, const StepParams *step, __global const uint *attributes,
                             __global const uint *color, const Attributes *a, bool is_surface, uint x, uint y, uint nx,
                             uint ny) {
  uint filled = 0u;
  for (uint k = 0u; k < 6u; ++k) {
    // The far side's three, and beside (x, y) both; (x, y) itself is no question.
    const uint back = k < 3u ? 1u : 0u, along = k % 3u - 1u;
    const uint bx = x - back * (nx - x) + along * (ny - y), by = y - back * (ny - y) + along * (nx - x);
    if (bx >= frame->width || by >= frame->height) continue;
    const Attributes b = load_attributes(attributes, frame->plane_pitch, plane_index(frame, bx, by));
    if (!hits_differ(step, a, &b, color[color_index(frame, x, y)], color[color_index(frame, bx, by)])) filled |= 1u << k;
  }
  const bool is_thick = (filled & 7u) == 7u && (filled & 40u);
  const bool runs_along = !(filled & 2u) && (filled & 40u) == 40u;
  return (is_thick && is_surface) || runs_along;
}

// Does pixel (x, y) spread to its neighbour (nx, ny): is it a source, is that interpolated, and is it something else?
static inline bool spreads(__constant FrameParams *frame, const StepParams *step, __global const uint *attributes,
                           __global const uint *color, uint x, uint y, uint nx, uint ny) {
  const uint pitch = frame->plane_pitch, at = plane_index(frame, x, y), to = plane_index(frame, nx, ny);
  const uint from_class = attributes[PLANE_CLASS * pitch + at] & CLASS_MASK;
  if (from_class != CLASS_TRACED && from_class != CLASS_CORRECTED) return false;
  if ((attributes[PLANE_CLASS * pitch + to] & CLASS_MASK) != CLASS_INTERPOLATED) return false;
  const Attributes a = load_attributes(attributes, pitch, at), b = load_attributes(attributes, pitch, to);
  if (!hits_differ(step, &a, &b, color[color_index(frame, x, y)], color[color_index(frame, nx, ny)])) return false;
  // What interpolation had missed is thin and may turn anywhere.
  return !(step->flags & STEP_THIN_ONLY) || from_class == CLASS_CORRECTED ||
         !passes_by(frame, step, attributes, color, &a, surfaces_differ(step, &a, &b), x, y, nx, ny);
}

// How many items a source has: one for each neighbour and, with STEP_BRIDGE, one for a pixel farther away.
static inline uint ways(const StepParams *step) { return step->flags & STEP_BRIDGE ? 5u : 4u; }

// The pixel that item i looks at from its source: left, right, up, down, across a gap. NO_PIXEL beyond the window, and
// from sources that lie neither in its interior nor in the row above or below.
static inline uint target(__constant FrameParams *frame, const StepParams *step, __global const uint *attributes,
                          __global const uint *color, __global const uint *list, uint i) {
  const uint source = list[step->source_offset + i / ways(step)];
  const uint x = source & 0xffffu, y = source >> 16;
  // Farther out in the context, what a source is compared with may be missing.
  if (y + 1u < frame->interior_begin || y > frame->interior_end) return NO_PIXEL;
  switch (i % ways(step)) {
  case 0u: return x > 0u ? source - 1u : NO_PIXEL;
  case 1u: return x + 1u < frame->width ? source + 1u : NO_PIXEL;
  case 2u: return y > frame->window_begin ? source - 0x10000u : NO_PIXEL;
  case 3u: return y + 1u < frame->window_end ? source + 0x10000u : NO_PIXEL;
  default: return bridged_pixel(frame, step, attributes, color, x, y);
  }
}

static inline uint pixel_plane_index(__constant FrameParams *frame, uint pixel) {
  return plane_index(frame, pixel & 0xffffu, pixel >> 16);
}

// Only interpolated pixels have a claim that means anything: check_pixel resets it, other pixels hold what was there.
static inline bool claimed_by(__constant FrameParams *frame, const StepParams *step, __global const uint *attributes,
                              __global const uint *color, __global const uint *list, uint i) {
  const uint pixel = target(frame, step, attributes, color, list, i);
  if (pixel == NO_PIXEL) return false;
  const uint pitch = frame->plane_pitch;
  const uint to = pixel_plane_index(frame, pixel);
  return attributes[PLANE_CLAIM * pitch + to] == i &&
         (attributes[PLANE_CLASS * pitch + to] & CLASS_MASK) == CLASS_INTERPOLATED;
}

#define PACK_FLAG(i) claimed_by(frame, &step, attributes, color, list, i)
#define PACK_PIXEL(i) target(frame, &step, attributes, color, list, i)

// Several sources may want the same pixel: the lowest item claims it.
static void mark_item(__constant FrameParams *frame, const StepParams *step, __global uint *attributes,
                      __global const uint *list, __global const uint *color, uint i) {
  const uint pixel = target(frame, step, attributes, color, list, i);
  if (pixel == NO_PIXEL) return;
  const uint source = list[step->source_offset + i / ways(step)];
  if (i % ways(step) == 4u ||
      spreads(frame, step, attributes, color, source & 0xffffu, source >> 16, pixel & 0xffffu, pixel >> 16))
    atomic_min(attributes + PLANE_CLAIM * frame->plane_pitch + pixel_plane_index(frame, pixel), i);
}

__kernel void step4_mark(__constant FrameParams *frame, const StepParams step, __global uint *attributes,
                         __global const uint *list, __global const uint *color) {
  const uint i = get_global_id(0);
  if (i < step.item_count) mark_item(frame, &step, attributes, list, color, i);
}

__kernel void step4_count(__constant FrameParams *frame, const StepParams step, __global const uint *attributes,
                          __global const uint *color, __global const uint *list, __global uint *out_masks,
                          __global uint *out_sums) {
  const uint chunk = get_global_id(0);
  if (chunk * 32u < step.item_count) PACK_COUNT(chunk, step.item_count)
}

__kernel void step4_scan(const StepParams step, __global uint *sums, __local uint *scratch) {
  pack_scan(&step, sums, scratch);
}

__kernel void step4_scatter(__constant FrameParams *frame, const StepParams step, __global const uint *attributes,
                            __global const uint *color, __global const uint *masks, __global const uint *sums,
                            __global const uint *list, __global uint *out_list) {
  const uint chunk = get_global_id(0), chunk_count = (step.item_count + 31u) / 32u;
  if (chunk < chunk_count) PACK_SCATTER(chunk, chunk_count)
}

// A pixel outside of the interior belongs to another window, which traces it; with STEP_SETTLE all listed pixels had
// their rays when this window was drawn before. Such a pixel is only taken out of the game: it neither fires nor spreads.
static void trace_item(SCENE_PARAMS, const StepParams *step, __global const uint *list, __global uint *out_attributes,
                       __global uint *out_color, __global uint *out_counters, uint item) {
  const uint pixel = list[step->list_offset + item], y = pixel >> 16;
  const uint at = PLANE_CLASS * frame->plane_pitch + pixel_plane_index(frame, pixel);
  // A pixel that two windows fire at may be listed twice.
  if ((out_attributes[at] & CLASS_MASK) != CLASS_INTERPOLATED) return;
  if ((step->flags & STEP_SETTLE) || y < frame->interior_begin || y >= frame->interior_end) {
    out_attributes[at] = (out_attributes[at] & ~CLASS_MASK) | CLASS_CONFIRMED;
    return;
  }
  trace_pixel(SCENE_ARGS, pixel & 0xffffu, y, CLASS_CORRECTED, step, out_attributes, out_color, out_counters);
}

__kernel void step4_trace(SCENE_PARAMS, const StepParams step, __global const uint *list,
                          __global uint *out_attributes, __global uint *out_color, __global uint *out_counters) {
  const uint item = get_global_id(0);
  if (item < step.item_count)
    trace_item(SCENE_ARGS, &step, list, out_attributes, out_color, out_counters, item);
}

// Whole rounds by one work-group, until none is wanted, one wants more than TAIL_SOURCES, or TAIL_ROUNDS are done. Lists
// what the other kernels would list, in their order. Leaves in the sums where the next round's sources begin and end,
// how many rounds there were, and where the list ended after each.
__kernel void step4_tail(SCENE_PARAMS, const StepParams step, __global uint *attributes, __global uint *out_color,
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
    for (uint i = begin; i < end; ++i) wanted += claimed_by(frame, &round, attributes, out_color, list, i) ? 1u : 0u;
    uint next = round.list_offset + inclusive_prefix(wanted, scratch, &total) - wanted;
    if (total > round.list_end - round.list_offset) break; // the same for all lanes; the host says what is wrong
    for (uint i = begin; i < end; ++i) {
      if (claimed_by(frame, &round, attributes, out_color, list, i)) list[next++] = target(frame, &round, attributes, out_color, list, i);
    }
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
    for (uint item = lane; item < total; item += lanes)
      trace_item(SCENE_ARGS, &round, list, attributes, out_color, out_counters, item);
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
