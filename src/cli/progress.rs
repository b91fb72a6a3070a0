// SPDX-License-Identifier: MIT OR Apache-2.0
//! Long work with a progress bar, on a terminal only and only if it takes a while.

use std::path::Path;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use rarefy::internal::device::open::DeviceOptions;
use rarefy::internal::monitor::{Event, Monitor};
use rarefy::internal::prepare::{PreparedScene, Shading};
use rarefy::internal::render::renderer::Renderer;
use rarefy::internal::scene::doctor::notices;
use rarefy::internal::scene::{self, LoadOptions, builtin};
use rarefy::{Error, Result, Scene};

use super::interrupt::Interrupt;
use super::output::{note_all, warn_all};
use super::outputs::Outputs;

/// Nothing is shown before this much time has passed.
const QUIET: Duration = Duration::from_secs(1);

/// A bar that names its phase.
pub struct Progress {
    started: Instant,
    bar: ProgressBar,
    phase: Mutex<String>,
}

impl Progress {
    /// A bar that stays hidden for the first second, and for good where standard error is no terminal.
    pub fn new() -> Self {
        let bar = ProgressBar::with_draw_target(Some(1000), ProgressDrawTarget::hidden());
        if let Ok(style) = ProgressStyle::with_template("{msg:>12} [{bar:40}] {percent}%") {
            bar.set_style(style.progress_chars("=> "));
        }
        Progress { started: Instant::now(), bar, phase: Mutex::new(String::new()) }
    }

    /// Shows that `share` of `phase` is done.
    pub fn update(&self, phase: &str, share: f32) {
        if self.started.elapsed() < QUIET {
            return;
        }
        if let Ok(mut current) = self.phase.lock()
            && *current != phase
        {
            if current.is_empty() {
                self.bar.set_draw_target(ProgressDrawTarget::stderr());
            }
            *current = phase.to_owned();
            self.bar.set_message(phase.to_owned());
        }
        self.bar.set_position((share.clamp(0.0, 1.0) * 1000.0) as u64);
    }

    /// Takes the bar away.
    pub fn clear(&self) {
        self.bar.finish_and_clear();
    }
}

/// Does `work` with a bar that is taken away at its end; Ctrl-C cancels it.
pub fn with_bar<T>(interrupt: &Interrupt, work: impl FnOnce(&Monitor) -> Result<T>) -> Result<T> {
    let progress = Arc::new(Progress::new());
    let shown = Arc::clone(&progress);
    let monitor = Monitor::new(move |event| {
        if let Event::Progress { phase, share } = event {
            shown.update(phase, share);
        }
    });
    let done = interrupt.watch(|cancel| work(&monitor.with_cancel(cancel)));
    progress.clear();
    done
}

/// Does `work` with a renderer, with a bar.
pub fn watched<T>(
    renderer: &mut Renderer,
    interrupt: &Interrupt,
    work: impl FnOnce(&mut Renderer) -> Result<T>,
) -> Result<T> {
    with_bar(interrupt, |monitor| {
        renderer.set_monitor(monitor);
        let done = work(renderer);
        renderer.set_monitor(&Monitor::default());
        done
    })
}

/// The scene that `name` means: a file or folder, else a built-in scene.
///
/// # Errors
/// Those of loading, and a file of the scene that is about to be overwritten.
pub fn load_scene(name: &Path, outputs: &Outputs, interrupt: &Interrupt) -> Result<Scene> {
    with_bar(interrupt, |monitor| load(name, outputs, monitor))
}

fn load(path: &Path, outputs: &Outputs, monitor: &Monitor) -> Result<Scene> {
    match path.to_str() {
        Some(name) if builtin::NAMES.contains(&name) && !path.exists() => builtin::to_scene_watched(name, monitor),
        _ => {
            let (scene, files) = scene::load_listing(path, &LoadOptions::default(), monitor)?;
            outputs.were_read(&files)?;
            Ok(scene)
        }
    }
}

/// A scene that was loaded and prepared.
pub struct Loaded {
    pub prepared: PreparedScene,
    /// How long loading took; preparing counts for itself.
    pub load_ms: f64,
    warnings: Vec<String>,
    notices: Vec<String>,
}

impl Loaded {
    /// Tells what a user should know about the scene.
    pub fn tell(&self) {
        warn_all(&self.warnings);
        note_all(&self.notices);
    }
}

/// Loads the scene that `name` means and prepares it for `shading`, or reads a baked one.
pub fn load_prepared(name: &Path, shading: Shading, outputs: &Outputs, interrupt: &Interrupt) -> Result<Loaded> {
    with_bar(interrupt, |monitor| prepare(name, shading, outputs, monitor))
}

/// Reads a baked scene, whatever its shading.
pub fn load_baked(name: &Path, interrupt: &Interrupt) -> Result<PreparedScene> {
    with_bar(interrupt, |monitor| PreparedScene::from_baked_file(name, monitor))
}

fn prepare(name: &Path, shading: Shading, outputs: &Outputs, monitor: &Monitor) -> Result<Loaded> {
    let started = Instant::now();
    if PreparedScene::is_baked_file(name) {
        let prepared = PreparedScene::from_baked_file(name, monitor)?;
        if prepared.shading() != shading {
            let message = format!(
                "{} is baked with `{}` shading and cannot be drawn with another; bake it again with `{shading}`",
                name.display(),
                prepared.shading()
            );
            return Err(Error::argument("--shading", message));
        }
        let load_ms = started.elapsed().as_secs_f64() * 1e3;
        return Ok(Loaded { prepared, load_ms, warnings: Vec::new(), notices: Vec::new() });
    }
    let scene = load(name, outputs, monitor)?;
    let load_ms = started.elapsed().as_secs_f64() * 1e3;
    let warnings = scene.warnings().to_vec();
    let notices = notices(&scene);
    Ok(Loaded { prepared: PreparedScene::new(&scene, shading, monitor)?, load_ms, warnings, notices })
}

/// Loads a scene and makes a renderer of it; the milliseconds are those of the loading.
pub fn make_renderer(
    name: &Path,
    shading: Shading,
    options: &DeviceOptions,
    outputs: &Outputs,
    interrupt: &Interrupt,
) -> Result<(Renderer, f64)> {
    let loaded = load_prepared(name, shading, outputs, interrupt)?;
    loaded.tell();
    let Loaded { prepared, load_ms, .. } = loaded;
    let prepared = Arc::new(prepared);
    let renderer = with_bar(interrupt, |monitor| Renderer::new(prepared, options, monitor))?;
    warn_all(renderer.notices());
    Ok((renderer, load_ms))
}
