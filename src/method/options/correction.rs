// SPDX-License-Identifier: MIT OR Apache-2.0
//! Post-correction: what is compared, and how it spreads.

use std::str::FromStr;

use super::checks::{DOT_PRODUCT, NOT_NEGATIVE, check};
use crate::error::{Error, Result, Setting};
use crate::names::{find, named};
use crate::settings::list;

/// Post-correction: rays for interpolated neighbours of traced pixels that show something else.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Correction {
    /// None.
    Off,
    /// The paper's single round: rows there and back, then columns. Only for frames that are in memory at once.
    Sweeps(Compared),
    /// Packed rounds until nothing changes: the least fixed point of the paper's rule.
    Converged {
        /// What is compared.
        compared: Compared,
        /// Traced pixels do not spread to neighbours that a straight edge or line would pass by; beyond the paper.
        thin_only: bool,
        /// Also looks at pixels between two parts of a thin line that shows above and below them; beyond the paper.
        bridges: bool,
        /// Also traces one pixel of every 16x16 that no test or neighbour has asked for; beyond the paper.
        probes: bool,
    },
}

/// What post-correction compares between a traced pixel and its interpolated neighbour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Compared {
    /// Object ids.
    Object,
    /// Object ids and shadow bits, as in the paper's pictures.
    ObjectAndShadow {
        /// Smallest 8-bit difference in a channel of the shown colours from which on shadow bits of one object count.
        t_visible: u8,
    },
    /// Object ids, shadow bits, and beyond the paper normals and reflected colours: also thin creases, and thin things
    /// seen in mirrors.
    All {
        /// Smallest 8-bit difference in a channel of the shown colours from which on a difference within one object
        /// counts.
        t_visible: u8,
        /// Least dot product of normals that are taken to be the same, -1 to 2.
        t_norm: f32,
        /// Largest distance of reflected colours that are taken to be the same, 0 or more.
        t_gcol: f32,
    },
}

/// How post-correction spreads: the name of [`Correction::Converged`] or [`Correction::Sweeps`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Spread {
    /// [`Correction::Converged`].
    Converged,
    /// [`Correction::Sweeps`].
    Sweeps,
}

named!(Spread of CorrectionSpread { Converged = "converged", Sweeps = "sweeps" });

impl Correction {
    /// Converged correction with all rules beyond the paper.
    pub const fn converged(compared: Compared) -> Correction {
        Correction::Converged { compared, thin_only: true, bridges: true, probes: true }
    }

    /// What is compared; `None` without correction.
    pub const fn compared(self) -> Option<Compared> {
        match self {
            Correction::Off => None,
            Correction::Sweeps(compared) | Correction::Converged { compared, .. } => Some(compared),
        }
    }

    /// How it spreads; `None` without correction.
    pub const fn spread(self) -> Option<Spread> {
        match self {
            Correction::Off => None,
            Correction::Sweeps(_) => Some(Spread::Sweeps),
            Correction::Converged { .. } => Some(Spread::Converged),
        }
    }

    /// The same spread, with another comparison; converged where there was no correction.
    #[must_use]
    pub const fn comparing(self, compared: Compared) -> Correction {
        match self {
            Correction::Off => Correction::converged(compared),
            Correction::Sweeps(_) => Correction::Sweeps(compared),
            Correction::Converged { thin_only, bridges, probes, .. } => {
                Correction::Converged { compared, thin_only, bridges, probes }
            }
        }
    }

    /// The same comparison, spread in this way; [`Correction::Off`] stays off, and what was swept converges by the
    /// paper's rule alone.
    #[must_use]
    pub const fn spreading(self, spread: Spread) -> Correction {
        match (self, spread) {
            (Correction::Off, _) | (Correction::Converged { .. }, Spread::Converged) => self,
            (Correction::Sweeps(compared) | Correction::Converged { compared, .. }, Spread::Sweeps) => {
                Correction::Sweeps(compared)
            }
            (Correction::Sweeps(compared), Spread::Converged) => {
                Correction::Converged { compared, thin_only: false, bridges: false, probes: false }
            }
        }
    }

    pub(super) fn validate(&self) -> Result<()> {
        match self.compared() {
            Some(Compared::All { t_norm, t_gcol, .. }) => {
                check(Setting::CorrectionTNorm, t_norm, DOT_PRODUCT)?;
                check(Setting::CorrectionTGcol, t_gcol, NOT_NEGATIVE)
            }
            _ => Ok(()),
        }
    }
}

