// SPDX-License-Identifier: MIT OR Apache-2.0
//! An OpenCL device as an executor: programs built on first use, one buffer per binding.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

use super::bounds_table::BoundsTable;
use crate::device::bounds;
use crate::device::executor::{Executor, ExecutorInfo, MemoryLimits};
use crate::device::frame_memory::{FrameBuffer, FrameHandle, FrameInputs, FrameSizes};
use crate::device::kernels::{self, Mutation};
use crate::device::launch::{Launch, SceneHandle};
use crate::device::launch_check::check_launch;
use crate::device::opencl::{
    AnyBuffer, Arg, Buffer, Context, DeviceLaunch, Kernel as DeviceKernel, Limits, ProgramSource,
};
use crate::device::profiles::Choices;
use crate::device::stage::{Binding, Items, Kernel, LAUNCHES, Program, Stage};
use crate::error::{Error, Result};
use crate::layout::{self, BuildFlavour, FrameParams, Traversal};
use crate::monitor::Monitor;
use crate::prepare::{PreparedScene, Shading};
use crate::scene::MAX_LIGHTS;

/// Work-items of a scan's work-group, where the device allows as many.
const SCAN_GROUP: usize = 256;
/// Work-items of a one-dimensional launch's work-group.
const LIST_GROUP: usize = 64;
/// Most work-items of any work-group where kernels are built with care.
const CAREFUL_GROUP: usize = 32;

/// Runs kernels on an OpenCL device.
pub struct OpenClExecutor {
    context: Context,
    is_lost: bool,
    kernels: HashMap<(Kernel, BuildFlavour), DeviceKernel>,
    strict: bool,
    traversal: Traversal,
    mutation: Option<Mutation>,
    scan_group: u32,
    program_ms: f64,
    /// On contexts before this one.
    peak_before: u64,
    monitor: Monitor,
    /// With bounds checks in kernels.
    bounds: Option<BoundsTable>,
}

/// A scene in the device's memory.
struct SceneOnDevice {
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
    fn upload(context: &Context, scene: &PreparedScene) -> Result<Self> {
        Ok(SceneOnDevice {
            nodes: context.buffer_from("nodes", &scene.tree.nodes)?,
            leaf_triangles: context.buffer_from("leaf_triangles", &scene.tree.leaf_triangles)?,
            triangles: context.buffer_from("triangles", &scene.triangles)?,
            triangle_shading: context.buffer_from("triangle_shading", &scene.triangle_shading)?,
            materials: context.buffer_from("materials", &scene.materials)?,
            object_materials: context.buffer_from("object_materials", &scene.object_materials)?,
            textures: context.buffer_from("textures", &scene.textures)?,
            texels: context.buffer_from("texels", &scene.texels)?,
            tables: context.buffer_from("tables", &scene.tables)?,
        })
    }
}

/// A frame in the device's memory.
struct FrameOnDevice {
    params: Buffer<FrameParams>,
    lights: Buffer<layout::Light>,
    attributes: Buffer<u32>,
    counters: Buffer<u32>,
    color: Buffer<u32>,
    list: Buffer<u32>,
    masks: Buffer<u32>,
    sums: Buffer<u32>,
}

impl FrameOnDevice {
    fn allocate(context: &Context, sizes: &FrameSizes) -> Result<Self> {
        Ok(FrameOnDevice {
            params: context.buffer("frame", 1)?,
            lights: context.buffer("lights", MAX_LIGHTS)?,
            attributes: context.buffer("attributes", sizes.attributes)?,
            counters: context.buffer("counters", sizes.counters)?,
            color: context.buffer("color", sizes.color)?,
            list: context.buffer("list", sizes.list)?,
            masks: context.buffer("masks", sizes.masks)?,
            sums: context.buffer("sums", sizes.sums)?,
        })
    }

    fn write_inputs(&self, context: &Context, inputs: &FrameInputs) -> Result<()> {
        context.write(&self.params, 0, std::slice::from_ref(&inputs.params))?;
        if inputs.lights.is_empty() { Ok(()) } else { context.write(&self.lights, 0, &inputs.lights) }
    }

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

impl OpenClExecutor {
    /// An executor on the device behind `context`. `strict` kernels equal the CPU twin bit for bit; `mutation` breaks
    /// kernels on purpose, for tests and for the self-test's negative control.
    pub fn new(context: Context, strict: bool, mutation: Option<Mutation>) -> Self {
        let (mut scan_group, traversal) = (scan_group(context.limits()), context.choices().traversal());
        if context.is_careful() {
            scan_group = scan_group.min(CAREFUL_GROUP as u32);
        }
        let mut executor = OpenClExecutor {
            context,
            is_lost: false,
            kernels: HashMap::new(),
            strict,
            traversal,
            mutation,
            scan_group,
            program_ms: 0.0,
            peak_before: 0,
            monitor: Monitor::default(),
            bounds: None,
        };
        executor.fit_scans();
        executor
    }

