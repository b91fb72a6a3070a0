// SPDX-License-Identifier: MIT OR Apache-2.0
//! A frame in an executor's memory: what it holds, how large its buffers are, and what it is drawn from.

use std::any::Any;
use std::ops::Range;

use crate::error::{Error, Result};
use crate::layout::*;

/// Buffers of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum FrameBuffer {
    /// Attribute planes.
    Attributes,
    /// Counter planes.
    Counters,
    /// The picture.
    Color,
    /// Packed pixel addresses.
    List,
    /// Mask words of the packing.
    Masks,
    /// Scan levels of the packing.
    Sums,
}

impl FrameBuffer {
    /// All buffers of a frame.
    pub const ALL: [FrameBuffer; 6] = [
        FrameBuffer::Attributes,
        FrameBuffer::Counters,
        FrameBuffer::Color,
        FrameBuffer::List,
        FrameBuffer::Masks,
        FrameBuffer::Sums,
    ];

    /// What its words are called in messages.
    pub fn name(self) -> &'static str {
        match self {
            FrameBuffer::Attributes => "words of attributes",
            FrameBuffer::Counters => "words of counters",
            FrameBuffer::Color => "words of colour",
            FrameBuffer::List => "list entries",
            FrameBuffer::Masks => "mask words",
            FrameBuffer::Sums => "words of sums",
        }
    }
}

/// What changes from frame to frame, or from window to window, of what kernels read.
#[derive(Debug, Clone, PartialEq)]
pub struct FrameInputs {
    /// Camera, environment, size and window.
    pub params: FrameParams,
    /// Lights, at most [`crate::scene::MAX_LIGHTS`]; `params.light_count` of them count.
    pub lights: Vec<Light>,
}

impl FrameInputs {
    /// The same camera and lights for another window of the frame.
    pub fn window(&self, params: FrameParams) -> FrameInputs {
        FrameInputs { params, lights: self.lights.clone() }
    }
}

/// The sizes of a frame's buffers, in 32-bit words.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FrameSizes {
    /// Attribute planes; 1 where a frame keeps none.
    pub attributes: usize,
    /// Counter planes; 0 where a frame keeps none.
    pub counters: usize,
    /// The picture.
    pub color: usize,
    /// Packed pixel addresses.
    pub list: usize,
    /// Mask words of the packing.
    pub masks: usize,
    /// Scan levels of the packing.
    pub sums: usize,
}

impl FrameSizes {
    /// Sizes for a frame's window; `attributes` and `counters` say which planes it keeps. `None` if they overflow `usize`.
    pub fn new(frame: &FrameParams, attributes: bool, counters: bool, scan_group: u32) -> Option<Self> {
        let words = |n: u64| usize::try_from(n).ok().filter(|&n| n < usize::MAX / 8);
        let pitch = u64::from(frame.plane_pitch);
        let rows = frame.window_end - frame.window_begin;
        let items = if attributes { most_packed_items(frame.width, rows) } else { 0 };
        let masks = items.div_ceil(32).max(1);
        let sums = scan_words(masks, scan_group).max(u64::from(TAIL_SUM_ENDS + TAIL_ROUNDS));
        Some(FrameSizes {
            attributes: words(if attributes { pitch * u64::from(PLANE_COUNT) } else { 1 })?,
            counters: words(if counters { pitch * u64::from(COUNTER_COUNT) } else { 0 })?,
            color: words(u64::from(frame.width) * u64::from(rows))?,
            list: words(if attributes { most_listed_pixels(frame) } else { 1 })?,
            masks: words(masks)?,
            sums: words(sums)?,
        })
    }

    /// Words of one of them.
    pub fn of(&self, buffer: FrameBuffer) -> usize {
        match buffer {
            FrameBuffer::Attributes => self.attributes,
            FrameBuffer::Counters => self.counters,
            FrameBuffer::Color => self.color,
            FrameBuffer::List => self.list,
            FrameBuffer::Masks => self.masks,
            FrameBuffer::Sums => self.sums,
        }
    }

    /// Whether buffers of these sizes serve where `wanted` are asked for.
    pub fn hold(&self, wanted: &FrameSizes) -> bool {
        // Items that find a counter buffer fill it.
        (self.counters > 0) == (wanted.counters > 0)
            && FrameBuffer::ALL.into_iter().all(|buffer| self.of(buffer) >= wanted.of(buffer))
    }

    /// The largest of them, in bytes.
    pub fn largest_bytes(&self) -> u64 {
        FrameBuffer::ALL.into_iter().map(|buffer| 4 * self.of(buffer) as u64).max().unwrap_or(0)
    }

    /// All of them together, in bytes.
    pub fn bytes(&self) -> u64 {
        FrameBuffer::ALL.into_iter().map(|buffer| 4 * self.of(buffer) as u64).sum()
    }

