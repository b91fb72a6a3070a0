// SPDX-License-Identifier: MIT OR Apache-2.0
//! The seven similarity tests on scenes whose fail masks are known: each scene is made so that one test alone must
//! light up, and the test says at which pixels from the geometry, not from what the twin traced.
#![allow(clippy::unwrap_used)]

use glam::{DVec3, Vec2, Vec3};
use rarefy::builtin;
use rarefy::layout::*;
use rarefy::options::{Correction, CorrectionMethod, Interpolation, Mode, RenderOptions, Tolerances};
use rarefy::scene::{Material, Scene};
use rarefy_host_tests::fixtures::*;

const W: u32 = 64;
const H: u32 = 48;

/// Where a pixel's attributes come from.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Role {
    Base,
    /// Adaptive, between two references.
    Between([(u32, u32); 2]),
    /// Adaptive, with a reference beyond the border.
    Border,
}

fn role((x, y): (u32, u32), (width, height): (u32, u32), block: u32) -> Role {
    if x % block == 0 && y % block == 0 {
        return Role::Base;
    }
    let mut stride = block;
    loop {
        let half = stride / 2;
        let (dx, dy) = if y % stride == 0 && x % stride == half {
            (half, 0)
        } else if x % half == 0 && y % stride == half {
            (0, half)
        } else {
            stride = half;
            continue;
        };
        let inside = x + dx < width && y + dy < height;
        return if inside { Role::Between([(x - dx, y - dy), (x + dx, y + dy)]) } else { Role::Border };
    }
}

/// A pinhole camera in doubles.
#[derive(Clone, Copy)]
struct Eye {
    at: DVec3,
    look_at: DVec3,
    fov_degrees: f64,
}

const FRONT: Eye = Eye { at: DVec3::new(0.0, 0.0, 3.0), look_at: DVec3::ZERO, fov_degrees: 40.0 };

impl Eye {
    /// Through the middle of a pixel, of length 1 along the line of sight.
    fn direction(&self, (x, y): (u32, u32)) -> DVec3 {
        let forward = (self.look_at - self.at).normalize();
        let right = forward.cross(DVec3::Y).normalize();
        let up = right.cross(forward);
        let half = (self.fov_degrees.to_radians() / 2.0).tan();
        let (w, h) = (f64::from(W), f64::from(H));
        let (sx, sy) = ((2.0 * f64::from(x) + 1.0) / w - 1.0, 1.0 - (2.0 * f64::from(y) + 1.0) / h);
        forward + right * (sx * half * w / h) + up * (sy * half)
    }

    /// Where the pixel's ray meets the plane z = `z`.
    fn on_wall(&self, pixel: (u32, u32), z: f64) -> DVec3 {
        let d = self.direction(pixel);
        self.at + d * ((z - self.at.z) / d.z)
    }

    fn seen_from(&self, builder: SceneBuilder) -> SceneBuilder {
        builder.camera(self.at.as_vec3(), self.look_at.as_vec3(), self.fov_degrees as f32)
    }
}

fn tolerances(t_pos: f32) -> Tolerances {
    Tolerances { t_pos, ..Tolerances::PAPER }
}

fn adaptive(block: u32, tolerances: Tolerances) -> RenderOptions {
    RenderOptions { tolerances, coarse_tolerances: tolerances, ..options(Mode::Adaptive, W, H, block) }
}

