// SPDX-License-Identifier: MIT OR Apache-2.0
//! The kernels' intermediate code, as clang optimises it for a 32-bit device: where a profile says that indexed private
//! arrays go to memory there is none, and every argument list fits.
#![allow(clippy::unwrap_used, missing_docs)]

use std::collections::{BTreeMap, BTreeSet};

use rarefy::internal::device::kernels::FILES;
use rarefy::internal::device::opencl::Profile;
use rarefy::internal::device::stage::{Binding, Kernel, Program};
use rarefy::internal::layout::{BuildFlavour, StepParams, Traversal, build_options};
use rarefy_host_tests::clang::{clang, intermediate_code};
use rarefy_host_tests::command::root;

/// Intermediate code as far as these checks read it.
struct Code {
    text: String,
    structs: BTreeMap<String, Vec<String>>,
}

/// The parts of a list between commas outside of any bracket.
fn parts(list: &str) -> Vec<String> {
    let (mut depth, mut all) = (0, vec![String::new()]);
    for c in list.chars() {
        depth += i32::from("([{<".contains(c)) - i32::from(")]}>".contains(c));
        if c == ',' && depth == 0 {
            all.push(String::new());
        } else {
            all.last_mut().unwrap().push(c);
        }
    }
    all.iter().map(|part| part.trim().to_owned()).filter(|part| !part.is_empty()).collect()
}

/// What stands between the bracket at the start of `text` and its partner.
fn inside(text: &str) -> &str {
    let mut depth = 0;
    for (at, c) in text.char_indices() {
        depth += i32::from("([{<".contains(c)) - i32::from(")]}>".contains(c));
        if depth == 0 {
            return &text[1..at];
        }
    }
    panic!("no end: {text}");
}

impl Code {
    fn new(text: String) -> Self {
        let of_line = |line: &str| {
            let (name, list) = line.split_once(" = type ")?;
            Some((name.to_owned(), parts(inside(list))))
        };
        let structs = text.lines().filter(|line| line.starts_with('%')).filter_map(of_line).collect();
        Code { text, structs }
    }

    /// Whether an array is in a type. Bytes at a struct's end are clang's filling up to its alignment.
    fn has_array(&self, of: &str) -> bool {
        let is_filling = |member: &String| member.starts_with('[') && member.ends_with(" x i8]");
        let in_struct = |members: &Vec<String>| {
            let filled = usize::from(members.last().is_some_and(is_filling));
            members[..members.len() - filled].iter().any(|member| self.has_array(member))
        };
        of.starts_with('[') || self.structs.get(of).is_some_and(in_struct)
    }

    /// Size and alignment of a type, in bytes.
    fn size(&self, of: &str) -> (u64, u64) {
        if let Some(members) = self.structs.get(of) {
            let mut whole = (0u64, 1u64);
            for (size, align) in members.iter().map(|member| self.size(member)) {
                whole = (whole.0.next_multiple_of(align) + size, whole.1.max(align));
            }
            return (whole.0.next_multiple_of(whole.1), whole.1);
        }
        if of.starts_with(['[', '<']) {
            let (count, element) = inside(of).split_once(" x ").unwrap();
            let (size, align) = self.size(element);
            let count: u64 = count.parse().unwrap();
            // A vector of three takes the room of four.
            let bytes = if of.starts_with('<') { (count * size).next_power_of_two() } else { count * size };
            return (bytes, if of.starts_with('<') { bytes } else { align });
        }
        let bytes = match of {
            "i1" | "i8" => 1,
            "i16" | "half" => 2,
            "i32" | "float" => 4,
            "i64" | "double" => 8,
            pointer if pointer.starts_with("ptr") || pointer.ends_with('*') => 4,
            other => panic!("what is {other}?"),
        };
        (bytes, bytes)
    }

