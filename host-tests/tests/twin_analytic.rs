// SPDX-License-Identifier: MIT OR Apache-2.0
//! The twin on scenes whose answers follow from geometry and optics, computed here in doubles.
#![allow(clippy::unwrap_used)]

use glam::{Vec2, Vec3};
use rarefy::internal::device::twin::ray_tree::fresnel;
use rarefy::internal::device::twin::shade::sample_texture;
use rarefy::internal::layout::{NO_OBJECT, PLANE_OBJECT, SURFACE_MIRROR};
use rarefy::internal::method::options::Mode;
use rarefy::internal::scene::builtin;
use rarefy::internal::scene::{Material, Scene, Surface};
use rarefy_host_tests::fixtures::*;

const RED: Vec3 = Vec3::new(0.9, 0.05, 0.1);
const GREEN: Vec3 = Vec3::new(0.1, 0.8, 0.05);
const DOWN: Vec3 = Vec3::NEG_Y;

/// Is `found` what is expected, but for a relative error?
fn close(found: f64, expected: f64, relative: f64) -> bool {
    (found - expected).abs() <= relative * expected.abs()
}

#[track_caller]
fn assert_close(what: &str, found: impl Into<f64>, expected: f64, relative: f64) {
    let found = found.into();
    assert!(close(found, expected, relative), "{what}: {found} instead of {expected}");
    // Negative control: the comparison tells a few hundred times the tolerance.
    assert!(!close(found, expected * (1.0 + 20.0 * relative), relative), "{what}: anything passes");
}

fn assert_colour(what: &str, found: Vec3, expected: Vec3, absolute: f32) {
    assert!((found - expected).abs().max_element() <= absolute, "{what}: {found} instead of {expected}");
    assert!(expected.max_element() > 4.0 * absolute, "{what}: black proves nothing");
}

/// Unpolarised reflectance by Fresnel's equations, from the angle of incidence and the indices before and behind.
fn reflectance(sin_i: f64, before: f64, behind: f64) -> f64 {
    let sin_t = sin_i * before / behind;
    let (cos_i, cos_t) = ((1.0 - sin_i * sin_i).sqrt(), (1.0 - sin_t * sin_t).sqrt());
    let s = (before * cos_i - behind * cos_t) / (before * cos_i + behind * cos_t);
    let p = (before * cos_t - behind * cos_i) / (before * cos_t + behind * cos_i);
    (s * s + p * p) / 2.0
}

/// Where along `[lo, hi]` the answer changes from true to false.
fn edge(mut lo: f64, mut hi: f64, is_before: impl Fn(f64) -> bool) -> f64 {
    assert!(is_before(lo) && !is_before(hi), "no edge between {lo} and {hi}");
    for _ in 0..40 {
        let middle = (lo + hi) / 2.0;
        if is_before(middle) { lo = middle } else { hi = middle }
    }
    (lo + hi) / 2.0
}

#[test]
fn a_sphere_covers_the_disc_that_its_tangents_cut() {
    let (radius, distance, fov) = (1.0f64, 4.0f64, 40.0f64);
    let mut builder = SceneBuilder::new("sphere").camera(v(0.0, 0.0, 4.0), Vec3::ZERO, fov as f32);
    builder.object(matte(Vec3::ONE));
    builder.sphere(Vec3::ZERO, radius as f32, 50);
    let mut renderer = twin_renderer(builder.build(1.0));
    for (width, height) in [(320, 240), (251, 301)] {
        draw(&mut renderer, &options(Mode::Full, width, height, 2));
        let covered = renderer.plane(PLANE_OBJECT).unwrap().iter().filter(|&&o| o != NO_OBJECT).count();
        let tangent = (radius / distance).asin().tan();
        let pixels = tangent / (fov.to_radians() / 2.0).tan() * f64::from(height) / 2.0;
        // A polygon of 100 sides within the circle covers 0.07 % less, and pixels on the rim go either way.
        assert_close("pixels of the sphere", covered as f64, std::f64::consts::PI * pixels * pixels, 5e-3);
    }
}

