// SPDX-License-Identifier: MIT OR Apache-2.0
//! The `rarefy` command.

mod cli;

fn main() -> std::process::ExitCode {
    cli::run()
}
