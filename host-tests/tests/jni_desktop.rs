// SPDX-License-Identifier: MIT OR Apache-2.0
//! The Java API in a desktop Java VM, with the library that cargo built: pictures, misuse, threads, errors, panics.
//!
//! The tests themselves are Java programs, in `android/library/src/test`; android/check.sh runs the same ones with the
//! library that ships. Java runs as a child process with `-Xcheck:jni`, which reports broken JNI rules.
//! The libraries must have been built: `cargo build --workspace` makes the library and `cargo test --workspace` the probe;
//! `./test.sh` runs both. Without a JDK these tests fail, unless the environment says `RAREFY_TEST_JVM=none`.

#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};
use std::process::Output;
use std::sync::OnceLock;

use rarefy_host_tests::clang::{clang, driver_library};
use rarefy_host_tests::command::{rarefy_in, root};
use rarefy_host_tests::frames::no_opencl;
use rarefy_host_tests::jdk::{self, all_text, built_library, java_files, jni_complaints};

/// The Java tools, for the library's own tests.
struct Jdk(jdk::Jdk);

impl Jdk {
    fn find() -> Option<Jdk> {
        jdk::Jdk::find().map(Jdk)
    }

    fn compile(&self, sources: &[PathBuf], classes: &Path) {
        self.0.compile(sources, classes);
    }

    /// Runs a class of `dev.rarefy` under `-Xcheck:jni`; returns all that it printed.
    fn run(&self, classes: &Path, class: &str, arguments: &[&str], variables: &[(&str, &str)]) -> String {
        let output = self.output(classes, class, arguments, variables);
        let text = all_text(&output);
        assert!(output.status.success(), "{class}: {}\n{text}", output.status);
        text
    }

    /// As [`Jdk::run`], whatever becomes of it.
    fn output(&self, classes: &Path, class: &str, arguments: &[&str], variables: &[(&str, &str)]) -> Output {
        let probe = built_library("examples/libguard_probe.so");
        let properties = [("dev.rarefy.probe", &*probe), ("dev.rarefy.classes", self::classes(self))];
        self.0.output(classes, &format!("dev.rarefy.{class}"), &properties, arguments, variables)
    }

    /// Runs one of the Java tests, which must come to its end and break no rule of JNI.
    #[track_caller]
    fn test(&self, class: &str, arguments: &[&str], variables: &[(&str, &str)]) -> String {
        self.test_in(classes(self), class, arguments, variables)
    }

    /// Runs one of the Java tests in a class loader like an app's.
    #[track_caller]
    fn test_as_app(&self, class: &str, arguments: &[&str]) {
        let folder = tempfile::tempdir().unwrap();
        self.compile(&[root().join("android/library/src/test/java/dev/rarefy/ChildLoader.java")], folder.path());
        self.test_in(folder.path(), "ChildLoader", &[&[class], arguments].concat(), &[]);
    }

    #[track_caller]
    fn test_in(&self, classes: &Path, class: &str, arguments: &[&str], variables: &[(&str, &str)]) -> String {
        let output = self.run(classes, class, arguments, variables);
        assert!(output.lines().any(|line| line == "done"), "{output}");
        assert!(jni_complaints(&output).is_empty(), "{output}");
        output
    }
}

/// The library and its tests, compiled once.
fn classes(jdk: &Jdk) -> &'static Path {
    static CLASSES: OnceLock<tempfile::TempDir> = OnceLock::new();
    let folder = CLASSES.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        let mut sources = java_files("android/library/annotations/org/jspecify/annotations");
        sources.extend(java_files("android/library/src/main/java/dev/rarefy"));
        sources.extend(java_files("android/library/src/test/java/dev/rarefy"));
        jdk.compile(&sources, folder.path());
        folder
    });
    folder.path()
}

/// Writes `text` as `NAME.java` into `folder`.
fn java_file(folder: &Path, name: &str, text: &str) -> PathBuf {
    let file = folder.join(format!("{name}.java"));
    std::fs::write(&file, text).unwrap();
    file
}

/// A built-in scene as files.
fn spheres(folder: &Path) -> String {
    rarefy_in(folder, &["make-scene", "spheres", "-o", "spheres"], &[]).expect(0);
    folder.join("spheres").to_str().unwrap().to_owned()
}

