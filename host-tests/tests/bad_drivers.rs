// SPDX-License-Identifier: MIT OR Apache-2.0
//! Drivers with faults that phones have: whatever they do, a later start ends with the right picture. docs/drivers.md has
//! the reports; `host-tests/drivers/bad_driver.c` has the faults, as a library before the system's OpenCL.
//!
//! Every start is a process of its own, since some of them die.
#![allow(clippy::unwrap_used, missing_docs)]

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;

use rarefy::{
    CacheFolder, DeviceChoice, DeviceOptions, Error, Keep, Method, Monitor, PreparedScene, RenderOptions, Renderer,
    Shading, builtin,
};
use rarefy_host_tests::clang::{clang, driver_library};
use rarefy_host_tests::frames::no_opencl;

/// Set in the processes that tests start: the folder of their caches.
const CHILD: &str = "RAREFY_TEST_CHILD_CACHE";

/// What a start came to.
#[derive(Debug)]
struct Start {
    /// Exit status; `None`: a signal ended it.
    status: Option<i32>,
    text: String,
    /// The programs that the driver built, in order.
    builds: Vec<String>,
}

impl Start {
    /// Demands a right picture from `backend`, with each of `parts` in what was said.
    #[track_caller]
    fn draws_on(&self, backend: &str, parts: &[&str]) {
        let (drawn, right) = (format!("backend: {backend}\n"), "picture: right\n");
        for part in [&drawn as &str, right].iter().chain(parts) {
            assert!(self.status == Some(0) && self.text.contains(part), "`{part}` is not in: {self:?}");
        }
    }

    fn built(&self, line: &str) -> usize {
        self.builds.iter().filter(|build| *build == line).count()
    }
}

/// A driver with a fault, and caches that last from start to start.
struct Driver {
    library: PathBuf,
    folder: tempfile::TempDir,
    variables: Vec<(&'static str, String)>,
}

impl Driver {
    /// `None` where there is no OpenCL or no compiler to build the library with.
    fn with(fault: &str) -> Option<Self> {
        if no_opencl() || clang().is_none() {
            return None;
        }
        let library = driver_library("bad_driver.c", &["-l:libOpenCL.so.1", "-ldl"]);
        let variables = vec![("BAD_DRIVER", fault.to_owned())];
        Some(Driver { library, folder: tempfile::tempdir().unwrap(), variables })
    }

    fn set(mut self, name: &'static str, value: &str) -> Self {
        self.variables.retain(|(set, _)| *set != name);
        self.variables.push((name, value.to_owned()));
        self
    }

    fn start(&self) -> Start {
        self.start_with(&[])
    }

    fn start_with(&self, more: &[(&str, &str)]) -> Start {
        let log = self.folder.path().join("log");
        let _ = std::fs::remove_file(&log);
        let mut command = Command::new(std::env::current_exe().unwrap());
        command.args(["child_start", "--exact", "--ignored", "--nocapture", "--test-threads", "1"]);
        command.env(CHILD, self.folder.path().join("cache")).env("BAD_DRIVER_LOG", &log);
        command.env("OPENCL_DYLIB_PATH", &self.library);
        command.envs(self.variables.iter().map(|(name, value)| (*name, value.as_str())));
        command.envs(more.iter().copied());
        let output = command.output().unwrap();
        let text = format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
        let builds = std::fs::read_to_string(&log).unwrap_or_default();
        Start { status: output.status.code(), text, builds: builds.lines().map(str::to_owned).collect() }
    }

