// SPDX-License-Identifier: MIT OR Apache-2.0
//! One opened device: context, queue, limits, memory accounts.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use opencl3::command_queue::{CL_QUEUE_PROFILING_ENABLE, create_command_queue, finish};
use opencl3::context::context::create_context;

use super::cache::{Cache, CacheFolder};
use super::codes::{self, check};
use super::discover::{DeviceInfo, DeviceKind, discover_guarded};
use super::faults::Faults;
use super::handle::Handle;
use super::limits::Limits;
use super::markers::Markers;
use super::slices::Planner;
use super::timing::{Timing, Wait};
use crate::device::profiles::{Choices, Profile};
use crate::error::{Remedy, Setting};
use crate::monitor::Monitor;
use crate::{Error, Result};

/// How long after a failed build a cancel may still arrive.
const CANCEL_ARRIVES: Duration = Duration::from_millis(100);

/// How to open a device.
#[derive(Debug, Clone, Default)]
pub struct OpenOptions {
    /// Which device, in the order of [`super::Discovery::devices`]; `None`: the first.
    pub index: Option<usize>,
    /// The profile to obey; `None`: only the device's own limits.
    pub profile: Option<Profile>,
    /// An OpenCL library to try before all others. Only the first search of a process can choose.
    pub library: Option<PathBuf>,
    /// The most memory that buffers may use together, in bytes.
    pub memory_budget_bytes: Option<u64>,
    /// Where compiled programs and what is known of drivers are kept.
    pub cache: CacheFolder,
    /// Do again what ended the process at an earlier start, and build again what did not build.
    pub retry_crashed: bool,
    /// Programs without the compiler's optimisation and small work-groups, where the usual ones do not do.
    pub careful: bool,
    /// For tests: the most work-items of every slice.
    pub slice_items: Option<u64>,
    /// For tests: when the device is lost.
    pub faults: Faults,
}

/// The memory that a context's buffers use, in bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct MemoryUse {
    /// Now.
    pub current_bytes: u64,
    /// The most at any time.
    pub peak_bytes: u64,
}

/// What buffers, programs and kernels keep alive.
pub(super) struct Shared {
    // Fields drop in this order: queue before context.
    pub queue: Handle,
    pub context: Handle,
    pub device: super::discover::DeviceId,
    pub info: DeviceInfo,
    pub limits: Limits,
    budget_bytes: Option<u64>,
    memory: Mutex<MemoryUse>,
}

impl Shared {
    /// Counts `bytes` more, if the limits allow it.
    pub fn reserve(&self, what: &str, bytes: u64) -> Result<()> {
        let mut memory = lock(&self.memory);
        self.limits.check_total(what, memory.current_bytes, bytes)?;
        let total = memory.current_bytes.saturating_add(bytes);
        if let Some(budget) = self.budget_bytes.filter(|&budget| total > budget) {
            return Err(Error::LimitExceeded {
                what: format!("{what}, with {} bytes in use", memory.current_bytes),
                limit: Setting::MemoryBudget.path().into(),
                wanted: format!("{total} bytes"),
                allowed: format!("{budget} bytes"),
                remedies: &[Remedy::LargerBudget, Remedy::SmallerPicture, Remedy::SmallerScene],
            });
        }
        memory.current_bytes = total;
        memory.peak_bytes = memory.peak_bytes.max(total);
        Ok(())
    }

    /// Counts `bytes` less.
    pub fn release(&self, bytes: u64) {
        let mut memory = lock(&self.memory);
        memory.current_bytes = memory.current_bytes.saturating_sub(bytes);
    }
}

/// What changes with each launch.
pub(super) struct State {
    pub planner: Planner,
    pub timing: Timing,
    pub enqueues: u64,
    pub monitor: Monitor,
    /// By a fault: nothing works any more.
    pub lost: bool,
}

/// An opened OpenCL device: the only way to memory, programs and launches.
///
/// All commands go through one in-order queue, so that each sees what those before it wrote. A context may be used from
/// several threads; launches take turns.
pub struct Context {
    pub(super) shared: Arc<Shared>,
    pub(super) cache: Cache,
    pub(super) verdicts: Cache,
    pub(super) failures: Cache,
    pub(super) markers: Markers,
    pub(super) state: Mutex<State>,
    choices: Choices,
    options: OpenOptions,
    /// How often the device was opened again.
    reopened: u32,
}