/// Draws `scene` and lists the pixels whose class word is not what `mask` says of their references.
fn mismatches(scene: &Scene, options: &RenderOptions, mask: &dyn Fn((u32, u32), (u32, u32)) -> u32) -> Vec<String> {
    let mut renderer = twin_renderer(scene.clone());
    draw(&mut renderer, options);
    let classes = renderer.plane(PLANE_CLASS).unwrap();
    let size = (options.width, options.height);
    let mut wrong = Vec::new();
    for (i, &word) in classes.iter().enumerate() {
        let pixel = (i as u32 % size.0, i as u32 / size.0);
        let expected = match role(pixel, size, options.block) {
            Role::Base => CLASS_BASE,
            Role::Border => CLASS_TRACED,
            Role::Between([a, b]) => match mask(a, b) {
                0 => CLASS_INTERPOLATED,
                mask => CLASS_TRACED | mask,
            },
        };
        if word != expected {
            wrong.push(format!("pixel {pixel:?}: {word:#x} instead of {expected:#x}"));
        }
    }
    wrong
}

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

    let off = RenderOptions { tests: FAIL_ALL & !fail, ..adaptive(2, t) };
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
    let off = RenderOptions { tests: FAIL_ALL & !fail, ..on.clone() };
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

const ODD_SIZES: [(u32, u32); 7] = [(1, 1), (1, 7), (7, 1), (2, 2), (5, 6), (33, 17), (48, 32)];

#[test]
fn a_flat_wall_costs_a_quarter_and_the_border() {
    for block in [2, 4] {
        for (width, height) in ODD_SIZES {
            let mut scene = builtin::to_scene("wall").unwrap();
            if width > 2 * height {
                // A wide picture shows what is beside the wall, unless the view is narrow.
                scene.view.camera.fov_y_degrees = 10.0;
            }
            // With few pixels they lie far apart.
            let options = RenderOptions { width, height, ..adaptive(block, tolerances(10.0)) };
            assert_eq!(mismatches(&scene, &options, &|_, _| 0), Vec::<String>::new(), "{width}x{height}");
            let stats = draw(&mut twin_renderer(scene), &options).stats.pixels;
            let (mut base, mut border) = (0, 0);
            for pixel in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
                match role(pixel, (width, height), block) {
                    Role::Base => base += 1,
                    Role::Border => border += 1,
                    Role::Between(_) => (),
                }
            }
            assert_eq!((stats.base, stats.traced), (base, border), "{width}x{height}, blocks of {block}");
            assert_eq!(base, u64::from(width.div_ceil(block) * height.div_ceil(block)));
            if block == 2 {
                // With even sides, the last column and row alone have no second reference.
                let last = |n: u32| u64::from(n.is_multiple_of(2));
                let (w, h) = (u64::from(width), u64::from(height));
                assert_eq!(border, last(width) * h.div_ceil(2) + last(height) * w, "{width}x{height}");
            }
        }
    }
    // Negative control: a wall of two objects costs more.
    let scene = depth_step();
    assert!(!mismatches(&scene, &adaptive(2, tolerances(10.0)), &|_, _| 0).is_empty());
}

#[test]
fn dense_noise_is_traced_nearly_whole() {
    let mut builder = FRONT.seen_from(SceneBuilder::new("noise"));
    let mut random = Random::new(11);
    for _ in 0..24_000 {
        builder.object(matte(random.point(1.0)));
        let at = v(random.range(-2.0, 2.0), random.range(-1.5, 1.5), random.range(-0.5, 0.5));
        builder.triangle([(); 3].map(|()| at + (random.point(0.12) - Vec3::splat(0.06))));
    }
    for block in [2, 4] {
        let options = adaptive(block, Tolerances::PAPER);
        let mut renderer = twin_renderer(builder.clone().build(4.0));
        let stats = draw(&mut renderer, &options).stats.pixels;
        let ratio = (stats.base + stats.traced) as f64 / f64::from(W * H);
        println!("blocks of {block}: {ratio:.4}");
        assert!(ratio > 0.95, "blocks of {block}: only {ratio} traced");
    }
}

