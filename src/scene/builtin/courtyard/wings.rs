// SPDX-License-Identifier: MIT OR Apache-2.0
//! The arcades: columns, arches, galleries with doors and lamps. Each wing is made along x with its front towards +z.

use glam::{Vec2, Vec3};

use super::ground::{GALLERY, STEP};
use super::{Parameters, at, upstairs};
use crate::scene::builtin::mesh::{Mesh, cos_sin};
use crate::scene::builtin::model::Model;
use crate::scene::builtin::parts::cupboards::{Spot, knob, panelled};
use crate::scene::builtin::parts::lamps::{Lamp, pendant};
use crate::scene::builtin::parts::shell::curve;

/// Where arches begin.
pub const SPRING: f32 = 2.45;
/// Where the wall above the arches ends.
pub const UPPER: f32 = 4.1;
/// Thickness of the wall above the arches.
const THICK: f32 = 0.45;
/// Pieces of an arch.
const PIECES: u32 = 28;

/// A wing of the building.
pub struct Wing {
    /// Its name in objects' names.
    pub name: &'static str,
    /// How many arches.
    pub bays: u32,
    /// Its place.
    pub spot: Spot,
    /// Which of its ends meets another wing, which has the column there: -1, 1, or 0 for none.
    pub joined: i32,
}

impl Wing {
    /// x of the `i`-th column.
    pub fn column(&self, p: &Parameters, i: u32) -> f32 {
        (i as f32 - 0.5 * self.bays as f32) * p.bay
    }

    /// Adds a mesh of the wing.
    pub fn add(&self, model: &mut Model, what: &str, material: &str, mesh: Mesh) {
        model.add(format!("{}-{what}", self.name), material, self.spot.put(mesh));
    }
}

/// The three wings.
pub fn wings(p: &Parameters) -> [Wing; 3] {
    let middle = 0.5 * (p.back() + p.front());
    let x = p.half_wide();
    [
        Wing { name: "back", bays: p.bays[0], spot: Spot::new(0.0, at(0.0, 0.0, p.back())), joined: 0 },
        Wing { name: "left", bays: p.bays[1], spot: Spot::new(0.25, at(-x, 0.0, middle)), joined: 1 },
        Wing { name: "right", bays: p.bays[1], spot: Spot::new(-0.25, at(x, 0.0, middle)), joined: -1 },
    ]
}

/// Texture coordinates in metres from where a vertex lies and looks.
pub fn masonry(mut mesh: Mesh, scale: f32) -> Mesh {
    for ((t, q), n) in mesh.texcoords.iter_mut().zip(&mesh.positions).zip(&mesh.normals) {
        let a = n.abs();
        let plane = if a.y > a.x && a.y > a.z {
            Vec2::new(q.x, -q.z)
        } else if a.x > a.z {
            Vec2::new(q.z, q.y)
        } else {
            Vec2::new(q.x, q.y)
        };
        *t = plane * scale;
    }
    mesh
}

/// Adds all wings.
pub fn add(model: &mut Model, p: &Parameters) {
    let column = column(p.column_sides);
    let mut lamp = 0;
    for wing in &wings(p) {
        let mut columns = Mesh::default();
        for i in 0..=wing.bays {
            let end = if i == 0 { -1 } else { i32::from(i == wing.bays) };
            if end == 0 || end != wing.joined {
                columns.append(&column.clone().moved(at(wing.column(p, i), 0.0, -0.5 * THICK)));
            }
        }
        wing.add(model, "columns", "stone", masonry(columns, 0.5));
        let (mut arches, mut mouldings) = (Mesh::default(), Mesh::default());
        for i in 0..wing.bays {
            let x = wing.column(p, i) + 0.5 * p.bay;
            arches.append(&arch(x, p.bay));
            let radius = 0.5 * p.bay - 0.31;
            for (more, thick, z) in [(0.085, 0.040, 0.012), (0.020, 0.022, 0.006)] {
                let path: Vec<Vec3> = (0..=PIECES)
                    .map(|k| {
                        let (c, s) = cos_sin(0.5 * k as f32 / PIECES as f32);
                        at(x + c * (radius + more), SPRING + s * (radius + more), z)
                    })
                    .collect();
                mouldings.append(&Mesh::tube(&path, thick, 8, false));
            }
        }
        wing.add(model, "arches", "plaster", masonry(arches, 0.35));
        wing.add(model, "mouldings", "stone", masonry(mouldings, 0.5));
        gallery(model, p, wing);
        upstairs::add(model, p, wing);
        for i in 0..wing.bays {
            let place = wing.spot.point(at(wing.column(p, i) + 0.5 * p.bay, 2.75, -1.5));
            lamp += 1;
            pendant(
                model,
                lamp,
                &Lamp { at: place.to_array(), radius: 0.16 },
                "dark-green",
                UPPER - 0.195,
                p.round_sides / 2,
            );
        }
    }
}

