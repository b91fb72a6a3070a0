// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pairs of pictures with known measures.
//!
//! The pictures follow integer formulas, so that the same ones could be made in Python, where scikit-image 0.26.0 gave
//! PSNR (`data_range=255`) and SSIM (settings in [`super::ssim`]), and flip-evaluator 1.7 gave FLIP (LDR, default
//! viewing conditions): the mean of its error map, and of its sorted values the one at rank ceil(0.99 n).

use super::Rgb8;

/// What the reference programs say of a pair.
pub struct Known {
    pub name: &'static str,
    pub psnr_db: f64,
    pub ssim: f64,
    pub flip_mean: f64,
    pub flip_p99: f64,
}

/// A picture that owns its pixels.
#[derive(Clone)]
pub struct Made {
    pub width: u32,
    pub height: u32,
    pub pixels: Vec<u32>,
}

impl Made {
    pub fn new(width: u32, height: u32, pixel: impl Fn(u32, u32) -> [u32; 3]) -> Self {
        let words = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let pixels = words.map(|(x, y)| pixel(x, y).iter().rev().fold(0xff, |word, c| word << 8 | c & 255));
        Made { width, height, pixels: pixels.collect() }
    }

    pub fn view(&self) -> Rgb8<'_> {
        Rgb8 { width: self.width, height: self.height, pixels: &self.pixels }
    }
}

fn hash(value: u32) -> u32 {
    let mut v = value.wrapping_mul(2_654_435_761);
    v ^= v >> 15;
    v = v.wrapping_mul(2_246_822_519);
    v ^ v >> 13
}

pub fn noise(width: u32, height: u32, seed: u32) -> Made {
    Made::new(width, height, |x, y| {
        let v = hash(x + y * width + seed * 1_000_003);
        [v, v >> 8, v >> 16]
    })
}

pub fn gradient(width: u32, height: u32, shift: u32) -> Made {
    Made::new(width, height, |x, y| {
        [x * 255 / width, y * 255 / height, (x + y + shift) * 255 / (width + height + shift)]
    })
}

pub fn edges(width: u32, height: u32, shift: u32) -> Made {
    Made::new(width, height, |x, y| {
        let (c, d) = (((x + shift) / 8 + y / 8) % 2, (x + shift + y) / 13 % 3);
        [40 + 170 * c, 60 + 50 * d, 220 - 90 * c - 40 * d]
    })
}

/// Adds noise of at most `amplitude` to each channel.
pub fn jitter(picture: &Made, seed: u32, amplitude: u32) -> Made {
    Made::new(picture.width, picture.height, |x, y| {
        let i = x + y * picture.width;
        let v = hash(i + seed * 1_000_003);
        [0, 8, 16].map(|shift| {
            let channel = picture.pixels[i as usize] >> shift & 255;
            (channel + (v >> shift) % (2 * amplitude + 1)).saturating_sub(amplitude).min(255)
        })
    })
}

/// Inverts single pixels on a grid.
pub fn dots(picture: &Made) -> Made {
    let mut made = picture.clone();
    for (i, pixel) in made.pixels.iter_mut().enumerate() {
        let (x, y) = (i as u32 % picture.width, i as u32 / picture.width);
        if x % 17 == 5 && y % 13 == 7 {
            *pixel ^= 0x00ff_ffff;
        }
    }
    made
}

/// Calls `check` with each pair, reference first.
pub fn for_each_pair(check: impl Fn(&Known, Rgb8, Rgb8)) {
    let run = |a: Made, b: Made, name, [psnr_db, ssim, flip_mean, flip_p99]: [f64; 4]| {
        check(&Known { name, psnr_db, ssim, flip_mean, flip_p99 }, a.view(), b.view());
    };
    run(
        noise(64, 48, 1),
        noise(64, 48, 2),
        "noise",
        [7.754652134887521, 0.037003373691712894, 0.4511310945272271, 0.8289268016815186],
    );
    run(
        gradient(61, 47, 0),
        gradient(61, 47, 9),
        "gradient",
        [32.24886518704694, 0.999846801959756, 0.12605713457479828, 0.16823244094848633],
    );
    run(
        edges(80, 40, 0),
        edges(80, 40, 1),
        "shifted edges",
        [15.695979048103563, 0.6597547751471203, 0.2397113426530268, 0.6141683459281921],
    );
    let smooth = gradient(50, 70, 3);
    run(
        smooth.clone(),
        jitter(&smooth, 5, 2),
        "faint noise",
        [45.17439968443541, 0.9913614688370171, 0.02157711364984113, 0.05273875966668129],
    );
    let sharp = edges(33, 90, 2);
    run(
        sharp.clone(),
        jitter(&sharp, 6, 30),
        "noisy edges",
        [23.19874309806221, 0.822727615981821, 0.13120125849866104, 0.2734982669353485],
    );
    let smooth = gradient(70, 70, 1);
    run(
        smooth.clone(),
        dots(&smooth),
        "dots",
        [29.972749948854435, 0.88778089861759, 0.02181370188291019, 0.33352896571159363],
    );
    let thin = noise(64, 11, 3);
    run(
        thin.clone(),
        jitter(&thin, 1, 9),
        "thin",
        [33.31825080995742, 0.9965877431785525, 0.06759668716602557, 0.1571362167596817],
    );
}
