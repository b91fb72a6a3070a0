// SPDX-License-Identifier: MIT OR Apache-2.0
//! The courtyard's parameters, as in `scenes/courtyard/parameters.json`.

use serde::Deserialize;

use crate::Result;
use crate::scene::builtin::check;
use crate::scene::builtin::parts::check_counts;

/// All parameters of the courtyard; lengths are metres.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Parameters {
    /// Seed of everything that grows or is strewn.
    pub seed: u32,
    /// Arches at the back, and along each side.
    pub bays: [u32; 2],
    /// Distance of the columns.
    pub bay: f32,
    /// Length and width of a paving stone.
    pub stone: [f32; 2],
    /// x and z of the fountain.
    pub fountain: [f32; 2],
    /// The trees.
    pub trees: Vec<TreePlace>,
    /// Leaves of each tree.
    pub tree_leaves: u32,
    /// Length of a tree's leaf.
    pub leaf: f32,
    /// Oranges in each tree.
    pub oranges: u32,
    /// Leaves of the ivy on the left wall.
    pub ivy_leaves: u32,
    /// Leaves of all hedges.
    pub hedge_leaves: u32,
    /// Flower pots.
    pub pots: u32,
    /// Leaves in each pot.
    pub pot_leaves: u32,
    /// Balusters of each bay.
    pub balusters: u32,
    /// Width of a roof tile.
    pub roof_tile: f32,
    /// Sides of columns.
    pub column_sides: u32,
    /// Sides of the fountain, pots and lamps.
    pub round_sides: u32,
    /// Sides of balusters, glasses and fruit.
    pub small_sides: u32,
    /// Width and height of the largest textures, in texels.
    pub texture: u32,
}

/// Where a tree stands, and how large it is.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TreePlace {
    /// x and z of its trunk.
    pub at: [f32; 2],
    /// Height at which the branches begin.
    pub trunk: f32,
    /// About how far the crown reaches from there.
    pub reach: f32,
}

impl Parameters {
    /// Half the width of the court.
    pub fn half_wide(&self) -> f32 {
        0.5 * self.bays[0] as f32 * self.bay
    }

    /// z of the arcade at the back; the side arcades end as far in front of the origin as is left.
    pub fn back(&self) -> f32 {
        -2.5 * self.bay
    }

    /// z at which the side arcades end.
    pub fn front(&self) -> f32 {
        self.back() + self.bays[1] as f32 * self.bay
    }

    /// Checks every value against its range.
    pub(super) fn check(&self) -> Result<()> {
        for (key, value, range) in [
            ("bay", self.bay, 1.8..=4.0),
            ("stone", self.stone[0], 0.08..=2.0),
            ("stone", self.stone[1], 0.08..=2.0),
            ("leaf", self.leaf, 0.02..=0.5),
            ("roof_tile", self.roof_tile, 0.1..=1.0),
        ] {
            check("courtyard", key, value, range)?;
        }
        check_counts(
            "courtyard",
            &[
                ("bays", self.bays[0], 3, 15),
                ("bays", self.bays[1], 4, 20),
                ("trees", self.trees.len() as u32, 1, 16),
                ("tree_leaves", self.tree_leaves, 1, 500_000),
                ("oranges", self.oranges, 1, 300),
                ("ivy_leaves", self.ivy_leaves, 1, 500_000),
                ("hedge_leaves", self.hedge_leaves, 1, 500_000),
                ("pots", self.pots, 1, 40),
                ("pot_leaves", self.pot_leaves, 1, 1000),
                ("balusters", self.balusters, 1, 40),
                ("column_sides", self.column_sides, 6, 256),
                ("round_sides", self.round_sides, 8, 256),
                ("small_sides", self.small_sides, 4, 64),
                ("texture", self.texture, 64, 4096),
            ],
        )?;
        let (x, z0, z1) = (self.half_wide(), self.back(), self.front());
        check("courtyard", "fountain", self.fountain[0], 3.0 - x..=x - 3.0)?;
        check("courtyard", "fountain", self.fountain[1], z0 + 3.0..=z1 - 3.0)?;
        for t in &self.trees {
            check("courtyard", "trees.at", t.at[0], 1.0 - x..=x - 1.0)?;
            check("courtyard", "trees.at", t.at[1], z0 + 1.0..=z1 - 1.0)?;
            check("courtyard", "trees.trunk", t.trunk, 0.3..=6.0)?;
            check("courtyard", "trees.reach", t.reach, 0.5..=8.0)?;
        }
        Ok(())
    }
}