/// A column with its plinth, base, capital and the block on it.
fn column(sides: u32) -> Mesh {
    let low = STEP - 0.004;
    let mut mesh = Mesh::rounded_block(at(-0.27, low, -0.27), at(0.27, low + 0.12, 0.27), 0.012);
    let mut profile = vec![(0.0, low + 0.119), (0.255, low + 0.119)];
    profile.extend(curve(&[(0.262, low + 0.135), (0.268, low + 0.16), (0.258, low + 0.185), (0.236, low + 0.195)], 4));
    profile.extend(curve(&[(0.226, low + 0.215), (0.230, low + 0.235), (0.236, low + 0.25), (0.222, low + 0.268)], 4));
    // The shaft swells a little.
    profile.extend((0..=12).map(|k| {
        let t = k as f32 / 12.0;
        (0.200 - 0.036 * t * t, 0.42 + 1.66 * t)
    }));
    profile.extend(curve(&[(0.182, 2.085), (0.186, 2.10), (0.180, 2.115), (0.166, 2.12)], 3));
    profile.extend(curve(&[(0.166, 2.15), (0.174, 2.20), (0.200, 2.26), (0.246, 2.315), (0.262, 2.335)], 5));
    profile.push((0.0, 2.336));
    mesh.append(&Mesh::lathe(&profile, sides));
    mesh.append(&Mesh::rounded_block(at(-0.29, 2.335, -0.29), at(0.29, SPRING + 0.002, 0.29), 0.014));
    // Leaves curl around the capital.
    for k in 0..8 {
        let leaf = Mesh::sheet(4, 6, |u, v| {
            let side = 2.0 * u - 1.0;
            let half = 0.060 * (1.0 - 0.7 * v * v);
            at(
                half * side,
                2.13 + 0.19 * v - 0.02 * v * v * v,
                0.172 + 0.10 * v * v + 0.035 * v * v * v - 0.02 * side * side,
            )
        });
        mesh.append(&leaf.turned_y(k as f32 / 8.0));
    }
    mesh
}

/// The wall above an arch: front, back, the arch's underside, and what rests on the columns.
fn arch(x: f32, bay: f32) -> Mesh {
    let radius = 0.5 * bay - 0.31;
    let mut mesh = Mesh::default();
    let point = |k: u32| {
        let (c, s) = cos_sin(0.5 * k as f32 / PIECES as f32);
        Vec2::new(x + c * radius, SPRING + s * radius)
    };
    let put = |p: Vec2, z: f32| at(p.x, p.y, z);
    for k in 0..PIECES {
        let (a, b) = (point(k + 1), point(k));
        let (c, d) = (Vec2::new(b.x, UPPER), Vec2::new(a.x, UPPER));
        mesh.append(&Mesh::quad([put(a, 0.0), put(b, 0.0), put(c, 0.0), put(d, 0.0)], Vec2::ONE));
        mesh.append(&Mesh::quad([put(b, -THICK), put(a, -THICK), put(d, -THICK), put(c, -THICK)], Vec2::ONE));
        mesh.append(&Mesh::quad([put(b, 0.0), put(a, 0.0), put(a, -THICK), put(b, -THICK)], Vec2::ONE));
    }
    for (x0, x1) in [(x - 0.5 * bay, x - radius), (x + radius, x + 0.5 * bay)] {
        let face =
            |x0: f32, x1: f32, z: f32| [at(x0, SPRING, z), at(x1, SPRING, z), at(x1, UPPER, z), at(x0, UPPER, z)];
        mesh.append(&Mesh::quad(face(x0, x1, 0.0), Vec2::ONE));
        mesh.append(&Mesh::quad(face(x1, x0, -THICK), Vec2::ONE));
        let low = [at(x0, SPRING, -THICK), at(x1, SPRING, -THICK), at(x1, SPRING, 0.0), at(x0, SPRING, 0.0)];
        mesh.append(&Mesh::quad(low, Vec2::ONE));
    }
    mesh
}

