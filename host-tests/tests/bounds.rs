// SPDX-License-Identifier: MIT OR Apache-2.0
//! Does any kernel leave its buffers? Kernels with bounds checks look at every access (`src/device/bounds.rs`).
#![allow(clippy::unwrap_used, missing_docs)]

use rarefy::Error;
use rarefy::internal::device::frame_memory::FrameBuffer;
use rarefy::internal::device::hooks::parity::KernelParity;
use rarefy::internal::device::kernels::Mutation;
use rarefy::internal::device::opencl::OpenOptions;
use rarefy::internal::device::opencl::executor::OpenClExecutor;
use rarefy::internal::layout::Traversal;
use rarefy::internal::method::options::{Method, Mode, RenderOptions};
use rarefy_host_tests::fixtures::{blocks, sweeps, with};
use rarefy_host_tests::frames::{Prepared, mutated_device, no_opencl, walking_by};

fn checked(
    open: &OpenOptions,
    understated: Option<(FrameBuffer, usize)>,
    mutation: Option<Mutation>,
) -> OpenClExecutor {
    let mut device = mutated_device(true, open, mutation);
    device.check_bounds(understated).unwrap();
    device
}

fn small() -> RenderOptions {
    RenderOptions { width: 50, height: 38, depth: 3, ..RenderOptions::default() }
}

/// Every check fails, so that there is as much to pack and to correct as can be.
fn everything_fails(block: u32) -> RenderOptions {
    with(&RenderOptions { method: blocks(block), ..small() }, |method| {
        (method.checks.fine.t_pos, method.checks.coarse.t_pos) = (0.0, 0.0);
    })
}

/// Draws frames on the twin, and each launch by checked kernels on the device, which must come to the same.
fn stays_within(scene: &str, open: &OpenOptions, frames: &[RenderOptions]) {
    let prepared = Prepared::named(scene);
    let mut device = checked(open, None, None);
    for (at, options) in frames.iter().enumerate() {
        let results = prepared.parity(&mut device, options, at % 2 == 1, None);
        let results = results.unwrap_or_else(|error| panic!("{scene}: {options:?}: {error}"));
        let differing: Vec<&KernelParity> = results.iter().filter(|result| result.different > 0).collect();
        assert!(differing.is_empty(), "{scene}: {options:?}: {differing:#?}");
    }
}

fn frames() -> Vec<RenderOptions> {
    vec![
        small(),
        everything_fails(4),
        RenderOptions { mode: Mode::Full, ..small() },
        RenderOptions { method: blocks(4), ..small() },
        RenderOptions { method: Method::paper(), ..small() },
        RenderOptions { method: sweeps(), ..small() },
        everything_fails(2),
        RenderOptions { band_rows: Some(8), ..small() },
        RenderOptions { band_rows: Some(12), width: 33, samples: 2, ..small() },
        RenderOptions { width: 1, height: 1, ..small() },
        RenderOptions { width: 3, height: 70, method: blocks(4), ..small() },
    ]
}

#[test]
fn no_access_of_a_frame_leaves_its_buffer() {
    if no_opencl() {
        return;
    }
    stays_within("zoo", &OpenOptions::default(), &frames()[..2]);
}

#[test]
#[ignore = "long: every kind of frame of every scene by kernels with bounds checks, and every walk"]
fn no_access_of_any_kind_of_frame_leaves_its_buffer() {
    if no_opencl() {
        return;
    }
    for scene in ["zoo", "mirror-room", "rods", "wall", "spheres", "dashes"] {
        stays_within(scene, &OpenOptions::default(), &frames());
    }
    for traversal in [Traversal::ShortStack, Traversal::Stackless] {
        stays_within("zoo", &walking_by(traversal), &frames()[..2]);
    }
}

/// What a frame of zoo in which every check fails is refused for.
fn refused(
    understated: Option<(FrameBuffer, usize)>,
    mutation: Option<(&str, &str, &str)>,
) -> (&'static str, &'static str, u64, u64) {
    let mutation = mutation.map(|(file, from, to)| Mutation { file: file.into(), from: from.into(), to: to.into() });
    let mut device = checked(&OpenOptions::default(), understated, mutation);
    match Prepared::named("zoo").draw(&mut device, &everything_fails(4), false) {
        Err(Error::LaunchBeyondBuffer { kernel, what, wanted, have }) => (kernel, what, wanted, have),
        other => panic!("{understated:?}: not refused: {other:?}"),
    }
}

/// The controls: a buffer that is told to be smaller than a frame needs, and kernels that leave theirs.
#[test]
fn a_buffer_that_is_too_small_is_noticed() {
    if no_opencl() {
        return;
    }
    for (buffer, kernel, words_of) in [
        (FrameBuffer::Masks, "step2b/pack_count", "mask words"),
        (FrameBuffer::Sums, "step2b/pack_count", "words of sums"),
        (FrameBuffer::List, "step2b/pack_scatter", "list entries"),
    ] {
        let (launch, what, wanted, have) = refused(Some((buffer, 5)), None);
        assert_eq!((launch, what, have), (kernel, words_of, 5), "{buffer:?}");
        assert!(wanted > have, "{buffer:?}: {wanted}");
    }
}

#[test]
#[ignore = "long: controls that compile the ray tree"]
fn a_kernel_that_leaves_its_buffer_is_noticed() {
    if no_opencl() {
        return;
    }
    let (kernel, what, ..) =
        refused(None, Some(("trace.cl", "list[step.list_offset + item]", "list[step.list_offset + item + 1000000u]")));
    assert_eq!((kernel, what), ("step2c/trace", "list entries"));
    let (kernel, what, ..) = refused(
        None,
        Some(("common/kdtree.clh", "const uint id = leaf_triangles[i]", "const uint id = leaf_triangles[i] + 100000u")),
    );
    assert_eq!((kernel, what), ("step1/trace", "vectors of triangles"));
    let (kernel, what, ..) = refused(Some((FrameBuffer::Attributes, 1000)), None);
    assert_eq!((kernel, what), ("step1/trace", "words of attributes"));
}
