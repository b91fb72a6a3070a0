// SPDX-License-Identifier: MIT OR Apache-2.0
//! A scene made ready on a device, and frames drawn from it.

use std::sync::Arc;
use std::time::Instant;

pub(crate) use super::device::open_opencl;

use super::device::Device;
use super::draw::{Job, LastFrame};
use crate::analysis::wave_model::{self, LaunchCost};
use crate::device::backend::{Backend, BackendInfo};
use crate::device::hooks::progress::WatchedBackend;
use crate::device::hooks::recording::RecordingBackend;
use crate::device::kernels::Mutation;
use crate::device::opencl::{CacheFolder, Faults};
use crate::device::profiles::Profile;
use crate::error::{Error, Remedy, Result, Setting};
use crate::layout::PLANE_COUNT;
use crate::method::fallback::Fallback;
use crate::method::frame::Frame;
pub use crate::method::frame::Keep;
use crate::method::options::{Mode, RenderOptions};
use crate::method::pipeline;
use crate::monitor::Monitor;
use crate::prepare::kdtree::{BuildOptions, KdStatistics, KdTree};
use crate::prepare::scene_buffers::{SceneBuffers, Shading};
use crate::scene::{Scene, View};

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
    /// For tests: when the OpenCL device is lost.
    pub faults: Faults,
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
    monitor: Monitor,
}

impl Renderer {
    /// Builds the kd-tree of `scene`, opens the device and uploads. `monitor` watches that, and the renderer's frames
    /// until [`Renderer::set_monitor`].
    ///
    /// # Errors
    /// No usable device, a scene beyond the device's limits, or a failing call. [`Error::Cancelled`].
    pub fn new(scene: Scene, options: &RendererOptions, monitor: &Monitor) -> Result<Self> {
        monitor.restart();
        let started = Instant::now();
        let part = monitor.part("kd-tree", 0.0, 0.8);
        let tree = KdTree::build(scene.positions(), scene.triangles(), &BuildOptions::default(), &part)?;
        let kdtree_ms = started.elapsed().as_secs_f64() * 1e3;
        let tree_statistics = tree.statistics();
        let started = Instant::now();
        let part = monitor.part("device", 0.8, 1.0);
        let buffers = Arc::new(SceneBuffers::watched(&scene, tree, options.shading, &part)?);
        let (name, view, triangle_count) = (scene.name().to_owned(), scene.view().clone(), scene.triangles().len());
        drop(scene);
        let mut notices = Vec::new();
        let device = Device::open(&buffers, options, &mut notices, &part)?;
        monitor.check()?;
        part.tell(1.0);
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
            monitor: monitor.clone(),
        })
    }

    /// Draws a frame. An adaptive frame that its own counters show to be dearer than full tracing makes the following
    /// ones full (see [`Fallback`]); the statistics say so.
    ///
    /// The renderer's monitor hears how far it is, and can cancel it. After any error the renderer is usable, and what
    /// the frame drawn last kept ([`Renderer::plane`]) is what it was: a frame's planes are replaced when the next one
    /// is finished, not before. (A frame's picture is the caller's.)
    ///
    /// A device that is lost on the way is opened again, with slices of half the time, and the frame begins again, once.
    /// [`Renderer::notices`] says so.
    ///
    /// # Errors
    /// An option out of range, a frame beyond the device's limits or the memory budget, or a failing call.
    /// [`Error::Cancelled`]; [`Error::DeviceLost`] if the device was lost twice: the next frame opens it once more.
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
        self.rescue_last_frame()?;
        let job = Job {
            options,
            keep,
            view: &self.view,
            buffers: &self.buffers,
            memory_budget_bytes: self.memory_budget_bytes,
            monitor: &self.monitor,
        };
        let (frame, planes) = self.device.working(&self.monitor, &mut self.notices, |backend| job.draw(backend))?;
        self.last_frame = Some(LastFrame { keep, planes });
        Ok(frame)
    }

    /// What the last frame kept outlives the next one, should that not be finished.
    fn rescue_last_frame(&mut self) -> Result<()> {
        self.monitor.check()?;
        let Some(last) = &mut self.last_frame else { return Ok(()) };
        match last.rescue(self.device.backend(), &self.monitor) {
            Err(Error::Cancelled) => Err(Error::Cancelled),
            // Lost with the device, as the next frame will find out.
            Err(error) => {
                log::warn!("the last frame's planes are gone: {error}");
                self.last_frame = None;
                Ok(())
            }
            Ok(()) => Ok(()),
        }
    }

    /// Draws a frame with counters and returns what each of its launches costs, lane by lane. The planes of the last
    /// frame are gone afterwards.
    ///
    /// # Errors
    /// As for [`Renderer::render`]; a frame that does not fit into memory at once.
    pub fn launch_costs(&mut self, options: &RenderOptions) -> Result<Vec<LaunchCost>> {
        options.validate()?;
        self.monitor.check()?;
        self.last_frame = None;
        let job = Job {
            options: &RenderOptions { band_rows: None, ..options.clone() },
            keep: Keep::COUNTERS,
            view: &self.view,
            buffers: &self.buffers,
            memory_budget_bytes: self.memory_budget_bytes,
            monitor: &self.monitor,
        };
        self.device.working(&self.monitor, &mut self.notices, |backend| {
            let params = job.params();
            let plan = job.plan(backend, &params)?;
            if !plan.is_one_window() {
                return Err(Error::LimitExceeded {
                    what: "the wave model".into(),
                    limit: Setting::MemoryBudget.path().into(),
                    wanted: format!("all {} rows of samples in memory", params.height),
                    allowed: format!("{} rows", plan.rows()),
                    remedies: &[Remedy::SmallerPicture, Remedy::LargerBudget],
                });
            }
            let backend = &mut WatchedBackend::new(backend, &self.monitor);
            backend.begin(&params, &plan.sizes)?;
            let mut recording = RecordingBackend::new(backend);
            if options.mode == Mode::Full {
                pipeline::full_frame(&mut recording, &params, false)?;
            } else {
                pipeline::adaptive_frame(&mut recording, &params, options, self.view.extent)?;
            }
            let launches = recording.launches;
            wave_model::launch_costs(backend, &params, &launches)
        })
    }

    /// An attribute plane (`PLANE_*`) of the frame that was finished last, row-major, one word a sample. Reading cannot be
    /// cancelled.
    ///
    /// # Errors
    /// No frame, or one that did not keep this plane; a failing call.
    pub fn plane(&mut self, plane: u32) -> Result<Vec<u32>> {
        self.kept_plane(plane, "attributes")
    }

    /// A counter plane (`COUNTER_*`) of the frame that was finished last, row-major, one word a sample. Reading cannot be
    /// cancelled.
    ///
    /// # Errors
    /// No frame, or one that did not keep this counter; a failing call.
    pub fn counter_plane(&mut self, plane: u32) -> Result<Vec<u32>> {
        self.kept_plane(PLANE_COUNT + plane, "counters")
    }

    fn kept_plane(&mut self, plane: u32, what: &'static str) -> Result<Vec<u32>> {
        let words = match &self.last_frame {
            Some(last) => last.plane(self.device.backend(), plane)?,
            None => None,
        };
        words.ok_or(Error::MissingPlane { plane: what })
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

    /// Who watches the next frames: a cancelled monitor must be replaced before there can be any.
    pub fn set_monitor(&mut self, monitor: &Monitor) {
        self.monitor = monitor.clone();
    }

    /// Who watches.
    pub fn monitor(&self) -> &Monitor {
        &self.monitor
    }

    /// Things a user should know about the device, one sentence each: why it was chosen, when it was lost.
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
