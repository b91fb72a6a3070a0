// SPDX-License-Identifier: MIT OR Apache-2.0
//! Text files as people really save them: logical lines of OBJ and MTL files, and whole small texts.
//!
//! Line ends may be LF, CRLF or a lone CR; a backslash before a line end joins two lines; a UTF-8 byte order mark is
//! skipped. UTF-16 and binary files are refused with a message that says so.

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};

use super::source::{Input, Source};
use crate::{Error, Result};

/// Longest logical line: far above any real polygon, far below what would fill the memory.
const MAX_LINE_BYTES: usize = 64 << 20;

/// Largest OBJ file: a model of ten million triangles has half of it.
pub(super) const MAX_OBJ_BYTES: u64 = 4 << 30;

/// Largest MTL file: half a million materials.
pub(super) const MAX_MTL_BYTES: u64 = 64 << 20;

/// How much of a file is looked at to tell text from other things.
const PROBE_BYTES: usize = 64 << 10;

/// A file that yields logical lines with the number of the physical line that each begins at.
pub(super) struct LogicalLines {
    reader: BufReader<Input>,
    path: PathBuf,
    /// The bytes of the current logical line.
    line: Vec<u8>,
    /// Physical lines read so far.
    physical_lines: usize,
    /// The last line ended in CR: an LF that follows belongs to it.
    after_cr: bool,
    bytes_read: u64,
    bytes_total: u64,
}

impl LogicalLines {
    /// Opens a file of at most `max_bytes`; an empty, UTF-16 or binary one is an error here.
    pub(super) fn open(source: &Source, path: &Path, max_bytes: u64) -> Result<Self> {
        let file = source.open(path, max_bytes)?;
        let bytes_total = file.length();
        let mut reader = BufReader::with_capacity(PROBE_BYTES, file);
        let probe = reader.fill_buf().map_err(|e| Error::io(path, e))?;
        check_is_text(path, probe)?;
        let mark = if probe.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        reader.consume(mark);
        Ok(LogicalLines {
            reader,
            path: path.to_path_buf(),
            line: Vec::new(),
            physical_lines: 0,
            after_cr: false,
            bytes_read: mark as u64,
            bytes_total,
        })
    }

    /// The file.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// The part of the file that has been read, from 0 to 1.
    pub(super) fn fraction_read(&self) -> f32 {
        if self.bytes_total == 0 { 1.0 } else { (self.bytes_read as f64 / self.bytes_total as f64).min(1.0) as f32 }
    }

    /// The next logical line, without white space at either end, and the number of its first physical line from 1.
    pub(super) fn next_line(&mut self) -> Result<Option<(usize, &[u8])>> {
        self.line.clear();
        let first = self.physical_lines + 1;
        if !self.read_physical_line()? {
            return Ok(None);
        }
        // A comment does not go on: `# C:\scenes\` is common.
        let is_comment = self.line.trim_ascii_start().first() == Some(&b'#');
        while !is_comment && self.line.trim_ascii_end().last() == Some(&b'\\') {
            let kept = self.line.trim_ascii_end().len() - 1;
            self.line.truncate(kept);
            self.line.push(b' ');
            if !self.read_physical_line()? {
                break;
            }
        }
        Ok(Some((first, self.line.trim_ascii())))
    }

    /// Appends a physical line without its end to `line`; `false` if nothing is left.
    fn read_physical_line(&mut self) -> Result<bool> {
        let mut any = false;
        loop {
            let available = self.reader.fill_buf().map_err(|e| Error::io(&self.path, e))?;
            if self.after_cr {
                self.after_cr = false;
                if available.first() == Some(&b'\n') {
                    self.reader.consume(1);
                    self.bytes_read += 1;
                    continue;
                }
            }
            if available.is_empty() {
                self.physical_lines += usize::from(any);
                return Ok(any);
            }
            any = true;
            let end = available.iter().position(|&b| b == b'\n' || b == b'\r');
            let taken = end.unwrap_or(available.len());
            if self.line.len() + taken > MAX_LINE_BYTES {
                return Err(Error::Syntax {
                    path: self.path.clone(),
                    line: self.physical_lines + 1,
                    message: format!("line is longer than {} MiB; is this the right file?", MAX_LINE_BYTES >> 20),
                });
            }
            self.line.extend_from_slice(&available[..taken]);
            self.after_cr = end.is_some_and(|e| available[e] == b'\r');
            let consumed = taken + usize::from(end.is_some());
            self.reader.consume(consumed);
            self.bytes_read += consumed as u64;
            if end.is_some() {
                self.physical_lines += 1;
                return Ok(true);
            }
        }
    }
}

/// Reads a whole text file of at most `max_bytes`.
pub(super) fn read_text(source: &Source, path: &Path, max_bytes: u64) -> Result<String> {
    let data = source.read(path, max_bytes)?;
    check_is_text(path, &data)?;
    let data = data.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&data);
    match std::str::from_utf8(data) {
        Ok(text) => Ok(text.to_owned()),
        Err(e) => Err(Error::Syntax {
            path: path.to_path_buf(),
            line: 1 + data[..e.valid_up_to()].iter().filter(|&&b| b == b'\n').count(),
            message: "not valid UTF-8; re-save the file as UTF-8".into(),
        }),
    }
}

