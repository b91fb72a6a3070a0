// SPDX-License-Identifier: MIT OR Apache-2.0
//! A launch, which names everything that it uses.

use std::any::Any;
use std::sync::Arc;

use super::frame_memory::FrameHandle;
use super::stage::{Kernel, Stage};
use crate::error::{Error, Result};
use crate::layout::StepParams;
use crate::prepare::PreparedScene;

/// A prepared scene in an executor's memory. Clones are one upload, which is freed with the last of them.
#[derive(Clone)]
pub struct SceneHandle {
    prepared: Arc<PreparedScene>,
    memory: Arc<dyn Any + Send + Sync>,
}

impl SceneHandle {
    /// A handle on `memory`, whose type the executor knows.
    pub(super) fn new(prepared: &Arc<PreparedScene>, memory: impl Any + Send + Sync) -> Self {
        SceneHandle { prepared: Arc::clone(prepared), memory: Arc::new(memory) }
    }

    /// The scene that was uploaded.
    pub fn prepared(&self) -> &Arc<PreparedScene> {
        &self.prepared
    }

    /// The memory, for the executor that made it.
    pub(super) fn memory<M: Any>(&self) -> Result<&M> {
        self.memory.downcast_ref().ok_or(Error::ForeignHandle { what: "scene" })
    }
}

impl std::fmt::Debug for SceneHandle {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "scene {}, {} bytes", self.prepared.name(), self.prepared.bytes())
    }
}

/// One launch of a kernel.
#[derive(Debug, Clone, Copy)]
pub struct Launch<'a> {
    /// The stage that it is part of: the label of its time and its errors.
    pub stage: Stage,
    /// What runs.
    pub kernel: Kernel,
    /// What it works on.
    pub step: &'a StepParams,
    /// The scene that it reads.
    pub scene: &'a SceneHandle,
    /// The frame that it reads and writes.
    pub frame: &'a FrameHandle,
}
