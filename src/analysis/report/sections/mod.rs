// SPDX-License-Identifier: MIT OR Apache-2.0
//! The parts of a report, each made of figures alone.

mod choices;
mod pixels;
mod speed;
mod stages;
mod sweeps;

use std::collections::BTreeMap;

use serde::Serialize;

use super::figures::Figures;
use super::plan::Extent;
use super::table::{Cell, Chart, Column, Picture, Table, Unit};

/// One part of a report: our tables, the paper's, and what shows them.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Section {
    /// Its anchor.
    pub id: String,
    /// Its heading.
    pub title: String,
    /// What there is to know, a paragraph each.
    pub text: Vec<String>,
    /// Tables of this run.
    pub tables: Vec<Table>,
    /// The paper's, beside them.
    pub published: Vec<Table>,
    /// Charts of the tables.
    pub charts: Vec<Chart>,
    /// Pictures, in groups.
    pub pictures: Vec<Group>,
    /// Pairs of pictures to slide between.
    pub sliders: Vec<Slider>,
    /// Pictures that should be there.
    #[serde(skip)]
    pub missing: Vec<String>,
}

/// Pictures that belong together.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Group {
    /// What they show.
    pub title: String,
    /// The pictures, in order.
    pub pictures: Vec<Picture>,
}

/// A full and an adaptive picture, and ten times their difference.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Slider {
    /// The scene.
    pub title: String,
    /// Every pixel traced.
    pub full: Picture,
    /// Drawn adaptively.
    pub adaptive: Picture,
    /// Ten times the difference.
    pub difference: Picture,
}

/// All figures of a run, by the ids of the plan.
#[derive(Debug)]
pub struct Data<'a> {
    /// What was measured.
    pub extent: &'a Extent,
    /// What was found.
    pub found: &'a BTreeMap<String, Figures>,
    /// Close-ups that were cut from pictures.
    pub close_ups: &'a [Group],
}

impl Data<'_> {
    /// The figures of one measurement.
    pub fn get(&self, id: &str) -> Option<&Figures> {
        self.found.get(id)
    }

    fn scenes(&self) -> &[String] {
        &self.extent.scenes
    }

    /// A table of one row for each scene, from the measurement `group/SCENE`.
    fn by_scene(
        &self,
        title: &str,
        group: &str,
        columns: Vec<Column>,
        cells: impl Fn(&Figures) -> Option<Vec<Cell>>,
    ) -> Table {
        let scenes = self.scenes();
        Table::fill(title, "scene", columns, scenes, |at| self.get(&format!("{group}/{}", scenes[at])).and_then(&cells))
    }

    /// The figures of the measurements `group/SCENE` of all scenes, or none if one is missing.
    fn of_all_scenes(&self, group: &str) -> Option<Vec<&Figures>> {
        self.scenes().iter().map(|scene| self.get(&format!("{group}/{scene}"))).collect()
    }
}

impl Section {
    fn new(id: &str, title: &str, text: &[&str]) -> Self {
        let text = text.iter().map(|paragraph| (*paragraph).to_owned()).collect();
        Section { id: id.into(), title: title.into(), text, ..Section::default() }
    }

    /// What is wrong with it, one sentence each.
    pub fn problems(&self) -> Vec<String> {
        let tables = self.tables.iter().chain(&self.published).flat_map(Table::problems);
        let charts = self.charts.iter().flat_map(Chart::problems);
        let missing = self.missing.iter().map(|what| format!("{what} is missing"));
        tables.chain(charts).chain(missing).map(|problem| format!("{}: {problem}", self.id)).collect()
    }

    /// Adds a group of pictures, of which each is named for the case that it is missing.
    fn show(&mut self, title: &str, pictures: Vec<(String, Option<Picture>)>) {
        let mut group = Group { title: title.into(), pictures: Vec::new() };
        for (name, picture) in pictures {
            match picture {
                Some(picture) => group.pictures.push(picture),
                None => self.missing.push(format!("the picture {name}")),
            }
        }
        self.pictures.push(group);
    }
}

/// All parts, in the order of the paper's results, then ours.
pub fn all(data: &Data) -> Vec<Section> {
    vec![
        speed::one_sample(data),
        pixels::sliders(data),
        speed::supersampling(data),
        speed::resolution(data),
        stages::dissection(data),
        pixels::problematic(data),
        sweeps::reflective(data),
        sweeps::traced(data),
        pixels::close_ups(data),
        choices::correction(data),
        pixels::details(data),
        choices::presets(data),
        choices::blocks(data),
        choices::ablation(data),
        choices::quality(data),
        speed::triangles(data),
    ]
}

/// Columns of speed and quality, as the paper has them, and the work that does not depend on the device.
fn speed_columns() -> Vec<Column> {
    vec![
        Column::new("full ms", Unit::Milliseconds),
        Column::new("adaptive ms", Unit::Milliseconds),
        Column::new("speedup", Unit::Times),
        Column::new("± %", Unit::Percent),
        Column::new("work speedup", Unit::Times),
        Column::new("traced %", Unit::Percent),
        Column::new("with correction %", Unit::Percent),
        Column::new("PSNR dB", Unit::Decibel),
    ]
}

fn speed_cells(f: &Figures) -> Option<Vec<Cell>> {
    let times = f.times.as_ref()?;
    Some(vec![
        times.full_ms.median.into(),
        times.adaptive_ms.median.into(),
        times.speedup.median.into(),
        times.speedup.relative().into(),
        f.work_speedup().into(),
        f.traced.into(),
        f.traced_with_correction.into(),
        Cell::decibel(f.psnr_db),
    ])
}

/// Columns of what a method costs and leaves wrong, without times.
fn method_columns() -> Vec<Column> {
    vec![
        Column::new("traced %", Unit::Percent),
        Column::new("with correction %", Unit::Percent),
        Column::new("PSNR dB", Unit::Decibel),
        Column::new("FLIP", Unit::Fine),
        Column::new("work speedup", Unit::Times),
        Column::new("correction, % of work", Unit::Percent),
        Column::new("wrong object, pixels", Unit::Count),
        Column::new("wrong shadow, pixels", Unit::Count),
    ]
}

/// The means of several figures: geometric for shares and for work, arithmetic for the others.
fn mean_cells(figures: &[&Figures]) -> Vec<Cell> {
    let n = figures.len() as f64;
    let mean = |of: &dyn Fn(&Figures) -> f64| figures.iter().map(|f| of(f)).sum::<f64>() / n;
    let geometric = |of: &dyn Fn(&Figures) -> f64| mean(&|f| of(f).ln()).exp();
    let decibels: Vec<f64> = figures.iter().filter_map(|f| f.psnr_db).collect();
    let psnr = (!decibels.is_empty()).then(|| decibels.iter().sum::<f64>() / decibels.len() as f64);
    vec![
        geometric(&|f| f.traced).into(),
        geometric(&|f| f.traced_with_correction).into(),
        Cell::decibel(psnr),
        mean(&|f| f.flip_mean).into(),
        geometric(&Figures::work_speedup).into(),
        mean(&Figures::correction_work).into(),
        mean(&|f| f.wrong_object as f64).into(),
        mean(&|f| f.wrong_shadow as f64).into(),
    ]
}
