// SPDX-License-Identifier: MIT OR Apache-2.0
//! Errors of the library in the command's words: one line, with the options that would help.

use rarefy::Error;
use rarefy::error::Setting;

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
        Setting::TShadow => "--t-shadow",
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

/// One line for `error`.
pub fn line(error: &Error) -> String {
    let text = match error {
        Error::InvalidOption { setting, value, allowed } => {
            let name = option(*setting).unwrap_or(setting.path());
            format!("{name}: `{value}` is not allowed; it may be {allowed}")
        }
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
                    assert!(["kdtree", "scene", "traversal"].contains(&part), "{setting} has no option");
                }
            }
        }
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
