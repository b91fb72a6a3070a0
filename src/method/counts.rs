// SPDX-License-Identifier: MIT OR Apache-2.0
//! What of a frame is counted and kept.

use std::ops::AddAssign;

use crate::layout::{COUNTER_COUNT, FrameParams, PLANE_COUNT};

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
    #[doc(hidden)]
    pub fn planes(planes: &[u32]) -> Keep {
        Keep { planes: planes.iter().fold(0, |bits, plane| bits | 1 << plane), counters: false }
    }

    /// These counter planes (`COUNTER_*`), to be read after the frame, and the sums of all.
    #[doc(hidden)]
    pub fn counter_planes(counters: &[u32]) -> Keep {
        Keep { planes: counters.iter().fold(0, |bits, plane| bits | 1 << (PLANE_COUNT + plane)), counters: true }
    }

    /// Both.
    pub fn and(self, other: Keep) -> Keep {
        Keep { planes: self.planes | other.planes, counters: self.counters | other.counters }
    }

    /// Whether the plane is kept. Counter planes are numbered from [`PLANE_COUNT`] on.
    pub(crate) fn has(self, plane: u32) -> bool {
        self.planes >> plane & 1 != 0
    }

    /// Whether any plane is kept.
    pub(crate) fn any_plane(self) -> bool {
        self.planes != 0
    }

    /// Whether any attribute plane is kept.
    pub(crate) fn attributes(self) -> bool {
        self.planes & ((1 << PLANE_COUNT) - 1) != 0
    }
}

/// How many pixels of a frame went which way.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, serde::Serialize)]
pub struct PixelCounts {
    /// Traced in step1.
    pub base: u64,
    /// Traced in step2c and step3c.
    pub traced: u64,
    /// Rebuilt from their references, and left so.
    pub interpolated: u64,
    /// Traced in step4, changed or confirmed.
    pub corrected: u64,
    /// Of the corrected ones, those that were traced by chance. In a frame of several bands this and the next one depend on
    /// them: chains from other bands may come first.
    #[serde(skip)]
    pub probes: u64,
    /// Of the corrected ones, the interpolated neighbours that disagree with what a probe found.
    #[serde(skip)]
    pub beside_probes: u64,
}

impl PixelCounts {
    /// The counts of a frame's interior rows, of which so many pixels were base pixels, traced and corrected.
    pub fn new(frame: &FrameParams, base: u64, traced: u64, corrected: u64) -> Self {
        let pixels = u64::from(frame.width) * u64::from(frame.interior_end - frame.interior_begin);
        let interpolated = pixels - base - traced - corrected;
        PixelCounts { base, traced, corrected, interpolated, ..PixelCounts::default() }
    }

    /// Adds the counts of another window.
    pub fn add(&mut self, other: &PixelCounts) {
        self.base += other.base;
        self.traced += other.traced;
        self.interpolated += other.interpolated;
        self.corrected += other.corrected;
        self.probes += other.probes;
        self.beside_probes += other.beside_probes;
    }
}

/// Rays by kind.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, serde::Serialize)]
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

impl AddAssign for RayCounts {
    fn add_assign(&mut self, more: RayCounts) {
        self.primary += more.primary;
        self.shadow += more.shadow;
        self.reflection += more.reflection;
        self.refraction += more.refraction;
    }
}

/// Work that does not depend on the device.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, serde::Serialize)]
pub struct WorkCounts {
    /// Inner kd-tree nodes visited.
    pub traversal_steps: u64,
    /// Ray-triangle tests.
    pub triangle_tests: u64,
    /// Surface points shaded, interpolated pixels and points at the ends of secondary rays included.
    pub shaded_pixels: u64,
}

impl AddAssign for WorkCounts {
    fn add_assign(&mut self, more: WorkCounts) {
        self.traversal_steps += more.traversal_steps;
        self.triangle_tests += more.triangle_tests;
        self.shaded_pixels += more.shaded_pixels;
    }
}

impl WorkCounts {
    /// Traversal steps and triangle tests together: what `work_speedup` compares.
    pub fn traversal(&self) -> u64 {
        self.traversal_steps + self.triangle_tests
    }
}
