// SPDX-License-Identifier: MIT OR Apache-2.0
//! `conference`: a conference room with a long table, many thin-legged chairs, blinds, lamps, a screen and plants.
//!
//! The room stands on y = 0. The windows are in its left wall (-x), the screen on its back wall (-z); lengths are metres.

mod desk;
mod parameters;
mod room;
mod seats;
mod sides;
mod surfaces;

pub use parameters::{Blinds, Parameters, Table, Windows};

use super::model::Model;
use super::parts::{at, lamps};
use crate::Result;

/// Makes the conference room.
///
/// # Errors
/// If a parameter is out of its range.
pub fn generate(p: &Parameters, view: &'static str) -> Result<Model> {
    p.check()?;
    let mut model = Model::new("conference", view);
    surfaces::add(&mut model, p);
    room::add(&mut model, p);
    desk::add(&mut model, p);
    seats::add(&mut model, p);
    sides::add(&mut model, p);
    for (i, lamp) in p.lamps.iter().enumerate() {
        lamps::pendant(&mut model, i + 1, lamp, "dark-metal", p.room.height, p.round_sides);
    }
    Ok(model)
}
