// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where results go: JSON to a file or standard output, and what several commands print alike.

use std::io::Write;
use std::path::Path;

use rarefy::internal::files;
use rarefy::{Error, FrameStats, Result};
use serde::Serialize;

/// What stands for standard output as the name of a file.
pub const STANDARD_OUTPUT: &str = "-";

/// Writes `value` to `path`; `-` is standard output.
pub fn write_json(path: &Path, value: &impl Serialize) -> Result<()> {
    let mut text = serde_json::to_string_pretty(value).map_err(|e| Error::argument("--json", e.to_string()))?;
    text.push('\n');
    if path == Path::new(STANDARD_OUTPUT) {
        let mut out = std::io::stdout().lock();
        return out.write_all(text.as_bytes()).and_then(|()| out.flush()).map_err(|e| Error::io("standard output", e));
    }
    files::write_whole(path, text.as_bytes())
}

/// Prints a line for people: to standard output, or to standard error where JSON has that.
pub fn say(json: Option<&Path>, line: &str) {
    // Whoever closed the pipe (`| head`) has read enough: that is no error.
    if json == Some(Path::new(STANDARD_OUTPUT)) {
        to_stderr(line);
    } else {
        let _ = writeln!(std::io::stdout(), "{line}");
    }
}

/// Prints one line about what went wrong to standard error, if that can be written.
pub fn complain(line: &str) {
    to_stderr(&format!("rarefy: {line}"));
}

/// Prints a line to standard error. One that cannot be written to is no reason to lose a picture.
fn to_stderr(line: &str) {
    let _ = writeln!(std::io::stderr(), "{line}");
}

/// The share of traced pixels, in the words that every command uses.
pub fn traced(stats: &FrameStats) -> String {
    let percent = |ratio: f64| 100.0 * ratio;
    format!(
        "{:.2} % of the pixels, {:.2} % with correction",
        percent(stats.ray_traced_ratio()),
        percent(stats.ray_traced_ratio_with_correction())
    )
}

/// Prints notices and warnings to standard error; long lists are cut.
pub fn warn_all(warnings: &[String]) {
    const MOST: usize = 8;
    for warning in warnings.iter().take(MOST) {
        to_stderr(&format!("warning: {warning}"));
    }
    if warnings.len() > MOST {
        to_stderr(&format!("warning: and {} more; `rarefy doctor` lists all", warnings.len() - MOST));
    }
}

/// Prints to standard error what is good to know; long lists are cut.
pub fn note_all(notices: &[String]) {
    const MOST: usize = 6;
    for notice in notices.iter().take(MOST) {
        to_stderr(&format!("note: {notice}"));
    }
    if notices.len() > MOST {
        to_stderr(&format!("note: and {} more; `rarefy doctor` lists all", notices.len() - MOST));
    }
}
