// SPDX-License-Identifier: MIT OR Apache-2.0
//! Each limit at half of what a frame uses today: the frame adapts and is the same picture, or it is refused with the
//! limit's name, both numbers and a remedy. The texts are those of docs/opencl-limits.md.
#![allow(clippy::unwrap_used, missing_docs)]

use rarefy::Error;
use rarefy::internal::device::executor::Executor;
use rarefy::internal::device::open::{DeviceChoice, DeviceOptions};
use rarefy::internal::device::opencl::executor::{scan_group, work_group};
use rarefy::internal::device::opencl::{CacheFolder, OpenOptions, Profile};
use rarefy::internal::device::stage::LAUNCHES;
use rarefy::internal::method::counts::Keep;
use rarefy::internal::method::options::RenderOptions;
use rarefy::internal::scene::builtin;
use rarefy_host_tests::frames::{Prepared, device, no_opencl, renderer_of};

const SCENE: &str = "spheres";

fn frame() -> RenderOptions {
    RenderOptions { width: 205, height: 153, ..RenderOptions::default() }
}

/// A profile of these entries in `limits`, `hardware` or `choices`.
fn profile_of(section: &str, entries: &[(&str, &str)]) -> Profile {
    let entry =
        |(key, value): &(&str, &str)| format!(r#""{key}":{{"value":{value},"certainty":"inferred","source":"test"}}"#);
    let entries = entries.iter().map(entry).collect::<Vec<_>>().join(",");
    let text = match section {
        "limits" => format!(r#"{{"limits":{{{entries}}}}}"#),
        other => format!(r#"{{"limits":{{}},"{other}":{{{entries}}}}}"#),
    };
    Profile::from_json("tight", &text).unwrap()
}

fn profile(section: &str, key: &str, value: &str) -> Profile {
    profile_of(section, &[(key, value)])
}

/// Draws the frame as a user would, and returns its pixels.
fn render(profile: Option<Profile>, memory_budget_bytes: Option<u64>) -> rarefy::Result<Vec<u32>> {
    let device = DeviceChoice::OpenCl(None);
    let cache = CacheFolder::Off;
    let options = DeviceOptions { device, profile, cache, memory_budget_bytes, ..DeviceOptions::default() };
    let mut renderer = renderer_of(&builtin::to_scene(SCENE).unwrap(), &options, &rarefy::Monitor::default())?;
    Ok(renderer.render(&frame(), Keep::default())?.pixels)
}

/// The least value of a limit that refuses nothing: each refusal says how much it wants. For limits that nothing adapts
/// to.
fn used(prepared: &Prepared, key: &str) -> u64 {
    let mut allowed = 1;
    loop {
        let open = OpenOptions {
            profile: Some(profile("limits", key, &allowed.to_string())),
            cache: CacheFolder::Off,
            ..OpenOptions::default()
        };
        match prepared.draw(&mut device(false, &open), &frame(), false) {
            Ok(_) => return allowed,
            Err(Error::LimitExceeded { limit, wanted, .. }) => {
                assert!(limit.starts_with(&key.to_uppercase()), "{key}: {limit}");
                let wanted: u64 = wanted.split(' ').next().unwrap().parse().unwrap();
                assert!(wanted > allowed, "{key}: {wanted} is refused where {allowed} is allowed");
                allowed = wanted;
            }
            Err(error) => panic!("{key} at {allowed}: {error}"),
        }
    }
}

#[derive(Debug, PartialEq, Eq)]
enum Outcome {
    SamePicture,
    Refused(String),
}

/// What a tight frame came to; anything else than the same picture or a full refusal is a panic.
fn outcome(what: &str, drawn: rarefy::Result<Vec<u32>>, expected: &[u32]) -> Outcome {
    match drawn {
        Ok(pixels) => {
            let different = pixels.iter().zip(expected).filter(|(a, b)| a != b).count();
            assert!(pixels.len() == expected.len() && different == 0, "{what}: {different} pixels differ");
            Outcome::SamePicture
        }
        Err(error @ Error::LimitExceeded { .. }) => {
            let text = error.to_string();
            let Error::LimitExceeded { what: who, limit, wanted, allowed, remedies } = error else { unreachable!() };
            assert!([&who, &limit, &wanted, &allowed].iter().all(|part| !part.is_empty()), "{what}: {text}");
            assert!(!remedies.is_empty(), "{what}: {text}");
            assert!(limit.to_lowercase().contains(what), "{what}: {text}");
            Outcome::Refused(text)
        }
        Err(error) => panic!("{what}: {error}"),
    }
}

#[test]
fn half_of_each_limit_adapts_or_refuses() {
    if no_opencl() {
        return;
    }
    let expected = render(None, None).unwrap();
    let prepared = Prepared::named(SCENE);
    let open = OpenOptions { cache: CacheFolder::Off, ..OpenOptions::default() };
    let mut device = device(false, &open);
    prepared.draw(&mut device, &frame(), false).unwrap();
    let (limits, choices) = (device.context().limits().clone(), device.context().choices().clone());
    let scan = u64::from(scan_group(&limits));
    let shapes = LAUNCHES.into_iter().filter_map(|(stage, kernel, _)| work_group(&choices, stage, kernel));
    let widest = shapes.clone().flatten().max().unwrap() as u64;
    let largest = shapes.map(|[width, height]| (width * height) as u64).max().unwrap();
    assert_eq!(used(&prepared, "cl_device_global_mem_size"), device.peak_bytes());
    // What is in use, and half of it. Work-groups and local memory adapt, so their use cannot be asked for by refusals.
    let sides = scan.max(widest) / 2;
    let mut tight = vec![
        ("cl_device_max_work_group_size", scan.max(largest), (scan.max(largest) / 2).to_string()),
        ("cl_kernel_work_group_size", scan, (scan / 2).to_string()),
        ("cl_device_max_work_item_sizes", scan.max(widest), format!("[{sides},{sides},{sides}]")),
        ("cl_device_local_mem_size", scan * 8, (scan * 4).to_string()),
    ];
    for key in [
        "cl_device_global_mem_size",
        "cl_device_max_mem_alloc_size",
        "cl_device_max_parameter_size",
        "cl_device_max_constant_buffer_size",
        "cl_device_max_constant_args",
    ] {
        let used = used(&prepared, key);
        tight.push((key, used, (used / 2).max(1).to_string()));
    }
    let mut refused = Vec::new();
    for (key, used, half) in &tight {
        let outcome = outcome(key, render(Some(profile("limits", key, half)), None), &expected);
        println!("{}: {used} in use, under {half}: {outcome:?}", key.to_uppercase());
        if outcome != Outcome::SamePicture {
            refused.push(*key);
        }
    }
    // What adapts, and what nothing can adapt to.
    for (key, _, _) in &tight[..6] {
        assert!(!refused.contains(key), "{key} no longer adapts");
    }
    for key in ["cl_device_max_parameter_size", "cl_device_max_constant_args", "cl_device_max_constant_buffer_size"] {
        assert!(refused.contains(&key), "{key}: half of what is used is enough, so it was not measured");
    }
    let half = device.peak_bytes() / 2;
    let outcome = outcome("memory_budget", render(None, Some(half)), &expected);
    println!("memory_budget: {} in use, under {half}: {outcome:?}", half * 2);
    assert_eq!(outcome, Outcome::SamePicture, "frames draw in bands");
}

/// What kernels do not use today, or what has no half: nothing of it, or the next lower one.
#[test]
fn what_is_not_used_may_be_missing() {
    if no_opencl() {
        return;
    }
    let expected = render(None, None).unwrap();
    let unused = [
        ("cl_device_extensions", "[]"),
        ("cl_device_address_bits", "32"),
        ("cl_device_image_support", "false"),
        ("cl_device_image2d_max_width", "1"),
        ("cl_device_image2d_max_height", "1"),
        ("cl_device_image_max_array_size", "1"),
        ("cl_device_image_max_buffer_size", "1"),
        ("cl_device_max_read_image_args", "1"),
        ("cl_device_max_write_image_args", "1"),
        ("cl_device_mem_base_addr_align", "1048576"),
        ("cl_device_max_compute_units", "1"),
    ];
    for tight in [profile_of("limits", &unused), profile("choices", "slice_ms", "0.1")] {
        assert_eq!(outcome("nothing", render(Some(tight), None), &expected), Outcome::SamePicture);
    }
    // Whether a slice takes longer than a millisecond depends on the machine; refused or not, it is done cleanly.
    let watchdog = profile("hardware", "gpu_batch_timeout_ms", "1");
    println!("{:?}", outcome("gpu_batch_timeout_ms", render(Some(watchdog), None), &expected));
    let old = profile("limits", "cl_device_version", r#""OpenCL 1.1 old""#);
    let refused = outcome("cl_device_version", render(Some(old), None), &expected);
    println!("{refused:?}");
    assert!(matches!(refused, Outcome::Refused(_)));
}

#[test]
#[should_panic(expected = "1 pixels differ")]
fn a_wrong_picture_is_noticed() {
    outcome("cl_device_version", Ok(vec![1, 2, 3]), &[1, 2, 4]);
}

#[test]
#[should_panic(expected = "needs 2, the limit `X` allows 1")]
fn a_refusal_without_a_remedy_is_noticed() {
    let (what, limit) = ("a launch".into(), "X".into());
    let error = Error::LimitExceeded { what, limit, wanted: "2".into(), allowed: "1".into(), remedies: &[] };
    outcome("x", Err(error), &[]);
}
