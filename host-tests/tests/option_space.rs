// SPDX-License-Identifier: MIT OR Apache-2.0
//! Do frames anywhere in the space of options stay within their buffers, and are they the same on the twin and on OpenCL?
#![allow(clippy::unwrap_used, missing_docs)]

use rarefy::Scene;
use rarefy::internal::device::open::{DeviceChoice, DeviceOptions};
use rarefy::internal::device::opencl::OpenOptions;
use rarefy::internal::method::counts::Keep;
use rarefy::internal::method::options::{
    Checks, Compared, Correction, GcolSpace, Interpolation, Method, Mode, RenderOptions, Test, TestSet, TextureRule,
    Tolerances,
};
use rarefy::internal::render::renderer::Renderer;
use rarefy::internal::scene::builtin;
use rarefy_host_tests::fixtures::{Random, SceneBuilder, blocks, dashes, matte, mirror, v, with};
use rarefy_host_tests::frames::{Prepared, device, no_opencl, renderer_of, twin, zoo};

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

/// One of the values.
fn any<T: Copy>(random: &mut Random, values: &[T]) -> T {
    values[random.below(values.len())]
}

fn flip(random: &mut Random) -> bool {
    random.below(2) == 0
}

/// Tolerances from "every pair fails" to "every pair passes".
fn tolerances(random: &mut Random) -> Tolerances {
    Tolerances {
        t_pos: any(random, &[0.0, 0.001, 0.03, 0.06, 1.0e9]),
        t_norm: any(random, &[-1.0, 0.5, 0.9, 0.99, 2.0]),
        t_conv: any(random, &[0.0, 0.05, 0.2, 1.0]),
        t_tex: any(random, &[0.0, 0.1, 0.3, 1.0]),
        t_gcol: any(random, &[0.0, 0.05, 0.15, 10.0]),
    }
}

fn compared(random: &mut Random) -> Compared {
    let t_visible = any(random, &[0, 1, 6, 255]);
    match random.below(3) {
        0 => Compared::Object,
        1 => Compared::ObjectAndShadow { t_visible },
        _ => {
            Compared::All { t_visible, t_norm: any(random, &[-1.0, 0.9, 2.0]), t_gcol: any(random, &[0.0, 0.07, 10.0]) }
        }
    }
}

fn method(random: &mut Random) -> Method {
    let tests = Test::ALL.into_iter().filter(|_| random.below(4) > 0);
    let tests = tests.fold(TestSet::NONE, TestSet::with);
    let compared = compared(random);
    Method {
        block: any(random, &[2, 4]),
        checks: Checks {
            tests: if flip(random) { TestSet::ALL } else { tests },
            fine: tolerances(random),
            coarse: tolerances(random),
            textures: any(random, &TextureRule::ALL),
            gcol_space: any(random, &GcolSpace::ALL),
            second_pairs: flip(random),
        },
        interpolation: any(random, &Interpolation::ALL),
        correction: match random.below(5) {
            0 => Correction::Off,
            1 => Correction::Sweeps(compared),
            _ => Correction::Converged { compared, thin_only: flip(random), bridges: flip(random) },
        },
        reuse_shadows: flip(random),
    }
}

/// Sides from one pixel to a few blocks and tiles, odd ones among them.
fn side(random: &mut Random) -> u32 {
    match random.below(3) {
        0 => any(random, &[1, 2, 3, 4, 5, 31, 32, 33, 63, 64, 65]),
        _ => 1 + random.below(70) as u32,
    }
}

fn options(random: &mut Random) -> RenderOptions {
    let method = method(random);
    let samples = any(random, &[1, 1, 1, 2, 4]);
    let (width, height) = (side(random).div_ceil(samples), side(random).div_ceil(samples));
    // Sweeps cannot be drawn in bands; a frame of one band may have as many rows as it likes.
    let banded = random.below(3) == 0 && !matches!(method.correction, Correction::Sweeps(_));
    RenderOptions {
        width,
        height,
        samples,
        mode: if random.below(8) == 0 { Mode::Full } else { Mode::Adaptive },
        depth: any(random, &[0, 1, 4]),
        method,
        band_rows: banded.then(|| 1 + random.below(40) as u32),
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

fn renderer(scene: &Scene, device: DeviceChoice) -> Renderer {
    let options = DeviceOptions { device, strict: true, ..DeviceOptions::default() };
    renderer_of(scene, &options, &rarefy::Monitor::default()).unwrap()
}

/// Draws `rounds` random frames on the twin and on OpenCL: no launch may be refused, no result may differ.
fn draw_anywhere(seed: u64, rounds: usize) {
    let mut random = Random::new(seed);
    let with_opencl = !no_opencl();
    let scenes = scenes();
    let mut drawn = 0;
    for (at, scene) in scenes.iter().enumerate() {
        let mut twin = renderer(scene, DeviceChoice::Cpu);
        let mut device = with_opencl.then(|| renderer(scene, DeviceChoice::OpenCl(None)));
        for _ in (at..rounds).step_by(scenes.len()) {
            let options = options(&mut random);
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
    draw_anywhere(2016, 70);
}

#[test]
#[ignore = "long: thousands of frames anywhere in the space of options"]
fn thousands_of_frames_anywhere_in_the_space_of_options() {
    let rounds = std::env::var("OPTION_SPACE_FRAMES").ok().and_then(|count| count.parse().ok());
    draw_anywhere(805, rounds.unwrap_or(4_000));
}
