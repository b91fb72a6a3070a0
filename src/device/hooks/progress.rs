// SPDX-License-Identifier: MIT OR Apache-2.0
//! A hook that tells a monitor how far a frame is, shows previews, and ends the frame when it is told to.

use crate::device::executor::Executor;
use crate::device::frame_memory::{FrameBuffer, FrameHandle};
use crate::device::launch::Launch;
use crate::device::queue::Hook;
use crate::device::stage::Stage;
use crate::error::Result;
use crate::layout::{FrameParams, StepFlags, base_shift, color_index};
use crate::monitor::{Monitor, Preview};

/// A share of an adaptive window's time at which each stage begins, in the order of [`Stage::ALL`]; for progress only.
const BEGINS: [f32; 9] = [0.0, 0.42, 0.48, 0.49, 0.58, 0.72, 0.73, 0.87, 1.0];

/// Watches one frame.
pub struct Progress {
    monitor: Monitor,
    /// Rows of samples whose preview was shown.
    shown_rows: u32,
}

impl Progress {
    /// Tells `monitor` of a frame that begins now.
    pub fn new(monitor: &Monitor) -> Self {
        monitor.restart();
        let monitor = monitor.part("frame", 0.0, 1.0);
        monitor.tell(0.0);
        Progress { monitor, shown_rows: 0 }
    }

    /// Tells that the frame is done.
    pub fn finished(&self) {
        self.monitor.tell(1.0);
    }

    /// The part of the frame that a launch of `stage` is.
    fn part(&self, stage: Stage, window: &FrameParams) -> Monitor {
        let (begin, end) =
            if window.block == 1 { (0.0, 1.0) } else { (BEGINS[stage as usize], BEGINS[stage as usize + 1]) };
        let rows = (window.interior_end - window.interior_begin) as f32;
        let place = |share: f32| (window.interior_begin as f32 + share * rows) / window.height as f32;
        self.monitor.part("frame", place(begin), place(end))
    }

    /// Shows the base pixels of the window's interior, unless they were shown before it was repaired.
    fn preview(&mut self, executor: &mut dyn Executor, launch: &Launch) -> Result<()> {
        let (frame, window) = (launch.frame, launch.frame.params());
        if window.block == 1 || !self.monitor.wants_previews() || window.interior_begin < self.shown_rows {
            return Ok(());
        }
        self.shown_rows = window.interior_end;
        let (rows, block) = (window.interior_begin..window.interior_end, window.block as usize);
        let first = color_index(window, 0, rows.start) as usize;
        let words = executor.read(frame, FrameBuffer::Color, first..color_index(window, 0, rows.end) as usize)?;
        let shifted = launch.step.flags.contains(StepFlags::SHIFTED);
        let columns = window.width.div_ceil(window.block) as usize;
        let base_rows = words.chunks(window.width.max(1) as usize).step_by(block).zip(rows.clone().step_by(block));
        let pixels: Vec<u32> = base_rows
            .flat_map(|(row, y)| {
                let shift = if shifted { base_shift(window.block, y) as usize } else { 0 };
                // A row that begins farther to the right may have one base pixel less, and in a narrow picture none.
                let base = row.iter().copied().skip(shift).step_by(block);
                let last = base.clone().next_back().unwrap_or_default();
                base.chain(std::iter::repeat(last)).take(columns)
            })
            .collect();
        self.monitor.show(Preview {
            width: window.width.div_ceil(window.block),
            height: window.height.div_ceil(window.block),
            first_row: rows.start / window.block,
            pixels: &pixels,
        });
        Ok(())
    }
}

impl Hook for Progress {
    fn begin(&mut self, _: &mut dyn Executor, _: &FrameHandle) -> Result<()> {
        self.monitor.check()
    }

    fn before(&mut self, executor: &mut dyn Executor, launch: &Launch) -> Result<()> {
        self.monitor.check()?;
        executor.watch(&self.part(launch.stage, launch.frame.params()));
        Ok(())
    }

    fn after(&mut self, executor: &mut dyn Executor, launch: &Launch) -> Result<()> {
        if launch.stage == Stage::Step1 { self.preview(executor, launch) } else { Ok(()) }
    }
}
