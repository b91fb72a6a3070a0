// SPDX-License-Identifier: MIT OR Apache-2.0
//! The CPU twin as an executor.

use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::time::Instant;

use super::{FrameBuffers, SceneArgs, Words};
use crate::device::executor::{Executor, ExecutorInfo, MemoryLimits};
use crate::device::frame_memory::{FrameBuffer, FrameHandle, FrameInputs, FrameSizes};
use crate::device::launch::{Launch, SceneHandle};
use crate::device::launch_check::check_launch;
use crate::device::stage::{Kernel, Stage};
use crate::error::Result;
use crate::layout::{StepParams, Traversal};
use crate::monitor::Monitor;
use crate::prepare::{PreparedScene, Shading};

/// Work-items of a scan's work-group, unless the twin imitates a device.
const SCAN_GROUP: u32 = 256;

/// Bytes of scenes and frames that are alive.
#[derive(Debug, Default)]
struct Account {
    current_bytes: AtomicU64,
    peak_bytes: AtomicU64,
}

/// A share of an account, given back when dropped.
struct Reservation {
    account: Arc<Account>,
    bytes: u64,
}

impl Reservation {
    fn new(account: &Arc<Account>, bytes: u64) -> Self {
        let current = account.current_bytes.fetch_add(bytes, Relaxed) + bytes;
        account.peak_bytes.fetch_max(current, Relaxed);
        Reservation { account: Arc::clone(account), bytes }
    }
}

impl Drop for Reservation {
    fn drop(&mut self) {
        self.account.current_bytes.fetch_sub(self.bytes, Relaxed);
    }
}

/// A frame in the twin's memory.
struct TwinFrame {
    buffers: FrameBuffers,
    _reserved: Reservation,
}

/// Runs every kernel's twin on the cores of this machine.
pub struct TwinExecutor {
    traversal: Traversal,
    scan_group: u32,
    few_launches: bool,
    timings: Vec<(Stage, f64)>,
    account: Arc<Account>,
    monitor: Monitor,
}

impl Default for TwinExecutor {
    fn default() -> Self {
        TwinExecutor {
            traversal: Traversal::default(),
            scan_group: SCAN_GROUP,
            few_launches: true,
            timings: Vec::new(),
            account: Arc::default(),
            monitor: Monitor::default(),
        }
    }
}

impl TwinExecutor {
    /// A twin that walks through kd-trees and scans as `device` does, so that all their words can be compared.
    pub fn imitating(device: &dyn Executor) -> Self {
        TwinExecutor { traversal: device.traversal(), scan_group: device.scan_group(), ..TwinExecutor::default() }
    }

    /// The same twin, which prefers few launches or does not.
    pub fn preferring_few_launches(self, few_launches: bool) -> Self {
        TwinExecutor { few_launches, ..self }
    }

    /// A twin whose rays walk as a device does that was built for `traversal`.
    pub fn walking_by(traversal: Traversal) -> Self {
        TwinExecutor { traversal, ..TwinExecutor::default() }
    }

    /// Runs a launch in this memory by `run`, which gets what [`super::run`] gets.
    ///
    /// # Errors
    /// As for [`Executor::run`].
    pub(in super::super) fn run_by(
        &mut self,
        launch: &Launch,
        run: impl FnOnce(Stage, Kernel, &SceneArgs, &StepParams, &FrameBuffers, &Monitor) -> Result<()>,
    ) -> Result<()> {
        let Launch { stage, kernel, step, scene, frame } = *launch;
        check_launch(stage, kernel, step, frame.params(), frame.sizes())?;
        // A scene of another executor is refused here as there, though the twin could read it.
        scene.memory::<Reservation>()?;
        let buffers = &frame.memory::<TwinFrame>()?.buffers;
        let started = Instant::now();
        let args = SceneArgs { traversal: self.traversal, ..scene_args(scene.prepared(), frame.inputs()) };
        run(stage, kernel, &args, step, buffers, &self.monitor)?;
        self.timings.push((stage, started.elapsed().as_secs_f64() * 1e3));
        Ok(())
    }
}

