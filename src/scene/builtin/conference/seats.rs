// SPDX-License-Identifier: MIT OR Apache-2.0
//! The chairs around the table and along the wall.

use super::{Parameters, at};
use crate::scene::builtin::mesh::{Mesh, Random};
use crate::scene::builtin::model::Model;
use crate::scene::builtin::parts::furniture::{ChairPlace, tube_chair};

/// z of a seat's place at the table, for the `k`-th along a side.
pub fn along(p: &Parameters, k: u32) -> f32 {
    let long = p.table.size[1] - 0.5;
    p.table.at[1] + long * ((k as f32 + 0.5) / p.seats as f32 - 0.5)
}

/// Where chairs stand: nobody has put them in a row.
fn places(p: &Parameters) -> Vec<ChairPlace> {
    let mut random = Random::new(p.seed.wrapping_add(41));
    let mut list = Vec::new();
    let [x, z] = p.table.at;
    let half = [0.5 * p.table.size[0], 0.5 * p.table.size[1]];
    for side in [-1.0, 1.0] {
        for k in 0..p.seats {
            let out = half[0] + random.range(0.16, 0.30);
            let turns = -0.25 * side + random.range(-0.018, 0.018);
            list.push(ChairPlace { at: [x + side * out, along(p, k) + random.range(-0.03, 0.03)], turns });
        }
    }
    list.push(ChairPlace { at: [x + 0.05, z - half[1] - 0.24], turns: 0.01 });
    for k in 0..p.guests {
        let turns = -0.25 + random.range(-0.008, 0.008);
        list.push(ChairPlace { at: [p.room.right - 0.42, p.room.back + 0.75 + 0.70 * k as f32], turns });
    }
    list
}

/// Adds the chairs.
pub fn add(model: &mut Model, p: &Parameters) {
    let parts = tube_chair(0.455, 0.90, p.chair_sides);
    for (i, chair) in places(p).iter().enumerate() {
        let put = |mesh: &Mesh| mesh.clone().turned_y(chair.turns).moved(at(chair.at[0], 0.0, chair.at[1]));
        for (what, material, mesh) in
            [("tubes", "chrome", &parts[0]), ("pads", "fabric", &parts[1]), ("arms", "black-plastic", &parts[2])]
        {
            model.add(format!("chair-{}-{what}", i + 1), material, put(mesh));
        }
    }
}
