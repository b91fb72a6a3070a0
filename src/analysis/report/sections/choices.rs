// SPDX-License-Identifier: MIT OR Apache-2.0
//! What each choice of the method costs and gains. The paper has no such tables.

use super::{Data, Section, mean_cells, method_columns, speed_cells, speed_columns};
use crate::analysis::report::plan::{self, FACTORS, ablations, corrections};
use crate::analysis::report::published;
use crate::analysis::report::table::{Cell, Chart, ChartKind, Series, Table};

/// How means are taken, for the reader.
const MEANS: &str = "Means over the scenes: geometric for shares and work, arithmetic for the others.";

pub(super) fn correction(data: &Data) -> Section {
    let side = data.extent.main_side;
    let mut section = Section::new(
        "correction",
        "One round of correction against converged",
        &[
            "“One round” walks rows and columns once each way, as the paper’s post-correction does; “converged” goes on until \
             nothing changes. Both compare objects, shadows, normals and reflected light here.",
            MEANS,
        ],
    );
    let labels = corrections().map(|(name, _)| name.to_owned());
    let title = format!("This run: corrections, means at {side}x{side}");
    section.tables.push(Table::fill(title, "correction", method_columns(), &labels, |at| {
        Some(mean_cells(&data.of_all_scenes(&format!("correction/{}", labels[at]))?))
    }));
    section
}

pub(super) fn ablation(data: &Data) -> Section {
    let side = data.extent.shown_side;
    let mut section = Section::new("ablation", "Each test switched off", &["What every test is worth.", MEANS]);
    let methods = ablations();
    let mut labels = vec!["all tests".to_owned()];
    labels.extend(methods.iter().map(|(name, _)| format!("without {}", name.to_uppercase())));
    let title = format!("This run: ablation, means at {side}x{side}");
    section.tables.push(Table::fill(title, "tests", method_columns(), &labels, |at| {
        let group = match at {
            0 => "shown/balanced".to_owned(),
            at => format!("ablation/{}", methods[at - 1].0),
        };
        Some(mean_cells(&data.of_all_scenes(&group)?))
    }));
    section
}

pub(super) fn presets(data: &Data) -> Section {
    let side = data.extent.main_side;
    let mut section = Section::new(
        "presets",
        "Presets side by side",
        &[
            "“balanced” is the default, “fast” begins with blocks of 4, “paper” follows the paper’s rules and tolerances.",
            MEANS,
        ],
    );
    let names = plan::presets().map(|(name, _)| name.to_owned());
    let title = format!("This run: presets, means at {side}x{side}");
    section.tables.push(Table::fill(title, "preset", method_columns(), &names, |at| {
        Some(mean_cells(&data.of_all_scenes(&format!("presets/{}", names[at]))?))
    }));
    let title = format!("This run: the paper\u{2019}s rules on our scenes at {side}x{side}");
    section.tables.push(data.by_scene(&title, "presets/paper", speed_columns(), speed_cells));
    section.published.push(published::speeds("Paper: 1024x1024, blocks of 2, correction on", &published::ONE_SAMPLE));
    section
}

pub(super) fn blocks(data: &Data) -> Section {
    let side = data.extent.main_side;
    let mut section = Section::new(
        "blocks",
        "Blocks of 2 against blocks of 4",
        &["With blocks of 4 a sixteenth of the pixels are base ones. The paper has blocks of 2 only."],
    );
    for (blocks, preset) in [(2, "balanced"), (4, "fast")] {
        let title = format!("This run: blocks of {blocks} at {side}x{side}");
        section.tables.push(data.by_scene(&title, &format!("presets/{preset}"), speed_columns(), speed_cells));
    }
    section
}

pub(super) fn quality(data: &Data) -> Section {
    let side = data.extent.shown_side;
    let mut section = Section::new(
        "quality",
        "Quality against traced pixels",
        &["All tolerances of a preset scaled by a factor: above 1 they are looser, below 1 stricter.", MEANS],
    );
    let methods: Vec<(&str, f32)> =
        plan::presets().iter().flat_map(|(name, _)| FACTORS.map(|factor| (*name, factor))).collect();
    let labels: Vec<String> = methods.iter().map(|(name, factor)| format!("{name} x {factor}")).collect();
    let group = |at: usize| format!("quality/{}/{}", methods[at].0, methods[at].1);
    let title = format!("This run: scaled tolerances, means at {side}x{side}");
    section.tables.push(Table::fill(title, "tolerances", method_columns(), &labels, |at| {
        Some(mean_cells(&data.of_all_scenes(&group(at))?))
    }));
    let row = |at: usize| match section.tables[0].rows[at].cells.as_slice() {
        [_, Cell::Number(traced), Cell::Number(psnr), ..] => (100.0 * traced, *psnr),
        _ => (f64::NAN, f64::NAN),
    };
    let series = plan::presets().into_iter().enumerate().map(|(preset, (name, _))| Series {
        name: name.to_owned(),
        // Equal pictures have no decibels to show.
        points: (0..FACTORS.len())
            .map(|factor| preset * FACTORS.len() + factor)
            .filter(|&at| section.tables[0].rows[at].cells[2] != Cell::Words("equal"))
            .map(row)
            .collect(),
    });
    let chart = Chart {
        id: "quality".into(),
        title: "PSNR by traced pixels".into(),
        kind: ChartKind::Lines,
        x_title: "traced with correction %".into(),
        y_title: "PSNR dB".into(),
        categories: Vec::new(),
        series: series.collect(),
    };
    section.charts.push(chart);
    section
}
