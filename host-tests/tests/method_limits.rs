// SPDX-License-Identifier: MIT OR Apache-2.0
//! The limits of the method: what a flat wall, dense noise and the strictest tolerances cost; that every pixel has one
//! class; and what interpolated pixels hold.
#![allow(clippy::unwrap_used)]

use glam::{DVec3, Vec2, Vec3};
use rarefy::internal::layout::*;
use rarefy::internal::math::{unpack_normal, unpack_texcoord};
use rarefy::internal::method::options::{Compared, Correction, Interpolation, Mode, RenderOptions, Tolerances};
use rarefy::internal::scene::builtin;
use rarefy::internal::scene::{Material, Scene};
use rarefy_host_tests::fixtures::*;
use rarefy_host_tests::masks::*;

const ODD_SIZES: [(u32, u32); 7] = [(1, 1), (1, 7), (7, 1), (2, 2), (5, 6), (33, 17), (48, 32)];

#[test]
fn a_flat_wall_costs_a_quarter_and_the_border() {
    for block in [2, 4] {
        for (width, height) in ODD_SIZES {
            let mut scene = builtin::to_scene("wall").unwrap();
            if width > 2 * height {
                // A wide picture shows what is beside the wall, unless the view is narrow.
                let mut view = scene.view().clone();
                view.camera.fov_y_degrees = 10.0;
                scene.set_view(view).unwrap();
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
    // Negative control: a scene of several objects costs more.
    let scene = builtin::to_scene("spheres").unwrap();
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

fn full_picture(renderer: &mut rarefy::internal::render::renderer::Renderer, width: u32, height: u32) -> Vec<u32> {
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
                for correction in [Correction::Off, plainly_converged(Compared::PAPER)] {
                    let options = with(&adaptive(block, zero), |method| method.correction = correction);
                    let options = RenderOptions { width, height, ..options };
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
    let camera = scene.view().camera;
    let (eye, forward) = (camera.eye.as_dvec3(), (camera.look_at - camera.eye).as_dvec3().normalize());
    let value = |plane: u32, at: usize| f64::from(f32::from_bits(planes[plane as usize][at]));
    let normal = |at: usize| unpack_normal(planes[PLANE_NORMAL as usize][at]).as_dvec3();
    let texcoord = |at: usize| {
        let word = planes[PLANE_TEXCOORD as usize][at];
        let [s, t] = [word & 0xffff, word >> 16].map(|half| f64::from(unpack_texcoord(half)));
        DVec3::new(s, t, 0.0)
    };
    let vector = |plane: u32, at: usize| DVec3::new(value(plane, at), value(plane + 1, at), value(plane + 2, at));
    let mut worst = [0f64; 4];
    let size = (options.width, options.height);
    for at in 0..(size.0 * size.1) as usize {
        let pixel = (at as u32 % size.0, at as u32 / size.0);
        let Role::Between(references) = role(pixel, size, options.method.block) else { continue };
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
        let mean_of = |[first, second]: [DVec3; 2]| first * wa + second * (1.0 - wa);
        let found = [
            vector(PLANE_POSITION_X, at).distance(mean(PLANE_POSITION_X)),
            normal(at).distance(mean_of([a, b].map(normal)).normalize()),
            texcoord(at).distance(mean_of([a, b].map(texcoord))),
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
            let plain = with(&options, |method| method.interpolation = Interpolation::Plain);
            let options = with(&options, |method| method.interpolation = Interpolation::Perspective);
            for worst in [
                differences_from_means(&scene, &options, perspective),
                differences_from_means(&scene, &plain, |_, _| 0.5),
            ] {
                // Normals and texture coordinates are stored in 16 bits for each coordinate.
                let rounding = [5e-6, 1e-4, 1.5e-5, 5e-6];
                let within = worst.iter().zip(rounding).all(|(&w, most)| w < most);
                assert!(within, "{name}, blocks of {block}: {worst:?}");
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
    let options = with(&adaptive(block, tolerances(100.0)), |method| method.interpolation = interpolation);
    let interpolated = draw(&mut renderer, &options).stats.pixels.interpolated;
    assert!(interpolated > u64::from(W * H) * 7 / 10, "only {interpolated} pixels are interpolated");
    let mut plane =
        |p| renderer.plane(p).unwrap().into_iter().map(|w| f64::from(f32::from_bits(w))).collect::<Vec<_>>();
    let [x, z] = [PLANE_POSITION_X, PLANE_POSITION_Z].map(&mut plane);
    let texcoords = renderer.plane(PLANE_TEXCOORD).unwrap();
    let coordinates = |half: fn(u32) -> u32| texcoords.iter().map(move |&word| f64::from(unpack_texcoord(half(word))));
    let (s, t): (Vec<f64>, Vec<f64>) = (coordinates(|w| w & 0xffff).collect(), coordinates(|w| w >> 16).collect());
    let mut errors = [0f64; 2];
    for at in 0..(W * H) as usize {
        let d = eye.direction((at as u32 % W, at as u32 / W));
        let p = eye.at - d * (eye.at.y / d.y);
        let size = p.distance(eye.at);
        // Hit points are made of the triangle's corners, so they are as exact along it as it is long.
        errors[0] = errors[0].max((x[at] - p.x).hypot(z[at] - p.z) / size.max(80.0));
        errors[1] = errors[1].max((s[at] - (p.x + 40.0) / 80.0).hypot(t[at] - (40.0 - p.z) / 80.0) / size);
    }
    errors
}

#[test]
fn perspective_interpolation_is_exact_on_planes_and_plain_interpolation_is_not() {
    for block in [2, 4] {
        // Texture coordinates are stored in 16 bits: each level of references adds half a step.
        let [position, texcoord] = interpolation_errors(block, Interpolation::Perspective);
        assert!(position < 2e-6 && texcoord < 2.5e-5, "blocks of {block}: {position}, {texcoord}");
        let [position, texcoord] = interpolation_errors(block, Interpolation::Plain);
        assert!(position > 1e-4 && texcoord > 1e-4, "blocks of {block}: plain is as good: {position}, {texcoord}");
    }
}

#[test]
fn every_pixel_has_one_class_and_the_counts_add_up() {
    let corrections = [
        Correction::Off,
        Correction::converged(Compared::Object),
        Correction::converged(Compared::PAPER),
        Correction::Sweeps(Compared::PAPER),
    ];
    let mut corrected = 0;
    for scene in pictures() {
        let mut renderer = twin_renderer(scene);
        for (width, height) in ODD_SIZES.into_iter().chain([(96, 64)]) {
            for (block, correction) in [2, 4].into_iter().flat_map(|b| corrections.map(|c| (b, c))) {
                let adaptive = with(&adaptive(block, Tolerances::PAPER), |method| method.correction = correction);
                let shifted = !width.is_multiple_of(2);
                let options = RenderOptions { width, height, ..with(&adaptive, |m| m.shifted_rows = shifted) };
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
                    let shift = if shifted { base_shift(block, pixel.1) } else { 0 };
                    let is_base = pixel.0 % block == shift && pixel.1.is_multiple_of(block);
                    assert_eq!(class & CLASS_MASK == CLASS_BASE, is_base, "{pixel:?}: {class:#x}");
                    let known =
                        CLASS_MASK | FAIL_ALL | CLASS_SECONDARY | 0xff << CLASS_REPEATS_S | 0xff << CLASS_REPEATS_T;
                    assert_eq!(class & !known, 0, "{pixel:?}: stray bits in {class:#x}");
                    let has_mask = class & (FAIL_ALL | CLASS_SECONDARY) != 0;
                    assert!(!has_mask || class & CLASS_MASK == CLASS_TRACED, "{pixel:?}: a fail mask in {class:#x}");
                }
            }
        }
    }
    assert!(corrected > 100, "only {corrected} pixels were corrected in all");
}
