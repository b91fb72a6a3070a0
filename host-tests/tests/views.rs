// SPDX-License-Identifier: MIT OR Apache-2.0
//! Camera, lights and environment change between frames, and two frames are alive.
#![allow(clippy::unwrap_used, missing_docs)]

use std::sync::Arc;

use glam::Vec3;
use rarefy::internal::device::open::{DeviceChoice, DeviceOptions};
use rarefy::internal::layout::PLANE_OBJECT;
use rarefy::internal::method::counts::Keep;
use rarefy::internal::method::options::RenderOptions;
use rarefy::internal::prepare::{PreparedScene, Shading};
use rarefy::internal::render::renderer::Renderer;
use rarefy::internal::scene::{Light, MAX_LIGHTS, View, builtin};
use rarefy::{Error, Monitor, Scene};
use rarefy_host_tests::frames::{no_opencl, renderer_of};

fn devices() -> Vec<DeviceChoice> {
    if no_opencl() { vec![DeviceChoice::Cpu] } else { vec![DeviceChoice::Cpu, DeviceChoice::OpenCl(None)] }
}

fn options() -> RenderOptions {
    RenderOptions { width: 90, height: 70, ..RenderOptions::default() }
}

fn renderer(scene: &Scene, device: DeviceChoice) -> Renderer {
    let options = DeviceOptions { device, strict: true, ..DeviceOptions::default() };
    renderer_of(scene, &options, &Monitor::default()).unwrap()
}

/// Views of a scene: as it comes, from elsewhere, with no light, with every light that a scene may have, by dusk.
fn views(view: &View) -> Vec<View> {
    let mut moved = view.clone();
    moved.camera.eye += Vec3::new(0.4, 0.3, 0.2);
    let dark = View { lights: Vec::new(), ..view.clone() };
    let light = |i: usize| Light { position: Vec3::new(i as f32 * 0.2 - 3.0, 3.0, 1.0), intensity: Vec3::splat(0.4) };
    let lit = View { lights: (0..MAX_LIGHTS).map(light).collect(), ..view.clone() };
    let dusk = View { ambient: Vec3::new(0.3, 0.1, 0.1), background: Vec3::new(0.2, 0.3, 0.6), ..view.clone() };
    vec![view.clone(), moved, dark, lit, dusk]
}

#[test]
fn a_changed_view_draws_what_a_new_renderer_draws() {
    let scene = builtin::to_scene("spheres").unwrap();
    for device in devices() {
        let mut kept = renderer(&scene, device);
        let mut pictures = Vec::new();
        for view in views(scene.view()).into_iter().rev() {
            let mut changed = scene.clone();
            changed.set_view(view.clone()).unwrap();
            let expected = renderer(&changed, device).render_exactly(&options(), Keep::default()).unwrap().pixels;
            kept.set_view(view).unwrap();
            assert!(kept.render_exactly(&options(), Keep::default()).unwrap().pixels == expected, "{device}");
            assert!(!pictures.contains(&expected), "{device}: a view that changes nothing shows nothing");
            pictures.push(expected);
        }
    }
}

#[test]
fn a_view_that_is_none_is_refused_and_the_old_one_stays() {
    let scene = builtin::to_scene("wall").unwrap();
    let mut renderer = renderer(&scene, DeviceChoice::Cpu);
    let lights = vec![Light { position: Vec3::ONE, intensity: Vec3::ONE }; MAX_LIGHTS + 1];
    let mut blind = scene.view().clone();
    blind.camera.look_at = blind.camera.eye;
    for bad in [View { lights, ..scene.view().clone() }, blind] {
        assert!(matches!(renderer.set_view(bad), Err(Error::InvalidScene { .. })));
        assert_eq!(renderer.view(), scene.view());
    }
}

#[test]
fn renderers_in_several_threads_share_a_prepared_scene() {
    let scene = builtin::to_scene("spheres").unwrap();
    let prepared = Arc::new(PreparedScene::new(&scene, Shading::Full, &Monitor::default()).unwrap());
    drop(scene);
    let draw = |prepared: Arc<PreparedScene>| {
        let options_of_device = DeviceOptions { device: DeviceChoice::Cpu, ..DeviceOptions::default() };
        let mut renderer = Renderer::new(prepared, &options_of_device, &Monitor::default()).unwrap();
        renderer.render_exactly(&options(), Keep::default()).unwrap().pixels
    };
    let expected = draw(Arc::clone(&prepared));
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..3).map(|_| scope.spawn(|| draw(Arc::clone(&prepared)))).collect();
        assert!(threads.into_iter().all(|thread| thread.join().unwrap() == expected));
    });
}

/// Planes of the frame before stay on the device while the next one is drawn, or go to the host where a budget does not
/// hold both frames; either way they are read as they were.
#[test]
fn the_planes_of_the_last_frame_outlive_one_that_fails() {
    let scene = builtin::to_scene("spheres").unwrap();
    let keep = Keep::planes(&[PLANE_OBJECT]);
    for device in devices() {
        let mut peaks: Vec<u64> = Vec::new();
        for round in 0..2 {
            // Less than both frames took the first time, and enough for each.
            let memory_budget_bytes = (round > 0).then(|| peaks[0] - (200 << 10));
            let opened = DeviceOptions { device, memory_budget_bytes, ..DeviceOptions::default() };
            let mut renderer = renderer_of(&scene, &opened, &Monitor::default()).unwrap();
            let large = RenderOptions { width: 150, height: 100, ..options() };
            renderer.render_exactly(&large, keep).unwrap();
            let objects = renderer.plane(PLANE_OBJECT).unwrap();
            assert_eq!(objects.len(), 150 * 100);
            let cancelled = Monitor::default();
            cancelled.cancel().cancel();
            renderer.set_monitor(&cancelled);
            assert!(matches!(renderer.render_exactly(&large, keep), Err(Error::Cancelled)));
            assert_eq!(renderer.plane(PLANE_OBJECT).unwrap(), objects);
            renderer.set_monitor(&Monitor::default());
            // A frame that is finished takes its place.
            renderer.render_exactly(&options(), keep).unwrap();
            assert_eq!(renderer.plane(PLANE_OBJECT).unwrap().len(), 90 * 70);
            renderer.render_exactly(&options(), Keep::default()).unwrap();
            assert!(matches!(renderer.plane(PLANE_OBJECT), Err(Error::MissingPlane { .. })));
            peaks.push(renderer.peak_device_bytes());
        }
        assert!(peaks[1] <= peaks[0] - (200 << 10), "{device}: {peaks:?}");
    }
}
