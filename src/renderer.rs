// SPDX-License-Identifier: MIT OR Apache-2.0
//! A scene made ready on a device, and frames drawn from it.

use std::sync::Arc;
use std::time::Instant;

use crate::backend::opencl::OpenClBackend;
use crate::backend::recording::RecordingBackend;
use crate::backend::twin::TwinBackend;
use crate::backend::{Backend, BackendInfo, FrameBuffer};
use crate::bands::{self, Collected, CounterSums, Plan, Room};
use crate::camera::frame_params;
use crate::error::{Error, Result};
use crate::fallback::Fallback;
pub use crate::frame::Keep;
use crate::frame::{Frame, FrameStats};
use crate::kdtree::{BuildOptions, KdStatistics, KdTree};
use crate::kernels::Mutation;
use crate::layout::*;
use crate::opencl::{self, CacheFolder, OpenOptions};
use crate::options::{Mode, RenderOptions};
use crate::pipeline;
use crate::profiles::Profile;
use crate::quick_test;
use crate::resolve::resolve;
use crate::scene::{Scene, View};
use crate::scene_buffers::{SceneBuffers, Shading};
use crate::stage::Stage;
use crate::twin::planes::plane_index;
use crate::wave_model::{self, LaunchCost};

/// Which device draws.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DeviceChoice {
    /// The first usable OpenCL device, else the CPU twin.
    #[default]
    Auto,
    /// The CPU twin.
    Cpu,
    /// An OpenCL device: the first usable one, or the one of this index in `rarefy devices`.
    OpenCl(Option<usize>),
}

/// How to make a renderer.
#[derive(Debug, Clone, Default)]
pub struct RendererOptions {
    /// Which device draws.
    pub device: DeviceChoice,
    /// The profile whose limits the OpenCL device is held to.
    pub profile: Option<Profile>,
    /// Kernels that equal the CPU twin bit for bit, instead of the device's fastest.
    pub strict: bool,
    /// Shading rules.
    pub shading: Shading,
    /// Most device memory, in bytes.
    pub memory_budget_bytes: Option<u64>,
    /// Kernels broken on purpose, for tests and the self-test's negative control.
    pub mutation: Option<Mutation>,
    /// Where compiled programs and verdicts of self-tests are kept.
    pub cache: CacheFolder,
}

/// How long it took to make ready, in milliseconds.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BuildTimes {
    /// Reading the scene's files.
    pub load_ms: f64,
    /// Building the kd-tree.
    pub kdtree_ms: f64,
    /// Opening the device and uploading.
    pub upload_ms: f64,
    /// Building programs.
    pub program_ms: f64,
}

enum Device {
    Twin(Box<TwinBackend>),
    OpenCl(Box<OpenClBackend>),
}

impl Device {
    fn backend(&mut self) -> &mut dyn Backend {
        match self {
            Device::Twin(twin) => twin.as_mut(),
            Device::OpenCl(device) => device.as_mut(),
        }
    }
}

/// The frame drawn last, as far as its planes can be read.
struct LastFrame {
    keep: Keep,
    planes: Planes,
}

/// Where planes are.
enum Planes {
    /// In the device's buffers: the frame was one window.
    OnDevice(FrameParams),
    /// On the host.
    Collected(Collected),
}

/// A scene on a device, ready to draw frames.
pub struct Renderer {
    name: String,
    view: View,
    triangle_count: usize,
    tree_statistics: KdStatistics,
    buffers: Arc<SceneBuffers>,
    device: Device,
    memory_budget_bytes: Option<u64>,
    times: BuildTimes,
    notices: Vec<String>,
    last_frame: Option<LastFrame>,
    fallback: Fallback,
}