    /// Bytes that each kernel's arguments take.
    fn argument_bytes(&self) -> BTreeMap<String, u64> {
        let of_line = |line: &str| {
            let head = line.strip_prefix("define ")?.split_once("spir_kernel void @")?.1;
            let at = head.find('(').unwrap();
            let of_argument = |argument: &String| match argument.split_once("byval(") {
                Some((_, rest)) => self.size(rest.split(')').next().unwrap()).0,
                None if argument.contains('*') || argument.starts_with("ptr") => 4,
                None if argument.starts_with('<') => self.size(&format!("<{}>", inside(argument))).0,
                None => self.size(argument.split(' ').next().unwrap()).0,
            };
            Some((head[..at].to_owned(), parts(inside(&head[at..])).iter().map(of_argument).sum()))
        };
        self.text.lines().filter_map(of_line).collect()
    }

    /// Everything that makes a compiler for a GPU put private values into memory.
    fn private_arrays(&self) -> Vec<String> {
        let (mut found, mut function) = (Vec::new(), "");
        for line in self.text.lines() {
            if line.starts_with("define ") {
                function = line.split('@').nth(1).unwrap().split('(').next().unwrap();
            }
            let Some((_, what)) = line.split_once(" = ") else { continue };
            if let Some(what) = what.strip_prefix("alloca ") {
                let list = parts(what);
                if self.has_array(&list[0]) || list.iter().skip(1).any(|part| part.contains('%')) {
                    found.push(format!("{function}: a private {}", list[0]));
                }
            } else if let Some(what) = what.strip_prefix("getelementptr ") {
                let list = parts(what);
                // Pointers without an address space are private. The first index is that of the whole.
                if !list[1].contains("addrspace(") && list.iter().skip(2).any(|index| index.contains('%')) {
                    let of = list[0].trim_start_matches("inbounds ");
                    found.push(format!("{function}: an index into private {of}"));
                }
            } else if what.starts_with("extractelement ") || what.starts_with("insertelement ") {
                let list = parts(what.split_once(' ').unwrap().1);
                if list.last().unwrap().contains('%') {
                    found.push(format!("{function}: an index into a vector, {}", list[0]));
                }
            }
        }
        found
    }
}

fn compiled(clang: &str, program: &str, flavour: BuildFlavour) -> Code {
    let path = root().join("kernels").join(program);
    Code::new(intermediate_code(clang, &path, &build_options(flavour)).unwrap())
}

fn programs() -> impl Iterator<Item = &'static str> {
    FILES.iter().map(|(name, _)| *name).filter(|name| name.ends_with(".cl"))
}

/// A kernel of its own.
fn snippet(clang: &str, text: &str) -> Code {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("k.cl");
    std::fs::write(&path, text).unwrap();
    Code::new(intermediate_code(clang, &path, "").unwrap())
}

/// Compiles every program in the flavours that differ in what they keep to themselves.
fn no_private_arrays(traversal: Traversal) {
    let Some(clang) = clang() else { return };
    for (strict, count, anchor) in [(false, false, false), (true, true, false), (false, false, true)] {
        let flavour = BuildFlavour { strict, count, anchor, traversal };
        for program in programs() {
            let found = compiled(clang, program, flavour).private_arrays();
            assert!(found.is_empty(), "kernels/{program}, {flavour:?}: {found:#?}");
        }
    }
}

// Each a test of its own, so that they run side by side.

#[test]
fn kernels_with_a_short_stack_have_no_private_arrays() {
    no_private_arrays(Traversal::ShortStack);
}

#[test]
fn kernels_without_a_stack_have_no_private_arrays() {
    no_private_arrays(Traversal::Stackless);
}

#[test]
fn kernels_with_a_private_stack_are_not_for_gpus() {
    let Some(clang) = clang() else { return };
    let profiles = Profile::names().into_iter().map(|name| Profile::named(name).unwrap().choices().traversal());
    let chosen: BTreeSet<&str> = profiles.map(Traversal::name).collect();
    assert_eq!(chosen, BTreeSet::from(["short-stack", "stackless"]), "what the profiles choose");
    // The private stack is one, in every program that traces.
    for program in [Program::Trace, Program::CorrectTail, Program::CorrectSweep] {
        let found = compiled(clang, &format!("{}.cl", program.name()), BuildFlavour::default()).private_arrays();
        assert!(found.iter().any(|f| f.contains("closest_hit: a private [48 x i32]")), "{found:#?}");
        assert!(found.iter().any(|f| f.contains("closest_hit: an index into private [48 x float]")), "{found:#?}");
    }
}

