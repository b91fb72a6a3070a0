// SPDX-License-Identifier: MIT OR Apache-2.0
//! Packed pixels send shadow rays only to lights about which their references disagree: which pixels, to which lights,
//! and that pictures in which nothing hides between references do not change.
#![allow(clippy::unwrap_used)]

use glam::{Vec2, Vec3};
use rarefy::internal::layout::*;
use rarefy::internal::method::counts::Keep;
use rarefy::internal::method::options::{Mode, RenderOptions};
use rarefy::internal::render::frame::Frame;
use rarefy::internal::render::renderer::Renderer;
use rarefy::internal::scene::Scene;
use rarefy_host_tests::fixtures::*;

const SIDE: u32 = 48;

fn adaptive(reuse_shadows: bool) -> RenderOptions {
    with(&options(Mode::Adaptive, SIDE, SIDE, 2), |method| method.reuse_shadows = reuse_shadows)
}

fn render(renderer: &mut Renderer, options: &RenderOptions) -> Frame {
    renderer.render_exactly(options, Keep::EVERYTHING).unwrap()
}

/// For each packed pixel that has references: its failed tests, and its shadow rays without and with what is known.
fn shadow_rays(scene: Scene) -> Vec<(u32, u32, u32)> {
    let mut renderer = twin_renderer(scene);
    let plain = render(&mut renderer, &adaptive(false));
    let classes = renderer.plane(PLANE_CLASS).unwrap();
    let without = renderer.counter_plane(COUNTER_SHADOW_RAYS).unwrap();
    let reusing = render(&mut renderer, &adaptive(true));
    assert_eq!(renderer.plane(PLANE_CLASS).unwrap(), classes);
    assert!(reusing.pixels == plain.pixels, "a picture without hidden shadows changed");
    let with = renderer.counter_plane(COUNTER_SHADOW_RAYS).unwrap();
    let at = |i: usize| (classes[i] & FAIL_ALL, without[i], with[i]);
    let is_packed = |i: &usize| classes[*i] & CLASS_MASK == CLASS_TRACED && classes[*i] & FAIL_ALL != 0;
    for i in (0..classes.len()).filter(|i| !is_packed(i)) {
        assert_eq!(without[i], with[i], "pixel {i} is base, interpolated or at the border");
    }
    (0..classes.len()).filter(is_packed).map(at).collect()
}

/// A wall under three lights. A screen that the camera does not see keeps the first light from the left half.
fn half_shadow() -> SceneBuilder {
    let mut builder = SceneBuilder::new("half-shadow").camera(v(0.0, 0.0, 3.0), v(0.0, 0.0, 0.0), 40.0);
    builder = builder.light(v(-6.0, 0.1, 2.0), 20.0).light(v(0.2, 0.3, 3.0), 4.0).light(v(4.0, 3.0, 3.0), 6.0);
    builder.object(matte(v(0.8, 0.8, 0.8)));
    builder.wall(Vec2::splat(-9.0), Vec2::splat(9.0), 0.0);
    builder.object(matte(Vec3::ONE));
    builder.quad([v(-3.0, -9.0, -1.0), v(-3.0, 9.0, -1.0), v(-3.0, 9.0, 1.9), v(-3.0, -9.0, 0.1)]);
    builder
}

#[test]
fn at_the_edge_of_a_shadow_only_the_light_in_doubt_is_asked() {
    let rays = shadow_rays(half_shadow().build(40.0));
    let at_edge: Vec<_> = rays.iter().filter(|ray| ray.0 == FAIL_SH).collect();
    assert!(at_edge.len() > 20, "{} pixels say little", at_edge.len());
    for &&(_, without, with) in &at_edge {
        assert_eq!((without, with), (3, 1));
    }
}

#[test]
fn where_only_the_reflection_is_in_doubt_the_mirror_itself_asks_no_light() {
    // The camera looks into a mirror that shows two walls behind it, of one light each side of the eye.
    let mut builder = SceneBuilder::new("mirror").camera(v(0.0, 0.0, 3.0), v(0.0, 0.0, 0.0), 40.0);
    builder = builder.light(v(0.5, 1.0, 4.0), 20.0).light(v(-0.5, 1.0, 4.0), 10.0);
    builder.object(mirror(0.6));
    builder.wall(Vec2::splat(-9.0), Vec2::splat(9.0), 0.0);
    for (x, colour) in [(-9.0, v(0.8, 0.1, 0.1)), (0.13, v(0.1, 0.1, 0.8))] {
        builder.object(matte(colour));
        builder.wall(glam::vec2(x, -9.0), glam::vec2(x + 9.13, 9.0), 6.0);
    }
    let rays = shadow_rays(builder.build(40.0));
    let doubtful: Vec<_> = rays.iter().filter(|ray| ray.0 == FAIL_GC).collect();
    assert!(doubtful.len() > 20, "{} pixels say little", doubtful.len());
    for &&(_, without, with) in &doubtful {
        // Two from the mirror, two from the wall that it shows.
        assert_eq!((without, with), (4, 2));
    }
}

#[test]
fn at_folds_and_between_objects_every_light_is_asked() {
    let mut builder = half_shadow();
    builder.object(matte(v(0.2, 0.7, 0.3)));
    builder.block(v(-0.3, -0.3, 0.0), v(0.4, 0.35, 0.5));
    let rays = shadow_rays(builder.build(40.0));
    let geometric: Vec<_> = rays.iter().filter(|ray| ray.0 & (FAIL_G1 | FAIL_G3) != 0).collect();
    assert!(geometric.len() > 20, "{} pixels say little", geometric.len());
    assert!(geometric.iter().all(|ray| ray.1 == ray.2), "{geometric:?}");
}

#[test]
fn the_strictest_tolerances_ask_every_light() {
    for scene in [half_shadow().build(40.0), rarefy::internal::scene::builtin::to_scene("mirror-room").unwrap()] {
        let mut renderer = twin_renderer(scene);
        let full = render(&mut renderer, &options(Mode::Full, SIDE, SIDE, 2));
        let mut strictest = adaptive(true);
        strictest.method.checks.fine.t_pos = 0.0;
        let frame = render(&mut renderer, &strictest);
        assert_eq!(frame.stats.rays, full.stats.rays, "{}", renderer.name());
    }
}
