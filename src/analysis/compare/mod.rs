// SPDX-License-Identifier: MIT OR Apache-2.0
//! Full and adaptive frames of one scene, in turn: speed, work and quality.

pub mod counted;
pub mod rounds;

use crate::analysis::compare::counted::{Counted, Reference, traversal_work};
use crate::analysis::compare::rounds::{Rounds, median, warm_up};
use crate::analysis::metrics::{Quality, WrongPixels};
use crate::error::Result;
use crate::method::counts::Keep;
use crate::method::options::{Mode, RenderOptions};
use crate::monitor::Monitor;
use crate::render::frame::{Frame, FrameStats};
use crate::render::renderer::Renderer;

/// What a comparison found.
#[derive(Debug, Clone)]
pub struct Comparison {
    /// Timed frames of each mode.
    pub frames: u32,
    /// The full frame: median times, with counters.
    pub full: FrameStats,
    /// The adaptive frame: median times, with counters.
    pub adaptive: FrameStats,
    /// Median over the rounds of full over adaptive frame time.
    pub speedup: f64,
    /// The adaptive picture against the full one.
    pub quality: Quality,
    /// Pixels that show another object than full tracing.
    pub wrong_object: WrongPixels,
    /// Pixels with other shadow bits than full tracing.
    pub wrong_shadow: WrongPixels,
    /// Traversal work of the adaptive frame by pixel class: base, traced, corrected.
    pub work_by_class: [u64; 3],
    /// Traversal work of a packed ray over that of an average ray of the full frame; `None` without packed rays.
    pub packed_ray_work_ratio: Option<f64>,
    /// The class plane of the adaptive frame, one word a sample.
    pub classes: Vec<u32>,
    /// The full picture.
    pub full_picture: Vec<u32>,
    /// The adaptive picture.
    pub adaptive_frame: Frame,
}

impl Comparison {
    /// Traversal steps and triangle tests of full over adaptive.
    pub fn work_speedup(&self) -> f64 {
        traversal_work(&self.full) as f64 / traversal_work(&self.adaptive) as f64
    }

    /// Speedup times the share of traced pixels, correction included: 1 if every skipped pixel was free.
    pub fn efficiency(&self) -> f64 {
        self.speedup * self.adaptive.ray_traced_ratio_with_correction()
    }

    /// Share of the adaptive frame's traversal work that correction rays cost.
    pub fn correction_work_ratio(&self) -> f64 {
        self.work_by_class[2] as f64 / self.work_by_class.iter().sum::<u64>() as f64
    }
}

/// Draws `frames` frames of each mode in turn and compares them. The fall-back to full tracing is switched off.
/// The renderer's monitor watches.
///
/// # Errors
/// Whatever drawing reports.
pub fn compare(renderer: &mut Renderer, options: &RenderOptions, frames: u32) -> Result<Comparison> {
    let monitor = renderer.monitor().clone();
    monitor.restart();
    let compared = compare_for(&monitor, renderer, options, frames);
    renderer.set_monitor(&monitor);
    compared
}

fn compare_for(monitor: &Monitor, renderer: &mut Renderer, options: &RenderOptions, frames: u32) -> Result<Comparison> {
    let full_options = RenderOptions { mode: Mode::Full, ..options.clone() };
    let adaptive_options = RenderOptions { mode: Mode::Adaptive, ..options.clone() };
    // Two counting frames, two for each round, and the metrics, which take about as long as two.
    let steps = (2 * frames + 4) as f32;
    let step = |from: u32, to: u32| monitor.part("frames", from as f32 / steps, to as f32 / steps);
    // The counting frames come first: they also warm up, and their planes are what pixels are compared by.
    renderer.set_monitor(&step(0, 1));
    let reference = Reference::draw(renderer, options)?;
    renderer.set_monitor(&step(1, 2));
    let counted = Counted::draw(renderer, &reference, options)?;
    let packed_ray_work_ratio = counted.packed_ray_work_ratio(&reference);
    let Reference { frame: full, .. } = reference;

    renderer.set_monitor(&step(2, 2));
    warm_up(renderer, options)?;
    let mut rounds = Rounds::default();
    let (mut full_picture, mut adaptive) = (full.pixels, counted.frame.clone());
    for round in 0..frames {
        renderer.set_monitor(&step(2 * round + 2, 2 * round + 3));
        let full = renderer.render_exactly(&full_options, Keep::default())?;
        renderer.set_monitor(&step(2 * round + 3, 2 * round + 4));
        adaptive = renderer.render_exactly(&adaptive_options, Keep::default())?;
        rounds.add(full.stats.frame_ms, &adaptive.stats);
        full_picture = full.pixels;
    }

    monitor.check()?;
    let quality = counted.quality_of(&adaptive.pixels, &full_picture, options)?;
    monitor.check()?;
    step(0, 2 * frames + 4).tell(1.0);

    let mut full_stats = full.stats;
    let work_by_class = counted.work_by_class();
    let Counted { frame, classes, wrong_object, wrong_shadow } = counted;
    let mut adaptive_stats = frame.stats;
    if frames > 0 {
        full_stats.frame_ms = median(&rounds.full_ms);
        adaptive_stats.frame_ms = median(&rounds.adaptive_ms);
        for (stage, times) in adaptive_stats.stages_ms.iter_mut().zip(&rounds.stages_ms) {
            *stage = median(times);
        }
    }
    Ok(Comparison {
        frames,
        speedup: median(&rounds.speedup),
        full: full_stats,
        adaptive: adaptive_stats,
        quality,
        wrong_object,
        wrong_shadow,
        work_by_class,
        packed_ray_work_ratio,
        classes,
        full_picture,
        adaptive_frame: adaptive,
    })
}
