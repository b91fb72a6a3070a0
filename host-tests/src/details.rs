// SPDX-License-Identifier: MIT OR Apache-2.0
//! Scenes whose detail lies at the limits of undersampling, at 256x256 pixels: things one pixel wide, texture that repeats
//! within a few pixels, patterns behind glass and in mirrors.
#![allow(clippy::unwrap_used)]

use glam::{Vec2, Vec3};
use rarefy::Scene;
use rarefy::internal::scene::{Material, Surface};

use crate::command::root;
use crate::fixtures::{ONCE, Random, SceneBuilder, glass, matte, mirror, v};

/// Width and height of the pictures.
pub const SIDE: u32 = 256;

/// What every group of scenes is called, with its scenes.
pub fn scenes() -> Vec<(String, Scene)> {
    let mut scenes = vec![
        // The second column of every four.
        ("fence on odd columns".into(), bars(0.0, (1..SIDE).step_by(4).map(|column| strip(column, 0.9)))),
        ("slats on odd rows".into(), bars(0.0, (1..SIDE).step_by(4).map(|row| turned(strip(row, 0.9))))),
        ("one wire".into(), bars(0.0, std::iter::once(strip(129, 0.9)))),
        ("dots".into(), bars(0.0, dots())),
    ];
    for degrees in [1.0_f32, 5.0, 10.0, 30.0] {
        let posts = (0..61).map(|k| upright(-0.9375 + 0.03125 * k as f32, 0.003, 0.9));
        scenes.push((format!("fence at {degrees} degrees"), bars(degrees, posts)));
    }
    scenes.push(("hair".into(), hair()));
    let text = image::open(root().join("host-tests/textures/text.png")).unwrap().into_rgba8();
    let text: Vec<u32> = text.pixels().map(|p| u32::from_le_bytes(p.0)).collect();
    scenes.push(("text behind a pane".into(), board(512, text.clone(), 1.0, true)));
    scenes.push(("text in a mirror".into(), text_in_a_mirror(text)));
    for (side, pane) in [(1, false), (1, true), (2, true)] {
        let name = format!("checks of {side} pixel{}", if pane { " behind a pane" } else { "" });
        scenes.push((name, board(SIDE, checks(SIDE, side), 1.0, pane)));
    }
    for repeats in [40, 100, 128] {
        scenes.push((format!("{repeats} repeats"), board(16, checks(16, 8), repeats as f32, false)));
    }
    scenes.push(("floor to the horizon".into(), floor()));
    scenes
}

fn checks(width: u32, side: u32) -> Vec<u32> {
    let texel = |x: u32, y: u32| if (x / side + y / side).is_multiple_of(2) { 0xff14_1414 } else { 0xffeb_ebeb };
    (0..width).flat_map(|y| (0..width).map(move |x| texel(x, y))).collect()
}

/// A camera that sees the square from -1 to 1 of the plane z = 0, each pixel 1/128 wide.
fn view() -> SceneBuilder {
    let fov = 2.0 * 0.025_f32.atan().to_degrees();
    let builder = SceneBuilder::new("details").camera(v(0.0, 0.0, 40.0), Vec3::ZERO, fov);
    builder.light(v(0.7, 1.1, 3.0), 9.0).environment(0.2, Vec3::ZERO)
}

type Corners = [Vec2; 4];

fn upright(x: f32, half_width: f32, half_height: f32) -> Corners {
    let at = |sx: f32, sy: f32| Vec2::new(x + sx * half_width, sy * half_height);
    [at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)]
}

/// Covers the middle of one column of pixels, and little more.
fn strip(column: u32, half_height: f32) -> Corners {
    upright((column as f32 + 0.5) / 128.0 - 1.0, 0.0034, half_height)
}

/// Rows for columns.
fn turned(corners: Corners) -> Corners {
    let mut corners = corners.map(|c| Vec2::new(c.y, -c.x));
    corners.rotate_left(1);
    corners
}

