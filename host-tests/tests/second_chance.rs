// SPDX-License-Identifier: MIT OR Apache-2.0
//! What goes beyond the paper's pairs of references, on scenes whose outcome is known from the geometry: other opposite
//! pairs of neighbours, and textures joined across their repetitions.
#![allow(clippy::unwrap_used)]

use glam::{DVec3, Vec2, Vec3};
use rarefy::internal::layout::*;
use rarefy::internal::math::unpack_texcoord;
use rarefy::internal::method::options::{RenderOptions, TextureRule, Tolerances};
use rarefy::internal::scene::{Material, Scene};
use rarefy_host_tests::fixtures::*;
use rarefy_host_tests::masks::*;

/// Two objects in one plane, parted by the line x = 0.1 + `lean` y.
fn parted(lean: f32) -> Scene {
    let mut builder = FRONT.seen_from(SceneBuilder::new("two objects"));
    let (x0, x1) = (0.1 - 9.0 * lean, 0.1 + 9.0 * lean);
    builder.object(matte(Vec3::X));
    builder.quad([v(-90.0, -9.0, 0.0), v(x0, -9.0, 0.0), v(x1, 9.0, 0.0), v(-90.0, 9.0, 0.0)]);
    builder.object(matte(Vec3::X));
    builder.quad([v(x0, -9.0, 0.0), v(90.0, -9.0, 0.0), v(90.0, 9.0, 0.0), v(x1, 9.0, 0.0)]);
    builder.build(1.0)
}

fn is_right(lean: f32, pixel: (u32, u32)) -> bool {
    let p = FRONT.on_wall(pixel, 0.0);
    let distance = p.x - 0.1 - f64::from(lean) * p.y;
    assert!(distance.abs() > 1e-5, "{pixel:?} is too near to the border to say");
    distance > 0.0
}

/// The class words of a frame, and its objects.
fn classes_and_objects(scene: &Scene, options: &RenderOptions) -> [Vec<u32>; 2] {
    let mut renderer = twin_renderer(scene.clone());
    draw(&mut renderer, options);
    [PLANE_CLASS, PLANE_OBJECT].map(|plane| renderer.plane(plane).unwrap())
}

#[test]
fn a_pixel_beside_a_straight_edge_needs_no_ray_if_any_opposite_pair_lies_on_one_side() {
    let (mut rescued, mut parted_in_all) = ([0; 3], 0);
    // Borders from upright to nearly level.
    for lean in [0.03, 0.3, 0.9, 1.7, 6.0] {
        let scene = parted(lean);
        for block in [2, 4] {
            let paper = adaptive(block, tolerances(1.0));
            let [classes, objects] =
                classes_and_objects(&scene, &with(&paper, |method| method.checks.second_pairs = true));
            let [before, _] = classes_and_objects(&scene, &paper);
            for (i, &class) in classes.iter().enumerate() {
                let (x, y) = (i as u32 % W, i as u32 / W);
                let right = |p| is_right(lean, p);
                assert_eq!(objects[i], u32::from(right((x, y))), "lean {lean}, blocks of {block}: {x}, {y}");
                // Half the distance between the rows that the pixel lies between.
                let d = if block == 4 && x % 2 == 0 && y % 2 == 0 { 2 } else { 1 };
                let is_odd = x % (2 * d) == d && y % (2 * d) == d;
                if !is_odd || y + d >= H || x + d >= W || right((x, y - d)) == right((x, y + d)) {
                    assert_eq!(class, before[i], "lean {lean}, blocks of {block}: {x}, {y} has no second chance");
                    continue;
                }
                let others =
                    [((x - d, y), (x + d, y)), ((x - d, y - d), (x + d, y + d)), ((x - d, y + d), (x + d, y - d))];
                let expected = match others.iter().position(|&(a, b)| right(a) == right(b)) {
                    Some(pair) => {
                        rescued[pair] += 1;
                        CLASS_INTERPOLATED
                    }
                    None => {
                        parted_in_all += 1;
                        CLASS_TRACED | FAIL_G1
                    }
                };
                assert_eq!(class, expected, "lean {lean}, blocks of {block}: {x}, {y}");
                assert_eq!(before[i], CLASS_TRACED | FAIL_G1, "lean {lean}, blocks of {block}: {x}, {y}");
            }
        }
    }
    println!("{rescued:?} pixels rescued by each pair, {parted_in_all} parted in all directions");
    assert!(rescued[0] > 50 && rescued[1] + rescued[2] > 10 && parted_in_all > 0, "{rescued:?}, {parted_in_all}");
}

