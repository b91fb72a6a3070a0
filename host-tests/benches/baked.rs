// SPDX-License-Identifier: MIT OR Apache-2.0
//! Baked scenes against OBJ files: `cargo bench -p rarefy-host-tests --bench baked -- [RUNS] [SCENE ...]`.
//!
//! For each scene (those of `../shared/scenes`, or of the folder that the variable SCENES names, if they are there; else
//! the built-in café as files) one line: the times until a prepared scene is there, from OBJ and from the baked file, in
//! turn, medians of RUNS (5 by default), their ratio; the most memory that a process held on the way, and the baked one's
//! over the file's size. Each load is a process of its own; what a process holds that loads nothing is subtracted.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use rarefy::{Monitor, PreparedScene, Shading};

/// Set in the processes that load something.
const CHILD: &str = "RAREFY_BENCH_BAKED";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    if let Ok(work) = std::env::var(CHILD) {
        let path = std::env::var_os("RAREFY_BENCH_PATH").unwrap_or_default();
        return child(&work, Path::new(&path));
    }
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    let runs = arguments.first().and_then(|runs| runs.parse().ok()).unwrap_or(5);
    let scratch = tempfile::tempdir()?;
    let mut scenes: Vec<PathBuf> = Vec::new();
    let root = std::env::var_os("SCENES").map_or("../shared/scenes".into(), PathBuf::from);
    // `cargo bench` starts in the package's folder.
    let root = if root.is_absolute() { root } else { Path::new("..").join(root) };
    for name in arguments.iter().skip(1).map(String::as_str).chain(arguments.is_empty().then_some("kitchen")) {
        let folder = root.join(name);
        if folder.is_dir() {
            scenes.push(folder);
        } else {
            println!("{name}: not in {}", root.display());
        }
    }
    if scenes.is_empty() {
        let cafe = scratch.path().join("cafe");
        rarefy::internal::scene::builtin::write("cafe", &cafe)?;
        scenes.push(cafe);
    }
    for scene in scenes {
        let baked = scratch.path().join("scene.baked");
        measure("bake", &scene, Some(&baked))?;
        let size = std::fs::metadata(&baked)?.len() as f64;
        let (mut obj, mut file) = (Vec::new(), Vec::new());
        let nothing = measure("nothing", &scene, None)?.1;
        for _ in 0..runs {
            obj.push(measure("obj", &scene, None)?);
            file.push(measure("baked", &baked, None)?);
        }
        let median = |values: &[(f64, f64)], of: fn(&(f64, f64)) -> f64| {
            let mut values: Vec<f64> = values.iter().map(of).collect();
            values.sort_by(f64::total_cmp);
            values[values.len() / 2]
        };
        let (obj_ms, baked_ms) = (median(&obj, |v| v.0), median(&file, |v| v.0));
        let (obj_bytes, baked_bytes) = (median(&obj, |v| v.1) - nothing, median(&file, |v| v.1) - nothing);
        const MIB: f64 = 1048576.0;
        println!(
            "{}: OBJ {obj_ms:.0} ms, baked {baked_ms:.1} ms: 1/{:.0}; peak OBJ {:.1} MiB, baked {:.1} MiB of a file of {:.1} MiB: {:.3}",
            scene.file_name().unwrap_or_default().to_string_lossy(),
            obj_ms / baked_ms,
            obj_bytes / MIB,
            baked_bytes / MIB,
            size / MIB,
            baked_bytes / size,
        );
    }
    Ok(())
}

/// Milliseconds and peak bytes of a process that does `work`.
fn measure(work: &str, path: &Path, output: Option<&Path>) -> Result<(f64, f64), Box<dyn std::error::Error>> {
    let mut command = Command::new(std::env::current_exe()?);
    command.env(CHILD, work).env("RAREFY_BENCH_PATH", path);
    if let Some(output) = output {
        command.env("RAREFY_BENCH_OUTPUT", output);
    }
    let output = command.output()?;
    let text = String::from_utf8(output.stdout)?;
    let numbers: Vec<f64> = text.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    match numbers[..] {
        [ms, bytes] if output.status.success() => Ok((ms, bytes)),
        _ => Err(format!("{work} of {}: {text}{}", path.display(), String::from_utf8_lossy(&output.stderr)).into()),
    }
}

fn child(work: &str, path: &Path) -> Result<(), Box<dyn std::error::Error>> {
    let monitor = Monitor::default();
    let from_files = || PreparedScene::new(&rarefy::load(path, &monitor)?, Shading::Full, &monitor);
    let started = Instant::now();
    let scene = match work {
        "obj" => Some(from_files()?),
        "baked" => Some(PreparedScene::from_baked_file(path, &monitor)?),
        "bake" => {
            let output = std::env::var_os("RAREFY_BENCH_OUTPUT").unwrap_or_default();
            from_files()?.bake_to(Path::new(&output))?;
            None
        }
        _ => None,
    };
    let ms = started.elapsed().as_secs_f64() * 1e3;
    println!("{ms} {}", peak_bytes());
    drop(scene);
    Ok(())
}

/// The most memory that this process has held so far, in bytes; 0 where the system does not tell.
fn peak_bytes() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).unwrap_or_default();
    line.split_whitespace().next().and_then(|kib| kib.parse::<u64>().ok()).unwrap_or(0) * 1024
}
