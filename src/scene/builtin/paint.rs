// SPDX-License-Identifier: MIT OR Apache-2.0
//! Painted textures: a small canvas with shapes, noise and a stroke font. Colours are sRGB from 0 to 1.
//!
//! As in [`super::mesh`], only `+ - * /` and square roots are used: every platform paints the same bytes.

use rayon::prelude::*;

use super::mesh::{hash, unit};

/// An sRGB colour, each part from 0 to 1.
pub type Colour = [f32; 3];

/// A picture while it is painted; rows from the top.
#[derive(Debug, Clone)]
pub struct Canvas {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    pixels: Vec<Colour>,
}

/// A mix of two colours: `a` at 0, `b` at 1.
pub fn mix(a: Colour, b: Colour, t: f32) -> Colour {
    let t = t.clamp(0.0, 1.0);
    [0, 1, 2].map(|k| a[k] + (b[k] - a[k]) * t)
}

/// A colour made lighter or darker.
pub fn shade(a: Colour, factor: f32) -> Colour {
    a.map(|v| v * factor)
}

/// A smooth step from 0 at `lo` to 1 at `hi`.
pub fn ramp(lo: f32, hi: f32, x: f32) -> f32 {
    let t = ((x - lo) / (hi - lo)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Smooth noise in `[0, 1]` that repeats after `period` cells in both directions.
pub fn noise(x: f32, y: f32, period: u32, seed: u32) -> f32 {
    let (x0, y0) = (x.floor(), y.floor());
    let (fx, fy) = (ramp(0.0, 1.0, x - x0), ramp(0.0, 1.0, y - y0));
    let p = period.max(1) as i32;
    let at = |i: i32, j: i32| {
        let (i, j) = ((x0 as i32 + i).rem_euclid(p) as u32, (y0 as i32 + j).rem_euclid(p) as u32);
        unit(hash(hash(i.wrapping_add(seed.wrapping_mul(7919))).wrapping_add(j)))
    };
    let top = at(0, 0) + (at(1, 0) - at(0, 0)) * fx;
    let bottom = at(0, 1) + (at(1, 1) - at(0, 1)) * fx;
    top + (bottom - top) * fy
}

/// Noise of four octaves in `[0, 1]` over the unit square; it repeats at the borders.
pub fn clouds(u: f32, v: f32, cells: u32, seed: u32) -> f32 {
    let mut sum = 0.0;
    let (mut weight, mut cells) = (0.5, cells);
    for octave in 0..4 {
        sum += weight * noise(u * cells as f32, v * cells as f32, cells, seed.wrapping_add(octave));
        weight *= 0.5;
        cells *= 2;
    }
    sum / 0.9375
}

impl Canvas {
    /// A canvas whose pixel colours come from `at(u, v)`, with `u` to the right and `v` downwards from 0 to 1.
    pub fn new(width: u32, height: u32, at: impl Fn(f32, f32) -> Colour + Sync) -> Self {
        let mut canvas = Canvas { width, height, pixels: vec![[0.0; 3]; width as usize * height as usize] };
        canvas.paint(|u, v, _| at(u, v));
        canvas
    }

    /// Paints over every pixel, rows on all threads: `how` gets `(u, v)` and the colour so far.
    pub fn paint(&mut self, how: impl Fn(f32, f32, Colour) -> Colour + Sync) {
        self.paint_rows(&how);
    }

    /// One function for all ways to paint: a loop over threads for each is 100 KB of Android's library.
    fn paint_rows(&mut self, how: &(dyn Fn(f32, f32, Colour) -> Colour + Sync)) {
        let (w, h) = (self.width as f32, self.height as f32);
        let rows = self.pixels.par_chunks_exact_mut(self.width.max(1) as usize);
        rows.enumerate().for_each(|(y, row)| {
            for (x, pixel) in row.iter_mut().enumerate() {
                *pixel = how((x as f32 + 0.5) / w, (y as f32 + 0.5) / h, *pixel);
            }
        });
    }

    /// Draws a line with round ends; coordinates and width in parts of the canvas width. `chalk` from 0 to 1 leaves
    /// out grains, as chalk does.
    pub fn line(&mut self, from: (f32, f32), to: (f32, f32), width: f32, colour: Colour, chalk: f32) {
        let scale = self.width as f32;
        let (ax, ay, bx, by) = (from.0 * scale, from.1 * scale, to.0 * scale, to.1 * scale);
        let r = width * scale * 0.5;
        let (dx, dy) = (bx - ax, by - ay);
        let length2 = dx * dx + dy * dy;
        let lo = |a: f32, b: f32| (a.min(b) - r - 1.0).floor().max(0.0) as u32;
        let hi = |a: f32, b: f32, limit: u32| ((a.max(b) + r + 2.0).max(0.0) as u32).min(limit);
        for y in lo(ay, by)..hi(ay, by, self.height) {
            for x in lo(ax, bx)..hi(ax, bx, self.width) {
                let (px, py) = (x as f32 + 0.5 - ax, y as f32 + 0.5 - ay);
                let t = if length2 > 0.0 { ((px * dx + py * dy) / length2).clamp(0.0, 1.0) } else { 0.0 };
                let (ex, ey) = (px - dx * t, py - dy * t);
                let distance = (ex * ex + ey * ey).sqrt();
                let grain = 1.0 - chalk * unit(hash(x.wrapping_mul(9781).wrapping_add(y.wrapping_mul(6271))));
                let cover = (r + 0.5 - distance).clamp(0.0, 1.0) * grain;
                let pixel = &mut self.pixels[(y * self.width + x) as usize];
                *pixel = mix(*pixel, colour, cover);
            }
        }
    }

    /// Draws a path of lines.
    pub fn lines(&mut self, points: &[(f32, f32)], width: f32, colour: Colour, chalk: f32) {
        for pair in points.windows(2) {
            self.line(pair[0], pair[1], width, colour, chalk);
        }
    }

    /// Writes capital letters, digits and a few signs; `height` of a letter and the place of its lower left corner in
    /// parts of the canvas width. Returns where the text ends.
    pub fn text(&mut self, text: &str, at: (f32, f32), height: f32, width: f32, colour: Colour, chalk: f32) -> f32 {
        let mut x = at.0;
        for letter in text.chars() {
            for stroke in glyph(letter).split(' ').filter(|s| !s.is_empty()) {
                let points: Vec<(f32, f32)> = stroke
                    .as_bytes()
                    .chunks_exact(2)
                    .map(|d| {
                        let (gx, gy) = (f32::from(d[0] - b'0'), f32::from(d[1] - b'0'));
                        (x + gx * height / 6.0, at.1 - gy * height / 6.0)
                    })
                    .collect();
                self.lines(&points, width, colour, chalk);
            }
            x += text_width(letter) * height / 6.0;
        }
        x
    }

    /// The width of a text in parts of the canvas width.
    pub fn measure(text: &str, height: f32) -> f32 {
        text.chars().map(|c| text_width(c) * height / 6.0).sum()
    }

    /// The picture as bytes, three a pixel.
    pub fn into_rgb(self) -> Vec<u8> {
        self.pixels.iter().flatten().map(|v| (v.clamp(0.0, 1.0) * 255.0 + 0.5) as u8).collect()
    }
}

/// The advance of a letter in sixths of its height.
fn text_width(letter: char) -> f32 {
    match letter {
        'I' | '1' | '.' | ':' => 3.5,
        ' ' => 3.5,
        _ => 5.5,
    }
}

/// The strokes of a letter: pairs of digits (x from 0 to 4, y from 0 at the base line to 6), strokes apart by
/// blanks. Unknown letters are blank.
fn glyph(letter: char) -> &'static str {
    match letter {
        'A' => "002640 1232",
        'B' => "00063645443303 3342413000",
        'C' => "4536160501103041",
        'D' => "00062644422000",
        'E' => "40000646 0333",
        'F' => "000646 0333",
        'G' => "45361605011030414323",
        'H' => "0006 4046 0343",
        'I' => "1016",
        'J' => "3631201001",
        'K' => "0006 4603 0340",
        'L' => "060040",
        'M' => "0006234640",
        'N' => "00064046",
        'O' => "100105163645413010",
        'P' => "00063645443303",
        'Q' => "100105163645413010 2240",
        'R' => "00063645443303 3340",
        'S' => "453616050413334241301001",
        'T' => "0646 2620",
        'U' => "060110304146",
        'V' => "062046",
        'W' => "0610233046",
        'X' => "0046 0640",
        'Y' => "062320 4623",
        'Z' => "06460040",
        '0' => "100105163645413010",
        '1' => "051610",
        '2' => "05163645440040",
        '3' => "064624344341301001",
        '4' => "30360242",
        '5' => "460604344341301001",
        '6' => "36160501103041423303",
        '7' => "064610",
        '8' => "130405163645443313 1302011030414233",
        '9' => "43130405163645413010",
        '.' => "1010",
        '-' => "1333",
        '\'' => "1615",
        '&' => "40051626350201102042",
        _ => "",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_repeats_at_the_borders_and_stays_in_range() {
        for i in 0..200 {
            let (u, v) = (i as f32 / 31.0, i as f32 / 57.0);
            let here = clouds(u, v, 4, 3);
            assert!((0.0..=1.0).contains(&here));
            assert!((here - clouds(u + 1.0, v, 4, 3)).abs() < 1e-3);
        }
    }

    #[test]
    fn text_leaves_marks_where_it_is_written_and_nowhere_else() {
        let mut canvas = Canvas::new(100, 50, |_, _| [0.0; 3]);
        let end = canvas.text("H1", (0.1, 0.3), 0.2, 0.02, [1.0; 3], 0.0);
        assert!(end > 0.3 && (end - 0.1 - Canvas::measure("H1", 0.2)).abs() < 1e-6);
        let bytes = canvas.into_rgb();
        let row = |y: usize| bytes[y * 300..(y + 1) * 300].iter().any(|&b| b > 128);
        assert!(row(20) && !row(5) && !row(40));
    }

    #[test]
    fn every_letter_s_strokes_lie_within_its_box() {
        for letter in ('A'..='Z').chain('0'..='9').chain(['.', '-', '\'', '&']) {
            assert!(!glyph(letter).is_empty(), "{letter}");
            for d in glyph(letter).bytes().filter(|&b| b != b' ') {
                assert!((b'0'..=b'6').contains(&d), "{letter}");
            }
        }
    }
}
