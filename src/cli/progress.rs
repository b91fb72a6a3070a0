// SPDX-License-Identifier: MIT OR Apache-2.0
//! Loading a scene and making a renderer with a progress bar, on a terminal only and only if it takes a while.

use std::path::Path;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use rarefy::renderer::{Renderer, RendererOptions};
use rarefy::{Result, Scene, builtin, scene};

use super::output::warn_all;

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

/// The scene that `name` means: a file or folder, else a built-in scene.
pub fn load_scene(name: &str, progress: &Progress) -> Result<Scene> {
    let path = Path::new(name);
    if !path.exists() && builtin::NAMES.contains(&name) {
        return builtin::to_scene(name);
    }
    scene::load(path, &|phase, share| progress.update(phase, share))
}

/// Loads a scene and makes a renderer of it; the milliseconds are those of the loading.
pub fn make_renderer(name: &str, options: &RendererOptions) -> Result<(Renderer, f64)> {
    let progress = Progress::new();
    let started = Instant::now();
    let scene = load_scene(name, &progress)?;
    let load_ms = started.elapsed().as_secs_f64() * 1e3;
    let warnings = scene.warnings.clone();
    let renderer = Renderer::new(scene, options, &|phase, share| progress.update(phase, share));
    progress.clear();
    let renderer = renderer?;
    warn_all(&warnings);
    warn_all(renderer.notices());
    Ok((renderer, load_ms))
}
