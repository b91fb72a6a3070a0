// SPDX-License-Identifier: MIT OR Apache-2.0
//! FLIP: the error that an observer sees who switches between two pictures at the same place.
//!
//! Written from Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild, "FLIP: A Difference Evaluator for
//! Alternating Images", Proceedings of the ACM on Computer Graphics and Interactive Techniques 3(2), 2020. Numbers in
//! parentheses below are sections of that paper. The pictures are 8-bit sRGB, the viewing conditions are the paper's
//! own: a monitor of 0.7 m and 3840 pixels, seen from 0.7 m, 67 pixels per degree.
//!
//! All filters are sums of products of a row and a column filter, so that they run one side at a time. The work is cut
//! into bands of rows; each pixel's value depends on the pictures alone, and sums are taken in order, so the result is
//! the same for any number of threads.

use std::f64::consts::PI;

use rayon::prelude::*;

use super::Rgb8;
use crate::{Result, memory};

/// Rows that one task works on; memory per task is about 20 floats per pixel of band and halo.
const BAND_ROWS: usize = 32;

/// The viewing distance and the monitor's width, in metres, and its width in pixels.
const DISTANCE_M: f64 = 0.7;
const MONITOR_M: f64 = 0.7;
const MONITOR_PIXELS: f64 = 3840.0;

/// Contrast sensitivity (4.1.1): Gaussian terms (a, b) of the achromatic, red-green and blue-yellow channel, in the
/// frequency domain in degrees.
const CSF_ACHROMATIC: [(f64, f64); 1] = [(1.0, 0.0047)];
const CSF_RED_GREEN: [(f64, f64); 1] = [(1.0, 0.0053)];
const CSF_BLUE_YELLOW: [(f64, f64); 2] = [(34.1, 0.04), (13.5, 0.025)];

/// Light that counts as none, over that of white: the resolution of 32-bit floats at the offset of -16 that the
/// evaluator's Y carries. Without it, the faintest tails of white beside black, which the evaluator loses in rounding,
/// would lift the mean of a chequered picture by 1e-4.
const UNSEEN_LIGHT: f32 = 1.0 / (116.0 * 524_288.0);

/// Colour error (4.1.3): the exponent, and the point where the steep part of the map ends.
const COLOUR_EXPONENT: f32 = 0.7;
const KNEE_IN: f32 = 0.4;
const KNEE_OUT: f32 = 0.95;

/// Features (4.2): width of the detector in degrees, and the exponent of the feature difference.
const FEATURE_WIDTH_DEGREES: f64 = 0.082;
const FEATURE_EXPONENT: f32 = 0.5;

/// FLIP of a whole picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flip {
    /// The mean error, 0 (equal) to 1.
    pub mean: f64,
    /// The 99th percentile by nearest rank: the least error that at least 99 % of the pixels do not exceed.
    pub p99: f64,
}

/// Mean and 99th percentile of the FLIP error.
///
/// # Errors
/// [`crate::Error::InvalidArgument`] if the sizes differ.
pub fn flip(reference: Rgb8, test: Rgb8) -> Result<Flip> {
    let mut errors = flip_map(reference, test)?;
    let count = errors.len();
    let mean = errors.iter().map(|&e| f64::from(e)).sum::<f64>() / count as f64;
    // ceil(0.99 n) in 64 bits: n * 99 may exceed a 32-bit usize.
    let rank = (count as u64 * 99).div_ceil(100) as usize;
    let (_, &mut p99, _) = errors.select_nth_unstable_by(rank - 1, f32::total_cmp);
    Ok(Flip { mean, p99: f64::from(p99) })
}

