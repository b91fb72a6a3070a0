// SPDX-License-Identifier: MIT OR Apache-2.0
//! A back end that passes everything on and remembers the launches.

use crate::device::backend::{Backend, BackendInfo, BufferSizes, FrameBuffer, MemoryLimits};
use crate::device::stage::{Kernel, Stage};
use crate::error::Result;
use crate::layout::{FrameParams, StepParams, TAIL_SUM_ENDS, TAIL_SUM_ROUNDS, Traversal};
use crate::monitor::Monitor;

/// A launch that was recorded.
#[derive(Debug, Clone, PartialEq)]
pub struct Recorded {
    /// The stage.
    pub stage: Stage,
    /// The kernel.
    pub kernel: Kernel,
    /// Its parameters.
    pub step: StepParams,
    /// `correct_tail`: where the list ended after each of its rounds.
    pub round_ends: Vec<u32>,
}

/// Records the launches of a frame.
pub struct RecordingBackend<'a> {
    inner: &'a mut dyn Backend,
    /// The launches so far, in order.
    pub launches: Vec<Recorded>,
}

impl<'a> RecordingBackend<'a> {
    /// Passes calls on to `inner`.
    pub fn new(inner: &'a mut dyn Backend) -> Self {
        RecordingBackend { inner, launches: Vec::new() }
    }
}

impl Backend for RecordingBackend<'_> {
    fn info(&self) -> BackendInfo {
        self.inner.info()
    }

    fn scan_group(&self) -> u32 {
        self.inner.scan_group()
    }

    fn memory_limits(&self) -> MemoryLimits {
        self.inner.memory_limits()
    }

    /// As on a GPU, whose launches are what recordings are for, whatever records them.
    fn prefers_few_launches(&self) -> bool {
        true
    }

    fn traversal(&self) -> Traversal {
        self.inner.traversal()
    }

    fn begin(&mut self, frame: &FrameParams, sizes: &BufferSizes) -> Result<()> {
        self.inner.begin(frame, sizes)
    }

    fn run(&mut self, stage: Stage, kernel: Kernel, step: &StepParams) -> Result<()> {
        self.inner.run(stage, kernel, step)?;
        let mut round_ends = Vec::new();
        if kernel == Kernel::CorrectTail {
            let rounds = self.inner.read_sum(TAIL_SUM_ROUNDS)? as usize;
            let ends = TAIL_SUM_ENDS as usize;
            round_ends = self.inner.read(FrameBuffer::Sums, ends..ends + rounds)?;
        }
        self.launches.push(Recorded { stage, kernel, step: *step, round_ends });
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
        self.inner.watch(monitor);
    }

    fn monitor(&self) -> &Monitor {
        self.inner.monitor()
    }

    fn peak_bytes(&self) -> u64 {
        self.inner.peak_bytes()
    }
}
