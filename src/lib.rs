// SPDX-License-Identifier: MIT OR Apache-2.0
//! Rarefy: a ray tracer for phones that traces a quarter to a third of the pixels and rebuilds the rest.
//!
//! It implements "Adaptive undersampling for efficient mobile ray tracing" (Kim et al., The Visual Computer 2016) with
//! OpenCL 1.2 kernels and a CPU twin of every kernel. Data flows one way:
//! scene files -> [`scene::Scene`] -> [`kdtree::KdTree`] -> device buffers -> stages -> frame -> PNG.
//!
//! ```no_run
//! use rarefy::options::RenderOptions;
//! use rarefy::renderer::{DeviceChoice, Keep, Renderer, RendererOptions};
//!
//! fn main() -> rarefy::Result<()> {
//!     let monitor = rarefy::Monitor::default(); // progress, previews, cancel: see rarefy::monitor
//!     let scene = rarefy::builtin::to_scene("spheres")?; // files: rarefy::scene::load(path, &monitor)?
//!     let device = RendererOptions { device: DeviceChoice::Auto, ..RendererOptions::default() };
//!     let mut renderer = Renderer::new(scene, &device, &monitor)?;
//!     let options = RenderOptions { width: 320, height: 240, ..RenderOptions::default() };
//!     let frame = renderer.render(&options, Keep::default())?;
//!     println!("{:?} in {:.0} ms", frame.stats.pixels, frame.stats.frame_ms);
//!     rarefy::picture::write_png("spheres.png", frame.width, frame.height, &frame.pixels)
//! }
//! ```

pub mod backend;
pub mod bands;
pub mod builtin;
pub mod camera;
pub mod compare;
pub mod error;
pub mod fallback;
pub mod frame;
pub mod kdtree;
pub mod kernels;
pub mod layers;
pub mod layout;
pub mod math;
pub mod metrics;
pub mod monitor;
pub mod opencl;
pub mod options;
pub mod picture;
pub mod pipeline;
pub mod profiles;
pub mod quick_test;
pub mod renderer;
pub mod report;
pub mod resolve;
pub mod scene;
pub mod scene_buffers;
pub mod selftest;
pub mod stage;
pub mod twin;
pub mod wave_model;

pub use error::{Error, Result};
pub use monitor::{Cancel, Monitor};
pub use scene::Scene;