impl Compared {
    /// Names of what may be compared.
    pub const NAMES: [&'static str; 3] = ["object", "object+shadow", "all"];
    /// Object ids and all shadow bits: the paper's comparison.
    pub const PAPER: Compared = Compared::ObjectAndShadow { t_visible: 0 };
    /// Everything, where a difference can be seen.
    pub const VISIBLE: Compared = Compared::All { t_visible: 6, t_norm: 0.9, t_gcol: 0.07 };

    /// The comparison's name, as [`FromStr`] reads it.
    pub const fn name(self) -> &'static str {
        match self {
            Compared::Object => Self::NAMES[0],
            Compared::ObjectAndShadow { .. } => Self::NAMES[1],
            Compared::All { .. } => Self::NAMES[2],
        }
    }

    /// The least visible difference that counts within one object; `None` where only object ids are compared.
    pub const fn t_visible(self) -> Option<u8> {
        match self {
            Compared::Object => None,
            Compared::ObjectAndShadow { t_visible } | Compared::All { t_visible, .. } => Some(t_visible),
        }
    }

    /// This comparison with the tolerances that `other` has as well.
    #[must_use]
    pub const fn with_tolerances_of(self, other: Compared) -> Compared {
        match (self, other) {
            (
                Compared::ObjectAndShadow { .. },
                Compared::ObjectAndShadow { t_visible } | Compared::All { t_visible, .. },
            ) => Compared::ObjectAndShadow { t_visible },
            (Compared::All { t_norm, t_gcol, .. }, Compared::ObjectAndShadow { t_visible }) => {
                Compared::All { t_visible, t_norm, t_gcol }
            }
            (Compared::All { .. }, Compared::All { .. }) => other,
            _ => self,
        }
    }
}

impl std::fmt::Display for Compared {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Compared {
    type Err = Error;

    /// With the tolerances of [`Compared::VISIBLE`].
    fn from_str(text: &str) -> Result<Self> {
        let Compared::All { t_visible, .. } = Compared::VISIBLE else { return Ok(Compared::VISIBLE) };
        let all = [Compared::Object, Compared::ObjectAndShadow { t_visible }, Compared::VISIBLE];
        find(&Self::NAMES, text)
            .map(|at| all[at])
            .ok_or_else(|| Error::option(Setting::Correction, text, list(&Self::NAMES)))
    }
}

impl std::fmt::Display for Correction {
    /// `off`, or what is compared and how it spreads: `all, converged`.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match (self.compared(), self.spread()) {
            (Some(compared), Some(spread)) => write!(f, "{compared}, {spread}"),
            _ => f.write_str("off"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comparisons_have_names_and_keep_the_tolerances_they_share() {
        for name in Compared::NAMES {
            assert_eq!(name.parse::<Compared>().unwrap().to_string(), name);
        }
        assert!("both".parse::<Compared>().unwrap_err().to_string().contains("object+shadow"));
        let paper = Compared::VISIBLE.with_tolerances_of(Compared::PAPER);
        assert_eq!(paper, Compared::All { t_visible: 0, t_norm: 0.9, t_gcol: 0.07 });
        assert_eq!(Compared::PAPER.with_tolerances_of(Compared::VISIBLE).t_visible(), Some(6));
        assert_eq!(Compared::Object.with_tolerances_of(Compared::VISIBLE), Compared::Object);
        assert_eq!(Compared::VISIBLE.with_tolerances_of(Compared::Object), Compared::VISIBLE);
    }

    #[test]
    fn comparison_and_spread_change_one_without_the_other() {
        let swept = Correction::Sweeps(Compared::PAPER);
        assert_eq!(swept.comparing(Compared::Object), Correction::Sweeps(Compared::Object));
        let plain =
            Correction::Converged { compared: Compared::PAPER, thin_only: false, bridges: false, probes: false };
        assert_eq!(swept.spreading(Spread::Converged), plain);
        assert_eq!(plain.spreading(Spread::Converged), plain);
        assert_eq!(plain.comparing(Compared::PAPER).spread(), Some(Spread::Converged));
        assert_eq!(Correction::Off.spreading(Spread::Sweeps), Correction::Off);
        assert_eq!(swept.to_string(), "object+shadow, sweeps");
    }
}
