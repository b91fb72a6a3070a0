// SPDX-License-Identifier: MIT OR Apache-2.0
//! `rarefy doctor`.

use std::path::Path;

use rarefy::internal::scene::doctor::{Severity, examine};
use rarefy::{Error, PreparedScene, Result};
use serde::Serialize;

use super::args::DoctorArgs;
use super::interrupt::Interrupt;
use super::output::{say, write_json};
use super::outputs::Outputs;
use super::progress::load_scene;

#[derive(Serialize)]
struct DoctorReport<'a> {
    scene: &'a str,
    triangles: usize,
    findings: Vec<FindingReport<'a>>,
}

#[derive(Serialize)]
struct FindingReport<'a> {
    severity: &'static str,
    topic: &'a str,
    message: &'a str,
}

fn word(severity: Severity) -> &'static str {
    if severity == Severity::Warning { "warning" } else { "note" }
}

/// Prints what is odd about a scene.
pub fn run(args: &DoctorArgs, interrupt: &Interrupt) -> Result<()> {
    let mut outputs = Outputs::of_scene(&args.scene, Path::new(""));
    outputs.json(args.json.as_deref())?;
    if PreparedScene::is_baked_file(&args.scene) {
        let message =
            "this is a baked scene, in which nothing odd can be seen any more; examine what it was baked from";
        return Err(Error::scene(args.scene.display().to_string(), message));
    }
    let scene = load_scene(&args.scene, &outputs, interrupt)?;
    let findings = examine(&scene);
    let json = args.json.as_deref();
    let summary = format!(
        "{}: {} triangles, {} objects, {} materials, {} textures, {} lights, extent {}",
        scene.name(),
        scene.triangles().len(),
        scene.objects().len(),
        scene.materials().len(),
        scene.textures().len(),
        scene.view().lights.len(),
        scene.view().extent
    );
    say(json, &summary);
    for finding in &findings {
        say(json, &format!("  {}: {}: {}", word(finding.severity), finding.topic, finding.message));
    }
    if findings.is_empty() {
        say(json, "  nothing odd");
    }
    match json {
        Some(path) => {
            let findings = findings.iter().map(|f| FindingReport {
                severity: word(f.severity),
                topic: f.topic,
                message: &f.message,
            });
            let report =
                DoctorReport { scene: scene.name(), triangles: scene.triangles().len(), findings: findings.collect() };
            write_json(path, &report)
        }
        None => Ok(()),
    }
}
