// SPDX-License-Identifier: MIT OR Apache-2.0
//! Twin of `kernels/trace.cl`.

use super::ray_tree::{needs_correction_ray, trace_pixel};
use super::{FrameBuffers, SceneArgs};
use crate::layout::{CLASS_BASE, CLASS_CORRECTED, StepParams, grid_pixel};

/// One work-item of `trace` over a grid, whose pixels become base pixels.
pub fn trace_grid(scene: &SceneArgs, step: &StepParams, gx: u32, gy: u32, buffers: &FrameBuffers) {
    if gx >= step.grid_width || gy >= step.grid_height {
        return;
    }
    let (x, y) = grid_pixel(scene.frame, step, gx, gy);
    if x < scene.frame.width {
        trace_pixel(scene, x, y, CLASS_BASE, step, buffers);
    }
}

/// One work-item of `trace` over a list.
pub fn trace_list(scene: &SceneArgs, step: &StepParams, item: u32, buffers: &FrameBuffers) {
    if item >= step.item_count {
        return;
    }
    let pixel = buffers.list.get(step.list_offset + item);
    let (x, y) = (pixel & 0xffff, pixel >> 16);
    if step.pixel_class == CLASS_CORRECTED && !needs_correction_ray(scene.frame, step, &buffers.attributes, (x, y)) {
        return;
    }
    trace_pixel(scene, x, y, step.pixel_class, step, buffers);
}
