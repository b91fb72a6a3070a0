// SPDX-License-Identifier: MIT OR Apache-2.0
//! A back end whose frames are watched: it passes everything on, tells a monitor how far the frame is, shows previews,
//! and ends when it is told to.

use crate::device::backend::{Backend, BackendInfo, BufferSizes, FrameBuffer, MemoryLimits};
use crate::device::stage::{Kernel, Stage};
use crate::error::Result;
use crate::layout::{FrameParams, StepParams, Traversal, color_index};
use crate::monitor::{Monitor, Preview};

/// A share of an adaptive window's time at which each stage begins, in the order of [`Stage::ALL`]; for progress only.
const BEGINS: [f32; 9] = [0.0, 0.42, 0.48, 0.49, 0.58, 0.72, 0.73, 0.87, 1.0];

/// Watches one frame. Whoever watched before is forgotten.
pub struct WatchedBackend<'a> {
    inner: &'a mut dyn Backend,
    monitor: Monitor,
    window: Option<FrameParams>,
    /// Rows of samples whose preview was shown.
    shown_rows: u32,
}

impl<'a> WatchedBackend<'a> {
    /// Watches `inner` for `monitor` until it is dropped.
    pub fn new(inner: &'a mut dyn Backend, monitor: &Monitor) -> Self {
        monitor.restart();
        let monitor = monitor.part("frame", 0.0, 1.0);
        inner.watch(&monitor);
        monitor.tell(0.0);
        WatchedBackend { inner, monitor, window: None, shown_rows: 0 }
    }

    /// Tells that the frame is done.
    pub fn finished(&self) {
        self.monitor.tell(1.0);
    }

    /// The part of the frame that a launch of `stage` is.
    fn part(&self, stage: Stage) -> Monitor {
        let Some(window) = &self.window else { return self.monitor.clone() };
        let (begin, end) =
            if window.block == 1 { (0.0, 1.0) } else { (BEGINS[stage as usize], BEGINS[stage as usize + 1]) };
        let rows = (window.interior_end - window.interior_begin) as f32;
        let place = |share: f32| (window.interior_begin as f32 + share * rows) / window.height as f32;
        self.monitor.part("frame", place(begin), place(end))
    }

    /// Shows the base pixels of the window's interior, unless they were shown before it was repaired.
    fn preview(&mut self) -> Result<()> {
        let Some(window) = self.window.filter(|window| window.block > 1) else { return Ok(()) };
        if !self.monitor.wants_previews() || window.interior_begin < self.shown_rows {
            return Ok(());
        }
        self.shown_rows = window.interior_end;
        let (rows, block) = (window.interior_begin..window.interior_end, window.block as usize);
        let first = color_index(&window, 0, rows.start) as usize;
        let words = self.inner.read(FrameBuffer::Color, first..color_index(&window, 0, rows.end) as usize)?;
        let base_rows = words.chunks(window.width.max(1) as usize).step_by(block);
        let pixels: Vec<u32> = base_rows.flat_map(|row| row.iter().copied().step_by(block)).collect();
        self.monitor.show(Preview {
            width: window.width.div_ceil(window.block),
            height: window.height.div_ceil(window.block),
            first_row: rows.start / window.block,
            pixels: &pixels,
        });
        Ok(())
    }
}

impl Drop for WatchedBackend<'_> {
    fn drop(&mut self) {
        self.inner.watch(&Monitor::default());
    }
}

impl Backend for WatchedBackend<'_> {
    fn info(&self) -> BackendInfo {
        self.inner.info()
    }

    fn scan_group(&self) -> u32 {
        self.inner.scan_group()
    }

    fn memory_limits(&self) -> MemoryLimits {
        self.inner.memory_limits()
    }

    fn prefers_few_launches(&self) -> bool {
        self.inner.prefers_few_launches()
    }

    fn traversal(&self) -> Traversal {
        self.inner.traversal()
    }

    fn begin(&mut self, frame: &FrameParams, sizes: &BufferSizes) -> Result<()> {
        self.monitor.check()?;
        self.window = Some(*frame);
        self.inner.begin(frame, sizes)
    }

    fn run(&mut self, stage: Stage, kernel: Kernel, step: &StepParams) -> Result<()> {
        self.monitor.check()?;
        let part = self.part(stage);
        self.inner.watch(&part);
        self.inner.run(stage, kernel, step)?;
        if stage == Stage::Step1 {
            self.preview()?;
        }
        Ok(())
    }

    fn read_sum(&mut self, at: u32) -> Result<u32> {
        self.inner.read_sum(at)
    }

    fn read(&mut self, buffer: FrameBuffer, range: std::ops::Range<usize>) -> Result<Vec<u32>> {
        self.inner.read(buffer, range)
    }

    fn write(&mut self, buffer: FrameBuffer, words: &[u32]) -> Result<()> {
        self.inner.write(buffer, words)
    }

    fn take_timings(&mut self) -> Result<Vec<(Stage, f64)>> {
        self.inner.take_timings()
    }

    fn watch(&mut self, monitor: &Monitor) {
        self.monitor = monitor.clone();
        self.inner.watch(monitor);
    }

    fn monitor(&self) -> &Monitor {
        &self.monitor
    }

    fn peak_bytes(&self) -> u64 {
        self.inner.peak_bytes()
    }
}