/// The FLIP error of each pixel, 0 to 1, row by row.
///
/// # Errors
/// [`crate::Error::InvalidArgument`] if the sizes differ.
pub fn flip_map(reference: Rgb8, test: Rgb8) -> Result<Vec<f32>> {
    reference.same_size(test)?;
    let observer = Observer::new();
    let width = reference.width() as usize;
    let mut errors = memory::filled("the FLIP error of each pixel", reference.pixels().len(), 0.0f32)?;
    errors.par_chunks_mut(width * BAND_ROWS).enumerate().for_each(|(band, out)| {
        let rows = band * BAND_ROWS..band * BAND_ROWS + out.len() / width;
        let sides = [reference, test].map(|picture| Band::new(&observer, picture, rows.start, rows.end));
        let mut scratch = Scratch::new(width);
        let mut seen = [Seen::new(width), Seen::new(width)];
        for (y, row) in rows.zip(out.chunks_exact_mut(width)) {
            for (side, seen) in sides.iter().zip(&mut seen) {
                seen.look(&observer, side, y, &mut scratch);
            }
            for (x, error) in row.iter_mut().enumerate() {
                *error = observer.pixel_error(&seen[0], &seen[1], x);
            }
        }
    });
    Ok(errors)
}

type Matrix = [[f64; 3]; 3];

/// Filters and colour constants.
struct Observer {
    /// Linear value of each 8-bit sRGB value.
    linear: [f32; 256],
    /// Linear RGB to X, Y, Z, each relative to the white point (D65).
    xyz_of_rgb: [[f32; 3]; 3],
    /// Linear RGB to the opponent space, and back.
    opponent_of_rgb: [[f32; 3]; 3],
    rgb_of_opponent: [[f32; 3]; 3],
    /// Spatial filters of the three opponent channels: sums of (row filter, column filter).
    sensitivity: [Vec<(Vec<f32>, Vec<f32>)>; 3],
    /// Feature detectors: Gaussian, its first and its second derivative.
    smooth: Vec<f32>,
    edge: Vec<f32>,
    point: Vec<f32>,
    /// The largest colour error: that of pure green against pure blue.
    largest: f32,
}

