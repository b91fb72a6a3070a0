// SPDX-License-Identifier: MIT OR Apache-2.0
//! The shape of the source tree: data and modules point one way, documents name what exists, files stay small.
#![allow(clippy::unwrap_used, missing_docs)]

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use rarefy_host_tests::command::root;

/// The modules of the library in layers: a module may use those of its own layer and of the layers before.
const LAYERS: &[&[&str]] = &[
    &["error", "files", "memory", "math", "monitor", "names", "settings"],
    &["layout"],
    &["scene"],
    &["prepare"],
    &["device"],
    &["method"],
    &["selftest"],
    &["render"],
    &["analysis"],
];

fn layer(module: &str) -> Option<usize> {
    LAYERS.iter().position(|modules| modules.contains(&module))
}

fn files_below(folder: &Path, extensions: &[&str], found: &mut Vec<PathBuf>) {
    for entry in folder.read_dir().unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files_below(&path, extensions, found);
        } else if path.extension().and_then(|e| e.to_str()).is_some_and(|e| extensions.contains(&e)) {
            found.push(path);
        }
    }
}

fn sources(folder: &str, extensions: &[&str]) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let folder = root().join(folder);
    if folder.is_dir() {
        files_below(&folder, extensions, &mut found);
    }
    found.sort();
    let name = |path: &PathBuf| path.strip_prefix(root()).unwrap().to_str().unwrap().to_owned();
    found.iter().map(|path| (name(path), std::fs::read_to_string(path).unwrap())).collect()
}

/// The top-level modules that `text` names as `crate::module`.
fn used_modules(text: &str) -> BTreeSet<String> {
    let mut used = BTreeSet::new();
    for line in text.lines().filter(|l| !l.trim_start().starts_with("//")) {
        for (at, _) in line.match_indices("crate::") {
            if line[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == '$') {
                continue;
            }
            let rest = &line[at + "crate::".len()..];
            let names = rest.strip_prefix('{').map_or(rest, |list| list.split('}').next().unwrap());
            let many = rest.starts_with('{');
            for part in names.split(',') {
                let name: String = part.trim().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
                used.insert(name);
                if !many {
                    break;
                }
            }
        }
    }
    used
}

/// Uses that point the wrong way, as `file: module`.
fn wrong_way(file: &str, text: &str) -> Vec<String> {
    // Tests may use what they like: they stand outside.
    let text = text.split("#[cfg(test)]").next().unwrap();
    let module = file.strip_prefix("src/").unwrap().split(['/', '.']).next().unwrap();
    let Some(own) = layer(module) else { return Vec::new() };
    let backwards = |used: &String| layer(used).is_some_and(|theirs| theirs > own);
    used_modules(text).into_iter().filter(backwards).map(|used| format!("{file} uses crate::{used}")).collect()
}

