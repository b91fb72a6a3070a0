// SPDX-License-Identifier: MIT OR Apache-2.0
//! The door to OpenCL on a real implementation: launches, slices, limits, caches, errors.
//!
//! Oclgrind runs these with `--test-threads 1` only: it mixes up contexts of several threads.
#![allow(clippy::unwrap_used, missing_docs)]

use std::path::Path;
use std::process::{Command, Output};

use rarefy::Error;
use rarefy::opencl::{
    Arg, CacheFolder, Door, Kernel, Launch, OpenOptions, Profile, ProgramSource, build_log, discover, open_with,
};

/// A test that finds no OpenCL fails, unless this variable says `none`.
const WITHOUT: &str = "RAREFY_TEST_OPENCL";

fn no_opencl() -> bool {
    let none = std::env::var(WITHOUT).is_ok_and(|value| value == "none");
    if none {
        println!("skipped: {WITHOUT}=none");
    }
    none
}

fn options() -> OpenOptions {
    OpenOptions { cache: CacheFolder::Off, ..OpenOptions::default() }
}

fn door_with(options: &OpenOptions) -> Door {
    open_with(options).unwrap_or_else(|error| panic!("{error} (or set {WITHOUT}=none)"))
}

fn door() -> Door {
    door_with(&options())
}