/// The gallery behind the arches: its wall with doors, its ceiling with beams.
fn gallery(model: &mut Model, p: &Parameters, wing: &Wing) {
    let half = 0.5 * wing.bays as f32 * p.bay;
    // Galleries reach into the corners where wings meet.
    let ends = match wing.joined {
        0 => [-half - GALLERY, half + GALLERY],
        1 => [-half, half + GALLERY],
        _ => [-half - GALLERY, half],
    };
    let face = |z: f32| [at(ends[0], 0.0, z), at(ends[1], 0.0, z), at(ends[1], UPPER, z), at(ends[0], UPPER, z)];
    wing.add(model, "wall", "ochre", masonry(Mesh::quad(face(-GALLERY), Vec2::ONE), 0.35));
    let high = UPPER - 0.004 * (1 + wing.joined) as f32 - 0.002;
    let ceiling = [
        at(ends[0], high, -GALLERY),
        at(ends[1], high, -GALLERY),
        at(ends[1], high, -THICK),
        at(ends[0], high, -THICK),
    ];
    wing.add(model, "ceiling", "plaster", masonry(Mesh::quad(ceiling, Vec2::ONE), 0.35));
    let (mut doors, mut knobs, mut casings, mut beams) =
        (Mesh::default(), Mesh::default(), Mesh::default(), Mesh::default());
    for i in 0..wing.bays {
        let x = wing.column(p, i) + 0.5 * p.bay;
        for k in 0..3 {
            let bx = x + p.bay * (k as f32 - 1.0) / 3.0;
            beams.append(&Mesh::block(
                at(bx - 0.06, UPPER - 0.20, -GALLERY + 0.001),
                at(bx + 0.06, UPPER + 0.03, -THICK + 0.02),
            ));
        }
        if i % 2 == 1 {
            continue;
        }
        let z = -GALLERY;
        for side in [-1.0f32, 1.0] {
            let leaf = |y: [f32; 2]| panelled([0.004, 0.60], y, 0.09);
            let both = leaf([STEP + 0.004, STEP + 1.0]).and(leaf([STEP + 1.003, STEP + 2.25]));
            let shift = if side < 0.0 { -0.604 } else { 0.0 };
            doors.append(&both.moved(at(x + shift, 0.0, z + 0.03)));
            knobs.append(&knob(0.028, p.small_sides).moved(at(x + side * 0.07, STEP + 1.05, z + 0.052)));
        }
        let block = |x0: f32, y0: f32, x1: f32, y1: f32| {
            Mesh::rounded_block(at(x + x0, y0, z - 0.002), at(x + x1, y1, z + 0.09), 0.012)
        };
        casings.append(&block(-0.78, 0.1, -0.602, STEP + 2.26));
        casings.append(&block(0.602, 0.1, 0.78, STEP + 2.26));
        casings.append(&block(-0.86, STEP + 2.26, 0.86, STEP + 2.46));
    }
    wing.add(model, "doors", "dark-green", doors);
    wing.add(model, "knobs", "brass", knobs);
    wing.add(model, "casings", "stone", masonry(casings, 0.5));
    wing.add(model, "beams", "dark-wood", beams.with_texture_scale(Vec2::splat(0.6)));
}