    /// Refuses a range of words that does not lie within a buffer.
    ///
    /// # Errors
    /// [`Error::LaunchBeyondBuffer`].
    pub(super) fn check_range(&self, buffer: FrameBuffer, range: &Range<usize>) -> Result<()> {
        let have = self.of(buffer);
        if range.start <= range.end && range.end <= have {
            return Ok(());
        }
        let (wanted, have) = (range.end.max(range.start) as u64, have as u64);
        Err(Error::LaunchBeyondBuffer { kernel: "transfer", what: buffer.name(), wanted, have })
    }
}

/// The most items that a packing can have in a window of `width` by `rows` samples: what masks and sums are sized by.
///
/// step2b and step3b pack grids of at most half of the pixels, in whole tiles, once for each half of the list. step4
/// packs [`STEP4_WAYS_MOST`] neighbours of each listed pixel, which may be all pixels but the base ones.
pub fn most_packed_items(width: u32, rows: u32) -> u64 {
    let (width, rows) = (u64::from(width), u64::from(rows));
    let tiled = |side: u64| side.next_multiple_of(u64::from(PACK_TILE_SIDE));
    let halves = [(width.div_ceil(2), rows), (width, rows.div_ceil(2))];
    let grid = halves.map(|(columns, rows)| 2 * tiled(columns) * tiled(rows));
    let neighbours = u64::from(STEP4_WAYS_MOST) * width * rows;
    neighbours.max(grid[0]).max(grid[1])
}

/// The most entries that the list can have in a window.
///
/// A pixel is listed once, when its check fails or when step4 fires at it. In a window of several, the pixels at which
/// other windows fire come first in the list, and step4 may fire at them again.
pub fn most_listed_pixels(frame: &FrameParams) -> u64 {
    let rows = frame.window_end - frame.window_begin;
    let pixels = u64::from(frame.width) * u64::from(rows);
    let is_one_window = frame.interior_begin == 0 && frame.interior_end == frame.height;
    if is_one_window { pixels } else { 2 * pixels }
}

/// The words of all levels of a scan over `chunks` sums, the count of all included.
pub(super) fn scan_words(chunks: u64, scan_group: u32) -> u64 {
    let (mut words, mut level) = (chunks, chunks);
    loop {
        level = level.div_ceil(u64::from(scan_group.max(2)));
        words += level;
        if level <= 1 {
            return words;
        }
    }
}

/// The buffers of a frame in an executor's memory, and what the frame is drawn from. They are freed with the handle.
pub struct FrameHandle {
    inputs: Box<FrameInputs>,
    sizes: FrameSizes,
    memory: Box<dyn Any + Send + Sync>,
}

impl FrameHandle {
    /// A handle on `memory`, whose type the executor knows.
    pub(super) fn new(inputs: FrameInputs, sizes: FrameSizes, memory: impl Any + Send + Sync) -> Self {
        FrameHandle { inputs: Box::new(inputs), sizes, memory: Box::new(memory) }
    }

    /// Size, camera and window.
    pub fn params(&self) -> &FrameParams {
        &self.inputs.params
    }

    /// What kernels read of it.
    pub fn inputs(&self) -> &FrameInputs {
        &self.inputs
    }

    /// The sizes of its buffers.
    pub fn sizes(&self) -> &FrameSizes {
        &self.sizes
    }

    pub(super) fn set_inputs(&mut self, inputs: &FrameInputs) {
        *self.inputs = inputs.clone();
    }

    /// The memory, for the executor that made it.
    pub(super) fn memory<M: Any>(&self) -> Result<&M> {
        self.memory.downcast_ref().ok_or(Error::ForeignHandle { what: "frame" })
    }
}

impl std::fmt::Debug for FrameHandle {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let FrameParams { width, height, window_begin, window_end, .. } = self.inputs.params;
        write!(f, "frame of {width}x{height}, rows {window_begin} to {window_end}, {} bytes", self.sizes.bytes())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_hold_every_level() {
        assert_eq!(scan_words(1, 256), 2);
        assert_eq!(scan_words(256, 256), 257);
        assert_eq!(scan_words(257, 256), 257 + 2 + 1);
        assert_eq!(scan_words(1000, 2), 1000 + 500 + 250 + 125 + 63 + 32 + 16 + 8 + 4 + 2 + 1);
    }

    #[test]
    fn the_documents_tell_the_bytes_of_a_sample() {
        let side = 1024;
        let phases = side / 2;
        let frame = FrameParams {
            width: side,
            height: side,
            block: 2,
            phase_width: phases,
            phase_height: phases,
            plane_pitch: side * side,
            window_end: side,
            interior_end: side,
            ..bytemuck::Zeroable::zeroed()
        };
        let bytes = |counters| {
            let sizes = FrameSizes::new(&frame, true, counters, 256).expect("a small frame");
            (sizes.bytes() as f64 / f64::from(side * side)).round()
        };
        let (without, with) = (bytes(false), bytes(true));
        let readme = include_str!("../../README.md");
        let said = format!("{without} bytes a sample for an adaptive frame ({with} with work counters)");
        assert!(readme.contains(&said), "README.md: {said}");
        let pictures = include_str!("../../docs/large-pictures.md");
        let said = format!("{without} bytes of device memory a sample, {with} with counters");
        assert!(pictures.contains(&said), "docs/large-pictures.md: {said}");
    }
}
