// SPDX-License-Identifier: MIT OR Apache-2.0
//! The command line: parses, calls the library, prints. Exit status: 0 good, 1 a comparison or self-test failed,
//! 2 error, 130 interrupted.

mod args;
mod bake;
mod bench;
mod compare;
mod devices;
mod diff;
mod doctor;
mod errors;
mod interrupt;
mod method;
mod output;
mod outputs;
mod progress;
mod render;
mod selftest;

use std::process::ExitCode;

use clap::Parser;
use clap::error::ErrorKind;
use rarefy::{Error, Result};

use args::{Cli, Command};
use interrupt::Interrupt;

/// Runs the command that the process was started with.
pub fn run() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => return usage(&error),
    };
    let interrupt = Interrupt::catch();
    // Made now, since a pool that cannot be made later is a panic.
    if let Err(error) = rayon::ThreadPoolBuilder::new().build_global() {
        output::complain(&format!("no threads can be started: {error}"));
        return ExitCode::from(2);
    }
    match dispatch(&cli.command, &interrupt) {
        Ok(good) => ExitCode::from(if good { 0 } else { 1 }),
        Err(Error::Cancelled) => interrupt::end(),
        Err(error) => {
            output::complain(&errors::line(&error));
            ExitCode::from(2)
        }
    }
}

/// Help and version as clap prints them, a wrong command line in one line.
fn usage(error: &clap::Error) -> ExitCode {
    if !error.use_stderr() || error.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
        // Whoever closed the pipe has read enough.
        let _ = error.print();
    } else {
        output::complain(&errors::usage(&error.render().to_string()));
    }
    ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2))
}

fn dispatch(command: &Command, interrupt: &Interrupt) -> Result<bool> {
    match command {
        Command::Render(args) => render::run(args, interrupt).map(|()| true),
        Command::Compare(args) => compare::run(args, interrupt).map(|()| true),
        Command::Bench(args) => bench::run(args, interrupt).map(|()| true),
        Command::Diff(args) => diff::run(args).map(|()| true),
        Command::Devices(args) => devices::run(args).map(|()| true),
        Command::Selftest(args) => selftest::run(args),
        Command::Doctor(args) => doctor::run(args, interrupt).map(|()| true),
        Command::Bake(args) => bake::run(args, interrupt).map(|()| true),
        Command::MakeScene(args) => {
            progress::with_bar(interrupt, |monitor| {
                rarefy::internal::scene::builtin::write_watched(&args.name, &args.output, monitor)
            })?;
            output::say(None, &args.output.display().to_string());
            Ok(true)
        }
    }
}
