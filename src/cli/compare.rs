// SPDX-License-Identifier: MIT OR Apache-2.0
//! `rarefy compare`.

use std::path::Path;

use rarefy::internal::analysis::compare::{Comparison, compare};
use rarefy::internal::analysis::layers;
use rarefy::internal::analysis::metrics::{CUSTOMARY_GAIN, Rgb8, difference_picture};
use rarefy::internal::analysis::report::CompareReport;
use rarefy::internal::analysis::wave_model::wave_model;
use rarefy::internal::analysis::wave_model::{LockStep, StageCost, WAVES, WaveModel};
use rarefy::internal::device::stage::Stage;
use rarefy::internal::method::fallback::{does_not_pay, may_lose_detail};
use rarefy::internal::method::options::{Mode, RenderOptions};
use rarefy::internal::render::picture::write_small_png;
use rarefy::internal::render::renderer::Renderer;
use rarefy::{Cancel, Error, Result};

use super::args::CompareArgs;
use super::interrupt::Interrupt;
use super::output::{say, traced, warn_all, write_json};
use super::outputs::Outputs;
use super::progress::{make_renderer, watched};

/// The pictures that are written into the folder.
const PICTURES: [&str; 5] = ["full.png", "adaptive.png", "difference.png", "class.png", "fail-mask.png"];

/// Draws both ways in turn; prints the table, writes pictures and JSON.
pub fn run(args: &CompareArgs, interrupt: &Interrupt) -> Result<()> {
    let options = args.draw.render_options(Mode::Adaptive)?;
    if args.frames == 0 {
        return Err(Error::argument("--frames", "0 frames cannot be timed; at least 1 is needed"));
    }
    let mut outputs = Outputs::of_scene(&args.draw.scene, Path::new(&args.draw.profile));
    outputs.json(args.draw.json.as_deref())?;
    if let Some(folder) = &args.output {
        std::fs::create_dir_all(folder).map_err(|e| Error::io(folder, e))?;
        PICTURES.iter().try_for_each(|name| outputs.picture("-o", &folder.join(name)))?;
    }
    let (mut renderer, load_ms) =
        make_renderer(&args.draw.scene, args.draw.shading, &args.draw.device_options()?, &outputs, interrupt)?;
    let notices = renderer.notices().len();
    let comparison = watched(&mut renderer, interrupt, |renderer| compare(renderer, &options, args.frames))?;
    let waves = if args.wave_model {
        Some(watched(&mut renderer, interrupt, |renderer| wave_model(renderer, &options))?)
    } else {
        None
    };
    warn_all(&renderer.notices()[notices..]);
    let json = args.draw.json.as_deref();
    for line in table(&mut renderer, &options, &comparison) {
        say(json, &line);
    }
    for line in waves.iter().flat_map(wave_table) {
        say(json, &line);
    }
    if let Some(folder) = &args.output {
        for line in interrupt.watch(|cancel| write_pictures(folder, &options, &comparison, cancel))? {
            say(json, &line);
        }
    }
    match json {
        Some(path) => {
            let waves = waves.as_ref();
            write_json(path, &CompareReport::new(&mut renderer, &options, &comparison, waves, load_ms))
        }
        None => Ok(()),
    }
}