fn profile(limits: &[(&str, &str)]) -> Profile {
    let limits: Vec<String> = limits
        .iter()
        .map(|(key, value)| format!(r#""{key}":{{"value":{value},"certainty":"inferred","source":"test"}}"#))
        .collect();
    Profile::from_json("tight", &format!(r#"{{"limits":{{{}}}}}"#, limits.join(","))).unwrap()
}

fn door_under(limits: &[(&str, &str)]) -> Door {
    door_with(&OpenOptions { profile: Some(profile(limits)), ..options() })
}

const SOURCE: &str = "
typedef struct { uint width, height; float scale; uint bias; } params_t;

kernel void count(global uint *out, uint width, uint height) {
    uint x = (uint)get_global_id(0), y = (uint)get_global_id(1);
    if (x >= width || y >= height) return;
    out[y * width + x] += y * width + x + 1u;
}

kernel void scale(global float *out, params_t p) {
    uint i = (uint)get_global_id(0);
    if (i < p.width * p.height) out[i] = (float)i * p.scale + (float)p.bias;
}

kernel void sum(global const uint *in, global uint *out, local uint *part, uint n) {
    uint i = (uint)get_global_id(0), l = (uint)get_local_id(0);
    part[l] = i < n ? in[i] : 0u;
    for (uint half_size = (uint)get_local_size(0) / 2u; half_size > 0u; half_size /= 2u) {
        barrier(CLK_LOCAL_MEM_FENCE);
        if (l < half_size) part[l] += part[l + half_size];
    }
    if (l == 0u) atomic_add(out, part[0]);
}

kernel void pick(constant uint *a, constant uint *b, global uint *out) {
    if (get_global_id(0) == 0) out[0] = a[0] + b[0];
}
";

fn kernel(door: &Door, name: &str) -> Kernel {
    let source = build_log::assemble(&[("door-test.cl", SOURCE)]);
    door.program(&ProgramSource { name: "door-test", source: &source, options: "" }).unwrap().kernel(name).unwrap()
}

/// Runs `count` on a picture and returns it: index + 1 everywhere if each work-item ran once.
fn count(door: &Door, width: usize, height: usize, local: Option<[usize; 2]>) -> Vec<u32> {
    let kernel = kernel(door, "count");
    let out = door.buffer::<u32>("out", width * height).unwrap();
    door.fill_zero(&out).unwrap();
    let (w, h) = (width as u32, height as u32);
    let args = [Arg::Buffer(&out), Arg::Value(&w.to_ne_bytes()), Arg::Value(&h.to_ne_bytes())];
    door.launch(&Launch {
        label: "count",
        kernel: &kernel,
        args: &args,
        global: [width, height],
        local,
        barrier: false,
    })
    .unwrap();
    door.read(&out, 0..width * height).unwrap()
}

fn counted(values: &[u32]) -> bool {
    values.iter().enumerate().all(|(index, &value)| value == index as u32 + 1)
}

#[test]
fn a_launch_of_any_size_runs_each_item_once() {
    if no_opencl() {
        return;
    }
    let door = door();
    for (width, height) in [(1, 1), (1, 7), (13, 1), (64, 64), (123, 45), (257, 129)] {
        for local in [None, Some([8, 8]), Some([64, 1]), Some([3, 5])] {
            assert!(counted(&count(&door, width, height, local)), "{width}x{height} {local:?}");
        }
    }
    // The comparison can fail.
    assert!(!counted(&[1, 2, 2]));
    let kernel = kernel(&door, "count");
    let out = door.buffer::<u32>("out", 1).unwrap();
    let zero = 0u32.to_ne_bytes();
    let before = door.enqueues();
    let args = [Arg::Buffer(&out), Arg::Value(&zero), Arg::Value(&zero)];
    let launch =
        Launch { label: "count", kernel: &kernel, args: &args, global: [0, 5], local: Some([8, 8]), barrier: false };
    door.launch(&launch).unwrap();
    assert_eq!(door.enqueues(), before, "an empty launch enqueues nothing");
}

#[test]
fn slices_give_the_same_result() {
    if no_opencl() {
        return;
    }
    let whole = door();
    let expected = count(&whole, 123, 45, Some([8, 8]));
    assert_eq!(whole.enqueues(), 1);
    for (items, enqueues) in [(1, 16 * 6), (64, 16 * 6), (200, 6 * 6), (1024, 6), (2048, 3), (u64::MAX, 1)] {
        let sliced = door_with(&OpenOptions { slice_items: Some(items), ..options() });
        assert_eq!(count(&sliced, 123, 45, Some([8, 8])), expected, "{items}");
        assert_eq!(sliced.enqueues(), enqueues, "{items}");
    }
    let single = door_with(&OpenOptions { slice_items: Some(10), ..options() });
    assert_eq!(count(&single, 123, 45, None), expected);
}

#[test]
fn slices_follow_the_profile() {
    if no_opencl() {
        return;
    }
    // A stage starts with small slices under a profile.
    let phone = door_with(&OpenOptions { profile: Some(Profile::named("adreno-420").unwrap()), ..options() });
    assert!(counted(&count(&phone, 400, 200, Some([8, 8]))));
    assert!(phone.enqueues() > 1);
    assert_eq!(phone.profile_name(), Some("adreno-420"));
    assert_eq!(phone.choices().work_group("step1"), [8, 8]);
}

#[test]
fn structs_are_passed_by_value() {
    if no_opencl() {
        return;
    }
    let door = door();
    let kernel = kernel(&door, "scale");
    let out = door.buffer::<f32>("out", 35).unwrap();
    let mut params = Vec::new();
    for word in [7u32, 5, 0.5f32.to_bits(), 3] {
        params.extend_from_slice(&word.to_ne_bytes());
    }
    let args = [Arg::Buffer(&out), Arg::Value(&params)];
    let launch =
        Launch { label: "scale", kernel: &kernel, args: &args, global: [35, 1], local: Some([8, 1]), barrier: false };
    door.launch(&launch).unwrap();
    let expected: Vec<f32> = (0..35).map(|i| i as f32 * 0.5 + 3.0).collect();
    assert_eq!(door.read(&out, 0..35).unwrap(), expected);
    assert_eq!(door.read(&out, 3..5).unwrap(), expected[3..5]);
}

fn launch_sum(door: &Door, local: usize) -> rarefy::Result<u32> {
    let kernel = kernel(door, "sum");
    let values: Vec<u32> = (0..1000).collect();
    let input = door.buffer_from("in", &values)?;
    let out = door.buffer_from("out", &[0u32])?;
    let n = 1000u32.to_ne_bytes();
    let args = [Arg::Buffer(&input), Arg::Buffer(&out), Arg::Local(local * 4), Arg::Value(&n)];
    let local = Some([local, 1]);
    door.launch(&Launch { label: "sum", kernel: &kernel, args: &args, global: [1000, 1], local, barrier: true })?;
    Ok(door.read(&out, 0..1)?[0])
}

#[test]
fn local_memory_and_barriers_work() {
    if no_opencl() {
        return;
    }
    assert_eq!(launch_sum(&door(), 64).unwrap(), 499_500);
    let sliced = door_with(&OpenOptions { slice_items: Some(64), ..options() });
    assert_eq!(launch_sum(&sliced, 32).unwrap(), 499_500);
}

#[test]
fn buffers_are_filled_copied_and_counted() {
    if no_opencl() {
        return;
    }
    let door = door();
    assert_eq!(door.memory().current_bytes, 0);
    let a = door.buffer_from("a", &[1u16, 2, 3]).unwrap();
    let b = door.buffer::<u16>("b", 3).unwrap();
    door.copy(&a, &b).unwrap();
    door.write(&b, 2, &[9]).unwrap();
    assert_eq!(door.read(&b, 0..3).unwrap(), [1, 2, 9]);
    door.fill_zero(&a).unwrap();
    assert_eq!(door.read(&a, 0..3).unwrap(), [0; 3]);
    assert!(door.fill(&a, 7).unwrap_err().to_string().contains("clEnqueueFillBuffer"));
    let words = door.buffer::<u32>("words", 5).unwrap();
    door.fill(&words, 0xdead_beef).unwrap();
    assert_eq!(door.read(&words, 0..5).unwrap(), [0xdead_beef; 5]);
    assert_eq!(door.memory().current_bytes, 6 + 6 + 20);
    drop(words);
    let empty = door.buffer_from::<u64>("empty", &[]).unwrap();
    assert!(empty.is_empty());
    assert_eq!(door.read(&empty, 0..0).unwrap(), Vec::<u64>::new());
    door.fill_zero(&empty).unwrap();
    assert_eq!(door.memory().current_bytes, 6 + 6 + 8);
    assert_eq!(door.memory().peak_bytes, 32);
    door.reset_peak_memory();
    assert_eq!(door.memory().peak_bytes, 20);
    drop((a, b, empty));
    assert_eq!(door.memory().current_bytes, 0);
}

#[test]
fn ranges_beyond_a_buffer_and_foreign_objects_are_errors() {
    if no_opencl() {
        return;
    }
    let (ours, other) = (door(), door());
    let buffer = ours.buffer::<u32>("small", 4).unwrap();
    for result in [
        ours.read(&buffer, 0..5).map(|_| ()),
        ours.read(&buffer, usize::MAX - 1..usize::MAX).map(|_| ()),
        ours.read(&buffer, 5..5).map(|_| ()),
        ours.write(&buffer, 3, &[1, 2]),
        ours.write(&buffer, usize::MAX, &[1, 2]),
    ] {
        let message = result.unwrap_err().to_string();
        assert!(message.contains("of the 4 of `small`") && message.contains("CL_INVALID_VALUE (-30)"), "{message}");
    }
    assert!(other.fill_zero(&buffer).unwrap_err().to_string().contains("CL_INVALID_CONTEXT"));
    let kernel = kernel(&other, "count");
    let one = 1u32.to_ne_bytes();
    let args = [Arg::Buffer(&buffer), Arg::Value(&one), Arg::Value(&one)];
    let launch = Launch { label: "count", kernel: &kernel, args: &args, global: [1, 1], local: None, barrier: false };
    let message = other.launch(&launch).unwrap_err().to_string();
    assert!(message.contains("clSetKernelArg 0 of `count`"), "{message}");
    assert!(ours.launch(&launch).unwrap_err().to_string().contains("CL_INVALID_CONTEXT"));
    let message = other.launch(&Launch { args: &args[1..], ..launch }).unwrap_err().to_string();
    assert!(message.contains("2 of 3 arguments") && message.contains("CL_INVALID_KERNEL_ARGS"), "{message}");
    let program = other.program(&ProgramSource { name: "p", source: SOURCE, options: "" }).unwrap();
    let message = program.kernel("missing").unwrap_err().to_string();
    assert!(message.contains("`missing`") && message.contains("CL_INVALID_KERNEL_NAME"), "{message}");
}

#[test]
fn launches_are_timed_per_label() {
    if no_opencl() {
        return;
    }
    let door = door();
    count(&door, 128, 128, Some([8, 8]));
    count(&door, 128, 128, Some([8, 8]));
    launch_sum(&door, 64).unwrap();
    let timings = door.take_timings().unwrap();
    let labels: Vec<_> = timings.iter().map(|(label, _)| *label).collect();
    assert_eq!(labels, ["count", "sum"]);
    assert!(timings.iter().all(|(_, ms)| *ms >= 0.0 && ms.is_finite()));
    assert_eq!(door.enqueues(), 3);
    assert!(door.take_timings().unwrap().is_empty(), "taken once");
}

#[test]
fn a_failing_enqueue_is_an_error_with_the_stage() {
    if no_opencl() {
        return;
    }
    let door = door_with(&OpenOptions { fail_enqueue: Some(1), ..options() });
    assert!(counted(&count(&door, 8, 8, None)));
    let message = launch_sum(&door, 64).unwrap_err().to_string();
    assert_eq!(message, "clEnqueueNDRangeKernel of `sum` failed: CL_OUT_OF_RESOURCES (-5)");
    assert_eq!(launch_sum(&door, 64).unwrap(), 499_500, "the door still works");
}

#[test]
fn a_build_error_names_file_and_line() {
    if no_opencl() {
        return;
    }
    let door = door();
    let source = build_log::assemble(&[
        ("common/good.clh", "uint twice(uint x);\nuint twice(uint x) { return x * 2u; }\n"),
        ("stages/bad.cl", "kernel void bad(global uint *out) {\n    out[0] = twice(1u);\n    out[1] = nonsense;\n}\n"),
    ]);
    let error = door.program(&ProgramSource { name: "bad", source: &source, options: "" }).unwrap_err();
    let message = error.to_string();
    assert!(matches!(error, Error::KernelBuild { .. }), "{message}");
    assert!(message.contains("`bad`") && message.contains(&door.info().driver), "{message}");
    assert!(message.contains("stages/bad.cl:3:14: error: use of undeclared identifier 'nonsense'"), "{message}");
    // Warnings are errors.
    let warned = "kernel void w(global uint *out) { out[0] = 1.5f > 0; int *p = out; }";
    assert!(door.program(&ProgramSource { name: "w", source: warned, options: "" }).is_err());
    // The mended source builds.
    let good = source.replace("nonsense", "twice(2u)");
    door.program(&ProgramSource { name: "good", source: &good, options: "-D X=1" }).unwrap();
    let error = door.program(&ProgramSource { name: "good", source: &good, options: "-cl-std=CL2.0" }).unwrap_err();
    assert!(error.to_string().contains("-cl-std"), "{error}");
}

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

    let door = door_under(&[("cl_device_max_mem_alloc_size", "1000")]);
    says(
        door.buffer::<u32>("b", 251).map(|_| ()),
        &format!("CL_DEVICE_MAX_MEM_ALLOC_SIZE{of}"),
        "1004 bytes",
        "1000 bytes",
    );
    assert!(door.buffer::<u32>("b", 250).is_ok());

    let door = door_under(&[("cl_device_global_mem_size", "1000")]);
    let first = door.buffer::<u8>("a", 600).unwrap();
    let limit = format!("CL_DEVICE_GLOBAL_MEM_SIZE{of}");
    says(door.buffer::<u8>("b", 401).map(|_| ()), &limit, "1001 bytes", "1000 bytes");
    assert!(door.buffer::<u8>("b", 400).is_ok());
    drop(first);
    assert!(door.buffer::<u8>("b", 1000).is_ok());

    let door = door_with(&OpenOptions { memory_budget_bytes: Some(500), ..options() });
    says(door.buffer::<u8>("b", 501).map(|_| ()), "--memory-budget", "501 bytes", "500 bytes");
    let door = door_with(&options());
    assert!(matches!(door.buffer::<u64>("b", usize::MAX), Err(Error::LimitExceeded { .. })));
    assert_eq!(door.memory().current_bytes, 0);

    let launch = |limits: &[(&str, &str)], local: usize| launch_sum(&door_under(limits), local).map(|_| ());
    let tight = [("cl_device_max_work_group_size", "32")];
    says(launch(&tight, 64), &format!("CL_DEVICE_MAX_WORK_GROUP_SIZE{of}"), "64 work-items", "32 work-items");
    launch(&tight, 32).unwrap();
    let tight = [("cl_kernel_work_group_size", "32")];
    says(launch(&tight, 64), &format!("CL_KERNEL_WORK_GROUP_SIZE{of}"), "64 work-items", "32 work-items");
    launch(&tight, 32).unwrap();
    // Only kernels with barriers get the lower one.
    assert!(counted(&count(&door_under(&tight), 64, 1, Some([64, 1]))));
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
        let door = door_under(limits);
        let kernel = kernel(&door, "pick");
        let (a, out) = (door.buffer_from("a", &vec![21u32; len]).unwrap(), door.buffer::<u32>("out", 1).unwrap());
        let args = [Arg::Buffer(&a), Arg::Buffer(&a), Arg::Buffer(&out)];
        let global = [1, 1];
        door.launch(&Launch { label: "pick", kernel: &kernel, args: &args, global, local: None, barrier: false })?;
        assert_eq!(door.read(&out, 0..1).unwrap(), [42]);
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
        door_under(limits).program(&ProgramSource { name: "k", source: &source, options: "" }).map(|_| ())
    };
    let limit = format!("CL_DEVICE_EXTENSIONS{of}");
    says(build(&[("cl_device_extensions", "[]")]), &limit, "cl_khr_byte_addressable_store", "no extension");
    build(&[]).unwrap();
    let old = [("cl_device_version", r#""OpenCL 1.1 old""#)];
    says(build(&old), &format!("CL_DEVICE_VERSION{of}"), "OpenCL 1.2", "OpenCL 1.1");

    let door = door_under(&[("cl_device_address_bits", "32")]);
    if usize::BITS == 64 {
        let kernel = kernel(&door, "count");
        let out = door.buffer::<u32>("out", 1).unwrap();
        let one = 1u32.to_ne_bytes();
        let args = [Arg::Buffer(&out), Arg::Value(&one), Arg::Value(&one)];
        let global = [1usize << (usize::BITS / 2), 1];
        let launch = Launch { label: "big", kernel: &kernel, args: &args, global, local: None, barrier: false };
        let limit = format!("CL_DEVICE_ADDRESS_BITS{of}");
        says(door.launch(&launch), &limit, "4294967296 work-items", "4294967295 work-items");
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
        let door = door_with(&OpenOptions { cache: cache.clone(), profile: Some(tight.clone()), ..options() });
        let program = door.program(&ProgramSource { name: "door-test", source: SOURCE, options: "" }).unwrap();
        assert_eq!(program.is_from_cache(), from_cache);
        let kernel = program.kernel("pick").unwrap();
        let a = door.buffer_from("a", &[1u32]).unwrap();
        let args = [Arg::Buffer(&a), Arg::Buffer(&a), Arg::Buffer(&a)];
        let global = [1, 1];
        let launch = Launch { label: "pick", kernel: &kernel, args: &args, global, local: None, barrier: false };
        let message = door.launch(&launch).unwrap_err().to_string();
        assert!(message.contains("CL_DEVICE_MAX_CONSTANT_ARGS"), "{message}");
    }
}

#[test]
fn an_enqueue_beyond_the_watchdog_is_an_error() {
    if no_opencl() || door().info().is_simulator() {
        return;
    }
    let entry = r#"{"value":1,"certainty":"inferred","source":"test"}"#;
    let text = format!(r#"{{"limits":{{}},"hardware":{{"gpu_batch_timeout_ms":{entry}}}}}"#);
    let strict = Profile::from_json("strict", &text).unwrap();
    let door = door_with(&OpenOptions { profile: Some(strict), ..options() });
    let source = "kernel void slow(global uint *out) {
        uint v = (uint)get_global_id(0);
        for (uint i = 0; i < 2000u; i++) v = v * 1664525u + (v >> 7) + 1013904223u;
        out[get_global_id(0)] = v;
    }";
    let program = door.program(&ProgramSource { name: "slow", source, options: "" }).unwrap();
    let kernel = program.kernel("slow").unwrap();
    let out = door.buffer::<u32>("out", 1 << 18).unwrap();
    let args = [Arg::Buffer(&out)];
    let launch = Launch {
        label: "slow",
        kernel: &kernel,
        args: &args,
        global: [1 << 18, 1],
        local: Some([64, 1]),
        barrier: false,
    };
    // The first run of a stage is not judged: it may include its compilation.
    door.launch(&launch).unwrap();
    door.finish().unwrap();
    let message = door.launch(&launch).and_then(|()| door.finish()).unwrap_err().to_string();
    assert!(message.contains("`slow`") && message.contains("gpu_batch_timeout_ms"), "{message}");
    assert!(message.contains("allows 1 ms") && message.contains("slice_ms"), "{message}");
    door.finish().unwrap();
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
        let door = door_under(&limit);
        let kernel = kernel(&door, "sum");
        let [width, height] = door.fit_work_group(&kernel, [64, 1], true);
        assert_eq!([width, height], [32, 1], "{limit:?}");
        assert_eq!(launch_sum(&door, width).unwrap(), 499_500);
    }
}

#[test]
fn every_embedded_profile_runs_the_kernels() {
    if no_opencl() {
        return;
    }
    for name in Profile::names() {
        let door = door_with(&OpenOptions { profile: Some(Profile::named(name).unwrap()), ..options() });
        for local in [None, Some([8, 8])] {
            assert!(counted(&count(&door, 123, 45, local)), "{name}");
        }
        assert_eq!(launch_sum(&door, 64).unwrap(), 499_500, "{name}");
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
    std::fs::write(&path, serde_json::to_string_pretty(&found.to_json()).unwrap()).unwrap();
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
    let door = door_with(&OpenOptions { profile: Some(own), ..options() });
    assert!(counted(&count(&door, 123, 45, Some([8, 8]))));
    assert_eq!(launch_sum(&door, 64).unwrap(), 499_500);
}

#[test]
fn a_device_that_is_not_there_is_an_error_with_those_that_are() {
    if no_opencl() {
        return;
    }
    let error = open_with(&OpenOptions { index: Some(99), ..options() }).unwrap_err().to_string();
    assert!(error.contains("no OpenCL device 99") && error.contains("0 ("), "{error}");
}

#[test]
fn threads_share_a_door() {
    if no_opencl() {
        return;
    }
    let door = door();
    if door.info().is_simulator() {
        println!("skipped: Oclgrind is not made for threads");
        return;
    }
    std::thread::scope(|scope| {
        let threads: Vec<_> =
            (0..4).map(|_| scope.spawn(|| (0..5).all(|_| counted(&count(&door, 123, 45, Some([8, 8])))))).collect();
        assert!(threads.into_iter().all(|thread| thread.join().unwrap()));
    });
    assert_eq!(door.enqueues(), 20);
}

/// Set in the processes that tests start. Without it the ignored tests below, run among the long ones, do nothing.
const CHILD: &str = "RAREFY_TEST_CHILD";

fn is_child() -> bool {
    std::env::var_os(CHILD).is_some()
}

/// Runs one of the ignored tests below in a process of its own, with these variables.
fn child(test: &str, variables: &[(&str, &str)]) -> Output {
    let mut command = child_command(test);
    command.envs(variables.iter().copied());
    command.output().unwrap()
}

fn child_command(test: &str) -> Command {
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.args([test, "--exact", "--ignored", "--nocapture", "--test-threads", "1"]);
    command.env(CHILD, "1");
    command
}

fn printed(output: &Output) -> String {
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{text}{}", String::from_utf8_lossy(&output.stderr));
    text
}

#[test]
#[ignore = "a process that other tests start"]
fn child_without_devices() {
    if !is_child() {
        return;
    }
    let error = open_with(&options()).unwrap_err();
    assert!(matches!(&error, Error::NoOpenCl { tried } if !tried.is_empty()), "{error}");
    println!("said: {error}");
    assert!(discover().devices.is_empty());
}

#[test]
fn without_a_platform_the_error_lists_what_was_tried() {
    if no_opencl() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let text = printed(&child("child_without_devices", &[("OCL_ICD_VENDORS", folder.path().to_str().unwrap())]));
    assert!(text.contains("said: no usable OpenCL device: "), "{text}");
    assert!(text.contains("no OpenCL platform is installed") && text.contains("--device cpu"), "{text}");
}

#[test]
#[ignore = "a process that other tests start"]
fn child_with_wrong_library() {
    if !is_child() {
        return;
    }
    let found = discover();
    println!("found {} devices, skipped {:?}", found.devices.len(), found.skipped);
    let search = rarefy::opencl::library::find(None);
    println!("refused: {:?}", search.reasons());
    assert!(search.accepted.is_some());
    if !found.devices.is_empty() {
        assert!(counted(&count(&door(), 9, 9, None)));
    }
}

#[test]
fn a_wrong_library_path_is_passed_over_with_the_reason() {
    if no_opencl() {
        return;
    }
    let text = printed(&child("child_with_wrong_library", &[("OPENCL_DYLIB_PATH", "/nonexistent/libX.so")]));
    assert!(text.contains("refused: [\"/nonexistent/libX.so: "), "{text}");
}

#[test]
#[ignore = "a process that other tests start"]
fn child_build() {
    if !is_child() {
        return;
    }
    let door = door_with(&OpenOptions::default());
    let source = build_log::assemble(&[("door-test.cl", SOURCE)]);
    let program = door.program(&ProgramSource { name: "door-test", source: &source, options: "" }).unwrap();
    assert!(counted(&count(&door, 123, 45, Some([8, 8]))));
    println!("from cache: {}", program.is_from_cache());
}

/// Starts `child_build` with scratch caches in `folder`.
fn child_build_in(folder: &Path) -> Command {
    let mut command = child_command("child_build");
    command.env("RAREFY_CACHE_DIR", folder.join("rarefy")).env("POCL_CACHE_DIR", folder.join("pocl"));
    command
}

fn entries(folder: &Path) -> Vec<std::path::PathBuf> {
    std::fs::read_dir(folder.join("rarefy")).unwrap().map(|file| file.unwrap().path()).collect()
}

#[test]
fn programs_are_cached_and_damage_is_mended() {
    if no_opencl() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("pocl")).unwrap();
    let cached = || printed(&child_build_in(folder.path()).output().unwrap()).contains("from cache: true");
    assert!(!cached());
    let entries = entries(folder.path());
    assert_eq!(entries.len(), 1, "{entries:?}");
    assert!(cached());
    let sound = std::fs::read(&entries[0]).unwrap();
    let mut flipped = sound.clone();
    flipped[sound.len() / 2] ^= 1;
    let foreign = b"rarefy program 1\nsomebody else's".to_vec();
    for damaged in [flipped, sound[..sound.len() / 2].to_vec(), Vec::new(), foreign] {
        std::fs::write(&entries[0], &damaged).unwrap();
        assert!(!cached());
        assert!(cached(), "the entry was written anew");
    }
}

#[test]
fn a_binary_that_the_driver_refuses_is_built_anew() {
    if no_opencl() {
        return;
    }
    // A sound entry whose content is no binary: written by the cache's own rules for an older driver, say.
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("pocl")).unwrap();
    printed(&child_build_in(folder.path()).output().unwrap());
    let path = entries(folder.path()).remove(0);
    let entry = std::fs::read(&path).unwrap();
    let head = b"rarefy program 1\n".len() + 16;
    let junk = b"not a program";
    let mut state: u128 = 0x6c62_272e_07bb_0142_62b8_2175_6295_c58d;
    for byte in (junk.len() as u64).to_le_bytes().iter().chain(junk) {
        state = (state ^ u128::from(*byte)).wrapping_mul((1 << 88) + 0x13b);
    }
    let refused = [&entry[..head], &state.to_le_bytes(), junk].concat();
    std::fs::write(&path, refused).unwrap();
    let text = printed(&child_build_in(folder.path()).output().unwrap());
    assert!(text.contains("from cache: false"), "{text}");
    assert_eq!(std::fs::read(&path).unwrap()[..head], entry[..head]);
}

#[test]
fn processes_may_race_for_the_cache() {
    if no_opencl() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("pocl")).unwrap();
    let spawn = || child_build_in(folder.path()).stdout(std::process::Stdio::piped()).spawn().unwrap();
    let children: Vec<_> = (0..3).map(|_| spawn()).collect();
    for child in children {
        printed(&child.wait_with_output().unwrap());
    }
    assert_eq!(entries(folder.path()).len(), 1, "one entry, no temporary files");
    assert!(printed(&child_build_in(folder.path()).output().unwrap()).contains("from cache: true"));
}
