// SPDX-License-Identifier: MIT OR Apache-2.0
//! A prepared scene on a device, and frames drawn from it.

use std::sync::Arc;
use std::time::Instant;

use super::frame::{Frame, FrameStats};
use super::frames::Frames;
use super::resolve::resolve;
use crate::device::cpu::executor::CpuExecutor;
use crate::device::executor::{Executor, ExecutorInfo};
use crate::device::frame_memory::FrameHandle;
use crate::device::hooks::progress::Progress;
use crate::device::launch::SceneHandle;
use crate::device::open::{DeviceChoice, DeviceOptions, devices, open_number};
use crate::device::opencl::codes;
use crate::device::queue::{Hook, Queue};
use crate::device::stage::Stage;
use crate::device::twin::executor::TwinExecutor;
use crate::error::{Error, Result};
use crate::layout::{FrameParams, PLANE_COUNT};
use crate::method::bands::{FrameBudget, Plan};
use crate::method::camera::frame_inputs;
use crate::method::counts::Keep;
use crate::method::fallback::{Fallback, may_lose_detail};
use crate::method::frame::draw_frame;
use crate::method::options::{Mode, RenderOptions};
use crate::monitor::Monitor;
use crate::prepare::PreparedScene;
use crate::prepare::kdtree::KdStatistics;
use crate::scene::View;
use crate::selftest::quick;

/// Most device memory of a frame and its scene where nobody says otherwise, in bytes.
pub const DEFAULT_BUDGET_BYTES: u64 = 4 << 30;

/// What small buffers beside the scene's arrays and the frame's may take, such as the frame's parameters and lights.
const SMALL_BUFFERS_BYTES: u64 = 64 << 10;

/// How long it took to make ready, in milliseconds.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize)]
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

/// A prepared scene on a device, ready to draw frames.
pub struct Renderer {
    prepared: Arc<PreparedScene>,
    view: View,
    executor: Box<dyn Executor>,
    /// `None`: the device is lost.
    scene: Option<SceneHandle>,
    frames: Frames,
    fallback: Fallback,
    memory_budget_bytes: Option<u64>,
    upload_ms: f64,
    notices: Vec<String>,
    passed_over: Vec<Error>,
    /// Whether another device may draw where this one cannot.
    may_change_device: bool,
    monitor: Monitor,
}

impl Renderer {
    /// Opens the device that `options` ask for and uploads the scene. `monitor` watches that, and the renderer's frames
    /// until [`Renderer::set_monitor`].
    ///
    /// A driver that this version has not met compiles kernels and is tested, which may take seconds. With
    /// [`DeviceChoice::Auto`] whatever is wrong with a driver is no error: the first device with its usual kernels, the
    /// same with kernels that are built with care, further devices and at last the CPU are tried.
    /// [`Renderer::passed_over`] says what did not do.
    ///
    /// # Errors
    /// No usable device, a scene beyond the device's limits, or a failing call. [`Error::Cancelled`].
    pub fn new(scene: Arc<PreparedScene>, options: &DeviceOptions, monitor: &Monitor) -> Result<Self> {
        monitor.restart();
        let part = monitor.part("device", 0.0, 1.0);
        part.check()?;
        let started = Instant::now();
        let mut passed_over = Vec::new();
        let opened = open_executor(&scene, options, &mut passed_over, &part)?;
        let notices = opened.notice(&passed_over).into_iter().collect();
        let mut executor = opened.executor;
        executor.watch(&part);
        let uploaded = executor.upload(&scene);
        executor.watch(&Monitor::default());
        let uploaded = uploaded?;
        monitor.check()?;
        part.tell(1.0);
        Ok(Renderer {
            view: scene.view().clone(),
            prepared: scene,
            executor,
            scene: Some(uploaded),
            frames: Frames::default(),
            fallback: Fallback::default(),
            memory_budget_bytes: options.memory_budget_bytes,
            upload_ms: started.elapsed().as_secs_f64() * 1e3,
            notices,
            passed_over,
            may_change_device: options.device == DeviceChoice::Auto,
            monitor: monitor.clone(),
        })
    }