impl Observer {
    fn new() -> Self {
        let pixels_per_degree = DISTANCE_M * (MONITOR_PIXELS / MONITOR_M) * (PI / 180.0);
        let xyz_of_rgb = white_relative_xyz();
        // The paper filters in YCxCz (4.1.1): 116 Y - 16, 500 (X - Y), 200 (Y - Z). Filters that sum to 1 commute with
        // scale and offset, so Y, X - Y and Y - Z do as well.
        let [x, y, z] = xyz_of_rgb;
        let minus = |a: [f64; 3], b: [f64; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
        let opponent_of_rgb = [y, minus(x, y), minus(y, z)];

        // One radius for all channels: three standard deviations of the widest term.
        let widest = CSF_BLUE_YELLOW.iter().fold(0.0, |w, t| t.1.max(w));
        let radius = (3.0 * (widest / (2.0 * PI * PI)).sqrt() * pixels_per_degree).ceil() as i32;
        let sensitivity = [&CSF_ACHROMATIC[..], &CSF_RED_GREEN[..], &CSF_BLUE_YELLOW[..]]
            .map(|terms| sensitivity_filters(terms, radius, pixels_per_degree));

        let deviation = 0.5 * FEATURE_WIDTH_DEGREES * pixels_per_degree;
        let radius = (3.0 * deviation).ceil() as i32;
        let feature = |polynomial: fn(f64) -> f64| -> Vec<f32> {
            let taps = (-radius..=radius).map(|x| f64::from(x) / deviation);
            scale_signs_apart(taps.map(|t| polynomial(t) * (-0.5 * t * t).exp()).collect())
        };
        let mut observer = Observer {
            linear: std::array::from_fn(|v| srgb_to_linear(v as f64 / 255.0) as f32),
            rgb_of_opponent: to_f32(inverse(opponent_of_rgb)),
            xyz_of_rgb: to_f32(xyz_of_rgb),
            opponent_of_rgb: to_f32(opponent_of_rgb),
            sensitivity,
            smooth: feature(|_| 1.0),
            edge: feature(|t| -t),
            point: feature(|t| t * t - 1.0),
            largest: 0.0,
        };
        let (green, blue) = (observer.hunt_lab([0.0, 1.0, 0.0]), observer.hunt_lab([0.0, 0.0, 1.0]));
        observer.largest = hyab(green, blue).powf(COLOUR_EXPONENT);
        observer
    }

    /// L*a*b* of linear RGB in [0, 1], with a* and b* scaled by lightness for the Hunt effect (4.1.2).
    fn hunt_lab(&self, rgb: [f32; 3]) -> [f32; 3] {
        let [x, y, z] = apply(&self.xyz_of_rgb, rgb).map(lab_curve);
        let lightness = 116.0 * y - 16.0;
        [lightness, 0.01 * lightness * 500.0 * (x - y), 0.01 * lightness * 200.0 * (y - z)]
    }

    /// Final error (4.3) of the pixel at column `x`.
    fn pixel_error(&self, a: &Seen, b: &Seen, x: usize) -> f32 {
        let filtered = |s: &Seen| [s.opponent[0][x], s.opponent[1][x], s.opponent[2][x]];
        let (colour_a, colour_b) = (filtered(a), filtered(b));
        if colour_a == colour_b {
            return 0.0; // most pixels, and 0 to any power that occurs
        }
        let lab = |opponent| {
            self.hunt_lab(apply(&self.rgb_of_opponent, opponent).map(|c| (c - UNSEEN_LIGHT).clamp(0.0, 1.0)))
        };
        let distance = hyab(lab(colour_a), lab(colour_b)).powf(COLOUR_EXPONENT);
        let knee = KNEE_IN * self.largest;
        let colour = if distance < knee {
            KNEE_OUT / knee * distance
        } else {
            KNEE_OUT + (distance - knee) / (self.largest - knee) * (1.0 - KNEE_OUT)
        };
        let edges = (a.edge[x] - b.edge[x]).abs();
        let points = (a.point[x] - b.point[x]).abs();
        let feature = (std::f32::consts::FRAC_1_SQRT_2 * edges.max(points)).powf(FEATURE_EXPONENT);
        colour.powf(1.0 - feature)
    }
}

/// The opponent channels of a band of rows with what lies above and below it, as far as the filters reach.
struct Band {
    width: usize,
    height: usize,
    first_row: usize,
    planes: [Vec<f32>; 3],
}

impl Band {
    fn new(observer: &Observer, picture: Rgb8, start: usize, end: usize) -> Self {
        let (width, height) = (picture.width() as usize, picture.height() as usize);
        let reach = (observer.smooth.len() / 2).max(observer.sensitivity[0][0].0.len() / 2);
        let rows = start.saturating_sub(reach)..(end + reach).min(height);
        let mut planes = [(); 3].map(|()| Vec::with_capacity(rows.len() * width));
        for y in rows.clone() {
            for pixel in picture.row(y) {
                let [red, green, blue, _] = pixel.to_le_bytes();
                let rgb = [red, green, blue].map(|c| observer.linear[usize::from(c)]);
                for (plane, value) in planes.iter_mut().zip(apply(&observer.opponent_of_rgb, rgb)) {
                    plane.push(value);
                }
            }
        }
        Band { width, height, first_row: rows.start, planes }
    }