#[test]
fn a_pair_that_agrees_with_neither_reference_is_no_help() {
    // One odd row of pixels of an object of its own, between an object above and another below: left and right of each
    // pixel in it look alike, but like neither of them.
    let mut builder = FRONT.seen_from(SceneBuilder::new("stripe"));
    let above = |y: u32| ((FRONT.on_wall((0, y), 0.0).y + FRONT.on_wall((0, y - 1), 0.0).y) / 2.0) as f32;
    for (bottom, top) in [(above(21), 9.0), (above(22), above(21)), (-9.0, above(22))] {
        builder.object(matte(Vec3::X));
        builder.wall(Vec2::new(-9.0, bottom), Vec2::new(9.0, top), 0.0);
    }
    let options = with(&adaptive(2, tolerances(1.0)), |method| method.checks.second_pairs = true);
    let mask = |a: (u32, u32), b: (u32, u32)| if a.1 == 20 && b.1 == 22 { FAIL_G1 } else { 0 };
    assert_eq!(mismatches(&builder.build(1.0), &options, &mask), Vec::<String>::new());
}

/// A wall whose texture repeats every 1.25 units.
fn tiles() -> Scene {
    let mut builder = FRONT.seen_from(SceneBuilder::new("tiles"));
    let texture = builder.texture(2, vec![0xff00_00ff, 0xff00_ff00, 0xffff_0000, 0xffff_ffff]);
    builder.object(Material { diffuse_texture: Some(texture), ..matte(Vec3::ONE) });
    let at = |x: f32, y: f32| (v(x, y, 0.0), Vec2::new(x * 0.8 + 0.513, y * 0.8 + 0.227));
    let corners = [at(-4.0, -4.0), at(4.0, -4.0), at(4.0, 4.0), at(-4.0, 4.0)];
    builder.quad_with(corners.map(|c| c.0), corners.map(|c| c.1));
    builder.build(1.0)
}

#[test]
fn textures_are_joined_across_their_repetitions() {
    let t = tolerances(1.0);
    let joined = |t_tex: f32| {
        with(&adaptive(2, Tolerances { t_tex, ..t }), |method| method.checks.textures = TextureRule::Joined)
    };
    // Two pixels are this far apart on the texture.
    let step = (FRONT.on_wall((2, 0), 0.0) - FRONT.on_wall((0, 0), 0.0)).length() as f32 * 0.8;
    assert_eq!(mismatches(&tiles(), &joined(1.001 * step), &|_, _| 0), Vec::<String>::new());
    assert_eq!(mismatches(&tiles(), &joined(0.999 * step), &|_, _| FAIL_TX), Vec::<String>::new());

    let mut renderer = twin_renderer(tiles());
    let mut largest_error = |options: &RenderOptions| {
        draw(&mut renderer, options);
        let words = renderer.plane(PLANE_TEXCOORD).unwrap();
        let pixels = (0..H).flat_map(|y| (0..W).map(move |x| (x, y)));
        let error = |(i, pixel): (usize, (u32, u32))| {
            let p: DVec3 = FRONT.on_wall(pixel, 0.0);
            let [ds, dt] =
                [(words[i] & 0xffff, p.x * 0.8 + 0.513), (words[i] >> 16, p.y * 0.8 + 0.227)].map(|(half, exact)| {
                    let found = f64::from(unpack_texcoord(half));
                    assert!((0.0..1.0).contains(&found), "{pixel:?}: {found}");
                    let e = (found - exact).rem_euclid(1.0);
                    e.min(1.0 - e)
                });
            ds.max(dt)
        };
        pixels.enumerate().map(error).fold(0.0, f64::max)
    };
    let error = largest_error(&joined(0.3));
    // Half a step of 16 bits for each of the levels that a coordinate passes.
    assert!(error < 3e-5, "a texture coordinate is off by {error}");
    // Negative control: without the test and without joining, coordinates beside a repetition are far off.
    let error = largest_error(&without(&adaptive(2, t), FAIL_TX));
    assert!(error > 0.3, "{error}");
}
