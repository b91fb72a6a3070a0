// SPDX-License-Identifier: MIT OR Apache-2.0
//! Kernels with bounds checks, for tests: every access to a buffer of a frame or a scene goes through a checked index.
//!
//! The checks are put into the text of a program, so that kernels are written without them and none can be forgotten:
//! what this does not understand it refuses. Each function gets one parameter more, the table of sizes. An index beyond
//! its buffer becomes 0, and the first such access is recorded in the table, where the executor finds it.

use std::collections::HashSet;

/// A kind of memory that kernels index.
struct Checked {
    /// What there is too little of, for messages.
    what: &'static str,
    /// The names of its pointers in kernels.
    names: &'static [&'static str],
    /// How many elements are read through a pointer made by adding to one of these.
    span: u32,
}

/// All memory that kernels index, in the order of the table of sizes.
const CHECKED: [Checked; SIZES] = [
    Checked { what: "words of attributes", names: &["attributes", "out_attributes"], span: 1 },
    Checked { what: "words of counters", names: &["out_counters"], span: 1 },
    Checked { what: "words of colour", names: &["color", "out_color"], span: 1 },
    Checked { what: "list entries", names: &["list", "out_list"], span: 1 },
    Checked { what: "mask words", names: &["masks", "out_masks"], span: 1 },
    Checked { what: "words of sums", names: &["sums", "out_sums"], span: 1 },
    Checked { what: "words of scratch memory", names: &["scratch"], span: 1 },
    Checked { what: "lights", names: &["lights"], span: 1 },
    Checked { what: "words of nodes", names: &["nodes"], span: 2 },
    Checked { what: "leaf entries", names: &["leaf_triangles"], span: 1 },
    Checked { what: "vectors of triangles", names: &["triangles"], span: 3 },
    Checked { what: "triangles to shade", names: &["triangle_shading"], span: 1 },
    Checked { what: "materials", names: &["materials"], span: 1 },
    Checked { what: "materials of objects", names: &["object_materials"], span: 1 },
    Checked { what: "textures", names: &["textures"], span: 1 },
    Checked { what: "texels", names: &["texels"], span: 1 },
    Checked { what: "words of tables", names: &["tables"], span: 1 },
    Checked { what: "entries of the stack", names: &["stack_node", "stack_t_max"], span: 1 },
];

/// How many sizes the table holds.
pub const SIZES: usize = 18;

/// Words before the sizes: 0 or 1 + what was left, the index, how many elements from there on, one unused.
pub const HEADER: usize = 4;

/// Pointers that kernels derive from these, and how many elements they may be indexed by; 1: by `->` alone.
const DERIVED: [(&str, u32); 5] = [("at", 2), ("tri", 3), ("shading", 1), ("m", 1), ("frame", 1)];

/// The pointers of `SCENE_PARAMS`.
const SCENE: [&str; 10] = [
    "lights",
    "nodes",
    "leaf_triangles",
    "triangles",
    "triangle_shading",
    "materials",
    "object_materials",
    "textures",
    "texels",
    "tables",
];

/// Private arrays, which no function declares as pointers.
const ARRAYS: [&str; 2] = ["stack_node", "stack_t_max"];

/// What may stand between a name and what follows it; macros go on behind a backslash.
const BLANK: [char; 4] = [' ', '\t', '\n', '\\'];

/// What every program begins with.
const PROLOGUE: &str = "\
static inline uint checked_index(__global uint *bounds, uint what, uint span, uint index) {
  const uint size = bounds[4u + what];
  if (index < size && span <= size - index) return index;
  if (atomic_cmpxchg(&bounds[0], 0u, what + 1u) == 0u) {
    bounds[1] = index;
    bounds[2] = span;
  }
  return 0u;
}
";

/// The access beyond a buffer that a table tells of, as what there was too little of and how much was wanted.
pub fn fault(table: &[u32]) -> Option<(&'static str, u64, u64)> {
    let what = (*table.first()? as usize).checked_sub(1)?;
    let (index, span) = (u64::from(*table.get(1)?), u64::from(*table.get(2)?));
    Some((CHECKED.get(what)?.what, index + span, u64::from(*table.get(HEADER + what)?)))
}

/// `source`, an assembled program, with its checks.
///
/// # Errors
/// A use of a buffer that is neither an index nor an argument, or a pointer that is not listed here.
pub fn with_checks(source: &str) -> Result<String, String> {
    let text = without_comments(source);
    let functions = text.lines().filter_map(defined).collect();
    let mut rewriter = Rewriter { text: &text, functions, pointers: HashSet::new(), out: PROLOGUE.to_owned() };
    rewriter.rewrite(0, text.len())?;
    Ok(rewriter.out)
}

/// The function that a line begins to define.
fn defined(line: &str) -> Option<&str> {
    let (head, _) = line.strip_prefix("static ")?.split_once('(')?;
    let name = head.rsplit([' ', '*']).next()?;
    (!head.contains('=')).then_some(name)
}

