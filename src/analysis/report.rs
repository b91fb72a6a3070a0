// SPDX-License-Identifier: MIT OR Apache-2.0
//! Statistics as JSON objects: the same keys in every command.

use serde_json::{Map, Value, json};

use crate::analysis::compare::Comparison;
use crate::analysis::wave_model::{StageCost, WAVES, WaveModel};
use crate::device::stage::Stage;
use crate::method::options::{Mode, RenderOptions, Test};
use crate::render::frame::{Frame, FrameStats};
use crate::render::renderer::{BuildTimes, Renderer};

/// The statistics of one frame: what `rarefy render` writes.
pub fn render_json(renderer: &mut Renderer, options: &RenderOptions, frame: &Frame, load_ms: f64) -> Value {
    let key = if options.mode == Mode::Full { "full" } else { "adaptive" };
    let mut object = head(renderer, options, load_ms);
    object.insert(key.into(), frame_json(&frame.stats, options.mode));
    object.insert("ray_traced_ratio".into(), json!(frame.stats.ray_traced_ratio()));
    object.insert("ray_traced_ratio_with_correction".into(), json!(frame.stats.ray_traced_ratio_with_correction()));
    object.insert("peak_device_bytes".into(), json!(renderer.peak_device_bytes()));
    Value::Object(object)
}

/// A comparison: what `rarefy compare` writes.
pub fn compare_json(renderer: &mut Renderer, options: &RenderOptions, comparison: &Comparison, load_ms: f64) -> Value {
    let mut object = head(renderer, options, load_ms);
    let quality = &comparison.quality;
    let entries = [
        ("frames", json!(comparison.frames)),
        ("full", frame_json(&comparison.full, Mode::Full)),
        ("adaptive", frame_json(&comparison.adaptive, Mode::Adaptive)),
        ("ray_traced_ratio", json!(comparison.adaptive.ray_traced_ratio())),
        ("ray_traced_ratio_with_correction", json!(comparison.adaptive.ray_traced_ratio_with_correction())),
        ("speedup", number(comparison.speedup)),
        ("work_speedup", number(comparison.work_speedup())),
        ("efficiency", number(comparison.efficiency())),
        ("correction_work_ratio", number(comparison.correction_work_ratio())),
        ("packed_ray_work_ratio", comparison.packed_ray_work_ratio().map_or(Value::Null, number)),
        ("psnr_db", quality.psnr_db.map_or(Value::Null, number)),
        ("psnr_interpolated_db", quality.psnr_interpolated_db.map_or(Value::Null, number)),
        ("ssim", number(quality.ssim)),
        ("flip_mean", number(quality.flip_mean)),
        ("flip_p99", number(quality.flip_p99)),
        ("wrong_object_pixels", json!(comparison.wrong_object.count)),
        ("wrong_object_largest_cluster", json!(comparison.wrong_object.largest_cluster)),
        ("wrong_shadow_pixels", json!(comparison.wrong_shadow.count)),
        ("peak_device_bytes", json!(renderer.peak_device_bytes())),
    ];
    object.extend(entries.map(|(key, value)| (key.to_owned(), value)));
    Value::Object(object)
}

/// The wave model: what `rarefy compare` adds under `wave_model`.
pub fn wave_model_json(model: &WaveModel) -> Value {
    let by_wave = |value: &dyn Fn(usize) -> f64| -> Value {
        WAVES.iter().enumerate().map(|(at, wave)| (wave.to_string(), number(value(at)))).collect::<Map<_, _>>().into()
    };
    let stages = |stages: &[StageCost]| -> Value {
        let stage = |cost: &StageCost| {
            let figures = json!({
                "launches": cost.launches,
                "round_trips": cost.round_trips,
                "lane_steps": number(cost.lanes),
                "wave_steps": by_wave(&|wave| cost.waves[wave]),
                "divergence": by_wave(&|wave| cost.divergence(wave))
            });
            (cost.stage.name().to_owned(), figures)
        };
        stages.iter().map(stage).collect::<Map<_, _>>().into()
    };
    json!({
        "speedup": by_wave(&|wave| model.speedup(wave)),
        "full": stages(&model.full),
        "adaptive": stages(&model.adaptive)
    })
}

fn number(value: f64) -> Value {
    // JSON has no infinity or NaN: such a figure does not exist.
    if value.is_finite() { json!(value) } else { Value::Null }
}

fn head(renderer: &mut Renderer, options: &RenderOptions, load_ms: f64) -> Map<String, Value> {
    let info = renderer.info();
    let BuildTimes { kdtree_ms, upload_ms, program_ms, .. } = renderer.build_times();
    let entries = [
        ("scene", json!(renderer.name())),
        ("triangles", json!(renderer.triangle_count())),
        ("width", json!(options.width)),
        ("height", json!(options.height)),
        ("samples_per_axis", json!(options.samples)),
        ("block", json!(options.method.block)),
        (
            "device",
            json!({"name": info.name, "version": info.version, "backend": info.backend, "profile": info.profile, "lanes": 1}),
        ),
        (
            "build",
            json!({"load_ms": load_ms, "kdtree_ms": kdtree_ms, "upload_ms": upload_ms, "program_ms": program_ms}),
        ),
    ];
    entries.map(|(key, value)| (key.to_owned(), value)).into_iter().collect()
}

fn frame_json(stats: &FrameStats, mode: Mode) -> Value {
    let mut object = Map::new();
    object.insert("frame_ms".into(), json!(stats.frame_ms));
    if let Some(rays) = stats.rays {
        let rays = json!({
            "primary": rays.primary, "shadow": rays.shadow, "reflection": rays.reflection, "refraction": rays.refraction
        });
        object.insert("rays".into(), rays);
    }
    if let Some(work) = stats.work {
        let work = json!({
            "traversal_steps": work.traversal_steps,
            "triangle_tests": work.triangle_tests,
            "shaded_pixels": work.shaded_pixels
        });
        object.insert("work".into(), work);
    }
    if mode == Mode::Adaptive {
        let p = &stats.pixels;
        let pixels =
            json!({"base": p.base, "traced": p.traced, "interpolated": p.interpolated, "corrected": p.corrected});
        object.insert("pixels".into(), pixels);
        let mut stages: Map<String, Value> =
            Stage::ALL.iter().map(|s| (s.name().to_owned(), json!(stats.stages_ms[*s as usize]))).collect();
        stages.insert("other".into(), json!(stats.other_ms()));
        object.insert("stages_ms".into(), Value::Object(stages));
        if let Some(failed) = stats.failed_tests {
            let failed: Map<String, Value> =
                Test::ALL.iter().zip(failed).map(|(t, n)| (t.name().to_owned(), json!(n))).collect();
            object.insert("failed_tests".into(), Value::Object(failed));
        }
        object.insert("fell_back".into(), json!(stats.fell_back));
    }
    Value::Object(object)
}
