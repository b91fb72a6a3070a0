// SPDX-License-Identifier: MIT OR Apache-2.0
//! The tables of docs/method.md: `cargo bench -p rarefy-host-tests --bench method_tables -- [SIZE [PART ...]]`.
//!
//! Draws the scenes of `../shared/scenes` in full and by each variant of the method, SIZE x SIZE pixels (1024 by default),
//! on the CPU twin, and prints rows in Markdown as they are done: means of the six scenes, for some parts each scene.
//! PART is part of a table's name; all by default.
#![allow(clippy::unwrap_used, missing_docs)]

use rarefy::internal::analysis::compare::counted::{Counted, Reference};
use rarefy::internal::analysis::report::figures::Figures;
use rarefy::internal::analysis::report::plan;
use rarefy::internal::device::open::{DeviceChoice, DeviceOptions};
use rarefy::internal::method::options::*;
use rarefy::internal::render::renderer::Renderer;
use rarefy_host_tests::command::root;

const SCENES: [(&str, &str); 6] = [
    ("modern-hall", "hall"),
    ("figures", "figures"),
    ("classroom", "classroom"),
    ("living-room", "living-room"),
    ("bathroom", "bathroom"),
    ("kitchen", "kitchen"),
];

/// A method with what the table calls it.
type Variant = (String, Method);

fn ours(label: &str, change: impl FnOnce(&mut Method)) -> Variant {
    let mut method = Method::balanced();
    change(&mut method);
    (label.to_owned(), method)
}

fn fast(label: &str, change: impl FnOnce(&mut Method)) -> Variant {
    let mut method = Method::fast();
    change(&mut method);
    (label.to_owned(), method)
}

fn scaled(name: &str, method: Method, factor: f32) -> Variant {
    (format!("{name} x {factor}"), plan::scaled(method, factor))
}

fn set_rules(method: &mut Method, thin: bool, gaps: bool, probes: bool) {
    let compared = method.correction.compared().unwrap();
    method.correction = Correction::Converged { compared, thin_only: thin, bridges: gaps, probes };
}

fn tables() -> Vec<(&'static str, Vec<Variant>)> {
    let compare = |label: &str, compared| ours(label, |m| m.correction = m.correction.comparing(compared));
    let conv = |t: f32| ours(&format!("`--t-conv {t}`"), |m| m.checks.fine.t_conv = t);
    let gcol = |t: f32| ours(&format!("display, `--t-gcol {t}`"), |m| m.checks.fine.t_gcol = t);
    let Compared::All { t_norm, t_gcol, .. } = Compared::VISIBLE else { unreachable!() };
    let visible = "object+shadow".parse().unwrap();
    let without_all = ours("without all five", |m| {
        (m.checks.second_pairs, m.checks.textures, m.reuse_shadows) = (false, TextureRule::Border, false);
        set_rules(m, false, false, false);
    });
    let factors = [0.5, 1.0, 1.75, 2.0, 4.0];
    let mut equal: Vec<Variant> = factors.iter().map(|&f| scaled("paper", Method::paper(), f)).collect();
    equal.extend(factors.iter().map(|&f| scaled("ours", Method::balanced(), f)));
    vec![
        ("presets", Preset::ALL.map(|p| (p.to_string(), p.into())).into()),
        ("fast-scaled", [1.0, 1.5, 2.0].map(|factor| scaled("fast", Method::fast(), factor)).into()),
        ("paper", vec![ours("the paper's tolerances in our rules", |m| m.checks.fine = Tolerances::PAPER)]),
        (
            "rules",
            vec![
                ours("all five (default)", |_| ()),
                ours("without second pairs", |m| m.checks.second_pairs = false),
                ours("textures not joined", |m| m.checks.textures = TextureRule::Border),
                ours("every light asked", |m| m.reuse_shadows = false),
                ours("correction at edges and beside lines too", |m| set_rules(m, false, true, true)),
                ours("no correction across gaps", |m| set_rules(m, true, false, true)),
                without_all,
            ],
        ),
        ("flat", [0.0, 0.01, 0.05, 0.1, 0.2].map(conv).into()),
        ("interpolation", vec![ours("`--interpolation plain`", |m| m.interpolation = Interpolation::Plain)]),
        (
            "reflections",
            vec![
                gcol(0.05),
                gcol(0.09),
                gcol(0.15),
                ours("`--gcol-space linear`, 0.05", |m| m.checks.gcol_space = GcolSpace::Linear),
            ],
        ),
        (
            "correction",
            vec![
                ours("`--correction off`", |m| m.correction = Correction::Off),
                compare("`--correction object`", Compared::Object),
                compare("`--correction object+shadow` (paper)", visible),
                compare("`--correction all` (default)", Compared::VISIBLE),
                compare("`all --correction-t-visible 0`", Compared::All { t_visible: 0, t_norm, t_gcol }),
                ours("`all --correction-method sweeps`", |m| m.correction = m.correction.spreading(Spread::Sweeps)),
            ],
        ),
        (
            "coarse",
            vec![
                fast("COARSE + FINE (`fast`)", |_| ()),
                fast("the paper's tolerances at both levels", |m| {
                    m.checks = m.checks.at_all_levels(Tolerances::PAPER);
                }),
                fast("`--correction object+shadow`", |m| m.correction = m.correction.comparing(visible)),
            ],
        ),
        ("equal", equal),
        ("ablation", Test::ALL.map(|test| ours(test.name(), |m| m.checks.tests = m.checks.tests.without(test))).into()),
    ]
}

