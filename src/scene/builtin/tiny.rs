// SPDX-License-Identifier: MIT OR Apache-2.0
//! Four tiny scenes for tests: each is simple enough to know by hand what its picture must be.

use glam::{Vec2, Vec3};
use serde::Deserialize;

use super::check;
use super::mesh::{Mesh, Random};
use super::model::{Finish, Model};
use super::paint::{Canvas, clouds, mix};
use crate::Result;
use crate::scene::Surface;

/// Parameters of `wall`: a square in the plane z = 0 about the origin.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wall {
    /// Half the length of the wall's sides, in metres.
    pub half_size: f32,
    /// Linear RGB of the wall.
    pub colour: [f32; 3],
}

/// Makes `wall`: one flat-coloured wall that fills the view.
pub fn wall(p: &Wall, view: &'static str) -> Result<Model> {
    check("wall", "half_size", p.half_size, 0.1..=100.0)?;
    let mut model = Model::new("wall", view);
    model.materials.push(Finish::matte("paint", p.colour));
    let h = p.half_size;
    model.add("wall", "paint", facing_z([-h, -h], [h, h], 0.0, Vec2::ONE));
    Ok(model)
}

/// A rectangle in a plane of constant z that faces +z.
fn facing_z(lo: [f32; 2], hi: [f32; 2], z: f32, repeats: Vec2) -> Mesh {
    let p = |x: f32, y: f32| Vec3::new(x, y, z);
    Mesh::quad([p(lo[0], lo[1]), p(hi[0], lo[1]), p(hi[0], hi[1]), p(lo[0], hi[1])], repeats)
}

/// Parameters of `spheres`: three spheres of radius 1 side by side on the floor y = 0.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Spheres {
    /// Distance between the middles of neighbours, in metres.
    pub spacing: f32,
    /// Radius of each sphere, in metres.
    pub radius: f32,
    /// Sides of each sphere around its axis; half as many rings.
    pub sides: u32,
    /// Half the length of the floor's sides, in metres.
    pub floor_half_size: f32,
    /// Length of one square of the floor's checks, in metres.
    pub check: f32,
    /// Width and height of the checks' texture, in texels.
    pub texture: u32,
}

/// Makes `spheres`: a diffuse, a mirror and a glass sphere on a checked floor.
pub fn spheres(p: &Spheres, view: &'static str) -> Result<Model> {
    check("spheres", "sides", p.sides as f32, 6.0..=200.0)?;
    check("spheres", "radius", p.radius, 0.01..=10.0)?;
    check("spheres", "spacing", p.spacing, 2.0 * p.radius..=40.0)?;
    check("spheres", "floor_half_size", p.floor_half_size, 1.0..=100.0)?;
    check("spheres", "check", p.check, 0.01..=10.0)?;
    check("spheres", "texture", p.texture as f32, 2.0..=1024.0)?;
    let mut model = Model::new("spheres", view);
    model.materials = vec![
        Finish::matte("floor", [1.0; 3]).with_texture("checks.png"),
        Finish::glossy("clay", [0.7, 0.2, 0.1], 0.2, 40.0),
        Finish::mirror("silver", [0.0; 3], [0.9; 3]),
        Finish::glass("glass", Surface::Glass, [1.0; 3]),
    ];
    let dark = |u: f32, v: f32| (u < 0.5) == (v < 0.5);
    model.add_picture(
        "checks.png",
        Canvas::new(p.texture, p.texture, |u, v| if dark(u, v) { [0.25, 0.27, 0.32] } else { [0.9, 0.88, 0.82] }),
    );
    let h = p.floor_half_size;
    let floor = Mesh::quad(
        [Vec3::new(-h, 0.0, h), Vec3::new(h, 0.0, h), Vec3::new(h, 0.0, -h), Vec3::new(-h, 0.0, -h)],
        Vec2::ONE,
    )
    .with_plan_texture(0.5 / p.check);
    model.add("floor", "floor", floor);
    for (i, (name, material)) in [("diffuse", "clay"), ("mirror", "silver"), ("glass", "glass")].into_iter().enumerate()
    {
        let x = (i as f32 - 1.0) * p.spacing;
        model.add(name, material, Mesh::sphere(p.radius, p.sides, p.sides / 2).moved(Vec3::new(x, p.radius, 0.0)));
    }
    Ok(model)
}

/// Parameters of `rods`: thin rods in front of the wall z = 0.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rods {
    /// Half the length of the wall's sides, in metres.
    pub wall_half_size: f32,
    /// Number of rods; every other one is slanted.
    pub count: u32,
    /// Radius of the thinnest rod, in metres.
    pub thinnest: f32,
    /// Radius of the thickest rod, in metres.
    pub thickest: f32,
    /// Height of the rods, in metres.
    pub height: f32,
    /// Sideways distance between neighbours, in metres.
    pub spacing: f32,
    /// Distance from the wall, in metres.
    pub distance: f32,
    /// How far the slanted rods' upper ends lean to the side, in metres.
    pub slant: f32,
    /// Sides of each rod.
    pub sides: u32,
}

