// SPDX-License-Identifier: MIT OR Apache-2.0
//! `rarefy bench`: is a report whole, does it load nothing, does a run that was ended go on, and is a cancelled one clean?
//! (What the tables and the verdict demand of their figures is tested beside them.)
#![allow(clippy::unwrap_used, missing_docs)]

use std::path::Path;

use rarefy_host_tests::command::{executable, rarefy_in};
use serde_json::Value;

const TINY: [&str; 9] = ["bench", "spheres", "--quick", "--size", "24", "--device", "cpu", "-o", "report"];

fn report(folder: &Path) -> (String, Value, String) {
    let read = |name: &str| std::fs::read_to_string(folder.join("report").join(name)).unwrap();
    (read("report.html"), serde_json::from_str(&read("report.json")).unwrap(), read("report.md"))
}

/// Addresses that a page would load: all that is not within it.
fn loads(page: &str) -> Vec<String> {
    let mut found = Vec::new();
    for (attribute, allowed) in [
        ("src=\"", &["data:image/png;base64,"][..]),
        ("srcset=\"", &[]),
        ("href=\"", &["#"]),
        ("xlink:href=\"", &["#"]),
        ("action=\"", &[]),
        ("poster=\"", &[]),
        ("url(", &[]),
        ("@import", &[]),
        ("fetch(", &[]),
        ("import(", &[]),
        ("XMLHttpRequest", &[]),
    ] {
        for (at, _) in page.match_indices(attribute) {
            let rest = &page[at + attribute.len()..];
            if !allowed.iter().any(|start| rest.starts_with(start)) {
                found.push(format!("{attribute}{}", rest.chars().take(40).collect::<String>()));
            }
        }
    }
    found
}

/// Every number of a JSON value that is `null`.
fn nulls(value: &Value, path: &str, found: &mut Vec<String>) {
    match value {
        Value::Null => found.push(path.to_owned()),
        Value::Array(items) => items.iter().enumerate().for_each(|(at, v)| nulls(v, &format!("{path}/{at}"), found)),
        Value::Object(map) => map.iter().for_each(|(key, v)| nulls(v, &format!("{path}/{key}"), found)),
        _ => {}
    }
}

