// SPDX-License-Identifier: MIT OR Apache-2.0
//! Counted frames: a full one, and adaptive ones that are judged by it.
//!
//! One full frame serves for any number of methods, which is what tables of methods are made of.

use crate::analysis::metrics::{self, Quality, Rgb8, WrongPixels};
use crate::error::Result;
use crate::layout::*;
use crate::method::counts::Keep;
use crate::method::options::{Mode, RenderOptions};
use crate::render::frame::{Frame, FrameStats};
use crate::render::renderer::Renderer;

/// A full frame with counters, and its planes that adaptive frames are compared by.
#[derive(Debug, Clone)]
pub struct Reference {
    /// The picture with its counters.
    pub frame: Frame,
    /// The object of each sample.
    pub objects: Vec<u32>,
    /// The shadow bits of each sample.
    pub shadows: Vec<u32>,
}

/// An adaptive frame with counters beside its reference.
#[derive(Debug, Clone)]
pub struct Counted {
    /// The picture with its counters.
    pub frame: Frame,
    /// The class plane, one word a sample.
    pub classes: Vec<u32>,
    /// Samples that show another object than full tracing.
    pub wrong_object: WrongPixels,
    /// Samples with other shadow bits than full tracing.
    pub wrong_shadow: WrongPixels,
}

/// Traversal steps and triangle tests of a frame.
pub fn traversal_work(stats: &FrameStats) -> u64 {
    stats.work.map_or(0, |work| work.traversal())
}

impl Reference {
    /// Draws the full frame of `options`.
    ///
    /// # Errors
    /// Whatever drawing reports.
    pub fn draw(renderer: &mut Renderer, options: &RenderOptions) -> Result<Self> {
        let options = RenderOptions { mode: Mode::Full, ..options.clone() };
        let frame = renderer.render_exactly(&options, kept())?;
        Ok(Reference { frame, objects: renderer.plane(PLANE_OBJECT)?, shadows: renderer.plane(PLANE_SHADOW)? })
    }

    /// Traversal work of the average ray of this frame, shadow and secondary rays of its pixel included.
    pub fn work_of_average_ray(&self) -> f64 {
        traversal_work(&self.frame.stats) as f64 / self.objects.len() as f64
    }
}

impl Counted {
    /// Draws the adaptive frame of `options`, which must be of the reference's size and samples.
    ///
    /// # Errors
    /// Whatever drawing reports.
    pub fn draw(renderer: &mut Renderer, reference: &Reference, options: &RenderOptions) -> Result<Self> {
        let options = RenderOptions { mode: Mode::Adaptive, ..options.clone() };
        let frame = renderer.render_exactly(&options, kept().and(Keep::planes(&[PLANE_CLASS])))?;
        let (width, height) = options.sample_size();
        let mut wrong = |plane, right: &[u32]| metrics::wrong_pixels(right, &renderer.plane(plane)?, width, height);
        let wrong_object = wrong(PLANE_OBJECT, &reference.objects)?;
        let wrong_shadow = wrong(PLANE_SHADOW, &reference.shadows)?;
        Ok(Counted { frame, classes: renderer.plane(PLANE_CLASS)?, wrong_object, wrong_shadow })
    }

    /// Quality of `picture`, drawn as this frame was, beside the full one.
    ///
    /// # Errors
    /// Pictures of other sizes.
    pub fn quality_of(&self, picture: &[u32], full: &[u32], options: &RenderOptions) -> Result<Quality> {
        let (width, height) = (options.width, options.height);
        metrics::compare_interpolated(
            Rgb8::new(width, height, full)?,
            Rgb8::new(width, height, picture)?,
            &pixels_with_interpolated_samples(&self.classes, options),
        )
    }

    /// Traversal work of base, traced and corrected pixels.
    pub fn work_by_class(&self) -> [u64; 3] {
        self.frame.stats.work_by_class.unwrap_or_default()
    }

    /// Traversal work of a packed ray over that of an average ray of the full frame; `None` without packed rays.
    pub fn packed_ray_work_ratio(&self, reference: &Reference) -> Option<f64> {
        let traced = self.frame.stats.pixels.traced;
        (traced > 0).then(|| self.work_by_class()[1] as f64 / traced as f64 / reference.work_of_average_ray())
    }
}

fn kept() -> Keep {
    Keep::planes(&[PLANE_OBJECT, PLANE_SHADOW]).and(Keep::COUNTERS)
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
