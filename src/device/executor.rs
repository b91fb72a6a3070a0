// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where kernels run: on an OpenCL device or as their CPU twins, behind one interface.
//!
//! An executor holds no scene and no frame of its own. [`Executor::upload`] and [`Executor::allocate`] return handles,
//! and every launch, read and write names the handle that it works on, so that nothing can be asked of a scene or a
//! frame that is not there, and several of each can be alive.

use std::ops::Range;
use std::sync::Arc;

use super::frame_memory::{FrameBuffer, FrameHandle, FrameInputs, FrameSizes};
use super::launch::{Launch, SceneHandle};
use super::stage::Stage;
use crate::error::Result;
use crate::layout::Traversal;
use crate::monitor::Monitor;
use crate::prepare::PreparedScene;

/// What the statistics say about the device of a frame.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct ExecutorInfo {
    /// Device name.
    pub name: String,
    /// Device and driver version.
    pub version: String,
    /// `opencl` or `cpu`.
    pub backend: &'static str,
    /// Name of the device profile, or `none`.
    pub profile: String,
}

impl ExecutorInfo {
    /// Name and version in one phrase, for messages.
    pub fn describe(&self) -> String {
        format!("{}, {}", self.name, self.version)
    }
}

/// How much memory an executor has for scenes and frames, in bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MemoryLimits {
    /// All buffers together.
    pub total_bytes: u64,
    /// The largest single buffer.
    pub allocation_bytes: u64,
}

/// A place where kernels run. Launches happen in order; reads wait for them.
pub trait Executor: Send {
    /// What this is.
    fn info(&self) -> ExecutorInfo;

    /// Work-items of a scan's work-group: a power of two.
    fn scan_group(&self) -> u32;

    /// What its memory holds, the profile's limits included.
    fn memory_limits(&self) -> MemoryLimits;

    /// How its rays walk through the kd-tree: what the counted steps depend on.
    fn traversal(&self) -> Traversal;

    /// Whether rounds of post-correction from few sources are best done by `correct_tail`, many in one launch: where a
    /// launch and a count read back cost more than such a round. The picture is the same.
    fn prefers_few_launches(&self) -> bool;

    /// Brings a scene into the executor's memory.
    ///
    /// # Errors
    /// A limit of the device or its profile, or a failing call. [`crate::Error::Cancelled`].
    fn upload(&mut self, scene: &Arc<PreparedScene>) -> Result<SceneHandle>;

    /// Makes buffers of these sizes for a frame, or for any window of it that they hold, which begins with `inputs`.
    ///
    /// # Errors
    /// As for [`Executor::upload`].
    fn allocate(&mut self, inputs: &FrameInputs, sizes: &FrameSizes) -> Result<FrameHandle>;

    /// Begins another window, or another frame, in the buffers of `frame`, which must hold it.
    ///
    /// # Errors
    /// A failing call.
    fn begin(&mut self, frame: &mut FrameHandle, inputs: &FrameInputs) -> Result<()>;

    /// Runs a launch.
    ///
    /// # Errors
    /// [`crate::Error::LaunchBeyondBuffer`] if it does not fit its buffers, which no device sees then. A limit of the
    /// device or its profile, a program that does not build, or a failing call. [`crate::Error::Cancelled`].
    fn run(&mut self, launch: &Launch) -> Result<()>;

    /// Reads words of a frame's buffer.
    ///
    /// # Errors
    /// [`crate::Error::LaunchBeyondBuffer`] for a range beyond the buffer; a failing call. [`crate::Error::Cancelled`].
    fn read(&mut self, frame: &FrameHandle, buffer: FrameBuffer, range: Range<usize>) -> Result<Vec<u32>>;

    /// Overwrites the start of a frame's buffer.
    ///
    /// # Errors
    /// As for [`Executor::read`].
    fn write(&mut self, frame: &FrameHandle, buffer: FrameBuffer, words: &[u32]) -> Result<()>;

    /// Milliseconds that launches took since the last call, by stage, in the order of first use.
    ///
    /// # Errors
    /// A failing call.
    fn take_timings(&mut self) -> Result<Vec<(Stage, f64)>>;

    /// From here on `monitor` watches: launches tell it how far they are, launches and transfers end with
    /// [`crate::Error::Cancelled`] once it says so. The default monitor watches nothing.
    fn watch(&mut self, monitor: &Monitor);

    /// Who watches: long loops on the host between launches ask it, too.
    fn monitor(&self) -> &Monitor;

    /// Most bytes of device memory in use so far.
    fn peak_bytes(&self) -> u64;

    /// Milliseconds spent building programs so far.
    fn program_ms(&self) -> f64 {
        0.0
    }

    /// Whether the device was lost, so that it must be opened again before anything else.
    fn is_lost(&self) -> bool {
        false
    }

    /// Opens the device again after it was lost, with slices of half the time, and returns what changed in a phrase for
    /// the user. Handles made before are useless from here on.
    ///
    /// # Errors
    /// A device that cannot be opened any more; it is lost still.
    fn reopen(&mut self) -> Result<String> {
        Ok(String::new())
    }
}
