// SPDX-License-Identifier: MIT OR Apache-2.0
//! The `rarefy` command as a user runs it: what it prints and writes, its exit status, and bad input.
#![allow(clippy::unwrap_used, missing_docs)]

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

use rarefy::internal::device::stage::Stage;
use rarefy::internal::render::picture::read_rgb8;
use rarefy_host_tests::command::{Run, rarefy_in};
use rarefy_host_tests::frames::no_opencl;
use serde_json::Value;
use tempfile::TempDir;

const NO_PLATFORM: &[(&str, &str)] = &[("OCL_ICD_VENDORS", "/nonexistent")];

fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

fn rarefy(folder: &TempDir, arguments: &str) -> Run {
    rarefy_in(folder.path(), &arguments.split_whitespace().collect::<Vec<_>>(), &[])
}

/// What lies in a folder.
fn entries(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        folder.read_dir().unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|e| panic!("{e}:\n{text}"))
}

fn keys(value: &Value) -> BTreeSet<&str> {
    value.as_object().unwrap().keys().map(String::as_str).collect()
}

fn set(words: &'static str) -> BTreeSet<&'static str> {
    words.split_whitespace().collect()
}

#[test]
fn render_writes_the_picture_the_layers_and_the_statistics() {
    let folder = folder();
    let layers: Vec<String> = rarefy::internal::analysis::layers::Layer::NAMES
        .iter()
        .map(|name| format!("--layer {name}={name}.png"))
        .collect();
    let arguments = format!("render spheres --device cpu --size 40x30 -o out.png --json out.json {}", layers.join(" "));
    let run = rarefy(&folder, &arguments).expect(0);
    assert!(run.stdout.contains("out.png: 40x30 on CPU, "), "{}", run.stdout);
    let (width, height, picture) = read_rgb8(folder.path().join("out.png")).unwrap();
    assert_eq!((width, height), (40, 30));
    assert!(picture.iter().collect::<BTreeSet<_>>().len() > 50, "an empty picture");
    for name in rarefy::internal::analysis::layers::Layer::NAMES {
        let (width, height, layer) = read_rgb8(folder.path().join(format!("{name}.png"))).unwrap();
        assert_eq!((width, height), (40, 30), "{name}");
        assert_eq!(layer == picture, name == "color", "{name}");
    }
    let value = json(&std::fs::read_to_string(folder.path().join("out.json")).unwrap());
    assert_eq!((&value["scene"], &value["width"], &value["height"]), (&"spheres".into(), &40.into(), &30.into()));
    assert_eq!(value["device"]["backend"], "cpu");
    assert!(value["adaptive"]["pixels"]["base"].as_u64() == Some(20 * 15));
}

#[test]
fn full_and_adaptive_pictures_differ_and_two_runs_do_not() {
    let folder = folder();
    for (name, mode) in [("a", "adaptive"), ("b", "adaptive"), ("f", "full")] {
        rarefy(&folder, &format!("render spheres --device cpu --size 96x64 --mode {mode} -o {name}.png")).expect(0);
    }
    let bytes = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    assert_eq!(bytes("a.png"), bytes("b.png"));
    assert_ne!(bytes("a.png"), bytes("f.png"));
    rarefy(&folder, "render spheres --device cpu --size 96x64 --t-pos 0 -o strict.png").expect(0);
    assert_eq!(bytes("strict.png"), bytes("f.png"));
}

#[test]
fn compare_writes_the_contract() {
    let folder = folder();
    let run = rarefy(&folder, "compare spheres --device cpu --size 320x240 --frames 1 --json - -o pictures").expect(0);
    let value = json(&run.stdout);
    let contract =
        set("scene triangles width height samples_per_axis block frames device build full adaptive ray_traced_ratio \
         ray_traced_ratio_with_correction speedup work_speedup efficiency psnr_db ssim flip_mean flip_p99 \
         wrong_object_pixels wrong_shadow_pixels peak_device_bytes");
    // Ours beyond the contract.
    let beyond =
        set("correction_work_ratio packed_ray_work_ratio psnr_interpolated_db wrong_object_largest_cluster falls_back");
    let all: BTreeSet<&str> = contract.union(&beyond).copied().collect();
    assert!(contract.is_subset(&keys(&value)), "missing: {:?}", contract.difference(&keys(&value)));
    assert_eq!(keys(&value), all);
    assert_eq!(keys(&value["device"]), set("name version backend profile lanes"));
    assert_eq!(keys(&value["build"]), set("load_ms kdtree_ms upload_ms program_ms"));
    assert_eq!(keys(&value["full"]), set("frame_ms rays work"));
    assert_eq!(keys(&value["adaptive"]), set("frame_ms rays work pixels stages_ms failed_tests fell_back"));
    for mode in ["full", "adaptive"] {
        assert_eq!(keys(&value[mode]["rays"]), set("primary shadow reflection refraction"));
        assert_eq!(keys(&value[mode]["work"]), set("traversal_steps triangle_tests shaded_pixels"));
    }
    assert_eq!(keys(&value["adaptive"]["pixels"]), set("base traced interpolated corrected"));
    assert_eq!(
        keys(&value["adaptive"]["stages_ms"]),
        set("step1 step2a step2b step2c step3a step3b step3c step4 other")
    );
    assert_eq!(keys(&value["adaptive"]["failed_tests"]), set("g1 g2 g3 g4 tx sh gc"));
    assert_eq!(value["full"]["rays"]["primary"], 320 * 240);
    let pixels = value["adaptive"]["pixels"].as_object().unwrap().values().map(|v| v.as_u64().unwrap()).sum::<u64>();
    assert_eq!(pixels, 320 * 240);
    assert!(value["psnr_db"].as_f64().unwrap() > 20.0 && value["work_speedup"].as_f64().unwrap() > 1.0);
    let wanted = ["adaptive.png", "class.png", "difference.png", "fail-mask.png", "full.png"];
    assert_eq!(entries(&folder.path().join("pictures")), wanted);
    // The table goes to standard error where standard output is JSON.
    assert!(run.stderr.contains("traced") && run.stderr.contains("PSNR"), "{}", run.stderr);
}

#[test]
fn diff_measures_pictures() {
    let folder = folder();
    rarefy(&folder, "render spheres --device cpu --size 48x32 -o a.png").expect(0);
    rarefy(&folder, "render spheres --device cpu --size 48x32 --mode full --depth 0 -o b.png").expect(0);
    rarefy(&folder, "render spheres --device cpu --size 32x32 -o small.png").expect(0);
    let equal = json(&rarefy(&folder, "diff a.png a.png --json -").expect(0).stdout);
    assert!(equal["psnr_db"].is_null(), "{equal}");
    assert_eq!(equal["flip_mean"].as_f64(), Some(0.0));
    let other = json(&rarefy(&folder, "diff a.png b.png -o d.png --json -").expect(0).stdout);
    assert!(other["psnr_db"].as_f64().unwrap() < 60.0 && other["flip_mean"].as_f64().unwrap() > 0.0, "{other}");
    assert_eq!(read_rgb8(folder.path().join("d.png")).unwrap().0, 48);
    rarefy(&folder, "diff a.png small.png -o none.png").expect_error(&["48x32", "32x32"]);
    rarefy(&folder, "diff a.png missing.png -o none.png").expect_error(&["missing.png"]);
    std::fs::write(folder.path().join("text.png"), "not a picture").unwrap();
    rarefy(&folder, "diff a.png text.png -o none.png").expect_error(&["text.png", "neither a PNG nor a JPEG"]);
    assert!(!folder.path().join("none.png").exists());
}

#[test]
fn a_dump_of_the_devices_is_a_profile_for_render() {
    if no_opencl() {
        return;
    }
    let folder = folder();
    let run = rarefy(&folder, "devices --json -").expect(0);
    std::fs::write(folder.path().join("phone.json"), &run.stdout).unwrap();
    assert!(!json(&run.stdout)["devices"].as_array().unwrap().is_empty());
    rarefy(&folder, "render wall --device opencl --size 16x16 --profile phone.json -o a.png").expect(0);
    let run =
        rarefy(&folder, "render wall --device opencl --size 16x16 --profile adreno-420 -o b.png --json -").expect(0);
    assert_eq!(json(&run.stdout)["device"]["profile"], "adreno-420");
    let rows = |arguments: &str| rarefy(&folder, arguments).expect(0).stdout;
    assert_eq!(rows("devices"), rows("devices --profile adreno-420"), "the reference phone stands beside the device");
    let row = |text: &str, name: &str| -> Vec<String> {
        let line =
            text.lines().find(|line| line.trim_start().starts_with(name)).unwrap_or_else(|| panic!("{name}: {text}"));
        line.trim_start()[name.len()..].split_whitespace().map(str::to_string).collect()
    };
    let beside = rows("devices --profile embedded-floor");
    assert_eq!(row(&beside, "limit"), ["device", "embedded-floor"]);
    for stage in ["step1", "step2a", "step2b", "step2c", "step3a", "step3b", "step3c", "step4"] {
        assert_eq!(row(&beside, &format!("work-group of {stage}, items")).len(), 2, "{stage}");
    }
    for name in ["work-group of scans, items", "lanes", "memory budget, MiB", "kernel arguments, bytes"] {
        assert_eq!(row(&beside, name).len(), 2, "{name}");
    }
    assert!(row(&beside, "slice, ms").len() >= 2 && row(&beside, "traversal").len() >= 2);
    let alone = rows("devices --profile none");
    assert_eq!((row(&alone, "limit").len(), row(&alone, "lanes").len()), (1, 1));
}

#[test]
fn selftest_passes_and_names_what_is_broken() {
    let folder = folder();
    let run = rarefy(&folder, "selftest --device cpu").expect(0);
    assert!(run.stdout.contains("twin") && run.stderr.is_empty(), "{run:?}");
    rarefy(&folder, "selftest --device cpu --break-stage step9").expect_error(&["step9", "step2b"]);
    if no_opencl() {
        return;
    }
    let run = rarefy(&folder, "selftest --device opencl").expect(0);
    for (.., label) in rarefy::internal::device::stage::LAUNCHES {
        assert!(run.stdout.contains(label), "{label} was not tested:\n{}", run.stdout);
    }
    // All eight stages: host-tests/tests/mutants.rs.
    for stage in [Stage::Step2b, Stage::Step4] {
        let run = rarefy(&folder, &format!("selftest --device opencl --break-stage {}", stage.name())).expect(1);
        assert!(run.stderr.contains(&format!(": {}", stage.name())), "{}", run.stderr);
        assert!(run.stdout.contains("WRONG"), "{}", run.stdout);
    }
}

#[test]
fn a_written_scene_draws_like_the_built_in_one_and_pleases_the_doctor() {
    let folder = folder();
    rarefy(&folder, "make-scene spheres -o written").expect(0);
    let there = entries(&folder.path().join("written"));
    assert_eq!(there, ["scene.mtl", "scene.obj", "textures", "view.json"]);
    rarefy(&folder, "render written --device cpu --size 64x48 -o a.png").expect(0);
    rarefy(&folder, "render spheres --device cpu --size 64x48 -o b.png").expect(0);
    let bytes = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    assert_eq!(bytes("a.png"), bytes("b.png"));
    let value = json(&rarefy(&folder, "doctor written --json -").expect(0).stdout);
    assert!(value["triangles"].as_u64().unwrap() > 1000 && value["findings"].is_array());
    rarefy(&folder, "make-scene spheres -o written").expect_error(&["written", "not empty"]);
    rarefy(&folder, "make-scene nosuch -o other").expect_error(&["nosuch", "spheres"]);
    assert!(!folder.path().join("other").exists());
}

/// Each must fail with one message that holds the words, and leave the folder empty.
#[test]
fn bad_input_is_one_clear_error_and_no_file() {
    let cases: &[(&str, &[&str])] = &[
        ("render nosuch", &["nosuch", "no such file or folder"]),
        ("render wall --size 0x0", &["--size", "0x0", "1 to 16384"]),
        ("render wall --size 0x64", &["--size", "0x64"]),
        ("render wall --size 16385x1", &["--size", "16385x1", "1 to 16384"]),
        ("render cafe --device opencl --memory-budget 1", &["leaf_triangles", "--memory-budget", "1048576 bytes"]),
        ("render wall --size -1x4", &["-1x4"]),
        ("render wall --size 64", &["WIDTHxHEIGHT"]),
        ("render wall --size 99999999999x1", &["99999999999x1"]),
        ("render wall --blocks 3", &["--blocks", "3", "2 or 4"]),
        ("render wall --depth 1000", &["--depth", "1000"]),
        ("render wall --samples 3", &["--samples"]),
        ("render wall --t-pos nan", &["--t-pos", "NaN"]),
        ("render wall --t-norm 7", &["--t-norm", "7"]),
        ("render wall --t-tex -0.5", &["--t-tex", "-0.5"]),
        ("render wall --layer shine=x.png", &["--layer", "shine", "fail-mask"]),
        ("render wall --layer normal", &["--layer", "NAME=FILE.png"]),
        ("render wall --mode full --layer class=x.png", &["--layer", "adaptive"]),
        ("render wall --disable-test gc,g9", &["--disable-test", "g9", "tx"]),
        ("render wall --profile nosuch", &["--profile", "nosuch", "adreno-420"]),
        ("render wall --profile no/such.json", &["no/such.json"]),
        ("render wall --device gpu", &["gpu", "opencl:N"]),
        ("render wall --method ours", &["--method", "ours", "balanced, fast or paper"]),
        ("render wall --correction-t-visible 256", &["--correction-t-visible", "256", "255"]),
        ("render wall --t-pos 0.1,wide", &["--t-pos", "wide"]),
        ("render wall --correction both", &["--correction", "both", "object+shadow", "off"]),
        ("render wall --correction-t-norm nan", &["--correction-t-norm", "NaN", "-1 to 2"]),
        ("render wall --correction-t-gcol -1", &["--correction-t-gcol", "-1", "0 or more"]),
        ("render wall --correction off --correction-t-norm 0.5", &["--correction-t-norm", "no use"]),
        ("render wall --correction off --correction-method sweeps", &["--correction-method", "no use"]),
        ("render wall --method paper --correction-bridges true", &["--correction-bridges", "no use"]),
        ("render wall --samples 4 --size 16384x16384", &["--samples", "`4`", "1 to 3", "16384x16384"]),
        ("render wall --sizes 16x16", &["--sizes", "tip", "--size"]),
        ("render --size 16x16", &["SCENE"]),
        ("render wall --device cpu -o no/such/folder.png", &["no/such"]),
        ("render wall --device cpu --layer normal=no/such.png", &["no"]),
        ("render wall --device cpu --json no/such.json", &["no"]),
        ("render wall --device cpu --size 16x16 -o .", &["this is a folder"]),
        ("compare wall --frames 0", &["--frames", "0"]),
        ("compare wall --frames 1 --device cpu --json no/such.json", &["no"]),
        ("selftest --device cpu --profile nosuch", &["nosuch"]),
        ("devices --profile nosuch", &["nosuch"]),
        ("doctor nosuch", &["nosuch"]),
        ("frobnicate", &["frobnicate"]),
    ];
    for (arguments, parts) in cases {
        let folder = folder();
        let picture = if arguments.starts_with("render") && !arguments.contains("-o ") { " -o out.png" } else { "" };
        println!("{arguments}");
        rarefy(&folder, &format!("{arguments}{picture}")).expect_error(parts);
        assert_eq!(entries(folder.path()), [""; 0], "{arguments}");
    }
}

#[test]
fn the_smallest_pictures_are_drawn() {
    let folder = folder();
    for (size, mode) in [("1x1", "full"), ("1x1", "adaptive"), ("1x7", "adaptive"), ("7x1", "adaptive")] {
        for block in [2, 4] {
            let arguments =
                format!("render spheres --device cpu --size {size} --mode {mode} --blocks {block} -o a.png");
            rarefy(&folder, &arguments).expect(0);
            let (width, height, pixels) = read_rgb8(folder.path().join("a.png")).unwrap();
            assert_eq!(format!("{width}x{height}"), size);
            assert!(pixels.iter().all(|p| p & 0xff_ffff != 0), "{arguments}: black pixels before a sky");
        }
    }
}

#[test]
fn what_cannot_be_written_leaves_the_old_file() {
    let folder = folder();
    let file = folder.path().join("file");
    std::fs::write(&file, "old").unwrap();
    rarefy(&folder, "render wall --device cpu --size 16x16 -o file/out.png").expect_error(&["file", "not a folder"]);
    // A full disk, as the system itself plays it.
    if cfg!(target_os = "linux") {
        rarefy(&folder, "render wall --device cpu --size 16x16 -o /dev/full")
            .expect_error(&["/dev/full", "No space left"]);
        // Nobody can make files here, not even root.
        rarefy(&folder, "render wall --device cpu --size 16x16 -o /proc/out.png").expect_error(&["/proc"]);
    }
    // A file system of one page, where root may mount one.
    let disk = folder.path().join("disk");
    std::fs::create_dir(&disk).unwrap();
    let mounted = Command::new("mount").args(["-t", "tmpfs", "-o", "size=8k", "none"]).arg(&disk).output();
    if mounted.is_ok_and(|o| o.status.success()) {
        std::fs::write(disk.join("out.png"), "old").unwrap();
        let run = rarefy(&folder, "render spheres --device cpu --size 200x200 -o disk/out.png");
        let left = entries(&disk);
        let old = std::fs::read_to_string(disk.join("out.png")).unwrap_or_default();
        assert!(Command::new("umount").arg(&disk).status().unwrap().success());
        run.expect_error(&["disk/out.png", "No space left"]);
        assert_eq!((left, old.as_str()), (vec!["out.png".to_owned()], "old"));
    } else {
        println!("skipped: a full disk of one page (mounting needs root)");
    }
    assert_eq!(std::fs::read_to_string(&file).unwrap(), "old");
}

/// Without OpenCL: an error that lists what was tried, or the twin, which says so.
fn no_device(variables: &[(&str, &str)], reason: &str) {
    let folder = folder();
    let run = |arguments: &str| rarefy_in(folder.path(), &arguments.split_whitespace().collect::<Vec<_>>(), variables);
    run("render wall --device opencl --size 16x16 -o a.png").expect_error(&[
        "no usable OpenCL device",
        reason,
        "--device cpu",
    ]);
    assert!(entries(folder.path()).is_empty());
    run("render wall --device opencl:1 --size 16x16 -o a.png").expect_error(&[reason]);
    run("selftest --device opencl").expect_error(&["no usable OpenCL device", reason]);
    let auto = run("render wall --size 16x16 -o a.png --json a.json").expect(0);
    assert!(auto.stderr.contains("drawing on the CPU") && auto.stderr.contains(reason), "{}", auto.stderr);
    let value = json(&std::fs::read_to_string(folder.path().join("a.json")).unwrap());
    assert_eq!(value["device"]["backend"], "cpu");
    let devices = run("devices").expect(0);
    assert!(
        devices.stdout.contains("no usable OpenCL device") && devices.stdout.contains(reason),
        "{}",
        devices.stdout
    );
}

#[test]
fn without_opencl_the_twin_draws_or_the_error_lists_what_was_tried() {
    if no_opencl() {
        return;
    }
    no_device(NO_PLATFORM, "no OpenCL platform is installed");
}

/// A driver with one platform and no device, as Mesa's are on machines without its GPUs.
const DRIVER: &str = r#"
#include <stddef.h>
#include <string.h>
static int platforms(unsigned n, void **out, unsigned *count);
static int text(const char *value, size_t size, void *out, size_t *needed) {
  if (needed) *needed = strlen(value) + 1;
  if (out && size > strlen(value)) strcpy(out, value);
  return 0;
}
static int platform_info(void *p, unsigned name, size_t size, void *out, size_t *needed) {
  (void)p;
  switch (name) {
  case 0x900: return text("FULL_PROFILE", size, out, needed);
  case 0x901: return text("OpenCL 1.2 empty", size, out, needed);
  case 0x902: return text("Deserted", size, out, needed);
  case 0x904: return text("cl_khr_icd", size, out, needed);
  case 0x920: return text("EMPTY", size, out, needed);
  default: return text("nobody", size, out, needed);
  }
}
static int devices(void *p, unsigned long type, unsigned n, void **out, unsigned *count) {
  (void)p; (void)type; (void)n; (void)out;
  if (count) *count = 0;
  return -1;
}
static void *table[200] = {(void *)platforms, (void *)platform_info, (void *)devices};
static struct { void **dispatch; } the_platform = {table};
static int platforms(unsigned n, void **out, unsigned *count) {
  if (count) *count = 1;
  if (out && n) out[0] = &the_platform;
  return 0;
}
int clIcdGetPlatformIDsKHR(unsigned n, void **out, unsigned *count) { return platforms(n, out, count); }
int clGetPlatformInfo(void *p, unsigned name, size_t size, void *out, size_t *needed) {
  return platform_info(p, name, size, out, needed);
}
void *clGetExtensionFunctionAddress(const char *name) {
  if (!strcmp(name, "clIcdGetPlatformIDsKHR")) return (void *)clIcdGetPlatformIDsKHR;
  if (!strcmp(name, "clGetPlatformInfo")) return (void *)clGetPlatformInfo;
  return NULL;
}
"#;

fn driver_without_devices(folder: &Path) -> PathBuf {
    let (source, library) = (folder.join("driver.c"), folder.join("libempty.so"));
    std::fs::write(&source, DRIVER).unwrap();
    let output = Command::new("cc").args(["-shared", "-fPIC", "-o"]).arg(&library).arg(&source).output();
    let output = output.expect("a C compiler, `cc`, which Rust links with as well");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let vendors = folder.join("vendors");
    std::fs::create_dir(&vendors).unwrap();
    std::fs::write(vendors.join("empty.icd"), format!("{}\n", library.display())).unwrap();
    vendors
}

#[test]
fn a_platform_without_devices_is_named_as_such() {
    if no_opencl() {
        return;
    }
    let folder = folder();
    let vendors = driver_without_devices(folder.path());
    no_device(&[("OCL_ICD_VENDORS", vendors.to_str().unwrap())], "platform Deserted: has no devices");
}
