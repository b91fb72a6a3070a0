// SPDX-License-Identifier: MIT OR Apache-2.0
//! `courtyard`: arcades around a paved court with a fountain, orange trees, ivy and hedges: millions of triangles.
//!
//! The court lies on y = 0; arcades stand at its back (-z) and at both sides, and its front is open. Lengths are metres.

mod fountain;
mod green;
mod ground;
mod parameters;
mod surfaces;
mod table;
mod upstairs;
mod wings;

pub use parameters::{Parameters, TreePlace};

use super::model::Model;
use super::parts::at;
use crate::Result;
use crate::monitor::Monitor;

/// Makes the courtyard.
///
/// # Errors
/// If a parameter is out of its range, or [`crate::Error::Cancelled`].
pub fn generate(p: &Parameters, view: &'static str, monitor: &Monitor) -> Result<Model> {
    p.check()?;
    let mut model = Model::new("courtyard", view);
    surfaces::add(&mut model, p, &monitor.part("scene", 0.0, 0.25))?;
    ground::add(&mut model, p, &monitor.part("scene", 0.25, 0.35))?;
    wings::add(&mut model, p);
    monitor.part("scene", 0.35, 0.45).tell(1.0);
    monitor.check()?;
    fountain::add(&mut model, p);
    table::add(&mut model, p);
    green::add(&mut model, p, &monitor.part("scene", 0.45, 1.0))?;
    Ok(model)
}
