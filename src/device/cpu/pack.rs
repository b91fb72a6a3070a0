// SPDX-License-Identifier: MIT OR Apache-2.0
//! Packing by rows of a tile: `device/twin/pack.rs`, where each item finds its tile by itself.

use crate::device::twin::{FrameBuffers, SceneArgs};
use crate::layout::*;

/// Items of a chunk, which has one word of flags.
pub const CHUNK: u32 = 32;

/// Rows of a tile that a chunk has.
const CHUNK_ROWS: u32 = CHUNK / PACK_TILE_SIDE;

/// One work-item of `pack_count` on a grid of pixels; that of probes has no rows.
pub fn pack_count(scene: &SceneArgs, step: &StepParams, chunk: u32, buffers: &FrameBuffers) {
    let begin = chunk * CHUNK;
    if begin >= step.item_count {
        return;
    }
    let frame = scene.frame;
    let half_items = grid_items(step);
    // Half of the list is whole tiles, and so whole chunks.
    let (k, wanted) = match begin.checked_sub(half_items) {
        None => (begin, CLASS_PENDING | CLASS_SECONDARY),
        Some(k) => (k, CLASS_PENDING),
    };
    let tile_columns = step.grid_width.div_ceil(PACK_TILE_SIDE);
    let (tile, within) = (k / (PACK_TILE_SIDE * PACK_TILE_SIDE), k % (PACK_TILE_SIDE * PACK_TILE_SIDE));
    let gx = tile % tile_columns * PACK_TILE_SIDE;
    let gy = tile / tile_columns * PACK_TILE_SIDE + within / PACK_TILE_SIDE;
    let columns = PACK_TILE_SIDE.min(step.grid_width - gx);
    let rows = CHUNK_ROWS.min(step.grid_height.saturating_sub(gy));
    let mut mask = 0;
    for row in 0..rows {
        let (x, y) = grid_pixel(frame, step, gx, gy + row);
        for column in 0..columns {
            let x = x + column * step.step_x;
            // The last pixel of a row that is shifted may lie beyond the picture.
            if x < frame.width {
                let class = buffers.attributes.get(PLANE_CLASS * frame.plane_pitch + plane_index(frame, x, y));
                let is_wanted = class & (CLASS_MASK | CLASS_SECONDARY) == wanted;
                mask |= u32::from(is_wanted) << (row * PACK_TILE_SIDE + column);
            }
        }
    }
    buffers.masks.set(chunk, mask);
    buffers.sums.set(chunk, mask.count_ones());
}
