// SPDX-License-Identifier: MIT OR Apache-2.0
//! Sets of flags in words that host and kernels share. The bits are the constants of the same names.

use bitflags::bitflags;
use bytemuck::{Pod, Zeroable};

use super::constants::*;

bitflags! {
    /// What a launch does beside what its kernel always does: `flags` of `StepParams`.
    #[repr(transparent)]
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
    pub struct StepFlags: u32 {
        /// Write attributes and class.
        const STORE = STEP_STORE;
        /// Post-correction compares shadow bits too.
        const COMPARE_SHADOW = STEP_COMPARE_SHADOW;
        /// Perspective-correct interpolation.
        const PERSPECTIVE = STEP_PERSPECTIVE;
        /// Reflected colours are compared linearly, not by their square roots.
        const GCOL_LINEAR = STEP_GCOL_LINEAR;
        /// Post-correction compares normals and reflected colours too.
        const COMPARE_SHADING = STEP_COMPARE_SHADING;
        /// The listed pixels had their rays already and are only marked.
        const SETTLE = STEP_SETTLE;
        /// Traced pixels do not spread to what a straight edge or line misses.
        const THIN_ONLY = STEP_THIN_ONLY;
        /// A pixel whose own references fail may be interpolated between other neighbours.
        const OTHER_PAIRS = STEP_OTHER_PAIRS;
        /// Texture coordinates are compared and interpolated across repetitions.
        const UNWRAP = STEP_UNWRAP;
        /// Lights about which a traced pixel's references agree need no shadow ray.
        const REUSE_SHADOWS = STEP_REUSE_SHADOWS;
        /// Sources also look for pixels between two parts of something thin.
        const BRIDGE = STEP_BRIDGE;
        /// The rows of a grid are shifted against each other.
        const SHIFTED = STEP_SHIFTED;
        /// The grid's items are probes of post-correction, one in each tile of the picture.
        const PROBES = STEP_PROBES;
        /// GC looks for texture between the points that two references see in a mirror or behind glass.
        const BEHIND = STEP_BEHIND;
    }
}

bitflags! {
    /// Similarity tests: which count, and in a pixel's class which failed.
    #[repr(transparent)]
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
    pub struct FailMask: u32 {
        /// Same object.
        const G1 = FAIL_G1;
        /// Close positions.
        const G2 = FAIL_G2;
        /// Similar normals.
        const G3 = FAIL_G3;
        /// Convexity.
        const G4 = FAIL_G4;
        /// Texture coordinates.
        const TX = FAIL_TX;
        /// Shadow bits.
        const SH = FAIL_SH;
        /// Reflected colour.
        const GC = FAIL_GC;
    }
}

impl FailMask {
    /// The failed tests of a word of the class plane.
    pub const fn of_class(class: u32) -> FailMask {
        FailMask::from_bits_truncate(class)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_hold_every_bit_that_kernels_know() {
        assert_eq!(FailMask::all().bits(), FAIL_ALL);
        let steps: u32 = SHARED_CONSTANTS
            .iter()
            .filter(|(name, bit)| name.starts_with("STEP_") && *name != "STEP4_WAYS_MOST" && bit.is_power_of_two())
            .map(|(_, bit)| bit)
            .sum();
        assert_eq!(StepFlags::all().bits(), steps);
        assert_eq!(FailMask::of_class(FAIL_GC | CLASS_SECONDARY | CLASS_TRACED), FailMask::GC);
    }
}
