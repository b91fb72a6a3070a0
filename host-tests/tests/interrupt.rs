// SPDX-License-Identifier: MIT OR Apache-2.0
//! Ctrl-C ends the command cleanly: status 130, one line, no half-written file.
#![cfg(unix)]
#![allow(clippy::unwrap_used, missing_docs)]

use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use rarefy_host_tests::command::{Run, executable};

const SIGINT_BIT: u64 = 1 << 1;

/// Whether the process has taken Ctrl-C over; where the system does not tell, after a while.
fn catches_interrupts(process: &Child) -> bool {
    match std::fs::read_to_string(format!("/proc/{}/status", process.id())) {
        Ok(status) => {
            let caught = status.lines().find_map(|line| line.strip_prefix("SigCgt:")).unwrap_or("0");
            u64::from_str_radix(caught.trim(), 16).unwrap() & SIGINT_BIT != 0
        }
        Err(_) => {
            std::thread::sleep(Duration::from_secs(2));
            true
        }
    }
}

/// Starts the command, sends it SIGINT `pause` after it takes that, and waits for its end.
fn interrupted(folder: &Path, arguments: &[&str], pause: Duration) -> Run {
    let mut command = Command::new(executable());
    command.args(arguments).current_dir(folder).stdout(Stdio::piped()).stderr(Stdio::piped());
    let process = command.spawn().unwrap();
    while !catches_interrupts(&process) {
        std::thread::sleep(Duration::from_millis(2));
    }
    std::thread::sleep(pause);
    let sent = Command::new("kill").args(["-INT", &process.id().to_string()]).status().unwrap();
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
            let run = interrupted(folder.path(), &arguments, Duration::from_millis(pause)).expect(130);
            assert_eq!((run.stdout.as_str(), run.stderr.as_str()), ("", "rarefy: interrupted\n"), "{arguments:?}");
        }
    }
    // `compare` makes its folder first; no file is there, not even a temporary one.
    let left: Vec<_> = folder.path().read_dir().unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left, ["pictures"]);
    assert_eq!(folder.path().join("pictures").read_dir().unwrap().count(), 0);
}

#[test]
fn a_command_without_an_interrupt_ends_as_ever() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = ["render", "spheres", "--device", "cpu", "--size", "40x30", "-o", "a.png"];
    rarefy_host_tests::command::rarefy_in(folder.path(), &arguments, &[]).expect(0);
    assert!(folder.path().join("a.png").is_file());
}
