// SPDX-License-Identifier: MIT OR Apache-2.0
//! The paper's two sweeps: by the share of reflective and of traced pixels.

use super::{Data, Section, speed_cells, speed_columns};
use crate::analysis::report::figures::Figures;
use crate::analysis::report::published::{self, SweepStep};
use crate::analysis::report::recipe::{MIRRORS, VIEWS};
use crate::analysis::report::table::{Cell, Chart, ChartKind, Column, Series, Table, Unit};

pub(super) fn reflective(data: &Data) -> Section {
    let side = data.extent.shown_side;
    let mut section = Section::new(
        "reflective",
        "Reflective pixels against speed",
        &[
            "More and more materials of the café become half mirrors, in an order that is fixed in the program; the share of \
           pixels that see a mirror or glass first is what came out.",
        ],
    );
    let labels: Vec<String> = (1..=MIRRORS.len()).map(|step| format!("step {step}")).collect();
    let columns = [vec![Column::new("reflective %", Unit::Percent)], speed_columns()].concat();
    let get = |at: usize| data.get(&format!("mirrors/{}", at + 1));
    section.tables.push(Table::fill(format!("This run: café at {side}x{side}"), "step", columns, &labels, |at| {
        let f = get(at)?;
        Some([vec![Cell::Number(f.reflective)], speed_cells(f)?].concat())
    }));
    section.published.push(published::sweep("Paper: speed by reflective pixels", "reflective", &published::REFLECTIVE));
    let points: Vec<Option<&Figures>> = (0..MIRRORS.len()).map(get).collect();
    let title = "Speedup by reflective pixels";
    section.charts.push(chart("reflective", title, "reflective %", &points, |f| f.reflective, &published::REFLECTIVE));
    let pictures = points.iter().enumerate().map(|(at, f)| {
        let found = f.and_then(|f| {
            let caption = format!("{:.1} % reflective", 100.0 * f.reflective);
            f.picture("adaptive").map(|p| super::Picture { caption, ..p.clone() })
        });
        (format!("of step {}", at + 1), found)
    });
    section.show("The steps", pictures.collect());
    section
}

pub(super) fn traced(data: &Data) -> Section {
    let side = data.extent.shown_side;
    let mut section = Section::new(
        "traced",
        "Traced pixels against speed",
        &["Five views of the café, which are fixed in the program; the share of traced pixels is what came out."],
    );
    let labels = VIEWS.map(|(name, ..)| name.to_owned());
    let get = |at: usize| data.get(&format!("views/{at}"));
    let title = format!("This run: views of the café at {side}x{side}");
    section.tables.push(Table::fill(title, "view", speed_columns(), &labels, |at| speed_cells(get(at)?)));
    section.published.push(published::sweep("Paper: speed by traced pixels", "traced", &published::TRACED));
    let mut points: Vec<Option<&Figures>> = (0..VIEWS.len()).map(get).collect();
    points.sort_by(|a, b| {
        let traced = |f: &Option<&Figures>| f.map_or(f64::NAN, |f| f.traced);
        traced(a).total_cmp(&traced(b))
    });
    let title = "Speedup by traced pixels";
    section.charts.push(chart("traced", title, "traced %", &points, |f| f.traced, &published::TRACED));
    let pictures = VIEWS.iter().enumerate().map(|(at, (name, ..))| {
        let found = get(at).and_then(|f| {
            let caption = format!("{name}: {:.1} % traced", 100.0 * f.traced);
            f.picture("adaptive").map(|p| super::Picture { caption, ..p.clone() })
        });
        (format!("of {name}"), found)
    });
    section.show("The views", pictures.collect());
    section
}

fn chart(
    id: &str,
    title: &str,
    x_title: &str,
    figures: &[Option<&Figures>],
    x: impl Fn(&Figures) -> f64,
    paper: &[SweepStep; 5],
) -> Chart {
    let series = |name: &str, y: &dyn Fn(&Figures) -> f64| Series {
        name: name.into(),
        points: figures.iter().map(|f| f.map_or((f64::NAN, f64::NAN), |f| (100.0 * x(f), y(f)))).collect(),
    };
    Chart {
        id: id.into(),
        title: title.into(),
        kind: ChartKind::Lines,
        x_title: x_title.into(),
        y_title: "speedup".into(),
        categories: Vec::new(),
        series: vec![
            series("this run, time", &|f| f.times.as_ref().map_or(f64::NAN, |t| t.speedup.median)),
            series("this run, work", &Figures::work_speedup),
            Series {
                name: "paper, time".into(),
                points: paper.iter().map(|(share, .., speedup)| (100.0 * share, *speedup)).collect(),
            },
        ],
    }
}
