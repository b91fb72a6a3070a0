// SPDX-License-Identifier: MIT OR Apache-2.0
//! An OpenCL device as a back end: programs built on first use, and one buffer per binding.

use std::collections::HashMap;
use std::sync::Arc;

use crate::device::backend::{Backend, BackendInfo, BufferSizes, FrameBuffer, MemoryLimits};
use crate::device::kernels::{self, Mutation};
use crate::device::launch_check::check_launch;
use crate::device::opencl::{AnyBuffer, Arg, Buffer, Door, Kernel as DeviceKernel, Launch, Limits, ProgramSource};
use crate::device::profiles::Choices;
use crate::device::stage::{Binding, Items, Kernel, LAUNCHES, Program, Stage};
use crate::error::Result;
use crate::layout::{self, BuildFlavour, FrameParams, StepParams, Traversal};
use crate::monitor::Monitor;
use crate::prepare::scene_buffers::{SceneBuffers, Shading};

/// Work-items of a scan's work-group, where the device allows as many.
const SCAN_GROUP: usize = 256;
/// Work-items of a one-dimensional launch's work-group.
const LIST_GROUP: usize = 64;

/// Runs kernels on an OpenCL device.
pub struct OpenClBackend {
    door: Door,
    host_scene: Arc<SceneBuffers>,
    /// `None`: the device is lost.
    scene: Option<SceneOnDevice>,
    buffers: Option<(BufferSizes, FrameOnDevice)>,
    kernels: HashMap<(Kernel, BuildFlavour), DeviceKernel>,
    flavour: BuildFlavour,
    mutation: Option<Mutation>,
    scan_group: u32,
    program_ms: f64,
    frame: FrameParams,
    /// On doors before this one.
    peak_before: u64,
    monitor: Monitor,
}

struct SceneOnDevice {
    frame: Buffer<FrameParams>,
    lights: Buffer<layout::Light>,
    nodes: Buffer<crate::prepare::kdtree::KdNode>,
    leaf_triangles: Buffer<u32>,
    triangles: Buffer<layout::Triangle>,
    triangle_shading: Buffer<layout::TriangleShading>,
    materials: Buffer<layout::Material>,
    object_materials: Buffer<u32>,
    textures: Buffer<layout::Texture>,
    texels: Buffer<u32>,
    tables: Buffer<u32>,
}

impl SceneOnDevice {
    fn upload(door: &Door, scene: &SceneBuffers) -> Result<Self> {
        Ok(SceneOnDevice {
            frame: door.buffer("frame", 1)?,
            lights: door.buffer_from("lights", &scene.lights)?,
            nodes: door.buffer_from("nodes", &scene.tree.nodes)?,
            leaf_triangles: door.buffer_from("leaf_triangles", &scene.tree.leaf_triangles)?,
            triangles: door.buffer_from("triangles", &scene.triangles)?,
            triangle_shading: door.buffer_from("triangle_shading", &scene.triangle_shading)?,
            materials: door.buffer_from("materials", &scene.materials)?,
            object_materials: door.buffer_from("object_materials", &scene.object_materials)?,
            textures: door.buffer_from("textures", &scene.textures)?,
            texels: door.buffer_from("texels", &scene.texels)?,
            tables: door.buffer_from("tables", &scene.tables)?,
        })
    }
}

struct FrameOnDevice {
    attributes: Buffer<u32>,
    counters: Buffer<u32>,
    color: Buffer<u32>,
    list: Buffer<u32>,
    masks: Buffer<u32>,
    sums: Buffer<u32>,
}

impl FrameOnDevice {
    fn get(&self, buffer: FrameBuffer) -> &Buffer<u32> {
        match buffer {
            FrameBuffer::Attributes => &self.attributes,
            FrameBuffer::Counters => &self.counters,
            FrameBuffer::Color => &self.color,
            FrameBuffer::List => &self.list,
            FrameBuffer::Masks => &self.masks,
            FrameBuffer::Sums => &self.sums,
        }
    }
}

impl OpenClBackend {
    /// Uploads `scene` to the device behind `door`. `strict` kernels equal the CPU twin bit for bit.
    ///
    /// # Errors
    /// A limit of the device or its profile, or a failing call.
    pub fn new(door: Door, scene: &Arc<SceneBuffers>, strict: bool) -> Result<Self> {
        OpenClBackend::watched(door, scene, strict, &Monitor::default())
    }