    /// Filters down the columns around row `y`; rows beyond the picture repeat its first and last.
    fn columns(&self, channel: usize, y: usize, filter: &[f32], out: &mut [f32]) {
        out.fill(0.0);
        let radius = filter.len() / 2;
        for (tap, &weight) in filter.iter().enumerate() {
            let row = (y + tap).saturating_sub(radius).min(self.height - 1) - self.first_row;
            let values = &self.planes[channel][row * self.width..(row + 1) * self.width];
            for (sum, &value) in out.iter_mut().zip(values) {
                *sum += weight * value;
            }
        }
    }
}

/// Buffers for a row between its column and its row filter.
struct Scratch {
    column: Vec<f32>,
    padded: Vec<f32>,
    along: Vec<f32>,
    across: Vec<f32>,
}

impl Scratch {
    fn new(width: usize) -> Self {
        let row = || vec![0.0; width];
        Scratch { column: row(), padded: Vec::new(), along: row(), across: row() }
    }
}

/// Filters along a row and adds to `out`; pixels beyond the picture repeat its first and last.
fn add_along_row(row: &[f32], filter: &[f32], padded: &mut Vec<f32>, out: &mut [f32]) {
    let (radius, width) = (filter.len() / 2, row.len());
    padded.clear();
    padded.resize(radius, row[0]);
    padded.extend_from_slice(row);
    padded.resize(width + 2 * radius, row[width - 1]);
    for (tap, &weight) in filter.iter().enumerate() {
        for (sum, &value) in out.iter_mut().zip(&padded[tap..]) {
            *sum += weight * value;
        }
    }
}

/// What the observer sees of one row of one picture.
struct Seen {
    /// The opponent channels after the contrast sensitivity filters.
    opponent: [Vec<f32>; 3],
    /// Strength of edges and of points.
    edge: Vec<f32>,
    point: Vec<f32>,
}

impl Seen {
    fn new(width: usize) -> Self {
        let row = || vec![0.0; width];
        Seen { opponent: [row(), row(), row()], edge: row(), point: row() }
    }

