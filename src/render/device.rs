// SPDX-License-Identifier: MIT OR Apache-2.0
//! The device behind a renderer: opened, tested, and opened again when it was lost.

use std::sync::Arc;

use super::renderer::{DeviceChoice, RendererOptions};
use crate::device::backend::Backend;
use crate::device::opencl::executor::OpenClBackend;
use crate::device::opencl::{self, OpenOptions, codes};
use crate::device::twin::executor::TwinBackend;
use crate::error::{Error, Result};
use crate::monitor::Monitor;
use crate::prepare::scene_buffers::SceneBuffers;
use crate::selftest::quick;

/// What draws.
pub(super) enum Device {
    Twin(Box<TwinBackend>),
    OpenCl(Box<OpenClBackend>),
}

impl Device {
    /// The device that `options` ask for. What a user should know about the choice goes to `notices`.
    pub fn open(
        buffers: &Arc<SceneBuffers>,
        options: &RendererOptions,
        notices: &mut Vec<String>,
        monitor: &Monitor,
    ) -> Result<Device> {
        let twin = || Device::Twin(Box::new(TwinBackend::new(Arc::clone(buffers))));
        let tested = || {
            let mut opened = open_opencl(buffers, options, monitor)?;
            if let Some(backend) = &mut opened {
                quick::check(backend, options.profile.as_ref())?;
                backend.watch(&Monitor::default());
            }
            Ok(opened)
        };
        match tested() {
            // A compiler that Ctrl-C ended, for one, is no reason to draw elsewhere.
            Err(_) if monitor.check().is_err() => Err(Error::Cancelled),
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

    pub fn backend(&mut self) -> &mut dyn Backend {
        match self {
            Device::Twin(twin) => twin.as_mut(),
            Device::OpenCl(device) => device.as_mut(),
        }
    }

    /// Does `work`. If the device is lost on the way, opens it again and does `work` once more; if it is lost again,
    /// that is the error, and the next call opens it anew.
    pub fn working<T>(
        &mut self,
        monitor: &Monitor,
        notices: &mut Vec<String>,
        mut work: impl FnMut(&mut dyn Backend) -> Result<T>,
    ) -> Result<T> {
        let device = match self {
            Device::Twin(twin) => return work(twin.as_mut()),
            Device::OpenCl(device) => device.as_mut(),
        };
        if device.is_lost() {
            open_again(device, monitor)?;
        }
        let lost = match work(device) {
            Err(_) if monitor.check().is_err() => return Err(Error::Cancelled),
            Err(error) if codes::is_loss(&error) => error,
            done => return done,
        };
        log::warn!("{}: {lost}", describe(device));
        open_again(device, monitor)?;
        let slices = device.door().slice_ms().map_or("whole".into(), |ms| format!("of {ms:.1} ms"));
        notices.push(format!("{} was lost ({lost}) and opened again; launches are {slices} now", describe(device)));
        work(device).map_err(|error| if codes::is_loss(&error) { given_up(device, &error) } else { error })
    }
}

fn open_again(device: &mut OpenClBackend, monitor: &Monitor) -> Result<()> {
    device.watch(monitor);
    let reopened = device.reopen();
    device.watch(&Monitor::default());
    reopened.map_err(|error| match error {
        Error::Cancelled => error,
        error => given_up(device, &error),
    })
}

fn given_up(device: &mut OpenClBackend, error: &Error) -> Error {
    device.give_up();
    Error::DeviceLost { device: describe(device), cause: error.to_string() }
}

fn describe(device: &OpenClBackend) -> String {
    let info = device.info();
    format!("{}, {}", info.name, info.version)
}

/// The OpenCL back end that `options` ask for; `None` if they ask for the CPU twin. `monitor` watches it from then on.
pub(crate) fn open_opencl(
    buffers: &Arc<SceneBuffers>,
    options: &RendererOptions,
    monitor: &Monitor,
) -> Result<Option<OpenClBackend>> {
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
    let mut backend = OpenClBackend::watched(opencl::open_with(&open)?, buffers, options.strict, monitor)?;
    backend.mutate(options.mutation.clone());
    Ok(Some(backend))
}
