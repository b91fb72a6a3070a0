// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a frame may be asked for.

use crate::error::{Error, Result};
use crate::layout::*;

/// Which pixels get rays.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Mode {
    /// Every pixel.
    Full,
    /// The method: base pixels, and those whose checks fail.
    #[default]
    Adaptive,
}

/// What post-correction compares.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Correction {
    /// No post-correction.
    Off,
    /// Object ids.
    Object,
    /// Object ids and shadow bits, as in the paper's pictures.
    ObjectAndShadow,
    /// Object ids, shadow bits, and beyond the paper normals and reflected colours: also thin creases, and thin things
    /// seen in mirrors.
    #[default]
    All,
}

/// How post-correction spreads.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum CorrectionMethod {
    /// Packed rounds until nothing changes: the least fixed point of the paper's rule.
    #[default]
    Converged,
    /// The paper's single round: rows there and back, then columns.
    Sweeps,
}

/// Where between its references an interpolated pixel lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Interpolation {
    /// Midway on the screen: exact on planes.
    #[default]
    Perspective,
    /// Midway in space, as in the paper.
    Plain,
}

/// A similarity test (paper, "similarity checks").
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Test {
    /// Same object.
    G1,
    /// Close positions.
    G2,
    /// Similar normals.
    G3,
    /// No fluctuation between them.
    G4,
    /// Same repetition of the texture.
    Tx,
    /// Same shadow bits.
    Sh,
    /// Similar reflected colours.
    Gc,
}

impl Test {
    /// All tests in the order of the fail mask.
    pub const ALL: [Test; 7] = [Test::G1, Test::G2, Test::G3, Test::G4, Test::Tx, Test::Sh, Test::Gc];

    /// The paper's name in lower case, as on the command line.
    pub fn name(self) -> &'static str {
        ["g1", "g2", "g3", "g4", "tx", "sh", "gc"][self as usize]
    }

    /// The test's bit in the class plane.
    pub fn fail_bit(self) -> u32 {
        FAIL_G1 << self as u32
    }

    /// The test called `name`, in any case.
    pub fn from_name(name: &str) -> Option<Test> {
        Test::ALL.into_iter().find(|t| t.name().eq_ignore_ascii_case(name))
    }
}

/// Tolerances of the checks at one level of blocks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerances {
    /// G2: largest distance, as a share of the scene's extent.
    pub t_pos: f32,
    /// G3: least dot product of the normals.
    pub t_norm: f32,
    /// G4: sine of the slope below which a surface counts as flat.
    pub t_conv: f32,
    /// TX: how far apart texture coordinates may be the shorter way around; without `unwrap_textures`, how near to the
    /// border of its repetition a coordinate counts as "at the border".
    pub t_tex: f32,
    /// GC: largest distance of the reflected colours.
    pub t_gcol: f32,
}

impl Tolerances {
    /// The tolerances of every published result (paper; `t_conv` is ours).
    pub const PAPER: Tolerances = Tolerances { t_pos: 0.03, t_norm: 0.9, t_conv: 0.05, t_tex: 0.3, t_gcol: 0.15 };
    /// Ours for references two pixels apart: looser distance and convexity, where perspective interpolation and
    /// correction by normals mend what they miss, and a tighter GC, whose misses show most (docs/method.md).
    pub const FINE: Tolerances = Tolerances { t_pos: 0.06, t_norm: 0.9, t_conv: 0.2, t_tex: 0.3, t_gcol: 0.05 };
    /// Ours for references four pixels apart: an error there spreads over more pixels.
    pub const COARSE: Tolerances = Tolerances { t_pos: 0.03, t_norm: 0.95, t_conv: 0.05, t_tex: 0.3, t_gcol: 0.06 };
}

/// Everything that decides how a frame is drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct RenderOptions {
    /// Width in pixels, 1 to [`crate::method::camera::MAX_SIDE`].
    pub width: u32,
    /// Height in pixels, likewise.
    pub height: u32,
    /// Samples per pixel and axis: 1, 2 or 4. The method works on the grid of samples; pixels are means of theirs.
    pub samples: u32,
    /// Which pixels get rays.
    pub mode: Mode,
    /// Side of the base blocks: 2 (paper) or 4.
    pub block: u32,
    /// Most secondary rays in a chain, 0 to 64; straight ones through panes of thin glass do not count.
    pub depth: u32,
    /// What post-correction compares.
    pub correction: Correction,
    /// How post-correction spreads.
    pub correction_method: CorrectionMethod,
    /// Where interpolated pixels lie.
    pub interpolation: Interpolation,
    /// Tolerances of the finest level (references two pixels apart).
    pub tolerances: Tolerances,
    /// Tolerances of the coarse level of blocks of 4 (references four pixels apart).
    pub coarse_tolerances: Tolerances,
    /// Compare reflected colours linearly, not by their square roots.
    pub gcol_linear: bool,
    /// Bits of the tests that are switched on: `FAIL_*`.
    pub tests: u32,
    /// A pixel of step III with eight known neighbours whose upper and lower one fail may lie between two others; beyond
    /// the paper.
    pub other_pairs: bool,
    /// TX compares texture coordinates, and interpolation joins them, the shorter way around; beyond the paper.
    pub unwrap_textures: bool,
    /// Bits of the tests that count only where the two references look different (`t_visible`); beyond the paper.
    pub lenient_tests: u32,
    /// From which difference of a colour channel of 0 to 255 on two references look different; 0 makes no test lenient.
    pub t_visible: u32,
    /// A traced pixel that lies between two points of one object, and fails GC or SH alone, sends shadow rays only to
    /// lights about which these disagree; beyond the paper.
    pub reuse_shadows: bool,
    /// Post-correction by [`CorrectionMethod::Converged`]: traced pixels do not spread to neighbours that a straight edge
    /// or line would pass by; beyond the paper.
    pub correction_thin_only: bool,
    /// Post-correction by [`CorrectionMethod::Converged`]: also looks at pixels between two parts of a thin line that
    /// shows above and below them; beyond the paper.
    pub correction_bridges: bool,
    /// Post-correction: from which difference of a colour channel of 0 to 255 on a change within one object counts.
    pub correction_t_visible: u32,
    /// Post-correction: least dot product of normals that are taken to be the same.
    pub correction_t_norm: f32,
    /// Post-correction: largest distance of reflected colours that are taken to be the same.
    pub correction_t_gcol: f32,
    /// Most rows of samples that are in device memory at once; `None`: as many as the budget allows. The picture does
    /// not depend on it.
    pub band_rows: Option<u32>,
}

