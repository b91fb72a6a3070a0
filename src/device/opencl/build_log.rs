// SPDX-License-Identifier: MIT OR Apache-2.0
//! Kernel source with marks of its files, and compiler logs read back into file, line and message.
//!
//! Compilers disagree about the form of a message and about `#line`: PoCL writes `error: file:5:15: text`, Mesa and
//! most phones `file:5:15: error: text`, and Oclgrind numbers the lines of the whole text, whatever the marks say.

use std::fmt::Write;

/// How bad a message is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Severity {
    /// The program does not build.
    Error,
    /// It builds, unless warnings are errors.
    Warning,
    /// Explains the message before it.
    Note,
}

/// One message of a compiler.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Message {
    /// The kernel file, as in the marks where possible.
    pub file: String,
    /// The line in the file, from 1.
    pub line: usize,
    /// The column, from 1.
    pub column: usize,
    /// How bad it is.
    pub severity: Severity,
    /// What the compiler says.
    pub text: String,
}

impl std::fmt::Display for Message {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let severity = match self.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Note => "note",
        };
        write!(f, "{}:{}:{}: {severity}: {}", self.file, self.line, self.column, self.text)
    }
}

/// Joins files into one program text, each after a `#line` mark with its name.
pub fn assemble(files: &[(&str, &str)]) -> String {
    let mut text = String::new();
    for (name, content) in files {
        // Writing to a `String` cannot fail.
        let _ = writeln!(text, "#line 1 \"{name}\"");
        text.push_str(content);
        if !content.ends_with('\n') {
            text.push('\n');
        }
    }
    text
}

/// The file name and line of a mark such as `#line 12 "kernels/trace.cl"`; the name is `None` if absent.
fn mark(line: &str) -> Option<(usize, Option<&str>)> {
    let rest = line.trim_start().strip_prefix('#')?.trim_start();
    let rest = rest.strip_prefix("line")?.trim_start();
    let digits = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
    let number = rest[..digits].parse().ok()?;
    let name = rest[digits..].trim().strip_prefix('"').and_then(|rest| rest.split_once('"'));
    Some((number, name.map(|(name, _)| name)))
}

/// The file and line that a line of the whole program text (from 1) came from, by its marks.
pub fn locate(source: &str, physical: usize) -> Option<(String, usize)> {
    let mut file = None;
    let mut next = 1;
    for (index, line) in source.lines().enumerate() {
        if index + 1 == physical {
            return file.map(|file: &str| (file.to_string(), next));
        }
        match mark(line) {
            Some((number, name)) => {
                next = number;
                file = name.or(file);
            }
            None => next += 1,
        }
    }
    None
}

/// Reads the messages of a compiler's log. With the program's source, places are given in its marked files.
pub fn parse(log: &str, source: &str) -> Vec<Message> {
    let names: Vec<&str> = source.lines().filter_map(|line| mark(line)?.1).collect();
    let mut messages = Vec::new();
    for line in log.lines() {
        let Some(mut message) = parse_line(line.trim()) else { continue };
        if let Some(name) = names.iter().find(|name| same_file(name, &message.file)) {
            message.file = name.to_string();
        } else if let Some((file, line)) = locate(source, message.line) {
            // The compiler named its own temporary file: it did not obey the marks.
            message.file = file;
            message.line = line;
        }
        messages.push(message);
    }
    messages
}

/// Some compilers put a folder in front of the name.
fn same_file(name: &str, reported: &str) -> bool {
    reported == name || reported.strip_suffix(name).is_some_and(|front| front.ends_with('/'))
}

fn severity(text: &str) -> Option<(Severity, &str)> {
    let words = [
        ("fatal error:", Severity::Error),
        ("error:", Severity::Error),
        ("warning:", Severity::Warning),
        ("note:", Severity::Note),
    ];
    let (word, severity) = words.into_iter().find(|(word, _)| text.starts_with(word))?;
    Some((severity, text[word.len()..].trim_start()))
}

fn parse_line(line: &str) -> Option<Message> {
    // PoCL: the severity first.
    if let Some((severity, rest)) = severity(line) {
        let (file, line, column, text) = place(rest)?;
        return Some(Message { file, line, column, severity, text: text.to_string() });
    }
    let (file, line, column, rest) = place(line)?;
    let (severity, text) = severity(rest)?;
    Some(Message { file, line, column, severity, text: text.to_string() })
}

