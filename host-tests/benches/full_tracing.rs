// SPDX-License-Identifier: MIT OR Apache-2.0
//! Full tracing against the yardstick: `cargo bench -p rarefy-host-tests --bench full_tracing -- [ROUNDS] [SCENE ...]`.
//!
//! Builds `../shared/anchors/embree-whitted` (g++, Embree 3 and nlohmann-json must be installed) and draws each of the
//! real scenes at 1024x1024 on equal work: Embree's single rays on two threads, and full tracing with
//! `--shading anchor` in a fast build on the first OpenCL device. Both take turns, ROUNDS times (7 by default); in a
//! round each draws three frames, of which the median counts, so that slow spells of the machine fall on both.
//!
//! Times are whole frames: `frame ms` of Rarefy includes the read-back of the picture, which Embree draws straight into
//! memory; `kernel ms` is what the device itself reports. The ratio is Embree's frame over Rarefy's frame, the median of
//! all rounds. Exit status: 1 if the ray counts of a scene differ by more than 0.5 %, 0 otherwise: the time itself
//! decides nothing. The variable DEVICE chooses another device (`cpu`, `twin`, `opencl:N`), LANES how many lanes the engine of
//! `cpu` has, ANCHOR_MODE how Embree traces (`single`, `packet8`, `packet16`), ANCHOR_CONFIG what it is told
//! (`max_isa=avx2`), SHARED another folder in place of `../shared`.
//!
//! ADAPTIVE=1 draws an adaptive frame of each preset in every round as well, and says how many times as fast as our own full
//! frame and as Embree's full frame it is.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::sync::Arc;

use rarefy::internal::device::cpu::Width;
use rarefy::internal::device::open::{DeviceChoice, DeviceOptions};
use rarefy::internal::method::counts::Keep;
use rarefy::internal::method::options::{Method, Mode, Preset, RenderOptions};
use rarefy::internal::prepare::{PreparedScene, Shading};
use rarefy::internal::render::renderer::Renderer;

const SCENES: [&str; 6] = ["modern-hall", "figures", "classroom", "living-room", "bathroom", "kitchen"];
const SIZE: u32 = 1024;
const FRAMES: usize = 3;
const GOAL: f64 = 0.6;
/// Largest difference of the ray counts: beyond, the two do not do the same work.
const MOST_DIFFERENCE: f64 = 0.005;

type BenchResult<T> = Result<T, Box<dyn std::error::Error>>;

/// What one run of the yardstick says.
struct Anchor {
    frame_ms: f64,
    /// Primary, shadow and reflection rays.
    rays: [u64; 3],
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn shared() -> PathBuf {
    std::env::var_os("SHARED").map_or_else(|| root().join("../shared"), PathBuf::from)
}

/// Compiles the yardstick; `None`, with a line that says why, where that is not possible.
fn build_anchor() -> Option<PathBuf> {
    let source = shared().join("anchors/embree-whitted/main.cpp");
    if !source.is_file() {
        println!("skipped: ../shared/anchors/embree-whitted is not here");
        return None;
    }
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from);
    let program = target.join("embree-whitted");
    let modified = |path: &Path| path.metadata().and_then(|data| data.modified()).ok();
    if modified(&program) > modified(&source) {
        return Some(program);
    }
    let compiler = std::env::var("CXX").unwrap_or_else(|_| "g++".into());
    let output = Command::new(&compiler)
        .args(["-O3", "-march=native", "-ffast-math", "-std=c++17"])
        .arg(&source)
        .arg("-o")
        .arg(&program)
        .args(["-lembree3", "-pthread"])
        .output();
    match output {
        Ok(output) if output.status.success() => Some(program),
        Ok(output) => {
            println!(
                "skipped: {compiler} cannot build the yardstick (apt-get install libembree-dev nlohmann-json3-dev)"
            );
            println!("{}", String::from_utf8_lossy(&output.stderr));
            None
        }
        Err(error) => {
            println!("skipped: {compiler} does not run: {error}");
            None
        }
    }
}

/// The number behind `key` in the words of `text`.
fn number_after(text: &str, key: &str) -> BenchResult<f64> {
    let mut words = text.split_whitespace().skip_while(|word| *word != key).skip(1);
    Ok(words.next().ok_or_else(|| format!("the yardstick says no `{key}`"))?.parse()?)
}

