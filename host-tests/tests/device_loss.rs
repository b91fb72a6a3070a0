// SPDX-License-Identifier: MIT OR Apache-2.0
//! A device that is lost in the middle of a frame, as when a phone's watchdog strikes: injected, on a real OpenCL.
#![allow(clippy::unwrap_used, missing_docs)]

use rarefy::internal::device::open::{DeviceChoice, DeviceOptions};
use rarefy::internal::device::opencl::{CacheFolder, Faults};
use rarefy::internal::layout::PLANE_OBJECT;
use rarefy::internal::method::counts::Keep;
use rarefy::internal::method::options::RenderOptions;
use rarefy::internal::render::renderer::Renderer;
use rarefy::internal::scene::builtin;
use rarefy::{Error, Monitor};
use rarefy_host_tests::frames::{no_opencl, renderer_of};

const OUT_OF_RESOURCES: i32 = -5;
const INVALID_COMMAND_QUEUE: i32 = -36;

fn renderer(faults: &Faults) -> Renderer {
    let options = DeviceOptions {
        device: DeviceChoice::OpenCl(None),
        strict: true,
        faults: faults.clone(),
        cache: CacheFolder::Off,
        ..DeviceOptions::default()
    };
    renderer_of(&builtin::to_scene("rods").unwrap(), &options, &Monitor::default()).unwrap()
}

fn options() -> RenderOptions {
    RenderOptions { width: 120, height: 91, ..RenderOptions::default() }
}

#[test]
fn a_lost_device_is_opened_again_and_the_frame_is_right() {
    if no_opencl() {
        return;
    }
    let faults = Faults::default();
    let mut renderer = renderer(&faults);
    let right = renderer.render_exactly(&options(), Keep::default()).unwrap();
    for (after, code) in [(0, OUT_OF_RESOURCES), (1, INVALID_COMMAND_QUEUE), (9, OUT_OF_RESOURCES)] {
        let notices = renderer.notices().len();
        faults.after(after, code);
        let frame = renderer.render_exactly(&options(), Keep::planes(&[PLANE_OBJECT])).unwrap();
        assert_eq!(faults.left(), 0, "the fault struck");
        assert!(frame.pixels == right.pixels, "after {after} enqueues: another picture");
        assert_eq!(frame.stats.pixels, right.stats.pixels);
        assert_eq!(renderer.plane(PLANE_OBJECT).unwrap().len(), 120 * 91);
        let said = &renderer.notices()[notices..];
        assert!(matches!(said, [one] if one.contains("was lost") && one.contains("opened again")), "{said:?}");
    }
    // In bands, too.
    faults.after(20, OUT_OF_RESOURCES);
    let bands = RenderOptions { band_rows: Some(20), ..options() };
    assert!(renderer.render_exactly(&bands, Keep::default()).unwrap().pixels == right.pixels);
    assert_eq!(faults.left(), 0);
}

#[test]
fn slices_are_halved_when_a_device_was_lost() {
    if no_opencl() {
        return;
    }
    let faults = Faults::default();
    let mut renderer = renderer(&faults);
    let told = |renderer: &Renderer| {
        let notice = renderer.notices().last().unwrap().clone();
        let number = notice.split(" ms").next().unwrap().rsplit(' ').next().unwrap().parse::<f64>();
        number.unwrap_or_else(|_| panic!("{notice}"))
    };
    faults.after(3, OUT_OF_RESOURCES);
    renderer.render_exactly(&options(), Keep::default()).unwrap();
    let first = told(&renderer);
    faults.after(3, OUT_OF_RESOURCES);
    renderer.render_exactly(&options(), Keep::default()).unwrap();
    assert!((told(&renderer) - first / 2.0).abs() < 0.11, "{first} ms, then {} ms", told(&renderer));
}

#[test]
fn a_second_loss_is_an_error_and_the_renderer_stays_usable() {
    if no_opencl() {
        return;
    }
    let faults = Faults::default();
    let mut renderer = renderer(&faults);
    let keep = Keep::planes(&[PLANE_OBJECT]);
    let right = renderer.render_exactly(&options(), keep).unwrap();
    for second in [0, 7] {
        faults.after(5, OUT_OF_RESOURCES);
        faults.after(second, INVALID_COMMAND_QUEUE);
        let error = renderer.render_exactly(&options(), Keep::default()).unwrap_err();
        assert!(matches!(error, Error::DeviceLost { .. }), "{error}");
        let message = error.to_string();
        for part in ["lost twice in one frame", "CL_INVALID_COMMAND_QUEUE (-36)", "smaller picture", "the CPU"] {
            assert!(message.contains(part), "{message}");
        }
        assert_eq!(faults.left(), 0);
        // What the frame before kept went with the device, and the next frame is right.
        assert!(matches!(renderer.plane(PLANE_OBJECT), Err(Error::MissingPlane { .. })));
        assert!(renderer.render_exactly(&options(), keep).unwrap().pixels == right.pixels);
    }
}

#[test]
fn other_failures_are_not_retried() {
    if no_opencl() {
        return;
    }
    const INVALID_KERNEL_ARGS: i32 = -52;
    let faults = Faults::default();
    let mut renderer = renderer(&faults);
    faults.after(2, INVALID_KERNEL_ARGS);
    let error = renderer.render_exactly(&options(), Keep::default()).unwrap_err();
    assert!(matches!(error, Error::OpenCl { code: INVALID_KERNEL_ARGS, .. }), "{error}");
    assert!(renderer.notices().iter().all(|notice| !notice.contains("lost")));
}
