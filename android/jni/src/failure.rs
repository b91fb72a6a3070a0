// SPDX-License-Identifier: MIT OR Apache-2.0
//! Why a native method failed, and what Java is told: a code, a place, a sentence.

use std::fmt;

use jni::objects::JThrowable;
use jni::refs::Global;
use rarefy::{Error, Setting};

/// Why a native method failed.
#[derive(Debug)]
pub enum Failure {
    /// The Rarefy library refused or failed.
    Rarefy(Error),
    /// A call into the Java VM failed.
    Jni(jni::errors::Error),
    /// A call that may not be made now.
    State(String),
    /// An argument that the library cannot take.
    Argument(String),
    /// A Bitmap or Surface that cannot be drawn into.
    Target(String),
    /// An app's own code failed while it was asked for a file.
    Asset {
        /// The file.
        name: String,
        /// What its code threw.
        cause: Global<JThrowable<'static>>,
    },
}

/// The words for a tracer that was closed.
pub const CLOSED: &str = "this RayTracer is closed";

impl Failure {
    /// Use of a tracer after it was closed.
    pub fn closed() -> Failure {
        Failure::State(CLOSED.to_owned())
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Failure::Rarefy(Error::InvalidOption { setting, value, allowed }) => {
                write!(f, "{}: `{value}` is not allowed; it may be {allowed}", java_name(*setting))
            }
            Failure::Rarefy(Error::MissingPlane { plane }) => {
                write!(f, "the last frame kept no plane of {plane}; name the layer in RenderOptions.Builder.keepLayers")
            }
            Failure::Rarefy(error) => error.fmt(f),
            Failure::Jni(error) => error.fmt(f),
            Failure::State(text) | Failure::Argument(text) | Failure::Target(text) => f.write_str(text),
            Failure::Asset { name, .. } => write!(f, "{name}: the AssetReader failed"),
        }
    }
}

impl std::error::Error for Failure {}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Failure::Rarefy(error)
    }
}

impl From<jni::errors::Error> for Failure {
    fn from(error: jni::errors::Error) -> Self {
        Failure::Jni(error)
    }
}

/// Every code that a `RayTracerException` may have: the names of its enum `Code`.
#[cfg(test)]
pub const CODES: [&str; 19] = [
    "IO",
    "SYNTAX",
    "INVALID_SCENE",
    "INVALID_IMAGE",
    "INVALID_OPTION",
    "INVALID_ARGUMENT",
    "INVALID_PROFILE",
    "MISSING_LAYER",
    "LIMIT_EXCEEDED",
    "OUT_OF_MEMORY",
    "NO_OPENCL",
    "OPENCL",
    "KERNEL_BUILD",
    "SELF_TEST",
    "DRIVER_CRASHED",
    "DEVICE_LOST",
    "CANCELLED",
    "TARGET_LOST",
    "INTERNAL",
];

/// The code of an error: a name of the enum `Code` of `RayTracerException`.
pub fn code(error: &Error) -> &'static str {
    match error {
        Error::Io { .. } => "IO",
        Error::Syntax { .. } => "SYNTAX",
        Error::InvalidScene { .. } => "INVALID_SCENE",
        Error::Image { .. } => "INVALID_IMAGE",
        Error::InvalidOption { .. } => "INVALID_OPTION",
        Error::InvalidArgument { .. } => "INVALID_ARGUMENT",
        Error::InvalidProfile { .. } => "INVALID_PROFILE",
        Error::MissingPlane { .. } => "MISSING_LAYER",
        Error::LimitExceeded { .. } => "LIMIT_EXCEEDED",
        Error::OutOfMemory { .. } => "OUT_OF_MEMORY",
        Error::NoOpenCl { .. } => "NO_OPENCL",
        Error::OpenCl { .. } => "OPENCL",
        Error::KernelBuild { .. } => "KERNEL_BUILD",
        Error::SelfTest { .. } => "SELF_TEST",
        Error::DriverCrashed { .. } => "DRIVER_CRASHED",
        Error::DeviceLost { .. } => "DEVICE_LOST",
        Error::Cancelled => "CANCELLED",
        _ => "INTERNAL",
    }
}

