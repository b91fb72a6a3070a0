// SPDX-License-Identifier: MIT OR Apache-2.0
//! The last look at a launch: whether all that it reads and writes lies within its buffers.
//!
//! Kernels trust their parameters. A launch whose items or ranges do not fit is refused here, with the numbers, by every
//! executor, before it can overwrite anything.

use super::frame_memory::{FrameSizes, scan_words};
use super::stage::{Binding, Items, Kernel, Stage};
use crate::error::{Error, Result};
use crate::layout::*;

/// Refuses a launch that would reach beyond buffers of these sizes or beyond the window of the frame.
///
/// # Errors
/// [`Error::LaunchBeyondBuffer`] with the first thing that there is too little of.
pub fn check_launch(
    stage: Stage,
    kernel: Kernel,
    step: &StepParams,
    frame: &FrameParams,
    sizes: &FrameSizes,
) -> Result<()> {
    let need = |what: &'static str, wanted: u64, have: u64| {
        if wanted <= have {
            return Ok(());
        }
        Err(Error::LaunchBeyondBuffer { kernel: kernel.label(stage), what, wanted, have })
    };
    let rows = u64::from(frame.window_end.saturating_sub(frame.window_begin));
    let pitch = u64::from(frame.plane_pitch);
    let items = u64::from(step.item_count);
    for binding in kernel.bindings() {
        match binding {
            // Full tracing keeps no attributes unless it is asked to.
            Binding::Attributes if stage != Stage::Step1 || step.flags.contains(StepFlags::STORE) => {
                need("words of attributes", u64::from(PLANE_COUNT) * pitch, sizes.attributes as u64)?;
            }
            Binding::Color => need("words of colour", u64::from(frame.width) * rows, sizes.color as u64)?,
            Binding::Counters if sizes.counters > 0 => {
                need("words of counters", u64::from(COUNTER_COUNT) * pitch, sizes.counters as u64)?;
            }
            _ => {}
        }
    }
    let list = |end: u64| need("list entries", end, sizes.list as u64);
    let sums = |end: u64| need("words of sums", end, sizes.sums as u64);
    let masks = |end: u64| need("mask words", end, sizes.masks as u64);
    match kernel.items(stage) {
        Items::Grid => {
            let end = |origin: u32, step: u32, count: u32| match count {
                0 => 0,
                _ => u64::from(origin) + u64::from(step) * u64::from(count - 1) + 1,
            };
            // In shifted rows the grid begins at the left border; kernels skip what lies behind the right one.
            let left = if step.flags.contains(StepFlags::SHIFTED) { 0 } else { step.origin_x };
            need("columns", end(left, step.step_x, step.grid_width), u64::from(frame.width))?;
            need("rows", end(step.origin_y, step.step_y, step.grid_height), u64::from(frame.window_end))?;
            need("rows above the grid", u64::from(frame.window_begin), u64::from(step.origin_y))
        }
        Items::List => match kernel {
            Kernel::CorrectMark => list(sources_end(step)),
            Kernel::CorrectSweep => {
                let lines = if step.step_x != 0 { rows } else { u64::from(frame.width) };
                need("lines", items, lines)
            }
            _ => list(u64::from(step.list_offset) + items),
        },
        Items::Chunks => {
            let chunks = items.div_ceil(32);
            masks(chunks)?;
            match kernel {
                Kernel::CorrectCount | Kernel::CorrectScatter => list(sources_end(step))?,
                _ => {}
            }
            match kernel {
                Kernel::PackScatter | Kernel::CorrectScatter => {
                    sums(scan_words(chunks, step.scan_group))?;
                    list(u64::from(step.list_end))
                }
                _ => sums(chunks),
            }
        }
        Items::Groups => {
            let groups = items.div_ceil(u64::from(step.scan_group.max(1)));
            sums(u64::from(step.sums_offset) + items + groups)
        }
        Items::OneGroup => {
            sums(u64::from(TAIL_SUM_ENDS + TAIL_ROUNDS))?;
            list(sources_end(step))?;
            list(u64::from(step.list_end).max(u64::from(step.list_offset)))
        }
    }
}

