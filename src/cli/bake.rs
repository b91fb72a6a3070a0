// SPDX-License-Identifier: MIT OR Apache-2.0
//! `rarefy bake`.

use std::path::Path;

use rarefy::{Error, Result};

use super::args::BakeArgs;
use super::interrupt::Interrupt;
use super::output::say;
use super::outputs::Outputs;
use super::progress::{Loaded, load_prepared};

/// Prepares a scene and writes it as a baked file.
pub fn run(args: &BakeArgs, interrupt: &Interrupt) -> Result<()> {
    let mut outputs = Outputs::of_scene(&args.scene, Path::new(""));
    outputs.file("-o", &args.output)?;
    let loaded = load_prepared(&args.scene, args.shading, &outputs, interrupt)?;
    loaded.tell();
    let Loaded { prepared, .. } = loaded;
    interrupt.watch(|_| prepared.bake_to(&args.output))?;
    let output = &args.output;
    let bytes = std::fs::metadata(output).map_err(|e| Error::io(output, e))?.len();
    let (triangles, mib) = (prepared.triangle_count(), bytes as f64 / f64::from(1 << 20));
    let line = format!("{}: {triangles} triangles, {mib:.1} MiB, {} shading", output.display(), prepared.shading());
    say(None, &line);
    Ok(())
}
