// SPDX-License-Identifier: MIT OR Apache-2.0
//! Parameters that several rooms have.

use serde::Deserialize;

use super::lamps::Lamp;
use crate::Result;
use crate::scene::builtin::check;

/// A room's walls, floor at y = 0.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Room {
    /// x of the left wall.
    pub left: f32,
    /// x of the right wall.
    pub right: f32,
    /// z of the back wall.
    pub back: f32,
    /// z of the front wall, behind the camera.
    pub front: f32,
    /// Height of the ceiling.
    pub height: f32,
}

/// A window in a wall on the left or right.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SideWindow {
    /// z of the side nearer to the front.
    pub near: f32,
    /// z of the side nearer to the back.
    pub far: f32,
    /// Height of the lower border.
    pub sill: f32,
    /// Height of the upper border.
    pub head: f32,
    /// Thickness of the wall.
    pub depth: f32,
    /// Half the width of the bars between the panes.
    pub bar: f32,
}

impl Room {
    /// Checks that the pendant lamps of `scene` hang in this room.
    pub fn check_lamps(&self, scene: &str, lamps: &[Lamp]) -> Result<()> {
        for lamp in lamps {
            check(scene, "lamps.radius", lamp.radius, 0.05..=0.6)?;
            check(scene, "lamps.at", lamp.at[0], self.left..=self.right)?;
            check(scene, "lamps.at", lamp.at[1], 1.0..=self.height - 0.3)?;
            check(scene, "lamps.at", lamp.at[2], self.back..=self.front)?;
        }
        Ok(())
    }
}
