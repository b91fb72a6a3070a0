// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where a pixel lies in the buffers of a frame: planes by phase, colours row by row.

use super::{FrameParams, PACK_TILE_SIDE, StepParams};

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

/// How many items half of the list has: the grid's tiles, those at its borders whole.
pub fn grid_items(step: &StepParams) -> u32 {
    let tiles = step.grid_width.div_ceil(PACK_TILE_SIDE) * step.grid_height.div_ceil(PACK_TILE_SIDE);
    tiles * PACK_TILE_SIDE * PACK_TILE_SIDE
}