/// Boxes and a sphere of several colours on a floor, before the plane z = 0.
fn furnished() -> SceneBuilder {
    let mut builder = SceneBuilder::new("furnished").light(v(-2.0, 4.0, 5.0), 12.0).environment(0.1, v(0.1, 0.2, 0.4));
    builder.object(Material { specular: Vec3::splat(0.3), shininess: 20.0, ..matte(RED) });
    builder.block(v(-1.2, -1.0, 1.0), v(-0.5, 0.2, 1.8));
    builder.object(Material { specular: Vec3::splat(0.3), shininess: 20.0, ..matte(GREEN) });
    builder.sphere(v(0.6, -0.3, 1.5), 0.5, 12);
    builder.object(matte(v(0.6, 0.6, 0.6)));
    builder.floor(Vec2::new(-3.0, 0.1), Vec2::new(3.0, 6.0), -1.0);
    builder
}

#[test]
fn a_mirror_shows_what_the_camera_behind_it_would_see() {
    let direct = furnished().build(4.0);
    let mut with_mirror = furnished();
    with_mirror.object(mirror(0.75));
    with_mirror.wall(Vec2::new(-3.0, -1.0), Vec2::new(3.0, 3.0), 0.0);
    let (mirrored, direct) = (Stand::new(&with_mirror.build(4.0), 1, 1, 1), Stand::new(&direct, 1, 1, 0));
    let eye = v(0.2, 0.4, 3.5);
    let behind = v(eye.x, eye.y, -eye.z);
    let (mut equal, mut differing, mut background) = (0, 0, 0);
    for (x, y) in (0..80).flat_map(|x| (0..60).map(move |y| (x as f32, y as f32))) {
        let target = v(-1.4 + x * 0.035, -0.95 + y * 0.03, 0.0);
        let d = target - eye;
        let Some(look) = mirrored.look(eye, d) else { continue };
        if mirrored.args().materials[look.point.material as usize].surface != SURFACE_MIRROR {
            continue;
        }
        let seen = direct.look(behind, v(d.x, d.y, -d.z));
        background += usize::from(seen.is_none());
        let expected = seen.map_or(v(0.1, 0.2, 0.4), |s| s.local) * 0.75;
        if (look.gcol - expected).abs().max_element() < 2e-4 {
            equal += 1
        } else {
            differing += 1
        }
        assert_eq!((look.work.reflection_rays, look.work.refraction_rays), (1, 0));
    }
    println!("{equal} equal, {differing} differ, {background} of the background");
    assert!(equal > 1500 && background > 100 && background < equal * 3 / 4);
    // Rays that pass the rim of an object or a shadow by a hair's breadth may fall on either side.
    assert!(differing * 200 < equal, "{differing} of {equal} reflected points differ");
    // Negative control: from a wrong place it looks different.
    let (a, b) = (direct.look(behind, v(0.3, -0.9, 3.5)), direct.look(behind + v(0.3, 0.0, 0.0), v(0.3, -0.9, 3.5)));
    assert!((a.unwrap().local - b.unwrap().local).abs().max_element() > 2e-4);
}

/// A floor at y = 0 that is red left of x = 0 and green right of it, under a slab of glass of thickness 1.
fn under_glass(surface: Option<Surface>, index: f32) -> Stand {
    let mut builder = SceneBuilder::new("slab");
    for (lo, hi, colour) in [(-20.0, 0.0, RED), (0.0, 20.0, GREEN)] {
        builder.object(matte(colour));
        builder.floor(Vec2::new(lo, -5.0), Vec2::new(hi, 5.0), 0.0);
    }
    match surface {
        Some(Surface::Glass) => {
            builder.object(glass(Surface::Glass, index));
            builder.block(v(-9.0, 0.5, -4.0), v(9.0, 1.5, 4.0));
        }
        Some(surface) => {
            builder.object(glass(surface, index));
            builder.floor(Vec2::new(-9.0, -4.0), Vec2::new(9.0, 4.0), 1.0);
        }
        None => (),
    }
    Stand::new(&builder.build(1.0), 1, 1, 8)
}

/// Where rays that run to the right and down at `angle` from height 2 must start to see the border of red and green.
fn border_start(stand: &Stand, angle: f64) -> f64 {
    let d = v(angle.sin() as f32, -angle.cos() as f32, 0.0);
    edge(-8.0, 8.0, |x| {
        let look = stand.look(v(x as f32, 2.0, 0.03), d).unwrap();
        let seen = look.local + look.gcol;
        seen.x > seen.y
    })
}

