// SPDX-License-Identifier: MIT OR Apache-2.0
//! The similarity checks between two references: which tests there are, how strict they are, how they compare.

use std::str::FromStr;

use crate::error::{Error, Result, Setting};
use crate::layout::FailMask;
use crate::names::named;

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

// In the order of the fail mask.
named!(Test of Tests { G1 = "g1", G2 = "g2", G3 = "g3", G4 = "g4", Tx = "tx", Sh = "sh", Gc = "gc" });

impl Test {
    /// The test in the fail mask of a pixel's class.
    pub const fn fail_mask(self) -> FailMask {
        match self {
            Test::G1 => FailMask::G1,
            Test::G2 => FailMask::G2,
            Test::G3 => FailMask::G3,
            Test::G4 => FailMask::G4,
            Test::Tx => FailMask::TX,
            Test::Sh => FailMask::SH,
            Test::Gc => FailMask::GC,
        }
    }

    /// The test's bit in the class plane.
    pub const fn fail_bit(self) -> u32 {
        self.fail_mask().bits()
    }
}

/// A set of similarity tests.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TestSet(FailMask);

impl TestSet {
    /// No test: nothing but the border of a picture is traced beside base pixels.
    pub const NONE: TestSet = TestSet(FailMask::empty());
    /// All seven tests.
    pub const ALL: TestSet = TestSet(FailMask::all());

    /// This set and `test`.
    #[must_use]
    pub const fn with(self, test: Test) -> TestSet {
        TestSet(self.0.union(test.fail_mask()))
    }

    /// This set but for `test`.
    #[must_use]
    pub const fn without(self, test: Test) -> TestSet {
        TestSet(self.0.difference(test.fail_mask()))
    }

    /// Whether `test` is in the set.
    pub const fn has(self, test: Test) -> bool {
        self.0.contains(test.fail_mask())
    }

    /// The tests as the fail mask of a pixel's class.
    pub const fn fail_mask(self) -> FailMask {
        self.0
    }
}

impl std::fmt::Display for TestSet {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let names: Vec<&str> = Test::ALL.into_iter().filter(|&test| self.has(test)).map(Test::name).collect();
        f.pad(&names.join(","))
    }
}

impl FromStr for TestSet {
    type Err = Error;

    /// Names parted by commas; nothing is [`TestSet::NONE`].
    fn from_str(text: &str) -> Result<Self> {
        let names = text.split(',').map(str::trim).filter(|name| !name.is_empty());
        names.map(Test::from_str).try_fold(TestSet::NONE, |set, test| Ok(set.with(test?)))
    }
}

/// How TX compares texture coordinates, and interpolation joins them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TextureRule {
    /// The paper's: a pair fails where one coordinate is at the border of its repetition, nearer than `t_tex`, and the
    /// other is not near that border.
    Border,
    /// Whole repetitions count: a pair fails where its coordinates are more than `t_tex` repetitions apart. Beyond the
    /// paper.
    Joined,
}

named!(TextureRule of Textures { Border = "border", Joined = "joined" });

/// The space in which reflected colours are compared, by GC and by post-correction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GcolSpace {
    /// Square roots of the channels, close to what a display shows.
    Display,
    /// Linear light, as in the paper.
    Linear,
}

named!(GcolSpace of GcolSpace { Display = "display", Linear = "linear" });

/// Tolerances of the checks at one level of blocks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerances {
    /// G2: largest distance, as a share of the scene's extent, 0 or more; at 0 every pixel fails.
    pub t_pos: f32,
    /// G3: least dot product of the normals, -1 to 2; above 1 every pair fails.
    pub t_norm: f32,
    /// G4: sine of the slope below which a surface counts as flat, 0 to 1.
    pub t_conv: f32,
    /// TX: by [`TextureRule`] how far apart texture coordinates may be, or how near to the border of its repetition a
    /// coordinate counts as "at the border"; 0 to 1.
    pub t_tex: f32,
    /// GC: largest distance of the reflected colours, 0 or more.
    pub t_gcol: f32,
}

