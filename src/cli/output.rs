// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where results go: JSON to a file or standard output, and what several commands print alike.

use std::io::Write;
use std::path::Path;

use rarefy::{Error, Result, files};
use serde_json::Value;

const STANDARD_OUTPUT: &str = "-";

/// Writes `value` to `path`; `-` is standard output.
pub fn write_json(path: &Path, value: &Value) -> Result<()> {
    let text = format!("{value:#}\n");
    if path == Path::new(STANDARD_OUTPUT) {
        let mut out = std::io::stdout().lock();
        return out.write_all(text.as_bytes()).and_then(|()| out.flush()).map_err(|e| Error::io("standard output", e));
    }
    files::write_whole(path, text.as_bytes())
}

/// Prints a line for people: to standard output, or to standard error where JSON has that.
pub fn say(json: Option<&Path>, line: &str) {
    // Whoever closed the pipe (`| head`) has read enough: that is no error.
    let _ = if json == Some(Path::new(STANDARD_OUTPUT)) {
        writeln!(std::io::stderr(), "{line}")
    } else {
        writeln!(std::io::stdout(), "{line}")
    };
}

/// Prints one line about what went wrong to standard error, if that can be written.
pub fn complain(line: &str) {
    let _ = writeln!(std::io::stderr(), "rarefy: {line}");
}

/// Prints notices and warnings to standard error; long lists are cut.
pub fn warn_all(warnings: &[String]) {
    const MOST: usize = 8;
    for warning in warnings.iter().take(MOST) {
        let _ = writeln!(std::io::stderr(), "warning: {warning}");
    }
    if warnings.len() > MOST {
        let more = warnings.len() - MOST;
        let _ = writeln!(std::io::stderr(), "warning: and {more} more; `rarefy doctor` lists all");
    }
}

/// Fails unless `path` can become a file: its folder exists. Checked before long work.
pub fn check_writable(path: &Path) -> Result<()> {
    let folder = match path.parent() {
        Some(p) if !p.as_os_str().is_empty() => p,
        _ => Path::new("."),
    };
    match folder.metadata() {
        Ok(m) if m.is_dir() => Ok(()),
        Ok(_) => Err(Error::io(folder, std::io::Error::other("is not a folder"))),
        Err(e) => Err(Error::io(folder, e)),
    }
}

/// As [`check_writable`], for `--json`.
pub fn check_json_writable(path: Option<&Path>) -> Result<()> {
    match path {
        Some(path) if path != Path::new(STANDARD_OUTPUT) => check_writable(path),
        _ => Ok(()),
    }
}
