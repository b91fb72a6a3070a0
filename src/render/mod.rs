// SPDX-License-Identifier: MIT OR Apache-2.0
//! Frames drawn from a prepared scene: the renderer, pixels from samples, pictures in files.

mod device;
mod device_choice;
mod draw;
pub mod picture;
pub mod renderer;
pub mod resolve;
