// SPDX-License-Identifier: MIT OR Apache-2.0
//! Full and adaptive frames of one scene, in turn: speed, work and quality.

use crate::analysis::metrics::{self, Quality, Rgb8, WrongPixels};
use crate::error::Result;
use crate::layout::*;
use crate::method::counts::Keep;
use crate::method::options::{Mode, RenderOptions};
use crate::monitor::Monitor;
use crate::render::frame::{Frame, FrameStats};
use crate::render::renderer::Renderer;

/// Side of the frames that only build programs, in pixels.
const WARM_UP_SIDE: u32 = 16;

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
        let work = |stats: &FrameStats| stats.work.map_or(0, |w| w.traversal()) as f64;
        work(&self.full) / work(&self.adaptive)
    }

    /// Speedup times the share of traced pixels, correction included: 1 if every skipped pixel was free.
    pub fn efficiency(&self) -> f64 {
        self.speedup * self.adaptive.ray_traced_ratio_with_correction()
    }

    /// Share of the adaptive frame's traversal work that correction rays cost.
    pub fn correction_work_ratio(&self) -> f64 {
        self.work_by_class[2] as f64 / self.work_by_class.iter().sum::<u64>() as f64
    }

    /// Traversal work of a packed ray over that of an average ray of the full frame; `None` without packed rays.
    pub fn packed_ray_work_ratio(&self) -> Option<f64> {
        let p = &self.adaptive.pixels;
        let all = (p.base + p.traced + p.interpolated + p.corrected) as f64;
        let average = self.full.work?.traversal() as f64 / all;
        (p.traced > 0).then(|| self.work_by_class[1] as f64 / p.traced as f64 / average)
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
    let keep = Keep::planes(&[PLANE_OBJECT, PLANE_SHADOW]).and(Keep::COUNTERS);
    renderer.set_monitor(&step(0, 1));
    let full = renderer.render_exactly(&full_options, keep)?;
    let full_objects = renderer.plane(PLANE_OBJECT)?;
    let full_shadows = renderer.plane(PLANE_SHADOW)?;
    renderer.set_monitor(&step(1, 2));
    let counted = renderer.render_exactly(&adaptive_options, keep.and(Keep::planes(&[PLANE_CLASS])))?;
    let (width, height) = options.sample_size();
    let wrong_object = metrics::wrong_pixels(&full_objects, &renderer.plane(PLANE_OBJECT)?, width, height)?;
    let wrong_shadow = metrics::wrong_pixels(&full_shadows, &renderer.plane(PLANE_SHADOW)?, width, height)?;
    drop((full_objects, full_shadows));
    let classes = renderer.plane(PLANE_CLASS)?;
    renderer.set_monitor(&step(2, 2));

    // Programs without counters are built in frames that cost nothing else.
    for mode in [&full_options, &adaptive_options] {
        let small = RenderOptions { width: WARM_UP_SIDE, height: WARM_UP_SIDE, ..mode.clone() };
        renderer.render_exactly(&small, Keep::default())?;
    }
    let mut rounds = Rounds::default();
    let (mut full_picture, mut adaptive) = (full.pixels, counted.clone());
    for round in 0..frames {
        renderer.set_monitor(&step(2 * round + 2, 2 * round + 3));
        let full = renderer.render_exactly(&full_options, Keep::default())?;
        renderer.set_monitor(&step(2 * round + 3, 2 * round + 4));
        adaptive = renderer.render_exactly(&adaptive_options, Keep::default())?;
        rounds.add(full.stats.frame_ms, &adaptive.stats);
        full_picture = full.pixels;
    }
    monitor.check()?;

    let (width, height) = (options.width, options.height);
    let interpolated = pixels_with_interpolated_samples(&classes, options);
    let quality = metrics::compare_interpolated(
        Rgb8::new(width, height, &full_picture)?,
        Rgb8::new(width, height, &adaptive.pixels)?,
        &interpolated,
    )?;
    monitor.check()?;
    step(0, 2 * frames + 4).tell(1.0);
    let mut full_stats = full.stats;
    let work_by_class = counted.stats.work_by_class.unwrap_or_default();
    let mut adaptive_stats = counted.stats;
    if frames > 0 {
        full_stats.frame_ms = median(&mut rounds.full_ms);
        adaptive_stats.frame_ms = median(&mut rounds.adaptive_ms);
        for (stage, times) in adaptive_stats.stages_ms.iter_mut().zip(&mut rounds.stages_ms) {
            *stage = median(times);
        }
    }
    Ok(Comparison {
        frames,
        speedup: median(&mut rounds.speedup),
        full: full_stats,
        adaptive: adaptive_stats,
        quality,
        wrong_object,
        wrong_shadow,
        work_by_class,
        classes,
        full_picture,
        adaptive_frame: adaptive,
    })
}

/// The times of all rounds.
#[derive(Default)]
struct Rounds {
    full_ms: Vec<f64>,
    adaptive_ms: Vec<f64>,
    speedup: Vec<f64>,
    stages_ms: [Vec<f64>; 8],
}

impl Rounds {
    fn add(&mut self, full_ms: f64, adaptive: &FrameStats) {
        self.full_ms.push(full_ms);
        self.adaptive_ms.push(adaptive.frame_ms);
        self.speedup.push(full_ms / adaptive.frame_ms);
        for (times, ms) in self.stages_ms.iter_mut().zip(adaptive.stages_ms) {
            times.push(ms);
        }
    }
}

/// Which pixels have a sample that was left interpolated.
fn pixels_with_interpolated_samples(classes: &[u32], options: &RenderOptions) -> Vec<bool> {
    let (width, samples) = (options.width as usize, options.samples as usize);
    let mut interpolated = vec![false; width * options.height as usize];
    for (y, row) in classes.chunks_exact(width * samples).enumerate() {
        for (x, class) in row.iter().enumerate() {
            interpolated[y / samples * width + x / samples] |= class & CLASS_MASK == CLASS_INTERPOLATED;
        }
    }
    interpolated
}

fn median(values: &mut [f64]) -> f64 {
    if values.is_empty() {
        return f64::NAN;
    }
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    if values.len() % 2 == 1 { values[middle] } else { 0.5 * (values[middle - 1] + values[middle]) }
}

#[cfg(test)]
mod tests {
    use super::median;

    #[test]
    fn the_median_is_the_middle_value_or_the_mean_of_two() {
        assert_eq!(median(&mut [3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&mut [4.0, 1.0, 2.0, 3.0]), 2.5);
        assert!(median(&mut []).is_nan());
    }
}
