// SPDX-License-Identifier: MIT OR Apache-2.0
//! A table with chairs in the shade of a tree, laid for tea.

use super::{Parameters, at};
use crate::scene::builtin::mesh::Mesh;
use crate::scene::builtin::model::Model;
use crate::scene::builtin::parts::crockery::{cup, plate, teapot, tumbler};
use crate::scene::builtin::parts::food::{apple, croissant, pear};
use crate::scene::builtin::parts::furniture::{slatted_chair, table};

/// Height of the table's top.
const TOP: f32 = 0.74;

/// Adds the table, its chairs, and what stands on it.
pub fn add(model: &mut Model, p: &Parameters) {
    let place = at(-0.70, 0.003, p.front() - 4.35);
    let (frame, top) = table(0.52, 0.40, TOP);
    let put = |mesh: Mesh| mesh.turned_y(0.03).moved(place);
    model.add("table-frame", "cream-paint", put(frame));
    model.add("table-top", "oak", put(top));
    let (wood, seat) = slatted_chair(0.46, 0.94, 8);
    for (n, (x, z, turns)) in [(-0.80, 0.02, 0.27), (0.82, 0.08, -0.22), (0.08, -0.68, 0.02)].into_iter().enumerate() {
        let stand = |mesh: &Mesh| mesh.clone().turned_y(turns).moved(place + at(x, 0.0, z));
        model.add(format!("chair-{}", n + 1), "dark-green", stand(&wood));
        model.add(format!("chair-{}-seat", n + 1), "oak", stand(&seat));
    }
    let on = |x: f32, z: f32| at(x, TOP + 0.0005, z);
    model.add("teapot", "porcelain", put(teapot(0.075, p.round_sides).turned_y(0.1).moved(on(0.02, -0.05))));
    let (mut cups, mut plates, mut glasses) = (Mesh::default(), Mesh::default(), Mesh::default());
    for (x, z) in [(-0.30, 0.05), (0.31, 0.08), (0.05, -0.25)] {
        plates.append(&plate(0.095, p.round_sides).moved(on(x, z)));
        cups.append(&cup(p.small_sides * 2).turned_y(x).moved(on(x + 0.02, z + 0.17)));
        glasses.append(&tumbler(0.027, 0.034, 0.10, 0.0025, p.small_sides * 2).moved(on(x + 0.14, z + 0.02)));
    }
    model.add("plates", "porcelain", put(plates));
    model.add("cups", "porcelain", put(cups));
    model.add("glasses", "glass", put(glasses));
    let food = croissant()
        .moved(on(-0.30, 0.05) + at(0.0, 0.008, 0.0))
        .and(croissant().turned_y(0.3).moved(on(0.31, 0.08) + at(0.0, 0.008, 0.0)));
    model.add("croissants", "crust", put(food));
    model.add("apple", "red-petal", put(apple(p.small_sides * 2).moved(on(0.17, -0.14))));
    model.add("pear", "herb", put(pear(p.small_sides * 2).moved(on(0.25, -0.20))));
}
