// SPDX-License-Identifier: MIT OR Apache-2.0
//! The JNI library in a desktop Java VM: it loads, registers its natives, and turns errors and panics into exceptions.
//!
//! Java runs as a child process with `-Xcheck:jni`, which reports broken JNI rules. The libraries must have been built:
//! `cargo build --workspace` makes the library and `cargo test --workspace` the probe; `./test.sh` runs both.
//! Without a JDK these tests fail, unless the environment says `RAREFY_TEST_JVM=none`.

#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::SystemTime;

/// The repository's root.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().to_path_buf()
}

/// The Java tools of this machine.
struct Jdk {
    javac: PathBuf,
    java: PathBuf,
    /// Keeps signal handlers in order between the Java VM and libraries that install their own; part of most JDKs.
    libjsig: Option<PathBuf>,
}

impl Jdk {
    /// The JDK in `JAVA_HOME`, else on `PATH`; `None` if the environment waives these tests.
    fn find() -> Option<Jdk> {
        if std::env::var_os("RAREFY_TEST_JVM").is_some_and(|v| v == "none") {
            println!("skipped: RAREFY_TEST_JVM=none");
            return None;
        }
        let mut folders = Vec::new();
        folders.extend(std::env::var_os("JAVA_HOME").map(|home| Path::new(&home).join("bin")));
        folders.extend(std::env::var_os("PATH").iter().flat_map(std::env::split_paths));
        let Some(javac) = folders.iter().map(|folder| folder.join("javac")).find(|file| file.is_file()) else {
            panic!(
                "no JDK: `javac` is neither in JAVA_HOME nor on PATH. Install one (Debian, Ubuntu: \
                 `apt-get install default-jdk-headless`) or waive these tests with RAREFY_TEST_JVM=none"
            );
        };
        // The real folder of the JDK, behind the links in /usr/bin: it holds a matching `java` and libjsig.
        let bin = javac.canonicalize().unwrap().parent().unwrap().to_path_buf();
        let libjsig = bin.parent().map(|home| home.join("lib/libjsig.so")).filter(|file| file.is_file());
        Some(Jdk { javac, java: bin.join("java"), libjsig })
    }

    /// Compiles `sources` into `classes`, with every warning an error, as Java 8 (what Android takes everywhere).
    fn compile(&self, sources: &[PathBuf], classes: &Path) {
        let mut javac = Command::new(&self.javac);
        javac.args(["--release", "8", "-Xlint:all,-options", "-Werror", "-d"]).arg(classes).args(sources);
        let output = javac.output().unwrap();
        assert!(output.status.success(), "{javac:?}\n{}", String::from_utf8_lossy(&output.stderr));
    }

    /// Runs `class` under `-Xcheck:jni`; returns all that it printed.
    fn run(&self, classes: &Path, library: &Path, class: &str) -> String {
        let mut java = Command::new(&self.java);
        if let Some(libjsig) = &self.libjsig {
            java.env("LD_PRELOAD", libjsig);
        }
        let mut property = std::ffi::OsString::from("-Ddev.rarefy.library=");
        property.push(library);
        java.args(["-Xcheck:jni", "-Xshare:auto", "-Dfile.encoding=UTF-8"]).arg(property);
        java.arg("-cp").arg(classes).arg(class);
        let output = java.output().unwrap();
        let mut text = String::from_utf8_lossy(&output.stdout).into_owned();
        text += &String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{java:?}: {}\n{text}", output.status);
        text
    }
}

/// A library that cargo built beside this test, not older than its sources.
fn built_library(name: &str) -> PathBuf {
    let test = std::env::current_exe().unwrap();
    let folder = test.parent().unwrap().parent().unwrap();
    let library = folder.join(name);
    let remedy = "build it: `cargo build --workspace && cargo build --workspace --examples` (with --release for a \
                  release test)";
    let Ok(built) = library.metadata().and_then(|m| m.modified()) else {
        panic!("{} is not here; {remedy}", library.display());
    };
    for folder in ["android/jni/src", "android/jni/examples"] {
        for source in root().join(folder).read_dir().unwrap() {
            let source = source.unwrap();
            let changed: SystemTime = source.metadata().unwrap().modified().unwrap();
            let part_of_it = folder.ends_with("src") || name.contains("probe");
            let stale = part_of_it && changed > built;
            assert!(!stale, "{} is older than {}; {remedy}", library.display(), source.path().display());
        }
    }
    library
}

/// What `-Xcheck:jni` found wrong; it does not change the exit status.
fn jni_complaints(output: &str) -> Vec<&str> {
    const MARKS: [&str; 4] = ["WARNING in native", "FATAL ERROR", "WARNING: JNI", "handler was modified"];
    output.lines().filter(|line| MARKS.iter().any(|mark| line.contains(mark))).collect()
}

