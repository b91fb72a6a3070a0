// SPDX-License-Identifier: MIT OR Apache-2.0
//! The CPU twin of every kernel: the truth that kernels are tested against, and the executor where there is no OpenCL.
//!
//! A twin is a function of one work-item (or, for kernels with barriers, one work-group) over the same buffers, written
//! like the kernel so that the two can be read side by side. [`run`] is the launch: all items of a kernel, in parallel.

// Twins compare as their kernels do, so that NaN takes the same branch.
#![allow(clippy::neg_cmp_op_on_partial_ord)]

pub mod bridge;
mod check;
mod correct;
mod correct_sweep;
pub mod correct_tail;
pub mod executor;
pub mod known_shadows;
pub mod pack;
pub mod planes;
pub mod ray_tree;
pub mod scene_args;
pub mod shade;
pub mod similarity;
mod trace;
pub mod traverse;
pub mod triangle_test;
mod walk_short;
mod walk_stack;

use std::sync::atomic::{AtomicU32, Ordering};

use rayon::prelude::*;

pub use planes::Words;
pub use scene_args::SceneArgs;

use crate::device::stage::{Items, Kernel, Stage};
use crate::error::Result;
use crate::layout::StepParams;
use crate::monitor::Monitor;

/// The buffers of a frame.
#[derive(Debug, Default)]
pub struct FrameBuffers {
    /// Attribute planes (`PLANE_*`), `plane_pitch` words each.
    pub attributes: Words,
    /// Counter planes (`COUNTER_*`), `plane_pitch` words each; empty if no counters are kept.
    pub counters: Words,
    /// The picture: one sRGB word a pixel, row-major.
    pub color: Words,
    /// Packed pixel addresses.
    pub list: Words,
    /// Mask words of the packing.
    pub masks: Words,
    /// Scan levels of the packing.
    pub sums: Words,
}

/// Work-items that a thread runs before it asks whether the launch is to end.
const ITEMS_AT_ONCE: u32 = 16;

/// Launches `kernel` for `stage`: runs its twin for every work-item.
///
/// # Errors
/// [`crate::Error::Cancelled`]: the buffers hold anything then.
pub fn run(
    stage: Stage,
    kernel: Kernel,
    scene: &SceneArgs,
    step: &StepParams,
    buffers: &FrameBuffers,
    monitor: &Monitor,
) -> Result<()> {
    let cancelled = || monitor.cancel().is_cancelled();
    match kernel.items(stage) {
        Items::Grid => {
            let item = match kernel {
                Kernel::Trace => trace::trace_grid,
                Kernel::Check => check::check,
                _ => unreachable!("kernels over a grid are listed above"),
            };
            let rows_done = AtomicU32::new(0);
            (0..step.grid_height).into_par_iter().for_each(|gy| {
                for gx in 0..step.grid_width {
                    if gx % ITEMS_AT_ONCE == 0 && cancelled() {
                        return;
                    }
                    item(scene, step, gx, gy, buffers);
                }
                let done = rows_done.fetch_add(1, Ordering::Relaxed) + 1;
                monitor.tell(done as f32 / step.grid_height as f32);
            });
        }
        Items::OneGroup => correct_tail::correct_tail(scene, step, buffers, |round| {
            (0..round.item_count).into_par_iter().for_each(|item| trace::trace_list(scene, round, item, buffers));
        }),
        Items::List | Items::Chunks | Items::Groups => {
            let count = match kernel.items(stage) {
                Items::Chunks => step.item_count.div_ceil(32),
                Items::Groups => step.item_count.div_ceil(step.scan_group),
                _ => step.item_count,
            };
            let item = |i| {
                if !cancelled() {
                    item_1d(kernel, scene, step, i, buffers);
                }
            };
            // Correction has many launches of a few items, which are done sooner than another thread wakes up.
            if count <= ITEMS_AT_ONCE {
                (0..count).for_each(item);
            } else {
                // Lists are cut into equal parts, of which the threads begin many before one ends: no share is told.
                (0..count).into_par_iter().with_min_len(ITEMS_AT_ONCE as usize).for_each(item);
            }
        }
    }
    monitor.check()
}

/// One work-item (or group) of a one-dimensional kernel. Exhaustive: a kernel without a twin does not compile.
fn item_1d(kernel: Kernel, scene: &SceneArgs, step: &StepParams, i: u32, buffers: &FrameBuffers) {
    match kernel {
        Kernel::Trace => trace::trace_list(scene, step, i, buffers),
        Kernel::Check => unreachable!("a kernel over a grid runs in two dimensions"),
        Kernel::PackCount => pack::pack_count(scene, step, i, buffers),
        Kernel::PackScan => pack::pack_scan(step, i, buffers),
        Kernel::PackScatter => pack::pack_scatter(scene, step, i, buffers),
        Kernel::CorrectMark => correct::correct_mark(scene, step, i, buffers),
        Kernel::CorrectCount => correct::correct_count(scene, step, i, buffers),
        Kernel::CorrectScatter => correct::correct_scatter(scene, step, i, buffers),
        Kernel::CorrectTail => unreachable!("a kernel of one work-group has no items"),
        Kernel::CorrectSweep => correct_sweep::correct_sweep(scene, step, i, buffers),
    }
}