/// Java's pictures on `device` are those of the command.
fn pictures_are_the_commands(device: &str) {
    let Some(jdk) = Jdk::find() else { return };
    let folder = tempfile::tempdir().unwrap();
    let scene = spheres(folder.path());
    rarefy_in(folder.path(), &["bake", &scene, "-o", "baked"], &[]).expect(0);
    let baked = folder.path().join("baked");
    let arguments = [device, &scene, baked.to_str().unwrap(), folder.path().to_str().unwrap()];
    let output = jdk.test("PictureTest", &arguments, &[]);
    assert!(output.contains(&format!("device: {device}")), "{output}");
    let paper = "--method paper --t-pos 0.01 --t-norm 0.95 --t-conv 0.1 --t-tex 0.25 --t-gcol 0.1 --disable-test gc \
                 --correction object";
    for (name, size, options) in [
        ("balanced", "96x64", ""),
        ("fast", "61x43", "--method fast --samples 2"),
        ("paper", "96x64", paper),
        ("full", "96x64", "--mode full --depth 2"),
    ] {
        let file = format!("{name}.png");
        let mut arguments =
            vec!["render", &scene, "-o", &file, "--size", size, "--device", device, "--build", "strict"];
        arguments.extend(options.split_whitespace());
        rarefy_in(folder.path(), &arguments, &[]).expect(0);
        let wanted = image::open(folder.path().join(&file)).unwrap().to_rgba8().into_raw();
        let got = std::fs::read(folder.path().join(name)).unwrap();
        assert!(wanted == got, "{name}: Java's picture is not the command's");
    }
}

#[test]
fn pictures_on_the_cpu_are_the_commands() {
    pictures_are_the_commands("cpu");
}

#[test]
fn pictures_on_opencl_are_the_commands() {
    if !no_opencl() {
        pictures_are_the_commands("opencl");
    }
}

#[test]
fn whatever_is_done_wrong_gives_its_exception() {
    let Some(jdk) = Jdk::find() else { return };
    let folder = tempfile::tempdir().unwrap();
    jdk.test("MisuseTest", &[folder.path().to_str().unwrap()], &[]);
}

#[test]
fn the_camera_moves_as_it_says() {
    let Some(jdk) = Jdk::find() else { return };
    jdk.test("CameraTest", &[], &[]);
}

#[test]
fn eight_threads_at_once_and_fifty_rounds() {
    let Some(jdk) = Jdk::find() else { return };
    jdk.test("ThreadsTest", &["cpu", "50"], &[]);
}

#[test]
#[ignore = "long: a thousand rounds of opening, drawing and closing on the CPU and on OpenCL"]
fn a_thousand_rounds_leave_nothing_behind() {
    let Some(jdk) = Jdk::find() else { return };
    jdk.test("ThreadsTest", &["cpu", "1000"], &[]);
    if !no_opencl() {
        jdk.test("ThreadsTest", &["opencl", "1000"], &[]);
    }
}

#[test]
fn without_opencl_the_cpu_draws_and_says_so() {
    let Some(jdk) = Jdk::find() else { return };
    let nowhere = tempfile::tempdir().unwrap();
    jdk.test("NoOpenClTest", &[], &[("OCL_ICD_VENDORS", nowhere.path().to_str().unwrap())]);
}

#[test]
fn an_app_names_its_opencl_and_asks_for_a_retry_after_a_crash() {
    let Some(jdk) = Jdk::find() else { return };
    if no_opencl() || clang().is_none() {
        return;
    }
    let library = driver_library("bad_driver.c", &["-l:libOpenCL.so.1", "-ldl"]);
    let library = library.to_str().unwrap();
    let caches = tempfile::tempdir().unwrap();
    let caches = caches.path().to_str().unwrap();
    let start = |fault: &str, retry: &str| {
        let variables = [("BAD_DRIVER", fault), ("OPENCL_DYLIB_PATH", "/nonexistent/libX.so")];
        let output = jdk.output(classes(&jdk), "BadDriverTest", &[library, caches, retry], &variables);
        (output.status.code(), all_text(&output))
    };
    let (status, text) = start("compiler-exits", "false");
    assert_eq!(status, Some(7), "the driver calls exit: {text}");
    // Remembered: the driver is not asked again, not even a mended one, until the app says so.
    for (fault, retry, parts) in [
        ("compiler-exits", "false", &["backend: cpu\n", "passed over: DRIVER_CRASHED: "][..]),
        ("none", "false", &["backend: cpu\n", "passed over: DRIVER_CRASHED: "]),
        ("none", "true", &["backend: opencl\n"]),
        ("none", "false", &["backend: opencl\n"]),
    ] {
        let (status, text) = start(fault, retry);
        assert_eq!(status, Some(0), "{fault}, {retry}: {text}");
        for part in parts.iter().copied().chain([&format!("library: {library}\n") as &str, "done\n"]) {
            assert!(text.contains(part), "{fault}, {retry}: no `{part}` in {text}");
        }
        assert!(jni_complaints(&text).is_empty(), "{text}");
    }
    assert!(!start("none", "false").1.contains("passed over: "));
}

