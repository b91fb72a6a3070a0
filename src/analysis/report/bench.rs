// SPDX-License-Identifier: MIT OR Apache-2.0
//! A whole report: about the run, its verdict, its parts, and the figures that all of it is made of.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;

use super::close_up::close_up;
use super::figures::Figures;
use super::plan::{Extent, SIX};
use super::published;
use super::sections::{self, Data, Group, Section};
use super::verdict::{self, Finding};
use crate::error::{Error, Result};

/// What was run, when and on what.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
pub struct About {
    /// Version of the program.
    pub version: String,
    /// Commit of the checkout that it was built from, and whether that was changed.
    pub commit: String,
    /// When the run began, in UTC.
    pub started: String,
    /// How long it took.
    pub took: String,
    /// Processor, its cores and the system.
    pub machine: String,
    /// Device that drew.
    pub device: String,
    /// Version of the device and its driver.
    pub driver: String,
    /// OpenCL or CPU, and the device profile.
    pub backend: String,
    /// The options of the command.
    pub options: String,
    /// How often frames were timed.
    pub repeats: String,
    /// How far times of one kind lay apart.
    pub spread: String,
    /// Which scene stands for which of the paper's.
    pub scenes: String,
    /// How many measurements were kept from a run that was ended before.
    pub resumed: String,
}

/// A report. Its JSON form is this very value.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Report {
    /// The run.
    pub about: About,
    /// Where the paper's figures come from.
    pub published: &'static str,
    /// Whether the paper's results hold.
    pub verdict: Vec<Finding>,
    /// The parts.
    pub sections: Vec<Section>,
    /// All figures, by the ids of the plan.
    pub measurements: BTreeMap<String, Figures>,
}

impl Report {
    /// Makes the report of what was `found`; close-ups are cut from pictures in `folder`, and written there.
    ///
    /// # Errors
    /// Pictures that cannot be read or written; [`Error::InvalidArgument`] with all that is missing.
    pub fn new(about: About, extent: &Extent, found: BTreeMap<String, Figures>, folder: &Path) -> Result<Self> {
        let mut close_ups = Vec::new();
        for scene in &extent.scenes {
            let of = |method: &str| found.get(&format!("shown/{method}/{scene}"));
            if let (Some(off), Some(on)) = (of("off"), of("balanced")) {
                close_ups.extend(close_up(folder, scene, off, on)?);
            }
        }
        let report = Report::from_figures(about, extent, found, &close_ups);
        match report.problems() {
            problems if problems.is_empty() => Ok(report),
            problems => Err(Error::argument("the report", problems.join("; "))),
        }
    }

    fn from_figures(mut about: About, extent: &Extent, found: BTreeMap<String, Figures>, close_ups: &[Group]) -> Self {
        about.repeats = repeats(&found);
        about.spread = spread(&found);
        about.scenes = stand_ins(extent);
        let data = Data { extent, found: &found, close_ups };
        let (verdict, sections) = (verdict::judge(&data), sections::all(&data));
        Report { about, published: published::SOURCE, verdict, sections, measurements: found }
    }

    /// What is missing, one sentence each: rows, figures, pictures, findings.
    pub fn problems(&self) -> Vec<String> {
        let findings = self.verdict.iter().filter(|finding| finding.holds().is_none());
        let findings = findings.map(|finding| format!("`{}` was not measured", finding.claim()));
        self.sections.iter().flat_map(Section::problems).chain(findings).collect()
    }
}

/// How often frames were timed.
fn repeats(found: &BTreeMap<String, Figures>) -> String {
    let counts: Vec<u32> = found.values().filter_map(|f| f.times.as_ref()).map(|times| times.repeats).collect();
    let (least, most) = (counts.iter().min().copied().unwrap_or(0), counts.iter().max().copied().unwrap_or(0));
    let range = if least == most { format!("{most}") } else { format!("{least} to {most}") };
    format!("{range} frames of each kind, full and adaptive in turn; medians are shown")
}