#[test]
fn every_kind_of_private_array_is_found() {
    let Some(clang) = clang() else { return };
    let found = |body: &str| {
        let text = format!(
            "typedef struct {{ float a[5]; uint n; }} Bag;\n\
             float of(Bag *b, uint i) __attribute__((noinline));\n\
             float of(Bag *b, uint i) {{ return b->a[i]; }}\n\
             __kernel void k(__global float *out, uint i, float4 v) {{ {body} }}\n"
        );
        snippet(clang, &text).private_arrays().into_iter().filter(|f| f.starts_with("k:")).collect::<Vec<_>>()
    };
    for bad in [
        "float a[9]; for (uint k = 0; k < 9; ++k) a[k] = out[k]; out[0] = a[i];",
        "Bag b; for (uint k = 0; k < 5; ++k) b.a[k] = out[k]; out[0] = of(&b, i);",
        "out[0] = v[i];",
        "v[i] = 1.0f; out[0] = v.x + v.y;",
    ] {
        assert!(!found(bad).is_empty(), "not found: {bad}");
    }
    // Arrays that optimisation dissolves are none, nor are those in other memory.
    for good in
        ["float a[3] = {out[0], out[1], out[2]}; out[3] = a[0] + a[2];", "out[i] = out[i + 1];", "out[0] = v.x + v[2];"]
    {
        assert_eq!(found(good), Vec::<String>::new(), "{good}");
    }
    // An index into what a caller owns counts as well.
    let text = "float of(float *a, uint i) __attribute__((noinline));\nfloat of(float *a, uint i) { return a[i]; }\n";
    assert_eq!(snippet(clang, text).private_arrays().len(), 1);
}

/// The kernels whose arguments take more than `most`.
fn too_long(bytes: &BTreeMap<String, u64>, most: u64) -> Vec<String> {
    bytes.iter().filter(|(_, bytes)| **bytes > most).map(|(name, bytes)| format!("{name}: {bytes} bytes")).collect()
}

#[test]
fn argument_lists_fit_every_profile() {
    let Some(clang) = clang() else { return };
    let mut of_traversals: BTreeMap<&str, BTreeMap<String, u64>> = BTreeMap::new();
    for name in Profile::names() {
        let profile = Profile::named(name).unwrap();
        let most = profile.count("cl_device_max_parameter_size").unwrap();
        let traversal = profile.choices().traversal();
        let all = of_traversals.entry(traversal.name()).or_insert_with(|| {
            let flavour = BuildFlavour { traversal, ..BuildFlavour::default() };
            programs().flat_map(|program| compiled(clang, program, flavour).argument_bytes()).collect()
        });
        println!("{name}: {most} bytes at most");
        for kernel in Kernel::ALL {
            let bytes = all[kernel.name()];
            println!("  {:16} {bytes:4} bytes of arguments", kernel.name());
            // As the host passes them.
            let of = |binding: &Binding| match binding {
                Binding::Scene => 11 * 4,
                Binding::Step => size_of::<StepParams>() as u64,
                _ => 4,
            };
            assert_eq!(bytes, kernel.bindings().iter().map(of).sum::<u64>(), "{}", kernel.name());
        }
        assert_eq!(too_long(all, most), Vec::<String>::new(), "{name}");
    }
    // One that does not fit, and sizes that can be counted by hand.
    let wide = "typedef struct { float4 a[16]; float3 b; uint c; } Wide;\n\
                __kernel void k(__global uint *out, const Wide w, float3 v, uint4 q, __local float *l, ushort s) {\n\
                out[0] = w.c + q.x + s; l[0] = v.x; }\n";
    let bytes = snippet(clang, wide).argument_bytes();
    assert_eq!(bytes["k"], 4 + (256 + 16 + 16) + 16 + 16 + 4 + 2);
    assert_eq!(too_long(&bytes, 256), ["k: 330 bytes"]);
    assert_eq!(too_long(&bytes, 330), Vec::<String>::new());
}