impl Tolerances {
    /// The tolerances of every published result (paper; `t_conv` is ours).
    pub const PAPER: Tolerances = Tolerances { t_pos: 0.03, t_norm: 0.9, t_conv: 0.05, t_tex: 0.3, t_gcol: 0.15 };
    /// Ours for references two pixels apart: looser distance and convexity, where perspective interpolation and
    /// correction by normals mend what they miss, and a tighter GC, whose misses show most (docs/method.md).
    pub const FINE: Tolerances = Tolerances { t_pos: 0.06, t_norm: 0.9, t_conv: 0.2, t_tex: 0.5, t_gcol: 0.05 };
    /// Ours for references four pixels apart: an error there spreads over more pixels.
    pub const COARSE: Tolerances = Tolerances { t_pos: 0.03, t_norm: 0.9, t_conv: 0.2, t_tex: 0.5, t_gcol: 0.09 };

    fn validate(&self) -> Result<()> {
        check(Setting::TPos, self.t_pos, NOT_NEGATIVE)?;
        check(Setting::TNorm, self.t_norm, DOT_PRODUCT)?;
        check(Setting::TConv, self.t_conv, SHARE)?;
        check(Setting::TTex, self.t_tex, SHARE)?;
        check(Setting::TGcol, self.t_gcol, NOT_NEGATIVE)
    }
}

pub(super) const SHARE: (f32, f32) = (0.0, 1.0);
/// 2 asks for more than any pair has.
pub(super) const DOT_PRODUCT: (f32, f32) = (-1.0, 2.0);
pub(super) const NOT_NEGATIVE: (f32, f32) = (0.0, f32::MAX);

/// Refuses a number outside of its range, NaN among them.
pub(super) fn check(setting: Setting, value: f32, (least, most): (f32, f32)) -> Result<()> {
    if (least..=most).contains(&value) {
        return Ok(());
    }
    let allowed = if most == f32::MAX { format!("{least} or more") } else { format!("{least} to {most}") };
    Err(Error::option(setting, value, allowed))
}

/// What decides whether a pixel lies between two references that are alike.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Checks {
    /// Which tests count.
    pub tests: TestSet,
    /// Tolerances where the references are two pixels apart.
    pub fine: Tolerances,
    /// Tolerances where they are four pixels apart: the first level of blocks of 4.
    pub coarse: Tolerances,
    /// How TX compares texture coordinates.
    pub textures: TextureRule,
    /// How GC compares reflected colours.
    pub gcol_space: GcolSpace,
    /// GC also fails where the texture of what two references see in a mirror or behind glass looks different midway between
    /// them; beyond the paper.
    pub secondary_textures: bool,
    /// A pixel of step III with eight known neighbours whose upper and lower one fail may lie between two others; beyond
    /// the paper.
    pub second_pairs: bool,
}

impl Checks {
    /// Gives both levels the same tolerances.
    #[must_use]
    pub const fn at_all_levels(self, tolerances: Tolerances) -> Checks {
        Checks { fine: tolerances, coarse: tolerances, ..self }
    }

    pub(super) fn validate(&self) -> Result<()> {
        self.fine.validate()?;
        self.coarse.validate()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_of_tests_are_written_and_read() {
        let set = TestSet::ALL.without(Test::Gc).without(Test::Tx);
        assert_eq!(set.to_string(), "g1,g2,g3,g4,sh");
        assert_eq!("g1, G2,g3,g4,SH".parse::<TestSet>().unwrap(), set);
        assert_eq!("".parse::<TestSet>().unwrap(), TestSet::NONE);
        assert!(set.has(Test::Sh) && !set.has(Test::Gc));
        let error = "gc,g9".parse::<TestSet>().unwrap_err().to_string();
        assert!(error.contains("`g9`") && error.contains("tx"), "{error}");
    }
}
