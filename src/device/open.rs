// SPDX-License-Identifier: MIT OR Apache-2.0
//! Which device is wanted, under which limits, and opening it.

use super::kernels::Mutation;
use super::opencl::executor::OpenClExecutor;
use super::opencl::{self, CacheFolder, Faults, OpenOptions};
use super::profiles::Profile;
use crate::error::Result;

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
    /// Where compiled programs and verdicts of self-tests are kept.
    pub cache: CacheFolder,
    /// Kernels broken on purpose, for tests and the self-test's negative control.
    #[doc(hidden)]
    pub mutation: Option<Mutation>,
    /// For tests: when the OpenCL device is lost.
    #[doc(hidden)]
    pub faults: Faults,
}

/// The OpenCL device that `options` ask for; `None` if they ask for the CPU twin.
///
/// # Errors
/// [`crate::Error::NoOpenCl`] with everything that was tried; a number that no device has; a failing call.
pub fn open_opencl(options: &DeviceOptions) -> Result<Option<OpenClExecutor>> {
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
        faults: options.faults.clone(),
        ..OpenOptions::default()
    };
    Ok(Some(OpenClExecutor::new(opencl::open_with(&open)?, options.strict, options.mutation.clone())))
}
