// SPDX-License-Identifier: MIT OR Apache-2.0
//! Frames drawn in bands equal frames drawn at once, byte for byte, whatever the height of the bands.
#![allow(clippy::unwrap_used, missing_docs)]

use glam::{DVec3, Vec3};
use rarefy::Error;
use rarefy::internal::device::open::{DeviceChoice, DeviceOptions};
use rarefy::internal::layout::*;
use rarefy::internal::method::counts::{Keep, PixelCounts};
use rarefy::internal::method::options::{Compared, Correction, Method, Mode, RenderOptions};
use rarefy::internal::render::frame::Frame;
use rarefy::internal::render::renderer::Renderer;
use rarefy::internal::scene::Scene;
use rarefy::internal::scene::builtin;
use rarefy_host_tests::fixtures::*;
use rarefy_host_tests::frames::{no_opencl, renderer_of};
use rarefy_host_tests::masks::*;

fn renderer(scene: Scene, device: DeviceChoice) -> Renderer {
    renderer_of(
        &scene,
        &DeviceOptions { device, strict: true, ..DeviceOptions::default() },
        &rarefy::Monitor::default(),
    )
    .unwrap()
}

fn devices() -> Vec<DeviceChoice> {
    let mut devices = vec![DeviceChoice::Cpu];
    if !no_opencl() {
        devices.push(DeviceChoice::OpenCl(None));
    }
    devices
}

/// A frame and its classes.
fn draw(renderer: &mut Renderer, options: &RenderOptions) -> (Frame, Vec<u32>) {
    let frame = renderer.render_exactly(options, Keep::planes(&[PLANE_CLASS]).and(Keep::COUNTERS)).unwrap();
    let classes = renderer.plane(PLANE_CLASS).unwrap();
    (frame, classes)
}

fn assert_same_in_bands(renderer: &mut Renderer, options: &RenderOptions, band_rows: &[u32]) {
    let (whole, whole_classes) = draw(renderer, options);
    for &rows in band_rows {
        let banded = RenderOptions { band_rows: Some(rows), ..options.clone() };
        let (frame, classes) = draw(renderer, &banded);
        assert!(frame.pixels == whole.pixels, "bands of {rows} rows: another picture");
        assert!(classes == whole_classes, "bands of {rows} rows: other classes");
        // Which pixels chance finds first depends on the bands; where it all ends does not.
        let ends = |frame: &Frame| PixelCounts { probes: 0, beside_probes: 0, ..frame.stats.pixels };
        assert_eq!(ends(&frame), ends(&whole), "bands of {rows} rows");
        assert_eq!(frame.stats.failed_tests, whole.stats.failed_tests, "bands of {rows} rows");
        if options.mode == Mode::Full {
            assert_eq!(frame.stats.work, whole.stats.work, "bands of {rows} rows");
        }
    }
}

#[test]
fn five_band_heights_draw_one_picture_on_both_back_ends() {
    for device in devices() {
        let mut renderer = renderer(builtin::to_scene("rods").unwrap(), device);
        for (block, samples) in [(2, 1), (4, 1), (2, 2)] {
            let options =
                RenderOptions { width: 101, height: 75, method: blocks(block), samples, ..RenderOptions::default() };
            assert_same_in_bands(&mut renderer, &options, &[2, 6, 8, 20, 64]);
        }
        let full = RenderOptions { width: 61, height: 47, samples: 2, mode: Mode::Full, ..RenderOptions::default() };
        assert_same_in_bands(&mut renderer, &full, &[1, 7, 30]);
    }
}

#[test]
fn dashes_are_found_across_gaps_in_bands_of_any_height() {
    for device in devices() {
        let mut renderer = renderer(dashes(&[(4.3, 6.0), (52.3, -9.0)]), device);
        let options = RenderOptions { width: 64, height: 64, ..RenderOptions::default() };
        let (joined, _) = draw(&mut renderer, &options);
        let (without, _) = draw(
            &mut renderer,
            &with(&options, |method| {
                let compared = Compared::VISIBLE;
                method.correction = Correction::Converged { compared, thin_only: true, bridges: false, probes: true };
            }),
        );
        assert!(joined.pixels != without.pixels, "there are no gaps to look across");
        assert_same_in_bands(&mut renderer, &options, &[2, 4, 6, 10, 32]);
        assert_same_in_bands(&mut renderer, &RenderOptions { method: blocks(4), ..options }, &[4, 8, 12, 20, 32]);
    }
}

