// SPDX-License-Identifier: MIT OR Apache-2.0
//! The self-tests: the full one on request, the quick one at a driver's first use.

pub mod full;
pub mod quick;
