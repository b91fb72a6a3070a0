// SPDX-License-Identifier: MIT OR Apache-2.0
//! `rarefy bench`: measures all tables of a report, keeps what is done, and writes the report at the end.

mod about;
mod chart;
mod page;

use std::collections::BTreeMap;
use std::path::Path;
use std::time::{Instant, SystemTime};

use rarefy::internal::analysis::report::bench::Report;
use rarefy::internal::analysis::report::figures::Figures;
use rarefy::internal::analysis::report::kept::{Kept, MEASUREMENTS};
use rarefy::internal::analysis::report::measure::{Laboratory, PICTURES};
use rarefy::internal::analysis::report::plan::{Case, Extent, built_in_scenes, cases};
use rarefy::internal::device::open::DeviceOptions;
use rarefy::internal::files;
use rarefy::{Error, Monitor, Result};

use super::args::{BenchArgs, profile};
use super::interrupt::Interrupt;
use super::output::say;
use super::progress::Progress;
use about::duration;

/// The forms of a report.
const FORMS: [&str; 3] = ["report.html", "report.md", "report.json"];

/// Measures and writes the report.
pub fn run(args: &BenchArgs, interrupt: &Interrupt) -> Result<()> {
    let scenes = scenes(args)?;
    let extent = if args.quick { Extent::quick(scenes) } else { Extent::whole(scenes) };
    let extent = match args.size {
        Some(side @ 8..=4096) => extent.with_side(side),
        Some(side) => return Err(Error::argument("--size", format!("{side} pixels; it may be 8 to 4096"))),
        None => extent,
    };
    let folder = &args.output;
    for sub in [PICTURES, MEASUREMENTS] {
        let path = folder.join(sub);
        std::fs::create_dir_all(&path).map_err(|e| Error::io(&path, e))?;
    }
    FORMS.iter().try_for_each(|form| files::check_writable(&folder.join(form)).map(drop))?;
    let (started, begun) = (SystemTime::now(), Instant::now());
    let device = DeviceOptions { device: args.device, profile: profile(&args.profile)?, ..DeviceOptions::default() };
    let report = interrupt.watch(|cancel| {
        let monitor = Monitor::default().with_cancel(cancel);
        let mut laboratory = Laboratory::new(device, &monitor);
        let info = laboratory.info()?;
        let mut about = about::about(&info, options(args, &extent), started);
        let kept = Kept::new(folder, format!("{}; {}; {}", about::program(), info.describe(), info.profile));
        let (found, resumed) = measure_all(&mut laboratory, &cases(&extent), &kept, folder)?;
        about.resumed = match resumed {
            0 => "no: everything was measured in one go".into(),
            count => {
                format!("{count} measurements are of a run with the same program and options that was ended before")
            }
        };
        about.took = duration(begun.elapsed());
        Report::new(about, &extent, found, folder)
    })?;
    for path in write(&report, folder)? {
        say(None, &path);
    }
    // The report has them; a new run measures anew.
    let path = folder.join(MEASUREMENTS);
    std::fs::remove_dir_all(&path).map_err(|e| Error::io(&path, e))?;
    for finding in &report.verdict {
        say(None, &format!("{} This {}.", finding.claim(), finding.answer()));
    }
    Ok(())
}

fn scenes(args: &BenchArgs) -> Result<Vec<String>> {
    if args.scenes.is_empty() {
        return Ok(built_in_scenes());
    }
    let name = |path: &std::path::PathBuf| {
        let name = path.to_str().map(|name| name.trim_end_matches('/').to_owned());
        name.ok_or_else(|| Error::argument(path.display().to_string(), "the name is not valid text; rename the scene"))
    };
    let mut names = args.scenes.iter().map(name).collect::<Result<Vec<_>>>()?;
    let mut seen = std::collections::BTreeSet::new();
    names.retain(|name| seen.insert(name.clone()));
    Ok(names)
}

/// The options of this run in words.
fn options(args: &BenchArgs, extent: &Extent) -> String {
    let what = if args.quick { "quick: small pictures" } else { "whole" };
    format!(
        "{what}; main tables at {0}x{0}, pictures, sweeps and ablation at {1}x{1}, supersampling at {2}x{2}; depth 4; device `{3}`",
        extent.main_side, extent.shown_side, extent.sampled_side, args.device
    )
}

/// Carries out all `cases` that were not kept; also returns how many were.
fn measure_all<'a>(
    laboratory: &mut Laboratory<'a>,
    cases: &[Case<'a>],
    kept: &Kept,
    folder: &Path,
) -> Result<(BTreeMap<String, Figures>, usize)> {
    let mut found: BTreeMap<String, Figures> = BTreeMap::new();
    let mut missing = Vec::new();
    for case in cases {
        match kept.find(case) {
            Some(figures) => drop(found.insert(case.id.clone(), figures)),
            None => missing.push(case),
        }
    }
    let resumed = found.len();
    let all: f64 = missing.iter().map(|case| case.weight()).sum();
    let (bar, begun) = (Progress::new(), Instant::now());
    let mut done = 0.0;
    for (at, case) in missing.iter().enumerate() {
        let remains = match done > 0.0 {
            true => format!(", about {} left", duration(begun.elapsed().mul_f64((all - done) / done))),
            false => String::new(),
        };
        bar.update(&format!("{} of {}{remains}", at + 1, missing.len()), (done / all) as f32);
        let measured = laboratory.measure(case, folder);
        let figures = measured.inspect_err(|_| bar.clear())?;
        kept.keep(case, &figures)?;
        found.insert(case.id.clone(), figures);
        done += case.weight();
    }
    bar.clear();
    Ok((found, resumed))
}

/// Writes all forms of the report; their paths. Nothing is written before all of them are made.
fn write(report: &Report, folder: &Path) -> Result<Vec<String>> {
    let json = serde_json::to_string_pretty(report).map_err(|e| Error::argument("the report", e.to_string()))?;
    let mut texts = Vec::new();
    for chart in report.sections.iter().flat_map(|section| &section.charts) {
        texts.push((format!("{PICTURES}/chart-{}.svg", chart.id), chart::svg(chart)?));
    }
    let forms = [page::html(report, folder)?, page::markdown(report)?, json + "\n"];
    texts.extend(FORMS.map(String::from).into_iter().zip(forms));
    let mut paths = Vec::new();
    for (name, text) in texts {
        let path = folder.join(name);
        files::write_whole(&path, text.as_bytes())?;
        paths.push(path.display().to_string());
    }
    Ok(paths)
}
