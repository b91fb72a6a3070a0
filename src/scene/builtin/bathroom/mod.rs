// SPDX-License-Identifier: MIT OR Apache-2.0
//! `bathroom`: a bath tub with foam, a large mirror above two wash bowls, a glazed shower, and towels.
//!
//! The room stands on y = 0. The mirror and the shower are at its back (-z), the window and the tub at its right wall (+x);
//! lengths are metres.

mod bath;
mod ceramics;
mod linen;
mod parameters;
mod room;
mod shower;
mod surfaces;
mod vanity;

pub use parameters::{Parameters, Room, Shower, Tub};

use super::model::Model;
use super::parts::at;
use crate::Result;

/// Makes the bathroom.
///
/// # Errors
/// If a parameter is out of its range.
pub fn generate(p: &Parameters, view: &'static str) -> Result<Model> {
    p.check()?;
    let mut model = Model::new("bathroom", view);
    surfaces::add(&mut model, p);
    room::add(&mut model, p);
    vanity::add(&mut model, p);
    ceramics::add(&mut model, p);
    shower::add(&mut model, p);
    bath::add(&mut model, p);
    linen::add(&mut model, p);
    Ok(model)
}
