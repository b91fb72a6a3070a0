// SPDX-License-Identifier: MIT OR Apache-2.0
//! Rarefy: a ray tracer for phones that traces a quarter to a third of the pixels and rebuilds the rest.
//!
//! It implements "Adaptive undersampling for efficient mobile ray tracing" (Kim et al., The Visual Computer 2016) with
//! OpenCL 1.2 kernels and a CPU twin of every kernel. Data flows one way:
//! scene files -> [`scene::Scene`] -> [`kdtree::KdTree`] -> device buffers -> stages -> frame -> PNG.

pub mod error;
pub mod kdtree;
pub mod math;
pub mod opencl;
pub mod profiles;
pub mod scene;

pub use error::{Error, Result};
pub use scene::Scene;