/// Small scenes of every kind of surface, an open one with background among them.
fn pictures() -> Vec<Scene> {
    let mut open = SceneBuilder::new("open").camera(v(0.0, 0.5, 4.0), v(0.0, 0.0, 0.0), 40.0);
    open = open.light(v(2.0, 3.0, 2.0), 9.0).environment(0.1, v(0.2, 0.3, 0.5));
    open.object(matte(v(0.7, 0.3, 0.2)));
    open.sphere(v(-0.5, 0.0, 0.0), 0.6, 8);
    open.object(mirror(0.8));
    open.block(v(0.3, -0.4, -0.3), v(0.9, 0.4, 0.3));
    let mut scenes = vec![open.build(3.0)];
    scenes.extend(["wall", "spheres", "rods", "mirror-room"].map(|name| builtin::to_scene(name).unwrap()));
    scenes
}

fn full_picture(renderer: &mut rarefy::renderer::Renderer, width: u32, height: u32) -> Vec<u32> {
    draw(renderer, &options(Mode::Full, width, height, 2)).pixels
}

#[test]
fn the_strictest_tolerances_give_the_full_picture() {
    let zero = tolerances(0.0);
    let mut differing = 0;
    for scene in pictures() {
        let mut renderer = twin_renderer(scene);
        for (width, height) in ODD_SIZES {
            let full = full_picture(&mut renderer, width, height);
            for block in [2, 4] {
                for correction in [Correction::Off, Correction::ObjectAndShadow] {
                    let options = RenderOptions { width, height, correction, ..adaptive(block, zero) };
                    let frame = draw(&mut renderer, &options);
                    assert!(frame.pixels == full, "{} at {width}x{height}, blocks of {block}", renderer.name());
                    assert_eq!(frame.stats.pixels.interpolated, 0);
                }
                // Negative control: wide ones do not.
                let options = RenderOptions { width, height, ..adaptive(block, tolerances(0.5)) };
                differing += usize::from(draw(&mut renderer, &options).pixels != full);
            }
        }
    }
    assert!(differing > 8, "only {differing} pictures differ with wide tolerances");
}

#[test]
fn the_strictest_tolerances_trace_even_pixels_that_see_one_point() {
    // Through so narrow a view that all rays are the same, distances are exactly zero.
    let mut builder = SceneBuilder::new("point").camera(v(3.0, 4.0, 3.0), v(2.0, 3.0, 0.0), 1e-7);
    builder.object(matte(Vec3::ONE));
    builder.wall(Vec2::splat(-9.0), Vec2::splat(9.0), 0.0);
    let mut renderer = twin_renderer(builder.build(1.0));
    for (t_pos, interpolated) in [(0.0, 0), (1e-6, 32 * 32 - 16 * 16 - 16 - 32)] {
        let options = RenderOptions { width: 32, height: 32, ..adaptive(2, tolerances(t_pos)) };
        assert_eq!(draw(&mut renderer, &options).stats.pixels.interpolated, interpolated, "t_pos {t_pos}");
    }
}

