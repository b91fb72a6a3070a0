// SPDX-License-Identifier: MIT OR Apache-2.0
//! How fast: one sample, supersampling, scaling with pixels and with triangles.

use super::{Data, Section, speed_cells, speed_columns};
use crate::analysis::report::plan::is_scaled;
use crate::analysis::report::published;
use crate::analysis::report::table::{Cell, Chart, ChartKind, Column, Series, Table, Unit};

pub(super) fn one_sample(data: &Data) -> Section {
    let side = data.extent.main_side;
    let mut section = Section::new(
        "one-sample",
        "One sample per pixel, correction on and off",
        &[
            "“Traced” is the share of pixels with a ray before correction, base pixels included, as in the paper. Work is \
             kd-tree nodes visited and triangles tested; it does not depend on how fast the device is. “±” is half the distance of the \
             fastest and the slowest round’s speedup.",
            "The paper’s scenes cannot be had; ours stand in their place and are other scenes.",
        ],
    );
    let title = |what: &str| format!("This run: {side}x{side}, blocks of 2, correction {what}");
    section.tables.push(data.by_scene(&title("on"), "presets/balanced", speed_columns(), speed_cells));
    section.tables.push(data.by_scene(&title("off"), "correction/off", speed_columns(), speed_cells));
    section.published.push(published::speeds("Paper: 1024x1024, blocks of 2, correction on", &published::ONE_SAMPLE));
    section
}

pub(super) fn supersampling(data: &Data) -> Section {
    let side = data.extent.sampled_side;
    let mut section = Section::new(
        "supersampling",
        "Supersampling",
        &[
            "The method works on the grid of samples. All three tables of this run have the same size in pixels, so that only \
           the samples change.",
        ],
    );
    for samples in [1, 2, 4] {
        let title = format!("This run: {side}x{side}, {samples}x{samples} samples per pixel");
        section.tables.push(data.by_scene(&title, &format!("samples/{samples}"), speed_columns(), speed_cells));
    }
    section.published.push(published::speeds("Paper: 1024x1024, 2x2 samples", &published::FOUR_SAMPLES));
    section.published.push(published::speeds("Paper: 1024x1024, 4x4 samples", &published::SIXTEEN_SAMPLES));
    let share = |scene: &String| {
        let points = [1u32, 2, 4].map(|samples| {
            let traced = data.get(&format!("samples/{samples}/{scene}")).map_or(f64::NAN, |f| f.traced);
            (f64::from(samples * samples), 100.0 * traced)
        });
        Series { name: scene.clone(), points: points.to_vec() }
    };
    section.charts.push(Chart {
        id: "supersampling".into(),
        title: "Traced samples by samples per pixel".into(),
        kind: ChartKind::Lines,
        x_title: "samples per pixel".into(),
        y_title: "traced %".into(),
        categories: Vec::new(),
        series: data.scenes().iter().map(share).collect(),
    });
    section
}

pub(super) fn resolution(data: &Data) -> Section {
    let mut section =
        Section::new("resolution", "Scaling with pixels", &["The same view in pictures of several sizes."]);
    let scenes: Vec<&String> = data.scenes().iter().filter(|scene| is_scaled(scene, data.scenes())).collect();
    let sides = &data.extent.scaled_sides;
    let labels: Vec<String> = sides.iter().map(|side| format!("{side}x{side}")).collect();
    for scene in &scenes {
        let title = format!("This run: {scene} by resolution");
        section.tables.push(Table::fill(title, "size", speed_columns(), &labels, |at| {
            data.get(&format!("pixels/{}/{scene}", sides[at])).and_then(speed_cells)
        }));
    }
    section.published.push(published::resolution());
    let full = |scene: &&String| {
        let points = sides.iter().map(|side| {
            let times = data.get(&format!("pixels/{side}/{scene}")).and_then(|f| f.times.as_ref());
            (f64::from(*side).powi(2) / 1e6, times.map_or(f64::NAN, |t| t.full_ms.median))
        });
        Series { name: format!("{scene}, full"), points: points.collect() }
    };
    let adaptive = |scene: &&String| {
        let points = sides.iter().map(|side| {
            let times = data.get(&format!("pixels/{side}/{scene}")).and_then(|f| f.times.as_ref());
            (f64::from(*side).powi(2) / 1e6, times.map_or(f64::NAN, |t| t.adaptive_ms.median))
        });
        Series { name: format!("{scene}, adaptive"), points: points.collect() }
    };
    section.charts.push(Chart {
        id: "resolution".into(),
        title: "Frame time by pixels".into(),
        kind: ChartKind::LogLines,
        x_title: "million pixels".into(),
        y_title: "ms".into(),
        categories: Vec::new(),
        series: scenes.iter().map(full).chain(scenes.iter().map(adaptive)).collect(),
    });
    section
}

pub(super) fn triangles(data: &Data) -> Section {
    let side = data.extent.shown_side;
    let mut section = Section::new(
        "triangles",
        "Scaling with triangles",
        &[
            "The scene “spheres” with each triangle cut into n x n equal ones: the same surfaces, only more triangles. The paper \
           has no such table.",
        ],
    );
    let parts = &data.extent.finer;
    let labels: Vec<String> = parts.iter().map(|n| format!("{n} x {n}")).collect();
    let columns = vec![
        Column::new("triangles", Unit::Count),
        Column::new("full ms", Unit::Milliseconds),
        Column::new("adaptive ms", Unit::Milliseconds),
        Column::new("speedup", Unit::Times),
        Column::new("steps and tests per pixel, full", Unit::Times),
        Column::new("work speedup", Unit::Times),
        Column::new("traced %", Unit::Percent),
    ];
    let get = |at: usize| data.get(&format!("finer/{}", parts[at]));
    section.tables.push(Table::fill(
        format!("This run: spheres at {side}x{side}, by how finely it is cut"),
        "parts of a triangle",
        columns,
        &labels,
        |at| {
            let f = get(at)?;
            let times = f.times.as_ref()?;
            Some(vec![
                f.triangles.into(),
                times.full_ms.median.into(),
                times.adaptive_ms.median.into(),
                times.speedup.median.into(),
                (f.full_work as f64 / f.sample_count() as f64).into(),
                f.work_speedup().into(),
                Cell::Number(f.traced),
            ])
        },
    ));
    let series = |name: &str, of: &dyn Fn(&crate::analysis::report::figures::Times) -> f64| Series {
        name: name.into(),
        points: (0..parts.len())
            .map(|at| {
                let f = get(at);
                let y = f.and_then(|f| f.times.as_ref()).map_or(f64::NAN, of);
                (f.map_or(f64::NAN, |f| f.triangles as f64), y)
            })
            .collect(),
    };
    section.charts.push(Chart {
        id: "triangles".into(),
        title: "Frame time by triangles".into(),
        kind: ChartKind::LogLines,
        x_title: "triangles".into(),
        y_title: "ms".into(),
        categories: Vec::new(),
        series: vec![series("full", &|t| t.full_ms.median), series("adaptive", &|t| t.adaptive_ms.median)],
    });
    section
}
