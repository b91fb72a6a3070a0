// SPDX-License-Identifier: MIT OR Apache-2.0
//! The seven similarity tests on scenes whose fail masks are known: each scene is made so that one test alone must
//! light up, and the test says at which pixels from the geometry, not from what the twin traced.
#![allow(clippy::unwrap_used)]

use glam::{DVec3, Vec2, Vec3};
use rarefy::internal::layout::*;
use rarefy::internal::method::options::Tolerances;
use rarefy::internal::scene::{Material, Scene};
use rarefy_host_tests::fixtures::*;
use rarefy_host_tests::masks::*;

/// Checks that test `fail` alone lights up, at the pixels where `differ` says, for both sizes of blocks; and that with
/// the test switched off the mask lacks it and those pixels are interpolated.
fn one_test_lights_up(
    name: &str,
    scene: &Scene,
    t: Tolerances,
    fail: u32,
    differ: &dyn Fn((u32, u32), (u32, u32)) -> bool,
) {
    let mask = |a, b| if differ(a, b) { fail } else { 0 };
    for block in [2, 4] {
        let wrong = mismatches(scene, &adaptive(block, t), &mask);
        assert!(
            wrong.is_empty(),
            "{name}, blocks of {block}: {} wrong, {:#?}",
            wrong.len(),
            &wrong[..wrong.len().min(9)]
        );
    }
    let pixels = || (0..H).flat_map(|y| (0..W).map(move |x| (x, y)));
    let lit = pixels().filter(|&p| matches!(role(p, (W, H), 2), Role::Between([a, b]) if differ(a, b))).count();
    assert!((20..2 * (W * H) as usize / 3).contains(&lit), "{name}: {lit} pixels say little");

    let off = without(&adaptive(2, t), fail);
    let wrong = mismatches(scene, &off, &|_, _| 0);
    assert!(wrong.is_empty(), "{name}, switched off: {} wrong, {:#?}", wrong.len(), &wrong[..wrong.len().min(9)]);

    // Negative controls: the comparison notices another bit, a shifted mask, and a mask where there is none.
    let other = if fail == FAIL_GC { FAIL_G1 } else { fail << 1 };
    let on = adaptive(2, t);
    assert_eq!(mismatches(scene, &on, &|a, b| if differ(a, b) { other } else { 0 }).len(), lit);
    assert!(!mismatches(scene, &on, &|a, b| mask((a.0 + 2, a.1 + 2), (b.0 + 2, b.1 + 2))).is_empty(), "{name}");
    assert_eq!(mismatches(scene, &off, &mask).len(), lit, "{name}");
}

/// The slanted line that several scenes are split by; the sign says on which side of it a point lies.
fn side(p: DVec3) -> bool {
    let distance = p.x - 0.1 - 0.3 * p.y;
    assert!(distance.abs() > 1e-4, "{p} is too near to the border to say");
    distance > 0.0
}

/// Adds the part of the plane `z` to the left or right of that line to the last object.
fn half_wall(builder: &mut SceneBuilder, right: bool, z: f32) {
    let (x0, x1, far) = (0.1 - 0.3 * 9.0, 0.1 + 0.3 * 9.0, 9.0);
    builder.quad(if right {
        [v(x0, -9.0, z), v(far, -9.0, z), v(far, 9.0, z), v(x1, 9.0, z)]
    } else {
        [v(-far, -9.0, z), v(x0, -9.0, z), v(x1, 9.0, z), v(-far, 9.0, z)]
    });
}

#[test]
fn g1_lights_up_where_two_objects_meet() {
    let mut builder = FRONT.seen_from(SceneBuilder::new("two objects"));
    builder.object(matte(Vec3::X));
    half_wall(&mut builder, false, 0.0);
    builder.object(matte(Vec3::X));
    half_wall(&mut builder, true, 0.0);
    let is_right = |p| side(FRONT.on_wall(p, 0.0));
    one_test_lights_up("G1", &builder.build(1.0), tolerances(1.0), FAIL_G1, &|a, b| is_right(a) != is_right(b));
}