/// A wall with a thin wire before it that lies between two columns of base pixels; only its lowest part is so wide
/// that one of them meets it. Everything above is found by correction alone, upwards through all bands.
fn wire_scene() -> Scene {
    let eye = Eye { at: DVec3::new(0.0, 0.0, 4.0), look_at: DVec3::ZERO, fov_degrees: 40.0 };
    let mut builder = eye.seen_from(SceneBuilder::new("wire"));
    builder.object(matte(Vec3::splat(0.6)));
    builder.quad([v(-4.0, -4.0, 0.0), v(4.0, -4.0, 0.0), v(4.0, 4.0, 0.0), v(-4.0, 4.0, 0.0)]);
    builder.object(matte(Vec3::new(0.9, 0.2, 0.1)));
    // The wire: about 0.9 pixels wide at 96 pixels, between two columns of base pixels.
    let pixel = 2.0 * 3.0 * 20f64.to_radians().tan() / 96.0;
    let (left, right) = ((pixel * 1.05) as f32, (pixel * 1.95) as f32);
    let [below, knee, above] = [-43.0, -33.0, 42.0].map(|rows| (rows * pixel) as f32);
    let pixel = pixel as f32;
    builder.quad([v(left, knee, 1.0), v(right, knee, 1.0), v(right, above, 1.0), v(left, above, 1.0)]);
    builder.quad([v(left, below, 1.0), v(right + pixel, below, 1.0), v(right, knee, 1.0), v(left, knee, 1.0)]);
    builder.build(10.0)
}

#[test]
fn a_thin_wire_is_followed_through_every_band() {
    // Shifted rows would meet the wire in every second of them.
    let method = Method { shifted_rows: false, ..Method::default() };
    let options = RenderOptions { width: 96, height: 96, method, ..RenderOptions::default() };
    for device in devices() {
        let mut renderer = renderer(wire_scene(), device);
        let without = with(&options, |method| method.correction = Correction::Off);
        let (full, _) = draw(&mut renderer, &RenderOptions { mode: Mode::Full, ..options.clone() });
        let (blind, _) = draw(&mut renderer, &without);
        let (whole, classes) = draw(&mut renderer, &options);
        // The wire matters: without correction most of it is missing, with it the picture is whole.
        let rows_apart =
            |frame: &Frame| (0..96).filter(|&y| frame.pixels[y * 96..][..96] != full.pixels[y * 96..][..96]).count();
        assert!(rows_apart(&blind) > 40, "only {} rows miss the wire", rows_apart(&blind));
        assert_eq!(rows_apart(&whole), 0);
        let corrected = |rows: std::ops::Range<usize>| {
            classes[rows.start * 96..rows.end * 96].iter().any(|c| c & CLASS_MASK == CLASS_CORRECTED)
        };
        assert!((30..80).step_by(2).all(|y| corrected(y..y + 2)), "the wire crosses every band");
        assert_same_in_bands(&mut renderer, &options, &[2, 4, 8, 16, 48]);
        assert_same_in_bands(
            &mut renderer,
            &RenderOptions { method: Method { block: 4, ..method }, ..options.clone() },
            &[4, 12, 16, 32, 48],
        );
    }
}