/// Refuses empty, UTF-16 and binary files by their first bytes.
fn check_is_text(path: &Path, probe: &[u8]) -> Result<()> {
    let refuse = |message: &str| Err(Error::scene(path.display().to_string(), message));
    if probe.is_empty() {
        return refuse("file is empty");
    }
    let nul_at = |parity: usize| probe.iter().skip(parity).step_by(2).filter(|&&b| b == 0).count();
    let (even, odd) = (nul_at(0), nul_at(1));
    // Plain English in UTF-16 has a NUL in every second byte, and always in the same half.
    let looks_utf16 = even.max(odd) * 4 > probe.len() && even.min(odd) * 16 < probe.len();
    if probe.starts_with(b"\xff\xfe") || probe.starts_with(b"\xfe\xff") || looks_utf16 {
        return refuse("text is UTF-16; re-save the file as UTF-8");
    }
    if even + odd > 0 {
        return refuse("not a text file (it has NUL bytes); a scene is an OBJ file with MTL and view.json as text");
    }
    Ok(())
}

/// The text of a name. What is not valid UTF-8 is read as Latin-1, each byte a character: the commonest other encoding,
/// and one that gives the bytes of a file's name back.
pub(super) fn name_text(bytes: &[u8]) -> String {
    let bytes = bytes.trim_ascii();
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().map(|&b| char::from(b)).collect(),
    }
}

/// Splits a line into its keyword and the rest.
pub(super) fn keyword(line: &[u8]) -> (&[u8], &[u8]) {
    let end = line.iter().position(u8::is_ascii_whitespace).unwrap_or(line.len());
    (&line[..end], line[end..].trim_ascii())
}

/// OBJ keys with more letters than this are unknown.
pub(super) const LONGEST_KEY: usize = 8;

/// `key` in lower case, in `buffer`; a longer one than any known as it is. (Exporters differ in letter case.)
pub(super) fn lower_case<'a>(key: &'a [u8], buffer: &'a mut [u8; LONGEST_KEY]) -> &'a [u8] {
    match buffer.get_mut(..key.len()) {
        Some(lower) => {
            lower.copy_from_slice(key);
            lower.make_ascii_lowercase();
            lower
        }
        None => key,
    }
}

/// A line of numbers without the comment that may follow them.
pub(super) fn without_comment(line: &[u8]) -> &[u8] {
    match line.iter().position(|&b| b == b'#') {
        Some(end) => line[..end].trim_ascii_end(),
        None => line,
    }
}

/// The words of a line.
pub(super) fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(u8::is_ascii_whitespace).filter(|w| !w.is_empty())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn lines_of(bytes: &[u8]) -> Result<Vec<(usize, String)>> {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("x.obj");
        std::fs::write(&path, bytes).unwrap();
        let mut lines =
            LogicalLines::open(&Source::Disk { confined_to: None, opened: Default::default() }, &path, MAX_OBJ_BYTES)?;
        let mut all = Vec::new();
        while let Some((number, line)) = lines.next_line()? {
            all.push((number, name_text(line)));
        }
        Ok(all)
    }

    #[test]
    fn every_kind_of_line_end_counts_once() {
        let expected = vec![(1, "a".to_string()), (2, String::new()), (3, "b c".into()), (4, "d".into())];
        for text in ["a\n\nb c\nd", "a\r\n\r\nb c\r\nd\r\n", "a\r\rb c\rd\r", "\u{feff}a\n\n  b c \nd\n"] {
            assert_eq!(lines_of(text.as_bytes()).unwrap(), expected, "{text:?}");
        }
    }

    #[test]
    fn a_backslash_joins_lines_and_numbers_stay_right() {
        let all = lines_of(b"f 1 \\\n2 \\\r\n3\n# C:\\\nv 1\\").unwrap();
        let lines: Vec<_> = all.iter().map(|(n, l)| (*n, l.split_whitespace().collect::<Vec<_>>().join(" "))).collect();
        assert_eq!(lines, [(1, "f 1 2 3".to_string()), (4, "# C:\\".into()), (5, "v 1".into())]);
    }

    #[test]
    fn files_that_are_not_text_are_named_as_what_they_are() {
        let utf16: Vec<u8> = "v 1 2 3\nf 1 2 3\n".encode_utf16().flat_map(u16::to_le_bytes).collect();
        assert!(lines_of(&utf16).unwrap_err().to_string().contains("re-save the file as UTF-8"));
        assert!(lines_of(&[&b"\xff\xfe"[..], &utf16].concat()).unwrap_err().to_string().contains("UTF-16"));
        assert!(lines_of(b"\x7fELF\0\0\x01\x02").unwrap_err().to_string().contains("not a text file"));
        assert!(lines_of(b"").unwrap_err().to_string().contains("empty"));
    }
}
