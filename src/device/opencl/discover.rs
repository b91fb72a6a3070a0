// SPDX-License-Identifier: MIT OR Apache-2.0
//! What OpenCL devices there are, which of them can run the kernels, and in what order to prefer them.

use std::ffi::c_void;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use opencl3::device::{CL_DEVICE_EXTENSIONS, CL_DEVICE_TYPE_ALL, CL_DEVICE_VERSION, get_device_data, get_device_ids};
use opencl3::platform::platform::{
    CL_PLATFORM_EXTENSIONS, CL_PLATFORM_NAME, CL_PLATFORM_PROFILE, CL_PLATFORM_VENDOR, CL_PLATFORM_VERSION,
    get_platform_data, get_platform_ids,
};
use serde::Serialize;
use serde_json::Value;

use super::cache::Key;
use super::limits::{Limits, parse_version};
use super::markers::Markers;
use super::{codes, library};
use crate::Result;
use crate::device::profiles::{Certainty, Choices, Entry, Profile};
use crate::device::queries::{Kind, QUERIES, Query};

/// The type of a device, as far as choices depend on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DeviceKind {
    /// A graphics processor.
    Gpu,
    /// The host's processor, software renderers and simulators included.
    Cpu,
    /// Anything else.
    Other,
}

/// Who a device is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DeviceInfo {
    /// `CL_DEVICE_NAME`.
    pub name: String,
    /// `CL_DEVICE_VERSION`.
    pub version: String,
    /// `CL_DRIVER_VERSION`.
    pub driver: String,
    /// `CL_PLATFORM_NAME`.
    pub platform: String,
    /// The type of the device.
    pub kind: DeviceKind,
}

impl DeviceInfo {
    /// One line for error messages: name, version, driver.
    pub fn describe(&self) -> String {
        format!("{} ({}, driver {})", self.name, self.version, self.driver)
    }

    /// Whether the device is a simulator, whose times mean nothing.
    pub fn is_simulator(&self) -> bool {
        self.platform.to_ascii_lowercase().contains("oclgrind")
    }
}

/// A device that can run the kernels.
#[derive(Debug, Clone)]
pub struct DeviceFound {
    pub(crate) id: DeviceId,
    /// Who it is.
    pub info: DeviceInfo,
    /// Everything that it answered, as a profile.
    pub profile: Profile,
}

impl DeviceFound {
    /// What would be chosen for this device, or what `profile` chooses.
    pub fn choices<'a>(&'a self, profile: Option<&'a Profile>) -> &'a Choices {
        profile.unwrap_or(&self.profile).choices()
    }

    /// What the context would enforce on this device, under `profile` if given.
    pub fn limits(&self, profile: Option<&Profile>) -> Limits {
        Limits::new(&self.profile, profile)
    }
}

/// A raw device id.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DeviceId(pub *mut c_void);

// SAFETY: a root device's id is a name without state; it stays valid for the process, from any thread.
unsafe impl Send for DeviceId {}
// SAFETY: as above.
unsafe impl Sync for DeviceId {}

/// All devices, best first, and what was passed over.
#[derive(Debug, Clone)]
pub struct Discovery {
    /// Usable devices: GPUs, then CPUs, PoCL before other software. `opencl:N` counts in this order.
    pub devices: Vec<DeviceFound>,
    /// Libraries, platforms and devices that could not be used, each with the reason.
    pub skipped: Vec<String>,
}

impl Discovery {
    /// Devices with their limits and choices, in the format of profiles; what was skipped. For JSON.
    pub fn dump(&self) -> impl Serialize + '_ {
        #[derive(Serialize)]
        struct Dump<'a> {
            devices: Vec<&'a Profile>,
            skipped: &'a [String],
        }
        Dump { devices: self.devices.iter().map(|device| &device.profile).collect(), skipped: &self.skipped }
    }
}

/// Looks for every platform and device, with the library that the system has.
pub fn discover() -> Discovery {
    discover_with(None)
}