#[test]
fn a_slab_of_glass_shifts_what_lies_behind_it_by_snells_law() {
    for index in [1.2, 1.5, 2.0] {
        for degrees in [0.0f64, 10.0, 30.0, 45.0, 60.0] {
            let angle = degrees.to_radians();
            let refracted = (angle.sin() / index).asin();
            // A ray that starts at height 2 and ends at height 0 runs 1 of that in glass.
            let expected = -(angle.tan() + refracted.tan());
            let found = border_start(&under_glass(Some(Surface::Glass), index as f32), angle);
            assert!((found - expected).abs() < 2e-4, "{index}, {degrees}: {found} instead of {expected}");
            let straight = border_start(&under_glass(None, 1.0), angle);
            assert!((straight + 2.0 * angle.tan()).abs() < 2e-4, "{degrees}: {straight} without glass");
            // Negative control: a slightly different index is told apart.
            let other = -(angle.tan() + (angle.sin() / (index + 0.02)).asin().tan());
            assert!(degrees == 0.0 || (found - other).abs() > 5e-4, "{index}, {degrees}: indices look the same");
        }
    }
}

#[test]
fn a_thin_pane_bends_nothing_and_lets_fresnels_share_pass() {
    for degrees in [0.0f64, 20.0, 50.0, 75.0] {
        let angle = degrees.to_radians();
        let pane = under_glass(Some(Surface::ThinGlass), 1.5);
        let found = border_start(&pane, angle.min(1.0));
        assert!((found + 2.0 * angle.min(1.0).tan()).abs() < 2e-4, "{degrees}: {found}");
        let look =
            pane.look(v(-2.0 * angle.tan() as f32 - 0.5, 2.0, 0.03), v(angle.sin() as f32, -angle.cos() as f32, 0.0));
        let look = look.unwrap();
        let share = 1.0 - reflectance(angle.sin(), 1.0, 1.5);
        assert_close("red through the pane", look.gcol.x, f64::from(RED.x) * share, 1e-5);
        assert_eq!(look.local, Vec3::ZERO);
        assert_eq!((look.work.refraction_rays, look.work.reflection_rays), (1, 1));
    }
}

#[test]
fn a_film_shows_as_much_of_its_own_colour_as_it_is_opaque() {
    for opacity in [0.0f32, 0.25, 0.8, 1.0] {
        let mut builder = SceneBuilder::new("film");
        builder.object(matte(RED));
        builder.floor(Vec2::splat(-9.0), Vec2::splat(9.0), 0.0);
        builder.object(Material { diffuse: GREEN, opacity, ..glass(Surface::ThinGlass, 1.0) });
        builder.floor(Vec2::splat(-9.0), Vec2::splat(9.0), 1.0);
        let stand = Stand::new(&builder.build(1.0), 1, 1, 8);
        let look = stand.look(v(0.1, 3.0, 0.2), DOWN).unwrap();
        assert_eq!((look.local, look.gcol), (GREEN * opacity, RED * (1.0 - opacity)), "{opacity}");
    }
}

