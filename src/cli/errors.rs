// SPDX-License-Identifier: MIT OR Apache-2.0
//! Errors of the library in the command's words: one line, with the options that would help.

use rarefy::Error;
use rarefy::internal::error::{Remedy, Setting};

/// The option that gives a setting.
fn option(setting: Setting) -> Option<&'static str> {
    Some(match setting {
        Setting::Size => "--size",
        Setting::Samples => "--samples",
        Setting::Mode => "--mode",
        Setting::Depth => "--depth",
        Setting::Method => "--method",
        Setting::Block => "--blocks",
        Setting::Tests => "--disable-test",
        Setting::TPos => "--t-pos",
        Setting::TNorm => "--t-norm",
        Setting::TConv => "--t-conv",
        Setting::TTex => "--t-tex",
        Setting::TGcol => "--t-gcol",
        Setting::Textures => "--textures",
        Setting::GcolSpace => "--gcol-space",
        Setting::Interpolation => "--interpolation",
        Setting::Correction => "--correction",
        Setting::CorrectionSpread => "--correction-method",
        Setting::CorrectionTVisible => "--correction-t-visible",
        Setting::CorrectionTNorm => "--correction-t-norm",
        Setting::CorrectionTGcol => "--correction-t-gcol",
        Setting::Device => "--device",
        Setting::Profile => "--profile",
        Setting::MemoryBudget => "--memory-budget",
        Setting::Shading => "--shading",
        Setting::Layer => "--layer",
        _ => return None,
    })
}

/// What the command calls a remedy.
fn remedy(remedy: Remedy) -> String {
    match remedy {
        Remedy::LargerBudget => "a larger --memory-budget".into(),
        Remedy::SmallerPicture => "a smaller --size".into(),
        Remedy::FewerSamples => "fewer --samples".into(),
        Remedy::ConvergedCorrection => "--correction-method converged".into(),
        Remedy::OtherDevice => "another --device".into(),
        Remedy::Cpu => "--device cpu".into(),
        Remedy::Retry => "--retry-crashed".into(),
        Remedy::ShorterSlices => "a --profile with lower `slice_ms`".into(),
        Remedy::SmallerWorkGroup => "a --profile with a smaller work-group".into(),
        other => other.to_string(),
    }
}

/// ` (use this, that or another thing)`, or nothing.
fn remedies(remedies: &[Remedy]) -> String {
    let words: Vec<String> = remedies.iter().copied().map(remedy).collect();
    match words.as_slice() {
        [] => String::new(),
        [one] => format!(" (use {one})"),
        [first @ .., last] => format!(" (use {} or {last})", first.join(", ")),
    }
}

/// One line for `error`.
pub fn line(error: &Error) -> String {
    let text = match error {
        Error::InvalidOption { setting, value, allowed } => {
            let name = option(*setting).unwrap_or(setting.path());
            format!("{name}: `{value}` is not allowed; it may be {allowed}")
        }
        Error::LimitExceeded { what, limit, wanted, allowed, remedies: given } => {
            let is_budget = limit == Setting::MemoryBudget.path();
            let limit = if is_budget { "--memory-budget" } else { limit };
            format!("{what} needs {wanted}, the limit `{limit}` allows {allowed}{}", remedies(given))
        }
        Error::NoOpenCl { .. } => format!("{error}{}", remedies(&[Remedy::Cpu])),
        Error::DeviceLost { device, cause } => {
            format!("{device} was lost twice in one frame: {cause}{}", remedies(Remedy::OF_A_LOST_DEVICE))
        }
        Error::DriverCrashed { device, work } => format!(
            "the process ended at an earlier start while {device} was {work}; that is not tried again{}",
            remedies(Remedy::OF_A_CRASH)
        ),
        other => other.to_string(),
    };
    one_line(&text)
}

/// clap's message without the usage that follows it, in one line.
pub fn usage(rendered: &str) -> String {
    let lines = rendered.lines().map(str::trim).take_while(|line| !line.starts_with("Usage:"));
    let mut text = String::new();
    for line in lines.filter(|line| !line.is_empty() && !line.starts_with("For more information")) {
        match text.is_empty() {
            true => text.push_str(line.strip_prefix("error: ").unwrap_or(line)),
            false => text.extend([if line.starts_with("tip:") { "; " } else { " " }, line]),
        }
    }
    text
}

/// `text` with its lines side by side.
pub fn one_line(text: &str) -> String {
    text.lines().map(str::trim).filter(|line| !line.is_empty()).collect::<Vec<_>>().join(" | ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::args::Cli;
    use clap::CommandFactory;

    #[test]
    fn every_option_that_is_named_exists_and_every_setting_of_a_frame_has_one() {
        let mut command = Cli::command();
        command.build();
        let render = command.find_subcommand("render").unwrap();
        for &setting in Setting::ALL {
            match option(setting) {
                Some(option) => {
                    let known = render.get_arguments().any(|a| a.get_long() == option.strip_prefix("--"));
                    assert!(known, "{setting}: there is no {option}");
                }
                None => {
                    let part = setting.path().split('.').next().unwrap();
                    assert!(["kdtree", "memory_path", "scene", "traversal"].contains(&part), "{setting} has no option");
                }
            }
        }
    }

    #[test]
    fn errors_name_the_options_that_help_and_are_one_line() {
        let (what, wanted, allowed) = ("a band".to_owned(), "2 MiB".to_owned(), "1 MiB".to_owned());
        let limit = Setting::MemoryBudget.to_string();
        let remedies = &[Remedy::LargerBudget, Remedy::FewerSamples, Remedy::SmallerScene];
        assert_eq!(
            line(&Error::LimitExceeded { what, limit, wanted, allowed, remedies }),
            "a band needs 2 MiB, the limit `--memory-budget` allows 1 MiB \
             (use a larger --memory-budget, fewer --samples or a smaller scene)"
        );
        assert_eq!(
            line(&Error::option(Setting::TPos, f32::NAN, "0 or more")),
            "--t-pos: `NaN` is not allowed; it may be 0 or more"
        );
        let lost = Error::DeviceLost { device: "x".into(), cause: "y".into() };
        assert!(line(&lost).contains("--profile") && line(&lost).ends_with("--device cpu)"), "{}", line(&lost));
        assert!(line(&Error::NoOpenCl { tried: vec!["z".into()] }).ends_with("z (use --device cpu)"));
        let crashed = Error::DriverCrashed { device: "x".into(), work: "building program `trace`".into() };
        assert!(
            line(&crashed).ends_with("not tried again (use --retry-crashed or --device cpu)"),
            "{}",
            line(&crashed)
        );
        let log = "step1.cl:3: error: a\n   int b\n\n".to_owned();
        let build = Error::KernelBuild { program: "step1".into(), device: "x".into(), log };
        assert!(line(&build).ends_with("on x: | step1.cl:3: error: a | int b"), "{}", line(&build));
    }

    #[test]
    fn wrong_command_lines_are_one_line() {
        let line = |words: &[&str]| {
            let error = <Cli as clap::Parser>::try_parse_from(words).unwrap_err();
            usage(&error.render().to_string())
        };
        assert_eq!(
            line(&["rarefy", "render", "wall", "--sizes", "1x1"]),
            "unexpected argument '--sizes' found; tip: a similar argument exists: '--size'"
        );
        assert!(line(&["rarefy", "render"]).ends_with("were not provided: <SCENE>"));
    }
}
