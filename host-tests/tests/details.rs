// SPDX-License-Identifier: MIT OR Apache-2.0
//! How much of detail at the limits of undersampling is seen. docs/method.md has the table, which
//! `cargo test -p rarefy-host-tests --test details -- --nocapture` prints.
#![allow(clippy::unwrap_used)]

use rarefy::internal::analysis::metrics::{self, Rgb8};
use rarefy::internal::layout::PLANE_OBJECT;
use rarefy::internal::method::counts::Keep;
use rarefy::internal::method::fallback::{does_not_pay, may_lose_detail};
use rarefy::internal::method::options::{Correction, Method, Mode, RenderOptions, TextureRule};
use rarefy::{Frame, Scene};
use rarefy_host_tests::details::{SIDE, scenes};
use rarefy_host_tests::fixtures::{draw, twin_renderer};

/// What undersampling still loses, with the decibels that are left in blocks of 2 and 4: docs/method.md says why.
const LOST: [(&str, [f64; 2]); 1] = [("hair", [27.5, 25.5])];

/// Decibels in blocks of 2 and of 4, infinite where the frame's own counters make it full.
fn measure(name: &str, scene: Scene, change: impl Fn(&mut Method)) -> [f64; 2] {
    let mut renderer = twin_renderer(scene);
    let options = |mode, method| RenderOptions { width: SIDE, height: SIDE, mode, method, ..RenderOptions::default() };
    let full = draw(&mut renderer, &options(Mode::Full, Method::balanced()));
    let objects = renderer.plane(PLANE_OBJECT).unwrap();
    let mut row = format!("| {name} |");
    let decibels = [Method::balanced(), Method::fast()].map(|mut method| {
        change(&mut method);
        let frame = draw(&mut renderer, &options(Mode::Adaptive, method));
        let picture = |pixels| Rgb8::new(SIDE, SIDE, pixels).unwrap();
        let psnr = metrics::psnr(picture(&full.pixels), picture(&frame.pixels)).unwrap();
        let wrong = metrics::wrong_pixels(&objects, &renderer.plane(PLANE_OBJECT).unwrap(), SIDE, SIDE).unwrap();
        let stats = &frame.stats;
        let falls_back = may_lose_detail(&stats.pixels) || does_not_pay(&stats.pixels);
        row += &format!(
            " {:.3} | {:.3} | {}{} | {} |",
            stats.ray_traced_ratio(),
            stats.ray_traced_ratio_with_correction(),
            psnr.map_or("same".into(), |db| format!("{db:.1}")),
            match (may_lose_detail(&stats.pixels), falls_back) {
                (true, _) => ", so full",
                (false, true) => ", then full",
                _ => "",
            },
            wrong.count
        );
        if falls_back { f64::INFINITY } else { psnr.unwrap_or(f64::INFINITY) }
    });
    println!("{row}");
    decibels
}

#[test]
fn fine_detail_is_seen_or_the_method_gives_way() {
    for (name, scene) in scenes() {
        let found = measure(&name, scene, |_| ());
        let least = LOST.iter().find(|(lost, _)| *lost == name).map_or([30.0, 28.0], |(_, least)| *least);
        assert!((0..2).all(|k| found[k] >= least[k]), "{name}: {found:?} instead of {least:?} dB");
    }
}

#[test]
fn a_frame_that_lost_detail_is_drawn_in_full() {
    let (_, scene) = scenes().into_iter().find(|(name, _)| name == "fence at 30 degrees").unwrap();
    let mut renderer = twin_renderer(scene);
    let options = |mode| RenderOptions { width: SIDE, height: SIDE, mode, ..RenderOptions::default() };
    let full = renderer.render(&options(Mode::Full), Keep::COUNTERS).unwrap();
    let adaptive = renderer.render_exactly(&options(Mode::Adaptive), Keep::COUNTERS).unwrap();
    assert!(may_lose_detail(&adaptive.stats.pixels) && adaptive.pixels != full.pixels);
    // The cost is that of both; of the following frames that of full tracing.
    let work = |frame: &Frame| frame.stats.work.unwrap().traversal();
    for cost in [work(&full) + work(&adaptive), work(&full)] {
        let frame = renderer.render(&options(Mode::Adaptive), Keep::COUNTERS).unwrap();
        assert!(frame.stats.fell_back && frame.pixels == full.pixels);
        assert_eq!(work(&frame), cost);
    }
}

fn probes_off(method: &mut Method) {
    if let Correction::Converged { probes, .. } = &mut method.correction {
        *probes = false;
    }
}

/// Control: each rule finds something that is lost without it.
#[test]
fn without_a_rule_its_details_are_lost() {
    type Change = fn(&mut Method);
    // Probes would find most of a lone wire too.
    let rules: [(&str, Change, Change); 4] = [
        ("one wire", probes_off, |m| m.shifted_rows = false),
        ("slats on odd rows", |_| (), probes_off),
        ("checks of 1 pixel behind a pane", |_| (), |m| m.checks.secondary_textures = false),
        (
            "floor to the horizon",
            |_| (),
            |m| {
                m.checks.textures = TextureRule::Border;
                (m.checks.fine.t_tex, m.checks.coarse.t_tex) = (0.3, 0.3);
            },
        ),
    ];
    for (name, base, off) in rules {
        let (_, scene) = scenes().into_iter().find(|(other, _)| other == name).unwrap();
        let with = measure(name, scene.clone(), base);
        let without = measure(name, scene, |method| {
            base(method);
            off(method);
        });
        assert!(without.iter().zip(with).any(|(without, with)| without + 10.0 < with), "{name}: {without:?}");
    }
}
