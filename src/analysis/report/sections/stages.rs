// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where the adaptive frame's time goes, as measured and as waves in lock step would pay it.

use super::{Data, Section};
use crate::analysis::report::figures::{Figures, WaveCosts, Waves, stage_names};
use crate::analysis::report::published;
use crate::analysis::report::table::{Cell, Chart, ChartKind, Column, Series, Unit};
use crate::device::stage::Stage;

/// Which size of waves the table shows: 64 lanes.
const WAVE: usize = 1;

/// One of the two sums of the wave model.
type WhichSum = fn(&Waves) -> &WaveCosts;

/// The two sums of the wave model.
const LOCK_STEPS: [(&str, WhichSum); 2] =
    [("lock step by loop", |waves| &waves.by_loop), ("lock step by item", |waves| &waves.by_item)];

pub(super) fn dissection(data: &Data) -> Section {
    let (main, shown) = (data.extent.main_side, data.extent.shown_side);
    let mut section = Section::new(
        "stages",
        "Stages of an adaptive frame",
        &[
            "step1, step2c and step3c trace rays, step2a and step3a check and interpolate, step2b and step3b pack, step4 \
             corrects; other is launches, transfers and what the host does. The paper’s names are I, II-c, III-c and so on.",
            "The wave model adds up what a GPU’s waves of 64 lanes in lock step would pay, in millions of traversal steps, \
             launches included. Lanes of a wave wait for each other after every loop through the tree; the second of its \
             tables is what would be paid if they waited only at the end of their ray trees.",
        ],
    );
    let names = stage_names();
    let columns = names.map(|name| Column::new(format!("{name} ms"), Unit::Milliseconds)).to_vec();
    section.tables.push(data.by_scene(
        &format!("This run: time of each stage at {main}x{main}"),
        "presets/balanced",
        columns,
        |f| Some(f.times.as_ref()?.stages_ms.map(Cell::Number).to_vec()),
    ));
    for (name, costs) in LOCK_STEPS {
        let mut columns = vec![Column::new("full", Unit::Times)];
        columns.extend(Stage::ALL.map(|stage| Column::new(stage.name(), Unit::Times)));
        columns.push(Column::new("modelled speedup", Unit::Times));
        section.tables.push(data.by_scene(
            &format!("This run: wave model at {shown}x{shown}, {name}, waves of 64, million steps"),
            "shown/balanced",
            columns,
            |f| {
                let waves = costs(f.waves.as_ref()?);
                let stages = waves.stages.iter().map(|cost| cost[WAVE].into());
                Some([waves.full[WAVE].into()].into_iter().chain(stages).chain([waves.speedup[WAVE].into()]).collect())
            },
        ));
    }
    section.published.push(published::kernels());
    section.charts.push(bars(data, "stages-time", "Share of the adaptive frame’s time", &names, |scene| {
        let times = data.get(&format!("presets/balanced/{scene}"))?.times.as_ref()?;
        Some(times.stages_ms.to_vec())
    }));
    section.charts.push(bars(data, "stages-waves", "Share of the modelled cost, waves of 64", &names[..8], |scene| {
        let figures: &Figures = data.get(&format!("shown/balanced/{scene}"))?;
        Some(figures.waves.as_ref()?.by_loop.stages.iter().map(|cost| cost[WAVE]).collect())
    }));
    section
}

/// Bars of shares, one for each scene.
fn bars(data: &Data, id: &str, title: &str, names: &[&str], costs: impl Fn(&String) -> Option<Vec<f64>>) -> Chart {
    let shares: Vec<Vec<f64>> = data
        .scenes()
        .iter()
        .map(|scene| {
            let costs = costs(scene).unwrap_or_else(|| vec![f64::NAN; names.len()]);
            let sum: f64 = costs.iter().sum();
            costs.iter().map(|cost| 100.0 * cost / sum).collect()
        })
        .collect();
    let series = names.iter().enumerate().map(|(at, name)| Series {
        name: (*name).to_owned(),
        points: shares.iter().enumerate().map(|(scene, shares)| (scene as f64, shares[at])).collect(),
    });
    Chart {
        id: id.into(),
        title: title.into(),
        kind: ChartKind::StackedBars,
        x_title: "scene".into(),
        y_title: "%".into(),
        categories: data.scenes().to_vec(),
        series: series.collect(),
    }
}
