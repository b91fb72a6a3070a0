// SPDX-License-Identifier: MIT OR Apache-2.0
//! Every kernel under Oclgrind, an OpenCL device that interprets kernels and watches for data races, accesses beyond
//! buffers and reads of what nobody wrote. `.ci/long-oclgrind.sh` sets the environment and runs these; without it
//! they do nothing.
#![allow(clippy::unwrap_used, missing_docs)]

use std::path::{Path, PathBuf};

use rarefy::internal::device::executor::Executor;
use rarefy::internal::device::hooks::recording::Recording;
use rarefy::internal::device::kernels::Mutation;
use rarefy::internal::device::open::{DeviceChoice, DeviceOptions};
use rarefy::internal::device::opencl::{CacheFolder, OpenOptions};
use rarefy::internal::device::stage::Kernel;
use rarefy::internal::layout::Traversal;
use rarefy::internal::method::counts::Keep;
use rarefy::internal::method::options::{Mode, RenderOptions};
use rarefy::internal::render::renderer::Renderer;
use rarefy::internal::scene::builtin;
use rarefy_host_tests::fixtures::{blocks, sweeps};
use rarefy_host_tests::frames::{Drawn, Prepared, device, mutated_device, renderer_of, twin, walking_by};

/// Where Oclgrind writes what it finds; `None` outside of its script.
fn log() -> Option<PathBuf> {
    let log = std::env::var_os("RAREFY_OCLGRIND_LOG").map(PathBuf::from);
    if log.is_none() {
        println!("skipped: run by .ci/long-oclgrind.sh");
    }
    log
}

fn findings(log: &Path) -> String {
    std::fs::read_to_string(log).unwrap_or_default()
}

fn renderer(device: DeviceChoice, mutation: Option<Mutation>) -> Renderer {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("oclgrind");
    let cache = CacheFolder::At(folder);
    let options = DeviceOptions { device, strict: true, mutation, cache, ..DeviceOptions::default() };
    renderer_of(&builtin::to_scene("rods").unwrap(), &options, &rarefy::Monitor::default()).unwrap()
}

#[test]
#[ignore = "oclgrind: every kernel, interpreted"]
fn no_kernel_races_or_leaves_its_buffers() {
    let Some(log) = log() else { return };
    let (mut device, mut twin) = (renderer(DeviceChoice::OpenCl(None), None), renderer(DeviceChoice::Twin, None));
    assert!(device.info().name.contains("Oclgrind"), "{:?}", device.info());
    let base = RenderOptions { width: 26, height: 19, ..RenderOptions::default() };
    let frames = [
        base.clone(),
        RenderOptions { mode: Mode::Full, ..base.clone() },
        RenderOptions { method: blocks(4), ..base.clone() },
        RenderOptions { method: sweeps(), ..base.clone() },
        RenderOptions { band_rows: Some(6), samples: 2, width: 13, height: 10, ..base },
    ];
    for options in &frames {
        for keep in [Keep::default(), Keep::COUNTERS] {
            let (drawn, expected) = (device.render_exactly(options, keep), twin.render_exactly(options, keep));
            let (drawn, expected) = (drawn.unwrap(), expected.unwrap());
            assert!(drawn.pixels == expected.pixels, "{options:?}: another picture than the twin's");
            assert_eq!(drawn.stats.pixels, expected.stats.pixels);
        }
    }
    draw_with_tail(true);
    // The quick self-test ran too: it launches what these frames do on a larger picture.
    assert_eq!(findings(&log), "", "Oclgrind found something");
    println!("Oclgrind: {} frames, every kernel, no finding", 2 * frames.len() + 1);
}

/// A frame on a device of its own, without a quick self-test before: Oclgrind keeps what it knows of a released buffer and
/// takes it for the next one of that number.
fn draw_afresh(options: &RenderOptions, counters: bool, traversal: Traversal, mutation: Option<Mutation>) -> Drawn {
    let prepared = Prepared::named("rods");
    let mut device = mutated_device(true, &walking_by(traversal), mutation);
    assert!(device.info().name.contains("Oclgrind"), "{:?}", device.info());
    prepared.draw(&mut device, options, counters).unwrap()
}

