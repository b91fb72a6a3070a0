// SPDX-License-Identifier: MIT OR Apache-2.0
//! Negative controls of the wide engine's tests: each row breaks one expression of the engine, and the comparison with the
//! twin (`cpu_engine.rs`) must see it.
//!
//! The engine is compiled, so all rows are built at once: into a copy of the project in which each expression asks a variable
//! of the environment whether it is the broken one.
#![allow(clippy::unwrap_used, missing_docs)]

use std::path::{Path, PathBuf};
use std::process::Command;

/// The number of the broken row; none is without it.
const VARIABLE: &str = "RAREFY_ENGINE_MUTANT";

/// An expression in a file of the engine, after the text that tells it from others like it, and what it becomes.
struct Row {
    file: &'static str,
    before: &'static str,
    expression: &'static str,
    broken: &'static str,
}

const fn row(file: &'static str, before: &'static str, expression: &'static str, broken: &'static str) -> Row {
    Row { file, before, expression, broken }
}

const ROWS: &[Row] = &[
    // Lanes.
    row(
        "lanes.rs",
        "pub fn gt(self, other: Self) -> Mask<L> {\n        ",
        "Mask(other.0.simd_lt(self.0))",
        "Mask(other.0.simd_le(self.0))",
    ),
    row("lanes.rs", "pub fn floor(self) -> Self {\n        ", "Floats(self.0.floor())", "self"),
    // Cells.
    row("packet.rs", "near_max[k] = ", "t_max[k].min2(t * WIDEN_UP)", "t_max[k].min2(t * 0.999)"),
    row("packet.rs", "let near_is_first = ", "!(self.negative[axis][k] ^ flip)", "self.negative[axis][k] ^ flip"),
    // Closest hit and any hit.
    row("traverse.rs", "let tie = ", "t.equals(best.t) & Words::splat(l, id).lt(best.triangle)", "t.equals(best.t)"),
    row("traverse.rs", "let ahead = if ", "bits & TRIANGLE_GLASS != 0", "false"),
    row("traverse.rs", "            if ", "bits & TRIANGLE_GLASS != 0", "false"),
    row("traverse.rs", "        if ", "is_hole(scene, triangle, u[lane], v[lane])", "false"),
    row("traverse.rs", "shadowed[k] = ", "shadowed[k] | lanes", "lanes"),
    // The triangle test.
    row("triangle_test.rs", "lanes = ", "lanes.without(sum.lt(zero) ^ z.lt(zero))", "lanes"),
    row("triangle_test.rs", "let ahead = ", "across.lt(zero).select(-height, height)", "height"),
    row("triangle_test.rs", "lanes = ", "lanes & ahead.gt(error)", "lanes & ahead.gt(zero)"),
    // Surface points.
    row("surface.rs", "let geometric_normal = ", "g.dot(d).gt(zero).select_vectors(-g, g)", "g"),
    row("surface.rs", "let (s, t) = (interpolate([0, 2, 4]), ", "interpolate([1, 3, 5])", "interpolate([1, 5, 3])"),
    // Ray trees.
    row("ray_tree.rs", "limit[k] = if scene.anchor { distance } else { ", "distance * SHADOW_REACH", "distance * 0.5"),
    row("ray_tree.rs", "asks = ", "faces.without(is_known)", "faces"),
    row("ray_tree.rs", "let total = ", "sin2_t.ge(one)", "sin2_t.lt(sin2_t)"),
    row("ray_tree.rs", "inside: ", "c.inside ^ refracts.without(thin)", "c.inside"),
    row("ray_tree.rs", "behind: ", "lanes.without(textured).select_words(s.behind, no_object)", "s.behind"),
    // Shading.
    row("shade.rs", "let low = ", "low.lt(last).select_words(low, last)", "low & last"),
    row("shade.rs", "let lit = ", "points.lanes.without(points.shadow_bits.has(l, 1 << i))", "points.lanes"),
    row("vectors.rs", "quantise(below.select(fx, x)) | ", "quantise(below.select(fy, y))", "quantise(y)"),
    // The checks, in the paper's order, and what follows them.
    row("similarity.rs", "let mut mask = ", "self.bits_in(other_object, FAIL_G1)", "self.word(0)"),
    row(
        "similarity.rs",
        "let near = ",
        "distance.le(self.splat(step.t_pos))",
        "distance.le(self.splat(2.0 * step.t_pos))",
    ),
    row(
        "similarity.rs",
        "fails = fails | ",
        "self.bits_in(!a.normal.dot(b.normal).ge(self.splat(step.t_norm)), FAIL_G3)",
        "self.word(0)",
    ),
    row(
        "similarity.rs",
        "let bends = ",
        "(sa.gt(zero) & sb.lt(zero)) | (sa.lt(zero) & sb.gt(zero))",
        "sa.gt(zero) & sb.lt(zero)",
    ),
    row(
        "similarity.rs",
        "fails = fails | ",
        "self.bits_in(textured & self.textures_part(a, b), FAIL_TX)",
        "self.word(0)",
    ),
    row(
        "similarity.rs",
        "fails = fails | ",
        "self.bits_in(!a.shadow_bits.equals(b.shadow_bits), FAIL_SH)",
        "self.word(0)",
    ),
    row("similarity.rs", "fails = fails | self.bits_in(", "!alike | between", "!alike"),
    row("similarity.rs", "wa = ", "zb / (za + zb)", "za / (za + zb)"),
    row("similarity.rs", "let joins = ", "by_a | by_b", "by_a"),
    row(
        "planes.rs",
        "(PLANE_TEXCOORD, ",
        "half_word(a.s) | half_word(a.t).shifted_left(16)",
        "half_word(a.t) | half_word(a.s).shifted_left(16)",
    ),
    // Launches.
    row("pack.rs", "None => (begin, ", "CLASS_PENDING | CLASS_SECONDARY", "CLASS_PENDING"),
];

