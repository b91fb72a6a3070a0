// SPDX-License-Identifier: MIT OR Apache-2.0
//! Twin of `kernels/pack.cl`, `kernels/common/pack.clh` and `kernels/common/pack_order.clh`: packing by a prefix scan.

use super::planes::{Words, plane_index};
use super::{FrameBuffers, SceneArgs};
use crate::layout::*;

/// One work-item of `pack_count`.
pub fn pack_count(scene: &SceneArgs, step: &StepParams, chunk: u32, buffers: &FrameBuffers) {
    count(chunk, step.item_count, &buffers.masks, &buffers.sums, |i| {
        grid_item_is_pending(scene.frame, step, &buffers.attributes, i)
    });
}

/// One work-group of `pack_scan`.
pub fn pack_scan(step: &StepParams, group: u32, buffers: &FrameBuffers) {
    scan(group, step, &buffers.sums);
}

/// One work-item of `pack_scatter`.
pub fn pack_scatter(scene: &SceneArgs, step: &StepParams, chunk: u32, buffers: &FrameBuffers) {
    scatter(chunk, step, &buffers.masks, &buffers.sums, &buffers.list, |i| grid_item_pixel(scene.frame, step, i));
}

/// Mask word and flag count of a chunk of 32 items (`PACK_COUNT`).
pub fn count(chunk: u32, item_count: u32, masks: &Words, sums: &Words, flag: impl Fn(u32) -> bool) {
    let begin = chunk * 32;
    if begin >= item_count {
        return;
    }
    let mut mask = 0u32;
    for k in 0..32.min(item_count - begin) {
        if flag(begin + k) {
            mask |= 1 << k;
        }
    }
    masks.set(chunk, mask);
    sums.set(chunk, mask.count_ones());
}

/// One work-group of one level of the scan (`scan_level`).
fn scan(group: u32, step: &StepParams, sums: &Words) {
    let begin = group * step.scan_group;
    let end = (begin + step.scan_group).min(step.item_count);
    let mut total = 0;
    for element in begin..end {
        let value = sums.get(step.sums_offset + element);
        sums.set(step.sums_offset + element, total);
        total += value;
    }
    sums.set(step.sums_offset + step.item_count + group, total);
}

fn base(step: &StepParams, sums: &Words, chunk: u32, chunk_count: u32) -> u32 {
    let (mut base, mut offset, mut element, mut count) = (0, 0, chunk, chunk_count);
    loop {
        base += sums.get(offset + element);
        if count <= step.scan_group {
            return base;
        }
        offset += count;
        element /= step.scan_group;
        count = count.div_ceil(step.scan_group);
    }
}

/// Writes a chunk's wanted pixels to the list (`PACK_SCATTER`).
pub fn scatter(chunk: u32, step: &StepParams, masks: &Words, sums: &Words, list: &Words, pixel: impl Fn(u32) -> u32) {
    let chunk_count = step.item_count.div_ceil(32);
    if chunk >= chunk_count {
        return;
    }
    let mask = masks.get(chunk);
    let first = step.list_offset + base(step, sums, chunk, chunk_count);
    for (at, k) in (first..).zip((0..32).filter(|k| mask >> k & 1 != 0)) {
        list.set(at, pixel(chunk * 32 + k));
    }
}

/// Grid coordinates of item `i` in packing order: x in the low half word, y in the high one.
pub fn grid_item(step: &StepParams, i: u32) -> u32 {
    let half_items = grid_items(step);
    let k = if i < half_items { i } else { i - half_items };
    let tile_columns = step.grid_width.div_ceil(PACK_TILE_SIDE);
    let (tile, within) = (k / (PACK_TILE_SIDE * PACK_TILE_SIDE), k % (PACK_TILE_SIDE * PACK_TILE_SIDE));
    let gx = (tile % tile_columns) * PACK_TILE_SIDE + within % PACK_TILE_SIDE;
    let gy = (tile / tile_columns) * PACK_TILE_SIDE + within / PACK_TILE_SIDE;
    gx | gy << 16
}

/// Pixel address of item `i`.
pub fn grid_item_pixel(frame: &FrameParams, step: &StepParams, i: u32) -> u32 {
    let item = grid_item(step, i);
    let (x, y) = grid_pixel(frame, step, item & 0xffff, item >> 16);
    x | y << 16
}

/// Whether item `i` lies in the grid and its pixel waits for a ray of the half of the list that `i` belongs to.
pub fn grid_item_is_pending(frame: &FrameParams, step: &StepParams, attributes: &Words, i: u32) -> bool {
    let item = grid_item(step, i);
    if (item & 0xffff) >= step.grid_width || (item >> 16) >= step.grid_height {
        return false;
    }
    let pixel = grid_item_pixel(frame, step, i);
    let (x, y) = (pixel & 0xffff, pixel >> 16);
    let is_probe = step.flags.contains(StepFlags::PROBES);
    if x >= frame.width || is_probe && !(frame.interior_begin..frame.interior_end).contains(&y) {
        return false;
    }
    let at = plane_index(frame, x, y);
    let wanted = match (is_probe, i < grid_items(step)) {
        (true, _) => CLASS_INTERPOLATED,
        (false, true) => CLASS_PENDING | CLASS_SECONDARY,
        (false, false) => CLASS_PENDING,
    };
    attributes.get(PLANE_CLASS * frame.plane_pitch + at) & (CLASS_MASK | CLASS_SECONDARY) == wanted
}
