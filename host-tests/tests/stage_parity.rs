// SPDX-License-Identifier: MIT OR Apache-2.0
//! Kernels against their CPU twins: strict builds launch by launch and bit for bit, fast builds within bounds.
#![allow(clippy::unwrap_used, missing_docs)]

use std::collections::BTreeSet;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use rarefy::Monitor;
use rarefy::Scene;
use rarefy::internal::device::executor::{Executor, ExecutorInfo, MemoryLimits};
use rarefy::internal::device::frame_memory::{FrameBuffer, FrameHandle, FrameInputs, FrameSizes};
use rarefy::internal::device::kernels::Mutation;
use rarefy::internal::device::launch::{Launch, SceneHandle};
use rarefy::internal::device::opencl::{OpenOptions, Profile};
use rarefy::internal::device::stage::{Kernel, LAUNCHES, Stage};
use rarefy::internal::device::twin::executor::TwinExecutor;
use rarefy::internal::layout::struct_layout;
use rarefy::internal::method::options::{GcolSpace, Interpolation, Method, RenderOptions, TestSet};
use rarefy::internal::prepare::{PreparedScene, Shading};
use rarefy::internal::scene::builtin;
use rarefy_host_tests::fixtures::{blocks, combinations, full, sized, sweeps, with};
use rarefy_host_tests::frames::{Prepared, compare, device, differing, mutated_device, no_opencl, twin, zoo};

#[test]
fn every_launch_of_every_kind_of_frame_equals_the_twin() {
    if no_opencl() {
        return;
    }
    let prepared = Prepared::named("zoo");
    let mut device = device(true, &OpenOptions::default());
    // Counting or not in turn: the flavours are two programs, and the options do not care.
    let frames = combinations(50, 38).into_iter().enumerate().map(|(i, options)| (options, i % 2 == 0));
    let results = compare(&prepared, &mut device, frames);
    let launched: BTreeSet<&str> = results.iter().map(|r| r.kernel.label(r.stage)).collect();
    assert_eq!(launched, LAUNCHES.iter().map(|(.., label)| *label).collect(), "not every launch was compared");
    assert!(results.iter().all(|r| r.words > 0));
}

#[test]
fn frames_of_every_size_and_scene_equal_the_twin() {
    if no_opencl() {
        return;
    }
    for name in rarefy_host_tests::fixtures::quick_scenes() {
        let prepared = Prepared::named(name);
        let mut device = device(true, &OpenOptions::default());
        let sizes = [(1, 1), (1, 7), (7, 1), (2, 2), (3, 5), (33, 17)];
        let mut frames = Vec::new();
        for (i, (width, height)) in sizes.into_iter().enumerate() {
            for block in [2, 4] {
                frames.push((RenderOptions { method: blocks(block), ..sized(width, height) }, i % 2 == 0));
                frames.push((RenderOptions { method: Method { block, ..sweeps() }, ..sized(width, height) }, false));
            }
            frames.push((full(&sized(width, height)), i % 2 == 1));
        }
        compare(&prepared, &mut device, frames);
    }
}

#[test]
fn large_frames_with_scans_of_several_levels_equal_the_twin() {
    if no_opencl() {
        return;
    }
    // 210x150 has 260 chunks of A1 items, more than a scan's work-group of 256.
    let prepared = Prepared::named("cafe");
    let mut device = device(true, &OpenOptions::default());
    let four = RenderOptions { method: blocks(4), ..sized(210, 150) };
    let linear = with(&sized(210, 150), |method| {
        method.checks.gcol_space = GcolSpace::Linear;
        method.interpolation = Interpolation::Plain;
    });
    compare(&prepared, &mut device, [(sized(210, 150), false), (four, true), (linear, true)]);
}

