// SPDX-License-Identifier: MIT OR Apache-2.0
//! Frames drawn from a prepared scene: the renderer, pixels from samples, pictures in files.

pub mod frame;
mod frames;
pub mod picture;
pub mod renderer;
pub mod resolve;
