// SPDX-License-Identifier: MIT OR Apache-2.0
//! The context to OpenCL on a real implementation: launches, slices, buffers, errors, threads.
//!
//! Oclgrind runs these with `--test-threads 1` only: it mixes up contexts of several threads.
#![allow(clippy::unwrap_used, missing_docs)]

use rarefy::Error;
use rarefy::internal::device::opencl::{
    Arg, DeviceLaunch, Faults, OpenOptions, Profile, ProgramSource, build_log, open_with,
};
use rarefy::internal::monitor::{Cancel, Event, Monitor};
use rarefy_host_tests::contexts::{SOURCE, context, context_with, count, counted, kernel, launch_sum, options};
use rarefy_host_tests::frames::no_opencl;

#[test]
fn a_launch_of_any_size_runs_each_item_once() {
    if no_opencl() {
        return;
    }
    let context = context();
    for (width, height) in [(1, 1), (1, 7), (13, 1), (64, 64), (123, 45), (257, 129)] {
        for local in [None, Some([8, 8]), Some([64, 1]), Some([3, 5])] {
            assert!(counted(&count(&context, width, height, local)), "{width}x{height} {local:?}");
        }
    }
    // The comparison can fail.
    assert!(!counted(&[1, 2, 2]));
    let kernel = kernel(&context, "count");
    let out = context.buffer::<u32>("out", 1).unwrap();
    let zero = 0u32.to_ne_bytes();
    let before = context.enqueues();
    let args = [Arg::Buffer(&out), Arg::Value(&zero), Arg::Value(&zero)];
    let launch = DeviceLaunch {
        label: "count",
        kernel: &kernel,
        args: &args,
        global: [0, 5],
        local: Some([8, 8]),
        barrier: false,
    };
    context.launch(&launch).unwrap();
    assert_eq!(context.enqueues(), before, "an empty launch enqueues nothing");
}

#[test]
fn slices_give_the_same_result() {
    if no_opencl() {
        return;
    }
    let whole = context();
    let expected = count(&whole, 123, 45, Some([8, 8]));
    assert_eq!(whole.enqueues(), 1);
    for (items, enqueues) in [(1, 16 * 6), (64, 16 * 6), (200, 6 * 6), (1024, 6), (2048, 3), (u64::MAX, 1)] {
        let sliced = context_with(&OpenOptions { slice_items: Some(items), ..options() });
        assert_eq!(count(&sliced, 123, 45, Some([8, 8])), expected, "{items}");
        assert_eq!(sliced.enqueues(), enqueues, "{items}");
    }
    let single = context_with(&OpenOptions { slice_items: Some(10), ..options() });
    assert_eq!(count(&single, 123, 45, None), expected);
}

#[test]
fn slices_follow_the_profile() {
    if no_opencl() {
        return;
    }
    // A stage starts with small slices under a profile.
    let phone = context_with(&OpenOptions { profile: Some(Profile::named("adreno-420").unwrap()), ..options() });
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
    let context = context();
    let kernel = kernel(&context, "scale");
    let out = context.buffer::<f32>("out", 35).unwrap();
    let mut params = Vec::new();
    for word in [7u32, 5, 0.5f32.to_bits(), 3] {
        params.extend_from_slice(&word.to_ne_bytes());
    }
    let args = [Arg::Buffer(&out), Arg::Value(&params)];
    let launch = DeviceLaunch {
        label: "scale",
        kernel: &kernel,
        args: &args,
        global: [35, 1],
        local: Some([8, 1]),
        barrier: false,
    };
    context.launch(&launch).unwrap();
    let expected: Vec<f32> = (0..35).map(|i| i as f32 * 0.5 + 3.0).collect();
    assert_eq!(context.read(&out, 0..35).unwrap(), expected);
    assert_eq!(context.read(&out, 3..5).unwrap(), expected[3..5]);
}

#[test]
fn local_memory_and_barriers_work() {
    if no_opencl() {
        return;
    }
    assert_eq!(launch_sum(&context(), 64).unwrap(), 499_500);
    let sliced = context_with(&OpenOptions { slice_items: Some(64), ..options() });
    assert_eq!(launch_sum(&sliced, 32).unwrap(), 499_500);
}

