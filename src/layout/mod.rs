// SPDX-License-Identifier: MIT OR Apache-2.0
//! What host and kernels share: structs, numbers, where pixels lie, tables, and the build options that tell kernels.

mod constants;
mod flags;
mod flavour;
mod planes;
mod structs;
mod tables;

pub use constants::*;
pub use flags::{FailMask, StepFlags};
pub use flavour::{BuildFlavour, SHORT_STACK_ENTRIES, Traversal, build_options};
pub use planes::{base_pixels, base_shift, color_index, grid_items, grid_pixel, plane_index};
pub use structs::{FrameParams, Light, Material, StepParams, Texture, Triangle, TriangleShading};
pub use structs::{LayoutEntry, struct_layout};
pub use tables::tables;
