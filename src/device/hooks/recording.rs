// SPDX-License-Identifier: MIT OR Apache-2.0
//! A hook that remembers the launches of a frame.

use crate::device::executor::Executor;
use crate::device::frame_memory::FrameBuffer;
use crate::device::launch::Launch;
use crate::device::queue::Hook;
use crate::device::stage::{Kernel, Stage};
use crate::error::Result;
use crate::layout::{StepParams, TAIL_SUM_ENDS, TAIL_SUM_ROUNDS};

/// A launch that was recorded.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedLaunch {
    /// The stage.
    pub stage: Stage,
    /// The kernel.
    pub kernel: Kernel,
    /// Its parameters.
    pub step: StepParams,
    /// `correct_tail`: where the list ended after each of its rounds.
    pub round_ends: Vec<u32>,
}

/// Records launches, in order.
#[derive(Debug, Default)]
pub struct Recording {
    /// The launches so far.
    pub launches: Vec<RecordedLaunch>,
}

impl Hook for Recording {
    /// Launches on a GPU are what recordings are for, whatever records them.
    fn wants_few_launches(&self) -> bool {
        true
    }

    fn after(&mut self, executor: &mut dyn Executor, launch: &Launch) -> Result<()> {
        let mut round_ends = Vec::new();
        if launch.kernel == Kernel::CorrectTail {
            let (at, ends) = (TAIL_SUM_ROUNDS as usize, TAIL_SUM_ENDS as usize);
            let rounds = executor.read(launch.frame, FrameBuffer::Sums, at..at + 1)?[0] as usize;
            round_ends = executor.read(launch.frame, FrameBuffer::Sums, ends..ends + rounds)?;
        }
        let Launch { stage, kernel, step, .. } = *launch;
        self.launches.push(RecordedLaunch { stage, kernel, step: *step, round_ends });
        Ok(())
    }
}
