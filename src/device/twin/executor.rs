// SPDX-License-Identifier: MIT OR Apache-2.0
//! The CPU twin as a back end.

use std::sync::Arc;
use std::time::Instant;

use crate::device::backend::{Backend, BackendInfo, BufferSizes, FrameBuffer, MemoryLimits};
use crate::device::launch_check::check_launch;
use crate::device::stage::{Kernel, Stage};
use crate::device::twin::{self, FrameBuffers, SceneArgs, Words};
use crate::error::Result;
use crate::layout::{FrameParams, StepParams, Traversal};
use crate::monitor::Monitor;
use crate::prepare::scene_buffers::{SceneBuffers, Shading};

/// Runs every kernel's twin on the cores of this machine.
pub struct TwinBackend {
    scene: Arc<SceneBuffers>,
    frame: Option<FrameParams>,
    sizes: Option<BufferSizes>,
    buffers: FrameBuffers,
    traversal: Traversal,
    timings: Vec<(Stage, f64)>,
    peak_bytes: u64,
    monitor: Monitor,
}

impl TwinBackend {
    /// A back end for `scene`.
    pub fn new(scene: Arc<SceneBuffers>) -> Self {
        let peak_bytes = scene.bytes();
        TwinBackend {
            scene,
            frame: None,
            sizes: None,
            buffers: FrameBuffers::default(),
            traversal: Traversal::default(),
            timings: Vec::new(),
            peak_bytes,
            monitor: Monitor::default(),
        }
    }

    /// Lets rays walk as a device does that was built for `traversal`, so that steps can be compared.
    pub fn walk_by(&mut self, traversal: Traversal) {
        self.traversal = traversal;
    }

    fn buffer(&self, buffer: FrameBuffer) -> &Words {
        match buffer {
            FrameBuffer::Attributes => &self.buffers.attributes,
            FrameBuffer::Counters => &self.buffers.counters,
            FrameBuffer::Color => &self.buffers.color,
            FrameBuffer::List => &self.buffers.list,
            FrameBuffer::Masks => &self.buffers.masks,
            FrameBuffer::Sums => &self.buffers.sums,
        }
    }
}

/// The scene's arrays as arguments of twin functions, with a private stack for each ray.
pub fn scene_args<'a>(scene: &'a SceneBuffers, frame: &'a FrameParams) -> SceneArgs<'a> {
    SceneArgs {
        frame,
        lights: &scene.lights,
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

impl Backend for TwinBackend {
    fn info(&self) -> BackendInfo {
        BackendInfo {
            name: format!("CPU twin, {} threads", rayon::current_num_threads()),
            version: env!("CARGO_PKG_VERSION").into(),
            backend: "cpu",
            profile: "none".into(),
        }
    }

    fn scan_group(&self) -> u32 {
        256
    }

    fn memory_limits(&self) -> MemoryLimits {
        MemoryLimits { total_bytes: u64::MAX, allocation_bytes: u64::MAX }
    }

    fn prefers_few_launches(&self) -> bool {
        true
    }

    fn traversal(&self) -> Traversal {
        self.traversal
    }

    fn begin(&mut self, frame: &FrameParams, sizes: &BufferSizes) -> Result<()> {
        if !self.sizes.is_some_and(|existing| existing.hold(sizes)) {
            // Old buffers go first: both together may not fit.
            (self.sizes, self.buffers) = (None, FrameBuffers::default());
            let zeroed = |words| Words::zeroed_unless_cancelled(words, &self.monitor);
            self.buffers = FrameBuffers {
                attributes: zeroed(sizes.attributes)?,
                counters: zeroed(sizes.counters)?,
                color: zeroed(sizes.color)?,
                list: zeroed(sizes.list)?,
                masks: zeroed(sizes.masks)?,
                sums: zeroed(sizes.sums)?,
            };
            self.sizes = Some(*sizes);
            self.peak_bytes = self.peak_bytes.max(self.scene.bytes() + sizes.bytes());
        }
        self.frame = Some(*frame);
        Ok(())
    }

    fn run(&mut self, stage: Stage, kernel: Kernel, step: &StepParams) -> Result<()> {
        let (Some(frame), Some(sizes)) = (&self.frame, &self.sizes) else { return Ok(()) };
        check_launch(stage, kernel, step, frame, sizes)?;
        let started = Instant::now();
        let scene = twin::SceneArgs { traversal: self.traversal, ..scene_args(&self.scene, frame) };
        twin::run(stage, kernel, &scene, step, &self.buffers, &self.monitor)?;
        self.timings.push((stage, started.elapsed().as_secs_f64() * 1e3));
        Ok(())
    }

    fn read_sum(&mut self, at: u32) -> Result<u32> {
        Ok(self.buffers.sums.get(at))
    }

    fn read(&mut self, buffer: FrameBuffer, range: std::ops::Range<usize>) -> Result<Vec<u32>> {
        Ok(self.buffer(buffer).to_vec(range))
    }

    fn write(&mut self, buffer: FrameBuffer, words: &[u32]) -> Result<()> {
        let target = self.buffer(buffer);
        for (at, &word) in words.iter().enumerate() {
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
        self.peak_bytes
    }
}
