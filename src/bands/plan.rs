// SPDX-License-Identifier: MIT OR Apache-2.0
//! How many rows of a frame are in device memory at once.

use std::ops::Range;

use super::Room;
use crate::backend::BufferSizes;
use crate::error::{Error, Result};
use crate::layout::{FrameParams, PLANE_COUNT};

/// A frame cut into bands of whole rows of blocks.
#[derive(Debug, Clone)]
pub struct Plan {
    frame: FrameParams,
    /// Rows of a band, a multiple of the block unless the frame is one band.
    rows: u32,
    /// Buffers that hold any window of the plan.
    pub sizes: BufferSizes,
}

impl Plan {
    /// The fewest bands of about equal height that `room` and `most_rows` allow.
    ///
    /// # Errors
    /// [`Error::LimitExceeded`] if not even one row of blocks fits.
    pub fn new(frame: &FrameParams, room: &Room, most_rows: Option<u32>) -> Result<Plan> {
        let fits = |rows: u32| room.sizes(&widest(frame, rows)).filter(|sizes| room.holds(sizes));
        let height = frame.height;
        let most_rows = most_rows.unwrap_or(height).clamp(1, height);
        if most_rows == height
            && let Some(sizes) = fits(height)
        {
            return Ok(Plan { frame: *frame, rows: height, sizes });
        }
        let block_rows = height.div_ceil(frame.block);
        // The most rows of blocks that fit: between `low`, which does, and `high`, which does not.
        let (mut low, mut high) = (0, (most_rows / frame.block).clamp(1, block_rows) + 1);
        while high - low > 1 {
            let middle = low + (high - low) / 2;
            if fits(middle * frame.block).is_some() { low = middle } else { high = middle }
        }
        if low == 0 {
            return Err(room.too_small(&widest(frame, frame.block)));
        }
        let bands = block_rows.div_ceil(low);
        let rows = block_rows.div_ceil(bands) * frame.block;
        let sizes = fits(rows).ok_or_else(|| room.too_small(&widest(frame, rows)))?;
        Ok(Plan { frame: *frame, rows, sizes })
    }

    /// Whether the whole frame is in memory at once.
    pub fn is_one_window(&self) -> bool {
        self.rows >= self.frame.height
    }

    /// Rows of a band.
    pub fn rows(&self) -> u32 {
        self.rows
    }

    /// The bands' rows, from the top.
    pub fn bands(&self) -> impl Iterator<Item = Range<u32>> {
        let (rows, height) = (self.rows, self.frame.height);
        (0..height.div_ceil(rows)).map(move |band| band * rows..((band + 1) * rows).min(height))
    }

    /// The frame's parameters for drawing the rows `interior`, which begin at a multiple of the block.
    pub fn window(&self, interior: Range<u32>) -> FrameParams {
        window(&self.frame, interior)
    }
}

/// A band of `rows` rows with all the context that it can have.
fn widest(frame: &FrameParams, rows: u32) -> FrameParams {
    if rows >= frame.height { window(frame, 0..frame.height) } else { tall(frame, rows) }
}

fn tall(frame: &FrameParams, rows: u32) -> FrameParams {
    let context = if frame.block > 1 { frame.block + 1 } else { 0 };
    with_window(frame, 0..rows + context, 0..rows)
}

fn window(frame: &FrameParams, interior: Range<u32>) -> FrameParams {
    if frame.block == 1 {
        return with_window(frame, interior.clone(), interior);
    }
    // Above, a row of blocks, from which the last row above the interior is interpolated; below, the next row, which
    // holds base pixels.
    let begin = interior.start.saturating_sub(frame.block);
    let end = (interior.end + 1).min(frame.height);
    with_window(frame, begin..end, interior)
}

fn with_window(frame: &FrameParams, rows: Range<u32>, interior: Range<u32>) -> FrameParams {
    let phase_height = (rows.end - rows.start).div_ceil(frame.block);
    FrameParams {
        phase_height,
        plane_pitch: frame.block * frame.block * frame.phase_width * phase_height,
        window_begin: rows.start,
        window_end: rows.end,
        interior_begin: interior.start,
        interior_end: interior.end,
        ..*frame
    }
}

impl Room {
    /// The buffers of a window; `None` if they are beyond any address space.
    fn sizes(&self, frame: &FrameParams) -> Option<BufferSizes> {
        // Kernels address planes with 32 bits.
        let rows = u64::from(frame.window_end - frame.window_begin).next_multiple_of(u64::from(frame.block));
        let pitch = u64::from(frame.phase_width) * u64::from(frame.block) * rows;
        if pitch * u64::from(PLANE_COUNT) > u64::from(u32::MAX) {
            return None;
        }
        BufferSizes::new(frame, self.attributes, self.counters, self.scan_group)
    }

    fn holds(&self, sizes: &BufferSizes) -> bool {
        sizes.bytes() <= self.total_bytes && sizes.largest_bytes() <= self.allocation_bytes
    }

    fn too_small(&self, frame: &FrameParams) -> Error {
        let rows = frame.interior_end - frame.interior_begin;
        let wanted = self.sizes(frame).map_or(u64::MAX, |sizes| sizes.bytes());
        Error::LimitExceeded {
            what: format!("a band of {rows} rows of {} samples", frame.width),
            limit: "--memory-budget".into(),
            wanted: format!("{} KiB beside the scene's {} KiB", wanted.div_ceil(1 << 10), self.scene_bytes >> 10),
            allowed: format!(
                "{} KiB in all, {} KiB in one buffer",
                (self.total_bytes + self.scene_bytes) >> 10,
                self.allocation_bytes >> 10
            ),
            remedy: "choose a larger --memory-budget, fewer --samples or a smaller --size".into(),
        }
    }
}