#[test]
fn buffers_are_filled_copied_and_counted() {
    if no_opencl() {
        return;
    }
    let context = context();
    assert_eq!(context.memory().current_bytes, 0);
    let a = context.buffer_from("a", &[1u16, 2, 3]).unwrap();
    let b = context.buffer::<u16>("b", 3).unwrap();
    context.copy(&a, &b).unwrap();
    context.write(&b, 2, &[9]).unwrap();
    assert_eq!(context.read(&b, 0..3).unwrap(), [1, 2, 9]);
    context.fill_zero(&a).unwrap();
    assert_eq!(context.read(&a, 0..3).unwrap(), [0; 3]);
    assert!(context.fill(&a, 7).unwrap_err().to_string().contains("clEnqueueFillBuffer"));
    let words = context.buffer::<u32>("words", 5).unwrap();
    context.fill(&words, 0xdead_beef).unwrap();
    assert_eq!(context.read(&words, 0..5).unwrap(), [0xdead_beef; 5]);
    assert_eq!(context.memory().current_bytes, 6 + 6 + 20);
    drop(words);
    let empty = context.buffer_from::<u64>("empty", &[]).unwrap();
    assert!(empty.is_empty());
    assert_eq!(context.read(&empty, 0..0).unwrap(), Vec::<u64>::new());
    context.fill_zero(&empty).unwrap();
    assert_eq!(context.memory().current_bytes, 6 + 6 + 8);
    assert_eq!(context.memory().peak_bytes, 32);
    context.reset_peak_memory();
    assert_eq!(context.memory().peak_bytes, 20);
    drop((a, b, empty));
    assert_eq!(context.memory().current_bytes, 0);
}

#[test]
fn ranges_beyond_a_buffer_and_foreign_objects_are_errors() {
    if no_opencl() {
        return;
    }
    let (ours, other) = (context(), context());
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
    let launch =
        DeviceLaunch { label: "count", kernel: &kernel, args: &args, global: [1, 1], local: None, barrier: false };
    let message = other.launch(&launch).unwrap_err().to_string();
    assert!(message.contains("clSetKernelArg 0 of `count`"), "{message}");
    assert!(ours.launch(&launch).unwrap_err().to_string().contains("CL_INVALID_CONTEXT"));
    let message = other.launch(&DeviceLaunch { args: &args[1..], ..launch }).unwrap_err().to_string();
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
    let context = context();
    count(&context, 128, 128, Some([8, 8]));
    count(&context, 128, 128, Some([8, 8]));
    launch_sum(&context, 64).unwrap();
    let timings = context.take_timings().unwrap();
    let labels: Vec<_> = timings.iter().map(|(label, _)| *label).collect();
    assert_eq!(labels, ["count", "sum"]);
    assert!(timings.iter().all(|(_, ms)| *ms >= 0.0 && ms.is_finite()));
    assert_eq!(context.enqueues(), 3);
    assert!(context.take_timings().unwrap().is_empty(), "taken once");
}

#[test]
fn a_failing_enqueue_is_an_error_with_the_stage() {
    if no_opencl() {
        return;
    }
    let faults = Faults::default();
    faults.after(1, -5);
    let context = context_with(&OpenOptions { faults: faults.clone(), ..options() });
    assert!(counted(&count(&context, 8, 8, None)));
    let message = launch_sum(&context, 64).unwrap_err().to_string();
    assert_eq!(message, "clEnqueueNDRangeKernel of `sum` failed: CL_OUT_OF_RESOURCES (-5)");
    // The device is lost for good; one that is opened anew works.
    let message = launch_sum(&context, 64).unwrap_err().to_string();
    assert_eq!(message, "clEnqueueWriteBuffer failed: CL_INVALID_COMMAND_QUEUE (-36)");
    assert!(context.finish().is_err());
    assert_eq!(launch_sum(&context_with(&OpenOptions { faults, ..options() }), 64).unwrap(), 499_500);
}

#[test]
fn slices_follow_what_is_measured_on_every_device() {
    if no_opencl() {
        return;
    }
    let context = context();
    if context.info().is_simulator() {
        println!("skipped: a simulator's times say nothing");
        return;
    }
    assert!(context.slice_ms().is_some_and(|ms| (5.0..=30.0).contains(&ms)), "{:?}", context.slice_ms());
    // The first slice of a stage is small and measured, so a launch beyond it is cut at least once.
    assert!(counted(&count(&context, 1024, 1024, Some([8, 8]))));
    assert!(context.enqueues() > 1);
}

