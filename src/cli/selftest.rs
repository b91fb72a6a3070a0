// SPDX-License-Identifier: MIT OR Apache-2.0
//! `rarefy selftest`.

use rarefy::internal::device::open::DeviceOptions;
use rarefy::internal::device::stage::Stage;
use rarefy::internal::selftest::full as selftest;
use rarefy::{Error, Result};

use super::args::{SelftestArgs, profile};
use super::errors;
use super::output::{complain, say};

/// Prints every check; true if all passed.
pub fn run(args: &SelftestArgs) -> Result<bool> {
    let mutation = match &args.break_stage {
        None => None,
        Some(name) => {
            let stage = Stage::ALL.into_iter().find(|s| s.name() == name).ok_or_else(|| {
                let known = Stage::ALL.map(Stage::name).join(", ");
                Error::argument("--break-stage", format!("there is no stage `{name}`; the stages are {known}"))
            })?;
            Some(selftest::breaking_mutation(stage))
        }
    };
    let options = DeviceOptions {
        device: args.device,
        profile: profile(&args.profile)?,
        mutation,
        // Whoever asks for a test wants to know how it is now.
        retry_crashed: true,
        ..DeviceOptions::default()
    };
    let result = selftest::run(&options)?;
    say(None, &result.device);
    for check in &result.checks {
        let word = if check.passed { "ok" } else { "WRONG" };
        say(None, &format!("  {word:5} {:15} {}", check.name, check.detail));
    }
    if let Err(error) = result.require() {
        complain(&errors::line(&error));
    }
    Ok(result.passed())
}
