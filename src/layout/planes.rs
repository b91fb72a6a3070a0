// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where a pixel lies in the buffers of a frame: planes by phase, colours row by row.

use super::{FrameParams, PACK_TILE_SIDE, PROBE_TILE, StepFlags, StepParams};

/// Where pixel `(x, y)` lies within a plane.
#[inline]
pub fn plane_index(frame: &FrameParams, x: u32, y: u32) -> u32 {
    let shift = frame.block >> 1;
    let mask = frame.block - 1;
    let phase = ((y & mask) << shift) + (x & mask);
    let row = (y - frame.window_begin) >> shift;
    (phase * frame.phase_height + row) * frame.phase_width + (x >> shift)
}

/// Where a pixel's colour lies: row-major within the window.
#[inline]
pub fn color_index(frame: &FrameParams, x: u32, y: u32) -> u32 {
    (y - frame.window_begin) * frame.width + x
}

/// How far the base pixels of a row of blocks lie from the left border, where rows are shifted against each other: each of
/// `block` rows in succession by another number of columns.
pub fn base_shift(block: u32, y: u32) -> u32 {
    match block {
        2 => y >> 1 & 1,
        // 0, 2, 1, 3: neighbouring rows of blocks are far apart.
        4 => (y >> 1 & 2) | (y >> 3 & 1),
        _ => 0,
    }
}

/// How many base pixels the rows `rows` have, which begin at a multiple of the block; `shifted` against each other or not.
pub fn base_pixels(frame: &FrameParams, rows: std::ops::Range<u32>, shifted: bool) -> u64 {
    let in_row = |y| {
        let shift = if shifted { base_shift(frame.block, y) } else { 0 };
        u64::from(frame.width.saturating_sub(shift).div_ceil(frame.block))
    };
    rows.step_by(frame.block as usize).map(in_row).sum()
}

/// The pixel of post-correction's probe in a tile: along a row or column of tiles in changing rows, but never in one that
/// has base pixels.
fn probe(block: u32, gx: u32, gy: u32) -> (u32, u32) {
    let k = (5 * gx + 3 * gy) % (PROBE_TILE - PROBE_TILE / block);
    (gx * PROBE_TILE + (7 * gx + 5 * gy) % PROBE_TILE, gy * PROBE_TILE + 1 + k + k / (block - 1))
}

/// The pixel of a grid's item; the last one of a row of shifted rows or of probes may lie beyond the picture.
pub fn grid_pixel(frame: &FrameParams, step: &StepParams, gx: u32, gy: u32) -> (u32, u32) {
    if step.flags.contains(StepFlags::PROBES) {
        return probe(frame.block, gx, gy + step.origin_y);
    }
    let y = step.origin_y + step.step_y * gy;
    let x = if step.flags.contains(StepFlags::SHIFTED) {
        step.step_x * gx + ((step.origin_x + base_shift(frame.block, y)) & (step.step_x - 1))
    } else {
        step.origin_x + step.step_x * gx
    };
    (x, y)
}

/// How many items half of the list has: the grid's tiles, those at its borders whole.
pub fn grid_items(step: &StepParams) -> u32 {
    let tiles = step.grid_width.div_ceil(PACK_TILE_SIDE) * step.grid_height.div_ceil(PACK_TILE_SIDE);
    tiles * PACK_TILE_SIDE * PACK_TILE_SIDE
}