/// The largest differences of the interpolated pixels of a picture from the means of their references: of positions,
/// normals, texture coordinates, reflected colours. `weight` is the first reference's, from the depths of both.
fn differences_from_means(scene: &Scene, options: &RenderOptions, weight: fn(f64, f64) -> f64) -> [f64; 4] {
    let mut renderer = twin_renderer(scene.clone());
    draw(&mut renderer, options);
    let planes: Vec<Vec<u32>> = (0..PLANE_COUNT).map(|p| renderer.plane(p).unwrap()).collect();
    let camera = scene.view.camera;
    let (eye, forward) = (camera.eye.as_dvec3(), (camera.look_at - camera.eye).as_dvec3().normalize());
    let value = |plane: u32, at: usize| f64::from(f32::from_bits(planes[plane as usize][at]));
    let vector = |plane: u32, at: usize| DVec3::new(value(plane, at), value(plane + 1, at), value(plane + 2, at));
    let mut worst = [0f64; 4];
    let size = (options.width, options.height);
    for at in 0..(size.0 * size.1) as usize {
        let pixel = (at as u32 % size.0, at as u32 / size.0);
        let Role::Between(references) = role(pixel, size, options.block) else { continue };
        if planes[PLANE_CLASS as usize][at] & CLASS_MASK != CLASS_INTERPOLATED {
            continue;
        }
        let [a, b] = references.map(|(x, y)| (y * size.0 + x) as usize);
        for copied in [PLANE_OBJECT, PLANE_SHADOW] {
            assert_eq!(planes[copied as usize][at], planes[copied as usize][a], "{pixel:?}: plane {copied}");
        }
        let depth = |at| (vector(PLANE_POSITION_X, at) - eye).dot(forward);
        let wa = weight(depth(a), depth(b));
        let mean = |plane| vector(plane, a) * wa + vector(plane, b) * (1.0 - wa);
        let mean_of_one = |plane| value(plane, a) * wa + value(plane, b) * (1.0 - wa);
        let st = |s: f64, t: f64| DVec3::new(s, t, 0.0);
        let found = [
            vector(PLANE_POSITION_X, at).distance(mean(PLANE_POSITION_X)),
            vector(PLANE_NORMAL_X, at).distance(mean(PLANE_NORMAL_X).normalize()),
            st(value(PLANE_TEXCOORD_S, at), value(PLANE_TEXCOORD_T, at))
                .distance(st(mean_of_one(PLANE_TEXCOORD_S), mean_of_one(PLANE_TEXCOORD_T))),
            vector(PLANE_GCOL_R, at).distance(mean(PLANE_GCOL_R)),
        ];
        (0..4).for_each(|k| worst[k] = worst[k].max(found[k]));
    }
    worst
}

#[test]
fn interpolated_pixels_hold_the_means_of_their_references() {
    let perspective = |za: f64, zb: f64| zb / (za + zb);
    for name in ["spheres", "mirror-room"] {
        let scene = builtin::to_scene(name).unwrap();
        for block in [2, 4] {
            let options = RenderOptions { width: 131, height: 97, ..adaptive(block, tolerances(0.3)) };
            let plain = RenderOptions { interpolation: Interpolation::Plain, ..options.clone() };
            let options = RenderOptions { interpolation: Interpolation::Perspective, ..options };
            for worst in [
                differences_from_means(&scene, &options, perspective),
                differences_from_means(&scene, &plain, |_, _| 0.5),
            ] {
                assert!(worst.iter().all(|&w| w < 5e-6), "{name}, blocks of {block}: {worst:?}");
            }
            // Negative controls: the first reference alone, and the other weights.
            let first = differences_from_means(&scene, &plain, |_, _| 1.0);
            // In the room, all is flat.
            let bent = name == "spheres";
            assert!(first.iter().enumerate().all(|(k, &w)| w > 1e-3 || (k == 1 && !bent)), "{name}: {first:?}");
            let other = differences_from_means(&scene, &options, |_, _| 0.5);
            assert!(other[0] > 1e-4, "{name}: {other:?}");
        }
    }
}

/// The largest relative errors of position and texture coordinate in the interpolated pixels of a tilted plane.
fn interpolation_errors(block: u32, interpolation: Interpolation) -> [f64; 2] {
    let eye = Eye { at: DVec3::new(0.0, 1.0, 0.0), look_at: DVec3::new(0.3, 0.4, -1.0), fov_degrees: 50.0 };
    let mut builder = eye.seen_from(SceneBuilder::new("floor"));
    let texture = builder.texture(1, vec![u32::MAX]);
    builder.object(Material { diffuse_texture: Some(texture), ..matte(Vec3::ONE) });
    let corners = [v(-40.0, 0.0, 40.0), v(40.0, 0.0, 40.0), v(40.0, 0.0, -40.0), v(-40.0, 0.0, -40.0)];
    // One repetition, and its border far away.
    builder.quad_with(corners, ONCE);
    let mut renderer = twin_renderer(builder.build(1.0));
    let options = RenderOptions { interpolation, ..adaptive(block, tolerances(100.0)) };
    let interpolated = draw(&mut renderer, &options).stats.pixels.interpolated;
    assert!(interpolated > u64::from(W * H) * 7 / 10, "only {interpolated} pixels are interpolated");
    let mut plane =
        |p| renderer.plane(p).unwrap().into_iter().map(|w| f64::from(f32::from_bits(w))).collect::<Vec<_>>();
    let [x, z, s, t] = [PLANE_POSITION_X, PLANE_POSITION_Z, PLANE_TEXCOORD_S, PLANE_TEXCOORD_T].map(&mut plane);
    let mut errors = [0f64; 2];
    for at in 0..(W * H) as usize {
        let d = eye.direction((at as u32 % W, at as u32 / W));
        let p = eye.at - d * (eye.at.y / d.y);
        let size = p.distance(eye.at);
        errors[0] = errors[0].max((x[at] - p.x).hypot(z[at] - p.z) / size);
        errors[1] = errors[1].max((s[at] - (p.x + 40.0) / 80.0).hypot(t[at] - (40.0 - p.z) / 80.0) / size);
    }
    errors
}