#[test]
fn glass_reflects_and_transmits_by_fresnels_equations() {
    // A slab below a red ceiling and above a green floor, seen from between.
    let mut builder = SceneBuilder::new("slab");
    builder.object(matte(RED));
    builder.floor(Vec2::splat(-90.0), Vec2::splat(90.0), 5.0);
    builder.object(matte(GREEN));
    builder.floor(Vec2::splat(-90.0), Vec2::splat(90.0), -5.0);
    builder.object(glass(Surface::Glass, 1.5));
    builder.block(v(-50.0, -1.0, -50.0), v(50.0, 1.0, 50.0));
    let stand = Stand::new(&builder.build(1.0), 1, 1, 8);
    for degrees in [0.0f64, 15.0, 40.0, 56.31, 70.0, 80.0] {
        let angle = degrees.to_radians();
        let look = stand.look(v(0.03, 2.0, 0.01), v(angle.sin() as f32, -angle.cos() as f32, 0.0)).unwrap();
        let f = reflectance(angle.sin(), 1.0, 1.5);
        // Out of the glass the share is the same. Solve for the two shares from red and green.
        let [r, g] = [0, 1].map(|c| f64::from(look.gcol[c]));
        let [(rr, rg), (gr, gg)] = [RED, GREEN].map(|c| (f64::from(c.x), f64::from(c.y)));
        let det = rr * gg - gr * rg;
        let (reflected, transmitted) = ((r * gg - gr * g) / det, (rr * g - r * rg) / det);
        assert!((reflected - f).abs() < 1e-5, "{degrees}: {reflected} instead of {f} reflected");
        assert_close("transmitted", transmitted, (1.0 - f) * (1.0 - f), 1e-5);
        if degrees == 0.0 {
            assert!((reflected - 0.04).abs() < 1e-6, "{reflected} instead of 0.04 at normal incidence");
        }
        if degrees == 56.31 {
            // Brewster's angle, atan(1.5): half of the perpendicular part alone.
            assert!((reflected - 0.073_964_5).abs() < 1e-5);
        }
    }
}

#[test]
fn the_fresnel_function_refracts_by_snell_and_gives_up_at_the_critical_angle() {
    for index in [1.1f64, 1.33, 1.5, 2.4] {
        for i in 0..900 {
            let angle = (f64::from(i) * 0.1).to_radians();
            let d = v(angle.sin() as f32, -angle.cos() as f32, 0.0);
            let (f, inwards) = fresnel(d, Vec3::Y, (1.0 / index) as f32).unwrap();
            assert!((f64::from(f) - reflectance(angle.sin(), 1.0, index)).abs() < 2e-5, "{index}: {f} at {angle}");
            assert!((f64::from(inwards.x) * index - angle.sin()).abs() < 1e-6 && inwards.y < 0.0);
            let outwards = fresnel(d, Vec3::Y, index as f32);
            let sin_t = angle.sin() * index;
            if (sin_t - 1.0).abs() < 1e-5 {
                continue;
            }
            assert_eq!(outwards.is_none(), sin_t > 1.0, "{index}: {outwards:?} at {} degrees", i as f64 * 0.1);
            if let Some((f, direction)) = outwards {
                assert!((f64::from(direction.x) - sin_t).abs() < 1e-5);
                assert!((f64::from(f) - reflectance(angle.sin(), index, 1.0)).abs() < 2e-3 * (1.0 - sin_t).powf(-0.5));
            }
        }
    }
}

/// A prism with a right angle, its legs along x and y; red lies where total reflection sends rays, green behind the
/// long side.
fn prism(index: f32) -> Stand {
    let mut builder = SceneBuilder::new("prism");
    builder.object(glass(Surface::Glass, index));
    let (a, b, c) = (v(0.0, 0.0, -1.0), v(2.0, 0.0, -1.0), v(0.0, 2.0, -1.0));
    let back = Vec3::Z * 2.0;
    builder.triangle([a, c, b]);
    builder.triangle([a + back, b + back, c + back]);
    for (p, q) in [(a, b), (b, c), (c, a)] {
        builder.quad([p, q, q + back, p + back]);
    }
    builder.object(matte(RED));
    builder.floor(Vec2::splat(-50.0), Vec2::splat(50.0), -3.0);
    builder.object(matte(GREEN));
    builder.quad([v(4.0, -2.9, -50.0), v(4.0, -2.9, 50.0), v(4.0, 50.0, 50.0), v(4.0, 50.0, -50.0)]);
    Stand::new(&builder.build(1.0), 1, 1, 8)
}