    fn look(&mut self, observer: &Observer, band: &Band, y: usize, scratch: &mut Scratch) {
        for (channel, out) in self.opponent.iter_mut().enumerate() {
            out.fill(0.0);
            for (along, down) in &observer.sensitivity[channel] {
                band.columns(channel, y, down, &mut scratch.column);
                add_along_row(&scratch.column, along, &mut scratch.padded, out);
            }
        }
        for (detector, out) in [(&observer.edge, &mut self.edge), (&observer.point, &mut self.point)] {
            scratch.along.fill(0.0);
            scratch.across.fill(0.0);
            band.columns(0, y, &observer.smooth, &mut scratch.column);
            add_along_row(&scratch.column, detector, &mut scratch.padded, &mut scratch.along);
            band.columns(0, y, detector, &mut scratch.column);
            add_along_row(&scratch.column, &observer.smooth, &mut scratch.padded, &mut scratch.across);
            for ((strength, &h), &v) in out.iter_mut().zip(&scratch.along).zip(&scratch.across) {
                *strength = (h * h + v * v).sqrt();
            }
        }
    }
}

/// Row and column filters of one channel: each term is a Gaussian, and the two-dimensional sum over all is 1.
fn sensitivity_filters(terms: &[(f64, f64)], radius: i32, pixels_per_degree: f64) -> Vec<(Vec<f32>, Vec<f32>)> {
    let bell = |b: f64| -> Vec<f64> {
        (-radius..=radius).map(|x| (-(PI * f64::from(x) / pixels_per_degree).powi(2) / b).exp()).collect()
    };
    let height = |a: f64, b: f64| a * (PI / b).sqrt();
    let total: f64 = terms.iter().map(|&(a, b)| height(a, b) * bell(b).iter().sum::<f64>().powi(2)).sum();
    let filters = terms.iter().map(|&(a, b)| {
        let along = bell(b).iter().map(|g| (height(a, b) / total * g) as f32).collect();
        (along, bell(b).iter().map(|&g| g as f32).collect())
    });
    filters.collect()
}

/// Scales the positive weights to sum 1 and the negative ones to sum -1.
fn scale_signs_apart(weights: Vec<f64>) -> Vec<f32> {
    let positive: f64 = weights.iter().filter(|w| **w > 0.0).sum();
    let negative: f64 = -weights.iter().filter(|w| **w < 0.0).sum::<f64>();
    weights.iter().map(|&w| (if w > 0.0 { w / positive } else { w / negative.max(f64::MIN_POSITIVE) }) as f32).collect()
}

/// Distance for large colour differences (4.1.3): lightness and chroma added.
fn hyab(a: [f32; 3], b: [f32; 3]) -> f32 {
    let [l, u, v] = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    l.abs() + (u * u + v * v).sqrt()
}

/// The compressive curve of CIE L*a*b*.
fn lab_curve(t: f32) -> f32 {
    const DELTA: f32 = 6.0 / 29.0;
    if t > DELTA * DELTA * DELTA { t.cbrt() } else { t / (3.0 * DELTA * DELTA) + 4.0 / 29.0 }
}

/// The sRGB transfer curve, decoding.
fn srgb_to_linear(v: f64) -> f64 {
    if v <= 0.040_45 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
}

/// Linear sRGB to X, Y, Z over those of white, from the chromaticities of the sRGB standard and, like the evaluator, the
/// white point D65 to five digits.
fn white_relative_xyz() -> Matrix {
    let tristimulus = |x: f64, y: f64| [x / y, 1.0, (1.0 - x - y) / y];
    let [red, green, blue] = [tristimulus(0.64, 0.33), tristimulus(0.30, 0.60), tristimulus(0.15, 0.06)];
    let white = tristimulus(0.31271, 0.32902);
    let primaries: Matrix = std::array::from_fn(|i| [red[i], green[i], blue[i]]);
    // As much of each primary as makes white together.
    let amounts = inverse(primaries).map(|row| row[0] * white[0] + row[1] * white[1] + row[2] * white[2]);
    std::array::from_fn(|i| std::array::from_fn(|j| primaries[i][j] * amounts[j] / white[i]))
}

/// The inverse of a regular matrix, by cofactors.
fn inverse(m: Matrix) -> Matrix {
    // With cyclic indices a cofactor needs no sign.
    let cofactor = |i: usize, j: usize| {
        let (i1, i2, j1, j2) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
        m[i1][j1] * m[i2][j2] - m[i1][j2] * m[i2][j1]
    };
    let determinant: f64 = (0..3).map(|j| m[0][j] * cofactor(0, j)).sum();
    std::array::from_fn(|i| std::array::from_fn(|j| cofactor(j, i) / determinant))
}

fn to_f32(m: Matrix) -> [[f32; 3]; 3] {
    m.map(|row| row.map(|v| v as f32))
}

fn apply(m: &[[f32; 3]; 3], v: [f32; 3]) -> [f32; 3] {
    m.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::known::{self, Made};
    use super::*;

    #[test]
    fn flip_is_that_of_the_evaluator() {
        known::for_each_pair(|pair, reference, test| {
            let ours = flip(reference, test).unwrap();
            assert!((ours.mean - pair.flip_mean).abs() < 1e-5, "{}: {} not {}", pair.name, ours.mean, pair.flip_mean);
            assert!((ours.p99 - pair.flip_p99).abs() < 2e-5, "{}: {} not {}", pair.name, ours.p99, pair.flip_p99);
            // Negative control: the test moved by one column is another picture.
            let moved = Made::new(test.width(), test.height(), |x, y| {
                let [red, green, blue, _] = test.row(y as usize)[((x + 1) % test.width()) as usize].to_le_bytes();
                [red, green, blue].map(u32::from)
            });
            let other = flip(reference, moved.view()).unwrap();
            assert!((other.mean - pair.flip_mean).abs() > 1e-4, "{}: a moved picture measures the same", pair.name);
        });
    }

    #[test]
    fn small_pictures_are_those_of_the_evaluator() {
        for (width, height, mean, p99) in [
            (1, 1, 0.5372331142425537, 0.5372331142425537),
            (3, 2, 0.6152177155017853, 0.9622109532356262),
            (5, 200, 0.5262683769240976, 0.9524431228637695),
        ] {
            let (a, b) = (known::noise(width, height, 1), known::noise(width, height, 2));
            let ours = flip(a.view(), b.view()).unwrap();
            assert!((ours.mean - mean).abs() < 1e-5 && (ours.p99 - p99).abs() < 2e-5, "{width}x{height}: {ours:?}");
        }
    }

    #[test]
    fn black_beside_white_is_that_of_the_evaluator() {
        // White lines on black, the hardest case for the faint tails: 1.1e-4 off without `UNSEEN_LIGHT`.
        let black = Made::new(120, 120, |_, _| [0; 3]);
        let lines = Made::new(120, 120, |x, _| [if x % 14 == 0 { 255 } else { 0 }; 3]);
        let ours = flip(black.view(), lines.view()).unwrap();
        assert!((ours.mean - 0.383_062_884_7).abs() < 6e-5, "{ours:?}");
    }

    #[test]
    fn the_ends_of_the_scale() {
        let fill = |rgb: [u32; 3]| Made::new(40, 37, move |_, _| rgb);
        let (green, blue) = (fill([0, 255, 0]), fill([0, 0, 255]));
        let largest = flip(green.view(), blue.view()).unwrap();
        assert!((largest.mean - 1.0).abs() < 1e-5 && (largest.p99 - 1.0).abs() < 1e-5, "{largest:?}");
        let noise = known::noise(40, 37, 4);
        assert_eq!(flip(noise.view(), noise.view()).unwrap(), Flip { mean: 0.0, p99: 0.0 });
        let white = flip(fill([0; 3]).view(), fill([255; 3]).view()).unwrap();
        assert!((white.mean - 0.967_388).abs() < 1e-5, "{white:?}");
    }

    #[test]
    fn an_error_reaches_as_far_as_the_filters() {
        let clean = Made::new(64, 64, |_, _| [90; 3]);
        let mut spotted = clean.clone();
        spotted.pixels[32 * 64 + 31] = 0xff00_ff00;
        let map = flip_map(clean.view(), spotted.view()).unwrap();
        for (i, &error) in map.iter().enumerate() {
            let (dx, dy) = ((i % 64).abs_diff(31), (i / 64).abs_diff(32));
            assert_eq!(error != 0.0, dx <= 10 && dy <= 10, "({dx}, {dy}) away: {error}");
        }
    }

    #[test]
    fn any_number_of_threads_gives_the_same_bits() {
        let (a, b) = (known::edges(70, 150, 0), known::edges(70, 150, 3));
        let with = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| (flip_map(a.view(), b.view()).unwrap(), super::super::compare(a.view(), b.view()).unwrap()))
        };
        let (map, quality) = with(1);
        for threads in [2, 5] {
            let (other_map, other_quality) = with(threads);
            assert!(map.iter().zip(&other_map).all(|(a, b)| a.to_bits() == b.to_bits()));
            assert_eq!(quality, other_quality);
        }
    }

    #[test]
    fn the_percentile_is_by_nearest_rank() {
        let clean = Made::new(2000, 25, |_, _| [128; 3]);
        let mut dirty = clean.clone();
        let count = clean.pixels.len();
        let wrong = |picture: &Made| {
            let map = flip_map(clean.view(), picture.view()).unwrap();
            map.iter().filter(|&&e| e > 0.0).count()
        };
        // One green pixel spoils 21 x 21 of 50,000, less than 1 %; two spoil more.
        dirty.pixels[12 * 2000 + 1000] = 0xff00_ff00;
        assert!(wrong(&dirty) * 100 <= count);
        assert_eq!(flip(clean.view(), dirty.view()).unwrap().p99, 0.0);
        dirty.pixels[12 * 2000 + 500] = 0xff00_ff00;
        assert!(wrong(&dirty) * 100 > count);
        assert!(flip(clean.view(), dirty.view()).unwrap().p99 > 0.0);
    }
}