impl Renderer {
    /// Builds the kd-tree of `scene`, opens the device and uploads. `progress` gets a phase and its share done.
    ///
    /// # Errors
    /// No usable device, a scene beyond the device's limits, or a failing call.
    pub fn new(scene: Scene, options: &RendererOptions, progress: &(dyn Fn(&str, f32) + Sync)) -> Result<Self> {
        let started = Instant::now();
        let build = BuildOptions::default();
        let tree = KdTree::build(&scene.positions, &scene.triangles, &build, &|share| progress("kd-tree", share))?;
        let kdtree_ms = started.elapsed().as_secs_f64() * 1e3;
        let tree_statistics = tree.statistics();
        let started = Instant::now();
        let buffers = Arc::new(SceneBuffers::new(&scene, tree, options.shading)?);
        let (name, view, triangle_count) = (scene.name.clone(), scene.view.clone(), scene.triangles.len());
        drop(scene);
        let mut notices = Vec::new();
        let device = open_device(&buffers, options, &mut notices)?;
        let upload_ms = started.elapsed().as_secs_f64() * 1e3;
        Ok(Renderer {
            name,
            view,
            triangle_count,
            tree_statistics,
            buffers,
            device,
            memory_budget_bytes: options.memory_budget_bytes,
            times: BuildTimes { kdtree_ms, upload_ms, ..BuildTimes::default() },
            notices,
            last_frame: None,
            fallback: Fallback::default(),
        })
    }

    /// Draws a frame. An adaptive frame that its own counters show to be dearer than full tracing makes the following
    /// ones full (see [`Fallback`]); the statistics say so.
    ///
    /// # Errors
    /// An option out of range, a frame beyond the device's limits or the memory budget, or a failing call.
    pub fn render(&mut self, options: &RenderOptions, keep: Keep) -> Result<Frame> {
        let fell_back = options.mode == Mode::Adaptive && self.fallback.choose_full(options);
        let mut frame = if fell_back {
            self.render_exactly(&RenderOptions { mode: Mode::Full, ..options.clone() }, keep)?
        } else {
            self.render_exactly(options, keep)?
        };
        if options.mode == Mode::Adaptive && !fell_back {
            self.fallback.learn(options, &frame.stats.pixels);
        }
        frame.stats.fell_back = fell_back;
        Ok(frame)
    }

    /// Draws a frame in the mode that is asked for, without the fall-back: for comparisons.
    ///
    /// # Errors
    /// As for [`Renderer::render`].
    pub fn render_exactly(&mut self, options: &RenderOptions, keep: Keep) -> Result<Frame> {
        options.validate()?;
        let full = options.mode == Mode::Full;
        let block = if full { 1 } else { options.block };
        let (width, height) = options.sample_size();
        let params = frame_params(&self.view, &self.buffers, width, height, block, options.depth);
        let room = self.room(keep.attributes() || !full, keep.counters);
        let plan = Plan::new(&params, &room, options.band_rows)?;
        self.last_frame = None;
        let backend = self.device.backend();
        backend.take_timings()?;
        let started = Instant::now();
        let (counts, samples, planes) = if plan.is_one_window() {
            backend.begin(&params, &plan.sizes)?;
            let counts = if full {
                pipeline::full_frame(backend, &params, keep.attributes())?
            } else {
                pipeline::adaptive_frame(backend, &params, options, self.view.extent)?
            };
            (counts, backend.read(FrameBuffer::Color, 0..plan.sizes.color)?, Planes::OnDevice(params))
        } else {
            let (counts, mut collected) = bands::draw(backend, &plan, options, self.view.extent, keep)?;
            (counts, std::mem::take(&mut collected.colors), Planes::Collected(collected))
        };
        let pixels = match options.samples {
            1 => samples,
            samples_per_axis => resolve(&samples, options.width, options.height, samples_per_axis),
        };
        let frame_ms = started.elapsed().as_secs_f64() * 1e3;
        let mut stages_ms = [0.0; Stage::ALL.len()];
        for (kernel, ms) in backend.take_timings()? {
            stages_ms[kernel.stage() as usize] += ms;
        }
        let mut stats = FrameStats { frame_ms, stages_ms, pixels: counts, ..FrameStats::default() };
        if keep.counters {
            let sums = match &planes {
                Planes::OnDevice(params) => {
                    let primary = counts.base + counts.traced + counts.corrected;
                    let mut sums = CounterSums { primary, ..CounterSums::default() };
                    bands::sum_counters(backend, params, &mut sums, true)?;
                    sums
                }
                Planes::Collected(collected) => collected.sums,
            };
            (stats.rays, stats.work) = (Some(sums.rays()), Some(sums.work()));
            stats.work_by_class = Some(sums.work_by_class);
            stats.failed_tests = (!full).then_some(sums.failed_tests);
        }
        self.last_frame = Some(LastFrame { keep, planes });
        Ok(Frame { width: options.width, height: options.height, pixels, stats })
    }

