// SPDX-License-Identifier: MIT OR Apache-2.0
//! Twin of `kernels/common/known_shadows.clh`: lights that need no shadow ray.

use super::SceneArgs;
use super::planes::{Words, plane_index};
use crate::layout::*;

/// Lights that a pixel need not send shadow rays to.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct KnownShadows {
    /// Bit i: light i needs no shadow ray.
    pub lights: u32,
    /// Its shadow bit.
    pub bits: u32,
}

/// Whether the failed tests of a pixel leave no doubt about the surface between its references.
pub fn surface_is_sure(mask: FailMask) -> bool {
    !mask.intersects(FailMask::G1 | FailMask::G2) && (mask.contains(FailMask::GC) || mask == FailMask::SH)
}

/// What is known before the shadow rays of pixel `(x, y)`, whose primary ray hit `object`. `attributes` still hold what
/// the pixel's check left.
pub fn known_shadows(
    scene: &SceneArgs,
    step: &StepParams,
    attributes: &Words,
    (x, y): (u32, u32),
    pixel_class: u32,
    (object, material): (u32, u32),
) -> KnownShadows {
    let nothing = KnownShadows::default();
    if pixel_class == CLASS_BASE || !step.flags.contains(StepFlags::REUSE_SHADOWS) {
        return nothing;
    }
    let frame = scene.frame;
    let plane = |plane: u32, at: u32| attributes.get(plane * frame.plane_pitch + at);
    let at = plane_index(frame, x, y);
    if pixel_class == CLASS_TRACED {
        let (dx, dy) = (step.reference_dx, step.reference_dy);
        if x < dx || x + dx >= frame.width || y + dy >= frame.height {
            return nothing;
        }
        if !surface_is_sure(FailMask::of_class(plane(PLANE_CLASS, at))) {
            return nothing;
        }
        let (a, b) = (plane_index(frame, x - dx, y - dy), plane_index(frame, x + dx, y + dy));
        if plane(PLANE_OBJECT, a) != object || plane(PLANE_OBJECT, b) != object {
            return nothing;
        }
        let bits = plane(PLANE_SHADOW, a);
        return KnownShadows { bits, lights: !(bits ^ plane(PLANE_SHADOW, b)) };
    }
    let material = &scene.materials[material as usize];
    let little_own_light = material.surface != SURFACE_OPAQUE && material.reflectance[3] <= LITTLE_OWN_LIGHT;
    if plane(PLANE_OBJECT, at) == object && little_own_light {
        return KnownShadows { bits: plane(PLANE_SHADOW, at), lights: u32::MAX };
    }
    nothing
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_reflections_and_lone_shadows_leave_the_surface_out_of_doubt() {
        for mask in [
            FailMask::SH,
            FailMask::GC,
            FailMask::SH | FailMask::GC,
            FailMask::G3 | FailMask::GC,
            FailMask::TX | FailMask::SH | FailMask::GC,
        ] {
            assert!(surface_is_sure(mask), "{mask:?}");
        }
        // The strictest tolerances fail G2 everywhere: nothing is taken over then.
        for mask in [
            FailMask::empty(),
            FailMask::G1,
            FailMask::G2 | FailMask::GC,
            FailMask::G3,
            FailMask::G4 | FailMask::SH,
            FailMask::TX | FailMask::SH,
            FailMask::all(),
        ] {
            assert!(!surface_is_sure(mask), "{mask:?}");
        }
    }
}
