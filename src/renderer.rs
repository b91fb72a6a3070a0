// SPDX-License-Identifier: MIT OR Apache-2.0
//! A scene made ready on a device, and frames drawn from it.

use std::sync::Arc;
use std::time::Instant;

use crate::backend::opencl::OpenClBackend;
use crate::backend::twin::TwinBackend;
use crate::backend::{Backend, BackendInfo, BufferSizes, FrameBuffer};
use crate::camera::frame_params;
use crate::error::{Error, Result};
use crate::fallback::Fallback;
use crate::frame::{Frame, FrameStats, RayCounts, WorkCounts};
use crate::kdtree::{BuildOptions, KdStatistics, KdTree};
use crate::kernels::Mutation;
use crate::layout::*;
use crate::opencl::{self, CacheFolder, OpenOptions};
use crate::options::{Mode, RenderOptions, Test};
use crate::pipeline;
use crate::profiles::Profile;
use crate::quick_test;
use crate::scene::{Scene, View};
use crate::scene_buffers::{SceneBuffers, Shading};
use crate::stage::Stage;
use crate::twin::planes::plane_index;

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

/// What a frame keeps beside its picture.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Keep {
    /// Attributes of every pixel: layers can be read afterwards. An adaptive frame always keeps them.
    pub attributes: bool,
    /// Work counters of every pixel.
    pub counters: bool,
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
    last_frame: Option<(FrameParams, Keep)>,
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
        let keep = Keep { attributes: keep.attributes || !full, ..keep };
        let block = if full { 1 } else { options.block };
        let params = frame_params(&self.view, &self.buffers, options.width, options.height, block, options.depth);
        let sizes = self.buffer_sizes(&params, keep)?;
        let backend = self.device.backend();
        backend.take_timings()?;
        let started = Instant::now();
        backend.begin(&params, &sizes)?;
        let counts = if full {
            pipeline::full_frame(backend, &params, keep.attributes)?
        } else {
            pipeline::adaptive_frame(backend, &params, options, self.view.extent)?
        };
        let pixels = backend.read(FrameBuffer::Color, 0..sizes.color)?;
        let frame_ms = started.elapsed().as_secs_f64() * 1e3;
        let mut stages_ms = [0.0; Stage::ALL.len()];
        for (kernel, ms) in backend.take_timings()? {
            stages_ms[kernel.stage() as usize] += ms;
        }
        self.last_frame = Some((params, keep));
        let mut stats = FrameStats { frame_ms, stages_ms, pixels: counts, ..FrameStats::default() };
        if keep.counters {
            let (rays, work) = self.count_work(&params)?;
            (stats.rays, stats.work) = (Some(rays), Some(work));
            if !full {
                stats.failed_tests = Some(self.count_failed_tests(&params)?);
            }
        }
        Ok(Frame { width: options.width, height: options.height, pixels, stats })
    }

    /// An attribute plane (`PLANE_*`) of the last frame, row-major.
    ///
    /// # Errors
    /// No frame, or one that kept no attributes; a failing call.
    pub fn plane(&mut self, plane: u32) -> Result<Vec<u32>> {
        match self.last_frame {
            Some((params, keep)) if keep.attributes => self.read_plane(&params, FrameBuffer::Attributes, plane),
            _ => Err(Error::option("layer", "the last frame kept no attributes")),
        }
    }

    /// A counter plane (`COUNTER_*`) of the last frame, row-major.
    ///
    /// # Errors
    /// No frame, or one that kept no counters; a failing call.
    pub fn counter_plane(&mut self, plane: u32) -> Result<Vec<u32>> {
        match self.last_frame {
            Some((params, keep)) if keep.counters => self.read_plane(&params, FrameBuffer::Counters, plane),
            _ => Err(Error::option("layer", "the last frame kept no counters")),
        }
    }

    fn read_plane(&mut self, params: &FrameParams, buffer: FrameBuffer, plane: u32) -> Result<Vec<u32>> {
        let pitch = params.plane_pitch as usize;
        let start = plane as usize * pitch;
        let words = self.device.backend().read(buffer, start..start + pitch)?;
        let pixels = (0..params.height).flat_map(|y| (0..params.width).map(move |x| (x, y)));
        Ok(pixels.map(|(x, y)| words[plane_index(params, x, y) as usize]).collect())
    }

    fn count_work(&mut self, params: &FrameParams) -> Result<(RayCounts, WorkCounts)> {
        let mut sums = [0u64; COUNTER_COUNT as usize];
        for (plane, sum) in sums.iter_mut().enumerate() {
            let values = self.read_plane(params, FrameBuffer::Counters, plane as u32)?;
            *sum = values.iter().map(|&v| u64::from(v)).sum();
        }
        let primary = match self.last_frame {
            Some((p, _)) if p.block > 1 => {
                let classes = self.read_plane(params, FrameBuffer::Attributes, PLANE_CLASS)?;
                classes.iter().filter(|&&c| c & CLASS_MASK != CLASS_INTERPOLATED).count() as u64
            }
            _ => u64::from(params.width) * u64::from(params.height),
        };
        let rays = RayCounts {
            primary,
            shadow: sums[COUNTER_SHADOW_RAYS as usize],
            reflection: sums[COUNTER_REFLECTION_RAYS as usize],
            refraction: sums[COUNTER_REFRACTION_RAYS as usize],
        };
        let work = WorkCounts {
            traversal_steps: sums[COUNTER_TRAVERSAL_STEPS as usize],
            triangle_tests: sums[COUNTER_TRIANGLE_TESTS as usize],
            shaded_pixels: sums[COUNTER_SHADED as usize],
        };
        Ok((rays, work))
    }

    fn count_failed_tests(&mut self, params: &FrameParams) -> Result<[u64; 7]> {
        let classes = self.read_plane(params, FrameBuffer::Attributes, PLANE_CLASS)?;
        Ok(Test::ALL.map(|test| classes.iter().filter(|&&c| c & test.fail_bit() != 0).count() as u64))
    }

    fn buffer_sizes(&mut self, params: &FrameParams, keep: Keep) -> Result<BufferSizes> {
        let scan_group = self.device.backend().scan_group();
        let what = || format!("a frame of {}x{}", params.width, params.height);
        let sizes = BufferSizes::new(params, keep.attributes, keep.counters, scan_group);
        let sizes = sizes.ok_or_else(|| Error::LimitExceeded {
            what: what(),
            limit: "address space".into(),
            wanted: format!("buffers of {} planes of {} pixels", PLANE_COUNT, params.plane_pitch),
            allowed: format!("{} bytes", usize::MAX),
            remedy: "choose a smaller --size".into(),
        })?;
        // Without a budget only a sanity limit holds: no frame may take more than this.
        let budget = self.memory_budget_bytes.unwrap_or(DEFAULT_BUDGET_BYTES).min(usize::MAX as u64 / 2);
        let wanted = sizes.bytes() + self.buffers.bytes();
        if wanted > budget {
            return Err(Error::LimitExceeded {
                what: what(),
                limit: "--memory-budget".into(),
                wanted: format!("{} MiB", wanted.div_ceil(1 << 20)),
                allowed: format!("{} MiB", budget >> 20),
                remedy: "choose a smaller --size or a larger --memory-budget".into(),
            });
        }
        Ok(sizes)
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
