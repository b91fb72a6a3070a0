// SPDX-License-Identifier: MIT OR Apache-2.0
//! Do frames at the ends of the space of options stay within their buffers?
#![allow(clippy::unwrap_used, missing_docs)]

use rarefy::device::opencl::OpenOptions;
use rarefy::method::options::RenderOptions;
use rarefy_host_tests::fixtures::{blocks, with};
use rarefy_host_tests::frames::{Prepared, device, no_opencl, twin};

/// Every check fails: with blocks of 4, fifteen sixteenths of the pixels are sources of correction's first round, each
/// with five items. That was more than the masks held, and corrupted the heap under OpenCL.
#[test]
fn a_frame_in_which_every_check_fails_fits_its_buffers() {
    for block in [2, 4] {
        let sized = RenderOptions { width: 64, height: 64, method: blocks(block), ..RenderOptions::default() };
        let options = with(&sized, |method| {
            method.checks.fine.t_pos = 0.0;
            method.checks.coarse.t_pos = 0.0;
        });
        let prepared = Prepared::named("rods");
        let twin = prepared.draw(&mut twin(), &options, false).unwrap();
        assert_eq!(twin.counts.interpolated, 0);
        if !no_opencl() {
            let mut device = device(true, &OpenOptions::default());
            assert_eq!(twin, prepared.draw(&mut device, &options, false).unwrap());
        }
    }
}
