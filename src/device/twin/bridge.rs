// SPDX-License-Identifier: MIT OR Apache-2.0
//! Twin of `kernels/common/bridge.clh`: pixels between two parts of something thin.

use super::FrameBuffers;
use super::planes::{StoredHit, color_index, hits_differ, plane_index};
use crate::layout::*;

/// What a launch of step4 looks at.
#[derive(Clone, Copy)]
pub struct Hits<'a> {
    /// The frame.
    pub frame: &'a FrameParams,
    /// The launch.
    pub step: &'a StepParams,
    /// Its buffers.
    pub buffers: &'a FrameBuffers,
}

impl Hits<'_> {
    /// What the pixel `(x, y)` hit.
    pub fn of(&self, (x, y): (u32, u32)) -> StoredHit<'_> {
        let at = plane_index(self.frame, x, y);
        StoredHit { planes: &self.buffers.attributes, pitch: self.frame.plane_pitch, at }
    }

    /// Whether the hits of two pixels differ.
    pub fn differ(&self, a: (u32, u32), b: (u32, u32)) -> bool {
        let color = |(x, y): (u32, u32)| self.buffers.color.get(color_index(self.frame, x, y));
        hits_differ(self.step, &self.of(a), &self.of(b), || color(a), || color(b))
    }

    /// Whether the pixels above and below `(x, y)` both show something else than it does.
    fn is_thin(&self, (x, y): (u32, u32)) -> bool {
        self.differ((x, y), (x, y - 1)) && self.differ((x, y), (x, y + 1))
    }
}

/// The pixel beside the source `(x, y)` that lies midway between two parts of something thin; [`NO_PIXEL`] if there is
/// none.
pub fn bridged_pixel(hits: Hits, (x, y): (u32, u32)) -> u32 {
    let frame = hits.frame;
    if y & 1 == 0 || y < frame.interior_begin || y >= frame.interior_end || y < 2 || y + 2 >= frame.height {
        return NO_PIXEL;
    }
    let above = hits.is_thin((x, y - 1));
    if !above && !hits.is_thin((x, y + 1)) {
        return NO_PIXEL;
    }
    let (near, across) = if above { (y - 1, y + 1) } else { (y + 1, y - 1) };
    for k in 1..=BRIDGE_REACH {
        // Left of the picture wraps around to beyond it.
        for (px, qx) in [(x.wrapping_sub(2 * k), x.wrapping_sub(k)), (x + 2 * k, x + k)] {
            if px >= frame.width || hits.differ((x, near), (px, across)) || !hits.is_thin((px, across)) {
                continue;
            }
            let class = PLANE_CLASS * frame.plane_pitch + plane_index(frame, qx, y);
            let interpolated = hits.buffers.attributes.get(class) & CLASS_MASK == CLASS_INTERPOLATED;
            return if interpolated && hits.differ((x, near), (qx, y)) { qx | y << 16 } else { NO_PIXEL };
        }
    }
    NO_PIXEL
}
