// SPDX-License-Identifier: MIT OR Apache-2.0
//! What frames that do not fit into device memory need: they are drawn band by band, with the same picture for every height of the bands.
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

pub use collect::{Collected, CounterSums, NewPixels, read_frame_plane, read_plane, sum_counters};
use fired::FiredPixels;
pub use plan::Plan;

use crate::error::Result;
use crate::layout::FrameParams;

/// The memory for a frame's buffers beside its scene, in bytes, and what the buffers must hold.
#[derive(Debug, Clone, Copy)]
pub struct FrameBudget {
    /// Scene and frame together.
    pub total_bytes: u64,
    /// The largest one.
    pub allocation_bytes: u64,
    /// What the scene takes of that.
    pub scene_bytes: u64,
    /// Whether attributes are kept.
    pub attributes: bool,
    /// Whether counters are kept.
    pub counters: bool,
    /// Work-items of a scan's work-group.
    pub scan_group: u32,
}

/// Post-correction across bands.
pub(super) struct OpenChains {
    /// Pixels that had their correction rays.
    pub fired: FiredPixels,
    /// Pixels that are to have theirs.
    pub pending: BTreeSet<u32>,
}

impl OpenChains {
    /// None yet, in a frame of this size.
    ///
    /// # Errors
    /// [`crate::Error::OutOfMemory`].
    pub fn new(frame: &FrameParams) -> Result<Self> {
        Ok(OpenChains { fired: FiredPixels::new(frame.width, frame.height)?, pending: BTreeSet::new() })
    }

    /// The pending pixels of `rows`, which are about to be traced.
    pub fn take_pending(&mut self, rows: &Range<u32>) -> Vec<u32> {
        let end = u64::from(rows.end) << 16;
        let below = u32::try_from(end).map_or_else(|_| BTreeSet::new(), |end| self.pending.split_off(&end));
        let taken = self.pending.split_off(&(rows.start << 16));
        self.pending.extend(below);
        taken.into_iter().collect()
    }

    /// Sorts the pixels that a window fired at, some of them perhaps twice: returns those of its interior, which were
    /// traced.
    pub fn sort(&mut self, listed: impl IntoIterator<Item = u32>, interior: &Range<u32>) -> Vec<u32> {
        let (mut traced, outside): (Vec<u32>, Vec<u32>) =
            listed.into_iter().partition(|&pixel| interior.contains(&(pixel >> 16)));
        traced.retain(|&pixel| self.fired.insert(pixel));
        self.pending.extend(outside.into_iter().filter(|&pixel| !self.fired.contains(pixel)));
        traced
    }
}
