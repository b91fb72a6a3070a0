// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where kernels run: on an OpenCL device or as their CPU twins, behind one interface.

use super::launch_check::scan_words;
use crate::device::stage::{Kernel, Stage};
use crate::error::Result;
use crate::layout::*;
use crate::monitor::Monitor;

/// What the statistics say about the device of a frame.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BackendInfo {
    /// Device name.
    pub name: String,
    /// Device and driver version.
    pub version: String,
    /// `opencl` or `cpu`.
    pub backend: &'static str,
    /// Name of the device profile, or `none`.
    pub profile: String,
}

/// The sizes of a frame's buffers, in 32-bit words.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BufferSizes {
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

impl BufferSizes {
    /// Sizes for a frame's window; `attributes` and `counters` say which planes it keeps. `None` if they overflow `usize`.
    pub fn new(frame: &FrameParams, attributes: bool, counters: bool, scan_group: u32) -> Option<Self> {
        let words = |n: u64| usize::try_from(n).ok().filter(|&n| n < usize::MAX / 8);
        let pitch = u64::from(frame.plane_pitch);
        let rows = frame.window_end - frame.window_begin;
        let pixels = u64::from(frame.width) * u64::from(rows);
        let items = if attributes { most_packed_items(frame.width, rows) } else { 0 };
        let listed = most_listed_pixels(frame);
        let masks = items.div_ceil(32).max(1);
        let sums = scan_words(masks, scan_group);
        Some(BufferSizes {
            attributes: words(if attributes { pitch * u64::from(PLANE_COUNT) } else { 1 })?,
            counters: words(if counters { pitch * u64::from(COUNTER_COUNT) } else { 0 })?,
            color: words(pixels)?,
            list: words(if attributes { listed } else { 1 })?,
            masks: words(masks)?,
            sums: words(sums.max(u64::from(TAIL_SUM_ENDS + TAIL_ROUNDS)))?,
        })
    }

    /// Whether buffers of these sizes serve where `wanted` are asked for.
    pub fn hold(&self, wanted: &BufferSizes) -> bool {
        // Items that find a counter buffer fill it.
        (self.counters > 0) == (wanted.counters > 0)
            && self.each().into_iter().zip(wanted.each()).all(|(have, want)| have >= want)
    }

    /// The largest of them, in bytes.
    pub fn largest_bytes(&self) -> u64 {
        self.each().into_iter().map(|words| 4 * words as u64).max().unwrap_or(0)
    }

    fn each(&self) -> [usize; 6] {
        [self.attributes, self.counters, self.color, self.list, self.masks, self.sums]
    }

    /// All of them together, in bytes.
    pub fn bytes(&self) -> u64 {
        self.each().into_iter().map(|words| 4 * words as u64).sum()
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

/// How much memory a back end has for a frame, in bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MemoryLimits {
    /// All buffers together, the scene's included.
    pub total_bytes: u64,
    /// The largest single buffer.
    pub allocation_bytes: u64,
}

/// A place where kernels run. Launches happen in order; reads wait for them.
pub trait Backend {
    /// What this is.
    fn info(&self) -> BackendInfo;

    /// Work-items of a scan's work-group: a power of two.
    fn scan_group(&self) -> u32;

    /// What its memory holds, the profile's limits included.
    fn memory_limits(&self) -> MemoryLimits;

    /// How its rays walk through the kd-tree: what the counted steps depend on.
    fn traversal(&self) -> Traversal;

    /// Whether rounds of post-correction from few sources are best done by `correct_tail`, many in one launch: where a
    /// launch and a count read back cost more than such a round. The picture is the same.
    fn prefers_few_launches(&self) -> bool;

    /// Makes ready for a frame or a window of it: buffers of these sizes and the parameters.
    ///
    /// # Errors
    /// A limit of the device or its profile, or a failing call.
    fn begin(&mut self, frame: &FrameParams, sizes: &BufferSizes) -> Result<()>;

    /// Launches a kernel for a stage.
    ///
    /// # Errors
    /// A limit of the device or its profile, a program that does not build, or a failing call.
    fn run(&mut self, stage: Stage, kernel: Kernel, step: &StepParams) -> Result<()>;

    /// Reads one word of the sums buffer: the count of a packing.
    ///
    /// # Errors
    /// A failing call.
    fn read_sum(&mut self, at: u32) -> Result<u32>;

    /// Reads a buffer.
    ///
    /// # Errors
    /// A failing call.
    fn read(&mut self, buffer: FrameBuffer, range: std::ops::Range<usize>) -> Result<Vec<u32>>;

    /// Overwrites the start of a buffer; tests feed stages the twin's own inputs with it.
    ///
    /// # Errors
    /// A failing call.
    fn write(&mut self, buffer: FrameBuffer, words: &[u32]) -> Result<()>;

    /// Milliseconds that launches took since the last call, with their stages.
    ///
    /// # Errors
    /// A failing call.
    fn take_timings(&mut self) -> Result<Vec<(Stage, f64)>>;

    /// From here on `monitor` watches: launches tell it how far they are, launches and transfers end with
    /// [`crate::Error::Cancelled`] once it says so. The default monitor watches nothing.
    fn watch(&mut self, monitor: &Monitor);

    /// Who watches: long loops on the host between launches ask it, too.
    fn monitor(&self) -> &Monitor;

    /// Most bytes of device memory in use so far.
    fn peak_bytes(&self) -> u64;
}

/// A buffer of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
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
