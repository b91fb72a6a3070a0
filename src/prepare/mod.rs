// SPDX-License-Identifier: MIT OR Apache-2.0
//! From a scene to what kernels read: the kd-tree and flat arrays; baked files of both.

mod baked;
mod coincident;
pub mod kdtree;
mod prepared_scene;

pub(crate) use prepared_scene::flatten_lights;
pub use prepared_scene::{PreparedScene, Shading};