/// Slices are not made shorter than this when a device was lost, in milliseconds.
const LEAST_SLICE_MS: f64 = 1.0;

/// Locks, even after a panic in another thread: all state behind these locks is valid at any time.
pub(super) fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Opens a device: number `index` of those discovered, else the best, under a profile's limits if one is given.
///
/// Without a usable device the error is [`Error::NoOpenCl`] and lists everything that was tried.
pub fn open(index: Option<usize>, profile: Option<&Profile>) -> Result<Context> {
    open_with(&OpenOptions { index, profile: profile.cloned(), ..OpenOptions::default() })
}

/// As [`open`], with all options.
pub fn open_with(options: &OpenOptions) -> Result<Context> {
    open_again(options, 0)
}

/// Opens a device for the `reopened`th time again; slices are halved each time.
fn open_again(options: &OpenOptions, reopened: u32) -> Result<Context> {
    let search = Markers::of_search(&options.cache, options.retry_crashed);
    let mut found = discover_guarded(options.library.as_deref(), &search)?;
    let count = found.devices.len();
    if count == 0 {
        return Err(Error::NoOpenCl { tried: found.skipped });
    }
    let index = options.index.unwrap_or(0);
    if index >= count {
        let names: Vec<String> =
            found.devices.iter().enumerate().map(|(n, device)| format!("opencl:{n} ({})", device.info.name)).collect();
        return Err(Error::option(Setting::Device, format!("opencl:{index}"), names.join(", ")));
    }
    let device = found.devices.swap_remove(index);
    let limits = Limits::new(&device.profile, options.profile.as_ref());
    let raw_context = create_context(&[device.id.0], std::ptr::null(), None, std::ptr::null_mut());
    let context = Handle::context(check("clCreateContext", raw_context)?);
    // SAFETY: context and device are valid and belong together. The call of OpenCL 1.2: later ones are missing on the
    // phones that this library is for.
    let raw_queue = unsafe { create_command_queue(context.raw(), device.id.0, CL_QUEUE_PROFILING_ENABLE) };
    let queue = Handle::queue(check("clCreateCommandQueue", raw_queue)?);
    log::info!("OpenCL device: {}", device.info.describe());
    // A simulator's times say nothing about any watchdog.
    let watchdog_ms = limits.watchdog_ms.filter(|_| !device.info.is_simulator());
    let sliced = options.profile.is_some() || !device.info.is_simulator();
    let slice_ms = limits
        .slice_ms
        .filter(|_| sliced)
        .map(|ms| (ms * 0.5f64.powi(reopened.min(64) as i32)).max(LEAST_SLICE_MS.min(ms)));
    let slice_items = options.slice_items.map(|items| (items >> reopened.min(63)).max(1));
    let state = State {
        planner: Planner::new(slice_ms, slice_items),
        timing: Timing::new(watchdog_ms),
        enqueues: 0,
        monitor: Monitor::default(),
        lost: false,
    };
    // PoCL has a cache of its own, unless the variable says otherwise.
    let pocl_caches = std::env::var_os("POCL_KERNEL_CACHE").is_none_or(|value| value != "0");
    let driver_caches = device.info.platform.contains("Portable Computing Language") && pocl_caches;
    let choices = options.profile.as_ref().unwrap_or(&device.profile).choices().clone();
    Ok(Context {
        shared: Arc::new(Shared {
            queue,
            context,
            device: device.id,
            info: device.info,
            limits,
            budget_bytes: options.memory_budget_bytes,
            memory: Mutex::new(MemoryUse::default()),
        }),
        cache: Cache::programs(&options.cache, driver_caches),
        verdicts: Cache::verdicts(&options.cache),
        failures: Cache::failures(&options.cache, driver_caches),
        markers: Markers::new(options.cache.of_programs(driver_caches), options.retry_crashed),
        state: Mutex::new(state),
        choices,
        options: options.clone(),
        reopened,
    })
}

impl State {
    /// Goes on unless the work is to end; then waits for what is in flight.
    pub fn check_monitor(&mut self) -> Result<()> {
        let checked = self.monitor.check();
        if checked.is_err() {
            // Nobody is interested in how it ended.
            let _ = self.timing.harvest(&mut self.planner, Wait::ForAll);
        }
        checked
    }
}

impl Context {
    /// Whether programs are built without optimisation, for work-groups that are small.
    pub fn is_careful(&self) -> bool {
        self.options.careful
    }