    fn files(&self, suffix: &str) -> usize {
        let files = std::fs::read_dir(self.folder.path().join("cache")).into_iter().flatten();
        files.filter(|file| file.as_ref().unwrap().path().extension().is_some_and(|of| of == suffix)).count()
    }
}

/// One start of an app: opens what there is, draws, and says what came of it.
#[test]
#[ignore = "a process that other tests start"]
fn child_start() {
    let Some(cache) = std::env::var_os(CHILD) else { return };
    let is = |name: &str, value: &str| std::env::var(name).is_ok_and(|set| set == value);
    let options = DeviceOptions {
        device: if is("DEVICE", "opencl") { DeviceChoice::OpenCl(None) } else { DeviceChoice::Auto },
        // Equal to the twin bit for bit.
        strict: true,
        cache: CacheFolder::At(PathBuf::from(cache)),
        retry_crashed: is("RETRY", "yes"),
        opencl_library: std::env::var_os("LIBRARY").map(PathBuf::from),
        ..DeviceOptions::default()
    };
    let scene = std::env::var("SCENE").unwrap_or("spheres".into());
    let prepared = PreparedScene::new(&builtin(&scene).unwrap(), Shading::Full, &Monitor::default()).unwrap();
    let prepared = Arc::new(prepared);
    let cpu = DeviceOptions { device: DeviceChoice::Cpu, ..DeviceOptions::default() };
    let mut right = Renderer::new(prepared.clone(), &cpu, &Monitor::default()).unwrap();
    let mut renderer = match Renderer::new(prepared, &options, &Monitor::default()) {
        Ok(renderer) => renderer,
        Err(error) => {
            println!("refused: {error}");
            return;
        }
    };
    println!("device: {}", renderer.info().name);
    let method = if is("METHOD", "paper") { Method::paper() } else { Method::balanced() };
    let mut is_right = true;
    for (width, height) in [(40, 30), (1, 1), (2, 1), (1, 5), (33, 7)] {
        let size = RenderOptions { width, height, method, ..RenderOptions::default() };
        let pixels = |renderer: &mut Renderer| renderer.render(&size, Keep::default()).unwrap().pixels;
        is_right &= pixels(&mut renderer) == pixels(&mut right);
    }
    println!("backend: {}", renderer.info().backend);
    println!("picture: {}", if is_right { "right" } else { "WRONG" });
    for notice in renderer.notices() {
        println!("notice: {notice}");
    }
    for error in renderer.passed_over() {
        let kind = match error {
            Error::DriverCrashed { .. } => "crashed",
            Error::KernelBuild { .. } => "build",
            Error::SelfTest { .. } => "wrong",
            Error::NoOpenCl { .. } => "none",
            _ => "other",
        };
        println!("passed over: {kind}: {error}");
    }
    let report = rarefy::devices(&options);
    println!("library: {}", report.library.as_deref().unwrap_or("none"));
    println!("devices: {}", report.devices.len());
    for refused in &report.refused {
        println!("refused library: {}: {}", refused.path, refused.reason);
    }
    for skipped in &report.skipped {
        println!("skipped: {skipped}");
    }
}

/// The text that only the program of the ray tree has.
const TRACE: &str = "__kernel void trace(";

#[test]
fn a_sound_driver_draws_from_its_cache_and_is_never_asked_for_nothing() {
    let Some(driver) = Driver::with("none") else { return };
    driver.start().draws_on("opencl", &["devices: "]);
    assert_eq!((driver.files("marker"), driver.files("failure")), (0, 0), "notes stay");
    let again = driver.start();
    again.draws_on("opencl", &[]);
    assert!(!again.text.contains("notice: "), "{again:?}");
    assert!(again.built("binary") > 0 && again.built("build") == 0, "{again:?}");
    // A flat wall: every test holds, so that all lists of pixels to trace are empty.
    driver.start_with(&[("SCENE", "wall")]).draws_on("opencl", &[]);
}

#[test]
fn a_compiler_that_ends_the_process_is_named_at_the_next_start_and_not_asked_again() {
    let Some(driver) = Driver::with("compiler-aborts") else { return };
    let driver = driver.set("BAD_DRIVER_PROGRAM", TRACE);
    let first = driver.start();
    assert_eq!(first.status, None, "it should have died: {first:?}");
    assert_eq!(driver.files("marker"), 1);
    for _ in 0..2 {
        driver
            .start()
            .draws_on("cpu", &["notice: drawing on the CPU: ", "passed over: crashed: ", "building program `trace`"]);
    }
    // Asked for by name, it is refused, not tried.
    let refused = driver.start_with(&[("DEVICE", "opencl")]);
    assert!(refused.text.contains("refused: the process ended at an earlier start while "), "{refused:?}");
    // The memory is of this driver: a newer one is tried, and here dies as well.
    assert_eq!(driver.start_with(&[("BAD_DRIVER_VERSION", "2")]).status, None);
    assert_eq!(driver.files("marker"), 2);
    // A retry that goes well is forgiven for good.
    let mended = driver.set("BAD_DRIVER", "none");
    mended.start().draws_on("cpu", &["building program `trace`"]);
    mended.start_with(&[("RETRY", "yes")]).draws_on("opencl", &[]);
    mended.start().draws_on("opencl", &[]);
    assert_eq!(mended.files("marker"), 1, "that of the newer driver");
}

#[test]
fn a_compiler_that_dies_of_every_program_ends_one_start() {
    let Some(driver) = Driver::with("compiler-exits") else { return };
    assert_eq!(driver.start().status, Some(7), "the driver calls exit");
    driver.start().draws_on("cpu", &["passed over: crashed: ", "building program `"]);
    assert_eq!(driver.files("marker"), 1, "one program was tried");
}

#[test]
fn a_retry_that_dies_again_is_remembered_again() {
    let Some(driver) = Driver::with("compiler-exits") else { return };
    let driver = driver.set("BAD_DRIVER_PROGRAM", TRACE);
    assert_eq!(driver.start().status, Some(7), "the driver calls exit");
    driver.start().draws_on("cpu", &["passed over: crashed: ", "building program `trace`"]);
    assert_eq!(driver.start_with(&[("RETRY", "yes")]).status, Some(7));
    driver.start().draws_on("cpu", &["passed over: crashed: "]);
}

#[test]
fn a_compiler_that_works_in_kernel_creation_is_guarded_there() {
    let Some(driver) = Driver::with("late-compiler-aborts") else { return };
    let driver = driver.set("BAD_DRIVER_PROGRAM", TRACE);
    assert_eq!(driver.start().status, None);
    driver.start().draws_on("cpu", &["passed over: crashed: ", "building program `trace`"]);
}

#[test]
fn binaries_are_taken_after_kernels_exist() {
    let Some(driver) = Driver::with("late-compiler") else { return };
    driver.start().draws_on("opencl", &[]);
    let again = driver.start();
    again.draws_on("opencl", &[]);
    assert!(again.built("binary") > 0, "{again:?}");
    assert_eq!(again.built("build"), 0, "a binary was of no use: {again:?}");
}

#[test]
fn a_kernel_that_ends_the_process_is_named() {
    let Some(driver) = Driver::with("kernel-aborts") else { return };
    let driver = driver.set("BAD_DRIVER_KERNEL", "check");
    assert_eq!(driver.start().status, None);
    driver.start().draws_on("cpu", &["passed over: crashed: ", "running `step2a/check` for the first time"]);
}

#[test]
fn a_library_that_ends_the_process_is_not_opened_again() {
    let Some(driver) = Driver::with("dies-when-asked") else { return };
    assert_eq!(driver.start().status, None);
    driver.start().draws_on("cpu", &["passed over: crashed: ", "asking for devices", "skipped: the process ended"]);
    driver.set("BAD_DRIVER", "none").start_with(&[("RETRY", "yes")]).draws_on("opencl", &[]);
}

#[test]
fn builds_that_fail_are_not_repeated() {
    let Some(driver) = Driver::with("never-builds") else { return };
    let first = driver.start();
    first.draws_on("cpu", &["notice: drawing on the CPU: kernel program", "passed over: build: "]);
    assert!(first.built("build") > 0 && first.built("careful build") > 0, "both were tried: {first:?}");
    let second = driver.start();
    second.draws_on("cpu", &["as an earlier start found"]);
    assert_eq!(second.builds, [""; 0], "no build is repeated");
    // A new driver is asked, and so is the same one on demand.
    assert!(driver.start_with(&[("BAD_DRIVER_VERSION", "2")]).built("build") > 0);
    assert!(driver.start_with(&[("RETRY", "yes")]).built("build") > 0);
    let mended = driver.set("BAD_DRIVER", "none");
    mended.start().draws_on("cpu", &[]);
    mended.start_with(&[("RETRY", "yes")]).draws_on("opencl", &[]);
    mended.start().draws_on("opencl", &[]);
}

#[test]
fn what_the_usual_build_cannot_do_the_careful_one_may() {
    for fault in ["builds-without-optimisation", "out-of-host-memory"] {
        let Some(driver) = Driver::with(fault) else { return };
        let first = driver.start();
        first.draws_on("opencl", &["notice: drawing with kernels that are built with care", "passed over: build: "]);
        assert!(first.built("build") > 0, "{first:?}");
        let second = driver.start();
        second.draws_on("opencl", &["passed over: build: ", "as an earlier start found"]);
        assert!(second.built("build") == 0 && second.built("careful build") == 0, "{second:?}");
    }
}

#[test]
fn a_compiler_that_fails_in_kernel_creation_is_a_build_that_fails() {
    let Some(driver) = Driver::with("late-compiler-fails") else { return };
    driver.start().draws_on("cpu", &["passed over: build: ", "CL_OUT_OF_HOST_MEMORY"]);
    let second = driver.start();
    second.draws_on("cpu", &["as an earlier start found"]);
    assert_eq!(second.builds, [""; 0]);
}

#[test]
fn a_program_that_a_later_frame_needs_may_fail_as_well() {
    let Some(driver) = Driver::with("never-builds") else { return };
    let driver = driver.set("BAD_DRIVER_PROGRAM", "__kernel void correct_sweep(").set("METHOD", "paper");
    for _ in 0..2 {
        driver.start().draws_on("cpu", &["device: ", "on the CPU from here on: kernel program `correct_sweep`"]);
    }
    let refused = driver.start_with(&[("DEVICE", "opencl")]);
    assert!(
        refused.status == Some(101) && refused.text.contains(r#"KernelBuild { program: "correct_sweep""#),
        "{refused:?}"
    );
    // A method that does without stays on the device.
    driver.start_with(&[("METHOD", "balanced")]).draws_on("opencl", &[]);
    let driver = driver.set("BAD_DRIVER", "compiler-aborts").set("BAD_DRIVER_VERSION", "2");
    assert_eq!(driver.start().status, None);
    driver.start().draws_on("cpu", &["passed over: crashed: ", "building program `correct_sweep`"]);
    driver.start_with(&[("METHOD", "balanced")]).draws_on("opencl", &[]);
}

#[test]
fn wrong_numbers_are_seen_and_another_build_draws() {
    let Some(driver) = Driver::with("wrong-when-optimised") else { return };
    for _ in 0..2 {
        driver.start().draws_on("opencl", &["built with care", "passed over: wrong: self-test failed on ", "step1"]);
    }
    // The verdict is of this driver and its compiler.
    assert_eq!(driver.files("verdict"), 2);
    driver.start_with(&[("BAD_DRIVER_VERSION", "2")]).draws_on("opencl", &["built with care"]);
    assert_eq!(driver.files("verdict"), 4);
}

#[test]
fn devices_are_asked_by_their_own_version_and_whatever_their_name() {
    for fault in ["newer-platform-2.0", "newer-platform-1.2"] {
        let Some(driver) = Driver::with(fault) else { return };
        driver.start().draws_on("opencl", &[]);
    }
    let Some(driver) = Driver::with("only-qualcomm") else { return };
    driver.start().draws_on("opencl", &["device: QUALCOMM\n"]);
}

/// A folder in which every library that Rarefy looks for is a broken file.
fn hidden_libraries() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for name in ["libOpenCL.so.1", "libOpenCL.so", "libmali.so", "libGLES_mali.so", "libPVROCL.so"] {
        std::fs::write(folder.path().join(name), "hidden").unwrap();
    }
    folder
}

fn without_library<'a>(driver: &Driver, more: &[(&'a str, &'a str)]) -> Start {
    let hidden = hidden_libraries();
    let folder = hidden.path().to_str().unwrap();
    driver.start_with(&[&[("OPENCL_DYLIB_PATH", ""), ("LD_LIBRARY_PATH", folder)], more].concat())
}

