// SPDX-License-Identifier: MIT OR Apache-2.0
//! What is compiled by clang: kernels, for a 32-bit target as on the phone, without any device; and OpenCL libraries with faults.
#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use crate::command::root;

/// Without clang these tests fail, unless this variable says `none`.
pub const WITHOUT: &str = "RAREFY_TEST_CLANG";

/// A clang that knows the target; `None` where tests that need one are waived.
///
/// # Panics
/// If there is none.
pub fn clang() -> Option<&'static str> {
    if std::env::var(WITHOUT).is_ok_and(|value| value == "none") {
        println!("skipped: {WITHOUT}=none");
        return None;
    }
    let runs = |name: &&str| Command::new(name).arg("--version").output().is_ok_and(|o| o.status.success());
    let found = ["clang-14", "clang-15", "clang-16", "clang"].into_iter().find(runs);
    Some(
        found.unwrap_or_else(|| panic!("no clang here: install it (`apt-get install clang-14`) or set {WITHOUT}=none")),
    )
}

/// Compiles `file` to nothing.
///
/// # Errors
/// What the compiler said.
pub fn check(clang: &str, file: &Path, options: &str) -> Result<(), String> {
    run(clang, file, options, &["-fsyntax-only"]).map(|_| ())
}

/// The intermediate code of `file`, optimised, as text.
///
/// # Errors
/// What the compiler said.
pub fn intermediate_code(clang: &str, file: &Path, options: &str) -> Result<String, String> {
    run(clang, file, options, &["-O2", "-S", "-emit-llvm", "-o", "-"])
}

/// A library of what `linked` names and of `source`, a file in `host-tests/drivers`.
///
/// # Panics
/// Without clang, and if it does not compile.
pub fn driver_library(source: &str, linked: &[&str]) -> PathBuf {
    static FOLDER: OnceLock<tempfile::TempDir> = OnceLock::new();
    let folder = FOLDER.get_or_init(|| tempfile::tempdir().unwrap()).path();
    let built = folder.join(format!("lib{}-{:?}.so", source.replace('.', "-"), std::thread::current().id()));
    let output = Command::new(clang().unwrap())
        .args(["-std=gnu11", "-Wall", "-Wextra", "-Wno-unused-parameter", "-Werror", "-shared", "-fPIC", "-o"])
        .arg(&built)
        .arg(root().join("host-tests/drivers").join(source))
        .args(linked)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    built
}

fn run(clang: &str, file: &Path, options: &str, what: &[&str]) -> Result<String, String> {
    // spir: 32-bit sizes as on the phone. Of all extensions only those that OpenCL 1.2 has in its core.
    let output = Command::new(clang)
        .current_dir(root())
        .args("-x cl -cl-std=CL1.2 --target=spir-unknown-unknown -Xclang -finclude-default-header".split(' '))
        .arg("-Xclang")
        .arg(
            "-cl-ext=-all,+cl_khr_global_int32_base_atomics,+cl_khr_local_int32_base_atomics,\
             +cl_khr_byte_addressable_store",
        )
        .args("-Werror -Wall -Wextra -Wdouble-promotion -Wno-unused-function -Wno-gnu".split(' '))
        // Every function takes the whole scene, so that argument lists are alike.
        .arg("-Wno-unused-parameter")
        .arg("-Ikernels")
        .args(what)
        .args(options.split(' '))
        .arg(file)
        .output()
        .unwrap();
    if output.status.success() {
        Ok(String::from_utf8(output.stdout).unwrap())
    } else {
        Err(String::from_utf8_lossy(&output.stderr).into_owned())
    }
}