/// Splits `file:line:column: rest`, or `file:line:column:{ranges}: rest`.
fn place(text: &str) -> Option<(String, usize, usize, &str)> {
    for (colon, _) in text.match_indices(':') {
        let mut parts = text[colon + 1..].splitn(3, ':');
        let (Some(line), Some(column), Some(rest)) = (parts.next(), parts.next(), parts.next()) else { return None };
        let (Ok(line), Ok(column)) = (line.parse(), column.parse()) else { continue };
        let rest = match rest.strip_prefix('{') {
            Some(ranges) => ranges.split_once("}:")?.1,
            None => rest,
        };
        return Some((text[..colon].to_string(), line, column, rest.trim_start()));
    }
    None
}

/// The log for an error message: the messages with their places, else the log as it is.
pub(super) fn report(log: &str, source: &str) -> String {
    let messages = parse(log, source);
    if messages.iter().any(|message| message.severity == Severity::Error) {
        return messages.iter().map(Message::to_string).collect::<Vec<_>>().join("\n");
    }
    let log = log.trim();
    if log.is_empty() { "the compiler says nothing about the reason".into() } else { log.to_string() }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn sample() -> String {
        assemble(&[("kernels/common/a.clh", "int a;\nint b;\n"), ("kernels/trace.cl", "line1\nline2\nline3")])
    }

    fn only(log: &str) -> Message {
        let messages = parse(log, &sample());
        assert_eq!(messages.len(), 1, "{log}: {messages:?}");
        messages[0].clone()
    }

    #[test]
    fn three_forms_of_logs_are_read() {
        let expected = Message {
            file: "kernels/trace.cl".into(),
            line: 2,
            column: 15,
            severity: Severity::Error,
            text: "use of undeclared identifier 'x'".into(),
        };
        // PoCL.
        assert_eq!(only("error: kernels/trace.cl:2:15: use of undeclared identifier 'x'"), expected);
        // Mesa, and phones with clang inside.
        assert_eq!(only("kernels/trace.cl:2:15: error: use of undeclared identifier 'x'"), expected);
        // Oclgrind: lines of the whole text, name of its own. Marks are lines 1 and 4.
        assert_eq!(only("input.cl:6:15: error: use of undeclared identifier 'x'"), expected);
        // Qualcomm's, with a range; and with a folder in front.
        assert_eq!(only("<source>:6:15:{6:15-6:16}: error: use of undeclared identifier 'x'"), expected);
        assert_eq!(only("/tmp/x/kernels/trace.cl:2:15: error: use of undeclared identifier 'x'"), expected);
        assert_eq!(expected.to_string(), "kernels/trace.cl:2:15: error: use of undeclared identifier 'x'");
    }

    #[test]
    fn severities_and_other_lines() {
        let log = "1 error generated.\n\nwarning: kernels/trace.cl:1:1: odd: very\n   ^~~~\nkernels/trace.cl:3:2: note: here\n\
                   kernels/common/a.clh:1:5: fatal error: gone\nerror: no place at all\n::::";
        let messages = parse(log, &sample());
        let short: Vec<_> = messages.iter().map(|m| (m.severity, m.line, m.text.as_str())).collect();
        assert_eq!(
            short,
            [(Severity::Warning, 1, "odd: very"), (Severity::Note, 3, "here"), (Severity::Error, 1, "gone")]
        );
    }

    #[test]
    fn marks_are_followed() {
        let source = sample();
        assert_eq!(locate(&source, 1), None);
        assert_eq!(locate(&source, 2), Some(("kernels/common/a.clh".into(), 1)));
        assert_eq!(locate(&source, 3), Some(("kernels/common/a.clh".into(), 2)));
        assert_eq!(locate(&source, 7), Some(("kernels/trace.cl".into(), 3)));
        assert_eq!(locate(&source, 8), None);
        assert_eq!(locate("#line 7 \"x\"\na\n# line 20\nb", 4), Some(("x".into(), 20)));
        assert_eq!(mark("#pragma line 3"), None);
    }

    #[test]
    fn a_log_without_places_is_kept() {
        assert_eq!(report("  linker trouble\n", ""), "linker trouble");
        assert_eq!(report("", ""), "the compiler says nothing about the reason");
        assert!(report("error: k.cl:1:2: bad", "").starts_with("k.cl:1:2: error: bad"));
    }

    #[test]
    fn no_text_makes_the_parser_panic() {
        for log in
            ["a:1", "a:1:", "a:1:2", "a:1:2:", "é:1:2:{", "error:", ":1:1:error:", "a:99999999999999999999:1: error: x"]
        {
            parse(log, "#line\n#line x\n#line 3 \"a");
        }
    }
}
