// SPDX-License-Identifier: MIT OR Apache-2.0
//! The wave model says the same of a frame on every executor, and profiles do not change the picture.
#![allow(clippy::unwrap_used, missing_docs)]

use rarefy::internal::analysis::wave_model::wave_model;
use rarefy::internal::device::open::{DeviceChoice, DeviceOptions};
use rarefy::internal::device::profiles::Profile;
use rarefy::internal::device::stage::Stage;
use rarefy::internal::layout::Traversal;
use rarefy::internal::method::counts::Keep;
use rarefy::internal::method::options::{Mode, RenderOptions};
use rarefy::internal::render::renderer::Renderer;
use rarefy::internal::scene::builtin;
use rarefy_host_tests::fixtures::with;
use rarefy_host_tests::frames::{no_opencl, renderer_of, walking_by};

fn renderer(device: DeviceChoice, profile: Option<Profile>) -> Renderer {
    let options = DeviceOptions { device, profile, strict: true, ..DeviceOptions::default() };
    renderer_of(&builtin::to_scene("spheres").unwrap(), &options, &rarefy::Monitor::default()).unwrap()
}

fn options() -> RenderOptions {
    RenderOptions { width: 120, height: 90, ..RenderOptions::default() }
}

#[test]
fn both_back_ends_and_profiles_agree() {
    let mut twin = renderer(DeviceChoice::Twin, None);
    let expected = wave_model(&mut twin, &options()).unwrap();
    let picture = twin.render_exactly(&options(), Keep::default()).unwrap().pixels;
    assert_eq!(expected.full.len(), 1);
    assert_eq!(expected.adaptive.len(), Stage::ALL.len());
    // What the counters say must be in the sum: the lanes' steps are at least the traversal steps of the frame.
    let full = RenderOptions { mode: Mode::Full, ..options() };
    let work = twin.render_exactly(&full, Keep::COUNTERS).unwrap().stats.work.unwrap();
    assert!(expected.full[0].lanes > (work.traversal_steps + work.triangle_tests) as f64);
    // Base pixels cost about the same in whichever columns they lie.
    let base = |shifted: bool| {
        let options = with(&options(), |method| method.shifted_rows = shifted);
        let mut renderer = renderer(DeviceChoice::Twin, None);
        wave_model(&mut renderer, &options).unwrap().adaptive[Stage::Step1 as usize].lanes
    };
    assert!((0.95..1.05).contains(&(base(true) / base(false))), "{} and {}", base(true), base(false));
    for cost in expected.full.iter().chain(&expected.adaptive) {
        for (item, at) in cost.by_item.into_iter().zip(cost.by_loop) {
            // Who waits more often waits no less; and nobody does less than nothing.
            assert!(cost.lanes <= 1.001 * item && item <= 1.001 * at, "{cost:?}");
        }
    }
    if no_opencl() {
        return;
    }
    let on_device = |profile| {
        let mut device = renderer(DeviceChoice::OpenCl(None), profile);
        assert!(device.render_exactly(&options(), Keep::default()).unwrap().pixels == picture);
        wave_model(&mut device, &options()).unwrap()
    };
    assert_eq!(on_device(None), expected);
    // The phone walks with a short stack and repeats some steps; its limits change nothing.
    let phone = on_device(Some(Profile::named("adreno-420").unwrap()));
    assert_eq!(phone, on_device(walking_by(Traversal::ShortStack).profile));
    for (cost, of) in phone.full.iter().chain(&phone.adaptive).zip(expected.full.iter().chain(&expected.adaptive)) {
        assert_eq!((cost.stage, cost.launches, cost.round_trips), (of.stage, of.launches, of.round_trips));
        assert!((1.0..1.1).contains(&(cost.lanes / of.lanes)), "{cost:?}, not {of:?}");
    }
    assert!(phone.full[0].lanes > expected.full[0].lanes);
    // Mirrors and glass have loops that others wait through.
    assert!(expected.full[0].by_loop[1] > 1.05 * expected.full[0].by_item[1], "{:?}", expected.full[0]);
    // Negative control: another frame is another model.
    let other = with(&options(), |method| method.correction = rarefy::internal::method::options::Correction::Off);
    assert_ne!(wave_model(&mut twin, &other).unwrap(), expected);
}

#[test]
fn a_frame_in_bands_has_no_model() {
    let limited =
        DeviceOptions { device: DeviceChoice::Twin, memory_budget_bytes: Some(2 << 20), ..DeviceOptions::default() };
    let mut renderer =
        renderer_of(&builtin::to_scene("spheres").unwrap(), &limited, &rarefy::Monitor::default()).unwrap();
    let large = RenderOptions { width: 500, height: 400, ..RenderOptions::default() };
    let error = wave_model(&mut renderer, &large).unwrap_err().to_string();
    assert!(error.contains("wave model") && error.contains("memory_budget"), "{error}");
}
