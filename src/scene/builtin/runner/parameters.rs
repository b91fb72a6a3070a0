// SPDX-License-Identifier: MIT OR Apache-2.0
//! The finish line's parameters, as in `scenes/runner/parameters.json`.

use serde::Deserialize;

use crate::Result;
use crate::scene::builtin::check;
use crate::scene::builtin::parts::check_counts;

/// All parameters of the finish line; lengths are metres, angles whole turns.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Parameters {
    /// Seed of everything that is strewn: grains, clouds, trees.
    pub seed: u32,
    /// Width of a lane.
    pub lane: f32,
    /// The three runners.
    pub runners: [RunnerPlace; 3],
    /// Length of the cells in which the runners are made.
    pub cell: f32,
    /// x and z of the hurdles' middles.
    pub hurdles: Vec<[f32; 2]>,
    /// Sides of the cup, the bottles and the ball.
    pub round_sides: u32,
    /// Sides of rods.
    pub rod_sides: u32,
    /// Width and height of the largest textures, in texels.
    pub texture: u32,
}

/// Where and how a runner runs.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunnerPlace {
    /// x and z of the hips.
    pub at: [f32; 2],
    /// How far the runner is turned about the y axis; at 0 one runs to +z.
    pub turns: f32,
    /// What arms and legs do.
    pub pose: Pose,
}

/// What a runner's arms and legs do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Pose {
    /// The right leg is in front.
    Right,
    /// The left leg is in front.
    Left,
    /// Over the line, with both arms up.
    Wins,
}

impl Parameters {
    /// Checks every value against its range.
    pub(super) fn check(&self) -> Result<()> {
        for (key, value, range) in [("lane", self.lane, 0.6..=2.0), ("cell", self.cell, 0.006..=0.05)] {
            check("runner", key, value, range)?;
        }
        check_counts(
            "runner",
            &[
                ("round_sides", self.round_sides, 8, 256),
                ("rod_sides", self.rod_sides, 4, 64),
                ("texture", self.texture, 64, 4096),
                ("hurdles", self.hurdles.len() as u32, 1, 64),
            ],
        )?;
        for r in &self.runners {
            check("runner", "runners.at", r.at[0], -8.0..=8.0)?;
            check("runner", "runners.at", r.at[1], -12.0..=6.0)?;
            check("runner", "runners.turns", r.turns, -8.0..=8.0)?;
        }
        for h in &self.hurdles {
            check("runner", "hurdles", h[0], -8.0..=8.0)?;
            check("runner", "hurdles", h[1], -12.0..=6.0)?;
        }
        Ok(())
    }
}
