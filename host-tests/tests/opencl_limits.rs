// SPDX-License-Identifier: MIT OR Apache-2.0
//! The limits that the context enforces, on a real implementation.
//!
//! Oclgrind runs these with `--test-threads 1` only: it mixes up contexts of several threads.
#![allow(clippy::unwrap_used, missing_docs)]

use rarefy::internal::device::open::{DeviceChoice, DeviceOptions};
use rarefy::internal::device::opencl::{Arg, CacheFolder, DeviceLaunch, OpenOptions, Profile, ProgramSource, discover};
use rarefy::internal::scene::builtin;
use rarefy::{Error, Monitor};
use rarefy_host_tests::contexts::{
    SOURCE, context, context_under, context_with, count, counted, kernel, launch_sum, options, profile,
};
use rarefy_host_tests::frames::{no_opencl, renderer_of};

/// Each limit of a launch or an object, tripped by a profile that has only this one.
#[test]
fn every_limit_refuses_with_its_numbers() {
    if no_opencl() {
        return;
    }
    let says = |result: rarefy::Result<()>, limit: &str, wanted: &str, allowed: &str| match result {
        Err(error @ Error::LimitExceeded { .. }) => {
            let message = error.to_string();
            println!("{message}");
            for part in [format!("`{limit}"), format!("needs {wanted}"), format!("allows {allowed}")] {
                assert!(message.contains(&part), "{message}: {part}");
            }
        }
        other => panic!("{limit}: {other:?}"),
    };
    let of = " of profile tight";

    let context = context_under(&[("cl_device_max_mem_alloc_size", "1000")]);
    says(
        context.buffer::<u32>("b", 251).map(|_| ()),
        &format!("CL_DEVICE_MAX_MEM_ALLOC_SIZE{of}"),
        "1004 bytes",
        "1000 bytes",
    );
    assert!(context.buffer::<u32>("b", 250).is_ok());

    let context = context_under(&[("cl_device_global_mem_size", "1000")]);
    let first = context.buffer::<u8>("a", 600).unwrap();
    let limit = format!("CL_DEVICE_GLOBAL_MEM_SIZE{of}");
    says(context.buffer::<u8>("b", 401).map(|_| ()), &limit, "1001 bytes", "1000 bytes");
    assert!(context.buffer::<u8>("b", 400).is_ok());
    drop(first);
    assert!(context.buffer::<u8>("b", 1000).is_ok());

    let context = context_with(&OpenOptions { memory_budget_bytes: Some(500), ..options() });
    says(context.buffer::<u8>("b", 501).map(|_| ()), "memory_budget", "501 bytes", "500 bytes");
    let context = context_with(&options());
    assert!(matches!(context.buffer::<u64>("b", usize::MAX), Err(Error::LimitExceeded { .. })));
    assert_eq!(context.memory().current_bytes, 0);

    let launch = |limits: &[(&str, &str)], local: usize| launch_sum(&context_under(limits), local).map(|_| ());
    let tight = [("cl_device_max_work_group_size", "32")];
    says(launch(&tight, 64), &format!("CL_DEVICE_MAX_WORK_GROUP_SIZE{of}"), "64 work-items", "32 work-items");
    launch(&tight, 32).unwrap();
    let tight = [("cl_kernel_work_group_size", "32")];
    says(launch(&tight, 64), &format!("CL_KERNEL_WORK_GROUP_SIZE{of}"), "64 work-items", "32 work-items");
    launch(&tight, 32).unwrap();
    // Only kernels with barriers get the lower one.
    assert!(counted(&count(&context_under(&tight), 64, 1, Some([64, 1]))));
    let tight = [("cl_device_max_work_item_sizes", "[16,64,64]")];
    says(launch(&tight, 32), &format!("CL_DEVICE_MAX_WORK_ITEM_SIZES{of}"), "32 work-items", "16 work-items");
    launch(&tight, 16).unwrap();
    let tight = [("cl_device_local_mem_size", "128")];
    says(launch(&tight, 64), &format!("CL_DEVICE_LOCAL_MEM_SIZE{of}"), "256 bytes", "128 bytes");
    launch(&tight, 32).unwrap();
    // Three pointers of four bytes and one word.
    let tight = |bytes| [("cl_device_address_bits", "32"), ("cl_device_max_parameter_size", bytes)];
    says(launch(&tight("15"), 64), &format!("CL_DEVICE_MAX_PARAMETER_SIZE{of}"), "16 bytes", "15 bytes");
    launch(&tight("16"), 64).unwrap();

    let pick = |limits: &[(&str, &str)], len: usize| {
        let context = context_under(limits);
        let kernel = kernel(&context, "pick");
        let (a, out) = (context.buffer_from("a", &vec![21u32; len]).unwrap(), context.buffer::<u32>("out", 1).unwrap());
        let args = [Arg::Buffer(&a), Arg::Buffer(&a), Arg::Buffer(&out)];
        let global = [1, 1];
        context.launch(&DeviceLaunch {
            label: "pick",
            kernel: &kernel,
            args: &args,
            global,
            local: None,
            barrier: false,
        })?;
        assert_eq!(context.read(&out, 0..1).unwrap(), [42]);
        Ok(())
    };
    let tight = [("cl_device_max_constant_args", "1")];
    says(pick(&tight, 1), &format!("CL_DEVICE_MAX_CONSTANT_ARGS{of}"), "2", "1");
    pick(&[("cl_device_max_constant_args", "2")], 1).unwrap();
    let tight = [("cl_device_max_constant_buffer_size", "64")];
    says(pick(&tight, 17), &format!("CL_DEVICE_MAX_CONSTANT_BUFFER_SIZE{of}"), "68 bytes", "64 bytes");
    pick(&tight, 16).unwrap();

    let build = |limits: &[(&str, &str)]| {
        let name = "cl_khr_byte_addressable_store";
        let source = format!("#pragma OPENCL EXTENSION {name} : enable\nkernel void k(global char *o) {{ o[0] = 1; }}");
        context_under(limits).program(&ProgramSource { name: "k", source: &source, options: "" }).map(|_| ())
    };
    let limit = format!("CL_DEVICE_EXTENSIONS{of}");
    says(build(&[("cl_device_extensions", "[]")]), &limit, "cl_khr_byte_addressable_store", "no extension");
    build(&[]).unwrap();
    let old = [("cl_device_version", r#""OpenCL 1.1 old""#)];
    says(build(&old), &format!("CL_DEVICE_VERSION{of}"), "OpenCL 1.2", "OpenCL 1.1");

    let context = context_under(&[("cl_device_address_bits", "32")]);
    if usize::BITS == 64 {
        let kernel = kernel(&context, "count");
        let out = context.buffer::<u32>("out", 1).unwrap();
        let one = 1u32.to_ne_bytes();
        let args = [Arg::Buffer(&out), Arg::Value(&one), Arg::Value(&one)];
        let global = [1usize << (usize::BITS / 2), 1];
        let launch = DeviceLaunch { label: "big", kernel: &kernel, args: &args, global, local: None, barrier: false };
        let limit = format!("CL_DEVICE_ADDRESS_BITS{of}");
        says(context.launch(&launch), &limit, "4294967296 work-items", "4294967295 work-items");
    }
}

/// Programs from the cache must not escape the checks.
#[test]
fn limits_hold_for_cached_programs() {
    if no_opencl() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let cache = CacheFolder::At(folder.path().to_path_buf());
    let tight = profile(&[("cl_device_max_constant_args", "1")]);
    for from_cache in [false, true] {
        let context = context_with(&OpenOptions { cache: cache.clone(), profile: Some(tight.clone()), ..options() });
        let program = context.program(&ProgramSource { name: "context-test", source: SOURCE, options: "" }).unwrap();
        assert_eq!(program.is_from_cache(), from_cache);
        let kernel = program.kernel("pick").unwrap();
        let a = context.buffer_from("a", &[1u32]).unwrap();
        let args = [Arg::Buffer(&a), Arg::Buffer(&a), Arg::Buffer(&a)];
        let global = [1, 1];
        let launch = DeviceLaunch { label: "pick", kernel: &kernel, args: &args, global, local: None, barrier: false };
        let message = context.launch(&launch).unwrap_err().to_string();
        assert!(message.contains("CL_DEVICE_MAX_CONSTANT_ARGS"), "{message}");
    }
}

#[test]
fn an_enqueue_beyond_the_watchdog_is_an_error() {
    if no_opencl() || context().info().is_simulator() {
        return;
    }
    let entry = r#"{"value":1,"certainty":"inferred","source":"test"}"#;
    let text = format!(r#"{{"limits":{{}},"hardware":{{"gpu_batch_timeout_ms":{entry}}}}}"#);
    let strict = Profile::from_json("strict", &text).unwrap();
    // Whole launches: slices would follow what is measured.
    let context = context_with(&OpenOptions { profile: Some(strict), slice_items: Some(u64::MAX), ..options() });
    let source = "kernel void slow(global uint *out) {
        uint v = (uint)get_global_id(0);
        for (uint i = 0; i < 16000u; i++) v = v * 1664525u + (v >> 7) + 1013904223u;
        out[get_global_id(0)] = v;
    }";
    let program = context.program(&ProgramSource { name: "slow", source, options: "" }).unwrap();
    let kernel = program.kernel("slow").unwrap();
    let out = context.buffer::<u32>("out", 1 << 15).unwrap();
    let args = [Arg::Buffer(&out)];
    let launch = DeviceLaunch {
        label: "slow",
        kernel: &kernel,
        args: &args,
        global: [1 << 15, 1],
        local: Some([64, 1]),
        barrier: false,
    };
    // The first run of a stage is not judged: it may include its compilation.
    context.launch(&launch).unwrap();
    context.finish().unwrap();
    let message = context.launch(&launch).and_then(|()| context.finish()).unwrap_err().to_string();
    assert!(message.contains("`slow`") && message.contains("gpu_batch_timeout_ms"), "{message}");
    assert!(message.contains("allows 1 ms") && message.contains("slice_ms"), "{message}");
    context.finish().unwrap();
}

#[test]
fn work_groups_adapt_to_half_of_a_limit() {
    if no_opencl() {
        return;
    }
    for limit in [
        [("cl_device_max_work_group_size", "32")],
        [("cl_kernel_work_group_size", "32")],
        [("cl_device_max_work_item_sizes", "[32,32,32]")],
    ] {
        let context = context_under(&limit);
        let kernel = kernel(&context, "sum");
        let [width, height] = context.fit_work_group(&kernel, [64, 1], true);
        assert_eq!([width, height], [32, 1], "{limit:?}");
        assert_eq!(launch_sum(&context, width).unwrap(), 499_500);
    }
}

#[test]
fn every_embedded_profile_runs_the_kernels() {
    if no_opencl() {
        return;
    }
    for name in Profile::names() {
        let context = context_with(&OpenOptions { profile: Some(Profile::named(name).unwrap()), ..options() });
        for local in [None, Some([8, 8])] {
            assert!(counted(&count(&context, 123, 45, local)), "{name}");
        }
        assert_eq!(launch_sum(&context, 64).unwrap(), 499_500, "{name}");
    }
}

#[test]
fn a_dump_of_the_devices_is_a_profile() {
    if no_opencl() {
        return;
    }
    let found = discover();
    assert!(!found.devices.is_empty(), "{:?}", found.skipped);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("devices.json");
    std::fs::write(&path, serde_json::to_string_pretty(&found.dump()).unwrap()).unwrap();
    for (index, device) in found.devices.iter().enumerate() {
        let numbered = folder.path().join(format!("devices.json#{index}"));
        let loaded = Profile::load(&numbered).unwrap();
        assert_eq!(loaded.to_json(), device.profile.to_json());
        assert_eq!(loaded.text("cl_device_name"), Some(device.info.name.as_str()));
        assert!(loaded.count("cl_device_max_mem_alloc_size").is_some());
    }
    let error = Profile::load(&folder.path().join("devices.json#99")).unwrap_err().to_string();
    assert!(error.contains("there is no device #99"), "{error}");
    let own = Profile::load(&path).unwrap();
    let context = context_with(&OpenOptions { profile: Some(own), ..options() });
    assert!(counted(&count(&context, 123, 45, Some([8, 8]))));
    assert_eq!(launch_sum(&context, 64).unwrap(), 499_500);
}

#[test]
fn a_scene_beyond_one_allocation_is_refused_with_the_numbers() {
    if no_opencl() {
        return;
    }
    let make = |most_bytes: &str| {
        let options = DeviceOptions {
            device: DeviceChoice::OpenCl(None),
            profile: Some(profile(&[("cl_device_max_mem_alloc_size", most_bytes)])),
            ..DeviceOptions::default()
        };
        renderer_of(&builtin::to_scene("cafe").unwrap(), &options, &Monitor::default())
    };
    let error = make("1000000").err().unwrap();
    assert!(matches!(error, Error::LimitExceeded { .. }), "{error}");
    let message = error.to_string();
    // The largest array of this scene is beyond the limit; others are not.
    let named = ["buffer `nodes`", "buffer `triangles`", "buffer `leaf_triangles`", "buffer `triangle_shading`"];
    assert!(named.iter().any(|name| message.contains(name)), "{message}");
    for part in ["CL_DEVICE_MAX_MEM_ALLOC_SIZE", "allows 1000000 bytes", "tight"] {
        assert!(message.contains(part), "{message}");
    }
    make("100000000").unwrap();
}
