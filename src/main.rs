// SPDX-License-Identifier: MIT OR Apache-2.0
//! The `rarefy` command.

fn main() {}