#[test]
fn g1_lights_up_where_an_object_ends_before_the_background() {
    let mut builder = FRONT.seen_from(SceneBuilder::new("half a wall"));
    builder.object(matte(Vec3::X));
    half_wall(&mut builder, false, 0.0);
    let is_right = |p| side(FRONT.on_wall(p, 0.0));
    one_test_lights_up("G1", &builder.build(1.0), tolerances(1.0), FAIL_G1, &|a, b| is_right(a) != is_right(b));
}

#[test]
fn g2_lights_up_where_a_floor_runs_away() {
    let eye = Eye { at: DVec3::new(0.0, 1.0, 0.0), look_at: DVec3::new(0.0, 0.4, -1.0), fov_degrees: 50.0 };
    let mut builder = eye.seen_from(SceneBuilder::new("floor"));
    builder.object(matte(Vec3::ONE));
    builder.floor(Vec2::splat(-400.0), Vec2::splat(400.0), 0.0);
    let at = |p| {
        let d = eye.direction(p);
        eye.at + d * (-eye.at.y / d.y)
    };
    // A fifth of the extent of 2.
    one_test_lights_up("G2", &builder.build(2.0), tolerances(0.2), FAIL_G2, &|a, b| {
        let distance = at(a).distance(at(b));
        assert!((distance - 0.4).abs() > 1e-5, "{distance} is too near to the tolerance to say");
        distance > 0.4
    });
}

/// Two walls of one object, one behind the other.
fn depth_step() -> Scene {
    let mut builder = FRONT.seen_from(SceneBuilder::new("step"));
    builder.object(matte(Vec3::ONE));
    half_wall(&mut builder, true, 0.0);
    builder.wall(Vec2::splat(-9.0), Vec2::splat(9.0), -0.5);
    builder.build(1.0)
}

#[test]
fn g2_lights_up_at_a_step_in_depth() {
    let differ = |a, b| side(FRONT.on_wall(a, 0.0)) != side(FRONT.on_wall(b, 0.0));
    // Over a step between parallel walls one normal looks uphill and one downhill, too: with G4's tolerance at the sine
    // of a right angle, everything counts as flat and G2 is alone.
    let flat = Tolerances { t_conv: 1.0, ..tolerances(0.3) };
    one_test_lights_up("G2", &depth_step(), flat, FAIL_G2, &differ);
    let both = |a, b| if differ(a, b) { FAIL_G2 | FAIL_G4 } else { 0 };
    for block in [2, 4] {
        assert_eq!(mismatches(&depth_step(), &adaptive(block, tolerances(0.3)), &both), Vec::<String>::new());
    }
}

#[test]
fn g3_lights_up_at_a_fold() {
    // Two walls of one object that fall off to both sides of the line.
    let k = 0.7;
    let mut builder = FRONT.seen_from(SceneBuilder::new("fold"));
    builder.object(matte(Vec3::ONE));
    let at = |s: f32, y: f32| v(0.1 + 0.3 * y + s, y, -k * s.abs());
    builder.quad([at(-5.0, -9.0), at(0.0, -9.0), at(0.0, 9.0), at(-5.0, 9.0)]);
    builder.quad([at(0.0, -9.0), at(5.0, -9.0), at(5.0, 9.0), at(0.0, 9.0)]);
    // The fold itself lies in z = 0: a ray falls on the side on which it crosses that plane.
    let is_right = |p| side(FRONT.on_wall(p, 0.0));
    one_test_lights_up("G3", &builder.build(1.0), tolerances(1.0), FAIL_G3, &|a, b| is_right(a) != is_right(b));
}

/// A profile that bends up and back: (x, z, tilt of the normal towards -x in degrees) of each vertex.
const S_PROFILE: [(f64, f64, f64); 6] = [
    (-4.0, 0.0, 0.0),
    (-0.6, 0.0, 0.0),
    (-0.4, 0.0, 10.0),
    (0.4, 0.291_176, 10.0),
    (0.6, 0.291_176, 0.0),
    (4.0, 0.291_176, 0.0),
];

