// SPDX-License-Identifier: MIT OR Apache-2.0
//! Rarefy: a ray tracer for phones that shoots rays through about a third of the pixels and rebuilds the others.
//!
//! It implements "Adaptive undersampling for efficient mobile ray tracing" (Kim et al., The Visual Computer 2016) with
//! OpenCL 1.2 kernels, a CPU twin of every kernel, and a wide engine for CPUs. This page is all that a program needs to know.
//!
//! # Load, prepare, render, save
//!
//! A [`Scene`] comes from files ([`load`]), from bytes that your program holds ([`load_from`]), from a generator
//! ([`builtin`]) or from your own triangles ([`model`]). It is valid by construction. A [`PreparedScene`] adds the kd-tree
//! and everything else that rays need; threads may share it. A [`Renderer`] puts it on a device and draws [`Frame`]s.
//!
//! ```no_run
//! use std::sync::Arc;
//! use rarefy::{DeviceOptions, Keep, Monitor, PreparedScene, RenderOptions, Renderer, Shading};
//!
//! fn main() -> rarefy::Result<()> {
//!     let monitor = Monitor::default(); // watches nothing; see below
//!     let scene = rarefy::load("scenes/kitchen".as_ref(), &monitor)?; // or rarefy::builtin("spheres")?
//!     let prepared = Arc::new(PreparedScene::new(&scene, Shading::Full, &monitor)?);
//!     let mut renderer = Renderer::new(prepared, &DeviceOptions::default(), &monitor)?;
//!     let options = RenderOptions { width: 640, height: 480, ..RenderOptions::default() };
//!     let frame = renderer.render(&options, Keep::default())?;
//!     println!("{:?} in {:.0} ms on {}", frame.stats.pixels, frame.stats.frame_ms, renderer.info().name);
//!     frame.write_png("kitchen.png")
//! }
//! ```
//!
//! # Which device, which method
//!
//! [`DeviceOptions`] choose the device ([`DeviceChoice`]: an OpenCL GPU where there is one, else packets of rays on the CPU), a budget of memory,
//! and a [`Profile`] whose limits OpenCL is held to. Whatever memory the budget leaves, the picture is the same: frames that
//! do not fit are drawn in bands.
//!
//! Where a driver is missing, crashes or computes wrongly, something else draws, and [`Renderer::passed_over`] says why: see
//! [`Renderer::new`]. [`devices`] reports what there is. An app gives its cache folder ([`CacheFolder::At`]), in which
//! compiled kernels and what is known of drivers are kept.
//!
//! [`RenderOptions`] choose size, samples, [`Mode`] and the [`Method`]: [`Method::balanced`] is the default,
//! [`Method::fast`] starts from a sixteenth of the pixels, [`Method::paper`] is the paper's. A method is a value; its fields
//! are in [`tuning`]:
//!
//! ```
//! use rarefy::{Method, RenderOptions, tuning::Correction};
//!
//! let mut method = Method::fast();
//! method.checks.fine.t_pos = 0.03;
//! method.correction = Correction::Off;
//! let options = RenderOptions { method, samples: 2, ..RenderOptions::default() };
//! assert!(options.validate().is_ok());
//! method.checks.fine.t_pos = -1.0;
//! let error = RenderOptions { method, ..options }.validate().unwrap_err();
//! assert_eq!(error.to_string(), "method.checks.t_pos: `-1` is not allowed; it may be 0 or more");
//! ```
//!
//! # Move, light, look inside
//!
//! [`Renderer::set_view`] moves the [`Camera`] and changes [`Light`]s and environment between frames. [`Keep`] says what a
//! frame leaves beside its picture; [`draw_layer`] makes a picture of it: which pixels had rays, which test failed where,
//! what they cost ([`Layer`]). [`FrameStats`] has the figures. Positions count from [`Scene::origin`], which is 0 unless the
//! scene's files lie far away from 0.
//!
//! # Watch and cancel
//!
//! Whatever takes long is given a [`Monitor`]. It reports [`Event`]s (progress, and previews of a frame's base pixels) from
//! any thread, and its [`Cancel`] token ends the work within some milliseconds with [`Error::Cancelled`]:
//!
//! ```
//! use rarefy::{Cancel, Error, Event, Monitor, PreparedScene, Shading};
//!
//! let cancel = Cancel::default(); // give a clone to whoever may end the work
//! let monitor = Monitor::new(|event| {
//!     if let Event::Progress { phase, share } = event {
//!         println!("{phase}: {:.0} %", 100.0 * share);
//!     }
//! })
//! .with_cancel(&cancel);
//! cancel.cancel();
//! let prepared = PreparedScene::new(&rarefy::builtin("wall")?, Shading::Full, &monitor);
//! assert!(matches!(prepared, Err(Error::Cancelled)));
//! # Ok::<(), Error>(())
//! ```
//!
//! # Errors
//!
//! Every [`Error`] carries what was wrong as data (the [`Setting`], its value, what is allowed; the file and its line) and
//! says it in a sentence. Bad input never panics.

#![deny(clippy::print_stdout, clippy::print_stderr)]

/// Everything else, for this project's command, tests and bindings. It may change at any time.
// The modules lie in `src`, not in `src/internal`.
#[doc(hidden)]
#[path = "."]
pub mod internal {
    pub mod analysis;
    pub mod device;
    pub mod error;
    pub mod files;
    pub mod layout;
    pub mod math;
    pub(crate) mod memory;
    pub mod method;
    pub mod monitor;
    pub(crate) mod names;
    pub mod prepare;
    pub mod render;
    pub mod scene;
    pub mod selftest;
    pub(crate) mod settings;
}

use internal::{
    analysis, device, error, files, layout, math, memory, method, monitor, names, prepare, render, scene, selftest,
    settings,
};

pub use analysis::layers::{Layer, draw as draw_layer};
pub use device::open::{DeviceChoice, DeviceOptions, DeviceReport, DeviceSummary, RefusedLibrary, devices};
pub use device::opencl::CacheFolder;
pub use device::profiles::Profile;
pub use error::{Error, Result, Setting};
pub use method::counts::Keep;
pub use method::options::{Method, Mode, Preset, RenderOptions};
pub use monitor::{Cancel, Event, Monitor};
pub use prepare::{PreparedScene, Shading};
pub use render::frame::{Frame, FrameStats};
pub use render::renderer::Renderer;
pub use scene::builtin::to_scene as builtin;
pub use scene::{Camera, Light, Scene, View, load, load_from};

/// What scenes are made of, and how their files are found.
pub mod model {
    pub use crate::internal::math::pack_normal;
    pub use crate::internal::scene::{
        FileSource, LoadOptions, MAX_LIGHTS, Material, Object, SceneParts, Surface, Texture, load_with,
    };
}

/// The fields of a [`Method`].
pub mod tuning {
    pub use crate::internal::method::options::{
        Checks, Compared, Correction, GcolSpace, Interpolation, Spread, Test, TestSet, TextureRule, Tolerances,
    };
}

/// The example of README.md.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
