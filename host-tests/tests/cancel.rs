// SPDX-License-Identifier: MIT OR Apache-2.0
//! Work that is watched: it can be cancelled at any moment, tells how far it is, shows previews, and leaves everything
//! as it was when it is cancelled.
#![allow(clippy::unwrap_used, missing_docs)]

use std::path::Path;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use rarefy::internal::device::open::{DeviceChoice, DeviceOptions};
use rarefy::internal::layout::*;
use rarefy::internal::method::counts::Keep;
use rarefy::internal::method::options::{Mode, RenderOptions};
use rarefy::internal::monitor::{Cancel, Event, Monitor};
use rarefy::internal::render::frame::Frame;
use rarefy::internal::render::renderer::Renderer;
use rarefy::internal::scene::{self, builtin};
use rarefy::{Error, Scene};
use rarefy_host_tests::command::root;
use rarefy_host_tests::fixtures::{blocks, sweeps};
use rarefy_host_tests::frames::{no_opencl, renderer_of};

fn devices() -> Vec<DeviceChoice> {
    let mut devices = vec![DeviceChoice::Cpu];
    if !no_opencl() {
        devices.push(DeviceChoice::OpenCl(None));
    }
    devices
}

fn renderer(scene: Scene, device: DeviceChoice) -> Renderer {
    let options = DeviceOptions { device, strict: true, ..DeviceOptions::default() };
    renderer_of(&scene, &options, &Monitor::default()).unwrap()
}

fn small(width: u32, height: u32) -> RenderOptions {
    RenderOptions { width, height, ..RenderOptions::default() }
}

/// A monitor that cancels when it hears its report number `at` (from 0), and the count of its reports.
fn cancelling_at(at: u32) -> (Monitor, Arc<AtomicU32>) {
    let (cancel, heard) = (Cancel::default(), Arc::new(AtomicU32::new(0)));
    let (token, count) = (cancel.clone(), Arc::clone(&heard));
    let monitor = Monitor::with_previews(move |_| {
        if count.fetch_add(1, Ordering::Relaxed) == at {
            token.cancel();
        }
    });
    (monitor.with_cancel(&cancel), heard)
}

/// Cancels `work` at its first, second, ... report until it is done before; returns how often it was cancelled.
fn cancel_at_every_report(mut work: impl FnMut(&Monitor) -> rarefy::Result<()>, step: usize) -> usize {
    let mut cancelled = 0;
    for at in (0..).step_by(step) {
        let (monitor, heard) = cancelling_at(at);
        match work(&monitor) {
            Err(Error::Cancelled) => cancelled += 1,
            Err(error) => panic!("at report {at}: {error}"),
            Ok(()) if heard.load(Ordering::Relaxed) <= at => break,
            // Cancelled by the last report, which says that all is done.
            Ok(()) => {}
        }
    }
    cancelled
}

#[test]
fn a_scene_from_files_can_be_cancelled_while_it_is_loaded() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("spheres");
    builtin::write("spheres", &path).unwrap();
    let load = |monitor: &Monitor| scene::load(&path, monitor).map(|_| ());
    assert!(cancel_at_every_report(load, 1) >= 4);
    let cancelled = Cancel::default();
    cancelled.cancel();
    let error = scene::load(&path, &Monitor::default().with_cancel(&cancelled)).unwrap_err();
    assert!(matches!(error, Error::Cancelled), "{error}");
    assert_eq!(error.to_string(), "cancelled");
}

#[test]
fn a_renderer_can_be_cancelled_while_it_is_made() {
    for device in devices() {
        let options = DeviceOptions { device, ..DeviceOptions::default() };
        let make = |monitor: &Monitor| renderer_of(&builtin::to_scene("rods").unwrap(), &options, monitor).map(|_| ());
        assert!(cancel_at_every_report(make, 1) >= 2, "{device:?}");
    }
}

/// Draws `options`, cancelled at every report in turn; each time the renderer must then show the planes of the frame
/// before, and draw the right picture.
fn cancel_frames(renderer: &mut Renderer, options: &RenderOptions, step: usize) -> usize {
    let keep = Keep::planes(&[PLANE_CLASS]);
    let other = small(40, 31);
    renderer.set_monitor(&Monitor::default());
    let right = renderer.render_exactly(options, Keep::default()).unwrap().pixels;
    cancel_at_every_report(
        |monitor| {
            renderer.set_monitor(&Monitor::default());
            let before = renderer.render_exactly(&other, keep).unwrap();
            let classes = renderer.plane(PLANE_CLASS).unwrap();
            renderer.set_monitor(monitor);
            let done = renderer.render_exactly(options, keep);
            if done.is_err() {
                assert_eq!(renderer.plane(PLANE_CLASS).unwrap(), classes, "the planes of the frame before");
                let again = renderer.render_exactly(&other, keep).unwrap_err();
                assert!(matches!(again, Error::Cancelled), "a token stays cancelled: {again}");
            }
            renderer.set_monitor(&Monitor::default());
            assert!(renderer.render_exactly(options, Keep::default()).unwrap().pixels == right);
            assert!(renderer.render_exactly(&other, keep).unwrap().pixels == before.pixels);
            done.map(|_| ())
        },
        step,
    )
}

