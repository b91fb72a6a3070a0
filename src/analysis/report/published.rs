// SPDX-License-Identifier: MIT OR Apache-2.0
//! The results that the paper's authors published, as numbers.
//!
//! Youngwook Kim, Woong Seo, Yongho Kim, Yeongkyu Lim, Jae-Ho Nah, Insung Ihm: Adaptive undersampling for efficient mobile
//! ray tracing. The Visual Computer 32(6-8), 801-811, 2016. The figures are those of the authors' talk at Computer Graphics
//! International 2016: LG G3 Cat.6, Snapdragon 805, Adreno 420, OpenCL 1.2; unless it says otherwise at 1024x1024, one
//! sample per pixel, blocks of 2x2, correction on. Times are milliseconds, shares are of 1.

// A share of traced pixels happens to look like 1 / pi.
#![allow(clippy::approx_constant)]

use super::table::{Cell, Column, Row, Table, Unit};

/// Where the figures come from, for the reader of a report.
pub const SOURCE: &str = "Kim et al., \u{201c}Adaptive undersampling for efficient mobile ray tracing\u{201d}, The Visual Computer \
     32(6\u{2013}8), 2016, doi:10.1007/s00371-016-1251-y; figures of the authors\u{2019} talk at CGI 2016, measured on an LG G3 \
     Cat.6 (Snapdragon 805, Adreno 420, OpenCL 1.2) with scenes of their own";

/// The paper's scenes.
pub const SCENES: [&str; 6] = ["Cafe", "Ben", "Kitchen", "Conference", "Bathroom", "San Miguel"];

/// One scene by one way of sampling.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Speed {
    /// Full tracing, ms.
    pub full_ms: f64,
    /// The method, ms.
    pub ours_ms: f64,
    /// Full over ours.
    pub speedup: f64,
    /// Base and traced pixels of all.
    pub traced: f64,
    /// dB against full tracing.
    pub psnr_db: f64,
}

const fn speed(full_ms: f64, ours_ms: f64, speedup: f64, traced: f64, psnr_db: f64) -> Speed {
    Speed { full_ms, ours_ms, speedup, traced, psnr_db }
}

/// Full tracing of Kitchen and Bathroom by the side of the picture, ms.
pub const RESOLUTION: [(u32, [f64; 2]); 3] =
    [(512, [356.0, 319.4]), (1024, [1296.9, 1169.5]), (2048, [4777.8, 4293.7])];

/// One sample per pixel, in the order of [`SCENES`].
pub const ONE_SAMPLE: [Speed; 6] = [
    speed(1211.7, 591.2, 2.04, 0.294, 43.99),
    speed(1275.8, 575.2, 2.21, 0.270, 45.46),
    speed(1296.9, 828.0, 1.56, 0.345, 39.14),
    speed(841.6, 508.1, 1.65, 0.300, 48.92),
    speed(1169.5, 733.6, 1.59, 0.318, 40.54),
    speed(1344.3, 905.4, 1.48, 0.340, 39.16),
];

/// 2x2 samples per pixel.
pub const FOUR_SAMPLES: [Speed; 6] = [
    speed(4396.7, 2079.5, 2.11, 0.274, 44.03),
    speed(4586.9, 1946.6, 2.35, 0.260, 49.55),
    speed(4796.9, 2656.5, 1.80, 0.312, 45.22),
    speed(3284.0, 1803.9, 1.82, 0.277, 50.35),
    speed(4331.8, 2561.0, 1.69, 0.294, 46.41),
    speed(4833.8, 2923.6, 1.65, 0.300, 43.18),
];

/// 4x4 samples per pixel.
pub const SIXTEEN_SAMPLES: [Speed; 6] = [
    speed(16663.8, 7382.3, 2.25, 0.263, 44.26),
    speed(18007.2, 7230.0, 2.49, 0.255, 51.66),
    speed(18244.1, 8978.5, 2.03, 0.291, 48.83),
    speed(12700.4, 6729.4, 1.88, 0.265, 51.58),
    speed(16759.8, 8480.6, 1.97, 0.280, 49.12),
    speed(17917.2, 9987.0, 1.79, 0.278, 48.08),
];

/// The paper's names of its kernels.
pub const KERNELS: [&str; 9] = ["I", "II-a", "II-b", "II-c", "III-a", "III-b", "III-c", "IV", "ETC"];

/// Times of the kernels by scene, ms.
pub const KERNEL_MS: [[f64; 9]; 6] = [
    [284.3, 25.9, 10.4, 53.7, 38.5, 11.1, 94.6, 60.8, 11.8],
    [329.8, 25.4, 11.5, 40.2, 36.8, 10.7, 66.7, 44.3, 9.8],
    [341.7, 26.3, 10.2, 99.4, 37.5, 10.7, 207.1, 81.9, 13.2],
    [206.4, 23.8, 10.0, 38.7, 37.3, 11.6, 81.8, 86.7, 11.6],
    [300.7, 27.0, 10.0, 84.9, 37.1, 11.1, 185.2, 66.5, 11.0],
    [362.7, 24.0, 10.7, 126.0, 34.3, 11.0, 198.1, 130.0, 8.7],
];

