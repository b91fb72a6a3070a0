// SPDX-License-Identifier: MIT OR Apache-2.0
//! The wide CPU engine against the twin: every launch, bit for bit, on every width that this processor has.
#![allow(clippy::unwrap_used, missing_docs)]

use std::collections::BTreeSet;

use rarefy::internal::device::cpu::Width;
use rarefy::internal::device::cpu::executor::CpuExecutor;
use rarefy::internal::device::executor::Executor;
use rarefy::internal::device::stage::LAUNCHES;
use rarefy::internal::method::options::{GcolSpace, Interpolation, Method, RenderOptions};
use rarefy::internal::prepare::Shading;
use rarefy::internal::scene::{Camera, Scene, Surface, builtin};
use rarefy_host_tests::fixtures::{Random, blocks, combinations, full, sized, sweeps, with};
use rarefy_host_tests::frames::{Prepared, compare, twin};

fn engines() -> Vec<CpuExecutor> {
    let engines: Vec<CpuExecutor> = Width::available().filter_map(CpuExecutor::of_width).collect();
    assert!(!engines.is_empty() || cfg!(target_arch = "arm"), "this processor has no lanes");
    engines
}

#[test]
fn every_launch_of_every_kind_of_frame_equals_the_twin() {
    let prepared = Prepared::named("zoo");
    for mut engine in engines() {
        let frames = combinations(50, 38).into_iter().map(|options| (options, false));
        let results = compare(&prepared, &mut engine, frames);
        let launched: BTreeSet<&str> = results.iter().map(|r| r.kernel.label(r.stage)).collect();
        assert_eq!(launched, LAUNCHES.iter().map(|(.., label)| *label).collect(), "not every launch was compared");
        // What is counted are the twin's own steps.
        compare(&prepared, &mut engine, [(sized(50, 38), true)]);
    }
}

#[test]
fn frames_of_every_size_and_scene_equal_the_twin() {
    for name in rarefy_host_tests::fixtures::quick_scenes() {
        let prepared = Prepared::named(name);
        for mut engine in engines() {
            let mut frames = Vec::new();
            for (width, height) in [(1, 1), (1, 7), (7, 1), (2, 2), (3, 5), (33, 17)] {
                for block in [2, 4] {
                    frames.push((RenderOptions { method: blocks(block), ..sized(width, height) }, false));
                }
                frames.push((full(&sized(width, height)), false));
            }
            compare(&prepared, &mut engine, frames);
        }
    }
}

#[test]
fn larger_frames_equal_the_twin() {
    for name in ["cafe", "rods", "mirror-room"] {
        let prepared = Prepared::named(name);
        let four = RenderOptions { method: blocks(4), ..sized(210, 150) };
        let linear = with(&sized(210, 150), |method| {
            method.checks.gcol_space = GcolSpace::Linear;
            method.interpolation = Interpolation::Plain;
        });
        let paper = RenderOptions { method: Method::paper(), ..sized(210, 150) };
        for mut engine in engines() {
            compare(
                &prepared,
                &mut engine,
                [sized(210, 150), four.clone(), linear.clone(), paper.clone()].map(|f| (f, false)),
            );
        }
    }
}

#[test]
fn anchor_shading_equals_the_twin() {
    for name in ["spheres", "mirror-room"] {
        let prepared = Prepared::new(builtin::to_scene(name).unwrap(), Shading::Anchor);
        for mut engine in engines() {
            compare(&prepared, &mut engine, [(full(&sized(50, 38)), false), (sized(50, 38), false)]);
        }
    }
}

#[test]
fn whole_frames_equal_those_of_the_twin() {
    for name in ["zoo", "cafe"] {
        let prepared = Prepared::named(name);
        for mut engine in engines() {
            let sweeps = RenderOptions { method: sweeps(), ..sized(96, 64) };
            for options in [sized(96, 64), sweeps, full(&sized(96, 64))] {
                let drawn = prepared.draw(&mut engine, &options, false).unwrap();
                let expected = prepared.draw(&mut twin(), &options, false).unwrap();
                assert!(drawn == expected, "{name}, {}: {options:?}", engine.info().name);
            }
        }
    }
}

/// Cameras anywhere: within the scene, far away, looking past it, with narrow and wide views.
#[test]
fn views_from_anywhere_equal_the_twin() {
    let mut random = Random::new(14);
    for name in ["zoo", "wall", "rods", "spheres"] {
        let mut prepared = Prepared::named(name);
        let given = prepared.scene.view().clone();
        for round in 0..20 {
            let span = (given.camera.eye - given.camera.look_at).length() * 10f32.powf(random.range(-3.0, 2.5));
            let eye = given.camera.look_at + random.direction() * span;
            let look_at = if round % 4 == 3 { eye + random.direction() * span } else { given.camera.look_at };
            let camera =
                Camera { eye, look_at, up: random.direction(), fov_y_degrees: 10f32.powf(random.range(-1.0, 2.24)) };
            prepared.scene.set_view(rarefy::View { camera, ..given.clone() }).unwrap();
            let size = [1 + random.below(40) as u32, 1 + random.below(40) as u32];
            let options = RenderOptions { method: blocks([2, 4][round % 2]), ..sized(size[0], size[1]) };
            for mut engine in engines() {
                compare(&prepared, &mut engine, [(options.clone(), false), (full(&options), false)]);
            }
        }
    }
}

/// Eyes on triangles: whether a ray meets the surface that it starts on is a matter of the bound on the plane's error.
#[test]
fn eyes_on_surfaces_equal_the_twin() {
    let mut random = Random::new(5);
    for name in ["zoo", "mirror-room"] {
        let mut prepared = Prepared::named(name);
        let given = prepared.scene.view().clone();
        let parts = prepared.scene.clone().into_parts();
        for round in 0..30 {
            let corners = parts.triangles[random.below(parts.triangles.len())].map(|i| parts.positions[i as usize]);
            let eye = (corners[0] + corners[1] + corners[2]) / 3.0;
            let camera = Camera { eye, look_at: eye + random.direction(), up: random.direction(), fov_y_degrees: 90.0 };
            prepared.scene.set_view(rarefy::View { camera, ..given.clone() }).unwrap();
            let options = RenderOptions { method: blocks([2, 4][round % 2]), ..sized(33, 25) };
            for mut engine in engines() {
                compare(&prepared, &mut engine, [(options.clone(), false), (full(&options), false)]);
            }
        }
    }
}

/// What is seen in a mirror that has a texture of its own is not kept with it.
#[test]
fn a_textured_mirror_equals_the_twin() {
    let mut parts = Prepared::named("window").scene.into_parts();
    for material in parts.materials.iter_mut().filter(|material| material.surface == Surface::Mirror) {
        material.diffuse_texture = Some(0);
    }
    let prepared = Prepared::new(Scene::new(parts).unwrap(), Shading::Full);
    for mut engine in engines() {
        for block in [2, 4] {
            let options = RenderOptions { method: blocks(block), ..sized(64, 48) };
            compare(&prepared, &mut engine, [(options.clone(), false), (full(&options), false)]);
        }
    }
}
