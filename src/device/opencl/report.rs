// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the search for OpenCL came to, as plain data for an app: which libraries were tried, which devices there are.

use super::context::OpenOptions;
use super::discover::{DeviceKind, discover_guarded};
use super::library;
use super::markers::Markers;

/// What was found when OpenCL was looked for, and what was not.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct DeviceReport {
    /// The OpenCL library in use, a path or a name. `None`: there is none, and the CPU draws.
    pub library: Option<String>,
    /// The libraries that were tried before it, in order.
    pub refused: Vec<RefusedLibrary>,
    /// Devices that can draw, best first: the place of one is its number in
    /// [`DeviceChoice::OpenCl`](crate::DeviceChoice::OpenCl).
    pub devices: Vec<DeviceSummary>,
    /// Platforms and devices that cannot draw, each with the reason, and why nothing was asked, if so.
    pub skipped: Vec<String>,
}

/// A library that was tried and does not do.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RefusedLibrary {
    /// Path or name.
    pub path: String,
    /// What the system's loader said, or what the library lacks.
    pub reason: String,
}

/// An OpenCL device.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DeviceSummary {
    /// Its name.
    pub name: String,
    /// Its OpenCL version, in the driver's words.
    pub version: String,
    /// The driver's version; on phones it often names the compiler's.
    pub driver: String,
    /// The platform that it belongs to.
    pub platform: String,
    /// `gpu`, `cpu` or `other`.
    pub kind: &'static str,
    /// All that it says of its limits, as JSON in the format of profiles: a file with this text is one.
    pub profile: String,
}

/// Looks for OpenCL as opening a device with `options` does, and opens none.
pub fn report(options: &OpenOptions) -> DeviceReport {
    let markers = Markers::of_search(&options.cache, options.retry_crashed);
    let found = match discover_guarded(options.library.as_deref(), &markers) {
        Ok(found) => found,
        // The library is not even loaded.
        Err(error) => return DeviceReport { skipped: vec![error.to_string()], ..DeviceReport::default() },
    };
    let search = library::find(options.library.as_deref());
    let refused = search.refused.iter().map(|(path, reason)| (path.clone(), reason.clone()));
    let devices = found.devices.iter().map(|device| DeviceSummary {
        name: device.info.name.clone(),
        version: device.info.version.clone(),
        driver: device.info.driver.clone(),
        platform: device.info.platform.clone(),
        kind: match device.info.kind {
            DeviceKind::Gpu => "gpu",
            DeviceKind::Cpu => "cpu",
            DeviceKind::Other => "other",
        },
        // Texts and numbers alone, which JSON can say.
        profile: serde_json::to_string_pretty(&device.profile).unwrap_or_default(),
    });
    DeviceReport {
        library: search.accepted.clone(),
        refused: refused.map(|(path, reason)| RefusedLibrary { path, reason }).collect(),
        devices: devices.collect(),
        // Without a library these are the refusals once more.
        skipped: if search.accepted.is_some() { found.skipped } else { Vec::new() },
    }
}
