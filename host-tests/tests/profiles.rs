// SPDX-License-Identifier: MIT OR Apache-2.0
//! Every feature runs under every embedded profile, and draws what it draws without one.
#![allow(clippy::unwrap_used, missing_docs)]

use rarefy::builtin;
use rarefy::layers::{self, Layer};
use rarefy::opencl::Profile;
use rarefy::options::{Correction, CorrectionMethod, Interpolation, Mode, RenderOptions};
use rarefy::renderer::{DeviceChoice, Keep, Renderer, RendererOptions};
use rarefy_host_tests::frames::no_opencl;

/// Odd sides, so that work-groups stick out on both.
const WIDTH: u32 = 125;
const HEIGHT: u32 = 93;

fn renderer(profile: Option<&Profile>) -> Renderer {
    let device = DeviceChoice::OpenCl(None);
    let options = RendererOptions { device, profile: profile.cloned(), ..RendererOptions::default() };
    Renderer::new(builtin::to_scene("spheres").unwrap(), &options, &rarefy::Monitor::default()).unwrap()
}

/// Each feature with a name.
fn features() -> Vec<(String, RenderOptions, Keep)> {
    let base = RenderOptions { width: WIDTH, height: HEIGHT, ..RenderOptions::default() };
    let mut features = vec![
        ("full".into(), RenderOptions { mode: Mode::Full, ..base.clone() }, Keep::default()),
        ("adaptive".into(), base.clone(), Keep::default()),
        (
            "the paper's rules".into(),
            RenderOptions { width: WIDTH, height: HEIGHT, ..RenderOptions::paper() },
            Keep::default(),
        ),
        (
            "4 samples an axis".into(),
            RenderOptions { samples: 4, width: 31, height: 23, ..base.clone() },
            Keep::default(),
        ),
        ("one pixel".into(), RenderOptions { width: 1, height: 1, ..base.clone() }, Keep::default()),
    ];
    for block in [2, 4] {
        for correction in [Correction::Off, Correction::Object, Correction::ObjectAndShadow, Correction::All] {
            for correction_method in [CorrectionMethod::Converged, CorrectionMethod::Sweeps] {
                for interpolation in [Interpolation::Perspective, Interpolation::Plain] {
                    let name = format!("blocks {block}, {correction:?}, {correction_method:?}, {interpolation:?}");
                    let options = RenderOptions { block, correction, correction_method, interpolation, ..base.clone() };
                    features.push((name, options, Keep::default()));
                }
            }
        }
    }
    let keep = Keep::EVERYTHING;
    for mode in [Mode::Full, Mode::Adaptive] {
        features.push((format!("layers and counters, {mode:?}"), RenderOptions { mode, ..base.clone() }, keep));
    }
    features
}

/// A feature's name, its pictures, and the counts that went with them.
type Drawn = (String, Vec<Vec<u32>>, String);

/// Everything that a renderer can draw.
fn everything(renderer: &mut Renderer) -> Vec<Drawn> {
    let profile = renderer.info().profile;
    let mut all = Vec::new();
    for (name, options, keep) in features() {
        let at = format!("{profile}, {name}");
        let frame = renderer.render_exactly(&options, keep).unwrap_or_else(|error| panic!("{at}: {error}"));
        let mut pictures = vec![frame.pixels.clone()];
        let stats = &frame.stats;
        let counts = format!("{:?} {:?} {:?} {:?}", stats.pixels, stats.rays, stats.work, stats.failed_tests);
        if keep.counters {
            for layer in Layer::NAMES.map(|name| Layer::from_name(name).unwrap()) {
                if options.mode == Mode::Adaptive || !layer.is_adaptive_only() {
                    pictures
                        .push(layers::draw(layer, renderer, &frame).unwrap_or_else(|error| panic!("{at}: {error}")));
                }
            }
        }
        all.push((name, pictures, counts));
    }
    all
}

/// The names of the features that differ.
fn different(a: &[Drawn], b: &[Drawn]) -> Vec<String> {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).filter(|(a, b)| a != b).map(|(a, _)| a.0.clone()).collect()
}

#[test]
fn every_feature_runs_under_every_profile() {
    if no_opencl() {
        return;
    }
    let free = everything(&mut renderer(None));
    for name in Profile::names() {
        let mut bound = renderer(Some(&Profile::named(name).unwrap()));
        assert_eq!((bound.info().backend, bound.info().profile.as_str()), ("opencl", name));
        assert_eq!(different(&free, &everything(&mut bound)), Vec::<String>::new(), "{name}");
    }
    // The comparison can fail: one bit of one picture.
    let mut changed = free.clone();
    changed[4].1[0][0] ^= 1;
    assert_eq!(different(&free, &changed), ["one pixel"]);
}