struct Scene {
    name: &'static str,
    renderer: Renderer,
    reference: Reference,
}

#[derive(Clone, Copy, Default)]
struct Row {
    traced: f64,
    corrected: f64,
    psnr: f64,
    flip: f64,
    flip_p99: f64,
    work: f64,
    correction: f64,
    object: f64,
    cluster: f64,
    shadow: f64,
    packed: f64,
}

impl Row {
    fn print(&self, label: &str) {
        println!(
            "| {label} | {:.4} | {:.4} | {:.2} | {:.4} | {:.2} | {:.1} % | {:.0} | {:.0} |   cluster {:.0}, p99 {:.3}, packed {:.2}",
            self.traced,
            self.corrected,
            self.psnr,
            self.flip,
            self.work,
            100.0 * self.correction,
            self.object,
            self.shadow,
            self.cluster,
            self.flip_p99,
            self.packed
        );
    }

    /// Geometric for shares of traced pixels and for work, the largest cluster, arithmetic for the others.
    fn mean(rows: &[Row]) -> Row {
        let n = rows.len() as f64;
        let mean = |f: fn(&Row) -> f64| rows.iter().map(f).sum::<f64>() / n;
        Row {
            traced: mean(|r| r.traced.ln()).exp(),
            corrected: mean(|r| r.corrected.ln()).exp(),
            psnr: mean(|r| r.psnr),
            flip: mean(|r| r.flip),
            flip_p99: mean(|r| r.flip_p99),
            work: mean(|r| r.work.ln()).exp(),
            correction: mean(|r| r.correction),
            object: mean(|r| r.object),
            cluster: rows.iter().map(|r| r.cluster).fold(0.0, f64::max),
            shadow: mean(|r| r.shadow),
            packed: mean(|r| r.packed),
        }
    }
}

fn options(size: u32, method: Method) -> RenderOptions {
    RenderOptions { width: size, height: size, method, ..RenderOptions::default() }
}

fn load(folder: &str, name: &'static str, size: u32) -> Option<Scene> {
    let path = root().join("../shared/scenes").join(folder);
    if !path.is_dir() {
        println!("skipped: {} is not here", path.display());
        return None;
    }
    let monitor = rarefy::Monitor::default();
    let device = DeviceOptions { device: DeviceChoice::Twin, ..DeviceOptions::default() };
    let mut renderer = rarefy_host_tests::frames::renderer_of(
        &rarefy::internal::scene::load(&path, &monitor).unwrap(),
        &device,
        &monitor,
    )
    .unwrap();
    let reference = Reference::draw(&mut renderer, &options(size, Method::default())).unwrap();
    Some(Scene { name, renderer, reference })
}

fn measure(scene: &mut Scene, size: u32, method: Method) -> Row {
    let options = options(size, method);
    let counted = Counted::draw(&mut scene.renderer, &scene.reference, &options).unwrap();
    let quality = counted.quality_of(&counted.frame.pixels, &scene.reference.frame.pixels, &options).unwrap();
    let f = Figures::new(&scene.reference, &counted, &quality, scene.renderer.triangle_count(), 1, 0.0);
    Row {
        traced: f.traced,
        corrected: f.traced_with_correction,
        psnr: f.psnr_db.unwrap_or(f64::INFINITY),
        flip: f.flip_mean,
        flip_p99: f.flip_p99,
        work: f.work_speedup(),
        correction: f.correction_work(),
        object: f.wrong_object as f64,
        cluster: f.wrong_object_cluster as f64,
        shadow: f.wrong_shadow as f64,
        packed: f.packed_ray.unwrap_or(0.0),
    }
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with("--")).collect();
    let size = words.first().map_or(1024, |word| word.parse().expect("the first argument is the size"));
    let parts = words.get(1..).unwrap_or_default();
    let mut scenes: Vec<Scene> = SCENES.iter().filter_map(|&(folder, name)| load(folder, name, size)).collect();
    for (table, variants) in tables() {
        if !parts.is_empty() && !parts.iter().any(|part| table.contains(part.as_str())) {
            continue;
        }
        println!("\n{table}");
        for (label, method) in variants {
            let rows: Vec<Row> = scenes.iter_mut().map(|scene| measure(scene, size, method)).collect();
            Row::mean(&rows).print(&label);
            if matches!(table, "presets" | "ablation") {
                rows.iter().zip(&scenes).for_each(|(row, scene)| row.print(&format!("{label} {}", scene.name)));
            }
        }
    }
}
