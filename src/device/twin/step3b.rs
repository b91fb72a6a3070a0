// SPDX-License-Identifier: MIT OR Apache-2.0
//! Twin of `kernels/step3b.cl`.

use super::{FrameBuffers, SceneArgs, pack};
use crate::layout::StepParams;

/// One work-item of `step3b_count`.
pub fn step3b_count(scene: &SceneArgs, step: &StepParams, chunk: u32, buffers: &FrameBuffers) {
    pack::count(chunk, step.item_count, &buffers.masks, &buffers.sums, |i| {
        pack::grid_item_is_pending(scene.frame, step, &buffers.attributes, i)
    });
}

/// One work-group of `step3b_scan`.
pub fn step3b_scan(step: &StepParams, group: u32, buffers: &FrameBuffers) {
    pack::scan(group, step, &buffers.sums);
}

/// One work-item of `step3b_scatter`.
pub fn step3b_scatter(step: &StepParams, chunk: u32, buffers: &FrameBuffers) {
    pack::scatter(chunk, step, &buffers.masks, &buffers.sums, &buffers.list, |i| pack::grid_item_pixel(step, i));
}
