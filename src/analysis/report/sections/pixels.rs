// SPDX-License-Identifier: MIT OR Apache-2.0
//! What can be seen: which pixels failed which test, what differs, what correction brings back.

use super::{Data, Section, Slider};
use crate::analysis::report::published;
use crate::analysis::report::table::{Cell, Column, Table, Unit};
use crate::method::options::Test;

pub(super) fn problematic(data: &Data) -> Section {
    let side = data.extent.main_side;
    let mut section = Section::new(
        "problematic",
        "Problematic pixels",
        &[
            "Pixels that failed a test and were traced, beside the base pixels; then the share that failed each test. A pixel may \
           fail several. G1 is another object, G2 a distance, G3 normals, G4 a fold, TX texture, SH shadows, GC reflected light.",
        ],
    );
    let mut columns = vec![Column::new("problematic %", Unit::Percent)];
    columns.extend(Test::ALL.map(|test| Column::new(format!("{} %", test.name().to_uppercase()), Unit::Percent)));
    let title = format!("This run: problematic pixels at {side}x{side}, beside 25 % base pixels");
    section.tables.push(data.by_scene(&title, "presets/balanced", columns, |f| {
        Some([f.traced - f.base].into_iter().chain(f.failed).map(Cell::Number).collect())
    }));
    section.published.push(published::problematic());
    for scene in data.scenes() {
        let figures = data.get(&format!("shown/balanced/{scene}"));
        let kinds = ["class", "fail-mask"].into_iter().chain(Test::ALL.map(Test::name));
        let pictures = kinds.map(|kind| {
            let picture = figures.and_then(|f| f.picture(kind)).cloned();
            (format!("{kind} of {scene}"), picture)
        });
        section.show(scene, pictures.collect());
    }
    section.text.push(
        "In the pictures of classes base pixels are grey, traced ones orange, rebuilt ones dark blue, corrected ones red and \
         yellow. In the pictures of all tests G1 is red, G2 orange, G3 green, G4 cyan, TX magenta, SH blue, GC yellow."
            .into(),
    );
    section
}

pub(super) fn sliders(data: &Data) -> Section {
    let mut section = Section::new(
        "pictures",
        "Full, adaptive and their difference",
        &[
            "Move the slider between full tracing on the left and the adaptive picture on the right. Below is ten times the \
           difference.",
        ],
    );
    for scene in data.scenes() {
        let figures = data.get(&format!("shown/balanced/{scene}"));
        let picture = |kind: &str| figures.and_then(|f| f.picture(kind)).cloned();
        match (picture("full"), picture("adaptive"), picture("difference")) {
            (Some(full), Some(adaptive), Some(difference)) => {
                section.sliders.push(Slider { title: scene.clone(), full, adaptive, difference });
            }
            _ => section.missing.push(format!("the pictures of {scene}")),
        }
    }
    section
}

pub(super) fn close_ups(data: &Data) -> Section {
    let mut section = Section::new(
        "close-ups",
        "What correction brings back",
        &["Where correction changed the picture most, enlarged: before correction, after it, and full tracing."],
    );
    section.pictures = data.close_ups.to_vec();
    for scene in data.scenes().iter().skip(section.pictures.len()) {
        section.missing.push(format!("the close-up of {scene}"));
    }
    section
}

pub(super) fn details(data: &Data) -> Section {
    let side = data.extent.rods_side;
    let mut section = Section::new(
        "details",
        "Small details with 1 and 4x4 samples",
        &["Thin rods and their shadows; at 256x256 the thinnest covers half a pixel."],
    );
    let rows = [("off", 1), ("balanced", 1), ("off", 4), ("balanced", 4)];
    let labels = rows.map(|(method, samples)| {
        let correction = if method == "off" { "without" } else { "with" };
        format!("{samples}x{samples} samples, {correction} correction")
    });
    let columns = vec![
        Column::new("traced %", Unit::Percent),
        Column::new("with correction %", Unit::Percent),
        Column::new("PSNR dB", Unit::Decibel),
        Column::new("wrong object, samples", Unit::Count),
        Column::new("largest cluster", Unit::Count),
        Column::new("wrong shadow, samples", Unit::Count),
    ];
    let get = |at: usize| data.get(&format!("rods/{}/{}", rows[at].0, rows[at].1));
    section.tables.push(Table::fill(format!("This run: rods at {side}x{side}"), "drawn", columns, &labels, |at| {
        let f = get(at)?;
        Some(vec![
            f.traced.into(),
            f.traced_with_correction.into(),
            Cell::decibel(f.psnr_db),
            f.wrong_object.into(),
            f.wrong_object_cluster.into(),
            f.wrong_shadow.into(),
        ])
    }));
    for samples in [1, 4] {
        let picture = |method: &str, kind: &str, caption: &str| {
            let found = data.get(&format!("rods/{method}/{samples}")).and_then(|f| f.picture(kind));
            let caption = format!("{samples}x{samples} samples, {caption}");
            (caption.clone(), found.map(|p| super::Picture { caption, ..p.clone() }))
        };
        section.show(
            &format!("{samples}x{samples} samples per pixel"),
            vec![
                picture("balanced", "full", "full tracing"),
                picture("off", "adaptive", "without correction"),
                picture("balanced", "adaptive", "with correction"),
            ],
        );
    }
    section
}