#[test]
fn a_budget_cuts_the_frame_and_is_kept() {
    let options = RenderOptions { width: 300, height: 200, ..RenderOptions::default() };
    let scene = || builtin::to_scene("spheres").unwrap();
    let draw_within = |bytes: Option<u64>| {
        let renderer_options =
            DeviceOptions { device: DeviceChoice::Cpu, memory_budget_bytes: bytes, ..DeviceOptions::default() };
        let mut renderer = renderer_of(&scene(), &renderer_options, &rarefy::Monitor::default()).unwrap();
        let frame = renderer.render_exactly(&options, Keep::default());
        (frame.map(|frame| frame.pixels), renderer.peak_device_bytes())
    };
    let (whole, unlimited) = draw_within(None);
    let whole = whole.unwrap();
    for share in [2, 5] {
        let budget = unlimited / share;
        let (pixels, peak) = draw_within(Some(budget));
        assert!(pixels.unwrap() == whole, "{budget} bytes: another picture");
        assert!(peak <= budget && peak < unlimited, "{peak} bytes in use, {budget} allowed, {unlimited} without limit");
    }
    let error = draw_within(Some(100 << 10)).0.map(|_| "drawn").unwrap_err();
    assert!(matches!(&error, Error::LimitExceeded { limit, .. } if limit == "memory_budget"), "{error}");
}

#[test]
fn sweeps_need_the_whole_frame() {
    let mut renderer = renderer(builtin::to_scene("spheres").unwrap(), DeviceChoice::Cpu);
    let options =
        RenderOptions { width: 64, height: 64, method: sweeps(), band_rows: Some(16), ..RenderOptions::default() };
    let error = renderer.render_exactly(&options, Keep::default()).unwrap_err().to_string();
    assert!(error.contains("sweeps") && error.contains("converged"), "{error}");
    // The renderer stays usable.
    renderer.render_exactly(&RenderOptions { band_rows: None, ..options }, Keep::default()).unwrap();
}

#[test]
fn any_size_from_one_pixel_on() {
    let mut renderer = renderer(builtin::to_scene("spheres").unwrap(), DeviceChoice::Cpu);
    for (width, height) in [(1, 1), (1, 9), (9, 1), (2, 3), (5, 300), (400, 3)] {
        for (samples, block) in [(1, 2), (1, 4), (2, 2), (4, 4)] {
            let options = RenderOptions { width, height, samples, method: blocks(block), ..RenderOptions::default() };
            assert_same_in_bands(&mut renderer, &options, &[1, 4, 37]);
        }
    }
}

#[test]
fn extreme_sizes_are_the_same_on_both_back_ends_and_in_bands() {
    let mut renderers: Vec<Renderer> =
        devices().into_iter().map(|device| renderer(builtin::to_scene("spheres").unwrap(), device)).collect();
    for (width, height) in [(1, 1), (2, 1), (3, 5), (5, 3), (1, 4096), (4096, 1), (7, 1023)] {
        for (samples, block, mode) in
            [(1, 2, Mode::Adaptive), (1, 4, Mode::Adaptive), (2, 2, Mode::Adaptive), (1, 2, Mode::Full)]
        {
            let options =
                RenderOptions { width, height, samples, method: blocks(block), mode, ..RenderOptions::default() };
            let mut drawn = Vec::new();
            for renderer in &mut renderers {
                let (whole, classes) = draw(renderer, &options);
                assert_eq!(whole.pixels.len(), (width * height) as usize);
                assert_same_in_bands(renderer, &options, &[height.div_ceil(3) * samples]);
                drawn.push((whole.pixels, classes));
            }
            assert!(drawn.iter().all(|frame| frame == &drawn[0]), "{width}x{height}, blocks of {block}, {mode:?}");
        }
    }
}

#[test]
#[ignore = "long: real scenes in bands of five heights"]
fn real_scenes_are_the_same_in_bands() {
    let folder = rarefy_host_tests::command::root().join("../shared/scenes");
    for name in ["classroom", "bathroom"] {
        if !folder.join(name).is_dir() {
            println!("skipped: ../shared/scenes is not here");
            continue;
        }
        for device in devices() {
            let scene = rarefy::internal::scene::load(&folder.join(name), &rarefy::Monitor::default()).unwrap();
            let mut renderer = renderer(scene, device);
            let options = RenderOptions { width: 400, height: 301, ..RenderOptions::default() };
            assert_same_in_bands(&mut renderer, &options, &[2, 10, 32, 76, 200]);
            assert_same_in_bands(&mut renderer, &RenderOptions { method: blocks(4), ..options.clone() }, &[4, 40, 150]);
        }
    }
}