    /// From now on kernels have bounds checks (see [`bounds`]), and a launch that left a buffer is
    /// [`Error::LaunchBeyondBuffer`]. For a control a buffer may be told to have fewer words than it has.
    ///
    /// # Errors
    /// A failing call.
    pub fn check_bounds(&mut self, understated: Option<(FrameBuffer, usize)>) -> Result<()> {
        self.bounds = Some(BoundsTable::new(&self.context, understated)?);
        self.kernels.clear();
        Ok(())
    }

    /// Lowers the work-group of scans to what the driver allows their kernel, which it says once that is built.
    fn fit_scans(&mut self) {
        let scan = (Kernel::PackScan, self.flavour(Shading::Full, false));
        // What forbids the program is told when a frame wants it.
        if self.build(scan.0, scan.1).is_ok()
            && let Some(kernel) = self.kernels.get(&scan)
        {
            let [fitted, _] = self.context.fit_work_group(kernel, [self.scan_group as usize, 1], true);
            self.scan_group = fitted.max(2) as u32;
        }
    }

    fn flavour(&self, shading: Shading, count: bool) -> BuildFlavour {
        let anchor = shading == Shading::Anchor;
        BuildFlavour { strict: self.strict, count, anchor, traversal: self.traversal }
    }

    /// The options and texts that the device's compiler gets, in one: what a verdict about the kernels depends on.
    pub(crate) fn program_texts(&self, shading: Shading) -> String {
        let programs = Program::ALL.map(|program| kernels::program_source(program, self.mutation.as_ref()));
        let probe = kernels::assemble("probe.cl", self.mutation.as_ref());
        let flavour = self.flavour(shading, false);
        let careful = if self.context.is_careful() { "careful " } else { "" };
        format!("{careful}{} {flavour:?} {probe} {}", layout::build_options(flavour), programs.concat())
    }

    /// Sizes and offsets of the shared structs as this device's compiler lays them out, in the order of
    /// [`layout::struct_layout`].
    ///
    /// # Errors
    /// A program that does not build, or a failing call.
    pub fn probe(&mut self) -> Result<Vec<u32>> {
        let len = layout::struct_layout().len();
        let out: Buffer<u32> = self.context.buffer("probe", len)?;
        let source = kernels::assemble("probe.cl", self.mutation.as_ref());
        let options = layout::build_options(self.flavour(Shading::Full, false));
        let program = self.context.program(&ProgramSource { name: "probe", source: &source, options: &options })?;
        let kernel = program.kernel("probe")?;
        let args = [Arg::Buffer(&out)];
        self.context.launch(&DeviceLaunch {
            label: "probe",
            kernel: &kernel,
            args: &args,
            global: [1, 1],
            local: Some([1, 1]),
            barrier: false,
        })?;
        self.context.read(&out, 0..len)
    }

    /// Builds the programs that a usual frame needs, each noted by itself while its compiler runs.
    ///
    /// # Errors
    /// [`crate::Error::KernelBuild`]; [`crate::Error::DriverCrashed`] if a process ended in its compiler before.
    pub(crate) fn build_usual(&mut self, shading: Shading) -> Result<()> {
        let flavour = self.flavour(shading, false);
        // That of packing first, which was tried for its work-groups: if it ended an earlier start, no other program is
        // tried, whose compiling might end this one.
        for kernel in [Kernel::PackCount, Kernel::Trace, Kernel::Check, Kernel::CorrectMark] {
            self.build(kernel, flavour)?;
        }
        if self.prefers_few_launches() { self.build(Kernel::CorrectTail, flavour) } else { Ok(()) }
    }

    /// The device.
    pub fn context(&self) -> &Context {
        &self.context
    }