/// Makes `rods`: thin upright and slanted rods and their shadows on a wall.
pub fn rods(p: &Rods, view: &'static str) -> Result<Model> {
    check("rods", "count", p.count as f32, 2.0..=200.0)?;
    check("rods", "sides", p.sides as f32, 3.0..=64.0)?;
    check("rods", "thinnest", p.thinnest, 0.001..=1.0)?;
    check("rods", "thickest", p.thickest, p.thinnest..=1.0)?;
    check("rods", "height", p.height, 0.1..=10.0)?;
    check("rods", "wall_half_size", p.wall_half_size, 0.1..=100.0)?;
    let mut model = Model::new("rods", view);
    model.materials = vec![
        Finish::matte("plaster", [0.75, 0.72, 0.65]),
        Finish::glossy("red", [0.65, 0.08, 0.06], 0.3, 60.0),
        Finish::glossy("blue", [0.08, 0.15, 0.55], 0.3, 60.0),
    ];
    let h = p.wall_half_size;
    model.add("wall", "plaster", facing_z([-h, -h], [h, h], 0.0, Vec2::ONE));
    for i in 0..p.count {
        let x = (i as f32 - (p.count - 1) as f32 * 0.5) * p.spacing;
        let radius = p.thinnest + (p.thickest - p.thinnest) * i as f32 / (p.count - 1) as f32;
        let lean = if i % 2 == 1 { p.slant * 0.5 } else { 0.0 };
        let y = p.height * 0.5;
        let path = [Vec3::new(x - lean, -y, p.distance), Vec3::new(x + lean, y, p.distance)];
        let material = if i % 2 == 1 { "blue" } else { "red" };
        model.add(format!("rod-{}", i + 1), material, Mesh::tube(&path, radius, p.sides, false));
    }
    Ok(model)
}

/// Parameters of `mirror-room`: a closed room about the y axis that stands on y = 0.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MirrorRoom {
    /// Width (x), height (y) and depth (z), in metres.
    pub size: [f32; 3],
    /// How often the left wall's texture repeats across and upwards.
    pub repeats: [f32; 2],
    /// Width and height of that texture, in texels.
    pub texture: u32,
    /// Number of boxes.
    pub boxes: u32,
    /// Seed of the boxes' sizes and turns.
    pub seed: u32,
}

/// Makes `mirror-room`: a closed room whose back wall is a mirror, with boxes and a wall of repeating texture.
pub fn mirror_room(p: &MirrorRoom, view: &'static str) -> Result<Model> {
    let [w, h, d] = p.size;
    for (key, v) in [("size", w), ("size", h), ("size", d)] {
        check("mirror-room", key, v, 2.0..=50.0)?;
    }
    check("mirror-room", "texture", p.texture as f32, 2.0..=1024.0)?;
    check("mirror-room", "boxes", p.boxes as f32, 1.0..=5.0)?;
    let mut model = Model::new("mirror-room", view);
    model.materials = vec![
        Finish::matte("white", [0.75, 0.74, 0.70]),
        Finish::matte("floor", [0.35, 0.30, 0.25]),
        Finish::matte("tiles", [1.0; 3]).with_texture("tiles.png"),
        Finish::mirror("mirror", [0.02; 3], [0.92, 0.94, 0.93]),
    ];
    model.add_picture(
        "tiles.png",
        Canvas::new(p.texture, p.texture, |u, v| {
            let joint = u.min(v).min(1.0 - u).min(1.0 - v) < 0.04;
            let glaze = mix([0.15, 0.45, 0.55], [0.30, 0.62, 0.66], clouds(u, v, 4, 11));
            if joint { [0.85, 0.83, 0.78] } else { glaze }
        }),
    );
    let (x, z) = (w * 0.5, d * 0.5);
    let p3 = Vec3::new;
    let one = Vec2::ONE;
    let right = [p3(x, 0.0, z), p3(x, 0.0, -z), p3(x, h, -z), p3(x, h, z)];
    let left = [p3(-x, 0.0, z), p3(-x, 0.0, -z), p3(-x, h, -z), p3(-x, h, z)];
    let flip = |c: [Vec3; 4]| [c[1], c[0], c[3], c[2]];
    model.add("floor", "floor", Mesh::quad([left[0], right[0], right[1], left[1]], one));
    model.add("ceiling", "white", Mesh::quad([left[2], right[2], right[3], left[3]], one));
    model.add("left", "tiles", Mesh::quad(left, p.repeats.into()));
    model.add("right", "white", Mesh::quad(flip(right), one));
    model.add("front", "white", Mesh::quad([right[0], left[0], left[3], right[3]], one));
    model.add("back", "mirror", Mesh::quad([left[1], right[1], right[2], left[2]], one));
    let colours = [[0.60, 0.12, 0.10], [0.12, 0.45, 0.15], [0.12, 0.20, 0.55], [0.65, 0.50, 0.10], [0.45, 0.15, 0.45]];
    let mut random = Random::new(p.seed);
    for i in 0..p.boxes {
        let name = format!("box-{}", i + 1);
        model.materials.push(Finish::matte(&name, colours[i as usize % colours.len()]));
        let place = (i as f32 + 0.5) / p.boxes as f32 - 0.5;
        let (side, tall) = (random.range(0.06, 0.09) * w, random.range(0.15, 0.45) * h);
        let block = Mesh::block(Vec3::new(-side, 0.0, -side), Vec3::new(side, tall, side));
        let at = Vec3::new(place * w * 0.85, 0.0, random.range(-0.25, 0.1) * d);
        model.add(&name, &name, block.turned_y(random.range(0.0, 0.25)).moved(at));
    }
    Ok(model)
}