#[test]
fn errors_and_panics_become_exceptions_with_their_text() {
    let Some(jdk) = Jdk::find() else { return };
    // On a phone, an app's classes are in a class loader of their own, which threads of Rust do not know.
    jdk.test_as_app("GuardProbe", &[]);
    jdk.test("GuardProbe", &[], &[]);
    // The control: a native method that breaks a rule of JNI is noticed.
    let output = jdk.run(classes(&jdk), "GuardProbe", &["broken"], &[]);
    assert!(!jni_complaints(&output).is_empty(), "{output}");
}

#[test]
fn an_apps_class_loader_will_do() {
    let Some(jdk) = Jdk::find() else { return };
    let folder = tempfile::tempdir().unwrap();
    jdk.test_as_app("MisuseTest", &[folder.path().to_str().unwrap()]);
}

#[test]
fn classes_that_do_not_fit_are_refused_with_the_reason() {
    let Some(jdk) = Jdk::find() else { return };
    let drifted = |class: &str, from: &str, to: &str| {
        let folder = tempfile::tempdir().unwrap();
        let copy = folder.path().join("dev/rarefy");
        std::fs::create_dir_all(&copy).unwrap();
        let mut sources = java_files("android/library/annotations/org/jspecify/annotations");
        for file in java_files("android/library/src/main/java/dev/rarefy") {
            let name = file.file_stem().unwrap().to_str().unwrap();
            let mut text = std::fs::read_to_string(&file).unwrap();
            if name == class {
                assert!(text.contains(from), "{class}: {from}");
                text = text.replace(from, to);
            }
            sources.push(java_file(&copy, name, &text));
        }
        sources.push(java_file(
            &copy,
            "Refused",
            r#"package dev.rarefy;
            final class Refused {
                public static void main(String[] arguments) {
                    try {
                        System.out.println("loaded " + Native.version());
                    } catch (UnsatisfiedLinkError e) {
                        System.out.println("refused: " + e.getMessage());
                    }
                }
            }"#,
        ));
        jdk.compile(&sources, folder.path());
        jdk.run(folder.path(), "Refused", &[], &[])
    };
    let output = drifted("Native", "static native String version()", "static native String version()");
    assert!(output.contains("loaded "), "{output}");
    for (class, from, to, part) in [
        ("Native", "static native void cancel(long handle)", "static native int cancel(long handle)", "cancel"),
        ("Native", "[] readAsset(", "[] readAssets(", "readAsset"),
        ("FrameStats", "double frameMillis,\n", "float frameMillis,\n", "<init>"),
        ("ProgressListener", "float share", "double share", "onProgress"),
    ] {
        let output = drifted(class, from, to);
        let refused = output.lines().find(|line| line.starts_with("refused: ")).unwrap_or_else(|| panic!("{output}"));
        assert!(refused.contains(part), "{class}: {output}");
    }
}

/// The lines of README's only example in `language`, which must stand in `file` as they are.
fn example(language: &str, file: &str) {
    let text = |path: &str| std::fs::read_to_string(root().join(path)).unwrap();
    let readme = text("README.md");
    let (_, rest) =
        readme.split_once(&format!("```{language}\n")).unwrap_or_else(|| panic!("no example in {language}"));
    let lines = |text: &str| text.trim().lines().map(|line| line.trim().to_owned()).collect::<Vec<_>>();
    let (wanted, found) = (lines(rest.split_once("```").unwrap().0), lines(&text(file)));
    assert_eq!(wanted.len(), 5, "README promises five lines: {wanted:?}");
    assert!(found.windows(5).any(|five| five == wanted), "{file} has not README's example: {wanted:?}");
}

#[test]
fn the_examples_of_the_readme_run() {
    let Some(jdk) = Jdk::find() else { return };
    example("java", "android/library/src/test/java/dev/rarefy/Hello.java");
    // android/check.sh compiles and runs this one, with a compiler of Maven Central's.
    example("kotlin", "android/library/src/kotlin/Use.kt");
    let output = jdk.run(classes(&jdk), "Hello", &[], &[]);
    assert!(output.contains("640x480 in ") && output.contains(" % traced"), "{output}");
    assert!(jni_complaints(&output).is_empty(), "{output}");
}
