// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the context finds and leaves in a process of its own: libraries, platforms, the cache of programs.
//!
//! Oclgrind runs these with `--test-threads 1` only: it mixes up contexts of several threads.
#![allow(clippy::unwrap_used, missing_docs)]

use std::path::Path;
use std::process::{Command, Output};

use rarefy::Error;
use rarefy::internal::device::opencl::{OpenOptions, ProgramSource, build_log, discover, open_with};
use rarefy_host_tests::contexts::{SOURCE, context, context_with, count, counted, options};
use rarefy_host_tests::frames::no_opencl;

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
    assert!(text.contains("no OpenCL platform is installed"), "{text}");
}

#[test]
#[ignore = "a process that other tests start"]
fn child_with_wrong_library() {
    if !is_child() {
        return;
    }
    let found = discover();
    println!("found {} devices, skipped {:?}", found.devices.len(), found.skipped);
    let search = rarefy::internal::device::opencl::library::find(None);
    println!("refused: {:?}", search.reasons());
    assert!(search.accepted.is_some());
    if !found.devices.is_empty() {
        assert!(counted(&count(&context(), 9, 9, None)));
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
    let context = context_with(&OpenOptions::default());
    let source = build_log::assemble(&[("context-test.cl", SOURCE)]);
    let program = context.program(&ProgramSource { name: "context-test", source: &source, options: "" }).unwrap();
    assert!(counted(&count(&context, 123, 45, Some([8, 8]))));
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
