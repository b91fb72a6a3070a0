// SPDX-License-Identifier: MIT OR Apache-2.0
//! Frames that do not fit into device memory: drawn band by band, with the same picture for every height of the bands.
//!
//! A band is drawn in a window with a little context above and below, so that all its pixels find their references and
//! all its sources their neighbours. Only post-correction reaches farther: its chains cross from band to band. A pixel
//! of the window's context at which the interior fires is left to the band that it belongs to, as a *pending* pixel.
//! Bands below take their pending pixels along when they are drawn. For a band above, which is drawn already, a small
//! window around the pending pixels is drawn again (all of it is deterministic), what had its correction ray before is
//! marked as settled, and correction goes on from the pending pixels alone; only the pixels that this traces are new.
//! Since the fired set of `converged` is a least fixed point, the order of all this does not matter.

mod collect;
mod fired;
mod plan;

use std::collections::BTreeSet;
use std::ops::Range;

pub use collect::{Collected, CounterSums, Taken, read_plane, sum_counters};
use fired::FiredPixels;
pub use plan::Plan;

use crate::device::backend::{Backend, FrameBuffer};
use crate::error::{Error, Remedy, Result, Setting};
use crate::layout::FrameParams;
use crate::method::frame::Keep;
use crate::method::options::{Correction, Mode, RenderOptions};
use crate::method::pipeline::{self, Given, PixelCounts};

/// Rows of the first window that repairs a band; each further one of the same chain has twice as many.
const REPAIR_ROWS: u32 = 16;

/// The memory that a frame's buffers may take, in bytes, and what they must hold.
#[derive(Debug, Clone, Copy)]
pub struct Room {
    /// All of them together.
    pub total_bytes: u64,
    /// The largest one.
    pub allocation_bytes: u64,
    /// What the scene takes beside them; for messages.
    pub scene_bytes: u64,
    /// Whether attributes are kept.
    pub attributes: bool,
    /// Whether counters are kept.
    pub counters: bool,
    /// Work-items of a scan's work-group.
    pub scan_group: u32,
}

/// Draws a frame band by band.
///
/// # Errors
/// `sweeps`, whose chains depend on the order of all rows; whatever the back end reports.
pub fn draw(
    backend: &mut dyn Backend,
    plan: &Plan,
    options: &RenderOptions,
    extent: f32,
    keep: Keep,
) -> Result<(PixelCounts, Collected)> {
    let whole = plan.window(0..0);
    let mut frame =
        Banded { plan, options, extent, keep, collected: Collected::new(&whole, keep), counts: PixelCounts::default() };
    if options.mode == Mode::Full {
        for rows in plan.bands() {
            frame.draw_full(backend, rows)?;
        }
        return Ok((frame.counts, frame.collected));
    }
    if matches!(options.method.correction, Correction::Sweeps(_)) {
        return Err(Error::LimitExceeded {
            what: "post-correction by sweeps".into(),
            limit: Setting::MemoryBudget.path().into(),
            wanted: format!("all {} rows of samples in memory", whole.height),
            allowed: format!("{} rows", plan.rows()),
            remedies: &[Remedy::ConvergedCorrection, Remedy::LargerBudget, Remedy::SmallerPicture],
        });
    }
    let mut chains = Chains { fired: FiredPixels::new(whole.width, whole.height), pending: BTreeSet::new() };
    for rows in plan.bands() {
        frame.draw_band(backend, rows, &mut chains)?;
    }
    let mut reach = REPAIR_ROWS;
    while let Some(last) = chains.pending.last() {
        // Chains are followed upwards, from the last pending row.
        let block = whole.block;
        let end = ((last >> 16) + 1).next_multiple_of(block).min(whole.height);
        let begin = end.saturating_sub(reach.clamp(block, plan.rows())).next_multiple_of(block);
        frame.repair(backend, begin..end, &mut chains)?;
        let goes_on = chains.pending.last().is_some_and(|&pixel| (pixel >> 16) + 1 == begin);
        reach = if goes_on { reach.saturating_mul(2) } else { REPAIR_ROWS };
    }
    Ok((frame.counts, frame.collected))
}

/// Post-correction across bands.
struct Chains {
    /// Pixels that had their correction rays.
    fired: FiredPixels,
    /// Pixels that are to have theirs.
    pending: BTreeSet<u32>,
}

