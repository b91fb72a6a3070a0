// SPDX-License-Identifier: MIT OR Apache-2.0
//! Materials that more than one scene has.

use crate::scene::Surface;
use crate::scene::builtin::model::Finish;

/// Black wrought iron.
pub fn iron() -> Finish {
    Finish::glossy("iron", [0.025, 0.025, 0.028], 0.30, 60.0)
}

/// Chromed metal, which reflects.
pub fn chrome() -> Finish {
    Finish::mirror("chrome", [0.20, 0.20, 0.21], [0.62, 0.62, 0.63])
}

/// Polished brass, which reflects.
pub fn brass() -> Finish {
    Finish::mirror("brass", [0.55, 0.33, 0.09], [0.50, 0.36, 0.15])
}

/// A looking glass.
pub fn mirror() -> Finish {
    Finish::mirror("mirror", [0.02; 3], [0.90, 0.92, 0.91])
}

/// The white inside of a lamp's shade.
pub fn shade_inside() -> Finish {
    Finish::matte("shade-inside", [0.88, 0.84, 0.74])
}

/// A light bulb.
pub fn bulb() -> Finish {
    Finish::matte("bulb", [1.0, 0.93, 0.78])
}

/// White porcelain.
pub fn porcelain() -> Finish {
    Finish::glossy("porcelain", [0.85, 0.84, 0.81], 0.45, 220.0)
}

/// A closed body of clear glass.
pub fn glass() -> Finish {
    Finish::glass("glass", Surface::Glass, [0.985, 0.995, 0.99])
}

/// A pane of thin glass.
pub fn pane() -> Finish {
    Finish { index_of_refraction: 1.45, ..Finish::glass("pane", Surface::ThinGlass, [0.98, 0.99, 0.985]) }
}

/// Stems of plants.
pub fn stem() -> Finish {
    Finish::matte("stem", [0.12, 0.20, 0.06])
}

/// Crust of bread and pastry.
pub fn crust() -> Finish {
    Finish::glossy("crust", [0.62, 0.31, 0.085], 0.18, 30.0)
}

/// Brushed steel, which reflects dimly.
pub fn steel() -> Finish {
    Finish::mirror("steel", [0.30, 0.30, 0.31], [0.42, 0.42, 0.43])
}

/// Polished copper, which reflects.
pub fn copper() -> Finish {
    Finish::mirror("copper", [0.50, 0.21, 0.10], [0.50, 0.32, 0.22])
}
