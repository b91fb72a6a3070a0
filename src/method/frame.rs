// SPDX-License-Identifier: MIT OR Apache-2.0
//! A frame: its windows are begun, drawn in full or adaptively, corrected across their borders, and collected. A frame that
//! fits into memory is a plan of one band.

use std::ops::Range;

use super::bands::{Collected, CounterSums, NewPixels, OpenChains, Plan, sum_counters};
use super::counts::{Keep, PixelCounts};
use super::window::{CorrectionSeeds, adaptive_window, trace_window};
use crate::device::frame_memory::{FrameBuffer, FrameInputs};
use crate::device::queue::Queue;
use crate::error::{Error, Remedy, Result, Setting};
use crate::layout::base_pixels;
use crate::method::options::{Correction, Mode, RenderOptions};

/// Rows of the first window that repairs a band; each further one of the same chain has twice as many.
const REPAIR_ROWS: u32 = 16;

/// What drawing a frame leaves on the host.
#[derive(Debug)]
pub struct DrawnFrame {
    /// How many pixels went which way.
    pub counts: PixelCounts,
    /// The colour of every sample, and the kept planes if the frame was more than one band; those of a frame of one band
    /// are in the queue's frame.
    pub collected: Collected,
    /// Sums of the counters, if they are kept.
    pub sums: CounterSums,
}

/// Draws a frame as `plan` cuts it, in the queue's frame, whose buffers hold any window of the plan.
///
/// # Errors
/// Correction by `sweeps` in more than one band, for its chains depend on the order of all rows; whatever the executor
/// reports.
pub fn draw_frame(
    queue: &mut Queue,
    inputs: &FrameInputs,
    plan: &Plan,
    options: &RenderOptions,
    extent: f32,
    keep: Keep,
) -> Result<DrawnFrame> {
    let kept_on_host = if plan.is_one_band() { Keep::default() } else { keep };
    let mut frame = FrameInProgress {
        inputs,
        plan,
        options,
        extent,
        keep,
        counts: PixelCounts::default(),
        collected: Collected::new(&inputs.params, kept_on_host)?,
        sums: CounterSums::default(),
    };
    if options.mode == Mode::Full {
        for rows in plan.bands() {
            frame.trace_band(queue, rows)?;
        }
    } else {
        frame.refuse_sweeps_in_bands()?;
        let mut chains = OpenChains::new(&inputs.params)?;
        for rows in plan.bands() {
            frame.draw_band(queue, rows, &mut chains)?;
        }
        frame.close(queue, &mut chains)?;
    }
    Ok(DrawnFrame { counts: frame.counts, collected: frame.collected, sums: frame.sums })
}

/// A frame while its bands are drawn.
struct FrameInProgress<'a> {
    inputs: &'a FrameInputs,
    plan: &'a Plan,
    options: &'a RenderOptions,
    extent: f32,
    keep: Keep,
    counts: PixelCounts,
    collected: Collected,
    sums: CounterSums,
}

