// SPDX-License-Identifier: MIT OR Apache-2.0
//! `runner`: a finish line with three runners, hurdles, a podium with its cup, and a bench.
//!
//! The track lies on y = 0; its lanes run along z, and the runners run to +z. Lengths are metres.

mod figure;
mod gear;
mod ground;
mod parameters;
mod surfaces;

pub use parameters::{Parameters, Pose, RunnerPlace};

use super::model::Model;
use super::parts::at;
use crate::Result;

/// Makes the finish line.
///
/// # Errors
/// If a parameter is out of its range.
pub fn generate(p: &Parameters, view: &'static str) -> Result<Model> {
    p.check()?;
    let mut model = Model::new("runner", view);
    surfaces::add(&mut model, p);
    ground::add(&mut model, p);
    figure::add(&mut model, p);
    gear::add(&mut model, p);
    Ok(model)
}
