// SPDX-License-Identifier: MIT OR Apache-2.0
//! The wide engine as an executor: the twin's memory, other launches.

use std::ops::Range;
use std::sync::Arc;

use super::dispatch::{self, Width};
use crate::device::executor::{Executor, ExecutorInfo, MemoryLimits};
use crate::device::frame_memory::{FrameBuffer, FrameHandle, FrameInputs, FrameSizes};
use crate::device::launch::{Launch, SceneHandle};
use crate::device::stage::Stage;
use crate::device::twin;
use crate::device::twin::executor::TwinExecutor;
use crate::error::Result;
use crate::layout::Traversal;
use crate::monitor::Monitor;
use crate::prepare::PreparedScene;

/// Runs launches in packets on the cores of this machine.
pub struct CpuExecutor {
    /// Holds scenes and frames, and runs what has no wide form.
    twin: TwinExecutor,
    /// `None` on processors without vector instructions that the engine knows: everything is the twin's there.
    width: Option<Width>,
}

impl Default for CpuExecutor {
    fn default() -> Self {
        CpuExecutor { twin: TwinExecutor::default(), width: Width::available().next() }
    }
}

impl CpuExecutor {
    /// An engine of this width; `None` if the processor does not have it.
    pub fn of_width(width: Width) -> Option<Self> {
        let width = Width::available().find(|&available| available == width)?;
        Some(CpuExecutor { twin: TwinExecutor::default(), width: Some(width) })
    }

    /// Whether this processor has vector instructions that the engine knows.
    pub fn has_lanes() -> bool {
        Width::available().next().is_some()
    }

    /// The same engine, which prefers few launches or does not.
    pub fn preferring_few_launches(self, few_launches: bool) -> Self {
        CpuExecutor { twin: self.twin.preferring_few_launches(few_launches), ..self }
    }
}

impl Executor for CpuExecutor {
    fn info(&self) -> ExecutorInfo {
        let threads = rayon::current_num_threads();
        let lanes = match self.width {
            Some(width) => format!("{} lanes by {}", width.lanes(), width.name()),
            None => "1 lane".into(),
        };
        ExecutorInfo { name: format!("CPU, {lanes}, {threads} threads"), ..self.twin.info() }
    }

    fn scan_group(&self) -> u32 {
        self.twin.scan_group()
    }

    fn memory_limits(&self) -> MemoryLimits {
        self.twin.memory_limits()
    }

    fn traversal(&self) -> Traversal {
        self.twin.traversal()
    }

    fn prefers_few_launches(&self) -> bool {
        self.twin.prefers_few_launches()
    }

    fn upload(&mut self, scene: &Arc<PreparedScene>) -> Result<SceneHandle> {
        self.twin.upload(scene)
    }

    fn allocate(&mut self, inputs: &FrameInputs, sizes: &FrameSizes) -> Result<FrameHandle> {
        self.twin.allocate(inputs, sizes)
    }

    fn begin(&mut self, frame: &mut FrameHandle, inputs: &FrameInputs) -> Result<()> {
        self.twin.begin(frame, inputs)
    }

    fn run(&mut self, launch: &Launch) -> Result<()> {
        let width = self.width;
        self.twin.run_by(launch, |stage, kernel, scene, step, buffers, monitor| match width {
            Some(width) => dispatch::run(width, (stage, kernel), scene, step, buffers, monitor),
            None => twin::run(stage, kernel, scene, step, buffers, monitor),
        })
    }

    fn read(&mut self, frame: &FrameHandle, buffer: FrameBuffer, range: Range<usize>) -> Result<Vec<u32>> {
        self.twin.read(frame, buffer, range)
    }

    fn write(&mut self, frame: &FrameHandle, buffer: FrameBuffer, words: &[u32]) -> Result<()> {
        self.twin.write(frame, buffer, words)
    }

    fn take_timings(&mut self) -> Result<Vec<(Stage, f64)>> {
        self.twin.take_timings()
    }

    fn watch(&mut self, monitor: &Monitor) {
        self.twin.watch(monitor);
    }

    fn monitor(&self) -> &Monitor {
        self.twin.monitor()
    }

    fn peak_bytes(&self) -> u64 {
        self.twin.peak_bytes()
    }
}
