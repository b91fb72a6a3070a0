// SPDX-License-Identifier: MIT OR Apache-2.0
//! The café's parameters, as in `scenes/cafe/parameters.json`.

use serde::Deserialize;

use crate::scene::builtin::check;
use crate::scene::builtin::parts::furniture::ChairPlace;
use crate::scene::builtin::parts::lamps::Lamp;
use crate::scene::builtin::parts::room::SideWindow;
use crate::{Error, Result};

/// All parameters of the café; lengths are metres, angles whole turns.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Parameters {
    /// Seed of everything that is strewn: bottles, books, leaves, textures.
    pub seed: u32,
    /// The room's walls.
    pub room: Room,
    /// The window in the left wall.
    pub window: SideWindow,
    /// Length of a floor tile.
    pub floor_tile: f32,
    /// Round tables; the first one is laid.
    pub tables: Vec<Table>,
    /// Where the chairs stand.
    pub chairs: Vec<ChairPlace>,
    /// What each chair is like.
    pub chair: Chair,
    /// Pendant lamps.
    pub lamps: Vec<Lamp>,
    /// Sides of a lamp shade.
    pub lamp_sides: u32,
    /// Sides of a table top.
    pub table_sides: u32,
    /// Sides of glasses, the carafe and the cake dome.
    pub glass_sides: u32,
    /// Sides of cups and plates.
    pub cup_sides: u32,
    /// Sides of a bottle.
    pub bottle_sides: u32,
    /// Number of bottles on the upper shelf.
    pub bottles: u32,
    /// Number of books on the lower shelf.
    pub books: u32,
    /// Number of slats on the counter's front.
    pub slats: u32,
    /// Number of leaves of the plant.
    pub leaves: u32,
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
    /// Height of the panelling.
    pub wainscot: f32,
}

/// A round table.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Table {
    /// x and z of its middle.
    pub at: [f32; 2],
    /// Radius of its top.
    pub radius: f32,
}

/// What each chair is like.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Chair {
    /// Radius of legs and back.
    pub tube_radius: f32,
    /// Radius of the seat.
    pub seat_radius: f32,
    /// Height of the seat.
    pub seat_height: f32,
    /// Height of the back.
    pub back_height: f32,
    /// Sides of a tube.
    pub sides: u32,
    /// Pieces of a bent tube between two of its points.
    pub steps: u32,
    /// Sides of the seat.
    pub seat_sides: u32,
}

impl Parameters {
    /// Checks every value against its range.
    pub(super) fn check(&self) -> Result<()> {
        let r = &self.room;
        let w = &self.window;
        let c = &self.chair;
        for (key, value, range) in [
            ("room.left", r.left, -10.0..=-2.8),
            ("room.right", r.right, 2.5..=10.0),
            ("room.back", r.back, -10.0..=-2.9),
            ("room.front", r.front, 2.0..=12.0),
            ("room.height", r.height, 2.6..=6.0),
            ("room.wainscot", r.wainscot, 0.2..=1.5),
            ("window.near", w.near, w.far + 0.5..=r.front - 0.1),
            ("window.far", w.far, r.back + 0.1..=r.front),
            ("window.sill", w.sill, 0.2..=1.5),
            ("window.head", w.head, w.sill + 0.5..=r.height - 0.1),
            ("window.depth", w.depth, 0.05..=0.6),
            ("window.bar", w.bar, 0.005..=0.1),
            ("floor_tile", self.floor_tile, 0.05..=2.0),
            ("chair.tube_radius", c.tube_radius, 0.004..=0.03),
            ("chair.seat_radius", c.seat_radius, 0.1..=0.4),
            ("chair.seat_height", c.seat_height, 0.3..=0.8),
            ("chair.back_height", c.back_height, c.seat_height + 0.2..=1.5),
        ] {
            check("cafe", key, value, range)?;
        }
        for (key, value, lo, hi) in [
            ("chair.sides", c.sides, 3, 64),
            ("chair.steps", c.steps, 1, 32),
            ("chair.seat_sides", c.seat_sides, 6, 128),
            ("lamp_sides", self.lamp_sides, 6, 128),
            ("table_sides", self.table_sides, 6, 128),
            ("glass_sides", self.glass_sides, 6, 128),
            ("cup_sides", self.cup_sides, 6, 128),
            ("bottle_sides", self.bottle_sides, 6, 128),
            ("bottles", self.bottles, 1, 40),
            ("books", self.books, 1, 40),
            ("slats", self.slats, 1, 200),
            ("leaves", self.leaves, 1, 500),
            ("texture", self.texture, 64, 4096),
        ] {
            check("cafe", key, value as f32, lo as f32..=hi as f32)?;
        }
        for (key, count) in [("tables", self.tables.len()), ("chairs", self.chairs.len()), ("lamps", self.lamps.len())]
        {
            if !(1..=64).contains(&count) {
                let message = format!("`{key}` lists {count}; there must be 1 to 64");
                return Err(Error::scene("scenes/cafe/parameters.json", message));
            }
        }
        let mut places: Vec<(&str, [f32; 2])> = Vec::new();
        for t in &self.tables {
            check("cafe", "tables.radius", t.radius, 0.2..=1.0)?;
            places.push(("tables.at", t.at));
        }
        for c in &self.chairs {
            check("cafe", "chairs.turns", c.turns, -8.0..=8.0)?;
            places.push(("chairs.at", c.at));
        }
        for l in &self.lamps {
            check("cafe", "lamps.radius", l.radius, 0.05..=0.6)?;
            check("cafe", "lamps.at", l.at[1], 1.0..=r.height - 0.3)?;
            places.push(("lamps.at", [l.at[0], l.at[2]]));
        }
        for (key, [x, z]) in places {
            check("cafe", key, x, r.left..=r.right)?;
            check("cafe", key, z, r.back..=r.front)?;
        }
        Ok(())
    }
}
