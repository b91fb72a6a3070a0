// SPDX-License-Identifier: MIT OR Apache-2.0
//! The built `rarefy` command, run as a user runs it.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The repository's root.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().to_path_buf()
}

/// Path of the built command, beside the folder of the test executable: `target/PROFILE/rarefy`.
///
/// # Panics
/// If it is not built.
pub fn executable() -> PathBuf {
    let test = std::env::current_exe().unwrap();
    let profile = test.parent().and_then(Path::parent).unwrap();
    let path = profile.join(format!("rarefy{}", std::env::consts::EXE_SUFFIX));
    assert!(path.is_file(), "{} is not there: run `cargo build` first", path.display());
    path
}

/// What a run of the command came to.
#[derive(Debug)]
pub struct Run {
    /// Exit status; -1 if a signal ended it.
    pub status: i32,
    /// Standard output.
    pub stdout: String,
    /// Standard error.
    pub stderr: String,
}

/// Runs `rarefy` in `folder`. No variable that the tests are run with changes which device is chosen.
pub fn rarefy_in(folder: &Path, arguments: &[&str], variables: &[(&str, &str)]) -> Run {
    let mut command = Command::new(executable());
    command.args(arguments).current_dir(folder);
    command.envs(variables.iter().copied());
    let Output { status, stdout, stderr } = command.output().unwrap();
    Run {
        status: status.code().unwrap_or(-1),
        stdout: String::from_utf8(stdout).unwrap(),
        stderr: String::from_utf8(stderr).unwrap(),
    }
}

impl Run {
    /// Demands exit status `status`.
    #[track_caller]
    pub fn expect(self, status: i32) -> Self {
        assert_eq!(self.status, status, "stdout:\n{}\nstderr:\n{}", self.stdout, self.stderr);
        self
    }

    /// Demands exit status 2 and one line on standard error beside warnings, one that holds every one of `parts`.
    #[track_caller]
    pub fn expect_error(self, parts: &[&str]) -> Self {
        let run = self.expect(2);
        let lines: Vec<&str> = run.stderr.lines().filter(|line| !line.starts_with("warning: ")).collect();
        assert!(lines.len() == 1 && lines[0].starts_with("rarefy: "), "not one line:\n{}", run.stderr);
        for part in parts {
            assert!(run.stderr.contains(part), "`{part}` is not in the message:\n{}", run.stderr);
        }
        run
    }
}