#[test]
fn without_any_opencl_the_cpu_draws_and_the_report_says_what_was_tried() {
    let Some(driver) = Driver::with("none") else { return };
    let start = without_library(&driver, &[]);
    start.draws_on("cpu", &["passed over: none: no usable OpenCL device", "library: none", "devices: 0"]);
    for name in ["libOpenCL.so.1: ", "libOpenCL.so: ", "libmali.so: "] {
        assert!(start.text.contains(&format!("refused library: {name}")), "{start:?}");
    }
    // A library without platforms behind it.
    let none = tempfile::tempdir().unwrap();
    let start = driver.start_with(&[("OCL_ICD_VENDORS", none.path().to_str().unwrap())]);
    start.draws_on("cpu", &["no OpenCL platform is installed", "skipped: "]);
}

#[test]
fn a_library_that_the_caller_names_comes_first_and_others_are_told() {
    let Some(driver) = Driver::with("none") else { return };
    let named = driver.library.to_str().unwrap().to_owned();
    let start = driver.start_with(&[("OPENCL_DYLIB_PATH", "/nonexistent/libX.so"), ("LIBRARY", &named)]);
    start.draws_on("opencl", &[&format!("library: {named}\n")]);
    let wrong = driver.start_with(&[("LIBRARY", "/nonexistent/libY.so")]);
    wrong.draws_on("opencl", &[&format!("library: {named}\n"), "refused library: /nonexistent/libY.so: "]);
    // The OpenCL of Pixel phones is known, and said to be what it is.
    let pixel = driver_library("pixel.c", &[]);
    let start = driver.start_with(&[("LIBRARY", pixel.to_str().unwrap())]);
    start.draws_on(
        "opencl",
        &["is the OpenCL of Pixel phones, which gives its functions through loadOpenCLPointer only"],
    );
}

#[test]
fn two_starts_at_once_do_not_take_each_other_for_crashes() {
    let Some(driver) = Driver::with("none") else { return };
    std::thread::scope(|scope| {
        let starts: Vec<_> = (0..2).map(|_| scope.spawn(|| driver.start())).collect();
        for start in starts {
            start.join().unwrap().draws_on("opencl", &[]);
        }
    });
    assert_eq!(driver.files("marker"), 0);
}

#[test]
fn a_cache_that_cannot_be_written_costs_nothing_but_time() {
    let Some(driver) = Driver::with("none") else { return };
    let file: &Path = driver.folder.path();
    std::fs::write(file.join("cache"), "a file where the folder should be").unwrap();
    driver.start().draws_on("opencl", &[]);
}
