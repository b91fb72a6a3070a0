// SPDX-License-Identifier: MIT OR Apache-2.0
//! `rarefy diff`.

use rarefy::Result;
use rarefy::internal::analysis::metrics::{CUSTOMARY_GAIN, Rgb8, compare, difference_picture};
use rarefy::internal::render::picture::{read_rgb8, write_small_png};
use serde::Serialize;

use super::args::DiffArgs;
use super::output::{say, write_json};
use super::outputs::Outputs;

/// The figures of two pictures. There is no mask of interpolated pixels for two files.
#[derive(Serialize)]
struct DiffReport {
    psnr_db: Option<f64>,
    ssim: f64,
    flip_mean: f64,
    flip_p99: f64,
    width: u32,
    height: u32,
}

/// Measures two pictures; writes the difference and the figures.
pub fn run(args: &DiffArgs) -> Result<()> {
    let mut outputs = Outputs::of_inputs([args.reference.as_path(), &args.test]);
    if let Some(path) = &args.output {
        outputs.picture("-o", path)?;
    }
    outputs.json(args.json.as_deref())?;
    let (width, height, reference) = read_rgb8(&args.reference)?;
    let (test_width, test_height, test) = read_rgb8(&args.test)?;
    let reference = Rgb8::new(width, height, &reference)?;
    let test = Rgb8::new(test_width, test_height, &test)?;
    let quality = compare(reference, test)?;
    if let Some(path) = &args.output {
        write_small_png(path, width, height, &difference_picture(reference, test, CUSTOMARY_GAIN)?)?;
    }
    let json = args.json.as_deref();
    let psnr = quality.psnr_db.map_or("equal pictures".to_owned(), |db| format!("{db:.2} dB"));
    say(
        json,
        &format!(
            "PSNR {psnr}, SSIM {:.5}, FLIP mean {:.5}, 99th percentile {:.4}",
            quality.ssim, quality.flip_mean, quality.flip_p99
        ),
    );
    match json {
        Some(path) => write_json(
            path,
            &DiffReport {
                psnr_db: quality.psnr_db,
                ssim: quality.ssim,
                flip_mean: quality.flip_mean,
                flip_p99: quality.flip_p99,
                width,
                height,
            },
        ),
        None => Ok(()),
    }
}
