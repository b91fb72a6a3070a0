// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a frame leaves to the wave model: its launches' lanes, each with what it cost.

use std::sync::Arc;

use rayon::prelude::*;

use super::loops::loops;
use super::{BYTES_PER_STEP, Lane, SHADED_POINT, TRIANGLE_TEST};
use crate::device::executor::Executor;
use crate::device::frame_memory::{FrameBuffer, FrameHandle, FrameInputs};
use crate::device::hooks::recording::RecordedLaunch;
use crate::device::launch::Launch;
use crate::device::queue::Hook;
use crate::device::stage::{Kernel, Stage};
use crate::device::twin::executor::scene_args;
use crate::device::twin::{SceneArgs, Words};
use crate::error::{Error, Remedy, Result, Setting};
use crate::layout::*;
use crate::prepare::PreparedScene;

/// Side of the square work-groups of grid launches, in work-items.
const GROUP_SIDE: u32 = 8;

/// Attributes, class and claim of a sample, in bytes.
const ATTRIBUTE_BYTES: f64 = 4.0 * PLANE_COUNT as f64;
const COLOR_BYTES: f64 = 4.0;
const LIST_BYTES: f64 = 4.0;

/// Refuses frames in bands: what their windows cost is not read.
pub(super) struct OneWindow;

impl Hook for OneWindow {
    fn begin(&mut self, _: &mut dyn Executor, frame: &FrameHandle) -> Result<()> {
        let FrameParams { height, window_begin, window_end, .. } = *frame.params();
        if (window_begin, window_end) == (0, height) {
            return Ok(());
        }
        Err(Error::LimitExceeded {
            what: "the wave model".into(),
            limit: Setting::MemoryBudget.path().into(),
            wanted: format!("all {height} rows of samples in memory"),
            allowed: format!("{} rows", window_end - window_begin),
            remedies: &[Remedy::SmallerPicture, Remedy::LargerBudget],
        })
    }
}

/// What correction overwrites, and what it was drawn of.
#[derive(Default)]
pub(super) struct Before {
    scene: Option<Arc<PreparedScene>>,
    /// All attributes as they were when correction began.
    attributes: Option<Vec<u32>>,
}

impl Hook for Before {
    fn before(&mut self, executor: &mut dyn Executor, launch: &Launch) -> Result<()> {
        self.scene.get_or_insert_with(|| Arc::clone(launch.scene.prepared()));
        if launch.stage == Stage::Step4 && self.attributes.is_none() {
            self.attributes = Some(all_attributes(executor, launch.frame)?);
        }
        Ok(())
    }
}

fn all_attributes(executor: &mut dyn Executor, frame: &FrameHandle) -> Result<Vec<u32>> {
    executor.read(frame, FrameBuffer::Attributes, 0..frame.sizes().attributes)
}

/// What a frame left on the device.
pub(super) struct Left {
    inputs: FrameInputs,
    traversal: Traversal,
    /// Traversal steps, triangle tests, shaded points.
    counters: [Vec<u32>; 3],
    attributes: Vec<u32>,
    list: Vec<u32>,
}

impl Left {
    pub(super) fn read(executor: &mut dyn Executor, handle: &FrameHandle) -> Result<Self> {
        let pitch = handle.params().plane_pitch as usize;
        let mut counter = |plane: u32| {
            let at = plane as usize * pitch;
            executor.read(handle, FrameBuffer::Counters, at..at + pitch)
        };
        Ok(Left {
            inputs: handle.inputs().clone(),
            counters: [counter(COUNTER_TRAVERSAL_STEPS)?, counter(COUNTER_TRIANGLE_TESTS)?, counter(COUNTER_SHADED)?],
            traversal: executor.traversal(),
            attributes: all_attributes(executor, handle)?,
            list: executor.read(handle, FrameBuffer::List, 0..handle.sizes().list)?,
        })
    }
}

/// The lanes of a frame's launches.
pub(super) struct FrameItems {
    scene: Arc<PreparedScene>,
    left: Left,
    /// Attributes as traced pixels found them.
    found: Words,
}

impl FrameItems {
    pub(super) fn new(before: Before, left: Left) -> Result<Self> {
        let scene = before.scene.ok_or(Error::argument("the frame", "it had no launch"))?;
        let found = Words::from_words(before.attributes.as_ref().unwrap_or(&left.attributes));
        Ok(FrameItems { scene, left, found })
    }

    fn frame(&self) -> &FrameParams {
        &self.left.inputs.params
    }

    pub(super) fn passes(&self, launch: &RecordedLaunch) -> Vec<Vec<Lane>> {
        if launch.kernel != Kernel::CorrectTail {
            return vec![self.lanes(launch.stage, launch.kernel, &launch.step)];
        }
        // Each round is a mark, which packs, too, and a trace.
        let (mut sources, mut begin, mut passes) = (launch.step.item_count / 4, launch.step.list_offset, Vec::new());
        for &end in &launch.round_ends {
            let round = StepParams { list_offset: begin, item_count: end - begin, ..launch.step };
            let round = StepParams { pixel_class: CLASS_CORRECTED, ..round };
            let mark = StepParams { item_count: 4 * sources, ..round };
            passes.push(self.lanes(launch.stage, Kernel::CorrectMark, &mark));
            passes.push(self.lanes(launch.stage, Kernel::Trace, &round));
            (sources, begin) = (end - begin, end);
        }
        passes
    }

