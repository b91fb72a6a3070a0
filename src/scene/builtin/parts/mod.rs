// SPDX-License-Identifier: MIT OR Apache-2.0
//! Things that stand in more than one built-in scene: furniture, lamps, tableware, food, plants, windows, tiles.
//!
//! Shapes are meshes about the origin; a scene gives them place, name and material. Lengths are metres.

pub mod blinds;
pub mod cloth;
pub mod crockery;
pub mod cupboards;
pub mod finishes;
pub mod foliage;
pub mod food;
pub mod furniture;
pub mod lamps;
pub mod pictures;
pub mod plants;
pub mod plumbing;
pub mod room;
pub mod shell;
pub mod smooth;
pub mod walls;

use glam::Vec3;

use crate::Result;

/// A point.
pub(super) const fn at(x: f32, y: f32, z: f32) -> Vec3 {
    Vec3::new(x, y, z)
}

/// Checks whole numbers against their ranges: key, value, least, greatest.
pub(super) fn check_counts(scene: &str, counts: &[(&str, u32, u32, u32)]) -> Result<()> {
    counts.iter().try_for_each(|&(key, value, lo, hi)| super::check(scene, key, value as f32, lo as f32..=hi as f32))
}