#[test]
fn scans_in_small_groups_equal_the_twin() {
    if no_opencl() {
        return;
    }
    let prepared = Prepared::named("rods");
    let under = |group: u32| {
        let limits = format!(
            r#"{{"limits":{{"cl_kernel_work_group_size":{{"value":{group},"certainty":"inferred","source":"test"}}}}}}"#
        );
        let profile = Some(Profile::from_json("tight", &limits).unwrap());
        device(true, &OpenOptions { profile, ..OpenOptions::default() })
    };
    for group in [2, 8] {
        let mut device = under(group);
        assert_eq!(device.scan_group(), group);
        compare(&prepared, &mut device, [(sized(33, 17), false)]);
    }
    // A device whose kernels with barriers run in groups of one cannot pack: an error, not an endless scan.
    let refused = prepared.draw(&mut under(1), &sized(33, 17), false).unwrap_err();
    assert!(matches!(refused, rarefy::Error::LimitExceeded { .. }), "{refused}");
}

#[test]
fn anchor_shading_equals_the_twin() {
    if no_opencl() {
        return;
    }
    for name in ["spheres", "mirror-room"] {
        let prepared = Prepared::new(builtin::to_scene(name).unwrap(), Shading::Anchor);
        let mut device = device(true, &OpenOptions::default());
        let frames = [(full(&sized(50, 38)), true), (full(&sized(33, 17)), false), (sized(50, 38), false)];
        compare(&prepared, &mut device, frames);
    }
}

#[test]
fn strictest_and_laxest_tolerances_equal_the_twin() {
    if no_opencl() {
        return;
    }
    let prepared = Prepared::named("zoo");
    let mut device = device(true, &OpenOptions::default());
    let frame = |t_pos: f32, tests: TestSet| {
        let checked = with(&sized(50, 38), |method| {
            method.checks.fine.t_pos = t_pos;
            method.checks.coarse.t_pos = t_pos;
            method.checks.tests = tests;
        });
        (checked, false)
    };
    compare(&prepared, &mut device, [frame(0.0, TestSet::ALL), frame(1.0e9, TestSet::NONE)]);
    // With no test at all nothing but the border is traced, with the strictest one everything is.
    let strict = prepared.draw(&mut device, &frame(0.0, TestSet::ALL).0, false).unwrap();
    assert_eq!(strict.counts.interpolated, 0);
    assert_eq!(strict.pixels, prepared.draw(&mut twin(), &full(&sized(50, 38)), false).unwrap().pixels);
}

#[test]
fn whole_strict_frames_equal_those_of_the_twin() {
    if no_opencl() {
        return;
    }
    for name in ["zoo", "mirror-room", "rods", "cafe"] {
        let prepared = Prepared::named(name);
        let mut device = device(true, &OpenOptions::default());
        let sweeps = RenderOptions { method: sweeps(), ..sized(96, 64) };
        let four = RenderOptions { method: blocks(4), ..sized(96, 64) };
        for options in [sized(96, 64), four, sweeps, full(&sized(96, 64))] {
            let drawn = prepared.draw(&mut device, &options, false).unwrap();
            assert!(drawn == prepared.draw(&mut twin(), &options, false).unwrap(), "{name}: {options:?}");
        }
    }
}

#[test]
fn forced_slices_and_two_runs_give_the_same_picture() {
    if no_opencl() {
        return;
    }
    let prepared = Prepared::named("zoo");
    for options in [sized(50, 38), full(&sized(50, 38)), RenderOptions { method: blocks(4), ..sized(33, 17) }] {
        let first = prepared.draw(&mut device(false, &OpenOptions::default()), &options, false).unwrap();
        let mut again = device(false, &OpenOptions::default());
        assert!(prepared.draw(&mut again, &options, false).unwrap() == first, "another device object: {options:?}");
        assert!(prepared.draw(&mut again, &options, false).unwrap() == first, "a second frame: {options:?}");
        for items in [1, 100] {
            let open = OpenOptions { slice_items: Some(items), ..OpenOptions::default() };
            let mut sliced = device(false, &open);
            assert!(prepared.draw(&mut sliced, &options, false).unwrap() == first, "slices of {items}: {options:?}");
            assert!(2 * sliced.context().enqueues() > again.context().enqueues(), "nothing was cut");
        }
        let on_twin = prepared.draw(&mut twin(), &options, false).unwrap();
        assert!(prepared.draw(&mut twin(), &options, false).unwrap() == on_twin, "twin: {options:?}");
    }
}