#[test]
fn a_tiny_run_makes_a_whole_report_that_loads_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let run = rarefy_in(folder.path(), &TINY, &[]).expect(0);
    for form in ["report.html", "report.md", "report.json", "This "] {
        assert!(run.stdout.contains(form), "{}", run.stdout);
    }
    let (page, json, markdown) = report(folder.path());
    // No table lacks a figure, in any form. Measurements may: equal pictures have no decibels.
    let mut missing = Vec::new();
    for part in ["about", "verdict", "sections"] {
        nulls(&json[part], part, &mut missing);
    }
    assert_eq!(missing, [""; 0]);
    // The bytes of a picture may spell anything.
    let words: String = page.split("base64,").map(|part| part.split_once('"').map_or(part, |(_, rest)| rest)).collect();
    assert!(words.len() > 50_000 && words.contains("<h2"), "{} bytes", words.len());
    for bad in ["missing", "NaN", "undefined"] {
        assert!(!words.contains(bad) && !markdown.contains(bad), "{bad}");
    }
    let sections = json["sections"].as_array().unwrap();
    assert_eq!(sections.len(), 16);
    let (mut tables, mut heads, mut rows) = (1, 0, json["about"].as_object().unwrap().len());
    for section in sections {
        let id = section["id"].as_str().unwrap();
        assert!(page.contains(&format!("<h2 id=\"{id}\">")), "{id}");
        for table in section["tables"].as_array().unwrap().iter().chain(section["published"].as_array().unwrap()) {
            let title = table["title"].as_str().unwrap();
            assert!(!table["rows"].as_array().unwrap().is_empty(), "{title}");
            assert!(markdown.contains(title), "{title}");
            let columns = table["columns"].as_array().unwrap().len();
            tables += 1;
            heads += columns + 1;
            rows += table["rows"].as_array().unwrap().len();
            assert!(table["rows"].as_array().unwrap().iter().all(|r| r["cells"].as_array().unwrap().len() == columns));
        }
    }
    // Tables, their captions and heads; pictures and charts, and what they are for who cannot see them.
    let count = |what: &str| page.matches(what).count();
    assert_eq!(count("<table"), count("<caption>"));
    assert_eq!((count("<table"), count("scope=\"col\""), count("scope=\"row\"")), (tables, heads, rows));
    assert!(tables > 25, "{tables} tables");
    let without_alt = page.match_indices("<img").filter(|(at, _)| {
        let tag = page[*at..].split('>').next().unwrap();
        !tag.contains(" alt=\"") || tag.contains(" alt=\"\"")
    });
    assert_eq!(without_alt.count(), 0);
    assert!(count("<img") > 25 && count("<svg") >= 7 && count("<title>") == count("<svg") + 1);
    assert_eq!(loads(&page), [""; 0]);
    // The paper's figures stand beside ours, with their source.
    assert!(page.contains("s00371-016-1251-y") && page.contains("4,777.8"));
    for part in ["commit", "machine", "driver", "repeats", "spread", "options", "started"] {
        assert!(!json["about"][part].as_str().unwrap().is_empty(), "{part}");
    }
    // The report that the documentation shows has the same parts.
    let parts = |text: &str| text.lines().filter(|line| line.starts_with("## ")).map(String::from).collect::<Vec<_>>();
    let shown = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/report.md")).unwrap();
    assert_eq!(parts(&shown), parts(&markdown), "to renew: rarefy bench -o report && cp report/report.md docs/");
    // Nothing but the report is left.
    let mut left: Vec<_> = folder.path().join("report").read_dir().unwrap().map(|e| e.unwrap().file_name()).collect();
    left.sort();
    assert_eq!(left, ["pictures", "report.html", "report.json", "report.md"]);
    // The checks can fail.
    assert_eq!(loads("<img src=\"https://example.org/a.png\"><a href=\"#x\"><style>url(b.woff)</style>").len(), 2);
    let mut found = Vec::new();
    nulls(&serde_json::json!({"a": [1, null]}), "x", &mut found);
    assert_eq!(found, ["x/a/1"]);
}

#[cfg(unix)]
#[test]
fn a_run_that_was_ended_leaves_no_report_and_is_gone_on_with() {
    use std::process::{Command, Stdio};
    let folder = tempfile::tempdir().unwrap();
    let kept = folder.path().join("report/measurements");
    let count = || kept.read_dir().map_or(0, |entries| entries.count());
    let mut process = Command::new(executable());
    process.args(TINY).current_dir(folder.path()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let process = process.spawn().unwrap();
    while count() < 3 {
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    assert!(Command::new("kill").args(["-INT", &process.id().to_string()]).status().unwrap().success());
    let output = process.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130));
    assert_eq!(String::from_utf8(output.stderr).unwrap(), "rarefy: interrupted\n");
    let done = count();
    assert!(done >= 3 && !folder.path().join("report/report.html").exists());
    assert!(kept.read_dir().unwrap().all(|e| e.unwrap().file_name().to_str().unwrap().ends_with(".json")));

    rarefy_in(folder.path(), &TINY, &[]).expect(0);
    let (.., json, _) = report(folder.path());
    let resumed = json["about"]["resumed"].as_str().unwrap();
    assert!(resumed.starts_with(&format!("{done} measurements")), "{done}: {resumed}");
    assert!(!kept.exists());
}

#[test]
fn what_cannot_be_measured_is_told_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str]| rarefy_in(folder.path(), arguments, &[]);
    run(&["bench"]).expect_error(&["--output"]);
    run(&["bench", "no-such-scene", "--size", "16", "-o", "r"]).expect_error(&["no-such-scene"]);
    run(&["bench", "--size", "4", "-o", "r"]).expect_error(&["--size", "8 to 4096"]);
    std::fs::write(folder.path().join("file"), "").unwrap();
    run(&["bench", "--size", "16", "-o", "file"]).expect_error(&["file"]);
}