    /// Draws a frame. An adaptive frame that by its own counters may have lost detail is drawn once more, in full; it, and one
    /// that cost as much as full tracing, makes the following ones full (see [`Fallback`]). The statistics say so.
    ///
    /// The renderer's monitor is told how far it is, and can cancel it. After any error the renderer is usable, and what
    /// the frame drawn last kept ([`Renderer::plane`]) is what it was, unless the device was lost: a frame takes the
    /// last one's place when it is finished, not before. (A frame's picture is the caller's.)
    ///
    /// A device that is lost on the way is opened again, with slices of half the time, and the frame begins again, once.
    /// [`Renderer::notices`] says so.
    ///
    /// # Errors
    /// An option out of range, a frame beyond the device's limits or the memory budget, or a failing call.
    /// [`Error::Cancelled`]; [`Error::DeviceLost`] if the device was lost twice: the next frame opens it once more.
    pub fn render(&mut self, options: &RenderOptions, keep: Keep) -> Result<Frame> {
        if options.mode == Mode::Full {
            return self.render_exactly(options, keep);
        }
        let mut spent = None;
        if !self.fallback.choose_full(options) {
            let frame = self.render_exactly(options, keep)?;
            self.fallback.learn(options, &frame.stats.pixels);
            if !may_lose_detail(&frame.stats.pixels) {
                return Ok(frame);
            }
            spent = Some(frame.stats);
        }
        let mut frame = self.render_exactly(&RenderOptions { mode: Mode::Full, ..options.clone() }, keep)?;
        frame.stats.fell_back = true;
        if let Some(spent) = spent {
            frame.stats.add_cost(&spent);
        }
        Ok(frame)
    }

    /// Draws a frame in the mode that is asked for, without the fall-back: for comparisons.
    ///
    /// # Errors
    /// As for [`Renderer::render`].
    pub fn render_exactly(&mut self, options: &RenderOptions, keep: Keep) -> Result<Frame> {
        let mut observers: [&mut dyn Hook; 0] = [];
        let (frame, ()) = self.render_observed(options, keep, &mut observers, &mut |_, _| Ok(()))?;
        Ok(frame)
    }

    /// Draws a frame whose launches `observers` see, and looks at what it left on the device.
    ///
    /// # Errors
    /// As for [`Renderer::render`]; whatever an observer or `inspect` reports.
    #[doc(hidden)]
    pub fn render_observed<T>(
        &mut self,
        options: &RenderOptions,
        keep: Keep,
        observers: &mut [&mut dyn Hook],
        inspect: &mut dyn FnMut(&mut dyn Executor, &FrameHandle) -> Result<T>,
    ) -> Result<(Frame, T)> {
        options.validate()?;
        self.monitor.check()?;
        if self.executor.is_lost() || self.scene.is_none() {
            self.reopen()?;
        }
        let lost = match self.draw(options, keep, observers, inspect) {
            Err(_) if self.monitor.check().is_err() => return Err(Error::Cancelled),
            Err(error) if codes::is_loss(&error) => error,
            Err(error @ (Error::KernelBuild { .. } | Error::DriverCrashed { .. })) if self.may_change_device => {
                // A program that no frame needed so far.
                self.draw_on_cpu(error)?;
                return self.draw(options, keep, observers, inspect);
            }
            done => return done,
        };
        let device = self.executor.info().describe();
        log::warn!("{device}: {lost}");
        let changed = self.reopen()?;
        self.notices.push(format!("{device} was lost ({lost}) and opened again; {changed}"));
        self.draw(options, keep, observers, inspect)
            .map_err(|error| if codes::is_loss(&error) { self.lost(&error) } else { error })
    }

    /// Goes over to the CPU, since the device cannot build what a frame needs.
    fn draw_on_cpu(&mut self, reason: Error) -> Result<()> {
        self.frames.forget_device();
        self.scene = None;
        self.executor = Box::new(CpuExecutor::default());
        self.scene = Some(self.executor.upload(&self.prepared)?);
        self.may_change_device = false;
        self.notices.push(format!("drawing on the CPU from here on: {reason}"));
        self.passed_over.push(reason);
        Ok(())
    }