/// Behind the last list entry whose neighbours a launch of post-correction looks at.
fn sources_end(step: &StepParams) -> u64 {
    let ways = if step.flags.contains(StepFlags::BRIDGE) { STEP4_WAYS_MOST } else { 4 };
    u64::from(step.source_offset) + u64::from(step.item_count.div_ceil(ways))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::stage::LAUNCHES;

    type Launch = (Stage, Kernel);

    const STEP1: Launch = (Stage::Step1, Kernel::Trace);
    const STEP2A: Launch = (Stage::Step2a, Kernel::Check);
    const STEP2C: Launch = (Stage::Step2c, Kernel::Trace);
    const STEP3A: Launch = (Stage::Step3a, Kernel::Check);
    const STEP3B_SCATTER: Launch = (Stage::Step3b, Kernel::PackScatter);
    const MARK: Launch = (Stage::Step4, Kernel::CorrectMark);
    const COUNT: Launch = (Stage::Step4, Kernel::CorrectCount);
    const SCAN: Launch = (Stage::Step4, Kernel::PackScan);
    const TAIL: Launch = (Stage::Step4, Kernel::CorrectTail);
    const SWEEP: Launch = (Stage::Step4, Kernel::CorrectSweep);

    fn frame(width: u32, height: u32) -> FrameParams {
        let (phase_width, phase_height) = (width.div_ceil(2), height.div_ceil(2));
        FrameParams {
            width,
            height,
            block: 2,
            phase_width,
            phase_height,
            plane_pitch: 4 * phase_width * phase_height,
            window_end: height,
            interior_end: height,
            ..bytemuck::Zeroable::zeroed()
        }
    }

    /// What the launch lacks, and how much it wants.
    fn lacks((stage, kernel): Launch, step: StepParams, sizes: &FrameSizes) -> Option<(&'static str, u64)> {
        match check_launch(stage, kernel, &step, &frame(64, 48), sizes) {
            Err(Error::LaunchBeyondBuffer { what, wanted, have, .. }) => {
                assert!(wanted > have);
                Some((what, wanted))
            }
            _ => None,
        }
    }

    #[test]
    fn each_buffer_is_guarded_to_its_last_word() {
        let pixels = 64 * 48;
        let fits = FrameSizes::new(&frame(64, 48), true, true, 64).unwrap();
        let step = StepParams {
            step_x: 1,
            step_y: 1,
            grid_width: 64,
            grid_height: 48,
            item_count: pixels,
            scan_group: 64,
            flags: StepFlags::STORE,
            ..bytemuck::Zeroable::zeroed()
        };
        for (stage, kernel, label) in LAUNCHES {
            let step = match kernel {
                Kernel::CorrectSweep => StepParams { item_count: 48, ..step },
                Kernel::PackScan => StepParams { item_count: 96, ..step },
                _ => step,
            };
            assert_eq!(lacks((stage, kernel), step, &fits), None, "{label}");
        }
        let less = |change: fn(&mut FrameSizes)| {
            let mut sizes = fits;
            change(&mut sizes);
            sizes
        };
        let attributes = less(|sizes| sizes.attributes -= 1);
        assert_eq!(
            lacks(STEP2A, step, &attributes),
            Some(("words of attributes", u64::from(PLANE_COUNT) * u64::from(pixels)))
        );
        assert_eq!(lacks(STEP1, StepParams { flags: StepFlags::empty(), ..step }, &attributes), None);
        assert_eq!(lacks(STEP1, step, &less(|s| s.color -= 1)), Some(("words of colour", u64::from(pixels))));
        let counters = lacks(STEP2C, step, &less(|sizes| sizes.counters -= 1));
        assert_eq!(counters, Some(("words of counters", 6 * u64::from(pixels))));
        let wide = StepParams { grid_width: 65, ..step };
        assert_eq!(lacks(STEP3A, wide, &fits), Some(("columns", 65)));
        assert_eq!(lacks(STEP2A, StepParams { origin_y: 1, ..step }, &fits), Some(("rows", 49)));
        let behind = StepParams { list_offset: 1, ..step };
        assert_eq!(lacks(STEP2C, behind, &fits), Some(("list entries", u64::from(pixels) + 1)));
        let source = StepParams { source_offset: pixels, item_count: 5, flags: StepFlags::BRIDGE, ..step };
        assert_eq!(lacks(MARK, source, &fits), Some(("list entries", u64::from(pixels) + 1)));
        let scatter = StepParams { item_count: 32, list_end: pixels + 7, ..step };
        assert_eq!(lacks(STEP3B_SCATTER, scatter, &fits), Some(("list entries", u64::from(pixels) + 7)));
        assert_eq!(lacks(TAIL, scatter, &fits), Some(("list entries", u64::from(pixels) + 7)));
        // What corrupted the heap once: five items for each of up to 15/16 of the pixels.
        let first_round = StepParams { item_count: 5 * pixels, flags: StepFlags::BRIDGE, ..step };
        assert_eq!(lacks(COUNT, first_round, &fits), None);
        let small = less(|sizes| sizes.masks = 4 * 64 * 48 / 32);
        assert_eq!(lacks(COUNT, first_round, &small), Some(("mask words", 480)));
        let level = StepParams { item_count: 480, sums_offset: 10, ..step };
        assert!(lacks(SCAN, level, &FrameSizes { sums: 497, ..fits }).is_some());
        assert!(lacks(SCAN, level, &FrameSizes { sums: 498, ..fits }).is_none());
        assert!(lacks(SWEEP, StepParams { item_count: 65, ..step }, &fits).is_some());
    }
}
