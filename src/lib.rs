// SPDX-License-Identifier: MIT OR Apache-2.0
//! Rarefy: a ray tracer for phones that traces a quarter to a third of the pixels and rebuilds the rest.
//!
//! It implements "Adaptive undersampling for efficient mobile ray tracing" (Kim et al., The Visual Computer 2016) with
//! OpenCL 1.2 kernels and a CPU twin of every kernel. Data flows one way:
//! scene files -> [`scene::Scene`] -> [`prepare::kdtree::KdTree`] -> device buffers -> stages -> frame -> PNG.
//!
//! ```no_run
//! use rarefy::method::options::RenderOptions;
//! use rarefy::render::renderer::{DeviceChoice, Keep, Renderer, RendererOptions};
//!
//! fn main() -> rarefy::Result<()> {
//!     let monitor = rarefy::Monitor::default(); // progress, previews, cancel: see rarefy::monitor
//!     let scene = rarefy::scene::builtin::to_scene("spheres")?; // files: rarefy::scene::load(path, &monitor)?
//!     let device = RendererOptions { device: DeviceChoice::Auto, ..RendererOptions::default() };
//!     let mut renderer = Renderer::new(scene, &device, &monitor)?;
//!     let options = RenderOptions { width: 320, height: 240, ..RenderOptions::default() };
//!     let frame = renderer.render(&options, Keep::default())?;
//!     println!("{:?} in {:.0} ms", frame.stats.pixels, frame.stats.frame_ms);
//!     rarefy::render::picture::write_png("spheres.png", frame.width, frame.height, &frame.pixels)
//! }
//! ```

#![deny(clippy::print_stdout, clippy::print_stderr)]

pub mod analysis;
pub mod device;
pub mod error;
pub mod files;
pub mod layout;
pub mod math;
mod memory;
pub mod method;
pub mod monitor;
mod names;
pub mod prepare;
pub mod render;
pub mod scene;
pub mod selftest;
mod settings;

pub use error::{Error, Result};
pub use monitor::{Cancel, Monitor};
pub use scene::Scene;