    /// As [`OpenClBackend::new`]; `monitor` watches until [`Backend::watch`] is called.
    ///
    /// # Errors
    /// As for [`OpenClBackend::new`]; [`crate::Error::Cancelled`].
    pub fn watched(door: Door, scene: &Arc<SceneBuffers>, strict: bool, monitor: &Monitor) -> Result<Self> {
        door.watch(monitor);
        let on_device = SceneOnDevice::upload(&door, scene)?;
        let scan_group = scan_group(door.limits());
        let (anchor, traversal) = (scene.shading == Shading::Anchor, door.choices().traversal());
        let mut backend = OpenClBackend {
            door,
            host_scene: Arc::clone(scene),
            scene: Some(on_device),
            buffers: None,
            kernels: HashMap::new(),
            flavour: BuildFlavour { strict, count: false, anchor, traversal },
            mutation: None,
            scan_group,
            program_ms: 0.0,
            frame: bytemuck::Zeroable::zeroed(),
            peak_before: 0,
            monitor: monitor.clone(),
        };
        backend.fit_scans();
        Ok(backend)
    }

    /// Lowers the work-group of scans to what the driver allows their kernel, which it says once that is built.
    fn fit_scans(&mut self) {
        let scan = Kernel::PackScan;
        // What forbids the program is told when a frame wants it.
        if self.build(scan).is_ok()
            && let Some(kernel) = self.kernels.get(&(scan, self.flavour))
        {
            let [fitted, _] = self.door.fit_work_group(kernel, [self.scan_group as usize, 1], true);
            self.scan_group = fitted.max(2) as u32;
        }
    }

    /// Breaks the kernels on purpose: for tests, and for the self-test's negative control.
    pub fn mutate(&mut self, mutation: Option<Mutation>) {
        self.mutation = mutation;
        self.kernels.clear();
    }

    /// Does `work` with `scene` in place of the own one, with the same programs; afterwards the own scene, an empty frame
    /// and fresh measurements are back. `scene` must be shaded by the own scene's rules.
    pub(crate) fn with_scene<T>(
        &mut self,
        scene: &Arc<SceneBuffers>,
        work: impl FnOnce(&mut Self) -> Result<T>,
    ) -> Result<T> {
        let uploaded = SceneOnDevice::upload(&self.door, scene)?;
        let own = self.scene.replace(uploaded);
        let done = work(self);
        self.scene = own;
        self.buffers = None;
        let fresh = self.door.start_afresh();
        let done = done?;
        fresh.map(|()| done)
    }

    /// Whether the device was lost, so that it must be opened again before a frame.
    pub fn is_lost(&self) -> bool {
        self.scene.is_none()
    }

    /// Gives up everything on a device that was lost.
    pub fn give_up(&mut self) {
        self.buffers = None;
        self.kernels.clear();
        self.scene = None;
    }

    /// Opens the device again after it was lost: a new context with scene and programs, and slices of half the time.
    ///
    /// # Errors
    /// A device that cannot be opened any more, or a failing upload; the device is lost still.
    pub fn reopen(&mut self) -> Result<()> {
        self.give_up();
        self.peak_before = self.peak_bytes();
        self.door = self.door.reopen()?;
        self.door.watch(&self.monitor);
        self.scene = Some(SceneOnDevice::upload(&self.door, &self.host_scene)?);
        Ok(())
    }

    /// The options and texts that the device's compiler gets, in one: what a verdict about the kernels depends on.
    pub(crate) fn program_texts(&self) -> String {
        let programs = Program::ALL.map(|program| kernels::program_source(program, self.mutation.as_ref()));
        let probe = kernels::assemble("probe.cl", self.mutation.as_ref());
        format!("{} {:?} {probe} {}", layout::build_options(self.flavour), self.flavour, programs.concat())
    }

    /// The rules that its scene is shaded by.
    pub(crate) fn shading(&self) -> Shading {
        if self.flavour.anchor { Shading::Anchor } else { Shading::Full }
    }

    /// Milliseconds spent building programs so far.
    pub fn program_ms(&self) -> f64 {
        self.program_ms
    }

