// SPDX-License-Identifier: MIT OR Apache-2.0
//! Twin of `kernels/step2c.cl`.

use super::{FrameBuffers, SceneArgs};
use crate::layout::{CLASS_TRACED, StepParams};

/// One work-item of `step2c`.
pub fn step2c(scene: &SceneArgs, step: &StepParams, item: u32, buffers: &FrameBuffers) {
    if item >= step.item_count {
        return;
    }
    let pixel = buffers.list.get(step.list_offset + item);
    super::trace::trace_pixel(scene, pixel & 0xffff, pixel >> 16, CLASS_TRACED, step, buffers);
}
