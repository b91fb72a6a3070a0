// SPDX-License-Identifier: MIT OR Apache-2.0
//! Finds the line of an OBJ file that cannot be read, once reading has failed: `tobj`'s errors name none.

use std::path::Path;

use super::lines::{LogicalLines, MAX_OBJ_BYTES, keyword, without_comment, words};
use super::source::Source;
use crate::Error;
use crate::scene::MAX_COORDINATE;

/// The first line of `v`, `vt` or `vn` whose numbers are not numbers, not finite or too large.
///
/// `None`: there is no such line (or the file cannot be read any more).
pub(super) fn bad_number(source: &Source, path: &Path) -> Option<Error> {
    let mut lines = LogicalLines::open(source, path, MAX_OBJ_BYTES).ok()?;
    loop {
        let (number, line) = lines.next_line().ok()??;
        let (written, rest) = keyword(line);
        let rest = without_comment(rest);
        let key = written.to_ascii_lowercase();
        let least = match key.as_slice() {
            b"v" | b"vn" => 3,
            b"vt" => 1,
            _ => continue,
        };
        if let Err(message) = check(rest, least, key == b"v") {
            let key = String::from_utf8_lossy(written).into_owned();
            return Some(Error::Syntax {
                path: path.to_path_buf(),
                line: number,
                message: format!("`{key}`: {message}"),
            });
        }
    }
}

/// Checks the numbers that count of one line.
fn check(rest: &[u8], least: usize, is_position: bool) -> Result<(), String> {
    let mut values = Vec::new();
    // A fourth number is the weight, unless colours follow.
    let counted = if is_position && words(rest).count() == 4 { 4 } else { 3 };
    for word in words(rest).take(counted) {
        let text = String::from_utf8_lossy(&word[..word.len().min(60)]);
        let value: f32 = text.parse().map_err(|_| format!("`{text}` is not a number"))?;
        if !value.is_finite() {
            return Err(format!("`{text}` is not a finite number in single precision"));
        }
        values.push(value);
    }
    if values.len() < least {
        return Err(format!("{} numbers where {least} are needed", values.len()));
    }
    let weight = values.get(3).copied().unwrap_or(1.0);
    if weight == 0.0 {
        return Err("the weight (fourth number) is 0; leave it out".into());
    }
    match values.iter().take(3).find(|v| (**v / weight).abs() > MAX_COORDINATE) {
        Some(v) => Err(format!("{} is out of range (at most {MAX_COORDINATE:e}); scale the model down", v / weight)),
        None => Ok(()),
    }
}