#[test]
fn a_prism_reflects_all_light_beyond_the_critical_angle() {
    // A ray along x enters a leg straight and meets the long side at 45 degrees.
    let (o, d) = (v(-2.0, 0.7, 0.03), Vec3::X);
    // 1.5: the critical angle is 41.8 degrees. It goes down, out of the other leg, to the red floor.
    for index in [1.45f64, 1.5, 1.9] {
        let look = prism(index as f32).look(o, d).unwrap();
        let straight = 1.0 - reflectance(0.0, 1.0, index);
        assert_colour("behind the prism", look.gcol, RED * (straight * straight) as f32, 1e-5);
        // In, totally reflected, out; and the reflection off the first leg, into the dark.
        assert_eq!((look.work.refraction_rays, look.work.reflection_rays), (2, 2));
    }
    // 1.35: 47.8 degrees. It goes on to the green wall.
    for index in [1.1f64, 1.3, 1.35] {
        let look = prism(index as f32).look(o, d).unwrap();
        let share = (1.0 - reflectance(0.0, 1.0, index)) * (1.0 - reflectance(0.5f64.sqrt(), index, 1.0));
        assert_colour("behind the prism", look.gcol, GREEN * share as f32, 2e-5);
        assert_eq!((look.work.refraction_rays, look.work.reflection_rays), (2, 1));
    }
}

#[test]
fn a_shadow_ends_where_similar_triangles_put_it() {
    // A light at height 5 over x = -1, a screen at height 2 left of x = 0.3.
    for (light, height, side) in [(-1.0f64, 2.0f64, 0.3f64), (0.5, 1.0, 0.3), (-3.0, 4.0, -1.5)] {
        let mut builder =
            SceneBuilder::new("screen").light(v(light as f32, 5.0, 0.0), 10.0).environment(0.0, Vec3::ZERO);
        builder.object(matte(Vec3::ONE));
        // Not larger than it must be: rays start above a triangle by the error of its hit points, which grows with it.
        builder.floor(Vec2::splat(-8.0), Vec2::splat(8.0), 0.0);
        builder.object(matte(Vec3::ONE));
        builder.floor(Vec2::new(-25.0, -5.0), Vec2::new(side as f32, 5.0), height as f32);
        let stand = Stand::new(&builder.build(1.0), 1, 1, 0);
        let expected = light + (side - light) * 5.0 / (5.0 - height);
        let found = edge(expected - 3.0, expected + 3.0, |x| {
            let look = stand.look(v(x as f32, 0.5, 0.02), DOWN).unwrap();
            assert_eq!(look.shadow_bits == 1, look.local == Vec3::ZERO);
            look.shadow_bits == 1
        });
        assert!((found - expected).abs() < 1e-4, "{found} instead of {expected}");
    }
}

#[test]
fn light_falls_off_with_the_square_of_the_distance_and_the_cosine() {
    for height in [0.1f64, 0.5, 1.0, 3.0, 20.0] {
        for aside in [0.0f64, 0.3, 1.0, 2.5, 8.0] {
            let mut builder =
                SceneBuilder::new("lamp").light(v(0.0, height as f32, 0.0), 7.0).environment(0.25, Vec3::ZERO);
            builder.object(matte(v(0.8, 0.4, 0.2)));
            builder.floor(Vec2::splat(-30.0), Vec2::splat(30.0), 0.0);
            let stand = Stand::new(&builder.build(1.0), 1, 1, 0);
            let look = stand.look(v(aside as f32, 1.0, 0.0), v(0.0, -1.0, 0.0)).unwrap();
            let d2 = height * height + aside * aside;
            for (channel, own) in [0.8f64, 0.4, 0.2].into_iter().enumerate() {
                let expected = own * (0.25 + 7.0 * height / d2.sqrt() / d2);
                assert_close("reflected light", look.local[channel], expected, 2e-5);
            }
        }
    }
}

/// A linear value as an sRGB byte, rounded.
fn srgb(linear: f64) -> f64 {
    let encoded = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    (encoded.clamp(0.0, 1.0) * 255.0).round()
}