/// Comments hold words that look like accesses.
fn without_comments(source: &str) -> String {
    let mut out = String::with_capacity(source.len());
    let mut rest = source;
    while let Some(at) = rest.find('/') {
        out.push_str(&rest[..at]);
        rest = &rest[at..];
        let skipped = match rest.as_bytes().get(1) {
            // File names of `#line` have single ones.
            Some(b'/') => rest.find('\n').unwrap_or(rest.len()),
            Some(b'*') => rest.find("*/").map_or(rest.len(), |end| end + 2),
            _ => {
                out.push('/');
                1
            }
        };
        rest = &rest[skipped..];
    }
    out.push_str(rest);
    out
}

fn is_word(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
}

/// Where the expression that begins `text` ends: before a comma, semicolon or bracket that is not its own.
fn expression_end(text: &str) -> usize {
    let mut depth = 0usize;
    for (at, c) in text.char_indices() {
        match c {
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' if depth > 0 => depth -= 1,
            ')' | ']' | '}' | ';' => return at,
            ',' if depth == 0 => return at,
            _ => {}
        }
    }
    text.len()
}

/// Whether a `*` ends the type of a pointer to memory of the device.
fn is_declaration(before: &str) -> bool {
    let statement = before.rsplit([',', '(', ';', '{', '}']).next().unwrap_or_default();
    statement.contains("__global") || statement.contains("__constant") || statement.contains("__local")
}

/// Whether `word`, with which a line begins, begins a function.
fn begins_function(word: &str) -> bool {
    matches!(word, "static" | "__kernel")
}

struct Rewriter<'a> {
    text: &'a str,
    functions: HashSet<&'a str>,
    /// Pointers that the function which is being read has.
    pointers: HashSet<&'a str>,
    out: String,
}

impl<'a> Rewriter<'a> {
    fn rewrite(&mut self, mut at: usize, end: usize) -> Result<(), String> {
        let text = self.text;
        while at < end {
            let Some(start) = text[at..end].find(is_word).map(|start| at + start) else {
                self.out.push_str(&text[at..end]);
                return Ok(());
            };
            let word_end = text[start..end].find(|c| !is_word(c)).map_or(end, |length| start + length);
            self.out.push_str(&text[at..word_end]);
            at = self.word(start, word_end)?;
        }
        Ok(())
    }

    /// Looks at a word, which is written; where to go on behind what was written with it.
    fn word(&mut self, start: usize, end: usize) -> Result<usize, String> {
        let (word, before, after) =
            (&self.text[start..end], self.text[..start].trim_end_matches(BLANK), &self.text[end..]);
        let line = self.text[..start].rsplit('\n').next().unwrap_or_default();
        if line.starts_with("#line") || before.ends_with('.') || before.ends_with("->") {
            return Ok(end);
        }
        if line.is_empty() && begins_function(word) {
            self.pointers.clear();
        }
        if word == "SCENE_PARAMS" {
            self.pointers.extend(CHECKED.iter().flat_map(|checked| checked.names).filter(|name| SCENE.contains(name)));
        }
        let is_kernel = line == "__kernel void ";
        if after.starts_with('(') && (is_kernel || self.functions.contains(word)) {
            let is_definition = is_kernel || line.starts_with("static ") && !line.contains('(');
            self.out.push_str(if is_definition { "(__global uint *bounds" } else { "(bounds" });
            return Ok(match ["void)", ")"].into_iter().find(|empty| after[1..].starts_with(empty)) {
                Some(empty) => end + empty.len(),
                None => {
                    self.out.push_str(", ");
                    end + 1
                }
            });
        }
        let what = CHECKED.iter().position(|checked| checked.names.contains(&word));
        let derived = DERIVED.iter().find(|(name, _)| *name == word);
        if before.ends_with('*') && is_declaration(before) {
            if what.is_none() && derived.is_none() {
                return Err(format!("pointer `{word}` is not listed in src/device/bounds.rs"));
            }
            self.pointers.insert(word);
            return Ok(end);
        }
        // A macro is used where the names are pointers.
        let is_pointer = self.pointers.contains(word) || self.is_macro(start) || ARRAYS.contains(&word);
        if let Some(what) = what.filter(|_| is_pointer) {
            return self.access(what, word, end);
        }
        if let Some((_, span)) = derived
            && let Some(index) = after.strip_prefix('[')
        {
            let number = index.split(']').next().and_then(|index| index.trim_end_matches('u').parse::<u32>().ok());
            if number.is_none_or(|number| number >= *span) {
                return Err(format!("`{word}` reaches beyond the {span} elements that were checked"));
            }
        }
        Ok(end)
    }

