// SPDX-License-Identifier: MIT OR Apache-2.0
//! Twin of `kernels/step4.cl`: post-correction.

use super::planes::{color_index, hits_differ, load_attributes, plane_index};
use super::trace::trace_pixel;
use super::{FrameBuffers, SceneArgs, pack};
use crate::layout::*;

fn spreads(
    frame: &FrameParams,
    step: &StepParams,
    buffers: &FrameBuffers,
    (x, y): (u32, u32),
    (nx, ny): (u32, u32),
) -> bool {
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
    hits_differ(step, &a, &b, color(x, y), color(nx, ny))
}

fn neighbour(frame: &FrameParams, step: &StepParams, buffers: &FrameBuffers, i: u32) -> u32 {
    let source = buffers.list.get(step.source_offset + (i >> 2));
    let (x, y) = (source & 0xffff, source >> 16);
    let (exists, pixel) = match i & 3 {
        0 => (x > 0, source.wrapping_sub(1)),
        1 => (x + 1 < frame.width, source.wrapping_add(1)),
        2 => (y > frame.window_begin, source.wrapping_sub(0x10000)),
        _ => (y + 1 < frame.window_end, source.wrapping_add(0x10000)),
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
    let pixel = neighbour(frame, step, buffers, i);
    if pixel == NO_PIXEL {
        return;
    }
    let source = buffers.list.get(step.source_offset + (i >> 2));
    let coordinates = |pixel: u32| (pixel & 0xffff, pixel >> 16);
    if spreads(frame, step, buffers, coordinates(source), coordinates(pixel)) {
        buffers.attributes.min(PLANE_CLAIM * frame.plane_pitch + pixel_plane_index(frame, pixel), i);
    }
}

/// Only interpolated pixels have a claim that means anything: `check_pixel` resets it, other pixels hold what was there.
fn claimed_by(frame: &FrameParams, step: &StepParams, buffers: &FrameBuffers, i: u32) -> bool {
    let pixel = neighbour(frame, step, buffers, i);
    if pixel == NO_PIXEL {
        return false;
    }
    let planes = &buffers.attributes;
    let pitch = frame.plane_pitch;
    let to = pixel_plane_index(frame, pixel);
    planes.get(PLANE_CLAIM * pitch + to) == i && planes.get(PLANE_CLASS * pitch + to) & CLASS_MASK == CLASS_INTERPOLATED
}

/// One work-item of `step4_count`.
pub fn step4_count(scene: &SceneArgs, step: &StepParams, chunk: u32, buffers: &FrameBuffers) {
    pack::count(chunk, step.item_count, &buffers.masks, &buffers.sums, |i| claimed_by(scene.frame, step, buffers, i));
}

/// One work-group of `step4_scan`.
pub fn step4_scan(step: &StepParams, group: u32, buffers: &FrameBuffers) {
    pack::scan(group, step, &buffers.sums);
}

/// One work-item of `step4_scatter`.
pub fn step4_scatter(scene: &SceneArgs, step: &StepParams, chunk: u32, buffers: &FrameBuffers) {
    pack::scatter(chunk, step, &buffers.masks, &buffers.sums, &buffers.list, |i| {
        neighbour(scene.frame, step, buffers, i)
    });
}

/// One work-item of `step4_trace`.
pub fn step4_trace(scene: &SceneArgs, step: &StepParams, item: u32, buffers: &FrameBuffers) {
    if item >= step.item_count {
        return;
    }
    let pixel = buffers.list.get(step.list_offset + item);
    let (x, y) = (pixel & 0xffff, pixel >> 16);
    let frame = scene.frame;
    if step.flags & STEP_SETTLE != 0 || y < frame.interior_begin || y >= frame.interior_end {
        let at = PLANE_CLASS * frame.plane_pitch + pixel_plane_index(frame, pixel);
        buffers.attributes.set(at, buffers.attributes.get(at) & !CLASS_MASK | CLASS_CONFIRMED);
        return;
    }
    trace_pixel(scene, x, y, CLASS_CORRECTED, step, buffers);
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
        if spreads(frame, step, buffers, pixel(from), (tx, ty)) {
            trace_pixel(scene, tx, ty, CLASS_CORRECTED, step, buffers);
        }
    }
}