/// Writes `text` as `NAME.java` into `folder`.
fn java_file(folder: &Path, name: &str, text: &str) -> PathBuf {
    let file = folder.join(format!("{name}.java"));
    std::fs::write(&file, text).unwrap();
    file
}

#[test]
fn version_through_java() {
    let Some(jdk) = Jdk::find() else { return };
    let library = built_library("librarefy_jni.so");
    let folder = tempfile::tempdir().unwrap();
    let main = java_file(
        folder.path(),
        "VersionMain",
        r#"package dev.rarefy;
        final class VersionMain {
            public static void main(String[] arguments) throws Exception {
                Thread other = new Thread(() -> System.out.println("other thread: " + Native.version()));
                other.start();
                other.join();
                System.out.println("version: " + Native.version());
            }
        }"#,
    );
    let native = root().join("android/library/src/main/java/dev/rarefy/Native.java");
    jdk.compile(&[native, main], folder.path());
    let output = jdk.run(folder.path(), &library, "dev.rarefy.VersionMain");
    let version = env!("CARGO_PKG_VERSION");
    let lines: Vec<&str> = output.lines().collect();
    assert!(lines.contains(&format!("version: {version}").as_str()), "{output}");
    assert!(lines.contains(&format!("other thread: {version}").as_str()), "{output}");
    assert!(jni_complaints(&output).is_empty(), "{output}");
}

#[test]
fn a_class_that_does_not_fit_is_refused_with_the_reason() {
    let Some(jdk) = Jdk::find() else { return };
    let library = built_library("librarefy_jni.so");
    let folder = tempfile::tempdir().unwrap();
    let main = java_file(
        folder.path(),
        "Native",
        r#"package dev.rarefy;
        final class Native {
            static native int version();
            public static void main(String[] arguments) {
                try {
                    System.load(System.getProperty("dev.rarefy.library"));
                    System.out.println("loaded");
                } catch (UnsatisfiedLinkError e) {
                    System.out.println("refused: " + e.getMessage());
                }
            }
        }"#,
    );
    jdk.compile(&[main], folder.path());
    let output = jdk.run(folder.path(), &library, "dev.rarefy.Native");
    let refused = output.lines().find(|line| line.starts_with("refused: ")).unwrap_or_else(|| panic!("{output}"));
    assert!(refused.contains("dev/rarefy/Native") && refused.contains("version"), "{output}");
}

#[test]
fn errors_and_panics_become_exceptions_with_their_text() {
    let Some(jdk) = Jdk::find() else { return };
    let library = built_library("examples/libguard_probe.so");
    let folder = tempfile::tempdir().unwrap();
    let probe = java_file(
        folder.path(),
        "GuardProbe",
        r#"package dev.rarefy;
        final class GuardProbe {
            static native int fail(String text);
            static native int panic(String text);
            static native int callWithExceptionPending();

            interface Call { int run(); }

            static void report(String name, Call call) {
                try {
                    System.out.println(name + ": returned " + call.run());
                } catch (Throwable e) {
                    String text = String.valueOf(e.getMessage()).replace('\u00fc', '?').replace("\ud83d\ude42", "!");
                    System.out.println(name + ": " + e.getClass().getName() + ": " + text);
                }
            }

            public static void main(String[] arguments) {
                System.load(System.getProperty("dev.rarefy.library"));
                if (arguments.length == 0) {
                    report("error", () -> fail("gr\u00fcn \ud83d\ude42"));
                    report("panic", () -> panic("index 7"));
                    report("null", () -> fail(null));
                    report("again", () -> fail("still alive"));
                }
            }
        }"#,
    );
    let bad = java_file(
        folder.path(),
        "BadMain",
        r#"package dev.rarefy;
        final class BadMain {
            public static void main(String[] arguments) {
                GuardProbe.main(new String[] {"quiet"});
                GuardProbe.report("bad", () -> GuardProbe.callWithExceptionPending());
            }
        }"#,
    );
    jdk.compile(&[probe, bad], folder.path());

    let output = jdk.run(folder.path(), &library, "dev.rarefy.GuardProbe");
    let lines: Vec<&str> = output.lines().collect();
    for wanted in [
        "error: java.lang.IllegalStateException: --probe: gr?n !",
        "panic: java.lang.Error: internal error in Rarefy: index 7",
        "again: java.lang.IllegalStateException: --probe: still alive",
    ] {
        assert!(lines.contains(&wanted), "missing: {wanted}\n{output}");
    }
    assert!(lines.iter().any(|line| line.starts_with("null: java.lang.")), "{output}");
    assert!(!output.contains("returned"), "{output}");
    assert!(jni_complaints(&output).is_empty(), "{output}");

    // The control: a native method that breaks a rule of JNI is noticed.
    let output = jdk.run(folder.path(), &library, "dev.rarefy.BadMain");
    assert!(!jni_complaints(&output).is_empty(), "{output}");
}