/// Full and adaptive frames of a fast build against the twin.
fn fast_build_is_close(scene: Scene, side: u32) {
    let prepared = Prepared::new(scene, Shading::Full);
    let mut device = device(false, &OpenOptions::default());
    let pixels = f64::from(side) * f64::from(side);
    let options = full(&sized(side, side));
    let ours = prepared.draw(&mut device, &options, false).unwrap();
    let on_twin = prepared.draw(&mut twin(), &options, false).unwrap();
    let apart = ours.pixels_apart(&on_twin, 1);
    let options = sized(side, side);
    let adaptive = prepared.draw(&mut device, &options, false).unwrap();
    let adaptive_twin = prepared.draw(&mut twin(), &options, false).unwrap();
    let classes = adaptive.classes_apart(&adaptive_twin);
    let adaptive_apart = adaptive.pixels_apart(&adaptive_twin, 1);
    println!(
        "{} {side}x{side}: beyond 1/255: full {apart}, adaptive {adaptive_apart}; other classes {classes}",
        prepared.scene.name()
    );
    assert!(apart as f64 <= 1.0e-4 * pixels, "{apart} pixels beyond 1/255");
    assert!(classes as f64 <= 1.0e-3 * pixels, "{classes} pixels in another class");
    assert!(adaptive_apart as f64 <= 1.0e-3 * pixels, "{adaptive_apart} pixels of the adaptive frame beyond 1/255");
}

#[test]
fn fast_builds_draw_the_built_in_scenes_within_one_step() {
    if no_opencl() {
        return;
    }
    for name in rarefy_host_tests::fixtures::quick_scenes() {
        fast_build_is_close(builtin::to_scene(name).unwrap(), 256);
    }
    fast_build_is_close(zoo(), 256);
}

#[test]
#[ignore = "long: six real scenes, on the device and on the twin"]
fn real_scenes_are_drawn_alike() {
    if no_opencl() {
        return;
    }
    let folder = rarefy_host_tests::command::root().join("../shared/scenes");
    if !folder.is_dir() {
        println!("skipped: ../shared/scenes is not here");
        return;
    }
    let mut scenes: Vec<_> = folder.read_dir().unwrap().map(|e| e.unwrap().path()).filter(|p| p.is_dir()).collect();
    scenes.sort();
    for path in scenes {
        let load = |path: &Path| rarefy::internal::scene::load(path, &Monitor::default()).unwrap();
        let prepared = Prepared::new(load(&path), Shading::Full);
        let mut device = device(true, &OpenOptions::default());
        for options in [full(&sized(512, 512)), sized(512, 512), RenderOptions { method: blocks(4), ..sized(512, 512) }]
        {
            let drawn = prepared.draw(&mut device, &options, false).unwrap();
            let on_twin = prepared.draw(&mut twin(), &options, false).unwrap();
            assert!(drawn == on_twin, "{}: strict builds differ: {options:?}", path.display());
        }
        drop((prepared, device));
        fast_build_is_close(load(&path), 512);
    }
}

#[test]
fn the_device_lays_structs_out_as_the_host_does() {
    if no_opencl() {
        return;
    }
    let expected: Vec<u32> = struct_layout().iter().map(|entry| entry.bytes).collect();
    assert_eq!(device(true, &OpenOptions::default()).probe().unwrap(), expected);
    // The comparison can fail: by a member too many, and by any two that swapped places.
    for (from, to) in [
        ("  uint depth_limit;", "  uint inserted; uint depth_limit;"),
        ("  float t_pos;          // G2, scene units\n  float t_norm;", "  float t_norm;\n  float t_pos;"),
        ("  float s1;\n  float t1;", "  float t1;\n  float s1;"),
        (
            "  uint width;\n  uint height;\n  uint pad0;\n} Texture",
            "  uint height;\n  uint width;\n  uint pad0;\n} Texture",
        ),
    ] {
        let mutation = Mutation { file: "types.h".into(), from: from.into(), to: to.into() };
        let mut other = mutated_device(true, &OpenOptions::default(), Some(mutation));
        assert_ne!(other.probe().unwrap(), expected, "{from}");
    }
}

