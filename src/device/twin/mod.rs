// SPDX-License-Identifier: MIT OR Apache-2.0
//! The CPU twin of every kernel: the truth that kernels are tested against, and the back end where there is no OpenCL.
//!
//! A twin is a function of one work-item (or, for kernels with barriers, one work-group) over the same buffers, written
//! like the kernel so that the two can be read side by side. [`run`] is the launch: all items of a kernel, in parallel.

// Twins compare as their kernels do, so that NaN takes the same branch.
#![allow(clippy::neg_cmp_op_on_partial_ord)]

pub mod bridge;
pub mod executor;
pub mod known_shadows;
pub mod pack;
pub mod planes;
pub mod scene_args;
pub mod shade;
pub mod similarity;
mod step1;
mod step2a;
mod step2b;
mod step2c;
mod step3a;
mod step3b;
mod step3c;
mod step4;
pub mod trace;
pub mod traverse;
mod walk_short;
mod walk_stack;

use std::sync::atomic::{AtomicU32, Ordering};

use rayon::prelude::*;

pub use planes::Words;
pub use scene_args::SceneArgs;

use crate::device::stage::{Items, Kernel};
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

/// Launches `kernel`: runs its twin for every work-item.
///
/// # Errors
/// [`crate::Error::Cancelled`]: the buffers hold anything then.
pub fn run(
    kernel: Kernel,
    scene: &SceneArgs,
    step: &StepParams,
    buffers: &FrameBuffers,
    monitor: &Monitor,
) -> Result<()> {
    let cancelled = || monitor.cancel().is_cancelled();
    match kernel.items() {
        Items::Grid => {
            let item = match kernel {
                Kernel::Step1 => step1::step1,
                Kernel::Step2a => step2a::step2a,
                Kernel::Step3a => step3a::step3a,
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
        Items::OneGroup => step4::step4_tail(scene, step, buffers),
        Items::List | Items::Chunks | Items::Groups => {
            let count = match kernel.items() {
                Items::Chunks => step.item_count.div_ceil(32),
                Items::Groups => step.item_count.div_ceil(step.scan_group),
                _ => step.item_count,
            };
            // Lists are cut into equal parts, of which the threads begin many before one ends: no share is told.
            (0..count).into_par_iter().with_min_len(ITEMS_AT_ONCE as usize).for_each(|i| {
                if !cancelled() {
                    item_1d(kernel, scene, step, i, buffers);
                }
            });
        }
    }
    monitor.check()
}

/// One work-item (or group) of a one-dimensional kernel. Exhaustive: a kernel without a twin does not compile.
fn item_1d(kernel: Kernel, scene: &SceneArgs, step: &StepParams, i: u32, buffers: &FrameBuffers) {
    match kernel {
        Kernel::Step1 | Kernel::Step2a | Kernel::Step3a => unreachable!("kernels over a grid run in two dimensions"),
        Kernel::Step2bCount => step2b::step2b_count(scene, step, i, buffers),
        Kernel::Step2bScan => step2b::step2b_scan(step, i, buffers),
        Kernel::Step2bScatter => step2b::step2b_scatter(step, i, buffers),
        Kernel::Step2c => step2c::step2c(scene, step, i, buffers),
        Kernel::Step3bCount => step3b::step3b_count(scene, step, i, buffers),
        Kernel::Step3bScan => step3b::step3b_scan(step, i, buffers),
        Kernel::Step3bScatter => step3b::step3b_scatter(step, i, buffers),
        Kernel::Step3c => step3c::step3c(scene, step, i, buffers),
        Kernel::Step4Mark => step4::step4_mark(scene, step, i, buffers),
        Kernel::Step4Count => step4::step4_count(scene, step, i, buffers),
        Kernel::Step4Scan => step4::step4_scan(step, i, buffers),
        Kernel::Step4Scatter => step4::step4_scatter(scene, step, i, buffers),
        Kernel::Step4Trace => step4::step4_trace(scene, step, i, buffers),
        Kernel::Step4Tail => unreachable!("a kernel of one work-group has no items"),
        Kernel::Step4Sweep => step4::step4_sweep(scene, step, i, buffers),
    }
}
