// SPDX-License-Identifier: MIT OR Apache-2.0
//! Observers of launches: progress, recording, parity.

pub mod parity;
pub mod progress;
pub mod recording;