#[test]
fn a_frame_can_be_cancelled_at_any_report_and_leaves_the_one_before() {
    for device in devices() {
        let mut renderer = renderer(builtin::to_scene("rods").unwrap(), device);
        let options = small(120, 90);
        assert!(cancel_frames(&mut renderer, &options, 1) >= 5, "{device:?}");
        let bands = RenderOptions { band_rows: Some(16), ..options.clone() };
        assert!(cancel_frames(&mut renderer, &bands, 7) >= 5, "{device:?}, in bands");
        let full = RenderOptions { mode: Mode::Full, samples: 2, ..small(60, 45) };
        assert!(cancel_frames(&mut renderer, &full, 1) >= 1, "{device:?}, full");
    }
}

#[test]
fn other_errors_leave_the_frame_before_as_well() {
    let mut renderer = renderer(builtin::to_scene("spheres").unwrap(), DeviceChoice::Cpu);
    renderer.render_exactly(&small(30, 20), Keep::planes(&[PLANE_OBJECT])).unwrap();
    let objects = renderer.plane(PLANE_OBJECT).unwrap();
    let wrong = RenderOptions { band_rows: Some(2), ..small(30, 20) };
    let sweeps = RenderOptions { method: sweeps(), ..wrong };
    assert!(renderer.render_exactly(&sweeps, Keep::default()).is_err());
    assert_eq!(renderer.plane(PLANE_OBJECT).unwrap(), objects);
    // A finished frame replaces it.
    renderer.render_exactly(&small(30, 20), Keep::default()).unwrap();
    assert!(renderer.plane(PLANE_OBJECT).is_err());
}

#[test]
fn progress_runs_from_zero_to_one_and_never_back() {
    for device in devices() {
        let mut renderer = renderer(builtin::to_scene("spheres").unwrap(), device);
        for (band_rows, block, mode) in
            [(None, 2, Mode::Adaptive), (Some(12), 4, Mode::Adaptive), (None, 2, Mode::Full), (Some(9), 2, Mode::Full)]
        {
            let heard = Arc::new(Mutex::new(Vec::new()));
            let log = Arc::clone(&heard);
            renderer.set_monitor(&Monitor::new(move |event| {
                if let Event::Progress { phase, share } = event {
                    log.lock().unwrap().push((phase.to_owned(), share));
                }
            }));
            let options = RenderOptions { band_rows, method: blocks(block), mode, ..small(97, 61) };
            for _ in 0..2 {
                heard.lock().unwrap().clear();
                renderer.render_exactly(&options, Keep::COUNTERS).unwrap();
                let heard = heard.lock().unwrap();
                let shares: Vec<f32> = heard.iter().map(|(_, share)| *share).collect();
                assert!(heard.iter().all(|(phase, _)| phase == "frame"), "{heard:?}");
                assert!(shares.is_sorted() && shares[0] == 0.0 && *shares.last().unwrap() == 1.0, "{shares:?}");
                assert!(shares.len() >= if mode == Mode::Full { 2 } else { 5 }, "{shares:?}");
            }
        }
    }
}

/// A frame with the preview that came with it, put together.
fn with_preview(renderer: &mut Renderer, options: &RenderOptions) -> (Frame, u32, u32, Vec<Option<u32>>, u32) {
    type Shown = (u32, u32, Vec<Option<u32>>, u32);
    let shown: Arc<Mutex<Shown>> = Arc::default();
    let slot = Arc::clone(&shown);
    renderer.set_monitor(&Monitor::with_previews(move |event| {
        if let Event::Preview(preview) = event {
            let (width, height, pixels, count) = &mut *slot.lock().unwrap();
            (*width, *height) = (preview.width, preview.height);
            pixels.resize((preview.width * preview.height) as usize, None);
            assert_eq!(preview.pixels.len() % preview.width as usize, 0, "whole rows");
            let first = (preview.first_row * preview.width) as usize;
            for (slot, &pixel) in pixels[first..].iter_mut().zip(preview.pixels) {
                assert_eq!(slot.replace(pixel), None, "shown once");
            }
            *count += 1;
        }
    }));
    let frame = renderer.render_exactly(options, Keep::default()).unwrap();
    let (width, height, pixels, count) = std::mem::take(&mut *shown.lock().unwrap());
    (frame, width, height, pixels, count)
}

