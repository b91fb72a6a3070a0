// SPDX-License-Identifier: MIT OR Apache-2.0
//! Fixtures and assertions that the desktop tests share.

pub mod fixtures;
pub mod masks;
