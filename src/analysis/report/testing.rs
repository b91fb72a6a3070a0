// SPDX-License-Identifier: MIT OR Apache-2.0
//! Figures for tests of what is made of figures.

use super::figures::{Figures, STAGES, Times, WaveCosts, Waves};
use crate::analysis::compare::rounds::Spread;

/// Figures that agree with each other; another `seed`, others. They are binary fractions, which JSON gives back exactly.
pub fn figures(seed: u32) -> Figures {
    let x = f64::from(seed);
    let spread = |median: f64| Spread { median, least: 0.75 * median, most: 1.25 * median };
    let mut stages_ms = [1.0; STAGES];
    stages_ms[0] = 40.0 + x;
    let sum = stages_ms.iter().sum::<f64>();
    let waves =
        WaveCosts { speedup: [2.0, 1.75, 1.5], full: [10.0, 11.0, 12.0], stages: vec![[1.0, 1.25, 1.5]; STAGES - 1] };
    Figures {
        triangles: 1000 + u64::from(seed),
        width: 64,
        height: 64,
        samples: 1,
        reflective: 0.125,
        base: 0.25,
        traced: 0.25 + (1.0 + x) / 4096.0,
        traced_with_correction: 0.5 + x / 4096.0,
        failed: [0.125, 0.0625, 0.03125, 0.015625, 0.0, 0.25, 0.5],
        psnr_db: Some(40.0 + 0.125 * x),
        ssim: 0.9375,
        flip_mean: 0.0078125,
        flip_p99: 0.0625,
        wrong_object: 5,
        wrong_object_cluster: 2,
        wrong_shadow: 17,
        full_work: 1_000_000,
        work_by_class: [250_000, 80_000, 20_000 + u64::from(seed)],
        packed_ray: Some(1.5),
        times: Some(Times {
            repeats: 3,
            full_ms: spread(1.75 * sum),
            adaptive_ms: spread(sum),
            speedup: spread(1.75),
            stages_ms,
        }),
        waves: Some(Waves { lanes: [32, 64, 128], by_loop: waves.clone(), by_item: waves }),
        pictures: Vec::new(),
    }
}
