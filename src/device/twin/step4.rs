// SPDX-License-Identifier: MIT OR Apache-2.0
//! Twin of `kernels/step4.cl`: post-correction.

use rayon::prelude::*;

use super::bridge::{Hits, bridged_pixel};
use super::planes::{color_index, hits_differ, load_attributes, plane_index, surfaces_differ};
use super::trace::trace_pixel;
use super::{FrameBuffers, SceneArgs, pack};
use crate::layout::*;

/// Does what pixel `(x, y)` hit, by the looks of the pixels around, pass `(nx, ny)` by?
fn passes_by(hits: Hits, is_surface: bool, (x, y): (u32, u32), (nx, ny): (u32, u32)) -> bool {
    // Pixels left of or above the picture wrap around to beyond it, as in the kernel.
    let (dx, dy) = (nx.wrapping_sub(x), ny.wrapping_sub(y));
    let fills = |back: u32, along: u32| {
        let bx = x.wrapping_sub(back.wrapping_mul(dx)).wrapping_add(along.wrapping_mul(dy));
        let by = y.wrapping_sub(back.wrapping_mul(dy)).wrapping_add(along.wrapping_mul(dx));
        bx < hits.frame.width && by < hits.frame.height && !hits.differ((x, y), (bx, by))
    };
    let far = [u32::MAX, 0, 1].map(|along| fills(1, along));
    let beside = [u32::MAX, 1].map(|along| fills(0, along));
    let is_thick = far == [true; 3] && beside != [false; 2];
    let runs_along = !far[1] && beside == [true; 2];
    (is_thick && is_surface) || runs_along
}

fn spreads(hits: Hits, (x, y): (u32, u32), (nx, ny): (u32, u32)) -> bool {
    let Hits { frame, step, buffers } = hits;
    let planes = &buffers.attributes;
    let pitch = frame.plane_pitch;
    let (at, to) = (plane_index(frame, x, y), plane_index(frame, nx, ny));
    let from_class = planes.get(PLANE_CLASS * pitch + at) & CLASS_MASK;
    if from_class != CLASS_TRACED && from_class != CLASS_CORRECTED {
        return false;
    }
    if planes.get(PLANE_CLASS * pitch + to) & CLASS_MASK != CLASS_INTERPOLATED {
        return false;
    }
    let (a, b) = (load_attributes(planes, pitch, at), load_attributes(planes, pitch, to));
    let color = |x: u32, y: u32| buffers.color.get(color_index(frame, x, y));
    if !hits_differ(step, &a, &b, color(x, y), color(nx, ny)) {
        return false;
    }
    step.flags & STEP_THIN_ONLY == 0
        || from_class == CLASS_CORRECTED
        || !passes_by(hits, surfaces_differ(step, &a, &b), (x, y), (nx, ny))
}

/// How many items a source has.
fn ways(step: &StepParams) -> u32 {
    if step.flags & STEP_BRIDGE != 0 { 5 } else { 4 }
}

/// The pixel that item `i` looks at from its source: left, right, up, down, across a gap.
fn target(hits: Hits, i: u32) -> u32 {
    let Hits { frame, step, buffers } = hits;
    let source = buffers.list.get(step.source_offset + i / ways(step));
    let (x, y) = (source & 0xffff, source >> 16);
    if y + 1 < frame.interior_begin || y > frame.interior_end {
        return NO_PIXEL;
    }
    let (exists, pixel) = match i % ways(step) {
        0 => (x > 0, source.wrapping_sub(1)),
        1 => (x + 1 < frame.width, source.wrapping_add(1)),
        2 => (y > frame.window_begin, source.wrapping_sub(0x10000)),
        3 => (y + 1 < frame.window_end, source.wrapping_add(0x10000)),
        _ => return bridged_pixel(hits, (x, y)),
    };
    if exists { pixel } else { NO_PIXEL }
}

fn pixel_plane_index(frame: &FrameParams, pixel: u32) -> u32 {
    plane_index(frame, pixel & 0xffff, pixel >> 16)
}

/// One work-item of `step4_mark`.
pub fn step4_mark(scene: &SceneArgs, step: &StepParams, i: u32, buffers: &FrameBuffers) {
    if i >= step.item_count {
        return;
    }
    let frame = scene.frame;
    let hits = Hits { frame, step, buffers };
    let pixel = target(hits, i);
    if pixel == NO_PIXEL {
        return;
    }
    let source = buffers.list.get(step.source_offset + i / ways(step));
    let coordinates = |pixel: u32| (pixel & 0xffff, pixel >> 16);
    if i % ways(step) == 4 || spreads(hits, coordinates(source), coordinates(pixel)) {
        buffers.attributes.min(PLANE_CLAIM * frame.plane_pitch + pixel_plane_index(frame, pixel), i);
    }
}

