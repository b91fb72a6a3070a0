// SPDX-License-Identifier: MIT OR Apache-2.0
//! The method: what may be asked of a frame, which launches make one, post-correction, bands, the fall-back.

pub mod bands;
pub mod camera;
mod correction;
pub mod counts;
pub mod fallback;
pub mod frame;
pub mod options;
mod packing;
pub mod window;
