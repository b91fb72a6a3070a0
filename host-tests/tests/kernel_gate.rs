// SPDX-License-Identifier: MIT OR Apache-2.0
//! Kernels through a stricter compiler than any driver's, without a device: clang for a 32-bit target with no optional
//! feature, warnings as errors. And what every kernel file must say about itself.
#![allow(clippy::unwrap_used, missing_docs)]

use std::collections::{BTreeMap, BTreeSet};

use rarefy::internal::device::kernels::{FILES, assemble};
use rarefy::internal::layout::{BuildFlavour, Traversal, build_options};
use rarefy_host_tests::clang::{check, clang};
use rarefy_host_tests::command::root;

fn flavours() -> [BuildFlavour; 7] {
    let of = |strict, count, anchor| BuildFlavour { strict, count, anchor, ..BuildFlavour::default() };
    let walking_by = |traversal| BuildFlavour { traversal, ..of(true, true, false) };
    [
        of(false, false, false),
        of(true, false, false),
        of(false, true, false),
        of(false, false, true),
        of(true, true, true),
        walking_by(Traversal::ShortStack),
        walking_by(Traversal::Stackless),
    ]
}

/// The kernel programs: every embedded file that is one, by name.
fn programs() -> Vec<&'static str> {
    FILES.iter().map(|(name, _)| *name).filter(|name| name.ends_with(".cl")).collect()
}

/// Files of `kernels/` and `kernels/common/`, by their path below `kernels/`; documents aside.
fn files_on_disk() -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    for folder in ["", "common/"] {
        for entry in root().join("kernels").join(folder).read_dir().unwrap() {
            let entry = entry.unwrap();
            if entry.file_type().unwrap().is_file() && entry.path().extension().is_none_or(|e| e != "md") {
                names.insert(format!("{folder}{}", entry.file_name().to_str().unwrap()));
            }
        }
    }
    names
}

#[test]
fn every_kernel_passes_the_strict_compiler_in_every_flavour() {
    let Some(clang) = clang() else { return };
    for name in programs() {
        for flavour in flavours() {
            let options = build_options(flavour);
            let result = check(clang, &root().join("kernels").join(name), &options);
            assert!(result.is_ok(), "kernels/{name}, {flavour:?}: {}", result.unwrap_err());
        }
    }
}

#[test]
fn the_gate_refuses_what_phones_refuse() {
    let Some(clang) = clang() else { return };
    let options = build_options(BuildFlavour::default());
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("k.cl");
    let try_it = |body: &str| {
        std::fs::write(&path, format!("#include \"types.h\"\n__kernel void k(__global float *out) {{ {body} }}\n"))
            .unwrap();
        check(clang, &path, &options)
    };
    try_it("out[0] = 1.0f;").unwrap();
    for bad in [
        "out[0] = 1.0;",
        "double d = 1; out[0] = d;",
        "uint unused;",
        "out[0] = missing(1);",
        "out[0] = as_float(sub_group_size());",
    ] {
        assert!(try_it(bad).is_err(), "accepted: {bad}");
    }
}

/// The functions and function-like macros of a program, with those that each one names.
fn call_graph(source: &str) -> BTreeMap<String, BTreeSet<String>> {
    let without_comments: String = source.lines().map(|l| l.split("//").next().unwrap().to_owned() + "\n").collect();
    let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let mut bodies: BTreeMap<String, String> = BTreeMap::new();
    let mut lines = without_comments.lines().peekable();
    while let Some(line) = lines.next() {
        if let Some(rest) = line.strip_prefix("#define ") {
            let name: String = rest.chars().take_while(|&c| is_word(c)).collect();
            let mut body = rest[name.len()..].to_owned();
            while body.ends_with('\\') {
                body.pop();
                body += lines.next().unwrap();
            }
            bodies.entry(name).or_default().push_str(&body);
        } else if line.starts_with("static ") || line.starts_with("__kernel ") {
            let head = line.split('(').next().unwrap();
            let name = head.rsplit(|c| !is_word(c)).next().unwrap().to_owned();
            let mut body = line.to_owned();
            // A definition ends at its brace in the first column, or on its own line.
            let is_one_line = line.ends_with('}');
            while let Some(next) = lines.next_if(|_| !is_one_line) {
                body.push('\n');
                body += next;
                if next.starts_with('}') {
                    break;
                }
            }
            let after_head = body.split_once('(').unwrap().1.to_owned();
            bodies.insert(name, after_head);
        }
    }
    let names: BTreeSet<&String> = bodies.keys().collect();
    let called = |body: &String| {
        body.split(|c| !is_word(c)).filter(|w| names.contains(&w.to_string())).map(str::to_owned).collect()
    };
    bodies.iter().map(|(name, body)| (name.clone(), called(body))).collect()
}

/// A function that can reach itself.
fn cycle(graph: &BTreeMap<String, BTreeSet<String>>) -> Option<String> {
    graph
        .keys()
        .find(|&start| {
            let (mut seen, mut open) = (BTreeSet::new(), vec![start.clone()]);
            while let Some(name) = open.pop() {
                for next in &graph[&name] {
                    if next == start {
                        return true;
                    }
                    if seen.insert(next.clone()) {
                        open.push(next.clone());
                    }
                }
            }
            false
        })
        .cloned()
}

#[test]
fn no_kernel_recurses() {
    for name in programs() {
        let graph = call_graph(&assemble(name, None));
        assert_eq!(cycle(&graph), None, "kernels/{name}");
    }
    // The scan sees the calls that there are.
    let graph = call_graph(&assemble("trace.cl", None));
    assert!(graph["trace"].contains("trace_pixel") && graph["trace_pixel"].contains("closest_hit"));
    assert!(graph["closest_hit"].contains("INTERSECT"));
    let graph = call_graph(
        "static int a(int x) {\n  return b(x);\n}\n#define C(x) a(x)\nstatic int b(int x) { return C(x); }\n",
    );
    assert!(cycle(&graph).is_some());
}

#[test]
fn every_kernel_file_is_embedded_and_says_what_it_does() {
    let embedded: BTreeSet<String> = FILES.iter().map(|(name, _)| (*name).to_owned()).collect();
    assert_eq!(embedded, files_on_disk(), "src/device/kernels.rs embeds other files than kernels/ holds");
    for (name, text) in FILES {
        let mut lines = text.lines();
        assert_eq!(lines.next(), Some("// SPDX-License-Identifier: MIT OR Apache-2.0"), "kernels/{name}");
        let header: Vec<&str> = lines.take_while(|l| l.starts_with("//")).collect();
        let header = header.join("\n");
        let wanted: &[&str] = match name.rsplit_once('.').unwrap().1 {
            "cl" => &["Inputs:", "Outputs:", "Invariant:", "Cost:", "Twin:"],
            "clh" => &[],
            _ => continue,
        };
        for part in wanted {
            assert!(header.contains(part), "kernels/{name}: its header does not say `{part}`");
        }
        let twins: Vec<&str> = header
            .split(|c: char| c.is_whitespace() || "(),;".contains(c))
            .map(|word| word.trim_end_matches('.'))
            .filter(|word| word.starts_with("src/") && word.ends_with(".rs"))
            .collect();
        assert!(!twins.is_empty(), "kernels/{name}: its header names no twin in src/");
        for twin in twins {
            assert!(root().join(twin).is_file(), "kernels/{name} names {twin}, which is not there");
        }
    }
}
