// SPDX-License-Identifier: MIT OR Apache-2.0
//! Do frames anywhere in the space of options stay within their buffers, and are they the same on the twin and on OpenCL?
#![allow(clippy::unwrap_used, missing_docs)]

use std::path::Path;

use rarefy::Scene;
use rarefy::internal::device::open::{DeviceChoice, DeviceOptions};
use rarefy::internal::device::opencl::{CacheFolder, OpenOptions};
use rarefy::internal::method::counts::Keep;
use rarefy::internal::method::options::RenderOptions;
use rarefy::internal::scene::builtin;
use rarefy_host_tests::fixtures::{Random, SceneBuilder, blocks, dashes, matte, mirror, v, with};
use rarefy_host_tests::frames::{Prepared, device, no_opencl, renderer_of, twin, zoo};
use rarefy_host_tests::option_space::options;

/// Every check fails: with blocks of 4, fifteen sixteenths of the pixels are sources of correction's first round, each
/// with five items. That was more than the masks held, and corrupted the heap under OpenCL.
#[test]
fn a_frame_in_which_every_check_fails_fits_its_buffers() {
    for block in [2, 4] {
        let sized = RenderOptions { width: 64, height: 64, method: blocks(block), ..RenderOptions::default() };
        let options = with(&sized, |method| {
            method.checks.fine.t_pos = 0.0;
            method.checks.coarse.t_pos = 0.0;
        });
        let prepared = Prepared::named("rods");
        let twin = prepared.draw(&mut twin(), &options, false).unwrap();
        assert_eq!(twin.counts.interpolated, 0);
        if !no_opencl() {
            let mut device = device(true, &OpenOptions::default());
            assert_eq!(twin, prepared.draw(&mut device, &options, false).unwrap());
        }
    }
}

/// Triangles of all sizes without order, half of them mirrors: hardly a check succeeds.
fn thicket() -> Scene {
    let mut random = Random::new(16);
    let mut builder = SceneBuilder::new("thicket").camera(v(0.0, 0.0, 3.0), v(0.0, 0.0, 0.0), 50.0);
    builder = builder.light(v(2.0, 3.0, 4.0), 20.0).light(v(-2.0, 1.0, 2.0), 5.0);
    for i in 0..400 {
        builder.object(if i % 2 == 0 { matte(v(0.7, 0.4, 0.2)) } else { mirror(0.8) });
        let (middle, size) = (random.point(1.0), 0.02 + 0.3 * random.unit());
        builder.triangle([0, 1, 2].map(|_| middle + random.point(size)));
    }
    builder.build(4.0)
}

fn scenes() -> Vec<Scene> {
    let builtin = ["rods", "spheres", "wall", "mirror-room"].map(|name| builtin::to_scene(name).unwrap());
    builtin.into_iter().chain([zoo(), thicket(), dashes(&[(12.3, 6.0), (52.3, -9.0)])]).collect()
}

/// How frames are drawn on OpenCL.
#[derive(Clone, Copy, Default)]
struct Space {
    /// Kernels with bounds checks.
    bounds_checks: bool,
    /// Most samples of a side; `None`: a few tiles.
    largest: Option<u32>,
}

/// Draws `rounds` random frames on the twin and on OpenCL: no launch may be refused, no result may differ.
fn draw_anywhere(seed: u64, rounds: usize, space: Space) {
    let mut random = Random::new(seed);
    let with_opencl = !no_opencl();
    let scenes = scenes();
    let renderer = |scene: &Scene, device| {
        let cache = CacheFolder::At(Path::new(env!("CARGO_TARGET_TMPDIR")).join("option-space"));
        let Space { bounds_checks, .. } = space;
        let options = DeviceOptions { device, strict: true, bounds_checks, cache, ..DeviceOptions::default() };
        renderer_of(scene, &options, &rarefy::Monitor::default()).unwrap()
    };
    let mut drawn = 0;
    for (at, scene) in scenes.iter().enumerate() {
        let mut twin = renderer(scene, DeviceChoice::Twin);
        let mut device = with_opencl.then(|| renderer(scene, DeviceChoice::OpenCl(None)));
        for _ in (at..rounds).step_by(scenes.len()) {
            let options = options(&mut random, space.largest.unwrap_or(70));
            let frame = twin.render_exactly(&options, Keep::EVERYTHING);
            let frame = frame.unwrap_or_else(|error| panic!("{}: {options:?}: {error}", scene.name()));
            let p = frame.stats.pixels;
            let samples = options.sample_size();
            let all = u64::from(samples.0) * u64::from(samples.1);
            assert_eq!(p.base + p.traced + p.interpolated + p.corrected, all, "{}: {options:?}", scene.name());
            if let Some(device) = &mut device {
                let other = device.render_exactly(&options, Keep::EVERYTHING);
                let other = other.unwrap_or_else(|error| panic!("{}: {options:?}: {error}", scene.name()));
                assert!(frame.pixels == other.pixels, "{}: other pictures: {options:?}", scene.name());
                let (ours, theirs) = (&frame.stats, &other.stats);
                assert_eq!((ours.pixels, ours.rays), (theirs.pixels, theirs.rays), "{}: {options:?}", scene.name());
                assert_eq!(ours.failed_tests, theirs.failed_tests, "{}: {options:?}", scene.name());
            }
            drawn += 1;
        }
    }
    println!("{drawn} frames");
    assert_eq!(drawn, rounds);
}

#[test]
fn frames_anywhere_in_the_space_of_options_are_drawn_alike() {
    draw_anywhere(2016, 70, Space::default());
}

#[test]
#[ignore = "long: thousands of frames anywhere in the space of options"]
fn thousands_of_frames_anywhere_in_the_space_of_options() {
    let number = |name: &str| std::env::var(name).ok().and_then(|value| value.parse::<usize>().ok());
    // For whoever has the time: how many, how large, and which ones.
    let largest = number("OPTION_SPACE_LARGEST").map(|largest| largest as u32);
    let seed = number("OPTION_SPACE_SEED").unwrap_or(805) as u64;
    draw_anywhere(seed, number("OPTION_SPACE_FRAMES").unwrap_or(4_000), Space { largest, ..Space::default() });
}

#[test]
#[ignore = "long: hundreds of frames anywhere in the space of options by kernels with bounds checks"]
fn frames_anywhere_stay_within_their_buffers_access_by_access() {
    draw_anywhere(77, 700, Space { bounds_checks: true, ..Space::default() });
}

#[test]
#[ignore = "oclgrind: small frames anywhere in the space of options"]
fn no_frame_in_the_space_of_options_races_or_leaves_its_buffers() {
    let Some(log) = std::env::var_os("RAREFY_OCLGRIND_LOG") else {
        println!("skipped: run by .ci/long-oclgrind.sh");
        return;
    };
    draw_anywhere(21, 35, Space { largest: Some(14), ..Space::default() });
    assert_eq!(std::fs::read_to_string(log).unwrap_or_default(), "", "Oclgrind found something");
}