/// How far times of one kind lay apart, over all measurements.
fn spread(found: &BTreeMap<String, Figures>) -> String {
    let times = || found.values().filter_map(|f| f.times.as_ref()).filter(|times| times.repeats > 1);
    let of = |values: Vec<f64>| 100.0 * crate::analysis::compare::rounds::median(&values);
    let frames = of(times().flat_map(|t| [t.full_ms.relative(), t.adaptive_ms.relative()]).collect());
    let speedups = of(times().map(|t| t.speedup.relative()).collect());
    format!(
        "in the middle of all measurements \u{b1}{frames:.1} % for frame times and \u{b1}{speedups:.1} % for speedups"
    )
}

/// Which scene stands for which of the paper's.
fn stand_ins(extent: &Extent) -> String {
    let stands = |scene: &String| {
        let paper = SIX.iter().find(|(name, _)| name == scene);
        paper.map_or(scene.clone(), |(_, paper)| format!("{scene} (for the paper\u{2019}s {paper})"))
    };
    extent.scenes.iter().map(stands).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::report::plan::{Shown, cases};
    use crate::analysis::report::table::Picture;
    use crate::analysis::report::testing::figures;
    use crate::method::options::Test;

    /// A complete run of two scenes, made up.
    fn made_up() -> (Extent, BTreeMap<String, Figures>, Vec<Group>) {
        let extent = Extent::quick(vec!["cafe".into(), "../hall".into()]);
        let picture = |kind: &str| Picture {
            file: format!("pictures/x-{kind}.png"),
            width: 1,
            height: 1,
            alt: "a".into(),
            caption: "b".into(),
        };
        let mut found = BTreeMap::new();
        for (at, case) in cases(&extent).into_iter().enumerate() {
            let mut f = figures(at as u32);
            if case.shown != Shown::Nothing {
                let kinds = ["full", "adaptive", "difference", "class", "fail-mask"];
                f.pictures = kinds.into_iter().chain(Test::ALL.map(Test::name)).map(picture).collect();
            }
            found.insert(case.id, f);
        }
        let group = |scene: &String| Group { title: scene.clone(), pictures: vec![picture("before")] };
        let close_ups = extent.scenes.iter().map(group).collect();
        (extent, found, close_ups)
    }

    #[test]
    fn a_complete_run_makes_a_complete_report() {
        let (extent, found, close_ups) = made_up();
        let report = Report::from_figures(About::default(), &extent, found, &close_ups);
        assert_eq!(report.problems(), [""; 0]);
        assert_eq!(report.sections.len(), 16);
        let tables: usize = report.sections.iter().map(|s| s.tables.len() + s.published.len()).sum();
        assert!(tables > 25, "{tables}");
        assert!(report.about.scenes.contains("cafe (for the paper\u{2019}s Cafe), ../hall"), "{}", report.about.scenes);
        assert!(
            !serde_json::to_string(&report).unwrap_or_default().contains("null"),
            "a figure is missing in the JSON"
        );
    }

    #[test]
    fn any_missing_figure_is_a_problem() {
        let (extent, found, close_ups) = made_up();
        let ids: Vec<String> = found.keys().cloned().collect();
        for id in ids {
            let mut fewer = found.clone();
            fewer.remove(&id);
            // Close-ups are cut from these, before.
            let close_ups = if id.starts_with("shown/off/") { &close_ups[..1] } else { &close_ups };
            let report = Report::from_figures(About::default(), &extent, fewer, close_ups);
            assert!(!report.problems().is_empty(), "nobody misses {id}");
        }
        let report = Report::from_figures(About::default(), &extent, found.clone(), &close_ups[..1]);
        assert_eq!(report.problems(), ["close-ups: the close-up of ../hall is missing"]);
        // Frames that nobody timed, and a number that is none.
        for change in [
            (|f: &mut Figures| f.times = None) as fn(&mut Figures),
            |f| f.traced = f64::NAN,
            |f| f.work_by_class = [0; 3],
            |f| f.pictures.clear(),
        ] {
            let mut broken = found.clone();
            for id in ["presets/balanced/cafe", "shown/balanced/cafe"] {
                broken.entry(id.into()).and_modify(change);
            }
            let report = Report::from_figures(About::default(), &extent, broken, &close_ups);
            assert!(!report.problems().is_empty());
        }
    }
}
