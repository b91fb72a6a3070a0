// SPDX-License-Identifier: MIT OR Apache-2.0
//! `cafe`: a small café with a counter, bentwood chairs, a window, a mirror and lamps.
//!
//! The room stands on y = 0 with the counter at its back (-z) and the window in its left wall (-x); lengths are metres.

mod counter;
mod decor;
mod furniture;
mod parameters;
mod room;
mod surfaces;
mod tableware;

pub use parameters::{Chair, Parameters, Room, Table};

use super::model::Model;
use super::parts::at;
use crate::Result;

/// Makes the café.
///
/// # Errors
/// If a parameter is out of its range.
pub fn generate(p: &Parameters, view: &'static str) -> Result<Model> {
    p.check()?;
    let mut model = Model::new("cafe", view);
    surfaces::add(&mut model, p);
    room::add(&mut model, p);
    counter::add(&mut model, p);
    furniture::add(&mut model, p);
    tableware::add(&mut model, p);
    decor::add(&mut model, p);
    Ok(model)
}
