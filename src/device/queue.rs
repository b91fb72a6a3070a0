// SPDX-License-Identifier: MIT OR Apache-2.0
//! The queue that launches go through, and the hooks that observe them.

use std::ops::Range;

use super::executor::Executor;
use super::frame_memory::{FrameBuffer, FrameHandle, FrameInputs};
use super::launch::{Launch, SceneHandle};
use super::stage::{Kernel, Stage};
use crate::error::Result;
use crate::layout::{FrameParams, StepParams};

/// An observer of launches. What it does not override, it does not care for.
pub trait Hook {
    /// Whether frames that it observes should have few launches, as on a GPU, whatever the executor prefers.
    fn wants_few_launches(&self) -> bool {
        false
    }

    /// A window of a frame begins; its launches follow.
    ///
    /// # Errors
    /// Whatever ends the frame.
    fn begin(&mut self, executor: &mut dyn Executor, frame: &FrameHandle) -> Result<()> {
        let _ = (executor, frame);
        Ok(())
    }

    /// A launch is about to run on `executor`.
    ///
    /// # Errors
    /// Whatever ends the frame.
    fn before(&mut self, executor: &mut dyn Executor, launch: &Launch) -> Result<()> {
        let _ = (executor, launch);
        Ok(())
    }

    /// A launch has run, or is queued to.
    ///
    /// # Errors
    /// Whatever ends the frame.
    fn after(&mut self, executor: &mut dyn Executor, launch: &Launch) -> Result<()> {
        let _ = (executor, launch);
        Ok(())
    }
}

/// What the method launches through: an executor with the scene and the frame that its launches name, and the hooks that
/// observe them, in order.
pub struct Queue<'a, 'h> {
    executor: &'a mut dyn Executor,
    scene: &'a SceneHandle,
    frame: &'a mut FrameHandle,
    hooks: &'a mut [&'h mut dyn Hook],
}

impl<'a, 'h> Queue<'a, 'h> {
    /// A queue of launches on `scene` and `frame`.
    pub fn new(
        executor: &'a mut dyn Executor,
        scene: &'a SceneHandle,
        frame: &'a mut FrameHandle,
        hooks: &'a mut [&'h mut dyn Hook],
    ) -> Self {
        Queue { executor, scene, frame, hooks }
    }

    /// Begins a window: its parameters are those of the launches that follow.
    ///
    /// # Errors
    /// A failing call; whatever a hook reports.
    pub fn begin(&mut self, inputs: &FrameInputs) -> Result<()> {
        self.check()?;
        self.executor.begin(self.frame, inputs)?;
        self.hooks.iter_mut().try_for_each(|hook| hook.begin(self.executor, self.frame))
    }

    /// Launches a kernel for a stage.
    ///
    /// # Errors
    /// As for [`Executor::run`]; whatever a hook reports.
    pub fn launch(&mut self, stage: Stage, kernel: Kernel, step: &StepParams) -> Result<()> {
        let launch = Launch { stage, kernel, step, scene: self.scene, frame: self.frame };
        self.hooks.iter_mut().try_for_each(|hook| hook.before(self.executor, &launch))?;
        self.executor.run(&launch)?;
        self.hooks.iter_mut().try_for_each(|hook| hook.after(self.executor, &launch))
    }

    /// Size, camera and window of the frame.
    pub fn params(&self) -> &FrameParams {
        self.frame.params()
    }

    /// The frame.
    pub fn frame(&self) -> &FrameHandle {
        self.frame
    }

    /// Work-items of a scan's work-group.
    pub fn scan_group(&self) -> u32 {
        self.executor.scan_group()
    }

    /// Whether rounds of post-correction from few sources are best done many in one launch.
    pub fn prefers_few_launches(&self) -> bool {
        self.executor.prefers_few_launches() || self.hooks.iter().any(|hook| hook.wants_few_launches())
    }

    /// Reads words of one of the frame's buffers.
    ///
    /// # Errors
    /// As for [`Executor::read`].
    pub fn read(&mut self, buffer: FrameBuffer, range: Range<usize>) -> Result<Vec<u32>> {
        self.executor.read(self.frame, buffer, range)
    }

    /// Reads one word of the sums: the count of a packing.
    ///
    /// # Errors
    /// As for [`Executor::read`].
    pub fn read_sum(&mut self, at: u32) -> Result<u32> {
        let at = at as usize;
        // A read is as long as its range.
        Ok(self.read(FrameBuffer::Sums, at..at + 1)?[0])
    }

    /// Overwrites the start of one of the frame's buffers.
    ///
    /// # Errors
    /// As for [`Executor::write`].
    pub fn write(&mut self, buffer: FrameBuffer, words: &[u32]) -> Result<()> {
        self.executor.write(self.frame, buffer, words)
    }

    /// Milliseconds that launches took since the last call, by stage.
    ///
    /// # Errors
    /// A failing call.
    pub fn take_timings(&mut self) -> Result<Vec<(Stage, f64)>> {
        self.executor.take_timings()
    }

    /// Goes on unless the work is to end: for loops on the host between launches.
    ///
    /// # Errors
    /// [`Error::Cancelled`].
    pub fn check(&self) -> Result<()> {
        self.executor.monitor().check()
    }
}