#[test]
fn the_wall_has_the_colours_of_its_formula() {
    let mut renderer = twin_renderer(builtin::to_scene("wall").unwrap());
    let (width, height) = (90u32, 70u32);
    let check = |pixels: &[u32], intensity: f64| {
        let half = 25f64.to_radians().tan();
        let wrong = pixels.iter().enumerate().filter(|&(i, &word)| {
            let (x, y) = (i as u32 % width, i as u32 / width);
            let across = |i: u32, n: u32| (2.0 * f64::from(i) + 1.0) / f64::from(n) - 1.0;
            let (px, py) =
                (3.0 * half * across(x, width) * f64::from(width) / f64::from(height), 3.0 * half * across(y, height));
            let d2 = px * px + py * py + 4.0;
            let light = 0.12 + intensity * 2.0 / d2.sqrt() / d2;
            // At a rounding's edge the byte may be the next.
            [0.6, 0.5, 0.4].iter().enumerate().any(|(channel, own)| {
                let byte = f64::from(word >> (8 * channel) & 255);
                (byte - srgb(own * light * (1.0 - 1e-5))) * (byte - srgb(own * light * (1.0 + 1e-5))) > 0.0
            })
        });
        wrong.count()
    };
    for mode in [Mode::Full, Mode::Adaptive] {
        let frame = draw(&mut renderer, &options(mode, width, height, 2));
        assert_eq!(check(&frame.pixels, 3.2), 0, "{mode:?}");
        assert!(check(&frame.pixels, 3.1) > 1000, "{mode:?}: anything passes");
    }
}

#[test]
fn each_of_32_lights_has_a_bit() {
    for pattern in [0u32, 1, 0x8000_0000, 0x5555_5555, 0xdead_beef, u32::MAX] {
        let mut builder = SceneBuilder::new("lamps");
        let place = |i: u32| {
            let angle = i as f32 * std::f32::consts::TAU / 32.0;
            v(2.0 * angle.cos(), 3.0, 2.0 * angle.sin())
        };
        for i in 0..32 {
            builder = builder.light(place(i), 1.0 + i as f32);
        }
        builder.object(matte(Vec3::ONE));
        builder.floor(Vec2::splat(-5.0), Vec2::splat(5.0), 0.0);
        builder.object(matte(RED));
        for i in (0..32).filter(|i| pattern >> i & 1 != 0) {
            let at = place(i) * 0.9;
            builder.floor(Vec2::new(at.x - 0.05, at.z - 0.05), Vec2::new(at.x + 0.05, at.z + 0.05), at.y);
        }
        let stand = Stand::new(&builder.build(1.0), 1, 1, 0);
        let look = stand.look(v(0.0, 1.0, 0.0), v(0.0, -1.0, 0.0)).unwrap();
        assert_eq!(look.shadow_bits, pattern, "{:#x} instead of {pattern:#x}", look.shadow_bits);
        assert_eq!(look.work.shadow_rays, 32);
        let lit: f64 = (0..32).filter(|i| pattern >> i & 1 == 0).map(|i| f64::from(1 + i)).sum();
        assert_close("light", look.local.x, 1.0 + lit * 3.0 / 13f64.powf(1.5), 1e-5);
    }
}

#[test]
fn a_light_behind_the_surface_counts_as_shadowed() {
    // One light above, one below the floor; the shading normals lean so far that a low light is behind them.
    let mut builder = SceneBuilder::new("behind").light(v(0.0, 2.0, 0.0), 1.0).light(v(0.0, -2.0, 0.0), 1.0);
    builder = builder.light(v(9.0, 1.0, 0.0), 1.0);
    builder.object(matte(Vec3::ONE));
    let lean = v(-0.5, 1.0, 0.0).normalize();
    let corners = [v(-5.0, 0.0, 5.0), v(5.0, 0.0, 5.0), v(0.0, 0.0, -5.0)];
    builder.triangle_with(corners, [lean; 3], [Vec2::ZERO; 3]);
    let stand = Stand::new(&builder.build(1.0), 1, 1, 0);
    let above = stand.look(v(0.0, 1.0, 0.0), DOWN).unwrap();
    assert_eq!((above.shadow_bits, above.work.shadow_rays), (0b110, 1), "no ray is wasted on lights behind");
    // From below, the normals turn to the eye: the lower light shines, and the leaning normal faces the third one, but
    // the floor itself is in its way.
    let below = stand.look(v(0.0, -1.0, 0.0), Vec3::Y).unwrap();
    assert_eq!((below.shadow_bits, below.work.shadow_rays), (0b101, 1));
    assert!(below.point.normal.y < 0.0 && above.point.normal.y > 0.0);
}