impl Chains {
    /// The pending pixels of `rows`, which are about to be traced.
    fn take_pending(&mut self, rows: &Range<u32>) -> Vec<u32> {
        let end = u64::from(rows.end) << 16;
        let below = u32::try_from(end).map_or_else(|_| BTreeSet::new(), |end| self.pending.split_off(&end));
        let taken = self.pending.split_off(&(rows.start << 16));
        self.pending.extend(below);
        taken.into_iter().collect()
    }

    /// Sorts the pixels that a window fired at, some of them perhaps twice: returns those of its interior, which were
    /// traced.
    fn sort(&mut self, listed: impl IntoIterator<Item = u32>, interior: &Range<u32>) -> Vec<u32> {
        let (mut traced, outside): (Vec<u32>, Vec<u32>) =
            listed.into_iter().partition(|&pixel| interior.contains(&(pixel >> 16)));
        traced.retain(|&pixel| self.fired.insert(pixel));
        self.pending.extend(outside.into_iter().filter(|&pixel| !self.fired.contains(pixel)));
        traced
    }
}

/// A frame while its bands are drawn.
struct Banded<'a> {
    plan: &'a Plan,
    options: &'a RenderOptions,
    extent: f32,
    keep: Keep,
    collected: Collected,
    counts: PixelCounts,
}

impl Banded<'_> {
    fn draw_full(&mut self, backend: &mut dyn Backend, rows: Range<u32>) -> Result<()> {
        let window = self.plan.window(rows);
        backend.begin(&window, &self.plan.sizes)?;
        let counts = pipeline::full_frame(backend, &window, self.keep.attributes())?;
        self.counts.add(&counts);
        self.collected.sums.primary += counts.base;
        self.sum(backend, &window, true)?;
        self.collected.take(backend, &window, Taken::Interior)
    }

    fn draw_band(&mut self, backend: &mut dyn Backend, rows: Range<u32>, chains: &mut Chains) -> Result<()> {
        let fired = chains.take_pending(&rows);
        let window = self.plan.window(rows.clone());
        let given = Given { settled: None, fired: &fired };
        let (all_traced, listed) = self.draw_window(backend, &window, &given)?;
        let traced = all_traced.iter().filter(|&&pixel| rows.contains(&(pixel >> 16))).count() as u64;
        let corrected = chains.sort(fired.into_iter().chain(listed), &rows).len() as u64;
        self.counts.add(&PixelCounts::new(&window, traced, corrected));
        self.collected.sums.primary += corrected;
        self.sum(backend, &window, true)?;
        self.collected.take(backend, &window, Taken::Interior)
    }

    fn repair(&mut self, backend: &mut dyn Backend, rows: Range<u32>, chains: &mut Chains) -> Result<()> {
        let fired = chains.take_pending(&rows);
        let window = self.plan.window(rows.clone());
        let settled = chains.fired.in_rows(window.window_begin..window.window_end);
        let given = Given { settled: Some(&settled), fired: &fired };
        let (_, listed) = self.draw_window(backend, &window, &given)?;
        let fired = chains.sort(fired.into_iter().chain(listed), &rows);
        let corrected = fired.len() as u64;
        self.counts.corrected += corrected;
        self.counts.interpolated -= corrected;
        self.collected.sums.primary += corrected;
        self.sum(backend, &window, false)?;
        self.collected.take(backend, &window, Taken::Pixels(&fired))
    }

    /// Draws a window and reads which pixels it traced and which it fired at.
    fn draw_window(
        &mut self,
        backend: &mut dyn Backend,
        window: &FrameParams,
        given: &Given,
    ) -> Result<(Vec<u32>, Vec<u32>)> {
        backend.begin(window, &self.plan.sizes)?;
        let listed = pipeline::adaptive_window(backend, window, self.options, self.extent, given)?;
        let base_rows = (window.window_end - window.window_begin).div_ceil(window.block);
        self.collected.sums.primary += u64::from(window.phase_width) * u64::from(base_rows);
        self.collected.sums.primary += listed.traced().len() as u64;
        let traced = backend.read(FrameBuffer::List, listed.traced())?;
        Ok((traced, backend.read(FrameBuffer::List, listed.corrected())?))
    }

    fn sum(&mut self, backend: &mut dyn Backend, window: &FrameParams, first_time: bool) -> Result<()> {
        if self.keep.counters {
            sum_counters(backend, window, &mut self.collected.sums, first_time)?;
        }
        Ok(())
    }
}