impl Default for RenderOptions {
    fn default() -> Self {
        RenderOptions {
            width: 1024,
            height: 1024,
            samples: 1,
            mode: Mode::default(),
            block: 2,
            depth: 4,
            correction: Correction::default(),
            correction_method: CorrectionMethod::default(),
            interpolation: Interpolation::default(),
            tolerances: Tolerances::FINE,
            coarse_tolerances: Tolerances::COARSE,
            gcol_linear: false,
            tests: FAIL_ALL,
            other_pairs: true,
            unwrap_textures: true,
            lenient_tests: FAIL_SH,
            t_visible: 12,
            reuse_shadows: true,
            correction_thin_only: true,
            correction_bridges: true,
            correction_t_visible: 6,
            correction_t_norm: 0.9,
            correction_t_gcol: 0.07,
            band_rows: None,
        }
    }
}

impl RenderOptions {
    /// The paper's rules and tolerances: no lenient tests, correction by object ids and shadow bits in the paper's
    /// single round of sweeps, midway in space.
    pub fn paper() -> Self {
        RenderOptions {
            correction: Correction::ObjectAndShadow,
            correction_method: CorrectionMethod::Sweeps,
            interpolation: Interpolation::Plain,
            tolerances: Tolerances::PAPER,
            coarse_tolerances: Tolerances::PAPER,
            gcol_linear: true,
            other_pairs: false,
            unwrap_textures: false,
            lenient_tests: 0,
            t_visible: 0,
            reuse_shadows: false,
            correction_thin_only: false,
            correction_bridges: false,
            correction_t_visible: 0,
            ..RenderOptions::default()
        }
    }

    /// Width and height of the frame in samples.
    pub fn sample_size(&self) -> (u32, u32) {
        (self.width.saturating_mul(self.samples), self.height.saturating_mul(self.samples))
    }

    /// Checks every value against its range.
    ///
    /// # Errors
    /// [`Error::InvalidOption`] with the option, the value and the range.
    pub fn validate(&self) -> Result<()> {
        let max = crate::method::camera::MAX_SIDE;
        if !(1..=max).contains(&self.width) || !(1..=max).contains(&self.height) {
            return Err(Error::option(
                "--size",
                format!("{}x{} is out of range; each side may be 1 to {max} pixels", self.width, self.height),
            ));
        }
        if !matches!(self.samples, 1 | 2 | 4) {
            return Err(Error::option("--samples", format!("{} is not 1, 2 or 4", self.samples)));
        }
        let (width, height) = self.sample_size();
        let most = crate::method::camera::MAX_SAMPLE_SIDE;
        if width > most || height > most {
            return Err(Error::option(
                "--samples",
                format!("{width}x{height} samples are too many; each side may be 1 to {most}; choose a smaller --size"),
            ));
        }
        if !matches!(self.block, 2 | 4) {
            return Err(Error::option("--blocks", format!("{} is not 2 or 4", self.block)));
        }
        if self.depth > 64 {
            return Err(Error::option("--depth", format!("{} is above 64", self.depth)));
        }
        for t in [&self.tolerances, &self.coarse_tolerances] {
            let ranges = [
                ("--t-pos", t.t_pos, 0.0, f32::MAX),
                ("--t-norm", t.t_norm, -1.0, 2.0),
                ("--t-conv", t.t_conv, 0.0, 1.0),
                ("--t-tex", t.t_tex, 0.0, 1.0),
                ("--t-gcol", t.t_gcol, 0.0, f32::MAX),
            ];
            for (option, value, lo, hi) in ranges {
                if !(lo..=hi).contains(&value) {
                    return Err(Error::option(option, format!("{value} is out of range; it may be {lo} to {hi}")));
                }
            }
        }
        Ok(())
    }
}
