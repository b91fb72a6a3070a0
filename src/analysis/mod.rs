// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a frame shows and what it cost: metrics, layers, comparisons, the wave model, statistics as JSON.

pub mod compare;
pub mod layers;
pub mod metrics;
pub mod report;
pub mod wave_model;
