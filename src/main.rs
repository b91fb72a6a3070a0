// SPDX-License-Identifier: MIT OR Apache-2.0
//! The `rarefy` command.

// Printing must not panic where nobody listens: see `output` in the command.
#![deny(clippy::print_stdout, clippy::print_stderr)]

mod cli;

fn main() -> std::process::ExitCode {
    cli::run()
}