/// As [`discover_with`], with a note of it: a driver may end the process when it is asked who it is.
pub(super) fn discover_guarded(path: Option<&Path>, markers: &Markers) -> Result<Discovery> {
    let key = Key::new(&["discovery", &path.unwrap_or(Path::new("")).to_string_lossy(), env!("CARGO_PKG_VERSION")]);
    let marker = markers.guard(&key, "OpenCL", "loading the OpenCL library and asking for devices")?;
    let found = discover_with(path);
    drop(marker);
    Ok(found)
}

/// As [`discover`]; tries the library at `path` first. Only the first search of a process can choose the library.
pub(crate) fn discover_with(path: Option<&Path>) -> Discovery {
    // Drivers set their devices up at the first query; PoCL 3.1 crashes if another thread asks meanwhile.
    static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());
    let _guard = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
    let search = library::find(path);
    let mut skipped = Vec::new();
    let Some(accepted) = &search.accepted else {
        return Discovery { devices: Vec::new(), skipped: search.reasons() };
    };
    let platforms = match get_platform_ids() {
        Ok(platforms) => platforms,
        Err(codes::LIBRARY_NOT_LOADED) => {
            skipped.push(format!("{accepted}: the library cannot be loaded"));
            Vec::new()
        }
        // Some loaders answer "none" as an error.
        Err(-1001) => Vec::new(),
        Err(code) => {
            skipped.push(format!("{accepted}: clGetPlatformIDs failed: {} ({code})", codes::name(code)));
            Vec::new()
        }
    };
    if platforms.is_empty() && skipped.is_empty() {
        skipped.push(format!("{accepted}: no OpenCL platform is installed"));
    }
    let mut devices = Vec::new();
    for platform in platforms {
        let name = platform_text(platform, CL_PLATFORM_NAME);
        let found = match get_device_ids(platform, CL_DEVICE_TYPE_ALL) {
            Ok(found) => found,
            Err(code) => {
                skipped.push(format!("platform {name}: clGetDeviceIDs failed: {} ({code})", codes::name(code)));
                continue;
            }
        };
        if found.is_empty() {
            skipped.push(format!("platform {name}: has no devices"));
        }
        for id in found {
            let device = examine(platform, &name, id);
            match unfit(&device.profile) {
                None => devices.push(device),
                Some(reason) => skipped.push(format!("device {} of platform {name}: {reason}", device.info.name)),
            }
        }
    }
    // Stable, so that devices of one rank keep the platform's order.
    devices.sort_by_key(|device| rank(&device.info));
    Discovery { devices, skipped }
}

/// Less is better.
fn rank(info: &DeviceInfo) -> u32 {
    let platform = info.platform.to_ascii_lowercase();
    match info.kind {
        DeviceKind::Gpu => 0,
        DeviceKind::Other => 1,
        DeviceKind::Cpu if info.is_simulator() => 5,
        DeviceKind::Cpu if platform.contains("rusticl") || platform.contains("clover") => 4,
        DeviceKind::Cpu if platform.contains("portable computing language") => 2,
        DeviceKind::Cpu => 3,
    }
}

/// Why a device cannot run the kernels, if it cannot.
fn unfit(profile: &Profile) -> Option<String> {
    if profile.flag("cl_device_available") == Some(false) {
        return Some("is not available".into());
    }
    if profile.flag("cl_device_compiler_available") == Some(false) {
        return Some("has no compiler".into());
    }
    let version = profile.text("cl_device_version").unwrap_or_default();
    if parse_version(version).is_none_or(|version| version < (1, 2)) {
        return Some(format!("OpenCL 1.2 is needed, it has `{version}`"));
    }
    if profile.flag("cl_device_endian_little") == Some(false) {
        return Some("is big-endian".into());
    }
    if profile.words("cl_device_single_fp_config").is_none_or(|flags| flags.is_empty()) {
        return Some("has no 32-bit floats".into());
    }
    None
}