    fn build(&mut self, kernel: Kernel, flavour: BuildFlavour) -> Result<()> {
        if self.kernels.contains_key(&(kernel, flavour)) {
            return Ok(());
        }
        self.monitor.check()?;
        let started = std::time::Instant::now();
        let program = kernel.program();
        let mut options = layout::build_options(flavour);
        if flavour.strict && self.context.limits().correctly_rounded_divide_sqrt {
            options.push_str(" -cl-fp32-correctly-rounded-divide-sqrt");
        }
        let mut source = kernels::program_source(program, self.mutation.as_ref());
        if self.bounds.is_some() {
            source = bounds::with_checks(&source).map_err(|why| Error::argument("bounds checks", why))?;
        }
        let built =
            self.context.program(&ProgramSource { name: program.name(), source: &source, options: &options })?;
        for entry in program.kernels() {
            self.kernels.insert((entry, flavour), built.kernel(entry.name())?);
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
        // Lists of rays as well: some drivers compile a kernel anew for every shape.
        Items::List if kernel == Kernel::Trace => Some(choices.work_group(stage.name())),
        Items::Grid => Some(choices.work_group(stage.name())),
        Items::List | Items::Chunks | Items::OneGroup => Some([LIST_GROUP, 1]),
        Items::Groups => None,
    }
}

/// The work-group that one gets from `wanted` by halving its longer side until it has at most `most` items.
fn at_most(most: usize, [mut width, mut height]: [usize; 2]) -> [usize; 2] {
    while width.saturating_mul(height) > most.max(1) {
        if width > height { width = width.div_ceil(2) } else { height = height.div_ceil(2) }
    }
    [width, height]
}

fn previous_power_of_two(n: usize) -> usize {
    1 << (usize::BITS - 1 - n.max(1).leading_zeros())
}

/// The kernel's arguments, in order.
fn arguments<'a>(launch: &'a Launch, scene: &'a SceneOnDevice, frame: &'a FrameOnDevice) -> Vec<Arg<'a>> {
    let mut args: Vec<Arg> = Vec::with_capacity(20);
    for binding in launch.kernel.bindings() {
        match binding {
            Binding::Frame => args.push(Arg::Buffer(&frame.params)),
            Binding::Scene => {
                let all: [&dyn AnyBuffer; 11] = [
                    &frame.params,
                    &frame.lights,
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
            Binding::Step => args.push(Arg::value(launch.step)),
            Binding::Attributes => args.push(Arg::Buffer(&frame.attributes)),
            Binding::Color => args.push(Arg::Buffer(&frame.color)),
            Binding::Counters => args.push(Arg::Buffer(&frame.counters)),
            Binding::List => args.push(Arg::Buffer(&frame.list)),
            Binding::Masks => args.push(Arg::Buffer(&frame.masks)),
            Binding::Sums => args.push(Arg::Buffer(&frame.sums)),
            Binding::Scratch => args.push(Arg::Local(8 * launch.step.scan_group as usize)),
        }
    }
    args
}

impl Executor for OpenClExecutor {
    fn info(&self) -> ExecutorInfo {
        let info = self.context.info();
        ExecutorInfo {
            name: info.name.clone(),
            version: format!("{}, driver {}", info.version, info.driver),
            backend: "opencl",
            profile: self.context.profile_name().unwrap_or("none").into(),
        }
    }

    fn scan_group(&self) -> u32 {
        self.scan_group
    }

    fn traversal(&self) -> Traversal {
        self.traversal
    }

    fn memory_limits(&self) -> MemoryLimits {
        let limits = self.context.limits();
        MemoryLimits { total_bytes: limits.global_mem_bytes, allocation_bytes: limits.max_mem_alloc_bytes }
    }

    fn prefers_few_launches(&self) -> bool {
        // Each of a CPU's kernels is compiled before it first runs, and a launch costs microseconds.
        !self.context.is_cpu()
    }

    fn upload(&mut self, scene: &Arc<PreparedScene>) -> Result<SceneHandle> {
        Ok(SceneHandle::new(scene, SceneOnDevice::upload(&self.context, scene)?))
    }

    fn allocate(&mut self, inputs: &FrameInputs, sizes: &FrameSizes) -> Result<FrameHandle> {
        let memory = FrameOnDevice::allocate(&self.context, sizes)?;
        memory.write_inputs(&self.context, inputs)?;
        Ok(FrameHandle::new(inputs.clone(), *sizes, memory))
    }

    fn begin(&mut self, frame: &mut FrameHandle, inputs: &FrameInputs) -> Result<()> {
        frame.memory::<FrameOnDevice>()?.write_inputs(&self.context, inputs)?;
        frame.set_inputs(inputs);
        Ok(())
    }

    fn run(&mut self, launch: &Launch) -> Result<()> {
        let Launch { stage, kernel, step, .. } = *launch;
        check_launch(stage, kernel, step, launch.frame.params(), launch.frame.sizes())?;
        let (scene, frame) = (launch.scene.memory::<SceneOnDevice>()?, launch.frame.memory::<FrameOnDevice>()?);
        let flavour = self.flavour(launch.scene.prepared().shading, launch.frame.sizes().counters > 0);
        self.build(kernel, flavour)?;
        let device_kernel = &self.kernels[&(kernel, flavour)];
        let items = kernel.items(stage);
        let barrier = matches!(items, Items::Groups | Items::OneGroup);
        let fit = |wanted| self.context.fit_work_group(device_kernel, wanted, barrier);
        let local = match work_group(self.context.choices(), stage, kernel) {
            // Its scratch memory is that of a scan.
            Some([width, _]) if items == Items::OneGroup => fit([width.min(step.scan_group as usize), 1]),
            Some(wanted) if self.context.is_careful() => fit(at_most(CAREFUL_GROUP, wanted)),
            Some(wanted) => fit(wanted),
            // The scan's levels depend on the group: it is not fitted but checked.
            None => [step.scan_group as usize, 1],
        };
        let global = match items {
            Items::Grid => [step.grid_width as usize, step.grid_height as usize],
            // A row of work-groups, whatever their shape: trace.cl counts group by group.
            Items::List => [(step.item_count as usize).div_ceil(local[0] * local[1]) * local[0], local[1]],
            Items::Groups => [step.item_count as usize, 1],
            Items::Chunks => [step.item_count.div_ceil(32) as usize, 1],
            Items::OneGroup => local,
        };
        if global.contains(&0) {
            return Ok(());
        }
        let mut args = arguments(launch, scene, frame);
        if let Some(table) = &self.bounds {
            args.insert(0, table.prepare(&self.context, launch)?);
        }
        self.context.launch(&DeviceLaunch {
            label: kernel.label(stage),
            kernel: device_kernel,
            args: &args,
            global,
            local: Some(local),
            barrier,
        })?;
        self.bounds.as_ref().map_or(Ok(()), |table| table.look(&self.context, launch))
    }

    fn read(&mut self, frame: &FrameHandle, buffer: FrameBuffer, range: Range<usize>) -> Result<Vec<u32>> {
        frame.sizes().check_range(buffer, &range)?;
        self.context.read(frame.memory::<FrameOnDevice>()?.get(buffer), range)
    }

    fn write(&mut self, frame: &FrameHandle, buffer: FrameBuffer, words: &[u32]) -> Result<()> {
        frame.sizes().check_range(buffer, &(0..words.len()))?;
        self.context.write(frame.memory::<FrameOnDevice>()?.get(buffer), 0, words)
    }

    fn take_timings(&mut self) -> Result<Vec<(Stage, f64)>> {
        let timings = self.context.take_timings()?;
        let stage = |label: &str| LAUNCHES.iter().find(|(.., of)| *of == label).map(|(stage, ..)| *stage);
        Ok(timings.into_iter().filter_map(|(label, ms)| Some((stage(label)?, ms))).collect())
    }

    fn watch(&mut self, monitor: &Monitor) {
        self.context.watch(monitor);
        self.monitor = monitor.clone();
    }

    fn monitor(&self) -> &Monitor {
        &self.monitor
    }

    fn peak_bytes(&self) -> u64 {
        self.context.memory().peak_bytes.max(self.peak_before)
    }

    fn program_ms(&self) -> f64 {
        self.program_ms
    }

    fn is_lost(&self) -> bool {
        self.is_lost
    }

    fn reopen(&mut self) -> Result<String> {
        self.is_lost = true;
        self.kernels.clear();
        self.peak_before = self.peak_bytes();
        self.context = self.context.reopen()?;
        if let Some(table) = &self.bounds {
            self.bounds = Some(table.again(&self.context)?);
        }
        self.context.watch(&self.monitor);
        self.is_lost = false;
        let slices = self.context.slice_ms().map_or("whole".into(), |ms| format!("of {ms:.1} ms"));
        Ok(format!("launches are {slices} now"))
    }
}

#[cfg(test)]
mod tests {
    use super::at_most;

    #[test]
    fn careful_work_groups_are_small() {
        assert_eq!(at_most(32, [8, 8]), [8, 4]);
        assert_eq!(at_most(32, [64, 1]), [32, 1]);
        assert_eq!(at_most(32, [4, 4]), [4, 4]);
        assert_eq!(at_most(0, [3, 5]), [1, 1]);
    }
}
