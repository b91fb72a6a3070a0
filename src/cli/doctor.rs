// SPDX-License-Identifier: MIT OR Apache-2.0
//! `rarefy doctor`.

use std::path::Path;

use rarefy::internal::scene::doctor::{Severity, examine};
use rarefy::{PreparedScene, Result};
use serde::Serialize;

use super::args::DoctorArgs;
use super::interrupt::Interrupt;
use super::output::{say, write_json};
use super::outputs::Outputs;
use super::progress::{load_baked, load_scene};

#[derive(Serialize)]
struct DoctorReport<'a> {
    scene: &'a str,
    triangles: usize,
    /// Version of the format of a baked scene.
    #[serde(skip_serializing_if = "Option::is_none")]
    baked_version: Option<u32>,
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
        return tell_baked(args, &load_baked(&args.scene, interrupt)?);
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
            let report = DoctorReport {
                scene: scene.name(),
                triangles: scene.triangles().len(),
                baked_version: None,
                findings: findings.collect(),
            };
            write_json(path, &report)
        }
        None => Ok(()),
    }
}

/// Prints what a baked scene has. It was validated when it was read; what was odd about its model is not in it.
fn tell_baked(args: &DoctorArgs, scene: &PreparedScene) -> Result<()> {
    let json = args.json.as_deref();
    let summary = format!(
        "{}: baked, version {} of the format, {} shading: {} triangles, {} objects, {} materials, {} textures, {} lights, extent {}",
        scene.name(),
        PreparedScene::BAKED_VERSION,
        scene.shading(),
        scene.triangle_count(),
        scene.object_names().len(),
        scene.material_count(),
        scene.texture_count(),
        scene.view().lights.len(),
        scene.view().extent
    );
    say(json, &summary);
    let finding = FindingReport {
        severity: word(Severity::Note),
        topic: "baked",
        message: "the file is whole; what is odd about a model shows only in what it was baked from",
    };
    say(json, &format!("  {}: {}: {}", finding.severity, finding.topic, finding.message));
    let (triangles, baked_version) = (scene.triangle_count(), Some(PreparedScene::BAKED_VERSION));
    let report = DoctorReport { scene: scene.name(), triangles, baked_version, findings: vec![finding] };
    json.map_or(Ok(()), |path| write_json(path, &report))
}
