// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where the method does not pay, or may lose detail, frames are traced in full.

use crate::method::counts::PixelCounts;
use crate::method::options::RenderOptions;

/// What a packed ray costs, in average rays: packing puts neighbours side by side, but the pixels that need rays are the
/// hard ones.
const PACKED_RAY_COST: f64 = 1.5;
/// What checking, interpolating and packing cost per adaptive pixel, in average rays.
const CHECK_COST: f64 = 0.06;
/// Where correction traces more than this share of the pixels that had been interpolated, detail is finer than the grid of
/// samples, and more of it may be lost. (docs/method.md, section 7: fences that are lost have 0.12 and more, the six real
/// scenes at 512x512 0.07 at most; single dots and hair have less.)
const MOST_CORRECTED: f64 = 0.1;
/// Probes are pixels traced by chance. Where they led to more than this many pixels for each, and to more than
/// [`FEW_BESIDE_PROBES`], much is wrong that nothing else finds. (Same section: dots have 0.18, the six scenes at 512x512
/// 0.03 at most.)
const MOST_BESIDE_PROBES: f64 = 0.15;
/// So many are no evidence: a single thin thing.
const FEW_BESIDE_PROBES: u64 = 24;
/// After this many full frames the method gets another try: the view may have become easier.
const FRAMES_BEFORE_RETRY: u32 = 30;

/// Decides from each adaptive frame's own counters whether the following ones should be full.
///
/// An adaptive frame is taken to cost `base + 1.5 (traced + corrected) + 0.06 (all - base)` average rays; if that is
/// not less than one ray a pixel, or if the frame [may lose detail](may_lose_detail), the next 30 frames with the same
/// options are traced in full.
#[derive(Debug, Clone, Default)]
pub struct Fallback {
    options: Option<RenderOptions>,
    full_frames_left: u32,
}

impl Fallback {
    /// Should this frame be full? Counts down.
    pub fn choose_full(&mut self, options: &RenderOptions) -> bool {
        if self.full_frames_left == 0 || self.options.as_ref() != Some(options) {
            return false;
        }
        self.full_frames_left -= 1;
        true
    }

    /// Takes in what an adaptive frame did.
    pub fn learn(&mut self, options: &RenderOptions, pixels: &PixelCounts) {
        self.options = Some(options.clone());
        self.full_frames_left = if does_not_pay(pixels) { FRAMES_BEFORE_RETRY } else { 0 };
    }
}

/// Whether frames like this one should be traced in full: they cost as much, or may lose detail.
pub fn does_not_pay(pixels: &PixelCounts) -> bool {
    modelled_cost(pixels) >= 1.0 || may_lose_detail(pixels)
}

/// Whether interpolation was so often wrong, by what correction found, that more may be wrong that it did not find: such
/// a frame is drawn again in full. Correction traced more than a tenth of what had been interpolated, or what it traced by
/// chance was wrong too often.
pub fn may_lose_detail(pixels: &PixelCounts) -> bool {
    let rebuilt = pixels.interpolated + pixels.corrected;
    let chance_finds = pixels.beside_probes > FEW_BESIDE_PROBES
        && pixels.beside_probes as f64 > MOST_BESIDE_PROBES * pixels.probes as f64;
    chance_finds || pixels.corrected as f64 > MOST_CORRECTED * rebuilt as f64
}

/// Modelled cost of an adaptive frame over that of a full one.
pub fn modelled_cost(pixels: &PixelCounts) -> f64 {
    let all = (pixels.base + pixels.traced + pixels.interpolated + pixels.corrected) as f64;
    let packed = (pixels.traced + pixels.corrected) as f64;
    let adaptive = all - pixels.base as f64;
    (pixels.base as f64 + PACKED_RAY_COST * packed + CHECK_COST * adaptive) / all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thicket_falls_back_and_a_wall_does_not() {
        let options = RenderOptions::default();
        let mut fallback = Fallback::default();
        fallback.learn(
            &options,
            &PixelCounts { base: 25, traced: 6, interpolated: 68, corrected: 1, ..PixelCounts::default() },
        );
        assert!(!fallback.choose_full(&options));
        fallback.learn(
            &options,
            &PixelCounts { base: 250, traced: 60, interpolated: 630, corrected: 60, ..PixelCounts::default() },
        );
        assert!(!fallback.choose_full(&options));
        fallback.learn(
            &options,
            &PixelCounts { base: 250, traced: 60, interpolated: 610, corrected: 80, ..PixelCounts::default() },
        );
        assert!(fallback.choose_full(&options), "a ninth of what was interpolated was traced after all");
        fallback.learn(
            &options,
            &PixelCounts { base: 25, traced: 60, interpolated: 10, corrected: 5, ..PixelCounts::default() },
        );
        for _ in 0..FRAMES_BEFORE_RETRY {
            assert!(fallback.choose_full(&options));
        }
        assert!(!fallback.choose_full(&options), "the method gets another try");
    }

    #[test]
    fn what_chance_finds_tells_of_what_nothing_finds() {
        let found = |probes, beside_probes| {
            let (base, traced, interpolated, corrected) = (25_000, 600, 67_400, 1_000);
            may_lose_detail(&PixelCounts { base, traced, interpolated, corrected, probes, beside_probes })
        };
        assert!(found(200, 40));
        assert!(!found(200, 30), "fewer than 0.15 for each probe");
        assert!(!found(40, 20), "a single thin thing");
        assert!(!found(0, 0));
    }

    #[test]
    fn other_options_start_afresh() {
        let options = RenderOptions::default();
        let mut fallback = Fallback::default();
        fallback.learn(
            &options,
            &PixelCounts { base: 25, traced: 75, interpolated: 0, corrected: 0, ..PixelCounts::default() },
        );
        assert!(!fallback.choose_full(&RenderOptions { width: 512, ..options.clone() }));
        assert!(fallback.choose_full(&options));
    }
}