    /// Draws a frame with counters and returns what each of its launches costs, lane by lane.
    ///
    /// # Errors
    /// As for [`Renderer::render`]; a frame that does not fit into memory at once.
    pub fn launch_costs(&mut self, options: &RenderOptions) -> Result<Vec<LaunchCost>> {
        options.validate()?;
        let full = options.mode == Mode::Full;
        let block = if full { 1 } else { options.block };
        let (width, height) = options.sample_size();
        let params = frame_params(&self.view, &self.buffers, width, height, block, options.depth);
        let plan = Plan::new(&params, &self.room(!full, true), None)?;
        if !plan.is_one_window() {
            return Err(Error::LimitExceeded {
                what: "the wave model".into(),
                limit: "--memory-budget".into(),
                wanted: format!("all {height} rows of samples in memory"),
                allowed: format!("{} rows", plan.rows()),
                remedy: "choose a smaller --size or a larger --memory-budget".into(),
            });
        }
        self.last_frame = None;
        let backend = self.device.backend();
        backend.begin(&params, &plan.sizes)?;
        let mut recording = RecordingBackend::new(backend);
        if full {
            pipeline::full_frame(&mut recording, &params, false)?;
        } else {
            pipeline::adaptive_frame(&mut recording, &params, options, self.view.extent)?;
        }
        let launches = recording.launches;
        wave_model::launch_costs(backend, &params, &launches)
    }

    /// An attribute plane (`PLANE_*`) of the last frame, row-major, one word a sample.
    ///
    /// # Errors
    /// No frame, or one that did not keep this plane; a failing call.
    pub fn plane(&mut self, plane: u32) -> Result<Vec<u32>> {
        self.kept_plane(plane, "attributes")
    }

    /// A counter plane (`COUNTER_*`) of the last frame, row-major, one word a sample.
    ///
    /// # Errors
    /// No frame, or one that did not keep this counter; a failing call.
    pub fn counter_plane(&mut self, plane: u32) -> Result<Vec<u32>> {
        self.kept_plane(PLANE_COUNT + plane, "counters")
    }

    fn kept_plane(&mut self, plane: u32, what: &str) -> Result<Vec<u32>> {
        let missing = || Error::option("layer", format!("the last frame did not keep these {what}"));
        let last = self.last_frame.as_ref().filter(|last| last.keep.has(plane)).ok_or_else(missing)?;
        match &last.planes {
            Planes::OnDevice(params) => {
                let words = bands::read_plane(self.device.backend(), params, plane)?;
                let pixels = (0..params.height).flat_map(|y| (0..params.width).map(move |x| (x, y)));
                Ok(pixels.map(|(x, y)| words[plane_index(params, x, y) as usize]).collect())
            }
            Planes::Collected(collected) => collected.planes.get(&plane).cloned().ok_or_else(missing),
        }
    }

