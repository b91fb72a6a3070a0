// SPDX-License-Identifier: MIT OR Apache-2.0
//! A drawn frame and what it cost.

use crate::device::stage::Stage;
use crate::layout::{COUNTER_COUNT, PLANE_COUNT};
use crate::method::pipeline::PixelCounts;

/// What a frame keeps beside its picture.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Keep {
    planes: u32,
    /// Sums of the work counters.
    pub counters: bool,
}

impl Keep {
    /// Every attribute plane and every counter, to be read after the frame.
    pub const EVERYTHING: Keep = Keep { planes: (1 << (PLANE_COUNT + COUNTER_COUNT)) - 1, counters: true };
    /// The sums of the work counters.
    pub const COUNTERS: Keep = Keep { planes: 0, counters: true };

    /// These attribute planes (`PLANE_*`), to be read after the frame.
    pub fn planes(planes: &[u32]) -> Keep {
        Keep { planes: planes.iter().fold(0, |bits, plane| bits | 1 << plane), counters: false }
    }

    /// These counter planes (`COUNTER_*`), to be read after the frame, and the sums of all.
    pub fn counter_planes(counters: &[u32]) -> Keep {
        Keep { planes: counters.iter().fold(0, |bits, plane| bits | 1 << (PLANE_COUNT + plane)), counters: true }
    }

    /// Both.
    pub fn and(self, other: Keep) -> Keep {
        Keep { planes: self.planes | other.planes, counters: self.counters | other.counters }
    }

    /// Is the plane kept? Counter planes are numbered from [`PLANE_COUNT`] on.
    pub(crate) fn has(self, plane: u32) -> bool {
        self.planes >> plane & 1 != 0
    }

    /// Is any attribute plane kept?
    pub(crate) fn attributes(self) -> bool {
        self.planes & ((1 << PLANE_COUNT) - 1) != 0
    }
}

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

/// Rays by kind.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct RayCounts {
    /// From the eye.
    pub primary: u64,
    /// Towards lights.
    pub shadow: u64,
    /// Off mirrors and glass, total internal reflection included.
    pub reflection: u64,
    /// Through glass.
    pub refraction: u64,
}

/// Work that does not depend on the device.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct WorkCounts {
    /// Inner kd-tree nodes visited.
    pub traversal_steps: u64,
    /// Ray-triangle tests.
    pub triangle_tests: u64,
    /// Surface points shaded, interpolated pixels and points at the ends of secondary rays included.
    pub shaded_pixels: u64,
}

impl WorkCounts {
    /// Traversal steps and triangle tests together: what `work_speedup` compares.
    pub fn traversal(&self) -> u64 {
        self.traversal_steps + self.triangle_tests
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
    /// An adaptive frame was asked for and a full one drawn, because the method did not pay in frames before.
    pub fell_back: bool,
}

impl FrameStats {
    /// The frame's time outside of the stages (launches, transfers), milliseconds.
    pub fn other_ms(&self) -> f64 {
        (self.frame_ms - self.stages_ms.iter().sum::<f64>()).max(0.0)
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