    fn lanes(&self, stage: Stage, kernel: Kernel, step: &StepParams) -> Vec<Lane> {
        let bytes = |bytes: f64| bytes / BYTES_PER_STEP;
        let alike = |count: u32, cost: f64| vec![Lane::of(cost); count as usize];
        match kernel {
            Kernel::Trace if stage == Stage::Step1 => self.grid_lanes(step, |x, y| self.traced(step, CLASS_BASE, x, y)),
            Kernel::Check => self.grid_lanes(step, |x, y| Lane::of(self.checked(x, y))),
            Kernel::Trace => {
                let entries = &self.left.list[step.list_offset as usize..][..step.item_count as usize];
                let lane = |&pixel: &u32| {
                    let lane = self.traced(step, step.pixel_class, pixel & 0xffff, pixel >> 16);
                    Lane { cost: lane.cost + bytes(LIST_BYTES), ..lane }
                };
                entries.par_iter().map(lane).collect()
            }
            // A source's and a neighbour's class; few go on to compare.
            Kernel::CorrectMark => alike(step.item_count, bytes(LIST_BYTES + 8.0)),
            // 32 class words, a mask and a sum; the scan reads and writes a sum; scatter writes few entries.
            Kernel::PackCount | Kernel::CorrectCount => alike(step.item_count.div_ceil(32), bytes(4.0 * 34.0)),
            Kernel::PackScan => alike(step.item_count, bytes(8.0)),
            Kernel::PackScatter | Kernel::CorrectScatter => alike(step.item_count.div_ceil(32), bytes(4.0 * 12.0)),
            Kernel::CorrectTail => unreachable!("its passes are those of other kernels"),
            // One lane a line: what it fires is not attributed to lines.
            Kernel::CorrectSweep => alike(step.item_count, bytes(16.0 * f64::from(self.frame().width))),
        }
    }

    /// Lanes of a grid launch: work-groups of 8x8 row by row, row-major within a group.
    fn grid_lanes(&self, step: &StepParams, lane: impl Fn(u32, u32) -> Lane + Sync) -> Vec<Lane> {
        let groups = (step.grid_width.div_ceil(GROUP_SIDE), step.grid_height.div_ceil(GROUP_SIDE));
        let in_group = |group: u32| {
            let (left, top) = (group % groups.0 * GROUP_SIDE, group / groups.0 * GROUP_SIDE);
            let lane = &lane;
            (0..GROUP_SIDE * GROUP_SIDE).into_par_iter().map(move |at| {
                let (gx, gy) = (left + at % GROUP_SIDE, top + at / GROUP_SIDE);
                let (x, y) = grid_pixel(self.frame(), step, gx, gy);
                let inside = gx < step.grid_width && gy < step.grid_height && x < self.frame().width;
                if inside { lane(x, y) } else { Lane::of(0.0) }
            })
        };
        (0..groups.0 * groups.1).into_par_iter().flat_map(in_group).collect()
    }

    /// A pixel's ray tree and what it writes.
    fn traced(&self, step: &StepParams, class: u32, x: u32, y: u32) -> Lane {
        let at = plane_index(self.frame(), x, y) as usize;
        let [steps, tests, shaded] = [0, 1, 2].map(|counter| f64::from(self.left.counters[counter][at]));
        let stored = if self.frame().block > 1 { ATTRIBUTE_BYTES } else { 0.0 };
        let counted = steps + TRIANGLE_TEST * tests + SHADED_POINT * shaded;
        // A listed pixel of another window has no ray.
        let loops =
            if counted > 0.0 { loops(&self.scene_args(), step, class, (x, y), &self.found) } else { Box::default() };
        debug_assert_eq!(loops.iter().map(|(_, cost)| cost).sum::<f64>(), counted, "class {class} at {x}, {y}");
        Lane { cost: counted + (stored + COLOR_BYTES) / BYTES_PER_STEP, loops }
    }

    fn scene_args(&self) -> SceneArgs<'_> {
        SceneArgs { traversal: self.left.traversal, ..scene_args(&self.scene, &self.left.inputs) }
    }

    /// A check, and the interpolation where it passed: what correction traced later had been interpolated before.
    fn checked(&self, x: u32, y: u32) -> f64 {
        let read = 2.0 * (ATTRIBUTE_BYTES + COLOR_BYTES) / BYTES_PER_STEP;
        let at = plane_index(self.frame(), x, y);
        let class = self.left.attributes[(PLANE_CLASS * self.frame().plane_pitch + at) as usize];
        if matches!(class & CLASS_MASK, CLASS_INTERPOLATED | CLASS_CORRECTED | CLASS_CONFIRMED) {
            // Background is not shaded. What a correction ray left here counts as one point, too.
            let shaded = if self.left.counters[2][at as usize] > 0 { SHADED_POINT } else { 0.0 };
            read + shaded + (ATTRIBUTE_BYTES + COLOR_BYTES) / BYTES_PER_STEP
        } else {
            read
        }
    }
}
