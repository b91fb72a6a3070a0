// SPDX-License-Identifier: MIT OR Apache-2.0
//! A report as a page and as Markdown: templates filled from the model, numbers already in words.

use std::path::Path;

use base64::Engine;
use minijinja::syntax::SyntaxConfig;
use minijinja::value::Serde;
use minijinja::{AutoEscape, Environment, UndefinedBehavior};
use rarefy::internal::analysis::report::bench::{About, Report};
use rarefy::internal::analysis::report::sections::Section;
use rarefy::internal::analysis::report::table::{Cell, Picture, Table};
use rarefy::internal::files;
use rarefy::{Error, Result};
use serde::Serialize;

use super::chart;

const PAGE: &str = include_str!("page.html");
const MARKDOWN: &str = include_str!("report.md");
/// The largest picture that is put into a page.
const MAX_PICTURE_BYTES: u64 = 64 << 20;

/// The page, with all pictures and charts of the report in it; pictures are read from `folder`.
pub fn html(report: &Report, folder: &Path) -> Result<String> {
    fill("page.html", PAGE, &Filling::new(report, &|picture| embedded(picture, folder))?)
}

/// The tables in Markdown.
pub fn markdown(report: &Report) -> Result<String> {
    fill("report.md", MARKDOWN, &Filling::new(report, &|picture| Ok(picture.file.clone()))?)
}

fn fill(name: &str, template: &str, filling: &Filling) -> Result<String> {
    let mut environment = Environment::new();
    let syntax = SyntaxConfig::builder().trim_blocks(true).lstrip_blocks(true).build().map_err(failed)?;
    environment.set_syntax(syntax);
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    environment.set_auto_escape_callback(|name| match name.ends_with(".html") {
        true => AutoEscape::Html,
        false => AutoEscape::None,
    });
    environment.add_template(name, template).map_err(failed)?;
    environment.get_template(name).and_then(|template| template.render(Serde(filling))).map_err(failed)
}

fn failed(error: minijinja::Error) -> Error {
    Error::argument("the page", format!("{error:#}"))
}

/// The picture as an address that loads nothing.
fn embedded(picture: &Picture, folder: &Path) -> Result<String> {
    let bytes = files::read(&folder.join(&picture.file), MAX_PICTURE_BYTES)?;
    Ok(format!("data:image/png;base64,{}", base64::engine::general_purpose::STANDARD.encode(bytes)))
}

/// What the templates are filled with.
#[derive(Serialize)]
struct Filling<'a> {
    published: &'a str,
    run: Vec<(&'static str, &'a str)>,
    verdict: Vec<FindingText<'a>>,
    sections: Vec<SectionText<'a>>,
}

#[derive(Serialize)]
struct FindingText<'a> {
    claim: &'a str,
    answer: &'a str,
    holds: bool,
    evidence: &'a [String],
}

#[derive(Serialize)]
struct SectionText<'a> {
    id: &'a str,
    title: &'a str,
    text: &'a [String],
    tables: Vec<TableText<'a>>,
    published: Vec<TableText<'a>>,
    charts: Vec<ChartText<'a>>,
    groups: Vec<GroupText<'a>>,
    sliders: Vec<SliderText<'a>>,
}

#[derive(Serialize)]
struct TableText<'a> {
    title: &'a str,
    row_title: &'a str,
    columns: Vec<&'a str>,
    rows: Vec<(&'a str, Vec<String>)>,
}

#[derive(Serialize)]
struct ChartText<'a> {
    title: &'a str,
    svg: String,
}

#[derive(Serialize)]
struct GroupText<'a> {
    title: &'a str,
    pictures: Vec<PictureText<'a>>,
}

#[derive(Serialize)]
struct SliderText<'a> {
    title: &'a str,
    full: PictureText<'a>,
    adaptive: PictureText<'a>,
    difference: PictureText<'a>,
}

#[derive(Serialize)]
struct PictureText<'a> {
    source: String,
    #[serde(flatten)]
    picture: &'a Picture,
}

/// Where a picture is found.
type Source<'a> = &'a dyn Fn(&Picture) -> Result<String>;

impl<'a> Filling<'a> {
    fn new(report: &'a Report, source: Source) -> Result<Self> {
        let finding = |finding: &'a rarefy::internal::analysis::report::verdict::Finding| FindingText {
            claim: finding.claim(),
            answer: finding.answer(),
            holds: finding.holds() == Some(true),
            evidence: finding.evidence(),
        };
        Ok(Filling {
            published: report.published,
            run: run(&report.about),
            verdict: report.verdict.iter().map(finding).collect(),
            sections: report.sections.iter().map(|s| SectionText::new(s, source)).collect::<Result<_>>()?,
        })
    }
}

fn run(about: &About) -> Vec<(&'static str, &str)> {
    vec![
        ("Program", &about.version),
        ("Commit", &about.commit),
        ("Begun", &about.started),
        ("Took", &about.took),
        ("Machine", &about.machine),
        ("Device", &about.device),
        ("Driver", &about.driver),
        ("Back end", &about.backend),
        ("Options", &about.options),
        ("Repeats", &about.repeats),
        ("Spread", &about.spread),
        ("Scenes", &about.scenes),
        ("Resumed", &about.resumed),
    ]
}

impl<'a> SectionText<'a> {
    fn new(section: &'a Section, source: Source) -> Result<Self> {
        let picture = |picture: &'a Picture| Ok(PictureText { source: source(picture)?, picture });
        let tables = |tables: &'a [Table]| tables.iter().map(TableText::new).collect();
        let mut text = SectionText {
            id: &section.id,
            title: &section.title,
            text: &section.text,
            tables: tables(&section.tables),
            published: tables(&section.published),
            charts: Vec::new(),
            groups: Vec::new(),
            sliders: Vec::new(),
        };
        for chart in &section.charts {
            text.charts.push(ChartText { title: &chart.title, svg: chart::svg(chart)? });
        }
        for group in &section.pictures {
            let pictures = group.pictures.iter().map(picture).collect::<Result<_>>()?;
            text.groups.push(GroupText { title: &group.title, pictures });
        }
        for slider in &section.sliders {
            text.sliders.push(SliderText {
                title: &slider.title,
                full: picture(&slider.full)?,
                adaptive: picture(&slider.adaptive)?,
                difference: picture(&slider.difference)?,
            });
        }
        Ok(text)
    }
}

impl<'a> TableText<'a> {
    fn new(table: &'a Table) -> Self {
        let words = |cells: &[Cell]| {
            let columns = table.columns.iter().zip(cells);
            let words = columns.map(|(column, cell)| match cell {
                Cell::Number(value) => column.unit.format(*value),
                Cell::Words(words) => (*words).to_owned(),
                Cell::Missing => "missing".to_owned(),
            });
            words.collect()
        };
        TableText {
            title: &table.title,
            row_title: &table.row_title,
            columns: table.columns.iter().map(|column| column.title.as_str()).collect(),
            rows: table.rows.iter().map(|row| (row.label.as_str(), words(&row.cells))).collect(),
        }
    }
}