    /// Opens the device anew after it was lost, with the scene; everything else on it is gone.
    fn reopen(&mut self) -> Result<String> {
        self.frames.forget_device();
        self.scene = None;
        self.executor.watch(&self.monitor);
        let reopened = self.executor.reopen().and_then(|changed| {
            self.scene = Some(self.executor.upload(&self.prepared)?);
            Ok(changed)
        });
        self.executor.watch(&Monitor::default());
        reopened.map_err(|error| match error {
            Error::Cancelled => error,
            error => self.lost(&error),
        })
    }

    fn lost(&mut self, cause: &Error) -> Error {
        self.frames.forget_device();
        self.scene = None;
        Error::DeviceLost { device: self.executor.info().describe(), cause: cause.to_string() }
    }

    fn draw<T>(
        &mut self,
        options: &RenderOptions,
        keep: Keep,
        observers: &mut [&mut dyn Hook],
        inspect: &mut dyn FnMut(&mut dyn Executor, &FrameHandle) -> Result<T>,
    ) -> Result<(Frame, T)> {
        let Some(scene) = self.scene.clone() else { return Err(Error::ForeignHandle { what: "scene" }) };
        let block = if options.mode == Mode::Full { 1 } else { options.method.block };
        let (width, height) = options.sample_size();
        let inputs = frame_inputs(&self.view, &self.prepared, width, height, block, options.depth);
        let budget = self.frame_budget(options, keep);
        let plan = Plan::new(&inputs.params, &budget, options.band_rows)?;
        self.executor.take_timings()?;

        let started = Instant::now();
        let mut progress = Progress::new(&self.monitor);
        self.executor.watch(&self.monitor.part("frame", 0.0, 1.0));
        let executor = self.executor.as_mut();
        let mut frame = match self.frames.take(
            executor,
            &inputs,
            &plan.sizes,
            budget.total_bytes.saturating_sub(budget.scene_bytes),
        ) {
            Ok(frame) => frame,
            Err(error) => {
                executor.watch(&Monitor::default());
                return Err(error);
            }
        };
        let mut hooks: Vec<&mut dyn Hook> = vec![&mut progress];
        for observer in observers.iter_mut() {
            hooks.push(&mut **observer);
        }
        let mut queue = Queue::new(executor, &scene, &mut frame, &mut hooks);
        let drawn = draw_frame(&mut queue, &inputs, &plan, options, self.view.extent, keep).and_then(|mut drawn| {
            let samples = std::mem::take(&mut drawn.collected.colors);
            let pixels = match options.samples {
                1 => samples,
                per_axis => resolve(&samples, options.width, options.height, per_axis, &self.monitor)?,
            };
            let frame_ms = started.elapsed().as_secs_f64() * 1e3;
            let mut stages_ms = [0.0; Stage::ALL.len()];
            for (stage, ms) in queue.take_timings()? {
                stages_ms[stage as usize] += ms;
            }
            self.monitor.check()?;
            Ok((drawn, pixels, frame_ms, stages_ms))
        });
        let inspected = drawn.and_then(|drawn| Ok((drawn, inspect(executor, &frame)?)));
        executor.watch(&Monitor::default());
        let ((drawn, pixels, frame_ms, stages_ms), seen) = match inspected {
            Ok(done) => done,
            Err(error) => {
                self.frames.unfinished(frame);
                return Err(error);
            }
        };
        progress.finished();
        let mut stats = FrameStats { frame_ms, stages_ms, pixels: drawn.counts, ..FrameStats::default() };
        if keep.counters {
            (stats.rays, stats.work) = (Some(drawn.sums.rays()), Some(drawn.sums.work()));
            stats.work_by_class = Some(drawn.sums.work_by_class);
            stats.failed_tests = (options.mode == Mode::Adaptive).then_some(drawn.sums.failed_tests);
        }
        let stays_on_device = plan.is_one_band() && keep.any_plane();
        self.frames.finished(frame, keep, (!stays_on_device).then_some(drawn.collected));
        Ok((Frame { width: options.width, height: options.height, pixels, stats }, seen))
    }

