// SPDX-License-Identifier: MIT OR Apache-2.0
//! What one measurement found: the raw figures that all tables of a report are made of.

use serde::{Deserialize, Serialize};

use super::table::Picture;
use crate::analysis::compare::counted::{Counted, Reference, traversal_work};
use crate::analysis::compare::rounds::{Rounds, Spread};
use crate::analysis::metrics::Quality;
use crate::analysis::wave_model::{LockStep, WAVES, WaveModel};
use crate::device::stage::Stage;

/// Stages of an adaptive frame and what lies outside of them.
pub const STAGES: usize = Stage::ALL.len() + 1;

/// The names of the stages, as the paper's table has them.
pub fn stage_names() -> [&'static str; STAGES] {
    let mut names = ["other"; STAGES];
    for (name, stage) in names.iter_mut().zip(Stage::ALL) {
        *name = stage.name();
    }
    names
}

/// What one measurement found: a scene drawn in full and by one method.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Figures {
    /// Triangles of the scene.
    pub triangles: u64,
    /// Width of the picture in pixels.
    pub width: u32,
    /// Height of the picture in pixels.
    pub height: u32,
    /// Samples per pixel and axis.
    pub samples: u32,
    /// Share of the samples that see a mirror or glass first.
    pub reflective: f64,
    /// Share of the samples that are base ones.
    pub base: f64,
    /// Share that was traced before correction, base ones included: the paper's ratio.
    pub traced: f64,
    /// The same with the rays of post-correction.
    pub traced_with_correction: f64,
    /// Share of the samples that failed each test, in the order of the fail mask; one may fail several.
    pub failed: [f64; 7],
    /// PSNR in dB over all pixels; none if the pictures are equal.
    pub psnr_db: Option<f64>,
    /// Mean SSIM of the luma.
    pub ssim: f64,
    /// Mean FLIP error.
    pub flip_mean: f64,
    /// The FLIP error that 99 % of the pixels do not exceed.
    pub flip_p99: f64,
    /// Samples that show another object than full tracing.
    pub wrong_object: u64,
    /// The largest group of such samples.
    pub wrong_object_cluster: u64,
    /// Samples with other shadow bits than full tracing.
    pub wrong_shadow: u64,
    /// Traversal work of the full frame.
    pub full_work: u64,
    /// Traversal work of the adaptive frame's base, packed and corrected pixels.
    pub work_by_class: [u64; 3],
    /// Traversal work of a packed ray over that of an average ray; none without packed rays.
    pub packed_ray: Option<f64>,
    /// Times, where frames were timed.
    pub times: Option<Times>,
    /// The wave model, where it was asked for.
    pub waves: Option<Waves>,
    /// Pictures that were written.
    pub pictures: Vec<Picture>,
}

/// Times of full and adaptive frames that were drawn in turn.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Times {
    /// Frames of each kind.
    pub repeats: u32,
    /// Full frames, milliseconds.
    pub full_ms: Spread,
    /// Adaptive frames, milliseconds.
    pub adaptive_ms: Spread,
    /// Full over adaptive, round by round.
    pub speedup: Spread,
    /// Medians of the stages, milliseconds, and of what lies outside of them.
    pub stages_ms: [f64; STAGES],
}

/// What waves in lock step pay.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Waves {
    /// The sizes of waves that were modelled, in lanes.
    pub lanes: [u32; 3],
    /// Where lanes wait for each other after each loop, as in whole ray trees in one kernel.
    pub by_loop: WaveCosts,
    /// Where they wait at the end of an item.
    pub by_item: WaveCosts,
}

/// What waves in lock step pay, in millions of steps, launches included.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WaveCosts {
    /// Full over adaptive, for each size.
    pub speedup: [f64; 3],
    /// The full frame, for each size.
    pub full: [f64; 3],
    /// The stages of the adaptive frame, for each size; 0 for one that was not launched.
    pub stages: Vec<[f64; 3]>,
}