/// Only interpolated pixels have a claim that means anything: `check_pixel` resets it, other pixels hold what was there.
fn claimed_by(hits: Hits, i: u32) -> bool {
    let pixel = target(hits, i);
    if pixel == NO_PIXEL {
        return false;
    }
    let planes = &hits.buffers.attributes;
    let pitch = hits.frame.plane_pitch;
    let to = pixel_plane_index(hits.frame, pixel);
    planes.get(PLANE_CLAIM * pitch + to) == i && planes.get(PLANE_CLASS * pitch + to) & CLASS_MASK == CLASS_INTERPOLATED
}

/// One work-item of `step4_count`.
pub fn step4_count(scene: &SceneArgs, step: &StepParams, chunk: u32, buffers: &FrameBuffers) {
    let hits = Hits { frame: scene.frame, step, buffers };
    pack::count(chunk, step.item_count, &buffers.masks, &buffers.sums, |i| claimed_by(hits, i));
}

/// One work-group of `step4_scan`.
pub fn step4_scan(step: &StepParams, group: u32, buffers: &FrameBuffers) {
    pack::scan(group, step, &buffers.sums);
}

/// One work-item of `step4_scatter`.
pub fn step4_scatter(scene: &SceneArgs, step: &StepParams, chunk: u32, buffers: &FrameBuffers) {
    let hits = Hits { frame: scene.frame, step, buffers };
    pack::scatter(chunk, step, &buffers.masks, &buffers.sums, &buffers.list, |i| target(hits, i));
}

/// One work-item of `step4_trace`.
pub fn step4_trace(scene: &SceneArgs, step: &StepParams, item: u32, buffers: &FrameBuffers) {
    if item >= step.item_count {
        return;
    }
    let pixel = buffers.list.get(step.list_offset + item);
    let (x, y) = (pixel & 0xffff, pixel >> 16);
    let frame = scene.frame;
    let at = PLANE_CLASS * frame.plane_pitch + pixel_plane_index(frame, pixel);
    if buffers.attributes.get(at) & CLASS_MASK != CLASS_INTERPOLATED {
        return;
    }
    if step.flags & STEP_SETTLE != 0 || y < frame.interior_begin || y >= frame.interior_end {
        buffers.attributes.set(at, buffers.attributes.get(at) & !CLASS_MASK | CLASS_CONFIRMED);
        return;
    }
    trace_pixel(scene, x, y, CLASS_CORRECTED, step, buffers);
}

/// The work-group of `step4_tail`.
pub fn step4_tail(scene: &SceneArgs, step: &StepParams, buffers: &FrameBuffers) {
    let mut round = *step;
    let mut rounds = 0;
    while rounds < TAIL_ROUNDS && round.item_count != 0 && round.item_count <= 4 * TAIL_SOURCES {
        (0..round.item_count).for_each(|i| step4_mark(scene, &round, i, buffers));
        let mut total = 0;
        let hits = Hits { frame: scene.frame, step: &round, buffers };
        let wanted = (0..round.item_count).filter(|&i| claimed_by(hits, i)).count() as u32;
        if wanted > round.list_end - round.list_offset {
            break;
        }
        for i in (0..round.item_count).filter(|&i| claimed_by(hits, i)) {
            buffers.list.set(round.list_offset + total, target(hits, i));
            total += 1;
        }
        let trace = StepParams { item_count: total, ..round };
        (0..total).into_par_iter().for_each(|item| step4_trace(scene, &trace, item, buffers));
        round.source_offset = round.list_offset;
        round.list_offset += total;
        round.item_count = 4 * total;
        buffers.sums.set(TAIL_SUM_ENDS + rounds, round.list_offset);
        rounds += 1;
    }
    buffers.sums.set(TAIL_SUM_SOURCES, round.source_offset);
    buffers.sums.set(TAIL_SUM_LIST, round.list_offset);
    buffers.sums.set(TAIL_SUM_ROUNDS, rounds);
}

/// One work-item of `step4_sweep`.
pub fn step4_sweep(scene: &SceneArgs, step: &StepParams, line: u32, buffers: &FrameBuffers) {
    if line >= step.item_count {
        return;
    }
    let frame = scene.frame;
    let along_row = step.step_x != 0;
    let length = if along_row { frame.width } else { frame.height };
    let pixel = |k: u32| if along_row { (k, line) } else { (line, k) };
    let forth = (1..length).map(|k| (k - 1, k));
    let back = (1..length).rev().map(|k| (k, k - 1));
    for (from, to) in forth.chain(back) {
        let (tx, ty) = pixel(to);
        if spreads(Hits { frame, step, buffers }, pixel(from), (tx, ty)) {
            trace_pixel(scene, tx, ty, CLASS_CORRECTED, step, buffers);
        }
    }
}
