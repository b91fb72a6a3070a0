// SPDX-License-Identifier: MIT OR Apache-2.0
//! A drawn frame and what it cost.

use std::path::Path;

use super::picture::write_png;
use crate::device::stage::Stage;
use crate::error::Result;
use crate::method::counts::{PixelCounts, RayCounts, WorkCounts};

/// A picture with its statistics.
#[derive(Debug, Clone)]
pub struct Frame {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// One sRGB word a pixel, row-major from the top: red in the lowest byte, then green, blue, alpha 255.
    pub pixels: Vec<u32>,
    /// What it cost.
    pub stats: FrameStats,
}

impl Frame {
    /// Writes the picture as a PNG file, whole or not at all.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn write_png(&self, path: impl AsRef<Path>) -> Result<()> {
        write_png(path, self.width, self.height, &self.pixels)
    }
}

/// What a frame cost.
#[derive(Debug, Clone, Default)]
pub struct FrameStats {
    /// All stages and the read-back, milliseconds.
    pub frame_ms: f64,
    /// Device time of each stage, milliseconds, in the order of [`Stage::ALL`].
    pub stages_ms: [f64; Stage::ALL.len()],
    /// How many pixels went which way.
    pub pixels: PixelCounts,
    /// Rays by kind, if counters were kept.
    pub rays: Option<RayCounts>,
    /// Work, if counters were kept.
    pub work: Option<WorkCounts>,
    /// Traversal work of base, traced and corrected pixels, if counters were kept.
    pub work_by_class: Option<[u64; 3]>,
    /// How often each test failed, in the order of [`crate::method::options::Test::ALL`], if counters were kept.
    pub failed_tests: Option<[u64; 7]>,
    /// An adaptive frame was asked for and a full one drawn, because the method did not pay in frames before, or because
    /// the adaptive one may have lost detail: times, rays and work are then those of both.
    pub fell_back: bool,
}

impl FrameStats {
    /// The frame's time outside of the stages (launches, transfers), milliseconds.
    pub fn other_ms(&self) -> f64 {
        (self.frame_ms - self.stages_ms.iter().sum::<f64>()).max(0.0)
    }

    /// Adds what a frame cost that was drawn for this one and is not shown. `work_by_class` stays this frame's.
    pub(crate) fn add_cost(&mut self, spent: &FrameStats) {
        self.frame_ms += spent.frame_ms;
        self.stages_ms.iter_mut().zip(spent.stages_ms).for_each(|(ms, more)| *ms += more);
        if let (Some(rays), Some(more)) = (&mut self.rays, spent.rays) {
            *rays += more;
        }
        if let (Some(work), Some(more)) = (&mut self.work, spent.work) {
            *work += more;
        }
    }

    /// (base + traced) / all, as in the paper.
    pub fn ray_traced_ratio(&self) -> f64 {
        let p = &self.pixels;
        (p.base + p.traced) as f64 / (p.base + p.traced + p.interpolated + p.corrected).max(1) as f64
    }

    /// (base + traced + corrected) / all.
    pub fn ray_traced_ratio_with_correction(&self) -> f64 {
        let p = &self.pixels;
        (p.base + p.traced + p.corrected) as f64 / (p.base + p.traced + p.interpolated + p.corrected).max(1) as f64
    }
}