impl Times {
    /// Those of `rounds`.
    pub fn new(rounds: &Rounds) -> Self {
        let adaptive_ms = Spread::of(&rounds.adaptive_ms);
        let mut stages_ms = [0.0; STAGES];
        for (ms, times) in stages_ms.iter_mut().zip(&rounds.stages_ms) {
            *ms = crate::analysis::compare::rounds::median(times);
        }
        stages_ms[STAGES - 1] = (adaptive_ms.median - stages_ms.iter().sum::<f64>()).max(0.0);
        Times {
            repeats: rounds.speedup.len() as u32,
            full_ms: Spread::of(&rounds.full_ms),
            adaptive_ms,
            speedup: Spread::of(&rounds.speedup),
            stages_ms,
        }
    }

    /// The share of the adaptive frame's time that one stage takes.
    pub fn share(&self, stage: Stage) -> f64 {
        self.stages_ms[stage as usize] / self.stages_ms.iter().sum::<f64>()
    }
}

impl Waves {
    /// Those of `model`.
    pub fn new(model: &WaveModel) -> Self {
        Waves {
            lanes: WAVES.map(|lanes| lanes as u32),
            by_loop: WaveCosts::new(model, LockStep::ByLoop),
            by_item: WaveCosts::new(model, LockStep::ByItem),
        }
    }
}

impl WaveCosts {
    fn new(model: &WaveModel, lock_step: LockStep) -> Self {
        let millions = |cost: f64| cost / 1e6;
        let by_wave = |value: &dyn Fn(usize) -> f64| [0, 1, 2].map(value);
        let of_stage = |stage: Stage| {
            let found = model.adaptive.iter().find(|cost| cost.stage == stage);
            by_wave(&|wave| found.map_or(0.0, |cost| millions(cost.cost(lock_step, wave))))
        };
        WaveCosts {
            speedup: by_wave(&|wave| model.speedup(lock_step, wave)),
            full: by_wave(&|wave| millions(model.full.iter().map(|cost| cost.cost(lock_step, wave)).sum())),
            stages: Stage::ALL.map(of_stage).to_vec(),
        }
    }
}

impl Figures {
    /// Those of a counted frame beside its reference, of a scene with so many triangles; `reflective` of its samples see a
    /// mirror or glass.
    pub fn new(
        reference: &Reference,
        counted: &Counted,
        quality: &Quality,
        triangles: usize,
        samples: u32,
        reflective: f64,
    ) -> Self {
        let stats = &counted.frame.stats;
        let all = reference.objects.len() as f64;
        Figures {
            triangles: triangles as u64,
            width: counted.frame.width,
            height: counted.frame.height,
            samples,
            reflective,
            base: stats.pixels.base as f64 / all,
            traced: stats.ray_traced_ratio(),
            traced_with_correction: stats.ray_traced_ratio_with_correction(),
            failed: stats.failed_tests.unwrap_or_default().map(|count| count as f64 / all),
            psnr_db: quality.psnr_db,
            ssim: quality.ssim,
            flip_mean: quality.flip_mean,
            flip_p99: quality.flip_p99,
            wrong_object: counted.wrong_object.count,
            wrong_object_cluster: counted.wrong_object.largest_cluster,
            wrong_shadow: counted.wrong_shadow.count,
            full_work: traversal_work(&reference.frame.stats),
            work_by_class: counted.work_by_class(),
            packed_ray: counted.packed_ray_work_ratio(reference),
            times: None,
            waves: None,
            pictures: Vec::new(),
        }
    }

    /// Traversal work of the adaptive frame.
    pub fn adaptive_work(&self) -> u64 {
        self.work_by_class.iter().sum()
    }

    /// Traversal work of full over adaptive.
    pub fn work_speedup(&self) -> f64 {
        self.full_work as f64 / self.adaptive_work() as f64
    }

    /// Share of the adaptive frame's traversal work that correction takes.
    pub fn correction_work(&self) -> f64 {
        self.work_by_class[2] as f64 / self.adaptive_work() as f64
    }

    /// Samples of the picture.
    pub fn sample_count(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height) * u64::from(self.samples).pow(2)
    }

    /// A picture of one of the kinds that measurements write.
    pub fn picture(&self, kind: &str) -> Option<&Picture> {
        let ending = format!("-{kind}.png");
        self.pictures.iter().find(|picture| picture.file.ends_with(&ending))
    }
}
