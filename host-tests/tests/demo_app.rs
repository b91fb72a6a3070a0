// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the Android demo app decides, apart from its widgets, in a desktop Java VM with the library that cargo built:
//! gestures, settings, the render loop, the benchmark, sentences.
//!
//! The tests themselves are Java programs, in `android/demo/src/test`. As for `jni_desktop.rs`, the library must have been
//! built, and `RAREFY_TEST_JVM=none` waives them.

#![allow(clippy::unwrap_used)]

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use rarefy::Method;
use rarefy::internal::scene::builtin::{NAMES, ROOMS};
use rarefy_host_tests::clang::{clang, driver_library};
use rarefy_host_tests::command::{rarefy_in, root};
use rarefy_host_tests::frames::no_opencl;
use rarefy_host_tests::jdk::{Jdk, all_text, java_files, jni_complaints};
use serde_json::Value;

const LOGIC: &str = "android/demo/src/main/java/dev/rarefy/demo/logic";

/// The library, the app's logic and its tests, compiled once.
fn classes(jdk: &Jdk) -> &'static Path {
    static CLASSES: OnceLock<tempfile::TempDir> = OnceLock::new();
    let folder = CLASSES.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        let mut sources: Vec<PathBuf> = Vec::new();
        for part in [
            "android/library/annotations/org/jspecify/annotations",
            "android/library/src/main/java/dev/rarefy",
            LOGIC,
            "android/demo/src/test/java/dev/rarefy",
            "android/demo/src/test/java/dev/rarefy/demo/logic",
        ] {
            sources.extend(java_files(part));
        }
        jdk.compile(&sources, folder.path());
        folder
    });
    folder.path()
}

/// Runs one of the Java tests, which must come to its end and break no rule of JNI; what it printed.
#[track_caller]
fn test(class: &str, arguments: &[&str]) -> Option<String> {
    let jdk = Jdk::find()?;
    let output = jdk.output(classes(&jdk), &format!("dev.rarefy.demo.logic.{class}"), &[], arguments, &[]);
    let text = all_text(&output);
    assert!(output.status.success(), "{class}: {}\n{text}", output.status);
    assert!(text.lines().any(|line| line == "done"), "{text}");
    assert!(jni_complaints(&text).is_empty(), "{text}");
    Some(text)
}

#[test]
fn fingers_move_the_camera_as_expected() {
    test("GesturesTest", &[]);
}

#[test]
fn cameras_scenes_files_pictures_heat_and_json() {
    let folder = tempfile::tempdir().unwrap();
    test("PlainTest", &[folder.path().to_str().unwrap()]);
}

#[test]
fn settings_survive_and_the_panel_knows_what_the_methods_say() {
    let Some(text) = test("SettingsTest", &[]) else { return };
    let mut count = 0;
    for line in text.lines().filter_map(|line| line.strip_prefix("default ")) {
        let [name, method, fine, coarse] = line.split(' ').collect::<Vec<_>>()[..] else { panic!("{line}") };
        let checks = method.to_lowercase().parse::<Method>().unwrap().checks;
        let of = |tolerances: rarefy::tuning::Tolerances| match name {
            "t_pos" => tolerances.t_pos,
            "t_norm" => tolerances.t_norm,
            "t_conv" => tolerances.t_conv,
            "t_tex" => tolerances.t_tex,
            "t_gcol" => tolerances.t_gcol,
            _ => panic!("{line}"),
        };
        let panel: [f32; 2] = [fine.parse().unwrap(), coarse.parse().unwrap()];
        assert_eq!(panel, [of(checks.fine), of(checks.coarse)], "{line}");
        count += 1;
    }
    assert_eq!(count, 5 * 3);
}

#[test]
fn the_loop_shows_what_is_wanted_last_whatever_happens() {
    let folder = tempfile::tempdir().unwrap();
    rarefy_in(folder.path(), &["bake", "spheres", "-o", "baked"], &[]).expect(0);
    let baked = folder.path().join("baked");
    test("LoopTest", &[folder.path().to_str().unwrap(), baked.to_str().unwrap()]);
}

#[test]
fn sentences_have_the_numbers_of_the_region() {
    test("OverlayTest", &[]);
}

#[test]
fn after_a_crash_in_a_driver_it_starts_says_so_and_retries_when_asked() {
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
        let class = "dev.rarefy.demo.logic.CrashTest";
        let output = jdk.output(classes(&jdk), class, &[], &[library, caches, retry], &variables);
        (output.status.code(), all_text(&output))
    };
    let (status, text) = start("compiler-exits", "false");
    assert_eq!(status, Some(7), "the driver ends the app: {text}");
    let (status, text) = start("compiler-exits", "false");
    assert_eq!(status, Some(0), "{text}");
    assert!(text.contains("start: cpu\nstart: DRIVER_CRASHED["), "{text}");
    let (status, text) = start("none", "true");
    assert_eq!(status, Some(0), "{text}");
    assert!(text.contains("start: cpu\nstart: DRIVER_CRASHED["), "{text}");
    assert!(text.contains("retry: opencl\nretry: null\ndone\n"), "{text}");
}

