// SPDX-License-Identifier: MIT OR Apache-2.0
//! The bathroom's parameters, as in `scenes/bathroom/parameters.json`.

use serde::Deserialize;

use crate::Result;
use crate::scene::builtin::check;
use crate::scene::builtin::parts::check_counts;
use crate::scene::builtin::parts::room::SideWindow;

/// All parameters of the bathroom; lengths are metres, angles whole turns.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Parameters {
    /// Seed of everything that is strewn: foam, leaves, bottles, textures.
    pub seed: u32,
    /// The room's walls.
    pub room: Room,
    /// The window in the right wall.
    pub window: SideWindow,
    /// The shower in the right corner at the back.
    pub shower: Shower,
    /// The bath tub.
    pub tub: Tub,
    /// Length of a wall tile; it is half as high.
    pub wall_tile: f32,
    /// Width of a six-sided floor tile.
    pub floor_tile: f32,
    /// Length of a tile in the shower.
    pub mosaic_tile: f32,
    /// Bubbles on the water.
    pub bubbles: u32,
    /// Leaves of the plant.
    pub leaves: u32,
    /// Bobbles of the bath mat, across and along.
    pub mat: [u32; 2],
    /// Stakes of the laundry basket.
    pub stakes: u32,
    /// Cells across a hanging towel.
    pub towel_cells: u32,
    /// Sides of tub, bowls and other ceramics.
    pub ceramic_sides: u32,
    /// Sides of bottles, glasses and taps.
    pub small_sides: u32,
    /// Width and height of the largest textures, in texels.
    pub texture: u32,
}

/// The room's walls, floor at y = 0.
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
    /// Height of the tiles outside the shower.
    pub tiles: f32,
}

/// The shower in the right corner at the back.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shower {
    /// Its size along x and z.
    pub size: [f32; 2],
    /// Height of its glass walls.
    pub height: f32,
}

/// The bath tub.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tub {
    /// x and z of its middle.
    pub at: [f32; 2],
    /// Its width and its length, without the rim.
    pub size: [f32; 2],
    /// How far it is turned about the y axis.
    pub turns: f32,
}

impl Parameters {
    /// Checks every value against its range.
    pub(super) fn check(&self) -> Result<()> {
        let (r, w, s, t) = (&self.room, &self.window, &self.shower, &self.tub);
        for (key, value, range) in [
            ("room.left", r.left, -6.0..=-2.1),
            ("room.right", r.right, 1.9..=6.0),
            ("room.back", r.back, -6.0..=-1.7),
            ("room.front", r.front, 2.0..=8.0),
            ("room.height", r.height, 2.4..=4.0),
            ("room.tiles", r.tiles, 0.95..=1.02),
            ("shower.size", s.size[0], 0.7..=1.2),
            ("shower.size", s.size[1], 0.7..=1.4),
            ("shower.height", s.height, 1.6..=r.height - 0.1),
            ("window.far", w.far, r.back + s.size[1] + 0.2..=r.front - 0.8),
            ("window.near", w.near, w.far + 0.4..=r.front - 0.2),
            ("window.sill", w.sill, r.tiles + 0.05..=1.6),
            ("window.head", w.head, w.sill + 0.3..=r.height - 0.15),
            ("window.depth", w.depth, 0.05..=0.6),
            ("window.bar", w.bar, 0.005..=0.05),
            ("tub.at", t.at[0], r.left + 1.0..=r.right - 0.5),
            ("tub.at", t.at[1], r.back + 1.0..=r.front - 1.0),
            ("tub.size", t.size[0], 0.66..=1.2),
            ("tub.size", t.size[1], 1.2..=2.2),
            ("tub.turns", t.turns, -8.0..=8.0),
            ("wall_tile", self.wall_tile, 0.04..=1.0),
            ("floor_tile", self.floor_tile, 0.02..=1.0),
            ("mosaic_tile", self.mosaic_tile, 0.01..=0.5),
        ] {
            check("bathroom", key, value, range)?;
        }
        check_counts(
            "bathroom",
            &[
                ("bubbles", self.bubbles, 1, 5000),
                ("leaves", self.leaves, 1, 500),
                ("mat", self.mat[0], 1, 200),
                ("mat", self.mat[1], 1, 200),
                ("stakes", self.stakes, 8, 200),
                ("towel_cells", self.towel_cells, 4, 200),
                ("ceramic_sides", self.ceramic_sides, 12, 400),
                ("small_sides", self.small_sides, 6, 128),
                ("texture", self.texture, 64, 4096),
            ],
        )
    }
}