    /// Sizes and offsets of the shared structs as this device's compiler lays them out, in the order of
    /// [`layout::struct_layout`].
    ///
    /// # Errors
    /// A program that does not build, or a failing call.
    pub fn probe(&mut self) -> Result<Vec<u32>> {
        let len = layout::struct_layout().len();
        let out: Buffer<u32> = self.door.buffer("probe", len)?;
        let source = kernels::assemble("probe.cl", self.mutation.as_ref());
        let options = layout::build_options(self.flavour);
        let program = self.door.program(&ProgramSource { name: "probe", source: &source, options: &options })?;
        let kernel = program.kernel("probe")?;
        let args = [Arg::Buffer(&out)];
        self.door.launch(&Launch {
            label: "probe",
            kernel: &kernel,
            args: &args,
            global: [1, 1],
            local: Some([1, 1]),
            barrier: false,
        })?;
        self.door.read(&out, 0..len)
    }

    /// The device.
    pub fn door(&self) -> &Door {
        &self.door
    }

    fn build(&mut self, kernel: Kernel) -> Result<()> {
        if self.kernels.contains_key(&(kernel, self.flavour)) {
            return Ok(());
        }
        self.monitor.check()?;
        let started = std::time::Instant::now();
        let program = kernel.program();
        let mut options = layout::build_options(self.flavour);
        if self.flavour.strict && self.door.limits().correctly_rounded_divide_sqrt {
            options.push_str(" -cl-fp32-correctly-rounded-divide-sqrt");
        }
        let source = kernels::program_source(program, self.mutation.as_ref());
        let built = self.door.program(&ProgramSource { name: program.name(), source: &source, options: &options })?;
        for entry in program.kernels() {
            self.kernels.insert((entry, self.flavour), built.kernel(entry.name())?);
        }
        self.program_ms += started.elapsed().as_secs_f64() * 1e3;
        Ok(())
    }
}

/// Work-items of a scan's work-group within `limits`: a power of two up to 256.
pub fn scan_group(limits: &Limits) -> u32 {
    let widest = limits.fit_work_group([SCAN_GROUP, 1], SCAN_GROUP as u64, true)[0];
    // The scratch memory of a scan: two words per work-item.
    let local_words = usize::try_from(limits.local_mem_bytes / 8).unwrap_or(usize::MAX).max(1);
    // Groups of one would never add anything up; a device that has no larger ones refuses the launch.
    previous_power_of_two(widest.min(local_words)).max(2) as u32
}

/// The work-group that `kernel` is launched with by `stage` before it is fitted to the kernel's own limit; `None`: the scan's.
pub fn work_group(choices: &Choices, stage: Stage, kernel: Kernel) -> Option<[usize; 2]> {
    match kernel.items(stage) {
        Items::Grid => Some(choices.work_group(stage.name())),
        Items::List | Items::Chunks | Items::OneGroup => Some([LIST_GROUP, 1]),
        Items::Groups => None,
    }
}

fn previous_power_of_two(n: usize) -> usize {
    1 << (usize::BITS - 1 - n.max(1).leading_zeros())
}

impl Backend for OpenClBackend {
    fn info(&self) -> BackendInfo {
        let info = self.door.info();
        BackendInfo {
            name: info.name.clone(),
            version: format!("{}, driver {}", info.version, info.driver),
            backend: "opencl",
            profile: self.door.profile_name().unwrap_or("none").into(),
        }
    }

    fn scan_group(&self) -> u32 {
        self.scan_group
    }

    fn prefers_few_launches(&self) -> bool {
        // Each of its kernels is compiled before it first runs, and a launch costs microseconds.
        !self.door.is_cpu()
    }

    fn traversal(&self) -> Traversal {
        self.flavour.traversal
    }

    fn memory_limits(&self) -> MemoryLimits {
        let limits = self.door.limits();
        MemoryLimits { total_bytes: limits.global_mem_bytes, allocation_bytes: limits.max_mem_alloc_bytes }
    }

    fn begin(&mut self, frame: &FrameParams, sizes: &BufferSizes) -> Result<()> {
        if !self.buffers.as_ref().is_some_and(|(existing, _)| existing.hold(sizes)) {
            // Old buffers go first: both together may not fit.
            self.buffers = None;
            let door = &self.door;
            let on_device = FrameOnDevice {
                attributes: door.buffer("attributes", sizes.attributes)?,
                counters: door.buffer("counters", sizes.counters)?,
                color: door.buffer("color", sizes.color)?,
                list: door.buffer("list", sizes.list)?,
                masks: door.buffer("masks", sizes.masks)?,
                sums: door.buffer("sums", sizes.sums)?,
            };
            self.buffers = Some((*sizes, on_device));
        }
        self.flavour.count = sizes.counters > 0;
        self.frame = *frame;
        match &self.scene {
            Some(scene) => self.door.write(&scene.frame, 0, std::slice::from_ref(frame)),
            None => Ok(()),
        }
    }

