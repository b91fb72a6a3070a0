// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where a pixel lies in the buffers of a frame: planes by phase, colours row by row.

use super::structs::FrameParams;

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