/// Where it went wrong: a file with its line, a part of a scene, a setting, a device.
pub fn place(error: &Error) -> Option<String> {
    Some(match error {
        Error::Io { path, .. } | Error::Image { path, .. } => path.display().to_string(),
        Error::Syntax { path, line, .. } => format!("{}:{line}", path.display()),
        Error::InvalidScene { place, .. } | Error::InvalidProfile { place, .. } => place.clone(),
        Error::InvalidOption { setting, .. } => java_name(*setting).to_owned(),
        Error::InvalidArgument { what, .. } | Error::LimitExceeded { what, .. } | Error::OutOfMemory { what, .. } => {
            what.clone()
        }
        Error::OpenCl { call, .. } => call.clone(),
        Error::KernelBuild { device, .. }
        | Error::SelfTest { device, .. }
        | Error::DriverCrashed { device, .. }
        | Error::DeviceLost { device, .. } => device.clone(),
        _ => return None,
    })
}

/// What Java calls a setting; the setting's own path where Java cannot set it.
pub fn java_name(setting: Setting) -> &'static str {
    match setting {
        Setting::Size => "RenderOptions.Builder.size",
        Setting::Samples => "RenderOptions.Builder.samples",
        Setting::Mode => "RenderOptions.Builder.mode",
        Setting::Depth => "RenderOptions.Builder.depth",
        Setting::Method => "RenderOptions.Builder.method",
        Setting::Block => "RenderOptions.Builder.block",
        Setting::Tests => "RenderOptions.Builder.disableTest",
        Setting::TPos => "RenderOptions.Builder.tPos",
        Setting::TNorm => "RenderOptions.Builder.tNorm",
        Setting::TConv => "RenderOptions.Builder.tConv",
        Setting::TTex => "RenderOptions.Builder.tTex",
        Setting::TGcol => "RenderOptions.Builder.tGcol",
        Setting::Correction => "RenderOptions.Builder.correction",
        Setting::Device => "OpenOptions.Builder.device",
        Setting::Profile => "OpenOptions.Builder.profile",
        Setting::MemoryBudget => "OpenOptions.Builder.memoryBudgetBytes",
        Setting::Layer => "Layer",
        Setting::BuiltinScene => "SceneSource.builtin",
        other => other.path(),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn java(name: &str) -> String {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../library/src/main/java/dev/rarefy");
        std::fs::read_to_string(format!("{folder}/{name}.java")).unwrap()
    }

    #[test]
    fn java_knows_every_code_and_no_other() {
        let source = java("RayTracerException");
        let (_, body) = source.split_once("enum Code {").unwrap();
        // The enum ends with the code of what it does not know.
        let (body, _) = body.split_once("OTHER;").unwrap();
        let is_name = |line: &&str| !line.is_empty() && line.chars().all(|c| c.is_ascii_uppercase() || c == '_');
        let names: Vec<&str> = body.lines().filter_map(|line| line.trim().strip_suffix(',')).filter(is_name).collect();
        assert_eq!(names, CODES);
    }

    #[test]
    fn settings_are_named_by_the_methods_that_java_has() {
        let mut named = 0;
        for &setting in Setting::ALL {
            let name = java_name(setting);
            let Some((class, method)) = name.split_once(".Builder.") else { continue };
            let source = java(class);
            assert!(source.contains(&format!("Builder {method}(")), "{name}");
            named += 1;
        }
        assert!(named > 15);
    }

    #[test]
    fn errors_say_where() {
        let error = Error::Syntax { path: "a/b.obj".into(), line: 7, message: "no".into() };
        assert_eq!((code(&error), place(&error).as_deref()), ("SYNTAX", Some("a/b.obj:7")));
        assert_eq!(code(&Error::Cancelled), "CANCELLED");
        let failure = Failure::from(Error::option(Setting::TPos, -1, "0 or more"));
        assert_eq!(failure.to_string(), "RenderOptions.Builder.tPos: `-1` is not allowed; it may be 0 or more");
    }
}
