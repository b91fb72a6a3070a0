// SPDX-License-Identifier: MIT OR Apache-2.0
//! Twin of `kernels/correct.cl` and `kernels/common/correction.clh`: which pixels a round of post-correction traces.

use super::bridge::{Hits, bridged_pixel};
use super::planes::{plane_index, surfaces_differ};
use super::{FrameBuffers, SceneArgs, pack};
use crate::layout::*;

/// The pixels around a source that show the same as it does, looking from it towards a neighbour.
#[derive(Clone, Copy)]
struct SameAround {
    /// The row behind the source, left to right.
    behind: [bool; 3],
    /// Left and right of the source.
    sides: [bool; 2],
}

impl SameAround {
    fn new(hits: Hits, (x, y): (u32, u32), (nx, ny): (u32, u32)) -> Self {
        // Pixels left of or above the picture wrap around to beyond it, as in the kernel.
        let (dx, dy) = (nx.wrapping_sub(x), ny.wrapping_sub(y));
        let same = |back: u32, along: u32| {
            let bx = x.wrapping_sub(back.wrapping_mul(dx)).wrapping_add(along.wrapping_mul(dy));
            let by = y.wrapping_sub(back.wrapping_mul(dy)).wrapping_add(along.wrapping_mul(dx));
            bx < hits.frame.width && by < hits.frame.height && !hits.differ((x, y), (bx, by))
        };
        SameAround {
            behind: [u32::MAX, 0, 1].map(|along| same(1, along)),
            sides: [u32::MAX, 1].map(|along| same(0, along)),
        }
    }

    /// Whether these pixels show a straight edge or line that misses the neighbour ahead.
    fn misses_neighbour(self, is_surface: bool) -> bool {
        let is_edge = self.behind == [true; 3] && self.sides != [false; 2];
        let is_line = !self.behind[1] && self.sides == [true; 2];
        (is_edge && is_surface) || is_line
    }
}

/// Whether pixel `(x, y)` spreads to its neighbour `(nx, ny)`.
pub fn spreads(hits: Hits, (x, y): (u32, u32), (nx, ny): (u32, u32)) -> bool {
    let Hits { frame, step, buffers } = hits;
    let (a, b) = (hits.of((x, y)), hits.of((nx, ny)));
    let class = |at: u32| buffers.attributes.get(PLANE_CLASS * frame.plane_pitch + at) & CLASS_MASK;
    let from_class = class(a.at);
    if from_class != CLASS_TRACED && from_class != CLASS_CORRECTED {
        return false;
    }
    if class(b.at) != CLASS_INTERPOLATED || !hits.differ((x, y), (nx, ny)) {
        return false;
    }
    !step.flags.contains(StepFlags::THIN_ONLY)
        || from_class == CLASS_CORRECTED
        || !SameAround::new(hits, (x, y), (nx, ny)).misses_neighbour(surfaces_differ(step, &a, &b))
}

/// The item of a source that is a pixel across a gap.
const BRIDGE_ITEM: u32 = 4;

/// Items of a source: one for each neighbour and, with `STEP_BRIDGE`, one for a pixel farther away.
fn items_per_source(step: &StepParams) -> u32 {
    if step.flags.contains(StepFlags::BRIDGE) { 5 } else { 4 }
}

/// The pixel that item `i` may spread to: its source's left, right, upper or lower neighbour, or the one across a gap.
pub fn target(hits: Hits, i: u32) -> u32 {
    let Hits { frame, step, buffers } = hits;
    let source = buffers.list.get(step.source_offset + i / items_per_source(step));
    let (x, y) = (source & 0xffff, source >> 16);
    if y + 1 < frame.interior_begin || y > frame.interior_end {
        return NO_PIXEL;
    }
    let (exists, pixel) = match i % items_per_source(step) {
        0 => (x > 0, source.wrapping_sub(1)),
        1 => (x + 1 < frame.width, source.wrapping_add(1)),
        2 => (y > frame.window_begin, source.wrapping_sub(0x10000)),
        3 => (y + 1 < frame.window_end, source.wrapping_add(0x10000)),
        _ => return buffers.attributes.get(PLANE_CLAIM * frame.plane_pitch + plane_index(frame, x, y)),
    };
    if exists { pixel } else { NO_PIXEL }
}

fn pixel_plane_index(frame: &FrameParams, pixel: u32) -> u32 {
    plane_index(frame, pixel & 0xffff, pixel >> 16)
}

/// One work-item of `correct_mark`.
pub fn correct_mark(scene: &SceneArgs, step: &StepParams, i: u32, buffers: &FrameBuffers) {
    if i >= step.item_count {
        return;
    }
    let frame = scene.frame;
    let hits = Hits { frame, step, buffers };
    if i % items_per_source(step) == BRIDGE_ITEM {
        let source = buffers.list.get(step.source_offset + i / items_per_source(step));
        let pixel = bridged_pixel(hits, (source & 0xffff, source >> 16));
        buffers.attributes.set(PLANE_CLAIM * frame.plane_pitch + pixel_plane_index(frame, source), pixel);
    }
    mark_item(hits, i);
}

/// Lets item `i` claim its target if its source spreads there.
pub fn mark_item(hits: Hits, i: u32) {
    let Hits { frame, step, buffers } = hits;
    let pixel = target(hits, i);
    if pixel == NO_PIXEL {
        return;
    }
    let source = buffers.list.get(step.source_offset + i / items_per_source(step));
    let coordinates = |pixel: u32| (pixel & 0xffff, pixel >> 16);
    if i % items_per_source(step) == BRIDGE_ITEM || spreads(hits, coordinates(source), coordinates(pixel)) {
        buffers.attributes.min(PLANE_CLAIM * frame.plane_pitch + pixel_plane_index(frame, pixel), i);
    }
}

/// Whether item `i` claimed its target. Only interpolated pixels have a claim that means this: `check_pixel` resets it.
pub fn claimed_by(hits: Hits, i: u32) -> bool {
    let pixel = target(hits, i);
    if pixel == NO_PIXEL {
        return false;
    }
    let planes = &hits.buffers.attributes;
    let pitch = hits.frame.plane_pitch;
    let to = pixel_plane_index(hits.frame, pixel);
    planes.get(PLANE_CLAIM * pitch + to) == i && planes.get(PLANE_CLASS * pitch + to) & CLASS_MASK == CLASS_INTERPOLATED
}

/// One work-item of `correct_count`.
pub fn correct_count(scene: &SceneArgs, step: &StepParams, chunk: u32, buffers: &FrameBuffers) {
    let hits = Hits { frame: scene.frame, step, buffers };
    pack::count(chunk, step.item_count, &buffers.masks, &buffers.sums, |i| claimed_by(hits, i));
}

/// One work-item of `correct_scatter`.
pub fn correct_scatter(scene: &SceneArgs, step: &StepParams, chunk: u32, buffers: &FrameBuffers) {
    let hits = Hits { frame: scene.frame, step, buffers };
    pack::scatter(chunk, step, &buffers.masks, &buffers.sums, &buffers.list, |i| target(hits, i));
}