fn table(renderer: &mut Renderer, options: &RenderOptions, c: &Comparison) -> Vec<String> {
    let info = renderer.info();
    let decibel = |v: Option<f64>| v.map_or("equal".to_owned(), |db| format!("{db:.2} dB"));
    let (sample_width, sample_height) = options.sample_size();
    let all = f64::from(sample_width) * f64::from(sample_height);
    let p = &c.adaptive.pixels;
    let mut lines = vec![
        format!(
            "{}: {} triangles, {}x{}{}, blocks of {}, on {}",
            renderer.name(),
            renderer.triangle_count(),
            options.width,
            options.height,
            match options.samples {
                1 => String::new(),
                samples => format!(" with {samples}x{samples} samples"),
            },
            options.method.block,
            info.name
        ),
        format!(
            "  frame      full {:.1} ms, adaptive {:.1} ms: {:.2} times as fast",
            c.full.frame_ms, c.adaptive.frame_ms, c.speedup
        ),
        format!("  work       {:.2} times less (traversal steps and triangle tests)", c.work_speedup()),
        format!(
            "  traced     {} (base {:.2} %, failed checks {:.2} %)",
            traced(&c.adaptive),
            100.0 * p.base as f64 / all,
            100.0 * p.traced as f64 / all
        ),
        format!(
            "  quality    PSNR {}, SSIM {:.5}, FLIP mean {:.5}, 99th percentile {:.4}",
            decibel(c.quality.psnr_db),
            c.quality.ssim,
            c.quality.flip_mean,
            c.quality.flip_p99
        ),
        format!(
            "  wrong      object {} pixels (largest cluster {}), shadow {} pixels",
            c.wrong_object.count, c.wrong_object.largest_cluster, c.wrong_shadow.count
        ),
        format!(
            "  packed     a packed ray costs {} average rays; correction {:.1} % of the work",
            c.packed_ray_work_ratio.map_or("-".to_owned(), |r| format!("{r:.2}")),
            100.0 * c.correction_work_ratio()
        ),
    ];
    let stages = Stage::ALL.map(|s| format!("{} {:.1}", s.name(), c.adaptive.stages_ms[s as usize])).join("  ");
    lines.push(format!("  stages/ms  {stages}  other {:.1}", c.adaptive.other_ms()));
    if may_lose_detail(p) {
        lines.push("  falls back by its own counters: `rarefy render` draws this frame in full".to_owned());
    } else if does_not_pay(p) {
        lines.push("  falls back by its own counters: following frames would be traced in full".to_owned());
    }
    lines
}

/// Divergence by stage and the modelled speedup, for each size of waves, where lanes wait for each other after each loop and
/// where they wait at the end of an item.
fn wave_table(model: &WaveModel) -> Vec<String> {
    let heads = WAVES.map(|wave| format!("{:>13} {:>10}", format!("{wave}: cost/M"), "divergence")).concat();
    let mut lines = vec!["  waves of lanes in lock step (traversal steps; launches included)".to_owned()];
    for lock_step in LockStep::ALL {
        let row = |name: &str, cost: &StageCost| {
            let share =
                |wave| format!("{:>13.1} {:>10.2}", cost.cost(lock_step, wave) / 1e6, cost.divergence(lock_step, wave));
            format!("  {name:15}{}{}{}", share(0), share(1), share(2))
        };
        lines.push(format!("  {:15}{heads}", lock_step.name()));
        lines.extend(model.full.iter().map(|cost| row("full step1", cost)));
        lines.extend(model.adaptive.iter().map(|cost| row(cost.stage.name(), cost)));
        let speedups = [0, 1, 2].map(|wave| format!("{:>13.2} {:>10}", model.speedup(lock_step, wave), "")).concat();
        lines.push(format!("  {:15}{}", "speedup", speedups.trim_end()));
    }
    lines
}

fn write_pictures(folder: &Path, options: &RenderOptions, c: &Comparison, cancel: &Cancel) -> Result<Vec<String>> {
    let frame = &c.adaptive_frame;
    let (width, height) = (frame.width, frame.height);
    let reference = Rgb8::new(width, height, &c.full_picture)?;
    let test = Rgb8::new(width, height, &frame.pixels)?;
    let samples = options.sample_size();
    let pictures = [
        ((width, height), c.full_picture.clone()),
        ((width, height), frame.pixels.clone()),
        ((width, height), difference_picture(reference, test, CUSTOMARY_GAIN)?),
        (samples, layers::class_picture(&c.classes)),
        (samples, layers::fail_mask_picture(&c.classes)),
    ];
    let mut lines = Vec::new();
    for (name, ((width, height), pixels)) in PICTURES.into_iter().zip(pictures) {
        let path = folder.join(name);
        cancel.check()?;
        write_small_png(&path, width, height, &pixels)?;
        lines.push(path.display().to_string());
    }
    Ok(lines)
}
