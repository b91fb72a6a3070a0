// SPDX-License-Identifier: MIT OR Apache-2.0
//! Twin of `kernels/check.cl`.

use super::similarity::check_pixel;
use super::{FrameBuffers, SceneArgs};
use crate::layout::{StepParams, grid_pixel};

/// One work-item of `check`.
pub fn check(scene: &SceneArgs, step: &StepParams, gx: u32, gy: u32, buffers: &FrameBuffers) {
    if gx >= step.grid_width || gy >= step.grid_height {
        return;
    }
    let (x, y) = grid_pixel(scene.frame, step, gx, gy);
    if x < scene.frame.width {
        check_pixel(scene, step, x, y, buffers);
    }
}
