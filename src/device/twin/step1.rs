// SPDX-License-Identifier: MIT OR Apache-2.0
//! Twin of `kernels/step1.cl`.

use super::{FrameBuffers, SceneArgs};
use crate::layout::*;

/// One work-item of `step1`.
pub fn step1(scene: &SceneArgs, step: &StepParams, gx: u32, gy: u32, buffers: &FrameBuffers) {
    if gx >= step.grid_width || gy >= step.grid_height {
        return;
    }
    let (x, y) = (step.origin_x + step.step_x * gx, step.origin_y + step.step_y * gy);
    super::trace::trace_pixel(scene, x, y, CLASS_BASE, step, buffers);
}
