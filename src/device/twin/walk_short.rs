// SPDX-License-Identifier: MIT OR Apache-2.0
//! Twin of `kernels/common/walk_short.clh`: a few far children are remembered, and of each level whether its far child
//! waits; a restart from the root finds those that were forgotten.

use super::scene_args::Work;
use super::traverse::{Walk, Walker};
use crate::layout::{SHORT_STACK_ENTRIES, Traversal};
use crate::prepare::kdtree::MAX_DEPTH;

const _: () = assert!(MAX_DEPTH <= u64::BITS as usize);

pub(super) struct ShortWalk<'a> {
    walker: Walker<'a>,
    t_exit: f32,
    /// Bit l: the far child at level l waits.
    waiting: u64,
    level: u32,
    /// Levels above this one were passed before.
    replay: u32,
    /// The last few that wait, the deepest first.
    short_stack: [(u32, f32); SHORT_STACK_ENTRIES as usize],
    held: u32,
    entries: u32,
}

impl ShortWalk<'_> {
    fn push(&mut self, far: u32) {
        self.short_stack.rotate_right(1);
        self.short_stack[0] = (far, self.walker.t_max);
        // The oldest falls out.
        self.held = (self.held + 1).min(self.entries);
    }
}

impl<'a> Walk<'a> for ShortWalk<'a> {
    fn start(walker: Walker<'a>, traversal: Traversal) -> Self {
        ShortWalk {
            t_exit: walker.t_max,
            walker,
            waiting: 0,
            level: 0,
            replay: 0,
            short_stack: Default::default(),
            held: 0,
            entries: traversal.short_stack_entries().unwrap_or(0),
        }
    }

    fn walker(&mut self) -> &mut Walker<'a> {
        &mut self.walker
    }

    fn descend(&mut self, work: &mut Work) {
        let mut node = self.walker.at();
        while !node.is_leaf() {
            work.traversal_steps += 1;
            let fork = self.walker.fork(node);
            let again = self.level < self.replay;
            let is_waiting = self.waiting >> self.level & 1 != 0;
            if fork.t_split > self.walker.t_max {
                self.walker.node = fork.near;
            } else if if again { !is_waiting } else { fork.t_split < self.walker.t_min } {
                self.walker.node = fork.far;
            } else {
                self.push(fork.far);
                self.waiting |= 1 << self.level;
                self.walker.enter_near(&fork);
            }
            self.level += 1;
            node = self.walker.at();
        }
    }

    fn next_cell(&mut self) -> bool {
        if self.waiting == 0 {
            return false;
        }
        let deepest = 63 - self.waiting.leading_zeros();
        self.waiting ^= 1 << deepest;
        self.replay = deepest + 1;
        if self.held > 0 {
            (self.walker.node, self.walker.t_max) = self.short_stack[0];
            self.short_stack.rotate_left(1);
            self.held -= 1;
            self.level = deepest + 1;
        } else {
            (self.walker.node, self.walker.t_max) = (0, self.t_exit);
            self.level = 0;
        }
        true
    }
}
