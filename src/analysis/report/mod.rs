// SPDX-License-Identifier: MIT OR Apache-2.0
//! What is reported: statistics of one command as JSON, and the model behind the pages of `rarefy bench`.
//!
//! A report is made in one direction: a plan of measurements, their figures, and the tables, charts, pictures and verdict
//! made of these. Whatever shows a report shows that model; whatever stores it stores that.

pub mod bench;
pub mod close_up;
pub mod figures;
pub mod kept;
pub mod measure;
pub mod plan;
pub mod published;
pub mod recipe;
pub mod sections;
pub mod statistics;
pub mod table;
#[cfg(test)]
mod testing;
pub mod verdict;

pub use statistics::{CompareReport, RenderReport};