/// Two mirrors that face each other, 1 apart.
fn facing_mirrors(weight: f32, depth: u32) -> Stand {
    let mut builder = SceneBuilder::new("mirrors").environment(1.0, v(0.5, 0.5, 0.5));
    builder.object(mirror(weight));
    builder.floor(Vec2::splat(-50.0), Vec2::splat(50.0), 0.0);
    builder.floor(Vec2::splat(-50.0), Vec2::splat(50.0), 1.0);
    Stand::new(&builder.build(1.0), 1, 1, depth)
}

#[test]
fn mirrors_that_face_each_other_end_at_the_depth_limit_or_when_too_little_is_left() {
    for depth in [0, 1, 2, 4, 9, 64] {
        let look = facing_mirrors(1.0, depth).look(v(0.1, 0.5, 0.2), v(0.05, -1.0, 0.03)).unwrap();
        assert_eq!((look.work.reflection_rays, look.work.refraction_rays), (depth, 0));
        assert_eq!(look.gcol, Vec3::ZERO, "perfect mirrors have no colour of their own");
    }
    // The last chain with a weight of at least 1/512: 0.5^9, 0.25^4, 0.8^27.
    for (weight, rays) in [(0.5, 9), (0.25, 4), (0.8, 27), (0.001, 0)] {
        let look = facing_mirrors(weight, 64).look(v(0.1, 0.5, 0.2), v(0.001, -1.0, 0.002)).unwrap();
        assert_eq!(look.work.reflection_rays, rays, "mirrors of {weight}");
    }
}

#[test]
fn every_mirror_takes_its_share() {
    // A corner of two mirrors and a red wall behind the eye: two reflections, then red.
    let mut builder = SceneBuilder::new("corner");
    builder.object(mirror(0.5));
    builder.floor(Vec2::splat(-9.0), Vec2::splat(9.0), 0.0);
    builder.object(mirror(0.8));
    builder.wall(Vec2::new(-9.0, 0.0), Vec2::new(9.0, 9.0), -1.0);
    builder.object(matte(RED));
    builder.wall(Vec2::new(-9.0, 0.0), Vec2::new(9.0, 9.0), 5.0);
    let scene = builder.build(1.0);
    let look = |depth| Stand::new(&scene, 1, 1, depth).look(v(0.0, 1.0, 1.0), v(0.02, -1.0, -1.3)).unwrap();
    assert_colour("after two mirrors", look(4).gcol, RED * (0.5 * 0.8), 1e-6);
    assert_eq!(look(2).gcol, look(4).gcol);
    assert_eq!(look(1).gcol, Vec3::ZERO, "one reflection does not reach the wall");
}

/// A square from (0, 0) to (1, 1) with a texture of the colours red, green | blue, white, rows from the top.
fn painted(repeats: f32) -> Scene {
    let mut builder = SceneBuilder::new("painted");
    let texture = builder.texture(2, vec![0xff00_00ff, 0xff00_ff00, 0xffff_0000, 0xffff_ffff]);
    builder.object(Material { diffuse_texture: Some(texture), ..matte(Vec3::ONE) });
    let corners = [v(0.0, 0.0, 0.0), v(1.0, 0.0, 0.0), v(1.0, 1.0, 0.0), v(0.0, 1.0, 0.0)];
    builder.quad_with(corners, ONCE.map(|t| t * repeats));
    builder.build(1.0)
}

#[test]
fn a_texture_hangs_the_right_way_up_and_repeats() {
    let expected = [(0.25, 0.75, Vec3::X), (0.75, 0.75, Vec3::Y), (0.25, 0.25, Vec3::Z), (0.75, 0.25, Vec3::ONE)];
    for repeats in [1.0, 3.0] {
        let stand = Stand::new(&painted(repeats), 1, 1, 0);
        let at = |x: f32, y: f32| stand.look(v(x, y, 1.0), Vec3::NEG_Z).unwrap().local;
        for tile in 0..repeats as u32 * repeats as u32 {
            let (i, j) = ((tile % repeats as u32) as f32, (tile / repeats as u32) as f32);
            for (s, t, colour) in expected {
                assert_colour("texel", at((i + s) / repeats, (j + t) / repeats), colour, 1e-5);
            }
            // Between two texels: half of each. On the left border: half of what the next repetition ends with.
            let middle = at((i + 0.5) / repeats, (j + 0.75) / repeats);
            assert_colour("between", middle, v(0.5, 0.5, 0.0), 1e-5);
            let border = at((i + 1e-4) / repeats, (j + 0.25) / repeats);
            assert_colour("border", border, v(0.5, 0.5, 1.0), 1e-3);
        }
    }
    let stand = Stand::new(&painted(1.0), 1, 1, 0);
    for (s, t, colour) in expected {
        assert_eq!(sample_texture(&stand.args(), 0, s, t), colour);
    }
}

