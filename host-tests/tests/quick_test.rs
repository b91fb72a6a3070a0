// SPDX-License-Identifier: MIT OR Apache-2.0
//! The quick self-test at a driver's first use: who fails is refused, and nobody is tested twice.
#![allow(clippy::unwrap_used, missing_docs)]

use std::path::{Path, PathBuf};

use rarefy::Error;
use rarefy::internal::device::kernels::Mutation;
use rarefy::internal::device::open::{DeviceChoice, DeviceOptions};
use rarefy::internal::device::opencl::{CacheFolder, OpenOptions, Profile};
use rarefy::internal::device::stage::Stage;
use rarefy::internal::method::counts::Keep;
use rarefy::internal::method::options::RenderOptions;
use rarefy::internal::prepare::Shading;
use rarefy::internal::render::renderer::Renderer;
use rarefy::internal::scene::builtin;
use rarefy::internal::selftest::quick::Known;
use rarefy::internal::selftest::{full, quick};
use rarefy_host_tests::frames::{device, no_opencl, renderer_of};

const OPENCL: DeviceChoice = DeviceChoice::OpenCl(None);

fn options(device: DeviceChoice, cache: &Path, mutation: Option<Mutation>) -> DeviceOptions {
    DeviceOptions { device, cache: CacheFolder::At(cache.into()), mutation, ..DeviceOptions::default() }
}

fn renderer(options: &DeviceOptions) -> rarefy::Result<Renderer> {
    renderer_of(&builtin::to_scene("spheres").unwrap(), options, &rarefy::Monitor::default())
}

fn verdicts(cache: &Path) -> Vec<PathBuf> {
    let files = std::fs::read_dir(cache).unwrap().map(|file| file.unwrap().path());
    files.filter(|path| path.extension().is_some_and(|suffix| suffix == "verdict")).collect()
}

/// Tests a device opened with a cache in `cache`.
fn check(cache: &Path, profile: Option<&Profile>) -> rarefy::Result<Known> {
    let open =
        OpenOptions { cache: CacheFolder::At(cache.into()), profile: profile.cloned(), ..OpenOptions::default() };
    quick::check(&mut device(false, &open), Shading::Full, profile)
}

#[test]
fn a_device_is_tested_once() {
    if no_opencl() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    assert_eq!(check(folder.path(), None).unwrap(), Known::Tested);
    assert_eq!(check(folder.path(), None).unwrap(), Known::FromCache);
    let entry = verdicts(folder.path()).remove(0);
    let sound = std::fs::read(&entry).unwrap();
    // A damaged entry only causes a new run, which mends it.
    for damaged in [sound[..sound.len() - 1].to_vec(), Vec::new(), [&sound[..], b"!"].concat()] {
        std::fs::write(&entry, damaged).unwrap();
        assert_eq!(check(folder.path(), None).unwrap(), Known::Tested);
        assert_eq!(check(folder.path(), None).unwrap(), Known::FromCache);
        assert_eq!(std::fs::read(&entry).unwrap(), sound);
    }
    // Another profile is another device.
    let phone = Profile::named("adreno-420").unwrap();
    assert_eq!(check(folder.path(), Some(&phone)).unwrap(), Known::Tested);
    assert_eq!(check(folder.path(), Some(&phone)).unwrap(), Known::FromCache);
    assert_eq!(verdicts(folder.path()).len(), 2);
    // So is another build of the kernels.
    let open = OpenOptions { cache: CacheFolder::At(folder.path().into()), ..OpenOptions::default() };
    assert_eq!(quick::check(&mut device(true, &open), Shading::Full, None).unwrap(), Known::Tested);
}

#[test]
fn a_renderer_leaves_a_verdict_and_draws_its_own_scene() {
    if no_opencl() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let frame = RenderOptions { width: 64, height: 48, ..RenderOptions::default() };
    let scene = || builtin::to_scene("cafe").unwrap();
    let mut pictures = Vec::new();
    for _ in 0..2 {
        let mut renderer =
            renderer_of(&scene(), &options(OPENCL, folder.path(), None), &rarefy::Monitor::default()).unwrap();
        assert!(renderer.notices().is_empty());
        pictures.push((renderer.render(&frame, Keep::default()).unwrap().pixels, renderer.peak_device_bytes()));
    }
    assert_eq!(verdicts(folder.path()).len(), 1);
    // The test leaves no traces: not in the picture, not in the account of memory.
    assert_eq!(pictures[0], pictures[1]);
}