/// The point of the profile that a ray finds, with its normal.
fn on_profile(pixel: (u32, u32)) -> (DVec3, DVec3) {
    let d = FRONT.direction(pixel);
    let found = S_PROFILE.windows(2).find_map(|pair| {
        let [(x0, z0, tilt0), (x1, z1, tilt1)] = [pair[0], pair[1]];
        // at + t d = p0 + k (p1 - p0) in x and z
        let (ex, ez) = (x1 - x0, z1 - z0);
        let det = d.x * -ez + d.z * ex;
        let (rx, rz) = (x0 - FRONT.at.x, z0 - FRONT.at.z);
        let (t, k) = ((rx * -ez + rz * ex) / det, (d.x * rz - d.z * rx) / det);
        let normal = |tilt: f64| DVec3::new(-tilt.to_radians().sin(), 0.0, tilt.to_radians().cos());
        let n = normal(tilt0) * (1.0 - k) + normal(tilt1) * k;
        (0.0..1.0).contains(&k).then(|| (FRONT.at + d * t, n.normalize()))
    });
    found.unwrap()
}

#[test]
fn g4_lights_up_on_an_s_shaped_patch() {
    let mut builder = FRONT.seen_from(SceneBuilder::new("S"));
    builder.object(matte(Vec3::ONE));
    for pair in S_PROFILE.windows(2) {
        let p = |i: usize, y: f32| v(pair[i].0 as f32, y, pair[i].1 as f32);
        let n = |i: usize| {
            let tilt = pair[i].2.to_radians() as f32;
            v(-tilt.sin(), 0.0, tilt.cos())
        };
        let texcoords = [Vec2::ZERO; 3];
        builder.triangle_with([p(0, -4.0), p(1, -4.0), p(1, 4.0)], [n(0), n(1), n(1)], texcoords);
        builder.triangle_with([p(0, -4.0), p(1, 4.0), p(0, 4.0)], [n(0), n(1), n(0)], texcoords);
    }
    let differ = |a, b| {
        let ((pa, na), (pb, nb)) = (on_profile(a), on_profile(b));
        let e = (pb - pa).normalize();
        let slope = |s: f64| {
            assert!((s.abs() - 0.05).abs() > 1e-4, "a slope of {s} is too near to the tolerance to say");
            if s.abs() <= 0.05 { 0.0 } else { s }
        };
        slope(e.dot(na)) * slope(-e.dot(nb)) < 0.0
    };
    one_test_lights_up_in_rows("G4", &builder.build(1.0), FAIL_G4, &differ);
}

/// As [`one_test_lights_up`] for a scene that is the same in every row, blocks of 2 alone: pixels between blocks of 4
/// are interpolated across the bends, and are then no longer what the geometry says.
fn one_test_lights_up_in_rows(name: &str, scene: &Scene, fail: u32, differ: &dyn Fn((u32, u32), (u32, u32)) -> bool) {
    let mask = |a: (u32, u32), b: (u32, u32)| if a.1 == b.1 && differ(a, b) { fail } else { 0 };
    let on = adaptive(2, tolerances(1.0));
    let wrong = mismatches(scene, &on, &mask);
    assert!(wrong.is_empty(), "{name}: {} wrong, {:#?}", wrong.len(), &wrong[..wrong.len().min(9)]);
    let lit: Vec<u32> = (1..W - 1).step_by(2).filter(|&x| differ((x - 1, 0), (x + 1, 0))).collect();
    assert!((5..20).contains(&lit.len()), "{name}: lit columns {lit:?}");
    let off = without(&on, fail);
    assert_eq!(mismatches(scene, &off, &|_, _| 0), Vec::<String>::new(), "{name}");
    assert_eq!(mismatches(scene, &on, &|_, _| 0).len(), lit.len() * (H / 2) as usize, "{name}");
}