impl FrameInProgress<'_> {
    fn refuse_sweeps_in_bands(&self) -> Result<()> {
        let sweeps = matches!(self.options.method.correction, Correction::Sweeps(_));
        if !sweeps || self.plan.is_one_band() {
            return Ok(());
        }
        Err(Error::LimitExceeded {
            what: "post-correction by sweeps".into(),
            limit: Setting::MemoryBudget.path().into(),
            wanted: format!("all {} rows of samples in memory", self.inputs.params.height),
            allowed: format!("{} rows", self.plan.rows()),
            remedies: &[Remedy::ConvergedCorrection, Remedy::LargerBudget, Remedy::SmallerPicture],
        })
    }

    /// Traces every pixel of a band.
    fn trace_band(&mut self, queue: &mut Queue, rows: Range<u32>) -> Result<()> {
        self.begin(queue, rows.clone())?;
        trace_window(queue, self.keep.attributes())?;
        let counts = PixelCounts::new(queue.params(), self.base_pixels(&rows), 0, 0);
        self.counts.add(&counts);
        self.sums.primary += counts.base;
        if self.keep.counters {
            sum_counters(queue, &mut self.sums, true)?;
        }
        self.collected.take(queue, NewPixels::Interior)
    }

    /// Draws a band for the first time.
    fn draw_band(&mut self, queue: &mut Queue, rows: Range<u32>, chains: &mut OpenChains) -> Result<()> {
        let fired = chains.take_pending(&rows);
        self.begin(queue, rows.clone())?;
        let seeds = CorrectionSeeds { settled: None, fired: &fired };
        let (traced, corrected) = self.draw_window(queue, &rows, &seeds, chains)?;
        let base = self.base_pixels(&rows);
        self.counts.add(&PixelCounts::new(queue.params(), base, traced, corrected.len));
        self.collected.take(queue, NewPixels::Interior)
    }

    /// Follows the chains that cross into bands above, until none is open.
    fn close(&mut self, queue: &mut Queue, chains: &mut OpenChains) -> Result<()> {
        let (block, height) = (self.inputs.params.block, self.inputs.params.height);
        let mut reach = REPAIR_ROWS;
        while let Some(last) = chains.pending.last() {
            // Upwards, from the last pending row.
            let end = ((last >> 16) + 1).next_multiple_of(block).min(height);
            let begin = end.saturating_sub(reach.clamp(block, self.plan.rows())).next_multiple_of(block);
            self.repair_rows(queue, begin..end, chains)?;
            let goes_on = chains.pending.last().is_some_and(|&pixel| (pixel >> 16) + 1 == begin);
            reach = if goes_on { reach.saturating_mul(2) } else { REPAIR_ROWS };
        }
        Ok(())
    }

    /// Draws rows again, to trace their pending pixels and those that these fire at.
    fn repair_rows(&mut self, queue: &mut Queue, rows: Range<u32>, chains: &mut OpenChains) -> Result<()> {
        let fired = chains.take_pending(&rows);
        self.begin(queue, rows.clone())?;
        let window = *queue.params();
        let settled = chains.fired.in_rows(window.window_begin..window.window_end);
        let seeds = CorrectionSeeds { settled: Some(&settled), fired: &fired };
        let (_, corrected) = self.draw_window(queue, &rows, &seeds, chains)?;
        self.counts.corrected += corrected.len;
        self.counts.interpolated -= corrected.len;
        self.collected.take(queue, NewPixels::Listed(&corrected.pixels))
    }

    /// How many base pixels these rows have.
    fn base_pixels(&self, rows: &Range<u32>) -> u64 {
        base_pixels(&self.inputs.params, rows.clone(), self.options.method.shifted_rows)
    }

    fn begin(&mut self, queue: &mut Queue, rows: Range<u32>) -> Result<()> {
        queue.begin(&self.inputs.window(self.plan.window(rows)))
    }

    /// Draws the window that was begun. Returns how many pixels of its interior were traced, and which were corrected.
    fn draw_window(
        &mut self,
        queue: &mut Queue,
        interior: &Range<u32>,
        seeds: &CorrectionSeeds,
        chains: &mut OpenChains,
    ) -> Result<(u64, Corrected)> {
        let listed = adaptive_window(queue, self.options, self.extent, seeds)?;
        let window = queue.params();
        let base = self.base_pixels(&(window.window_begin..window.window_end));
        let (probes, beside_probes) = listed.probes();
        self.counts.probes += probes;
        self.counts.beside_probes += beside_probes;
        self.sums.primary += base + listed.traced().len() as u64;
        let (traced, corrected) = if self.plan.is_one_band() {
            // All is interior, and no chain leaves it: nobody asks which pixels these are.
            let corrected = Corrected { len: listed.corrected().len() as u64, pixels: Vec::new() };
            (listed.traced().len() as u64, corrected)
        } else {
            let traced = queue.read(FrameBuffer::List, listed.traced())?;
            let traced = traced.iter().filter(|&&pixel| interior.contains(&(pixel >> 16))).count() as u64;
            let fired = queue.read(FrameBuffer::List, listed.corrected())?;
            let pixels = chains.sort(seeds.fired.iter().copied().chain(fired), interior);
            (traced, Corrected { len: pixels.len() as u64, pixels })
        };
        self.sums.primary += corrected.len;
        if self.keep.counters {
            sum_counters(queue, &mut self.sums, seeds.settled.is_none())?;
        }
        Ok((traced, corrected))
    }
}

/// Pixels of a window's interior that had correction rays.
struct Corrected {
    len: u64,
    /// Which; only in a frame of several bands.
    pixels: Vec<u32>,
}
