// SPDX-License-Identifier: MIT OR Apache-2.0
//! A method is a value: everything that decides which pixels of an adaptive frame get rays and what the others show.

use std::str::FromStr;

use super::checks::{Checks, GcolSpace, TestSet, TextureRule, Tolerances};
use super::correction::{Compared, Correction};
use crate::error::{Error, Result, Setting};
use crate::names::named;

/// Where between its references an interpolated pixel lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Interpolation {
    /// Midway on the screen: exact on planes.
    Perspective,
    /// Midway in space, as in the paper.
    Plain,
}

named!(Interpolation of Interpolation { Perspective = "perspective", Plain = "plain" });

/// How an adaptive frame is drawn. Begin with a preset, [`Method::balanced`] being the default, and change fields.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Method {
    /// Side of the blocks of which one pixel is always traced: 2 (paper) or 4.
    pub block: u32,
    /// Base pixels of successive rows of blocks lie in different columns, so that nothing upright lies between all of them;
    /// beyond the paper.
    pub shifted_rows: bool,
    /// When a pixel may be interpolated.
    pub checks: Checks,
    /// Where interpolated pixels lie.
    pub interpolation: Interpolation,
    /// Which interpolated pixels are traced after all.
    pub correction: Correction,
    /// A traced pixel that lies between two points of one object, and fails GC or SH alone, sends shadow rays only to
    /// lights about which these disagree; beyond the paper.
    pub reuse_shadows: bool,
}

/// Names of the methods that come with the library.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Preset {
    /// [`Method::balanced`].
    #[default]
    Balanced,
    /// [`Method::fast`].
    Fast,
    /// [`Method::paper`].
    Paper,
}

named!(Preset of Method { Balanced = "balanced", Fast = "fast", Paper = "paper" });

impl Method {
    /// Our rules in blocks of 2: most of the picture's quality for a third of its rays.
    pub const fn balanced() -> Method {
        Method {
            block: 2,
            shifted_rows: true,
            checks: Checks {
                tests: TestSet::ALL,
                fine: Tolerances::FINE,
                coarse: Tolerances::COARSE,
                textures: TextureRule::Joined,
                gcol_space: GcolSpace::Display,
                secondary_textures: true,
                second_pairs: true,
            },
            interpolation: Interpolation::Perspective,
            correction: Correction::converged(Compared::VISIBLE),
            reuse_shadows: true,
        }
    }

    /// Our rules in blocks of 4: half the rays of [`Method::balanced`], at less quality.
    pub const fn fast() -> Method {
        Method { block: 4, ..Method::balanced() }
    }

    /// The paper's rules and tolerances: correction by object ids and shadow bits in the paper's single round of sweeps,
    /// midway in space.
    pub const fn paper() -> Method {
        Method {
            block: 2,
            shifted_rows: false,
            checks: Checks {
                tests: TestSet::ALL,
                fine: Tolerances::PAPER,
                coarse: Tolerances::PAPER,
                textures: TextureRule::Border,
                gcol_space: GcolSpace::Linear,
                secondary_textures: false,
                second_pairs: false,
            },
            interpolation: Interpolation::Plain,
            correction: Correction::Sweeps(Compared::PAPER),
            reuse_shadows: false,
        }
    }

    /// The preset that this is; `None` once a field was changed.
    pub fn preset(&self) -> Option<Preset> {
        Preset::ALL.into_iter().find(|&preset| Method::from(preset) == *self)
    }

    /// Checks every value against its range.
    ///
    /// # Errors
    /// [`Error::InvalidOption`] with the setting, its value and the range.
    pub fn validate(&self) -> Result<()> {
        if !matches!(self.block, 2 | 4) {
            return Err(Error::option(Setting::Block, self.block, "2 or 4"));
        }
        self.checks.validate()?;
        self.correction.validate()
    }
}

impl Default for Method {
    fn default() -> Self {
        Preset::default().into()
    }
}

impl From<Preset> for Method {
    fn from(preset: Preset) -> Method {
        match preset {
            Preset::Balanced => Method::balanced(),
            Preset::Fast => Method::fast(),
            Preset::Paper => Method::paper(),
        }
    }
}

impl FromStr for Method {
    type Err = Error;

    /// A preset's name.
    fn from_str(name: &str) -> Result<Self> {
        name.parse::<Preset>().map(Method::from)
    }
}

impl std::fmt::Display for Method {
    /// The preset's name, or `custom`.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.preset().map_or("custom", Preset::name))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn presets_are_told_by_their_names_and_a_changed_one_is_custom() {
        for preset in Preset::ALL {
            let method: Method = preset.name().parse().unwrap();
            method.validate().unwrap();
            assert_eq!((method.preset(), method.to_string()), (Some(preset), preset.to_string()));
            let other = Method { reuse_shadows: !method.reuse_shadows, ..method };
            assert_eq!((other.preset(), other.to_string().as_str()), (None, "custom"));
        }
        assert_eq!(Method::default(), Method::balanced());
        assert!("ours".parse::<Method>().unwrap_err().to_string().contains("balanced, fast or paper"));
    }
}