/// What `rarefy compare --json` has at least.
const CONTRACT: &str = "
    scene triangles width height samples_per_axis block frames
    device device/name device/version device/backend device/profile
    build build/load_ms build/kdtree_ms build/upload_ms build/program_ms
    full full/frame_ms full/rays full/rays/primary full/rays/shadow full/rays/reflection full/rays/refraction
    full/work full/work/traversal_steps full/work/triangle_tests full/work/shaded_pixels
    adaptive adaptive/frame_ms adaptive/rays adaptive/work adaptive/fell_back
    adaptive/pixels/base adaptive/pixels/traced adaptive/pixels/interpolated adaptive/pixels/corrected
    adaptive/stages_ms/step1 adaptive/stages_ms/step2a adaptive/stages_ms/step2b adaptive/stages_ms/step2c
    adaptive/stages_ms/step3a adaptive/stages_ms/step3b adaptive/stages_ms/step3c adaptive/stages_ms/step4 adaptive/stages_ms/other
    adaptive/failed_tests/g1 adaptive/failed_tests/g2 adaptive/failed_tests/g3 adaptive/failed_tests/g4
    adaptive/failed_tests/tx adaptive/failed_tests/sh adaptive/failed_tests/gc
    ray_traced_ratio ray_traced_ratio_with_correction speedup work_speedup efficiency
    psnr_db ssim flip_mean flip_p99 wrong_object_pixels wrong_shadow_pixels peak_device_bytes";

/// Every name of an object and of those in it, as paths.
fn names(value: &Value, path: &str, found: &mut BTreeSet<String>) {
    for (name, part) in value.as_object().into_iter().flatten() {
        let path = format!("{path}/{name}");
        found.insert(path.clone());
        names(part, &path, found);
    }
}

#[test]
fn the_benchmark_has_every_row_and_the_names_of_the_command() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("benchmark.json");
    if test("BenchmarkTest", &[file.to_str().unwrap()]).is_none() {
        return;
    }
    let app: Value = serde_json::from_slice(&std::fs::read(file).unwrap()).unwrap();
    let rows = app["rows"].as_array().unwrap();
    let methods: Vec<&str> = rows.iter().map(|row| row["method"].as_str().unwrap()).collect();
    assert_eq!(methods, ["balanced", "fast", "paper"]);
    let arguments = ["compare", "spheres", "--size", "96x64", "--device", "cpu", "--frames", "1", "--json", "-"];
    let command = rarefy_in(folder.path(), &arguments, &[]).expect(0);
    let command: Value = serde_json::from_str(&command.stdout).unwrap();
    let mut wanted = BTreeSet::new();
    names(&command, "", &mut wanted);
    for (row, value) in rows.iter().enumerate() {
        let mut got = BTreeSet::new();
        names(value, "", &mut got);
        // All that `compare --json` promises is there, and nothing by another name.
        for name in CONTRACT.split_whitespace().map(|name| format!("/{name}")) {
            assert!(got.contains(&name) && wanted.contains(&name), "row {row}: {name}");
        }
        let unknown: Vec<&String> = got.iter().filter(|name| *name != "/method" && !wanted.contains(*name)).collect();
        assert!(unknown.is_empty(), "row {row}: {unknown:?}");
    }
    // The same scene, size, device and method: the same counts and nearly the same quality.
    let (row, balanced) = (&rows[0], &command);
    assert_eq!(row["full"]["rays"], balanced["full"]["rays"]);
    for part in ["rays", "work", "pixels", "failed_tests"] {
        assert_eq!(row["adaptive"][part], balanced["adaptive"][part], "{part}");
    }
    for part in ["ray_traced_ratio", "ray_traced_ratio_with_correction", "work_speedup", "psnr_db"] {
        let (app, command) = (row[part].as_f64().unwrap(), balanced[part].as_f64().unwrap());
        assert!((app - command).abs() < 1e-9 * command.abs(), "{part}: {app}, {command}");
    }
}

#[test]
fn sixty_random_sequences_reach_no_wrong_state() {
    test("SequencesTest", &["60", "1"]);
}

#[test]
#[ignore = "long: a thousand random sequences of fingers and of an Activity's life"]
fn a_thousand_random_sequences_reach_no_wrong_state() {
    test("SequencesTest", &["1000", "1000"]);
}

#[test]
fn the_logic_knows_nothing_of_android() {
    let of_android = |text: &str| text.contains("import android") || text.contains(" android.");
    let folder = root().join(LOGIC);
    let mut count = 0;
    for file in folder.read_dir().unwrap() {
        let file = file.unwrap().path();
        assert!(!of_android(&std::fs::read_to_string(&file).unwrap()), "{}", file.display());
        count += 1;
    }
    assert!(count > 15, "{count}");
    let screens = folder.parent().unwrap().join("MainActivity.java");
    assert!(of_android(&std::fs::read_to_string(screens).unwrap()));
}

#[test]
fn the_list_has_every_scene_of_the_library() {
    let text = std::fs::read_to_string(root().join(LOGIC).join("SceneChoice.java")).unwrap();
    let named = |kind: &str| -> BTreeSet<String> {
        let before = format!("new SceneChoice(Kind.{kind}, \"");
        text.split(&before).skip(1).map(|part| part.split_once('"').unwrap().0.to_owned()).collect()
    };
    let (assets, builtin) = (named("ASSET"), named("BUILTIN"));
    assert_eq!(assets, BTreeSet::from(["bathroom".to_owned(), "kitchen".to_owned()]));
    assert!(assets.iter().all(|name| ROOMS.contains(&name.as_str())));
    let in_library = NAMES.iter().filter(|name| !ROOMS.contains(name));
    assert_eq!(builtin, in_library.map(|&name| name.to_owned()).collect());
}