#[test]
fn modules_use_only_what_comes_before_them() {
    let mut wrong = Vec::new();
    for (file, text) in sources("src", &["rs"]) {
        let module = file.strip_prefix("src/").unwrap().split(['/', '.']).next().unwrap().to_owned();
        let outside = ["lib", "main", "cli"].contains(&module.as_str());
        assert!(outside || layer(&module).is_some(), "{file}: give `{module}` a place in LAYERS");
        wrong.extend(wrong_way(&file, &text));
        // The command is a user of the library, and its only one that knows the terminal.
        assert!(outside || !text.contains("clap::") && !text.contains("indicatif::"), "{file} knows the command line");
        assert!(
            file.starts_with("src/device/opencl/") || file == "src/device/queries.rs" || !text.contains("opencl3::"),
            "{file} calls OpenCL"
        );
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    // The check can fail.
    assert_eq!(wrong_way("src/scene/import/load.rs", "use crate::render::renderer::Renderer;").len(), 1);
    assert_eq!(wrong_way("src/scene/import/load.rs", "use crate::{error, device::twin};").len(), 1);
    assert!(wrong_way("src/render/renderer.rs", "use crate::scene::Scene;").is_empty());
}

/// The module of a source file, to its second level: `src/device/twin/pack.rs` is `device::twin`.
fn second_level(file: &str) -> String {
    let path = file.strip_prefix("src/").unwrap().strip_suffix(".rs").unwrap();
    let parts: Vec<&str> = path.split('/').filter(|part| *part != "mod").collect();
    parts[..parts.len().min(2)].join("::")
}

/// What a file uses of the library, to the second level where `known` has such a module: by `crate::a::b`,
/// `crate::a::{b, c}` and, in a file of a folder of the first level, `super::b`.
fn used_second_level(file: &str, text: &str, known: &BTreeSet<String>) -> BTreeSet<String> {
    let own = second_level(file);
    let text = text.split("#[cfg(test)]").next().unwrap();
    let code: String = text.lines().filter(|l| !l.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n");
    let name = |text: &str| text.trim().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>();
    let mut used: BTreeSet<String> = used_modules(text).into_iter().filter(|module| known.contains(module)).collect();
    let mut take = |first: &str, rest: &str| {
        let list = rest.strip_prefix('{').map(|list| list.split('}').next().unwrap());
        for part in list.unwrap_or(rest).split(if list.is_some() { ',' } else { '\0' }) {
            used.insert(format!("{first}::{}", name(part)));
        }
    };
    for (at, _) in code.match_indices("crate::") {
        let rest = &code[at + "crate::".len()..];
        if let Some((first, rest)) = rest.split_once("::").filter(|(first, _)| name(first) == *first) {
            take(first, rest);
        }
    }
    if let (Some((first, _)), 2) = (own.split_once("::"), file.matches('/').count()) {
        for (at, _) in code.match_indices("super::") {
            take(first, &code[at + "super::".len()..]);
        }
    }
    used.into_iter().filter(|module| known.contains(module) && *module != own).collect()
}

type Graph = BTreeMap<String, BTreeSet<String>>;

/// The longest chain of uses from `module` on, itself included; an error if it comes back to a module of `way`.
fn longest_chain(graph: &Graph, module: &str, way: &mut Vec<String>) -> Result<Vec<String>, String> {
    if way.iter().any(|before| before == module) {
        return Err(format!("{} -> {module}", way.join(" -> ")));
    }
    way.push(module.to_owned());
    let mut longest = Vec::new();
    for used in graph.get(module).into_iter().flatten() {
        let chain = longest_chain(graph, used, way)?;
        longest = if chain.len() > longest.len() { chain } else { longest };
    }
    way.pop();
    longest.insert(0, module.to_owned());
    Ok(longest)
}

fn longest_of_all(graph: &Graph) -> Result<Vec<String>, String> {
    let chains: Result<Vec<_>, _> = graph.keys().map(|module| longest_chain(graph, module, &mut Vec::new())).collect();
    Ok(chains?.into_iter().max_by_key(Vec::len).unwrap())
}

#[test]
fn no_module_uses_itself_by_way_of_others_and_chains_are_short() {
    let files: Vec<_> = sources("src", &["rs"])
        .into_iter()
        .filter(|(file, _)| !file.starts_with("src/cli/") && !["src/lib.rs", "src/main.rs"].contains(&file.as_str()))
        .collect();
    let known: BTreeSet<String> = files.iter().map(|(file, _)| second_level(file)).collect();
    let (mut modules, mut folders) = (Graph::new(), Graph::new());
    for (file, text) in &files {
        let (own, used) = (second_level(file), used_second_level(file, text, &known));
        let top = |module: &str| module.split("::").next().unwrap().to_owned();
        let tops = used.iter().map(|module| top(module)).filter(|used| *used != top(&own));
        folders.entry(top(&own)).or_default().extend(tops);
        modules.entry(own).or_default().extend(used);
    }
    let chain = longest_of_all(&folders).unwrap();
    println!("{} top-level modules: {}", chain.len(), chain.join(" -> "));
    assert!(chain.len() <= 11, "{chain:?}");
    let chain = longest_of_all(&modules).unwrap();
    println!("{} modules: {}", chain.len(), chain.join(" -> "));
    assert!(chain.len() <= 13, "{chain:?}");
    // Addresses and sizes are the layout's: only executors know the twin, what compares with it or repeats it lane by lane, and
    // the wave model, which traces pixels again to learn what each loop cost.
    let users = modules.iter().filter(|(_, used)| used.contains("device::twin")).map(|(module, _)| module.as_str());
    let allowed = ["analysis::wave_model", "device::cpu", "render::renderer", "selftest::full", "selftest::quick"];
    assert_eq!(users.filter(|user| !allowed.contains(user)).collect::<Vec<_>>(), [""; 0], "use the twin");
    // The checks can fail.
    let circle = Graph::from([("a".into(), ["b".to_owned()].into()), ("b".into(), ["a".to_owned()].into())]);
    assert_eq!(longest_of_all(&circle).unwrap_err(), "a -> b -> a");
    let known = ["device::twin", "device::opencl", "error"].map(String::from).into();
    let text = "use crate::device::{twin, other};\nuse crate::error::Error;\nuse super::opencl::X;";
    assert_eq!(used_second_level("src/device/launch.rs", text, &known), known);
}

/// Options of the command that a text words.
fn worded_options(text: &str) -> Vec<&str> {
    let starts = text.match_indices("--").map(|(at, _)| &text[at..]);
    let option = |rest: &'_ str| rest[2..].starts_with(|c: char| c.is_ascii_lowercase());
    starts.filter(|rest| option(rest)).map(|rest| rest.split_whitespace().next().unwrap()).collect()
}

#[test]
fn the_library_words_no_option_of_the_command() {
    for (file, text) in sources("src", &["rs"]) {
        if !file.starts_with("src/cli/") {
            assert_eq!(worded_options(&text), [""; 0], "{file}: name the setting; src/cli/errors.rs knows its option");
        }
    }
    // The check can fail.
    assert_eq!(worded_options("choose a smaller --size -- or -cl-std, x--"), ["--size"]);
}

/// `NAME` and the like; file names in capitals, such as `README.md`, lie outside the folders that are looked for.
fn is_placeholder(word: &str) -> bool {
    !word.is_empty() && word.chars().all(|c| c.is_ascii_uppercase())
}

/// Words of a document that look like paths within the repository.
fn named_paths(text: &str) -> Vec<String> {
    let tops = ["src/", "kernels/", "android/", "host-tests/", "scenes/", ".ci/", "docs/"];
    let separators = |c: char| c.is_whitespace() || "`()[]|,;\"<>".contains(c);
    let words = text.split(separators).map(|w| w.trim_end_matches(['.', ':', ')']).trim_start_matches("./"));
    words
        .filter(|w| tops.iter().any(|t| w.starts_with(t)))
        // Patterns and place-holders (`*`, `NAME`) are not paths.
        .filter(|w| !w.contains(['*', '{', '$', '=']) && !w.split(['/', '-', '.']).any(is_placeholder))
        .map(|w| w.split(['#', ':']).next().unwrap().trim_end_matches('/').to_owned())
        .filter(|w| !w.is_empty())
        .collect()
}

#[test]
fn every_path_that_the_documents_name_exists() {
    let always =
        ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md", "kernels/README.md", "scenes/README.md"];
    let folder = sources("docs", &["md"]).into_iter().map(|(document, _)| document);
    for document in always.into_iter().map(String::from).chain(folder) {
        let text =
            std::fs::read_to_string(root().join(&document)).unwrap_or_else(|error| panic!("{document}: {error}"));
        for path in named_paths(&text) {
            assert!(root().join(&path).exists(), "{document} names {path}, which is not there");
        }
    }
    assert_eq!(named_paths("see `src/lib.rs` and kernels/trace.cl."), ["src/lib.rs", "kernels/trace.cl"]);
}

#[test]
fn every_source_file_has_its_licence_and_stays_small() {
    const LICENCE: &str = "SPDX-License-Identifier: MIT OR Apache-2.0";
    let all = ["src", "kernels", "host-tests", "android"]
        .map(|f| sources(f, &["rs", "cl", "clh", "h", "toml", "sh", "java"]));
    let mut count = 0;
    for (file, text) in all.concat().iter().filter(|(file, _)| !file.contains("/target/")) {
        let head: Vec<&str> = text.lines().take(2).collect();
        assert!(head.iter().any(|line| line.contains(LICENCE)), "{file} does not begin with `{LICENCE}`");
        let lines = text.lines().count();
        let bounded = file.starts_with("src/") || file.starts_with("kernels/");
        assert!(!bounded || lines <= 600, "{file} has {lines} lines; 600 is the most");
        count += 1;
    }
    assert!(count > 80, "only {count} files were looked at");
}