#[test]
fn a_launch_is_cancelled_between_two_slices() {
    if no_opencl() {
        return;
    }
    let context = context_with(&OpenOptions { slice_items: Some(64), ..options() });
    let cancel = Cancel::default();
    let token = cancel.clone();
    // Told after each slice: cancels at about a quarter of the launch.
    let monitor = Monitor::new(move |event| {
        if matches!(event, Event::Progress { share, .. } if share >= 0.25) {
            token.cancel();
        }
    });
    let kernel = kernel(&context, "count");
    let out = context.buffer::<u32>("out", 64 * 64).unwrap();
    context.fill_zero(&out).unwrap();
    context.watch(&monitor.with_cancel(&cancel));
    let side = 64u32.to_ne_bytes();
    let args = [Arg::Buffer(&out), Arg::Value(&side), Arg::Value(&side)];
    let launch = DeviceLaunch {
        label: "count",
        kernel: &kernel,
        args: &args,
        global: [64, 64],
        local: Some([8, 8]),
        barrier: false,
    };
    assert!(matches!(context.launch(&launch), Err(Error::Cancelled)));
    assert!((16..=18).contains(&context.enqueues()), "{} of 64 slices", context.enqueues());
    for result in [context.read(&out, 0..1).map(|_| ()), context.write(&out, 0, &[1])] {
        assert!(matches!(result, Err(Error::Cancelled)));
    }
    // Whoever watches next is asked.
    context.watch(&Monitor::default());
    let done = context.read(&out, 0..64 * 64).unwrap().iter().filter(|&&word| word != 0).count() as u64;
    assert_eq!(done, 64 * context.enqueues(), "what was enqueued has run");
    assert!(counted(&count(&context, 64, 64, Some([8, 8]))));
}

#[test]
fn a_build_error_names_file_and_line() {
    if no_opencl() {
        return;
    }
    let context = context();
    let source = build_log::assemble(&[
        ("common/good.clh", "uint twice(uint x);\nuint twice(uint x) { return x * 2u; }\n"),
        ("stages/bad.cl", "kernel void bad(global uint *out) {\n    out[0] = twice(1u);\n    out[1] = nonsense;\n}\n"),
    ]);
    let error = context.program(&ProgramSource { name: "bad", source: &source, options: "" }).unwrap_err();
    let message = error.to_string();
    assert!(matches!(error, Error::KernelBuild { .. }), "{message}");
    assert!(message.contains("`bad`") && message.contains(&context.info().driver), "{message}");
    assert!(message.contains("stages/bad.cl:3:14: error: use of undeclared identifier 'nonsense'"), "{message}");
    // Warnings are errors.
    let warned = "kernel void w(global uint *out) { out[0] = 1.5f > 0; int *p = out; }";
    assert!(context.program(&ProgramSource { name: "w", source: warned, options: "" }).is_err());
    // The mended source builds.
    let good = source.replace("nonsense", "twice(2u)");
    context.program(&ProgramSource { name: "good", source: &good, options: "-D X=1" }).unwrap();
    let error = context.program(&ProgramSource { name: "good", source: &good, options: "-cl-std=CL2.0" }).unwrap_err();
    assert!(error.to_string().contains("-cl-std"), "{error}");
}

#[test]
fn a_device_that_is_not_there_is_an_error_with_those_that_are() {
    if no_opencl() {
        return;
    }
    let error = open_with(&OpenOptions { index: Some(99), ..options() }).unwrap_err().to_string();
    assert!(error.contains("`opencl:99`") && error.contains("opencl:0 ("), "{error}");
}

#[test]
fn threads_share_a_context() {
    if no_opencl() {
        return;
    }
    let context = context();
    if context.info().is_simulator() {
        println!("skipped: Oclgrind is not made for threads");
        return;
    }
    std::thread::scope(|scope| {
        let threads: Vec<_> =
            (0..4).map(|_| scope.spawn(|| (0..5).all(|_| counted(&count(&context, 123, 45, Some([8, 8])))))).collect();
        assert!(threads.into_iter().all(|thread| thread.join().unwrap()));
    });
    assert_eq!(context.enqueues(), 20);
}