#[test]
fn pictures_have_their_corners_where_they_belong() {
    // The camera sees the middle of the square: x to the right, y up.
    let mut scene = painted(1.0);
    let mut view = scene.view().clone();
    let camera = &mut view.camera;
    (camera.eye, camera.look_at, camera.fov_y_degrees) = (v(0.5, 0.5, 1.0), v(0.5, 0.5, 0.0), 40.0);
    scene.set_view(view).unwrap();
    for mode in [Mode::Full, Mode::Adaptive] {
        let frame = draw(&mut twin_renderer(scene.clone()), &options(mode, 40, 40, 2));
        let strongest = |x: usize, y: usize| {
            let word = frame.pixels[y * 40 + x];
            [word & 255, word >> 8 & 255, word >> 16 & 255].map(|c| c > 190)
        };
        assert_eq!(strongest(3, 3), [true, false, false], "top left is red");
        assert_eq!(strongest(36, 3), [false, true, false], "top right is green");
        assert_eq!(strongest(3, 36), [false, false, true], "bottom left is blue");
        assert_eq!(strongest(36, 36), [true, true, true], "bottom right is white");
    }
}

#[test]
fn a_leaf_is_cut_out_for_eyes_and_light() {
    // A leaf over a floor, holes in the left half of its texture; a light above.
    let mut builder = SceneBuilder::new("leaf").light(v(0.0, 100.0, 0.0), 1e4).environment(0.0, Vec3::ZERO);
    let texture = builder.texture(2, vec![0x00ff_ffff, 0xffff_ffff]);
    let leaf = builder.object(Material { cutout_texture: Some(texture), ..matte(GREEN) });
    let corners = [v(-1.0, 1.0, 1.0), v(1.0, 1.0, 1.0), v(1.0, 1.0, -1.0), v(-1.0, 1.0, -1.0)];
    builder.quad_with(corners, ONCE);
    let floor = builder.object(matte(RED));
    builder.floor(Vec2::splat(-9.0), Vec2::splat(9.0), 0.0);
    let stand = Stand::new(&builder.build(1.0), 1, 1, 0);
    for (x, object) in
        [(-0.9, floor), (-0.5, floor), (-0.02, floor), (0.02, leaf), (0.5, leaf), (0.98, leaf), (1.02, floor)]
    {
        let from_above = stand.look(v(x, 3.0, 0.1), v(0.0, -1.0, 0.0)).unwrap();
        assert_eq!(from_above.point.object, object, "at {x}");
        let below = stand.look(v(x, 0.5, 0.1), v(0.0, -1.0, 0.0)).unwrap();
        assert_eq!((below.point.object, below.shadow_bits == 1), (floor, object == leaf), "shadow at {x}");
    }
}

#[test]
fn glass_casts_no_shadow_and_stones_do() {
    for (material, shadowed) in [
        (glass(Surface::Glass, 1.5), false),
        (glass(Surface::ThinGlass, 1.5), false),
        (mirror(1.0), true),
        (matte(RED), true),
    ] {
        let mut builder = SceneBuilder::new("shade").light(v(0.0, 5.0, 0.0), 1.0);
        builder.object(matte(Vec3::ONE));
        builder.floor(Vec2::splat(-9.0), Vec2::splat(9.0), 0.0);
        builder.object(material);
        builder.block(v(-1.0, 1.0, -1.0), v(1.0, 2.0, 1.0));
        let stand = Stand::new(&builder.build(1.0), 1, 1, 0);
        let look = stand.look(v(0.3, 0.5, 0.2), v(0.0, -1.0, 0.0)).unwrap();
        assert_eq!(look.shadow_bits == 1, shadowed);
    }
}