#[test]
fn perspective_interpolation_is_exact_on_planes_and_plain_interpolation_is_not() {
    for block in [2, 4] {
        let [position, texcoord] = interpolation_errors(block, Interpolation::Perspective);
        assert!(position < 2e-6 && texcoord < 1e-6, "blocks of {block}: {position}, {texcoord}");
        let [position, texcoord] = interpolation_errors(block, Interpolation::Plain);
        assert!(position > 1e-4 && texcoord > 1e-6, "blocks of {block}: plain is as good: {position}, {texcoord}");
    }
}

#[test]
fn every_pixel_has_one_class_and_the_counts_add_up() {
    let corrections = [
        (Correction::Off, CorrectionMethod::Converged),
        (Correction::Object, CorrectionMethod::Converged),
        (Correction::ObjectAndShadow, CorrectionMethod::Converged),
        (Correction::ObjectAndShadow, CorrectionMethod::Sweeps),
    ];
    let mut corrected = 0;
    for scene in pictures() {
        let mut renderer = twin_renderer(scene);
        for (width, height) in ODD_SIZES.into_iter().chain([(96, 64)]) {
            for (block, (correction, correction_method)) in [2, 4].into_iter().flat_map(|b| corrections.map(|c| (b, c)))
            {
                let adaptive = adaptive(block, Tolerances::PAPER);
                let options = RenderOptions { width, height, correction, correction_method, ..adaptive };
                let stats = draw(&mut renderer, &options).stats.pixels;
                let classes = renderer.plane(PLANE_CLASS).unwrap();
                let count =
                    |wanted: &[u32]| classes.iter().filter(|&&c| wanted.contains(&(c & CLASS_MASK))).count() as u64;
                let found = [
                    count(&[CLASS_BASE]),
                    count(&[CLASS_TRACED]),
                    count(&[CLASS_INTERPOLATED]),
                    count(&[CLASS_CORRECTED, CLASS_CONFIRMED]),
                ];
                assert_eq!(found, [stats.base, stats.traced, stats.interpolated, stats.corrected]);
                assert_eq!(found.iter().sum::<u64>(), u64::from(width) * u64::from(height));
                corrected += stats.corrected;
                for (i, &class) in classes.iter().enumerate() {
                    let pixel = (i as u32 % width, i as u32 / width);
                    let is_base = role(pixel, (width, height), block) == Role::Base;
                    assert_eq!(class & CLASS_MASK == CLASS_BASE, is_base, "{pixel:?}: {class:#x}");
                    assert_eq!(class & !(CLASS_MASK | FAIL_ALL), 0, "{pixel:?}: stray bits in {class:#x}");
                    let has_mask = class & FAIL_ALL != 0;
                    assert!(!has_mask || class & CLASS_MASK == CLASS_TRACED, "{pixel:?}: a fail mask in {class:#x}");
                }
            }
        }
    }
    assert!(corrected > 100, "only {corrected} pixels were corrected in all");
}
