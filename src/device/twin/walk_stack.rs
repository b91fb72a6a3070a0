// SPDX-License-Identifier: MIT OR Apache-2.0
//! Twin of `kernels/common/walk_stack.clh`: the walk with a private stack.

use super::scene_args::Work;
use super::traverse::{Walk, Walker};
use crate::layout::Traversal;
use crate::prepare::kdtree::MAX_DEPTH;

pub(super) struct StackWalk<'a> {
    walker: Walker<'a>,
    stack: [(u32, f32); MAX_DEPTH],
    depth: usize,
}

impl<'a> Walk<'a> for StackWalk<'a> {
    #[inline]
    fn start(walker: Walker<'a>, _: Traversal) -> Self {
        StackWalk { walker, stack: [(0, 0.0); MAX_DEPTH], depth: 0 }
    }

    #[inline]
    fn walker(&mut self) -> &mut Walker<'a> {
        &mut self.walker
    }

    #[inline]
    fn descend(&mut self, work: &mut Work) {
        let walker = &mut self.walker;
        let mut node = walker.at();
        while !node.is_leaf() {
            work.traversal_steps += 1;
            let fork = walker.fork(node);
            if fork.t_split > walker.t_max {
                walker.node = fork.near;
            } else if fork.t_split < walker.t_min {
                walker.node = fork.far;
            } else {
                self.stack[self.depth] = (fork.far, walker.t_max);
                self.depth += 1;
                walker.enter_near(&fork);
            }
            node = walker.at();
        }
    }

    #[inline]
    fn next_cell(&mut self) -> bool {
        if self.depth == 0 {
            return false;
        }
        self.depth -= 1;
        (self.walker.node, self.walker.t_max) = self.stack[self.depth];
        true
    }
}
