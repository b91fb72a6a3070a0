// SPDX-License-Identifier: MIT OR Apache-2.0
//! Twin of `kernels/correct_tail.cl`: rounds of few sources in one launch.

use super::bridge::Hits;
use super::correct::{claimed_by, mark_item, target};
use super::{FrameBuffers, SceneArgs};
use crate::layout::*;

/// The work-group of `correct_tail`. `trace` runs a list launch of `trace` with the given parameters.
pub fn correct_tail(scene: &SceneArgs, step: &StepParams, buffers: &FrameBuffers, trace: impl Fn(&StepParams)) {
    let mut round = StepParams { pixel_class: CLASS_CORRECTED, ..*step };
    let mut rounds = 0;
    while rounds < TAIL_ROUNDS && round.item_count != 0 && round.item_count <= 4 * TAIL_SOURCES {
        let hits = Hits { frame: scene.frame, step: &round, buffers };
        (0..round.item_count).for_each(|i| mark_item(hits, i));
        let wanted = (0..round.item_count).filter(|&i| claimed_by(hits, i)).count() as u32;
        if wanted > round.list_end - round.list_offset {
            break;
        }
        let mut total = 0;
        for i in (0..round.item_count).filter(|&i| claimed_by(hits, i)) {
            buffers.list.set(round.list_offset + total, target(hits, i));
            total += 1;
        }
        trace(&StepParams { item_count: total, ..round });
        round.source_offset = round.list_offset;
        round.list_offset += total;
        round.item_count = 4 * total;
        buffers.sums.set(TAIL_SUM_ENDS + rounds, round.list_offset);
        rounds += 1;
    }
    buffers.sums.set(TAIL_SUM_SOURCES, round.source_offset);
    buffers.sums.set(TAIL_SUM_LIST, round.list_offset);
    buffers.sums.set(TAIL_SUM_ROUNDS, rounds);
}
