// SPDX-License-Identifier: MIT OR Apache-2.0
//! The wrapper around OpenCL: nothing else in this crate calls it.
//!
//! [`open`] finds the library, picks a device and returns a [`Context`], which makes [`Buffer`]s,
//! [`Program`]s and launches. It knows the device's limits (or those of a [`Profile`], which a desktop obeys like the
//! phone would), accounts for memory, splits long launches into slices, and measures them.

mod bounds_table;
mod buffer;
pub mod build_log;
mod cache;
pub mod codes;
mod context;
mod discover;
pub mod executor;
mod faults;
mod handle;
mod launch;
pub mod library;
mod limits;
pub mod markers;
mod program;
mod report;
mod slices;
mod timing;

pub use buffer::{AnyBuffer, Buffer};
pub use cache::CacheFolder;
pub use context::{Context, MemoryUse, OpenOptions, open, open_with};
pub use discover::{DeviceFound, DeviceInfo, DeviceKind, Discovery, discover};
pub use faults::Faults;
pub use launch::{Arg, DeviceLaunch};
pub use limits::Limits;
pub use program::{Kernel, Program, ProgramSource};
pub use report::{DeviceReport, DeviceSummary, RefusedLibrary, report};

pub use crate::device::profiles::Profile;
