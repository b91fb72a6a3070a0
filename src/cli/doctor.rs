// SPDX-License-Identifier: MIT OR Apache-2.0
//! `rarefy doctor`.

use std::path::Path;

use rarefy::Result;
use rarefy::scene::doctor::{Severity, examine};
use serde_json::json;

use super::args::DoctorArgs;
use super::interrupt::Interrupt;
use super::output::{say, write_json};
use super::outputs::Outputs;
use super::progress::load_scene;

/// Prints what is odd about a scene.
pub fn run(args: &DoctorArgs, interrupt: &Interrupt) -> Result<()> {
    Outputs::of_scene(&args.scene, Path::new("")).json(args.json.as_deref())?;
    let scene = load_scene(&args.scene, interrupt)?;
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
        let severity = if finding.severity == Severity::Warning { "warning" } else { "note" };
        say(json, &format!("  {severity}: {}: {}", finding.topic, finding.message));
    }
    if findings.is_empty() {
        say(json, "  nothing odd");
    }
    match json {
        Some(path) => {
            let findings: Vec<_> = findings
                .iter()
                .map(|f| {
                    let warning = f.severity == Severity::Warning;
                    json!({"severity": if warning { "warning" } else { "note" }, "topic": f.topic, "message": f.message})
                })
                .collect();
            write_json(
                path,
                &json!({"scene": scene.name(), "triangles": scene.triangles().len(), "findings": findings}),
            )
        }
        None => Ok(()),
    }
}
