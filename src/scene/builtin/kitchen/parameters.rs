// SPDX-License-Identifier: MIT OR Apache-2.0
//! The kitchen's parameters, as in `scenes/kitchen/parameters.json`.

use serde::Deserialize;

use crate::Result;
use crate::scene::builtin::check;
use crate::scene::builtin::parts::check_counts;
use crate::scene::builtin::parts::furniture::ChairPlace;
use crate::scene::builtin::parts::lamps::Lamp;
use crate::scene::builtin::parts::room::Room;

/// All parameters of the kitchen; lengths are metres, angles whole turns.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Parameters {
    /// Seed of everything that is strewn: tableware, jars, fruit, herbs, textures.
    pub seed: u32,
    /// The room's walls.
    pub room: Room,
    /// The window in the back wall.
    pub window: Window,
    /// Length of a tile on the walls.
    pub wall_tile: f32,
    /// Length of a tile on the floor.
    pub floor_tile: f32,
    /// The dining table.
    pub table: Table,
    /// Where the chairs stand.
    pub chairs: Vec<ChairPlace>,
    /// Pendant lamps.
    pub lamps: Vec<Lamp>,
    /// Plates in the drying rack.
    pub rack_plates: u32,
    /// Jars on the upper shelf.
    pub jars: u32,
    /// Spice jars beside the hood.
    pub spices: u32,
    /// Apples, oranges and pears in the bowl.
    pub fruit: u32,
    /// Leaves of a pot of herbs.
    pub herb_leaves: u32,
    /// Sides of pots, bowls and plates.
    pub round_sides: u32,
    /// Sides of cups, glasses, jars and fruit.
    pub small_sides: u32,
    /// Sides of a chair's legs.
    pub chair_sides: u32,
    /// Width and height of the largest textures, in texels.
    pub texture: u32,
}

/// The window in the back wall, above the sink.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Window {
    /// x of its left side.
    pub left: f32,
    /// x of its right side.
    pub right: f32,
    /// Height of the lower border.
    pub sill: f32,
    /// Height of the upper border.
    pub head: f32,
    /// Thickness of the wall.
    pub depth: f32,
    /// Half the width of the bars between the panes.
    pub bar: f32,
}

/// The dining table.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Table {
    /// x and z of its middle.
    pub at: [f32; 2],
    /// Its length along x and its width.
    pub size: [f32; 2],
}

impl Parameters {
    /// Checks every value against its range.
    pub(super) fn check(&self) -> Result<()> {
        let (r, w, t) = (&self.room, &self.window, &self.table);
        for (key, value, range) in [
            ("room.left", r.left, -8.0..=-2.3),
            ("room.right", r.right, 2.2..=8.0),
            ("room.back", r.back, -8.0..=-2.1),
            ("room.front", r.front, 2.5..=10.0),
            ("room.height", r.height, 2.5..=5.0),
            ("window.left", w.left, -1.5..=-0.7),
            ("window.right", w.right, w.left + 0.4..=0.1),
            ("window.sill", w.sill, 0.95..=1.4),
            ("window.head", w.head, w.sill + 0.4..=r.height - 0.2),
            ("window.depth", w.depth, 0.05..=0.6),
            ("window.bar", w.bar, 0.005..=0.05),
            ("wall_tile", self.wall_tile, 0.03..=1.0),
            ("floor_tile", self.floor_tile, 0.05..=2.0),
            ("table.at", t.at[0], r.left + 0.8..=r.right - 0.8),
            ("table.at", t.at[1], r.back + 1.2..=r.front - 0.8),
            ("table.size", t.size[0], 0.9..=3.0),
            ("table.size", t.size[1], 0.6..=1.6),
        ] {
            check("kitchen", key, value, range)?;
        }
        check_counts(
            "kitchen",
            &[
                ("rack_plates", self.rack_plates, 1, 24),
                ("jars", self.jars, 1, 24),
                ("spices", self.spices, 1, 24),
                ("fruit", self.fruit, 1, 100),
                ("herb_leaves", self.herb_leaves, 1, 1000),
                ("round_sides", self.round_sides, 6, 256),
                ("small_sides", self.small_sides, 6, 128),
                ("chair_sides", self.chair_sides, 3, 64),
                ("texture", self.texture, 64, 4096),
                ("chairs", self.chairs.len() as u32, 1, 64),
                ("lamps", self.lamps.len() as u32, 1, 16),
            ],
        )?;
        for c in &self.chairs {
            check("kitchen", "chairs.turns", c.turns, -8.0..=8.0)?;
            check("kitchen", "chairs.at", c.at[0], r.left..=r.right)?;
            check("kitchen", "chairs.at", c.at[1], r.back..=r.front)?;
        }
        r.check_lamps("kitchen", &self.lamps)
    }
}
