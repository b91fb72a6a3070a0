// SPDX-License-Identifier: MIT OR Apache-2.0
//! `kitchen`: a family kitchen with fitted cupboards, steel and copper, tiles, and a laid table.
//!
//! The room stands on y = 0. The window and the sink are at its back (-z), a second run of cupboards along its right wall
//! (+x); lengths are metres.

mod cooking;
mod dining;
mod parameters;
mod room;
mod stores;
mod surfaces;
mod units;

pub use parameters::{Parameters, Table, Window};

use super::model::Model;
use super::parts::at;
use crate::Result;

/// Makes the kitchen.
///
/// # Errors
/// If a parameter is out of its range.
pub fn generate(p: &Parameters, view: &'static str) -> Result<Model> {
    p.check()?;
    let mut model = Model::new("kitchen", view);
    surfaces::add(&mut model, p);
    room::add(&mut model, p);
    units::add(&mut model, p);
    cooking::add(&mut model, p);
    stores::add(&mut model, p);
    dining::add(&mut model, p);
    Ok(model)
}