/// A twin that changes the first word of `buffer` after each launch of a kernel by a stage.
struct Tampered {
    inner: TwinExecutor,
    launch: (Stage, Kernel),
    buffer: FrameBuffer,
}

impl Executor for Tampered {
    fn info(&self) -> ExecutorInfo {
        self.inner.info()
    }
    fn scan_group(&self) -> u32 {
        self.inner.scan_group()
    }
    fn memory_limits(&self) -> MemoryLimits {
        self.inner.memory_limits()
    }
    fn prefers_few_launches(&self) -> bool {
        self.inner.prefers_few_launches()
    }

    fn traversal(&self) -> rarefy::internal::layout::Traversal {
        self.inner.traversal()
    }
    fn upload(&mut self, scene: &Arc<PreparedScene>) -> rarefy::Result<SceneHandle> {
        self.inner.upload(scene)
    }
    fn allocate(&mut self, inputs: &FrameInputs, sizes: &FrameSizes) -> rarefy::Result<FrameHandle> {
        self.inner.allocate(inputs, sizes)
    }
    fn begin(&mut self, frame: &mut FrameHandle, inputs: &FrameInputs) -> rarefy::Result<()> {
        self.inner.begin(frame, inputs)
    }
    fn run(&mut self, launch: &Launch) -> rarefy::Result<()> {
        self.inner.run(launch)?;
        if (launch.stage, launch.kernel) == self.launch {
            let first = self.inner.read(launch.frame, self.buffer, 0..1)?[0];
            self.inner.write(launch.frame, self.buffer, &[first ^ 1])?;
        }
        Ok(())
    }
    fn read(&mut self, frame: &FrameHandle, buffer: FrameBuffer, range: Range<usize>) -> rarefy::Result<Vec<u32>> {
        self.inner.read(frame, buffer, range)
    }
    fn write(&mut self, frame: &FrameHandle, buffer: FrameBuffer, words: &[u32]) -> rarefy::Result<()> {
        self.inner.write(frame, buffer, words)
    }
    fn take_timings(&mut self) -> rarefy::Result<Vec<(Stage, f64)>> {
        self.inner.take_timings()
    }
    fn watch(&mut self, monitor: &Monitor) {
        self.inner.watch(monitor);
    }
    fn monitor(&self) -> &Monitor {
        self.inner.monitor()
    }
    fn peak_bytes(&self) -> u64 {
        self.inner.peak_bytes()
    }
}

#[test]
fn the_comparison_sees_one_changed_word_of_any_buffer() {
    use FrameBuffer::*;
    let prepared = Prepared::named("spheres");
    let options = sized(33, 17);
    compare(&prepared, &mut twin(), [(options.clone(), true)]);
    for (stage, kernel, buffer) in [
        (Stage::Step1, Kernel::Trace, Attributes),
        (Stage::Step2a, Kernel::Check, Color),
        (Stage::Step2b, Kernel::PackCount, Masks),
        (Stage::Step2b, Kernel::PackScan, Sums),
        (Stage::Step3b, Kernel::PackScatter, List),
        (Stage::Step3c, Kernel::Trace, Counters),
    ] {
        let mut device = Tampered { inner: twin(), launch: (stage, kernel), buffer };
        let results = prepared.parity(&mut device, &options, true, None).unwrap();
        let caught = differing(&results);
        assert_eq!(caught.len(), 1, "{}", kernel.label(stage));
        // Step III runs once for the even columns and once for the odd ones.
        let launches = if stage >= Stage::Step3a { 2 } else { 1 };
        assert_eq!((caught[0].stage, caught[0].kernel, caught[0].different), (stage, kernel, launches));
        assert_eq!(caught[0].first.map(|f| (f.0, f.1)), Some((buffer, 0)));
    }
    // Pictures and classes of whole frames, too.
    let drawn = prepared.draw(&mut twin(), &options, false).unwrap();
    let mut other = prepared.draw(&mut twin(), &options, false).unwrap();
    other.pixels[5] ^= 0x0200;
    other.classes[7] ^= 1;
    assert!(drawn != other);
    assert_eq!((drawn.pixels_apart(&other, 1), drawn.classes_apart(&other)), (1, 1));
}