    /// What the device, its profile and the budget leave for a frame's buffers.
    fn room(&mut self, attributes: bool, counters: bool) -> Room {
        let backend = self.device.backend();
        let limits = backend.memory_limits();
        let scene_bytes = self.buffers.bytes() + SMALL_BUFFERS_BYTES;
        let budget = self.memory_budget_bytes.unwrap_or(DEFAULT_BUDGET_BYTES).min(usize::MAX as u64 / 2);
        Room {
            total_bytes: budget.min(limits.total_bytes).saturating_sub(scene_bytes),
            allocation_bytes: limits.allocation_bytes,
            scene_bytes,
            attributes,
            counters,
            scan_group: backend.scan_group(),
        }
    }

    /// The scene's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The view that frames are drawn from.
    pub fn view(&self) -> &View {
        &self.view
    }

    /// Moves the camera, lights or environment; the number of lights must stay.
    pub fn set_view(&mut self, view: View) {
        self.view = view;
    }

    /// Number of triangles.
    pub fn triangle_count(&self) -> usize {
        self.triangle_count
    }

    /// Statistics of the kd-tree.
    pub fn tree_statistics(&self) -> &KdStatistics {
        &self.tree_statistics
    }

    /// What draws.
    pub fn info(&mut self) -> BackendInfo {
        self.device.backend().info()
    }

    /// How long it took to make ready; program builds so far included, `load_ms` left 0.
    pub fn build_times(&self) -> BuildTimes {
        let program_ms = match &self.device {
            Device::Twin(_) => 0.0,
            Device::OpenCl(device) => device.program_ms(),
        };
        BuildTimes { program_ms, ..self.times }
    }

    /// Things a user should know about the choice of device, one sentence each.
    pub fn notices(&self) -> &[String] {
        &self.notices
    }

    /// Most bytes of device memory in use so far.
    pub fn peak_device_bytes(&mut self) -> u64 {
        self.device.backend().peak_bytes()
    }

    /// The back end: tests run single stages with it.
    pub fn backend(&mut self) -> &mut dyn Backend {
        self.device.backend()
    }
}

/// What small buffers beside the scene's arrays and the frame's may take, such as the frame's parameters.
const SMALL_BUFFERS_BYTES: u64 = 64 << 10;
/// Most device memory of a frame and its scene where nobody says otherwise, in bytes.
pub const DEFAULT_BUDGET_BYTES: u64 = 4 << 30;

fn open_device(buffers: &Arc<SceneBuffers>, options: &RendererOptions, notices: &mut Vec<String>) -> Result<Device> {
    let twin = || Device::Twin(Box::new(TwinBackend::new(Arc::clone(buffers))));
    let tested = || {
        let mut opened = open_opencl(buffers, options)?;
        if let Some(backend) = &mut opened {
            quick_test::check(backend, options.profile.as_ref())?;
        }
        Ok(opened)
    };
    match tested() {
        Ok(Some(backend)) => Ok(Device::OpenCl(Box::new(backend))),
        Ok(None) => Ok(twin()),
        // No device, or one that a quick self-test found wanting.
        Err(error @ (Error::NoOpenCl { .. } | Error::SelfTest { .. } | Error::KernelBuild { .. }))
            if options.device == DeviceChoice::Auto =>
        {
            notices.push(format!("drawing on the CPU twin: {error}"));
            Ok(twin())
        }
        Err(error) => Err(error),
    }
}

/// The OpenCL back end that `options` ask for; `None` if they ask for the CPU twin.
pub(crate) fn open_opencl(buffers: &Arc<SceneBuffers>, options: &RendererOptions) -> Result<Option<OpenClBackend>> {
    let index = match options.device {
        DeviceChoice::Cpu => return Ok(None),
        DeviceChoice::Auto => None,
        DeviceChoice::OpenCl(index) => index,
    };
    let open = OpenOptions {
        index,
        profile: options.profile.clone(),
        memory_budget_bytes: options.memory_budget_bytes,
        cache: options.cache.clone(),
        ..OpenOptions::default()
    };
    let mut backend = OpenClBackend::new(opencl::open_with(&open)?, buffers, options.strict)?;
    backend.mutate(options.mutation.clone());
    Ok(Some(backend))
}
