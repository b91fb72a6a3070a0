// SPDX-License-Identifier: MIT OR Apache-2.0
//! The demo app in a desktop Java VM with Android's own framework and drawing code: are its screens as stored, readable, and clear of
//! the system's bars; do touches, rotation, background, a lost surface and the end of the process do what they should?
//!
//! The tests themselves are Java, in `android/demo/src/screens`; `android/screens.sh` compiles and runs them with the library that
//! cargo built. They need a JDK and files of Maven Central and PyPI, about 700 MB, once. Without a JDK they fail, unless the
//! environment says `RAREFY_TEST_JVM=none`; where those files cannot be had, `RAREFY_TEST_SCREENS=none` waives these alone.

#![allow(clippy::unwrap_used)]

use std::process::Command;

use rarefy_host_tests::command::{executable, root};

/// Runs a part of the screens' tests, of which there must be at least `least`.
fn screens(part: &str, least: usize) {
    for variable in ["RAREFY_TEST_JVM", "RAREFY_TEST_SCREENS"] {
        if std::env::var_os(variable).is_some_and(|value| value == "none") {
            println!("skipped: {variable}=none");
            return;
        }
    }
    let library = executable().with_file_name("librarefy_jni.so");
    assert!(library.is_file(), "{} is not here; build it: `cargo build --workspace`", library.display());
    let output = Command::new(root().join("android/screens.sh")).arg(part).arg(library).output().unwrap();
    let text = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text).into_owned()).concat();
    assert!(output.status.success(), "android/screens.sh {part}:\n{text}");
    let passed = text.split_once("OK (").and_then(|(_, rest)| rest.split_once(" test")?.0.parse::<usize>().ok());
    assert!(passed.is_some_and(|passed| passed >= least), "android/screens.sh {part} ran too few tests:\n{text}");
}

#[test]
fn the_first_screens_are_as_stored_and_a_finger_turns_the_camera() {
    screens("quick", 3);
}

#[test]
#[ignore = "long: every screen of the demo app, on Android 6, 14 and 15"]
fn every_screen_and_what_android_does_to_an_app() {
    screens("long", 27);
}
