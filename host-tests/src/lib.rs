// SPDX-License-Identifier: MIT OR Apache-2.0
//! Fixtures and assertions that the desktop tests share.
#![allow(clippy::unwrap_used)]

pub mod baked;
pub mod clang;
pub mod command;
pub mod contexts;
pub mod details;
pub mod fixtures;
pub mod frames;
pub mod fuzz;
pub mod jdk;
pub mod masks;
pub mod option_space;
