// SPDX-License-Identifier: MIT OR Apache-2.0
//! The kernel sources, embedded, and their assembly into programs.
//!
//! A phone has no include path: `#include "..."` lines are replaced by the file's text here, once per program, with
//! `#line` marks so that compiler messages name the real file and line.

use crate::device::stage::Program;

/// Every kernel file with its path below `kernels/`.
pub const FILES: &[(&str, &str)] = &[
    ("types.h", include_str!("../../kernels/types.h")),
    ("common/math.clh", include_str!("../../kernels/common/math.clh")),
    ("common/triangle_test.clh", include_str!("../../kernels/common/triangle_test.clh")),
    ("common/walk_stack.clh", include_str!("../../kernels/common/walk_stack.clh")),
    ("common/walk_short.clh", include_str!("../../kernels/common/walk_short.clh")),
    ("common/kdtree.clh", include_str!("../../kernels/common/kdtree.clh")),
    ("common/shade.clh", include_str!("../../kernels/common/shade.clh")),
    ("common/attributes.clh", include_str!("../../kernels/common/attributes.clh")),
    ("common/ray_tree.clh", include_str!("../../kernels/common/ray_tree.clh")),
    ("common/known_shadows.clh", include_str!("../../kernels/common/known_shadows.clh")),
    ("common/correction.clh", include_str!("../../kernels/common/correction.clh")),
    ("common/bridge.clh", include_str!("../../kernels/common/bridge.clh")),
    ("common/similarity.clh", include_str!("../../kernels/common/similarity.clh")),
    ("common/pack.clh", include_str!("../../kernels/common/pack.clh")),
    ("common/pack_order.clh", include_str!("../../kernels/common/pack_order.clh")),
    ("trace.cl", include_str!("../../kernels/trace.cl")),
    ("check.cl", include_str!("../../kernels/check.cl")),
    ("pack.cl", include_str!("../../kernels/pack.cl")),
    ("correct.cl", include_str!("../../kernels/correct.cl")),
    ("correct_tail.cl", include_str!("../../kernels/correct_tail.cl")),
    ("correct_sweep.cl", include_str!("../../kernels/correct_sweep.cl")),
    ("probe.cl", include_str!("../../kernels/probe.cl")),
];

/// A change to the kernel sources, for tests and for `selftest`'s negative control: in `file`, the first `from` becomes
/// `to`.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Mutation {
    /// Path below `kernels/`.
    pub file: String,
    /// Text that must occur.
    pub from: String,
    /// What it becomes.
    pub to: String,
}

/// The text of a program: its kernel file with everything that it includes.
pub fn program_source(program: Program, mutation: Option<&Mutation>) -> String {
    assemble(&format!("{}.cl", program.name()), mutation)
}

/// The text of `file` with its includes in place.
///
/// # Panics
/// If an embedded file includes one that is not embedded, or a mutation does not apply: mistakes in this crate or test.
pub fn assemble(file: &str, mutation: Option<&Mutation>) -> String {
    let mut out = String::new();
    let mut seen = Vec::new();
    append(file, mutation, &mut seen, &mut out);
    out
}

fn append(file: &str, mutation: Option<&Mutation>, seen: &mut Vec<String>, out: &mut String) {
    if seen.iter().any(|s| s == file) {
        return;
    }
    seen.push(file.to_owned());
    let text = FILES.iter().find(|(name, _)| *name == file).map(|(_, text)| *text);
    let text = text.unwrap_or_else(|| panic!("kernels/{file} is not embedded in src/device/kernels.rs"));
    let mutated = mutation.filter(|m| m.file == file).map(|m| {
        assert!(text.contains(&m.from), "kernels/{file} has no `{}` to mutate", m.from);
        text.replacen(&m.from, &m.to, 1)
    });
    let text = mutated.as_deref().unwrap_or(text);
    out.push_str(&format!("#line 1 \"kernels/{file}\"\n"));
    for (number, line) in text.lines().enumerate() {
        if let Some(name) = line.strip_prefix("#include \"").and_then(|rest| rest.strip_suffix('"')) {
            append(name, mutation, seen, out);
            out.push_str(&format!("#line {} \"kernels/{file}\"\n", number + 2));
        } else {
            out.push_str(line);
            out.push('\n');
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn programs_hold_every_include_once_and_keep_line_numbers() {
        for program in Program::ALL {
            let source = program_source(program, None);
            assert!(!source.contains("#include"), "{}", program.name());
            assert_eq!(source.matches("#line 1 \"kernels/types.h\"").count(), 1);
        }
        let source = program_source(Program::Trace, None);
        let after = source.split("__kernel void trace").next().unwrap().rsplit("#line ").next().unwrap();
        let (line, rest) = after.split_once(' ').unwrap();
        let expected = FILES.iter().find(|(n, _)| *n == "trace.cl").unwrap().1;
        let kernel_line = expected.lines().position(|l| l.starts_with("__kernel")).unwrap() + 1;
        assert!(rest.starts_with("\"kernels/trace.cl\"\n"));
        assert_eq!(line.parse::<usize>().unwrap() + rest.matches('\n').count() - 1, kernel_line);
    }
}