fn examine(platform: *mut c_void, platform_name: &str, id: *mut c_void) -> DeviceFound {
    let mut profile = Profile::empty("device", "");
    // Who it is comes first: some drivers end the process when they are asked what their version does not have.
    let words = |number| get_device_data(id, number).map(|bytes| text(&bytes)).unwrap_or_default();
    let (version, extensions) = (words(CL_DEVICE_VERSION), words(CL_DEVICE_EXTENSIONS));
    for query in QUERIES {
        let value = match query.device {
            Some(_) if !query.may_be_asked(parse_version(&version), &extensions) => None,
            Some(number) => get_device_data(id, number).ok().and_then(|bytes| decode(query, &bytes)),
            None => platform_value(platform, query.key),
        };
        profile.set(query.key, reported(value));
    }
    let text = |key: &str| profile.text(key).unwrap_or("unknown").to_string();
    let software = ["llvmpipe", "softpipe"].iter().any(|name| text("cl_device_name").contains(name));
    let kind = match profile.text("cl_device_type") {
        _ if software => DeviceKind::Cpu,
        Some("CL_DEVICE_TYPE_GPU") => DeviceKind::Gpu,
        Some("CL_DEVICE_TYPE_CPU") => DeviceKind::Cpu,
        _ if platform_name.contains("Oclgrind") => DeviceKind::Cpu,
        _ => DeviceKind::Other,
    };
    let info = DeviceInfo {
        name: text("cl_device_name"),
        version: text("cl_device_version"),
        driver: text("cl_driver_version"),
        platform: platform_name.to_string(),
        kind,
    };
    // A CPU has no watchdog, and its display does not wait for OpenCL, but whoever cancels does: there, enqueues are
    // cheap enough for shorter slices.
    let slice_ms = if kind == DeviceKind::Cpu { 5.0 } else { 25.0 };
    profile.set_choices(Choices::for_device(kind == DeviceKind::Gpu, Some(slice_ms)));
    profile.set_device(format!("{}, {platform_name}, {}", info.name, info.version));
    DeviceFound { id: DeviceId(id), info, profile }
}

fn reported(value: Option<Value>) -> Entry {
    match value {
        Some(value) => {
            Entry { value, certainty: Certainty::Reported, source: "asked of the device".into(), note: String::new() }
        }
        None => Entry {
            value: Value::Null,
            certainty: Certainty::NotFound,
            source: "the device does not answer this query".into(),
            note: String::new(),
        },
    }
}

fn platform_value(platform: *mut c_void, key: &str) -> Option<Value> {
    let number = match key {
        "cl_platform_name" => CL_PLATFORM_NAME,
        "cl_platform_vendor" => CL_PLATFORM_VENDOR,
        "cl_platform_version" => CL_PLATFORM_VERSION,
        "cl_platform_profile" => CL_PLATFORM_PROFILE,
        "cl_platform_extensions" => CL_PLATFORM_EXTENSIONS,
        // Queries of kernels: there is none to ask.
        _ => return None,
    };
    Some(platform_text(platform, number).into())
}

fn platform_text(platform: *mut c_void, number: u32) -> String {
    get_platform_data(platform, number).map(|bytes| text(&bytes)).unwrap_or_default()
}

/// A C string that a driver wrote: up to the first NUL, made printable.
pub(super) fn text(bytes: &[u8]) -> String {
    let end = bytes.iter().position(|&byte| byte == 0).unwrap_or(bytes.len());
    String::from_utf8_lossy(&bytes[..end]).trim().to_string()
}

/// A number of 4 or 8 bytes: which one depends on the query and, for `size_t`, on the ABI.
fn number(bytes: &[u8]) -> Option<u64> {
    if let Ok(bytes) = <[u8; 8]>::try_from(bytes) {
        return Some(u64::from_ne_bytes(bytes));
    }
    <[u8; 4]>::try_from(bytes).ok().map(|bytes| u32::from_ne_bytes(bytes).into())
}

