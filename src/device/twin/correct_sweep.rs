// SPDX-License-Identifier: MIT OR Apache-2.0
//! Twin of `kernels/correct_sweep.cl`: the paper's one round of post-correction.

use super::bridge::Hits;
use super::correct::spreads;
use super::ray_tree::trace_pixel;
use super::{FrameBuffers, SceneArgs};
use crate::layout::*;

/// One work-item of `correct_sweep`.
pub fn correct_sweep(scene: &SceneArgs, step: &StepParams, line: u32, buffers: &FrameBuffers) {
    if line >= step.item_count {
        return;
    }
    let frame = scene.frame;
    let along_row = step.step_x != 0;
    let length = if along_row { frame.width } else { frame.height };
    let pixel = |k: u32| if along_row { (k, line) } else { (line, k) };
    let forth = (1..length).map(|k| (k - 1, k));
    let back = (1..length).rev().map(|k| (k, k - 1));
    for (from, to) in forth.chain(back) {
        let (tx, ty) = pixel(to);
        if spreads(Hits { frame, step, buffers }, pixel(from), (tx, ty)) {
            trace_pixel(scene, tx, ty, CLASS_CORRECTED, step, buffers);
        }
    }
}