    /// Whether what failed or crashed before is done again.
    pub(super) fn retries(&self) -> bool {
        self.options.retry_crashed
    }

    /// Who the device is.
    pub fn info(&self) -> &DeviceInfo {
        &self.shared.info
    }

    /// What may be asked of it: its own limits, clamped by the profile.
    pub fn limits(&self) -> &Limits {
        &self.shared.limits
    }

    /// What suits it: the profile's choices, else those for its type of device.
    pub fn choices(&self) -> &Choices {
        &self.choices
    }

    /// The profile that it obeys, if any.
    pub fn profile_name(&self) -> Option<&str> {
        self.options.profile.as_ref().map(Profile::name)
    }

    /// Whether the device is the host's processor.
    pub fn is_cpu(&self) -> bool {
        self.shared.info.kind == DeviceKind::Cpu
    }

    /// The memory that the context's buffers use.
    pub fn memory(&self) -> MemoryUse {
        *lock(&self.shared.memory)
    }

    /// Lets the peak start again from what is in use now.
    pub fn reset_peak_memory(&self) {
        let mut memory = lock(&self.shared.memory);
        memory.peak_bytes = memory.current_bytes;
    }

    /// When the device is to be lost.
    pub(super) fn faults(&self) -> &Faults {
        &self.options.faults
    }

    /// Opens the same device once more, after it was lost: a new context, slices of half the time. Everything made on
    /// this context stays useless.
    pub(crate) fn reopen(&self) -> Result<Context> {
        open_again(&self.options, self.reopened + 1)
    }

    /// The duration that slices aim at, in milliseconds; `None`: whole launches.
    pub fn slice_ms(&self) -> Option<f64> {
        lock(&self.state).planner.target_ms()
    }

    /// From here on `monitor` watches launches and transfers: it is told how far a launch is, and ends it between two
    /// slices. What is in flight then is waited for.
    pub fn watch(&self, monitor: &Monitor) {
        lock(&self.state).monitor = monitor.clone();
    }

    /// Goes on unless the device was lost by a fault, or the work is to end.
    pub(super) fn check_watch(&self, call: &str) -> Result<()> {
        let state = &mut *lock(&self.state);
        if state.lost {
            return Err(codes::error(call, codes::INVALID_COMMAND_QUEUE));
        }
        state.check_monitor()
    }

    /// The error of a failed build, or [`Error::Cancelled`] if the work is to end. Ctrl-C in a terminal reaches the
    /// compiler's own processes as well, and may do so before it reaches the token, which is therefore given a moment.
    pub(super) fn unless_cancelled(&self, error: Error) -> Error {
        let monitor = lock(&self.state).monitor.clone();
        let failed = Instant::now();
        loop {
            match monitor.check() {
                Err(cancelled) => return cancelled,
                Ok(()) if failed.elapsed() >= CANCEL_ARRIVES => return error,
                Ok(()) => std::thread::sleep(Duration::from_millis(5)),
            }
        }
    }

    /// Waits for everything enqueued. A launch that failed on the device is an error here.
    pub fn finish(&self) -> Result<()> {
        let finished = check("clFinish", finish(self.shared.queue.raw()));
        let state = &mut *lock(&self.state);
        let harvested = state.timing.harvest(&mut state.planner, Wait::ForAll);
        if state.lost {
            return Err(codes::error("clFinish", codes::INVALID_COMMAND_QUEUE));
        }
        // What failed first explains more than the queue's own answer.
        harvested.and(finished)
    }

    /// Waits for everything enqueued and returns the milliseconds on the device per launch label since the last call,
    /// in the order of first use.
    pub fn take_timings(&self) -> Result<Vec<(&'static str, f64)>> {
        self.finish()?;
        Ok(lock(&self.state).timing.take())
    }

    /// Forgets what launches so far took and how much memory they had: after a self-test, whose launches are not typical.
    pub(crate) fn start_afresh(&self) -> Result<()> {
        self.take_timings()?;
        self.reset_peak_memory();
        lock(&self.state).planner.forget();
        Ok(())
    }

    /// The number of enqueued launches (slices) since the context was opened.
    pub fn enqueues(&self) -> u64 {
        lock(&self.state).enqueues
    }
}

impl std::fmt::Debug for Context {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "OpenCL context on {}", self.shared.info.describe())
    }
}