    fn run(&mut self, stage: Stage, kernel: Kernel, step: &StepParams) -> Result<()> {
        self.build(kernel)?;
        let (Some(scene), Some((sizes, buffers))) = (&self.scene, &self.buffers) else { return Ok(()) };
        check_launch(stage, kernel, step, &self.frame, sizes)?;
        let device_kernel = &self.kernels[&(kernel, self.flavour)];
        let mut args: Vec<Arg> = Vec::with_capacity(20);
        for binding in kernel.bindings() {
            match binding {
                Binding::Frame => args.push(Arg::Buffer(&scene.frame)),
                Binding::Scene => {
                    let all: [&dyn AnyBuffer; 11] = [
                        &scene.frame,
                        &scene.lights,
                        &scene.nodes,
                        &scene.leaf_triangles,
                        &scene.triangles,
                        &scene.triangle_shading,
                        &scene.materials,
                        &scene.object_materials,
                        &scene.textures,
                        &scene.texels,
                        &scene.tables,
                    ];
                    args.extend(all.map(Arg::Buffer));
                }
                Binding::Step => args.push(Arg::value(step)),
                Binding::Attributes => args.push(Arg::Buffer(&buffers.attributes)),
                Binding::Color => args.push(Arg::Buffer(&buffers.color)),
                Binding::Counters => args.push(Arg::Buffer(&buffers.counters)),
                Binding::List => args.push(Arg::Buffer(&buffers.list)),
                Binding::Masks => args.push(Arg::Buffer(&buffers.masks)),
                Binding::Sums => args.push(Arg::Buffer(&buffers.sums)),
                Binding::Scratch => args.push(Arg::Local(8 * step.scan_group as usize)),
            }
        }
        let items = kernel.items(stage);
        let barrier = matches!(items, Items::Groups | Items::OneGroup);
        let global = match items {
            Items::Grid => [step.grid_width as usize, step.grid_height as usize],
            Items::List | Items::Groups => [step.item_count as usize, 1],
            Items::Chunks => [step.item_count.div_ceil(32) as usize, 1],
            Items::OneGroup => [1, 1],
        };
        let fit = |wanted| self.door.fit_work_group(device_kernel, wanted, barrier);
        let local = match work_group(self.door.choices(), stage, kernel) {
            // Its scratch memory is that of a scan.
            Some([width, _]) if items == Items::OneGroup => fit([width.min(step.scan_group as usize), 1]),
            Some(wanted) => fit(wanted),
            // The scan's levels depend on the group: it is not fitted but checked.
            None => [step.scan_group as usize, 1],
        };
        let global = if items == Items::OneGroup { local } else { global };
        if global.contains(&0) {
            return Ok(());
        }
        self.door.launch(&Launch {
            label: kernel.label(stage),
            kernel: device_kernel,
            args: &args,
            global,
            local: Some(local),
            barrier,
        })
    }

    fn read_sum(&mut self, at: u32) -> Result<u32> {
        let at = at as usize;
        Ok(self.read(FrameBuffer::Sums, at..at + 1)?.first().copied().unwrap_or(0))
    }

    fn read(&mut self, buffer: FrameBuffer, range: std::ops::Range<usize>) -> Result<Vec<u32>> {
        match &self.buffers {
            Some((_, buffers)) => self.door.read(buffers.get(buffer), range),
            None => Ok(Vec::new()),
        }
    }

    fn write(&mut self, buffer: FrameBuffer, words: &[u32]) -> Result<()> {
        match &self.buffers {
            Some((_, buffers)) => self.door.write(buffers.get(buffer), 0, words),
            None => Ok(()),
        }
    }

    fn take_timings(&mut self) -> Result<Vec<(Stage, f64)>> {
        let timings = self.door.take_timings()?;
        let stage = |label: &str| LAUNCHES.iter().find(|(.., of)| *of == label).map(|(stage, ..)| *stage);
        Ok(timings.into_iter().filter_map(|(label, ms)| Some((stage(label)?, ms))).collect())
    }

    fn watch(&mut self, monitor: &Monitor) {
        self.door.watch(monitor);
        self.monitor = monitor.clone();
    }

    fn monitor(&self) -> &Monitor {
        &self.monitor
    }

    fn peak_bytes(&self) -> u64 {
        self.door.memory().peak_bytes.max(self.peak_before)
    }
}