/// What twin functions get of a scene and a frame, with a private stack for each ray.
pub fn scene_args<'a>(scene: &'a PreparedScene, inputs: &'a FrameInputs) -> SceneArgs<'a> {
    SceneArgs {
        frame: &inputs.params,
        lights: &inputs.lights,
        nodes: &scene.tree.nodes,
        leaf_triangles: &scene.tree.leaf_triangles,
        triangles: &scene.triangles,
        triangle_shading: &scene.triangle_shading,
        materials: &scene.materials,
        object_materials: &scene.object_materials,
        textures: &scene.textures,
        texels: &scene.texels,
        tables: &scene.tables,
        anchor: scene.shading == Shading::Anchor,
        traversal: Traversal::default(),
    }
}

fn words(buffers: &FrameBuffers, buffer: FrameBuffer) -> &Words {
    match buffer {
        FrameBuffer::Attributes => &buffers.attributes,
        FrameBuffer::Counters => &buffers.counters,
        FrameBuffer::Color => &buffers.color,
        FrameBuffer::List => &buffers.list,
        FrameBuffer::Masks => &buffers.masks,
        FrameBuffer::Sums => &buffers.sums,
    }
}

impl Executor for TwinExecutor {
    fn info(&self) -> ExecutorInfo {
        ExecutorInfo {
            name: format!("CPU twin, {} threads", rayon::current_num_threads()),
            version: env!("CARGO_PKG_VERSION").into(),
            backend: "cpu",
            profile: "none".into(),
        }
    }

    fn scan_group(&self) -> u32 {
        self.scan_group
    }

    fn memory_limits(&self) -> MemoryLimits {
        MemoryLimits { total_bytes: u64::MAX, allocation_bytes: u64::MAX }
    }

    fn traversal(&self) -> Traversal {
        self.traversal
    }

    fn prefers_few_launches(&self) -> bool {
        self.few_launches
    }

    fn upload(&mut self, scene: &Arc<PreparedScene>) -> Result<SceneHandle> {
        // The prepared scene is what the twin reads: nothing is copied.
        Ok(SceneHandle::new(scene, Reservation::new(&self.account, scene.bytes())))
    }

    fn allocate(&mut self, inputs: &FrameInputs, sizes: &FrameSizes) -> Result<FrameHandle> {
        let zeroed = |buffer| Words::zeroed_unless_cancelled(sizes.of(buffer), &self.monitor);
        let buffers = FrameBuffers {
            attributes: zeroed(FrameBuffer::Attributes)?,
            counters: zeroed(FrameBuffer::Counters)?,
            color: zeroed(FrameBuffer::Color)?,
            list: zeroed(FrameBuffer::List)?,
            masks: zeroed(FrameBuffer::Masks)?,
            sums: zeroed(FrameBuffer::Sums)?,
        };
        let frame = TwinFrame { buffers, _reserved: Reservation::new(&self.account, sizes.bytes()) };
        Ok(FrameHandle::new(inputs.clone(), *sizes, frame))
    }

    fn begin(&mut self, frame: &mut FrameHandle, inputs: &FrameInputs) -> Result<()> {
        frame.set_inputs(inputs);
        Ok(())
    }

    fn run(&mut self, launch: &Launch) -> Result<()> {
        self.run_by(launch, super::run)
    }

    fn read(&mut self, frame: &FrameHandle, buffer: FrameBuffer, range: Range<usize>) -> Result<Vec<u32>> {
        frame.sizes().check_range(buffer, &range)?;
        words(&frame.memory::<TwinFrame>()?.buffers, buffer).to_vec(range)
    }

    fn write(&mut self, frame: &FrameHandle, buffer: FrameBuffer, new: &[u32]) -> Result<()> {
        frame.sizes().check_range(buffer, &(0..new.len()))?;
        let target = words(&frame.memory::<TwinFrame>()?.buffers, buffer);
        for (at, &word) in new.iter().enumerate() {
            target.set(at as u32, word);
        }
        Ok(())
    }

    fn take_timings(&mut self) -> Result<Vec<(Stage, f64)>> {
        Ok(std::mem::take(&mut self.timings))
    }

    fn watch(&mut self, monitor: &Monitor) {
        self.monitor = monitor.clone();
    }

    fn monitor(&self) -> &Monitor {
        &self.monitor
    }

    fn peak_bytes(&self) -> u64 {
        self.account.peak_bytes.load(Relaxed)
    }
}