fn decode(query: &Query, bytes: &[u8]) -> Option<Value> {
    match query.kind {
        Kind::Text => Some(text(bytes).into()),
        Kind::Words => Some(text(bytes).split_whitespace().collect::<Vec<_>>().into()),
        Kind::Count => number(bytes).map(Value::from),
        Kind::Size => number(bytes).filter(|&size| size > 0).map(Value::from),
        Kind::Flag => number(bytes).map(|flag| (flag != 0).into()),
        Kind::Sizes3 => {
            let sizes: Vec<u64> = bytes.chunks_exact(size_of::<usize>()).filter_map(number).take(3).collect();
            (sizes.len() == 3 && sizes.iter().all(|&size| size > 0)).then(|| sizes.into())
        }
        Kind::Bits(names) => number(bytes).map(|bits| {
            let set: Vec<&str> = names.iter().filter(|(_, bit)| bits & bit != 0).map(|(name, _)| *name).collect();
            if set.is_empty() { 0.into() } else { set.into() }
        }),
        // A device type may carry the DEFAULT bit besides.
        Kind::Choice(names) => number(bytes).and_then(|bits| {
            let exact = names.iter().find(|(_, value)| *value == bits);
            let name = exact.or_else(|| names.iter().find(|(_, value)| *value != 0 && bits & value != 0));
            name.map(|(name, _)| (*name).into())
        }),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn device(name: &str, platform: &str, kind: DeviceKind) -> DeviceInfo {
        DeviceInfo {
            name: name.into(),
            version: "OpenCL 1.2".into(),
            driver: "1".into(),
            platform: platform.into(),
            kind,
        }
    }

    #[test]
    fn gpus_come_first_and_simulators_last() {
        let mut devices = [
            device("sim", "Oclgrind", DeviceKind::Cpu),
            device("llvmpipe", "rusticl", DeviceKind::Cpu),
            device("pthread", "Portable Computing Language", DeviceKind::Cpu),
            device("Adreno", "QUALCOMM Snapdragon(TM)", DeviceKind::Gpu),
        ];
        devices.sort_by_key(rank);
        assert_eq!(devices.map(|device| device.name), ["Adreno", "pthread", "llvmpipe", "sim"]);
    }

    #[test]
    fn answers_of_drivers_are_decoded_with_care() {
        let key = |key: &str| Query::find(key).unwrap();
        let decode = |name: &str, bytes: &[u8]| decode(key(name), bytes);
        assert_eq!(decode("cl_device_name", b"Mali\0junk"), Some("Mali".into()));
        assert_eq!(decode("cl_device_name", &[0xff, b'x', 0]), Some("\u{fffd}x".into()));
        assert_eq!(decode("cl_device_max_work_group_size", &256u32.to_ne_bytes()), Some(256.into()));
        assert_eq!(decode("cl_device_max_work_group_size", &256u64.to_ne_bytes()), Some(256.into()));
        assert_eq!(decode("cl_device_max_work_group_size", &[1, 2, 3]), None);
        assert_eq!(decode("cl_device_max_work_group_size", &[]), None);
        assert_eq!(decode("cl_device_double_fp_config", &0u64.to_ne_bytes()), Some(0.into()));
        assert_eq!(decode("cl_device_type", &5u64.to_ne_bytes()), Some("CL_DEVICE_TYPE_GPU".into()));
        assert_eq!(decode("cl_device_max_work_item_sizes", &[0; 8]), None);
    }

    #[test]
    fn unfit_devices_are_named_with_the_reason() {
        let with = |key: &'static str, value: Value| {
            let mut profile = Profile::named("adreno-420").unwrap();
            profile.set(key, reported(Some(value)));
            unfit(&profile)
        };
        assert_eq!(unfit(&Profile::named("adreno-420").unwrap()), None);
        assert!(with("cl_device_version", "OpenCL 1.1 Mali-T760".into()).unwrap().contains("1.2 is needed"));
        assert!(with("cl_device_version", "Vulkan".into()).is_some());
        assert!(with("cl_device_compiler_available", false.into()).unwrap().contains("compiler"));
        assert!(with("cl_device_available", false.into()).is_some());
        assert!(with("cl_device_endian_little", false.into()).is_some());
        assert!(with("cl_device_single_fp_config", 0.into()).unwrap().contains("floats"));
    }
}