fn run_anchor(program: &Path, scene: &Path) -> BenchResult<Anchor> {
    let (size, frames) = (SIZE.to_string(), FRAMES.to_string());
    let variable = |name: &str, or: &str| std::env::var(name).unwrap_or(or.to_owned());
    let (mode, config) = (variable("ANCHOR_MODE", "single"), variable("ANCHOR_CONFIG", ""));
    let output = Command::new(program)
        .arg(scene.join("scene.obj"))
        .arg(scene.join("view.json"))
        .args(["--mode", &mode, "--config", &config, "--threads", "2", "--size", &size, "--frames", &frames])
        .output()?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into());
    }
    let text = String::from_utf8(output.stdout)?;
    let rays = ["primary", "shadow", "reflection"].map(|key| number_after(&text, key).map(|n| n as u64));
    let [primary, shadow, reflection] = rays;
    Ok(Anchor { frame_ms: number_after(&text, "median")?, rays: [primary?, shadow?, reflection?] })
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    if values.len() % 2 == 1 { values[middle] } else { 0.5 * (values[middle - 1] + values[middle]) }
}

/// What both said of a scene.
struct Measured {
    ratio: f64,
    rays_agree: bool,
    /// Of each preset: our full frame, and Embree's, over the adaptive one.
    adaptive: Vec<(Preset, [f64; 2])>,
}

/// The lanes that LANES asks for; `None` for the widest.
fn lanes() -> BenchResult<Option<Width>> {
    let Ok(words) = std::env::var("LANES") else { return Ok(None) };
    let lanes: usize = words.parse()?;
    let width = Width::available().find(|width| width.lanes() == lanes);
    Ok(Some(width.ok_or_else(|| format!("this processor has no vectors of {lanes} lanes"))?))
}

fn geometric_mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    f64::exp(values.map(f64::ln).sum::<f64>() / count)
}

fn measure(anchor: &Path, scene: &Path, name: &str, rounds: usize) -> BenchResult<Measured> {
    let options = DeviceOptions {
        device: std::env::var("DEVICE").map_or(Ok(DeviceChoice::OpenCl(None)), |words| words.parse())?,
        cpu_width: lanes()?,
        ..DeviceOptions::default()
    };
    let monitor = rarefy::Monitor::default();
    let prepared = PreparedScene::new(&rarefy::internal::scene::load(scene, &monitor)?, Shading::Anchor, &monitor)?;
    let mut renderer = Renderer::new(Arc::new(prepared), &options, &monitor)?;
    let frame = RenderOptions { width: SIZE, height: SIZE, mode: Mode::Full, ..RenderOptions::default() };
    let counted = renderer.render_exactly(&frame, Keep::COUNTERS)?;
    let rays = counted.stats.rays.ok_or("a counted frame without ray counts")?;
    let ours = [rays.primary, rays.shadow, rays.reflection + rays.refraction];
    renderer.render_exactly(&frame, Keep::default())?; // builds the timed program
    let (mut theirs, mut whole, mut kernel, mut ratios) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let mut their_rays = [0; 3];
    let presets = if std::env::var_os("ADAPTIVE").is_some() { &Preset::ALL[..] } else { &[] };
    let mut adaptive: Vec<[Vec<f64>; 2]> = vec![Default::default(); presets.len()];
    for _ in 0..rounds {
        let embree = run_anchor(anchor, scene)?;
        let (mut frame_ms, mut kernel_ms) = (Vec::new(), Vec::new());
        for _ in 0..FRAMES {
            let stats = renderer.render_exactly(&frame, Keep::default())?.stats;
            frame_ms.push(stats.frame_ms);
            kernel_ms.push(stats.stages_ms.iter().sum());
        }
        let ms = median(&mut frame_ms);
        for (&preset, ratios) in presets.iter().zip(&mut adaptive) {
            let frame = RenderOptions { mode: Mode::Adaptive, method: Method::from(preset), ..frame.clone() };
            let mut frame_ms = Vec::new();
            for _ in 0..FRAMES {
                frame_ms.push(renderer.render_exactly(&frame, Keep::default())?.stats.frame_ms);
            }
            let adaptive_ms = median(&mut frame_ms);
            ratios[0].push(ms / adaptive_ms);
            ratios[1].push(embree.frame_ms / adaptive_ms);
        }
        ratios.push(embree.frame_ms / ms);
        theirs.push(embree.frame_ms);
        whole.push(ms);
        kernel.push(median(&mut kernel_ms));
        their_rays = embree.rays;
    }
    // Mirrors are rare in some scenes: a kind of ray counts as at least a thousandth of all.
    let all: u64 = their_rays.iter().sum();
    let agrees = |(&a, b): (&u64, u64)| a.abs_diff(b) as f64 <= MOST_DIFFERENCE * b.max(all / 1000) as f64;
    let rays_agree = ours.iter().zip(their_rays).all(agrees);
    let ratio = median(&mut ratios);
    println!(
        "{name:<12} {:>9} | {:>8} {:>8} {:>8} | {:>8} {:>8} {:>8} | {:>9.1} {:>9.1} {:>9.1} | {ratio:>6.3} {:>6.3} {:>6.3}{}",
        renderer.triangle_count(),
        their_rays[0],
        their_rays[1],
        their_rays[2],
        ours[0],
        ours[1],
        ours[2],
        median(&mut theirs),
        median(&mut whole),
        median(&mut kernel),
        ratios[0],
        ratios[ratios.len() - 1],
        if rays_agree { "" } else { "  RAYS DIFFER BY MORE THAN 0.5 %" }
    );
    let adaptive =
        presets.iter().zip(&mut adaptive).map(|(&preset, [full, embree])| (preset, [median(full), median(embree)]));
    let adaptive: Vec<_> = adaptive.collect();
    for (preset, [full, embree]) in &adaptive {
        println!("{:<12} {preset}: {full:.3} times as fast as our full frame, {embree:.3} times as Embree's", "");
    }
    Ok(Measured { ratio, rays_agree, adaptive })
}