fn copy(from: &Path, to: &Path) {
    if from.is_file() {
        std::fs::copy(from, to).unwrap();
        return;
    }
    std::fs::create_dir_all(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap() {
        let name = entry.unwrap().file_name();
        if name != "target" {
            copy(&from.join(&name), &to.join(&name));
        }
    }
}

/// The project with all rows in it.
fn mutated_project(root: &Path) -> tempfile::TempDir {
    let project = tempfile::tempdir().unwrap();
    for part in ["Cargo.toml", "Cargo.lock", "src", "kernels", "scenes", "android", "fuzz", "host-tests"] {
        copy(&root.join(part), &project.path().join(part));
    }
    let engine = project.path().join("src/device/cpu");
    for (i, row) in ROWS.iter().enumerate() {
        let path = engine.join(row.file);
        let text = std::fs::read_to_string(&path).unwrap();
        let given = format!("{}{}", row.before, row.expression);
        assert_eq!(text.matches(&given).count(), 1, "{}: {given}", row.file);
        let either =
            format!("{}(if super::is_mutant({i}) {{ {} }} else {{ {} }})", row.before, row.broken, row.expression);
        std::fs::write(&path, text.replace(&given, &either)).unwrap();
    }
    let module = engine.join("mod.rs");
    let asks = format!(
        "{}\n#[inline(always)]\npub(crate) fn is_mutant(number: u32) -> bool {{\n    static BROKEN: std::sync::LazyLock<u32> = \
         std::sync::LazyLock::new(|| std::env::var(\"{VARIABLE}\").map_or(u32::MAX, |n| n.parse().unwrap_or(u32::MAX)));\n    \
         *BROKEN == number\n}}\n",
        std::fs::read_to_string(&module).unwrap()
    );
    std::fs::write(&module, asks).unwrap();
    project
}

/// Copies what cargo built of other people's crates to `project`, so that these are not built again. The project's own must
/// not lie in one folder with those of its copy: cargo tells them apart by where they lie within the project.
fn copy_dependencies(project: &Path) {
    let program = std::env::current_exe().unwrap();
    let built = program.parent().unwrap().parent().unwrap();
    for part in [".fingerprint", "build", "deps"] {
        let to = project.join("target/debug").join(part);
        std::fs::create_dir_all(&to).unwrap();
        let files = std::fs::read_dir(built.join(part)).unwrap().map(|entry| entry.unwrap().path()).filter(|path| {
            let is_ours = path.file_name().unwrap().to_str().unwrap().contains("rarefy");
            let is_library =
                path.extension().is_some_and(|e| ["rlib", "rmeta", "so", "d"].iter().any(|&library| e == library));
            !is_ours && (part != "deps" || is_library)
        });
        let files: Vec<PathBuf> = files.collect();
        for some in files.chunks(200) {
            // With their times, by which cargo tells what is new.
            assert!(Command::new("cp").arg("-a").args(some).arg(&to).status().unwrap().success());
        }
    }
}

/// The test of the engine, built from `project`.
fn build(project: &Path) -> PathBuf {
    copy_dependencies(project);
    let output = Command::new(env!("CARGO"))
        .args([
            "test",
            "--workspace",
            "--test",
            "cpu_engine",
            "--no-run",
            "--message-format",
            "json-render-diagnostics",
        ])
        .args(["--target-dir", "target"])
        .current_dir(project)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    let messages = text.lines().map(|line| serde_json::from_str::<serde_json::Value>(line).unwrap());
    let mut programs = messages
        .filter(|message| message["target"]["name"] == "cpu_engine")
        .filter_map(|message| message["executable"].as_str().map(PathBuf::from));
    programs.next().expect("cargo names no program")
}

#[test]
#[ignore = "long: builds the engine anew"]
fn the_comparison_with_the_twin_sees_every_broken_expression() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").canonicalize().unwrap();
    let project = mutated_project(&root);
    let program = build(project.path());
    // As `cargo test` runs it.
    let passes = |mutant: Option<usize>| {
        let mut command = Command::new(&program);
        command.current_dir(project.path().join("host-tests")).env_remove(VARIABLE);
        if let Some(number) = mutant {
            command.env(VARIABLE, number.to_string());
        }
        command.output().unwrap().status.success()
    };
    assert!(passes(None), "the tests fail where nothing is broken");
    let missed: Vec<String> = ROWS
        .iter()
        .enumerate()
        .filter(|&(number, _)| passes(Some(number)))
        .map(|(_, row)| format!("{}: {} -> {}", row.file, row.expression, row.broken))
        .collect();
    assert!(missed.is_empty(), "nothing sees:\n{}", missed.join("\n"));
}