/// A wall whose texture repeats every 1.25 units; `textured` says whether its material shows one.
fn tiles(textured: bool) -> Scene {
    let mut builder = FRONT.seen_from(SceneBuilder::new("tiles"));
    let texture = builder.texture(2, vec![0xff00_00ff, 0xff00_ff00, 0xffff_0000, 0xffff_ffff]);
    builder.object(Material { diffuse_texture: textured.then_some(texture), ..matte(Vec3::ONE) });
    let at = |x: f32, y: f32| (v(x, y, 0.0), Vec2::new(x * 0.8 + 0.513, y * 0.8 + 0.227));
    let corners = [at(-4.0, -4.0), at(4.0, -4.0), at(4.0, 4.0), at(-4.0, 4.0)];
    builder.quad_with(corners.map(|c| c.0), corners.map(|c| c.1));
    builder.build(1.0)
}

/// In which repetition of the texture a pixel lies.
fn tile(pixel: (u32, u32)) -> [i64; 2] {
    let p = FRONT.on_wall(pixel, 0.0);
    [p.x * 0.8 + 0.513, p.y * 0.8 + 0.227].map(|c| {
        assert!((c - c.round()).abs() > 1e-4, "{c} is too near to the texture's border to say");
        c.floor() as i64
    })
}

#[test]
fn tx_lights_up_where_a_texture_repeats() {
    one_test_lights_up("TX", &tiles(true), tolerances(1.0), FAIL_TX, &|a, b| tile(a) != tile(b));
    // Without a texture the same coordinates mean nothing.
    assert_eq!(mismatches(&tiles(false), &adaptive(2, tolerances(1.0)), &|_, _| 0), Vec::<String>::new());
}

#[test]
fn sh_lights_up_at_the_edge_of_a_shadow() {
    // A light far to the left, and a screen between it and the wall that the camera does not see. The screen's upper
    // edge runs askew: z = 1 + 0.1 y at x = -3.
    let light = DVec3::new(-6.0, 0.0, 2.0);
    let mut builder = FRONT.seen_from(SceneBuilder::new("shadow")).light(light.as_vec3(), 20.0);
    builder.object(matte(Vec3::ONE));
    builder.wall(Vec2::splat(-9.0), Vec2::splat(9.0), 0.0);
    builder.object(matte(Vec3::ONE));
    builder.quad([v(-3.0, -9.0, -1.0), v(-3.0, 9.0, -1.0), v(-3.0, 9.0, 1.9), v(-3.0, -9.0, 0.1)]);
    let lit = |pixel| {
        let p = FRONT.on_wall(pixel, 0.0);
        let crossing = p + (light - p) * ((-3.0 - p.x) / (light.x - p.x));
        let above = crossing.z - (1.0 + 0.1 * crossing.y);
        assert!(above.abs() > 1e-4, "{p} is too near to the shadow's edge to say");
        above > 0.0
    };
    one_test_lights_up("SH", &builder.build(1.0), tolerances(1.0), FAIL_SH, &|a, b| lit(a) != lit(b));
}

#[test]
fn gc_lights_up_where_a_mirror_shows_an_edge() {
    // The camera looks straight into a mirror that shows two walls behind it, three times as far.
    let mut builder = FRONT.seen_from(SceneBuilder::new("mirror"));
    builder.object(mirror(1.0));
    builder.wall(Vec2::splat(-9.0), Vec2::splat(9.0), 0.0);
    for (right, colour) in [(false, v(0.8, 0.1, 0.1)), (true, v(0.1, 0.1, 0.8))] {
        builder.object(matte(colour));
        half_wall(&mut builder, right, 6.0);
    }
    let is_right = |p| {
        let at = FRONT.on_wall(p, 0.0);
        side(DVec3::new(3.0 * at.x, 3.0 * at.y, 6.0))
    };
    one_test_lights_up("GC", &builder.build(1.0), tolerances(1.0), FAIL_GC, &|a, b| is_right(a) != is_right(b));
}