    /// What the device, its profile and the memory budget leave for a frame's buffers, and what these must hold.
    fn frame_budget(&self, options: &RenderOptions, keep: Keep) -> FrameBudget {
        let limits = self.executor.memory_limits();
        let scene_bytes = self.prepared.bytes() + SMALL_BUFFERS_BYTES;
        let budget = self.memory_budget_bytes.unwrap_or(DEFAULT_BUDGET_BYTES).min(usize::MAX as u64 / 2);
        FrameBudget {
            total_bytes: budget.min(limits.total_bytes),
            allocation_bytes: limits.allocation_bytes,
            scene_bytes,
            attributes: keep.attributes() || options.mode == Mode::Adaptive,
            counters: keep.counters,
            scan_group: self.executor.scan_group(),
        }
    }

    /// An attribute plane (`PLANE_*`) of the frame that was finished last, row-major, one word a sample. Reading cannot be
    /// cancelled.
    ///
    /// # Errors
    /// No frame, or one that did not keep this plane; a failing call.
    #[doc(hidden)]
    pub fn plane(&mut self, plane: u32) -> Result<Vec<u32>> {
        self.kept_plane(plane, "attributes")
    }

    /// A counter plane (`COUNTER_*`) of the frame that was finished last, row-major, one word a sample. Reading cannot be
    /// cancelled.
    ///
    /// # Errors
    /// No frame, or one that did not keep this counter; a failing call.
    #[doc(hidden)]
    pub fn counter_plane(&mut self, plane: u32) -> Result<Vec<u32>> {
        self.kept_plane(PLANE_COUNT + plane, "counters")
    }

    fn kept_plane(&mut self, plane: u32, what: &'static str) -> Result<Vec<u32>> {
        let words = self.frames.plane(self.executor.as_mut(), plane)?;
        words.ok_or(Error::MissingPlane { plane: what })
    }

    /// The scene that frames are drawn from.
    pub fn scene(&self) -> &Arc<PreparedScene> {
        &self.prepared
    }

    /// The scene's name.
    pub fn name(&self) -> &str {
        self.prepared.name()
    }

    /// The view that frames are drawn from.
    pub fn view(&self) -> &View {
        &self.view
    }

    /// Moves the camera, changes lights (as many as a scene may have) or environment, for the frames that follow.
    /// Positions are relative to [`PreparedScene::origin`].
    ///
    /// # Errors
    /// As for [`View::validate`]; the view then stays.
    pub fn set_view(&mut self, view: View) -> Result<()> {
        view.validate()?;
        self.view = view;
        Ok(())
    }

    /// Number of triangles.
    pub fn triangle_count(&self) -> usize {
        self.prepared.triangle_count()
    }

    /// Statistics of the kd-tree.
    pub fn tree_statistics(&self) -> KdStatistics {
        self.prepared.tree().statistics()
    }

    /// What draws.
    pub fn info(&self) -> ExecutorInfo {
        self.executor.info()
    }

    /// How long it took to make ready; program builds so far included, `load_ms` left 0.
    pub fn build_times(&self) -> BuildTimes {
        BuildTimes {
            load_ms: 0.0,
            kdtree_ms: self.prepared.kdtree_ms(),
            upload_ms: self.upload_ms,
            program_ms: self.executor.program_ms(),
        }
    }

    /// Who watches the next frames: a cancelled monitor must be replaced before there can be any.
    pub fn set_monitor(&mut self, monitor: &Monitor) {
        self.monitor = monitor.clone();
    }

    /// Who watches.
    pub fn monitor(&self) -> &Monitor {
        &self.monitor
    }

    /// Why the device, or the build of kernels, that would have come first does not draw: an error for each that was passed
    /// over. Empty if the first choice draws. [`Error::DriverCrashed`] among them is what
    /// [`DeviceOptions::retry_crashed`] is for.
    pub fn passed_over(&self) -> &[Error] {
        &self.passed_over
    }

    /// Things a user should know about the device, one sentence each: why it was chosen, when it was lost.
    pub fn notices(&self) -> &[String] {
        &self.notices
    }