    /// Whether a place lies in the body of a macro.
    fn is_macro(&self, at: usize) -> bool {
        let lines = self.text[..at].rsplit('\n');
        let mut own = lines.scan(true, |first, line| {
            let is_part = *first || line.ends_with('\\');
            *first = false;
            is_part.then_some(line)
        });
        own.any(|line| line.starts_with("#define"))
    }

    /// Writes what follows the pointer `word` to `CHECKED[what]`, checked; where to go on.
    fn access(&mut self, what: usize, word: &str, end: usize) -> Result<usize, String> {
        let after = &self.text[end..];
        let gap = after.len() - after.trim_start_matches(BLANK).len();
        let next = &after[gap..];
        if let Some(index) = next.strip_prefix('[') {
            if index.starts_with("MAX_DEPTH]") {
                return Ok(end); // a declaration
            }
            // Of several expressions in brackets the last counts.
            let mut length = expression_end(index);
            while index[length..].starts_with(',') {
                length += 1 + expression_end(&index[length + 1..]);
            }
            let start = end + gap + 1;
            self.out.push('[');
            self.checked(what, 1, start, start + length)?;
            self.out.push(']');
            return Ok(start + length + 1);
        }
        if let Some(sum) = next.strip_prefix("+ ") {
            let start = end + gap + 2;
            let length = expression_end(sum);
            self.out.push_str(" + ");
            self.checked(what, CHECKED[what].span, start, start + length)?;
            return Ok(start + length);
        }
        if next.starts_with([',', ')', ';']) || after[..gap].contains('\n') {
            return Ok(end);
        }
        Err(format!("`{word}` is followed by `{}`", next.chars().take(20).collect::<String>()))
    }

    fn checked(&mut self, what: usize, span: u32, start: usize, end: usize) -> Result<(), String> {
        self.out.push_str(&format!("checked_index(bounds, {what}u, {span}u, ("));
        self.rewrite(start, end)?;
        self.out.push_str("))");
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::device::kernels::program_source;
    use crate::device::stage::Program;

    #[test]
    fn accesses_are_checked_and_functions_handed_the_table() {
        let source = "static uint f(__global const uint *list, uint i) {\n  return list[i + list[0]];\n}\n\
                      static void g(void) {}\n__kernel void k(__global uint *out_masks) {\n  g();\n  \
                      out_masks[1] = f(a->list, 2u); // out_masks[7]\n  atomic_min(out_masks + b(1, 2) + 3, 4);\n}\n";
        let text = with_checks(source).unwrap();
        let text = text.strip_prefix(PROLOGUE).unwrap();
        assert_eq!(
            text,
            "static uint f(__global uint *bounds, __global const uint *list, uint i) {\n  \
             return list[checked_index(bounds, 3u, 1u, (i + list[checked_index(bounds, 3u, 1u, (0))]))];\n}\n\
             static void g(__global uint *bounds) {}\n__kernel void k(__global uint *bounds, __global uint *out_masks) {\n  \
             g(bounds);\n  out_masks[checked_index(bounds, 4u, 1u, (1))] = f(bounds, a->list, 2u); \n  \
             atomic_min(out_masks + checked_index(bounds, 4u, 1u, (b(1, 2) + 3)), 4);\n}\n"
        );
    }

    #[test]
    fn what_is_not_understood_is_refused() {
        for (source, why) in [
            ("static void f(__global uint *other) {}\n", "`other`"),
            ("static void f(__global uint *list) { uint a = *list - 1; }\n", "`list`"),
            ("static void f(__global uint *list) { list++; }\n", "`list`"),
            ("static void f(__global const uint *at) { uint a = at[2]; }\n", "beyond the 2"),
            ("static void f(__global const uint *at) { uint a = at[i]; }\n", "beyond the 2"),
        ] {
            let error = with_checks(source).unwrap_err();
            assert!(error.contains(why), "{source}: {error}");
        }
    }

    #[test]
    fn every_index_of_every_program_is_checked() {
        for program in Program::ALL {
            let text = with_checks(&program_source(program, None)).unwrap();
            for name in CHECKED.iter().flat_map(|checked| checked.names) {
                for (at, _) in text.match_indices(&format!("{name}[")) {
                    let before = text[..at].chars().next_back().unwrap();
                    let rest = &text[at + name.len() + 1..];
                    let is_checked = rest.starts_with("checked_index(bounds, ") || rest.starts_with("MAX_DEPTH]");
                    assert!(is_word(before) || is_checked, "{}: {name}[{:.40}", program.name(), rest);
                }
            }
        }
    }

    #[test]
    fn a_table_tells_of_the_first_fault() {
        let mut table = vec![0; HEADER + SIZES];
        assert_eq!(fault(&table), None);
        (table[0], table[1], table[2], table[HEADER + 3]) = (4, 70, 2, 64);
        assert_eq!(fault(&table), Some(("list entries", 72, 64)));
    }
}