/// A frame launched as on a GPU, as recorded frames are: Oclgrind is a CPU, whose own frames do without `correct_tail`.
fn draw_with_tail(counters: bool) {
    let prepared = Prepared::named("spheres");
    let options = RenderOptions { width: 26, height: 19, ..RenderOptions::default() };
    let draw = |executor: &mut dyn Executor| {
        let mut recording = Recording::default();
        let (drawn, _) = prepared.draw_observed(executor, &options, counters, &mut [&mut recording]).unwrap();
        assert!(recording.launches.iter().any(|launch| launch.kernel == Kernel::CorrectTail));
        drawn
    };
    assert!(draw(&mut device(true, &OpenOptions::default())) == draw(&mut twin()), "another picture than the twin's");
}

#[test]
#[ignore = "oclgrind: reads of what nobody wrote, every kernel and every walk"]
fn no_kernel_reads_what_nobody_wrote() {
    let Some(log) = log() else { return };
    let base = RenderOptions { width: 26, height: 19, ..RenderOptions::default() };
    let full = RenderOptions { mode: Mode::Full, ..base.clone() };
    let frames = [
        (base.clone(), false, Traversal::PrivateStack),
        (full.clone(), true, Traversal::PrivateStack),
        (RenderOptions { method: blocks(4), ..base.clone() }, true, Traversal::PrivateStack),
        (RenderOptions { method: sweeps(), ..base.clone() }, false, Traversal::PrivateStack),
        (base, true, Traversal::ShortStack),
        (full, true, Traversal::Stackless),
    ];
    for (options, counters, traversal) in &frames {
        let drawn = draw_afresh(options, *counters, *traversal, None);
        let prepared = Prepared::named("rods");
        assert!(drawn == prepared.draw(&mut twin(), options, *counters).unwrap(), "{options:?}");
        assert_eq!(findings(&log), "", "{options:?}, {}", traversal.name());
    }
    draw_with_tail(false);
    assert_eq!(findings(&log), "", "correct_tail");
    println!("Oclgrind: {} frames, nothing read that nobody wrote", frames.len() + 1);
}

#[test]
#[ignore = "oclgrind: a kernel that reads what nobody wrote, which must be found"]
fn a_read_of_what_nobody_wrote_is_found() {
    let Some(log) = log() else { return };
    let mutation = Mutation {
        file: "common/attributes.clh".into(),
        from: "  out_attributes[PLANE_SHADOW * pitch + at] = a->shadow_bits;".into(),
        to: String::new(),
    };
    let options = RenderOptions { width: 26, height: 19, ..RenderOptions::default() };
    draw_afresh(&options, false, Traversal::PrivateStack, Some(mutation));
    let found = findings(&log);
    assert!(found.contains("depends on uninitialized value") && found.contains("check"), "{found}");
}

#[test]
#[ignore = "oclgrind: a racing kernel, which must be found"]
fn a_racing_kernel_is_found() {
    let Some(log) = log() else { return };
    // All chunks write the same sum.
    let mutation = Mutation {
        file: "common/pack.clh".into(),
        from: "out_sums[chunk] = popcount(mask);".into(),
        to: "out_sums[0] = popcount(mask);".into(),
    };
    let folder = CacheFolder::At(Path::new(env!("CARGO_TARGET_TMPDIR")).join("oclgrind"));
    let options = DeviceOptions {
        device: DeviceChoice::OpenCl(None),
        mutation: Some(mutation),
        cache: folder,
        ..DeviceOptions::default()
    };
    let options_frame = RenderOptions { width: 64, height: 48, ..RenderOptions::default() };
    // The quick self-test may refuse the device before; by then the race has happened.
    if let Ok(mut renderer) = renderer_of(&builtin::to_scene("rods").unwrap(), &options, &rarefy::Monitor::default()) {
        let _ = renderer.render_exactly(&options_frame, Keep::default());
    }
    let found = findings(&log);
    assert!(found.contains("race"), "Oclgrind saw no race: {found}");
}
