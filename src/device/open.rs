// SPDX-License-Identifier: MIT OR Apache-2.0
//! Which device is wanted, under which limits, and opening it.

use std::path::PathBuf;

use super::cpu::Width;
use super::kernels::Mutation;
use super::opencl::executor::OpenClExecutor;
use super::opencl::{self, CacheFolder, Faults, OpenOptions};
use super::profiles::Profile;
use crate::error::Result;

pub use super::opencl::{DeviceReport, DeviceSummary, RefusedLibrary};

/// Which device draws.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DeviceChoice {
    /// The first usable OpenCL device that is not a CPU; else the wide engine on the CPU; where that has no lanes, whatever
    /// OpenCL device there is. Under a profile, which only OpenCL obeys, the first OpenCL device of any type.
    #[default]
    Auto,
    /// The wide engine: packets of rays on the CPU's cores.
    Cpu,
    /// The twin: plain scalar code on the CPU's cores, slower, with the same pictures.
    Twin,
    /// An OpenCL device: the first usable one, or the one of this index in `rarefy devices`.
    OpenCl(Option<usize>),
}

/// How to open a device.
#[derive(Debug, Clone, Default)]
pub struct DeviceOptions {
    /// Which device draws.
    pub device: DeviceChoice,
    /// The profile whose limits the OpenCL device is held to.
    pub profile: Option<Profile>,
    /// Kernels that equal the CPU twin bit for bit, instead of the device's fastest.
    pub strict: bool,
    /// Most device memory, in bytes.
    pub memory_budget_bytes: Option<u64>,
    /// Where compiled programs and what is known of drivers are kept. An app gives a folder in its own cache
    /// ([`CacheFolder::At`]), without which a driver that crashed is tried again at every start.
    pub cache: CacheFolder,
    /// An OpenCL library to try before all others. The library is chosen once in a process, by whoever opens a device or
    /// asks [`crate::devices`] first.
    pub opencl_library: Option<PathBuf>,
    /// Does again what ended the process at an earlier start ([`crate::Error::DriverCrashed`]), and builds again what did
    /// not build. For a user who asks for it, or after a system update.
    pub retry_crashed: bool,
    /// Kernels broken on purpose, for tests and the self-test's negative control.
    #[doc(hidden)]
    pub mutation: Option<Mutation>,
    /// For tests: kernels with bounds checks on an OpenCL device; an access beyond a buffer is an error.
    #[doc(hidden)]
    pub bounds_checks: bool,
    /// For benchmarks: the lanes of the wide engine under [`DeviceChoice::Cpu`], where the processor has them; its widest
    /// ones otherwise.
    #[doc(hidden)]
    pub cpu_width: Option<Width>,
    /// For tests: when the OpenCL device is lost.
    #[doc(hidden)]
    pub faults: Faults,
}

/// What there is to draw with: OpenCL libraries that were tried, devices and what was passed over. Nothing is opened, and
/// nothing fails.
pub fn devices(options: &DeviceOptions) -> DeviceReport {
    opencl::report(&open_options(options, None, false))
}

fn open_options(options: &DeviceOptions, index: Option<usize>, careful: bool) -> OpenOptions {
    OpenOptions {
        index,
        profile: options.profile.clone(),
        library: options.opencl_library.clone(),
        memory_budget_bytes: options.memory_budget_bytes,
        cache: options.cache.clone(),
        retry_crashed: options.retry_crashed,
        careful,
        slice_items: None,
        faults: options.faults.clone(),
    }
}

/// The OpenCL device of number `index`, with the usual or the careful build of kernels.
///
/// # Errors
/// As for [`open_opencl`].
pub(crate) fn open_number(options: &DeviceOptions, index: Option<usize>, careful: bool) -> Result<OpenClExecutor> {
    let context = opencl::open_with(&open_options(options, index, careful))?;
    let mut executor = OpenClExecutor::new(context, options.strict, options.mutation.clone());
    if options.bounds_checks {
        executor.check_bounds(None)?;
    }
    Ok(executor)
}

/// The OpenCL device that `options` ask for; `None` if they ask for the CPU.
///
/// # Errors
/// [`crate::Error::NoOpenCl`] with everything that was tried; a number that no device has; a failing call.
pub fn open_opencl(options: &DeviceOptions) -> Result<Option<OpenClExecutor>> {
    let index = match options.device {
        DeviceChoice::Cpu | DeviceChoice::Twin => return Ok(None),
        DeviceChoice::Auto => None,
        DeviceChoice::OpenCl(index) => index,
    };
    open_number(options, index, false).map(Some)
}