fn dots() -> impl Iterator<Item = Corners> {
    let middle = |pixel: u32| (pixel as f32 + 0.5) / 128.0 - 1.0;
    let places = (1..SIDE).step_by(6).flat_map(|y| (1..SIDE).step_by(6).map(move |x| (x, y)));
    places.map(move |(x, y)| upright(middle(x), 0.0034, 0.0034).map(|c| c - Vec2::Y * middle(y)))
}

/// Red quads just before a grey wall, turned by an angle.
fn bars(degrees: f32, quads: impl Iterator<Item = Corners>) -> Scene {
    let mut builder = view();
    builder.object(matte(Vec3::splat(0.8)));
    builder.wall(Vec2::splat(-1.2), Vec2::splat(1.2), 0.0);
    let turn = Vec2::from_angle(degrees.to_radians());
    builder.object(matte(v(0.8, 0.1, 0.1)));
    for corners in quads {
        builder.quad(corners.map(|c| turn.rotate(c).extend(0.01)));
    }
    builder.build(2.0)
}

/// 400 needles that stand on a floor.
fn hair() -> Scene {
    let mut builder = SceneBuilder::new("hair").camera(v(0.0, 1.5, 4.0), v(0.0, 0.9, 0.0), 40.0);
    builder = builder.light(v(3.0, 8.0, 4.0), 80.0).environment(0.25, v(0.4, 0.55, 0.8));
    builder.object(matte(Vec3::splat(0.7)));
    builder.floor(Vec2::splat(-6.0), Vec2::splat(6.0), 0.0);
    builder.object(matte(v(0.3, 0.2, 0.1)));
    let mut random = Random::new(56);
    for _ in 0..400 {
        let root = v(random.range(-0.42, 0.42), 0.0, random.range(-0.42, 0.42));
        let tip = root + v(random.range(-0.4, 0.4), random.range(1.0, 2.0), random.range(-0.4, 0.4));
        builder.triangle([root, root + v(0.008, 0.0, 0.0), tip]);
    }
    builder.build(20.0)
}

/// A textured square that fills the picture, if wanted behind clear glass.
fn board(width: u32, texels: Vec<u32>, repeats: f32, pane: bool) -> Scene {
    let mut builder = view();
    let texture = builder.texture(width, texels);
    builder.object(Material { diffuse_texture: Some(texture), ..matte(Vec3::ONE) });
    let corners = ONCE.map(|c| (2.0 * c - Vec2::ONE).extend(0.0));
    builder.quad_with(corners, ONCE.map(|c| c * repeats));
    if pane {
        builder.object(glass(Surface::ThinGlass, 1.5));
        builder.quad(corners.map(|c| c + 0.3 * Vec3::Z));
    }
    builder.build(2.0)
}

/// A wall behind the camera, seen in a mirror that fills the picture.
fn text_in_a_mirror(text: Vec<u32>) -> Scene {
    let mut builder = SceneBuilder::new("mirror").camera(v(0.0, 0.0, 2.4), Vec3::ZERO, 45.0);
    builder.object(mirror(0.95));
    builder.wall(Vec2::splat(-2.0), Vec2::splat(2.0), 0.0);
    let texture = builder.texture(512, text);
    builder.object(Material { diffuse_texture: Some(texture), ..matte(Vec3::ONE) });
    builder.quad_with([v(2.0, -2.0, 2.6), v(-2.0, -2.0, 2.6), v(-2.0, 2.0, 2.6), v(2.0, 2.0, 2.6)], ONCE);
    builder.build(2.0)
}

/// Checks of half a unit on a floor of a thousand.
fn floor() -> Scene {
    let mut builder = SceneBuilder::new("floor").camera(v(0.0, 1.7, 5.0), v(0.0, 1.0, -10.0), 50.0);
    builder = builder.light(v(3.0, 8.0, 4.0), 80.0).environment(0.25, v(0.4, 0.55, 0.8));
    let texture = builder.texture(16, checks(16, 8));
    builder.object(Material { diffuse_texture: Some(texture), ..matte(Vec3::ONE) });
    let corners = [v(-500.0, 0.0, 500.0), v(500.0, 0.0, 500.0), v(500.0, 0.0, -500.0), v(-500.0, 0.0, -500.0)];
    builder.quad_with(corners, ONCE.map(|c| c * 1000.0));
    builder.build(20.0)
}