/// Problematic adaptive pixels on top of the base ones, by scene.
pub const PROBLEMATIC: [f64; 6] = [0.044, 0.020, 0.095, 0.050, 0.068, 0.090];

/// Steps of the two sweeps: share of reflective or traced pixels, full ms, ours ms, speedup.
pub type SweepStep = (f64, f64, f64, f64);

/// By the share of reflective pixels.
pub const REFLECTIVE: [SweepStep; 5] = [
    (0.199, 813.3, 454.0, 1.79),
    (0.411, 870.2, 451.8, 1.92),
    (0.609, 992.8, 495.1, 2.00),
    (0.820, 1054.4, 493.5, 2.13),
    (0.999, 1077.3, 437.0, 2.46),
];

/// By the share of traced pixels.
pub const TRACED: [SweepStep; 5] = [
    (0.259, 944.6, 362.1, 2.60),
    (0.266, 884.7, 414.4, 2.13),
    (0.280, 866.4, 460.4, 1.88),
    (0.291, 859.8, 521.7, 1.64),
    (0.321, 904.7, 606.1, 1.49),
];

fn table(title: &str, row_title: &str, columns: Vec<Column>, rows: impl Iterator<Item = (String, Vec<f64>)>) -> Table {
    let rows: Vec<Row> =
        rows.map(|(label, cells)| Row { label, cells: cells.into_iter().map(Cell::Number).collect() }).collect();
    let labels = rows.iter().map(|row| row.label.clone()).collect::<Vec<_>>();
    Table { rows, ..Table::new(title, row_title, columns, labels) }
}

/// Table 9.0: full tracing by resolution.
pub fn resolution() -> Table {
    let columns =
        vec![Column::new("Kitchen, full ms", Unit::Milliseconds), Column::new("Bathroom, full ms", Unit::Milliseconds)];
    let rows = RESOLUTION.iter().map(|(side, ms)| (format!("{side}x{side}"), ms.to_vec()));
    table("Paper: full tracing by resolution", "size", columns, rows)
}

/// Tables 9.1 and 9.2: speed, traced pixels and quality.
pub fn speeds(title: &str, figures: &[Speed; 6]) -> Table {
    let columns = vec![
        Column::new("full ms", Unit::Milliseconds),
        Column::new("ours ms", Unit::Milliseconds),
        Column::new("speedup", Unit::Times),
        Column::new("traced %", Unit::Percent),
        Column::new("PSNR dB", Unit::Decibel),
    ];
    let rows = SCENES
        .iter()
        .zip(figures)
        .map(|(scene, f)| ((*scene).to_owned(), vec![f.full_ms, f.ours_ms, f.speedup, f.traced, f.psnr_db]));
    table(title, "scene", columns, rows)
}

/// Table 9.3: times of the kernels.
pub fn kernels() -> Table {
    let columns = KERNELS.map(|kernel| Column::new(format!("{kernel} ms"), Unit::Milliseconds)).to_vec();
    let rows = SCENES.iter().zip(&KERNEL_MS).map(|(scene, ms)| ((*scene).to_owned(), ms.to_vec()));
    table(
        "Paper: times of the kernels (I, II-c, III-c trace rays; a check and interpolate; b pack; IV corrects)",
        "scene",
        columns,
        rows,
    )
}

/// Table 9.4: problematic pixels.
pub fn problematic() -> Table {
    let columns = vec![Column::new("problematic %", Unit::Percent)];
    let rows = SCENES.iter().zip(PROBLEMATIC).map(|(scene, share)| ((*scene).to_owned(), vec![share]));
    table("Paper: problematic adaptive pixels, beside 25 % base pixels", "scene", columns, rows)
}

/// Tables 9.5 and 9.6: the sweeps.
pub fn sweep(title: &str, row_title: &str, steps: &[SweepStep; 5]) -> Table {
    let columns = vec![
        Column::new("full ms", Unit::Milliseconds),
        Column::new("ours ms", Unit::Milliseconds),
        Column::new("speedup", Unit::Times),
    ];
    let rows = steps
        .iter()
        .map(|&(share, full, ours, speedup)| (format!("{:.1} %", 100.0 * share), vec![full, ours, speedup]));
    table(title, row_title, columns, rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_published_figures_agree_with_each_other() {
        for figures in [ONE_SAMPLE, FOUR_SAMPLES, SIXTEEN_SAMPLES] {
            for f in figures {
                assert!((f.full_ms / f.ours_ms - f.speedup).abs() < 0.011, "{f:?}");
            }
        }
        for (f, kernels) in ONE_SAMPLE.iter().zip(KERNEL_MS) {
            assert!((kernels.iter().sum::<f64>() - f.ours_ms).abs() < 0.35, "{f:?}");
        }
        for (f, problematic) in ONE_SAMPLE.iter().zip(PROBLEMATIC) {
            assert!((0.25 + problematic - f.traced).abs() < 0.0011, "{f:?}");
        }
        for (_, full, ours, speedup) in REFLECTIVE.into_iter().chain(TRACED) {
            assert!((full / ours - speedup).abs() < 0.02, "{full} {ours}");
        }
        for table in [resolution(), kernels(), problematic(), speeds("a", &ONE_SAMPLE), sweep("b", "c", &TRACED)] {
            assert!(table.problems().is_empty(), "{:?}", table.problems());
        }
    }
}
