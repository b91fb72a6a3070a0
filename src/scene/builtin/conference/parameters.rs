// SPDX-License-Identifier: MIT OR Apache-2.0
//! The conference room's parameters, as in `scenes/conference/parameters.json`.

use serde::Deserialize;

use crate::Result;
use crate::scene::builtin::check;
use crate::scene::builtin::parts::check_counts;
use crate::scene::builtin::parts::lamps::Lamp;
use crate::scene::builtin::parts::room::Room;

/// All parameters of the conference room; lengths are metres, angles whole turns.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Parameters {
    /// Seed of everything that is strewn: chairs, paper, leaves, textures.
    pub seed: u32,
    /// The room's walls.
    pub room: Room,
    /// The windows in the left wall.
    pub windows: Windows,
    /// The blinds before them.
    pub blinds: Blinds,
    /// The table.
    pub table: Table,
    /// Chairs along each long side of the table; one more stands at its far end.
    pub seats: u32,
    /// Chairs in a row along the right wall.
    pub guests: u32,
    /// Pendant lamps above the table.
    pub lamps: Vec<Lamp>,
    /// Leaves of each plant.
    pub leaves: u32,
    /// Wooden battens on the back wall.
    pub battens: u32,
    /// Sides of a chair's tubes.
    pub chair_sides: u32,
    /// Sides of lamps, carafes and pots.
    pub round_sides: u32,
    /// Sides of glasses, cups and microphones.
    pub small_sides: u32,
    /// Width and height of the largest textures, in texels.
    pub texture: u32,
}

/// The windows in the left wall, at equal distances.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Windows {
    /// How many.
    pub count: u32,
    /// Width of each.
    pub wide: f32,
    /// Height of their lower borders.
    pub sill: f32,
    /// Height of their upper borders.
    pub head: f32,
    /// Thickness of the wall.
    pub depth: f32,
    /// Half the width of the bars between the panes.
    pub bar: f32,
}

/// What the blinds are like.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Blinds {
    /// Slats of each.
    pub slats: u32,
    /// Cells along a slat.
    pub cells: u32,
    /// How far the slats are turned from lying flat.
    pub tilt: f32,
}

/// The table.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Table {
    /// x and z of its middle.
    pub at: [f32; 2],
    /// Its width along x and its length along z.
    pub size: [f32; 2],
}

impl Parameters {
    /// Checks every value against its range.
    pub(super) fn check(&self) -> Result<()> {
        let (r, w, b, t) = (&self.room, &self.windows, &self.blinds, &self.table);
        for (key, value, range) in [
            ("room.left", r.left, -12.0..=-2.8),
            ("room.right", r.right, 2.8..=12.0),
            ("room.back", r.back, -20.0..=-3.5),
            ("room.front", r.front, 3.5..=20.0),
            ("room.height", r.height, 2.6..=6.0),
            ("windows.wide", w.wide, 0.6..=(r.front - r.back - 0.4) / w.count.max(1) as f32 - 0.2),
            ("windows.sill", w.sill, 0.3..=1.2),
            ("windows.head", w.head, w.sill + 0.4..=r.height - 0.25),
            ("windows.depth", w.depth, 0.05..=0.6),
            ("windows.bar", w.bar, 0.005..=0.05),
            ("blinds.tilt", b.tilt, 0.0..=0.24),
            ("table.at", t.at[0], r.left + 1.5..=r.right - 1.5),
            ("table.at", t.at[1], r.back + 2.0..=r.front - 2.0),
            ("table.size", t.size[0], 1.2..=3.0),
            ("table.size", t.size[1], 2.4..=12.0),
        ] {
            check("conference", key, value, range)?;
        }
        check_counts(
            "conference",
            &[
                ("windows.count", w.count, 1, 12),
                ("blinds.slats", b.slats, 2, 400),
                ("blinds.cells", b.cells, 1, 200),
                ("seats", self.seats, 1, 24),
                ("guests", self.guests, 1, 24),
                ("leaves", self.leaves, 1, 500),
                ("battens", self.battens, 1, 400),
                ("chair_sides", self.chair_sides, 3, 64),
                ("round_sides", self.round_sides, 8, 256),
                ("small_sides", self.small_sides, 6, 128),
                ("texture", self.texture, 64, 4096),
                ("lamps", self.lamps.len() as u32, 1, 16),
            ],
        )?;
        r.check_lamps("conference", &self.lamps)
    }
}