    /// Most bytes of device memory in use so far.
    pub fn peak_device_bytes(&self) -> u64 {
        self.executor.peak_bytes()
    }

    /// The parameters of the frame drawn last and `work` on a queue of its launches, if its planes are on the device: for
    /// tests that launch single kernels.
    #[doc(hidden)]
    pub fn on_last_frame<T>(&mut self, work: impl FnOnce(&FrameParams, &mut Queue) -> T) -> Option<T> {
        let (scene, frame) = (self.scene.as_ref()?, self.frames.last_mut()?);
        let params = *frame.params();
        let mut hooks: [&mut dyn Hook; 0] = [];
        let mut queue = Queue::new(self.executor.as_mut(), scene, frame, &mut hooks);
        Some(work(&params, &mut queue))
    }
}

/// What draws, and how it came to that.
struct Opened {
    executor: Box<dyn Executor>,
    careful: bool,
    is_opencl: bool,
}

impl Opened {
    fn on_cpu(executor: impl Executor + 'static) -> Self {
        Opened { executor: Box::new(executor), careful: false, is_opencl: false }
    }

    /// What a user should know about it.
    fn notice(&self, passed_over: &[Error]) -> Option<String> {
        let first = passed_over.first()?;
        Some(match (self.is_opencl, self.careful) {
            (false, _) => format!("drawing on the CPU: {first}"),
            (true, true) => format!("drawing with kernels that are built with care, which may be slower: {first}"),
            (true, false) => format!("drawing on {}: {first}", self.executor.info().name),
        })
    }
}

/// The executor that `options` ask for, tested if nobody has tested it yet. Why others were not taken goes to
/// `passed_over`.
fn open_executor(
    scene: &PreparedScene,
    options: &DeviceOptions,
    passed_over: &mut Vec<Error>,
    monitor: &Monitor,
) -> Result<Opened> {
    let (first, is_auto) = match options.device {
        DeviceChoice::Cpu => {
            let engine = options.cpu_width.and_then(CpuExecutor::of_width).unwrap_or_default();
            return Ok(Opened::on_cpu(engine));
        }
        DeviceChoice::Twin => return Ok(Opened::on_cpu(TwinExecutor::default())),
        DeviceChoice::Auto => (0, true),
        DeviceChoice::OpenCl(index) => (index.unwrap_or(0), false),
    };
    // Software that compiles kernels for the CPU is slower than the engine. What only OpenCL can do is another matter.
    let is_for_opencl = options.profile.is_some() || options.mutation.is_some() || options.bounds_checks;
    let prefers_engine = |index: usize| {
        CpuExecutor::has_lanes()
            && !is_for_opencl
            && devices(options).devices.get(index).is_some_and(|device| device.kind == "cpu")
    };
    if is_auto && prefers_engine(first) {
        return Ok(Opened::on_cpu(CpuExecutor::default()));
    }
    let mut index = first;
    loop {
        for careful in [false, true] {
            let tested = open_number(options, Some(index), careful).and_then(|mut device| {
                device.watch(monitor);
                quick::check(&mut device, scene.shading(), options.profile.as_ref())?;
                Ok(device)
            });
            // A compiler that Ctrl-C ended, for one, is no reason to draw elsewhere.
            monitor.check()?;
            match tested {
                Ok(device) => return Ok(Opened { executor: Box::new(device), careful, is_opencl: true }),
                Err(error @ (Error::SelfTest { .. } | Error::KernelBuild { .. })) => passed_over.push(error),
                // Another build of the same might end the process once more.
                Err(error @ (Error::DriverCrashed { .. } | Error::NoOpenCl { .. })) if is_auto => {
                    passed_over.push(error);
                    break;
                }
                Err(error) => return Err(error),
            }
        }
        if !is_auto {
            // The usual build says more.
            return Err(passed_over.swap_remove(0));
        }
        index += 1;
        // As software, the engine is as good as another device.
        let is_next = devices(options).devices.get(index).is_some_and(|device| device.kind != "cpu");
        if !is_next {
            return Ok(Opened::on_cpu(CpuExecutor::default()));
        }
    }
}
