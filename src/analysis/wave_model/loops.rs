// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cost of a ray tree loop by loop. Lanes of a wave wait for each other after every loop through the kd-tree, not only
//! at the end of the tree: so the model must know what each loop costs.

use super::{SHADED_POINT, TRIANGLE_TEST};
use crate::device::twin::ray_tree::ray_tree;
use crate::device::twin::scene_args::{Part, Tally, Work};
use crate::device::twin::{SceneArgs, Words};
use crate::layout::StepParams;

/// Where in the program a lane is. Lanes of a wave are at one place at a time, and none goes on before all are done there.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Place {
    /// 0: the primary ray; 1 and 2: the first and the second chain of secondary rays.
    pub chain: u8,
    /// The ray of the chain.
    pub ray: u8,
    /// What is done with it.
    pub part: Part,
}

/// What one lane costs at each place where it is busy, in the order of the program.
pub type Loops = Box<[(Place, f64)]>;

/// A ray tree's cost as it grows.
struct Log {
    work: Work,
    chain: u8,
    ray: u8,
    /// The loop that runs, and the work when it began.
    open: Option<(Place, Work)>,
    loops: Vec<(Place, f64)>,
}

impl Log {
    fn close(&mut self) {
        if let Some((place, before)) = self.open.take() {
            let steps = self.work.traversal_steps - before.traversal_steps;
            let tests = self.work.triangle_tests - before.triangle_tests;
            let cost = f64::from(steps) + TRIANGLE_TEST * f64::from(tests);
            if cost > 0.0 {
                self.loops.push((place, cost));
            }
        }
    }
}

impl Tally for Log {
    fn work(&mut self) -> &mut Work {
        &mut self.work
    }

    fn leaves_surface(&mut self, chain: u32, ray: u32) {
        // Depth and panes bound both far below 256.
        (self.chain, self.ray) = (chain as u8 + 1, ray as u8);
    }

    fn begins(&mut self, part: Part) {
        self.close();
        let place = Place { chain: self.chain, ray: self.ray, part };
        if part == Part::Shading {
            self.loops.push((place, SHADED_POINT));
        } else {
            self.open = Some((place, self.work));
        }
    }
}

/// What the ray tree of pixel `(x, y)` costs, loop by loop, as `step` traces it; `attributes` as they were before.
pub fn loops(scene: &SceneArgs, step: &StepParams, class: u32, (x, y): (u32, u32), attributes: &Words) -> Loops {
    let mut log = Log { work: Work::default(), chain: 0, ray: 0, open: None, loops: Vec::new() };
    ray_tree(scene, step, attributes, (x, y), class, &mut log);
    log.close();
    log.loops.into_boxed_slice()
}