#[test]
fn a_broken_kernel_is_refused_by_name() {
    refused_by_name(&[Stage::Step1, Stage::Step4]);
}

#[test]
#[ignore = "long: a program per stage"]
fn any_broken_kernel_is_refused_by_name() {
    refused_by_name(&Stage::ALL);
}

fn refused_by_name(stages: &[Stage]) {
    if no_opencl() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    for &stage in stages {
        let broken = options(OPENCL, folder.path(), Some(full::breaking_mutation(stage)));
        let refusal = |start: &str| match renderer(&broken).err() {
            Some(error @ Error::SelfTest { .. }) => error.to_string(),
            Some(error) => panic!("{start} of {}: {error}", stage.name()),
            None => panic!("{start} of {}: not refused", stage.name()),
        };
        let first = refusal("first start");
        assert!(first.contains(&format!(": {}", stage.name())), "{first}");
        assert!(first.contains("driver "), "{first}");
        println!("{first}");
        assert_eq!(refusal("second start"), first, "the verdict is kept");
    }
    // Of the usual build, and of the careful one.
    assert_eq!(verdicts(folder.path()).len(), 2 * stages.len());
}

#[test]
fn auto_falls_back_with_a_notice() {
    if no_opencl() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let broken = options(DeviceChoice::Auto, folder.path(), Some(full::breaking_mutation(Stage::Step2b)));
    for _ in 0..2 {
        let fallen = renderer(&broken).unwrap();
        assert_eq!(fallen.info().backend, "cpu");
        let notices = fallen.notices().to_vec();
        assert_eq!(notices.len(), 1, "{notices:?}");
        assert!(notices[0].starts_with("drawing on the CPU: self-test failed on "), "{notices:?}");
        assert!(notices[0].contains("step2b"), "{notices:?}");
        assert_eq!(fallen.passed_over().len(), 2);
        // Of the usual build, and of the careful one.
        assert_eq!(verdicts(folder.path()).len(), 2);
    }
    // A program that does not even build.
    let mutation = Mutation { file: "pack.cl".into(), from: "__kernel".into(), to: "__colonel".into() };
    let fallen = renderer(&options(DeviceChoice::Auto, folder.path(), Some(mutation.clone()))).unwrap();
    assert_eq!(fallen.info().backend, "cpu");
    assert!(fallen.notices()[0].contains("`pack` does not build"), "{:?}", fallen.notices());
    let refused = renderer(&options(OPENCL, folder.path(), Some(mutation))).err();
    assert!(matches!(refused, Some(Error::KernelBuild { .. })), "{refused:?}");
    // A build that fails is no verdict, and an intact device is none the worse.
    assert_eq!(verdicts(folder.path()).len(), 2);
    let sound = renderer(&options(OPENCL, folder.path(), None)).unwrap();
    assert_eq!((sound.info().backend, sound.notices().len()), ("opencl", 0));
}

/// PoCL is a CPU, where packets of rays are faster than kernels with one ray to a work-item. What the engine cannot do is asked
/// of OpenCL all the same.
#[test]
fn auto_prefers_the_engine_to_opencl_on_a_cpu() {
    if no_opencl() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let auto = options(DeviceChoice::Auto, folder.path(), None);
    let drawn_by = |options: &DeviceOptions| {
        let renderer = renderer(options).unwrap();
        assert!(renderer.notices().is_empty(), "{:?}", renderer.notices());
        renderer.info().backend
    };
    assert_eq!(drawn_by(&auto), "cpu");
    // Nothing was built for a device that does not draw.
    assert!(std::fs::read_dir(folder.path()).unwrap().next().is_none());
    assert_eq!(drawn_by(&DeviceOptions { bounds_checks: true, ..auto.clone() }), "opencl");
    let phone = Some(Profile::named("adreno-420").unwrap());
    assert_eq!(drawn_by(&DeviceOptions { profile: phone, ..auto }), "opencl");
}
