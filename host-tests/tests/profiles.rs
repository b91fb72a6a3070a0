// SPDX-License-Identifier: MIT OR Apache-2.0
//! Every feature runs under every embedded profile, and draws what it draws without one.
#![allow(clippy::unwrap_used, missing_docs)]

use std::collections::HashMap;

use rarefy::internal::analysis::layers::{self, Layer};
use rarefy::internal::device::open::{DeviceChoice, DeviceOptions};
use rarefy::internal::device::opencl::Profile;
use rarefy::internal::layout::Traversal;
use rarefy::internal::method::counts::Keep;
use rarefy::internal::method::options::{Interpolation, Method, Mode, RenderOptions};
use rarefy::internal::render::renderer::Renderer;
use rarefy::internal::scene::builtin;
use rarefy_host_tests::fixtures::{blocks, corrections};
use rarefy_host_tests::frames::{no_opencl, renderer_of, walking_by};

/// Odd sides, so that work-groups stick out on both.
const WIDTH: u32 = 125;
const HEIGHT: u32 = 93;

fn renderer(profile: Option<&Profile>) -> Renderer {
    let device = DeviceChoice::OpenCl(None);
    let options = DeviceOptions { device, profile: profile.cloned(), ..DeviceOptions::default() };
    renderer_of(&builtin::to_scene("spheres").unwrap(), &options, &rarefy::Monitor::default()).unwrap()
}

/// Each feature with a name.
fn features() -> Vec<(String, RenderOptions, Keep)> {
    let base = RenderOptions { width: WIDTH, height: HEIGHT, ..RenderOptions::default() };
    let mut features = vec![
        ("full".into(), RenderOptions { mode: Mode::Full, ..base.clone() }, Keep::default()),
        ("adaptive".into(), base.clone(), Keep::default()),
        ("the paper's rules".into(), RenderOptions { method: Method::paper(), ..base.clone() }, Keep::default()),
        (
            "4 samples an axis".into(),
            RenderOptions { samples: 4, width: 31, height: 23, ..base.clone() },
            Keep::default(),
        ),
        ("one pixel".into(), RenderOptions { width: 1, height: 1, ..base.clone() }, Keep::default()),
    ];
    for block in [2, 4] {
        for correction in corrections() {
            for interpolation in Interpolation::ALL {
                let name = format!("blocks {block}, {correction}, {interpolation}");
                let method = Method { correction, interpolation, ..blocks(block) };
                features.push((name, RenderOptions { method, ..base.clone() }, Keep::default()));
            }
        }
    }
    let keep = Keep::EVERYTHING;
    for mode in [Mode::Full, Mode::Adaptive] {
        features.push((format!("layers and counters, {mode:?}"), RenderOptions { mode, ..base.clone() }, keep));
    }
    features
}

/// What a feature drew.
#[derive(Debug, Clone, PartialEq)]
struct Drawn {
    name: String,
    pictures: Vec<Vec<u32>>,
    /// All but the steps.
    counts: String,
    /// Traversal steps, and the layer that shows them: they depend on the way of walking.
    steps: (Option<u64>, Vec<u32>),
}

/// Everything that a renderer can draw.
fn everything(renderer: &mut Renderer) -> Vec<Drawn> {
    let profile = renderer.info().profile;
    let mut all = Vec::new();
    for (name, options, keep) in features() {
        let at = format!("{profile}, {name}");
        let frame = renderer.render_exactly(&options, keep).unwrap_or_else(|error| panic!("{at}: {error}"));
        let mut pictures = vec![frame.pixels.clone()];
        let stats = &frame.stats;
        let tests = stats.work.map(|work| (work.triangle_tests, work.shaded_pixels));
        let counts = format!("{:?} {:?} {tests:?} {:?}", stats.pixels, stats.rays, stats.failed_tests);
        let mut steps = (stats.work.map(|work| work.traversal_steps), Vec::new());
        if keep.counters {
            for layer in Layer::ALL {
                if options.mode == Mode::Adaptive || !layer.is_adaptive_only() {
                    let drawn = layers::draw(layer, renderer, &frame).unwrap_or_else(|error| panic!("{at}: {error}"));
                    if layer == Layer::Rays { steps.1 = drawn } else { pictures.push(drawn) }
                }
            }
        }
        all.push(Drawn { name, pictures, counts, steps });
    }
    all
}

/// The names of the features that differ.
fn different(a: &[Drawn], b: &[Drawn]) -> Vec<String> {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).filter(|(a, b)| a != b).map(|(a, _)| a.name.clone()).collect()
}

#[test]
fn every_feature_runs_under_every_profile() {
    if no_opencl() {
        return;
    }
    let free = everything(&mut renderer(None));
    let mut walking: HashMap<Traversal, Vec<Drawn>> = HashMap::new();
    for name in Profile::names() {
        let profile = Profile::named(name).unwrap();
        // The same walk without the limits.
        let traversal = profile.choices().traversal();
        let free = walking.entry(traversal).or_insert_with(|| {
            let drawn = everything(&mut renderer(walking_by(traversal).profile.as_ref()));
            let counted = free.iter().filter(|drawn| drawn.steps.0.is_some()).map(|drawn| drawn.name.clone());
            assert_eq!(different(&free, &drawn), counted.collect::<Vec<_>>(), "{}", traversal.name());
            let alike: Vec<Drawn> =
                drawn.iter().zip(&free).map(|(a, b)| Drawn { steps: b.steps.clone(), ..a.clone() }).collect();
            assert_eq!(different(&free, &alike), Vec::<String>::new(), "{}, but for the steps", traversal.name());
            drawn
        });
        let mut bound = renderer(Some(&profile));
        assert_eq!((bound.info().backend, bound.info().profile.as_str()), ("opencl", name));
        assert_eq!(different(free, &everything(&mut bound)), Vec::<String>::new(), "{name}");
    }
    assert_eq!(walking.len(), 2, "a short stack and none");
    // The comparison can fail: one bit of one picture.
    let mut changed = free.clone();
    changed[4].pictures[0][0] ^= 1;
    assert_eq!(different(&free, &changed), ["one pixel"]);
}
