// SPDX-License-Identifier: MIT OR Apache-2.0
//! Times of frames that were drawn in turn, round by round.

use serde::{Deserialize, Serialize};

use crate::device::stage::Stage;
use crate::error::Result;
use crate::method::counts::Keep;
use crate::method::options::{Mode, RenderOptions};
use crate::render::frame::FrameStats;
use crate::render::renderer::Renderer;

/// Side of the frames that only build programs, in pixels.
const WARM_UP_SIDE: u32 = 16;

/// The times of all rounds: a full and an adaptive frame each.
#[derive(Debug, Clone, Default)]
pub struct Rounds {
    /// Of the full frames, milliseconds.
    pub full_ms: Vec<f64>,
    /// Of the adaptive frames, milliseconds.
    pub adaptive_ms: Vec<f64>,
    /// Full over adaptive, in each round.
    pub speedup: Vec<f64>,
    /// Of each stage of the adaptive frames, milliseconds.
    pub stages_ms: [Vec<f64>; Stage::ALL.len()],
}

/// The middle of several values, and how far they lie apart.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// The middle value, or the mean of the two middle ones.
    pub median: f64,
    /// The least value.
    pub least: f64,
    /// The greatest value.
    pub most: f64,
}

impl Rounds {
    /// Adds a round.
    pub fn add(&mut self, full_ms: f64, adaptive: &FrameStats) {
        self.full_ms.push(full_ms);
        self.adaptive_ms.push(adaptive.frame_ms);
        self.speedup.push(full_ms / adaptive.frame_ms);
        for (times, ms) in self.stages_ms.iter_mut().zip(adaptive.stages_ms) {
            times.push(ms);
        }
    }
}

impl Spread {
    /// That of `values`; not a number if there are none.
    pub fn of(values: &[f64]) -> Self {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let at = |index: usize| sorted.get(index).copied().unwrap_or(f64::NAN);
        Spread { median: median(values), least: at(0), most: at(sorted.len().saturating_sub(1)) }
    }

    /// Half the distance of the extremes as a share of the median.
    pub fn relative(&self) -> f64 {
        0.5 * (self.most - self.least) / self.median
    }
}

/// The middle value, or the mean of the two middle ones; not a number if there are none.
pub fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let middle = sorted.len() / 2;
    match sorted.len() {
        0 => f64::NAN,
        n if n % 2 == 1 => sorted[middle],
        _ => 0.5 * (sorted[middle - 1] + sorted[middle]),
    }
}

/// Builds the programs that uncounted frames of both modes need, in frames that cost nothing else.
///
/// # Errors
/// Whatever drawing reports.
pub fn warm_up(renderer: &mut Renderer, options: &RenderOptions) -> Result<()> {
    for mode in [Mode::Full, Mode::Adaptive] {
        let small = RenderOptions { width: WARM_UP_SIDE, height: WARM_UP_SIDE, mode, ..options.clone() };
        renderer.render_exactly(&small, Keep::default())?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_is_the_middle_value_or_the_mean_of_two() {
        assert_eq!(median(&[3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&[4.0, 1.0, 2.0, 3.0]), 2.5);
        assert!(median(&[]).is_nan());
    }

    #[test]
    fn a_spread_has_the_extremes() {
        let spread = Spread::of(&[4.0, 1.0, 2.0]);
        assert_eq!(spread, Spread { median: 2.0, least: 1.0, most: 4.0 });
        assert_eq!(spread.relative(), 0.75);
        assert!(Spread::of(&[]).least.is_nan());
    }
}
