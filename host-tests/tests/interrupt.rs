// SPDX-License-Identifier: MIT OR Apache-2.0
//! Ctrl-C ends the command cleanly: status 130, one line, no half-written file.
#![cfg(unix)]
#![allow(clippy::unwrap_used, missing_docs)]

use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use rarefy_host_tests::command::{Run, executable};
use rarefy_host_tests::frames::no_opencl;

const SIGINT_BIT: u64 = 1 << 1;

/// Whether a set of signals of the process's main thread holds SIGINT; `None` where the system does not tell.
fn has_interrupt(process: &Child, set: &str) -> Option<bool> {
    let status = std::fs::read_to_string(format!("/proc/{}/status", process.id())).ok()?;
    let signals = status.lines().find_map(|line| line.strip_prefix(set)?.strip_prefix(':')).unwrap_or("0");
    Some(u64::from_str_radix(signals.trim(), 16).unwrap() & SIGINT_BIT != 0)
}

/// Whether the process has taken Ctrl-C over; where the system does not tell, after a while.
fn catches_interrupts(process: &Child) -> bool {
    has_interrupt(process, "SigCgt").unwrap_or_else(|| {
        std::thread::sleep(Duration::from_secs(2));
        true
    })
}

/// Starts the command, sends it SIGINT `pause` after it takes that, and waits for its end. The processes that it has
/// started by then get the signal as well, as from a terminal.
fn interrupted(folder: &Path, arguments: &[&str], variables: &[(&str, &Path)], pause: Duration) -> Run {
    let mut command = Command::new(executable());
    command.args(arguments).current_dir(folder).stdout(Stdio::piped()).stderr(Stdio::piped());
    command.envs(variables.iter().copied()).process_group(0);
    let process = command.spawn().unwrap();
    while !catches_interrupts(&process) {
        std::thread::sleep(Duration::from_millis(2));
    }
    std::thread::sleep(pause);
    // Processes that it starts inherit what its threads block: a driver's compiler does not hear the signal.
    assert!(pause.is_zero() || has_interrupt(&process, "SigBlk") != Some(false), "children hear Ctrl-C");
    let sent = Command::new("kill").args(["-INT", "--", &format!("-{}", process.id())]).status().unwrap();
    assert!(sent.success());
    let output = process.wait_with_output().unwrap();
    Run {
        status: output.status.code().unwrap_or(-1),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}

#[test]
fn ctrl_c_ends_the_command_cleanly_whatever_it_is_doing() {
    let folder = tempfile::tempdir().unwrap();
    let large = ["--device", "cpu", "--size", "8192x8192", "--memory-budget", "256"];
    let render = ["render", "cafe", "-o", "cafe.png", "--layer", "class=class.png"];
    let compare = ["compare", "cafe", "-o", "pictures", "--json", "cafe.json"];
    for command in [&render[..], &compare[..]] {
        // At once, while the scene is made ready, and in the frame, which takes far longer than any pause here.
        for pause in [0, 100, 500] {
            let arguments = [command, &large].concat();
            let run = interrupted(folder.path(), &arguments, &[], Duration::from_millis(pause)).expect(130);
            assert_eq!((run.stdout.as_str(), run.stderr.as_str()), ("", "rarefy: interrupted\n"), "{arguments:?}");
        }
    }
    // `compare` makes its folder first; no file is there, not even a temporary one.
    let left: Vec<_> = folder.path().read_dir().unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left, ["pictures"]);
    assert_eq!(folder.path().join("pictures").read_dir().unwrap().count(), 0);
}

/// A compiler that was interrupted leaves an error, and a linker that was ended took the process along.
#[test]
fn ctrl_c_while_kernels_are_built_is_no_build_error() {
    if no_opencl() {
        return;
    }
    for pause in [300, 800, 1300, 1800, 2300, 2800] {
        // PoCL keeps compiled kernels, so each run has a cache of its own.
        let folder = tempfile::tempdir().unwrap();
        let variables = [("POCL_CACHE_DIR", folder.path()), ("RAREFY_CACHE_DIR", folder.path())];
        let arguments = ["render", "spheres", "--device", "opencl", "--size", "64x48", "-o", "a.png"];
        let run = interrupted(folder.path(), &arguments, &variables, Duration::from_millis(pause)).expect(130);
        // PoCL says itself that its compiler failed.
        assert!(run.stderr.ends_with("rarefy: interrupted\n"), "{}", run.stderr);
        assert_eq!(run.stderr.matches("rarefy").count(), 1, "{}", run.stderr);
        assert!(!folder.path().join("a.png").exists());
    }
}

#[test]
fn a_command_without_an_interrupt_ends_as_ever() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = ["render", "spheres", "--device", "cpu", "--size", "40x30", "-o", "a.png"];
    rarefy_host_tests::command::rarefy_in(folder.path(), &arguments, &[]).expect(0);
    assert!(folder.path().join("a.png").is_file());
}
