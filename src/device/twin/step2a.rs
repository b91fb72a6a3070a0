// SPDX-License-Identifier: MIT OR Apache-2.0
//! Twin of `kernels/step2a.cl`.

use super::{FrameBuffers, SceneArgs};
use crate::layout::StepParams;

/// One work-item of `step2a`.
pub fn step2a(scene: &SceneArgs, step: &StepParams, gx: u32, gy: u32, buffers: &FrameBuffers) {
    if gx >= step.grid_width || gy >= step.grid_height {
        return;
    }
    let (x, y) = (step.origin_x + step.step_x * gx, step.origin_y + step.step_y * gy);
    super::similarity::check_pixel(scene, step, x, y, buffers);
}