fn run() -> BenchResult<bool> {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with("--")).collect();
    let rounds = words.iter().find_map(|word| word.parse().ok()).unwrap_or(7).max(1);
    let names: Vec<&String> = words.iter().filter(|word| word.parse::<usize>().is_err()).collect();
    let folder = shared().join("scenes");
    if !folder.is_dir() {
        println!("skipped: ../shared/scenes is not here");
        return Ok(true);
    }
    let Some(anchor) = build_anchor() else { return Ok(true) };
    println!(
        "{rounds} rounds of {FRAMES} frames each, {SIZE}x{SIZE}, 2 threads; ratio = Embree's frame ms / Rarefy's frame ms"
    );
    println!(
        "{:<12} {:>9} | {:>26} | {:>26} | {:>9} {:>9} {:>9} | {:>6} {:>6} {:>6}",
        "", "", "Embree's rays", "Rarefy's rays", "Embree", "Rarefy", "Rarefy", "", "", ""
    );
    println!(
        "{:<12} {:>9} | {:>8} {:>8} {:>8} | {:>8} {:>8} {:>8} | {:>9} {:>9} {:>9} | {:>6} {:>6} {:>6}",
        "scene",
        "triangles",
        "primary",
        "shadow",
        "reflect.",
        "primary",
        "shadow",
        "reflect.",
        "frame ms",
        "frame ms",
        "kernel ms",
        "ratio",
        "least",
        "most"
    );
    let mut all: Vec<Measured> = Vec::new();
    for name in SCENES.into_iter().filter(|name| names.is_empty() || names.iter().any(|wanted| wanted == name)) {
        let scene = folder.join(name);
        if !scene.is_dir() {
            println!("skipped: {name} is not here");
            continue;
        }
        all.push(measure(&anchor, &scene, name, rounds)?);
    }
    let agree = all.iter().all(|measured| measured.rays_agree);
    if let Some(first) = all.first() {
        let mean = geometric_mean(all.iter().map(|measured| measured.ratio));
        let verdict = if mean >= GOAL { "reached" } else { "missed" };
        println!(
            "geometric mean of the ratios: {mean:.3} of Embree; goal of OpenCL against single rays {GOAL}: {verdict}"
        );
        for (i, (preset, _)) in first.adaptive.iter().enumerate() {
            let [full, embree] = [0, 1].map(|of| geometric_mean(all.iter().map(|measured| measured.adaptive[i].1[of])));
            println!(
                "{preset}, geometric mean: {full:.3} times as fast as our full frames, {embree:.3} times as Embree's"
            );
        }
    }
    if !agree {
        println!("the ray counts differ: the two did not do equal work");
    }
    Ok(agree)
}

fn main() -> ExitCode {
    match run() {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("full_tracing: {error}");
            ExitCode::from(2)
        }
    }
}