#[test]
fn a_preview_is_the_base_pixels_of_the_picture() {
    for device in devices() {
        let mut renderer = renderer(builtin::to_scene("rods").unwrap(), device);
        for (width, height) in [(97u32, 61u32), (1, 1), (5, 3), (64, 1)] {
            for (block, band_rows, least) in [(2, None, 1), (4, None, 1), (2, Some(10), height.div_ceil(16))] {
                let options = RenderOptions { method: blocks(block), band_rows, ..small(width, height) };
                let (frame, preview_width, preview_height, pixels, count) = with_preview(&mut renderer, &options);
                assert_eq!((preview_width, preview_height), (width.div_ceil(block), height.div_ceil(block)));
                for (at, &pixel) in pixels.iter().enumerate() {
                    // Rows of blocks are shifted against each other; one that ends a base pixel early repeats its last.
                    let y = at as u32 / preview_width * block;
                    let shift = base_shift(block, y);
                    let most = (width.max(shift + 1) - 1 - shift) / block;
                    let x = (at as u32 % preview_width).min(most) * block + shift;
                    assert_eq!(pixel, Some(frame.pixels[(y * width + x) as usize]), "{width}x{height} at {x},{y}");
                }
                assert!(count >= least, "{count} previews of {width}x{height}");
            }
        }
        // Every pixel of a full frame is a base pixel: the picture itself is as soon there.
        let full = RenderOptions { mode: Mode::Full, ..small(20, 10) };
        assert_eq!(with_preview(&mut renderer, &full).4, 0);
    }
}

/// Two hundred moments all over loading, building and drawing, on the twin and on OpenCL. How long each takes is measured by
/// `cargo bench -p rarefy-host-tests --bench cancel`.
#[test]
#[ignore = "long: cancels 200 times at random moments"]
fn two_hundred_random_moments() {
    let real = root().join("../shared/scenes/living-room");
    let temporary = tempfile::tempdir().unwrap();
    let folder = if real.is_dir() {
        real
    } else {
        let folder = temporary.path().join("cafe");
        builtin::write("cafe", &folder).unwrap();
        folder
    };
    let mut random = 12345u32;
    let mut moment = |most_ms: u32| {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        Duration::from_micros(u64::from((random >> 8) % (1000 * most_ms)))
    };
    let mut cancelled = 0;
    for device in devices() {
        let mut renderer = renderer(scene::load(&folder, &Monitor::default()).unwrap(), device);
        let frames = [
            small(320, 240),
            RenderOptions { band_rows: Some(50), ..small(320, 240) },
            RenderOptions { mode: Mode::Full, samples: 2, ..small(160, 120) },
        ];
        let mut right = Vec::new();
        for options in &frames {
            right.push(renderer.render_exactly(options, Keep::default()).unwrap().pixels);
        }
        for round in 0..100 {
            let cancel = Cancel::default();
            let monitor = Monitor::default().with_cancel(&cancel);
            let (options, right) = (&frames[round % 3], &right[round % 3]);
            let done = std::thread::scope(|threads| {
                let pause = moment(if round % 4 == 0 { 800 } else { 120 });
                threads.spawn(move || {
                    std::thread::sleep(pause);
                    cancel.cancel();
                });
                if round % 4 == 0 {
                    let options = DeviceOptions { device, ..DeviceOptions::default() };
                    let made = scene::load(Path::new(&folder), &monitor)
                        .and_then(|scene| renderer_of(&scene, &options, &monitor));
                    made.map(|_| None)
                } else {
                    renderer.set_monitor(&monitor);
                    renderer.render_exactly(options, Keep::default()).map(Some)
                }
            });
            match done {
                Err(Error::Cancelled) => cancelled += 1,
                Err(error) => panic!("{error}"),
                Ok(Some(frame)) => assert!(frame.pixels == *right, "a finished frame is right"),
                Ok(None) => {}
            }
            if round % 10 == 9 {
                renderer.set_monitor(&Monitor::default());
                assert!(renderer.render_exactly(options, Keep::default()).unwrap().pixels == *right);
            }
        }
    }
    println!("cancelled {cancelled} times");
    assert!(cancelled > 60, "only {cancelled} moments met work");
}
