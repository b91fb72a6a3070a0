// SPDX-License-Identifier: MIT OR Apache-2.0
//! Builds the tree from the root down: splits nodes by the surface area heuristic, large ones in parallel.
//!
//! What becomes of a node depends on its own triangles, cell, depth and share of the memory only, and the parts are put
//! together in a fixed order: the bytes are the same for any number of threads.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

use glam::Vec3;

use super::clip::{Cell, Corners, Primitive, cell_epsilon, split_primitive, whole};
use super::sah::{Costs, Scratch, Split, best_split};
use super::{KdNode, KdTree, MAX_DEPTH};
use crate::error::{Remedy, Setting};
use crate::monitor::Monitor;
use crate::{Error, Result, memory};

/// Cost of an inner node on a ray's way, the unit of [`INTERSECTION_COST`].
const TRAVERSAL_COST: f32 = 1.0;
/// Cost of a triangle test in inner nodes.
///
/// Measured, kernels with a ray per work-item: full tracing of three real scenes is 1.09 times as fast with 0.6 as with 0.4
/// (living-room 1.08, bathroom 1.02, kitchen 1.18; a half to a third of the triangle tests) and 1.12 times with 0.8. The tree
/// grows by 37 % from 0.4 to 0.6 and by a further 18 % to 0.8. Packets of rays want 0.3 to 0.6.
const INTERSECTION_COST: f32 = 0.6;
/// Wald and Havran (2006) multiply the cost of splits that cut off empty space by 0.8. Measured: up to 5 % cheaper trees
/// than without (at worst 0.5 % dearer), while 0.6 makes them 10 to 150 % dearer (space is cut off until the depth is used up).
const EMPTY_BONUS: f32 = 0.2;

/// Most bytes of a tree per triangle of the scene, whatever the memory limit is.
///
/// Ordinary scenes need 15 to 60. Only inputs such as thousands of equal triangles, where each split pays off by the
/// heuristic and copies them all, come near this limit; it keeps such trees from growing to millions of nodes.
pub const MAX_BYTES_PER_TRIANGLE: u64 = 128;
/// What the tree of a scene of few triangles may take anyway.
const MIN_BUDGET_BYTES: u64 = 64 << 10;
/// Node indices and leaf entries have 30 and 32 bits; a tree of this size can exceed neither.
const MAX_TREE_BYTES: u64 = 4 << 30;
/// Nodes with more triangles than this grow in parallel.
const FORK_ABOVE: usize = 2048;
/// Triangles that are taken up before it is asked whether the work is to end.
const TRIANGLES_AT_ONCE: usize = 1 << 15;
/// Coordinates beyond this overflow in the intersection test's products.
const LARGEST_COORDINATE: f32 = 1.0e12;

/// How to build a tree.
#[derive(Debug, Clone, PartialEq)]
pub struct BuildOptions {
    /// Cost of an inner node on a ray's way, above 0, in any unit. Default 1.
    pub traversal_cost: f32,
    /// Cost of a triangle test in the same unit, above 0. Default 0.6. Less makes a smaller tree with larger leaves.
    pub intersection_cost: f32,
    /// By what share a split that cuts off empty space counts as cheaper, 0 to below 1. Default 0.2.
    pub empty_bonus: f32,
    /// Deepest leaf, at most [`MAX_DEPTH`] (0: the root is a leaf). `None`, the default: `8 + 1.3 log2(triangles)` as
    /// in Havran's thesis, at most [`MAX_DEPTH`].
    pub max_depth: Option<usize>,
    /// Most bytes of the finished tree (nodes and leaf entries). Default 1 GiB. Where the limit would be exceeded,
    /// splitting stops and leaves are larger, in the same way on every machine; a limit that cannot even hold one leaf
    /// with all triangles is an error. See also [`MAX_BYTES_PER_TRIANGLE`].
    pub memory_limit_bytes: u64,
    /// Number of threads, at least 1. `None`, the default: those of the current rayon pool.
    pub threads: Option<usize>,
}

impl Default for BuildOptions {
    fn default() -> Self {
        BuildOptions {
            traversal_cost: TRAVERSAL_COST,
            intersection_cost: INTERSECTION_COST,
            empty_bonus: EMPTY_BONUS,
            max_depth: None,
            memory_limit_bytes: 1 << 30,
            threads: None,
        }
    }
}

impl BuildOptions {
    fn check(&self) -> Result<()> {
        let costs =
            [(Setting::KdTraversalCost, self.traversal_cost), (Setting::KdIntersectionCost, self.intersection_cost)];
        for (setting, cost) in costs {
            if !(cost.is_finite() && cost > 0.0) {
                return Err(Error::option(setting, cost, "a finite number above 0"));
            }
        }
        if !(0.0..1.0).contains(&self.empty_bonus) {
            return Err(Error::option(Setting::KdEmptyBonus, self.empty_bonus, "0 or more and less than 1"));
        }
        if let Some(depth) = self.max_depth.filter(|&depth| depth > MAX_DEPTH) {
            return Err(Error::option(Setting::KdMaxDepth, depth, format!("0 to {MAX_DEPTH}")));
        }
        if self.threads == Some(0) {
            return Err(Error::option(Setting::KdThreads, 0, "1 or more"));
        }
        Ok(())
    }
}

impl KdTree {
    /// Builds the tree over `triangles`, whose corners are indices into `positions`.
    ///
    /// `monitor` is told which share is done, and can end it.
    ///
    /// # Errors
    ///
    /// [`Error::InvalidOption`] for options out of range, [`Error::InvalidScene`] for indices out of range and for
    /// coordinates that are not finite or beyond 1e12, [`Error::LimitExceeded`] if the memory limit is below what a
    /// single leaf needs, [`Error::Cancelled`].
    pub fn build(
        positions: &[Vec3],
        triangles: &[[u32; 3]],
        options: &BuildOptions,
        monitor: &Monitor,
    ) -> Result<KdTree> {
        options.check()?;
        monitor.check()?;
        let monitor = monitor.part("kd-tree", 0.0, 1.0);
        let (cell, epsilon) = scene_cell(positions, triangles)?;
        let budget = budget_bytes(triangles.len() as u64, options)?;
        let auto_depth = 8 + (1.3 * (triangles.len().max(1) as f64).log2()) as usize;
        let builder = Builder {
            positions,
            triangles,
            epsilon,
            costs: Costs {
                traversal: options.traversal_cost,
                intersection: options.intersection_cost,
                empty_factor: 1.0 - options.empty_bonus,
            },
            max_depth: options.max_depth.unwrap_or(auto_depth).min(MAX_DEPTH),
            serial: options.threads == Some(1),
            monitor: &monitor,
            done: Mutex::new(0.0),
            starved: AtomicBool::new(false),
        };
        monitor.tell(0.0);
        let grow = || {
            let primitives = builder.primitives()?;
            Ok(builder.grow(primitives, Place { cell, depth: 0, budget, weight: 1.0 }))
        };
        let grown = match options.threads {
            None | Some(1) => grow(),
            Some(threads) => {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
                pool.map_err(|e| {
                    Error::option(Setting::KdThreads, threads, format!("less: they cannot be started ({e})"))
                })?
                .install(grow)
            }
        };
        // A tree that was cancelled, or ran out of memory, is a stump.
        monitor.check()?;
        let grown = grown?;
        if builder.starved.load(Relaxed) {
            return Err(memory::out_of_memory::<Primitive>("the triangles of the kd-tree", triangles.len()));
        }
        let mut tree =
            KdTree { nodes: Vec::new(), leaf_triangles: Vec::new(), bounds_min: cell.lo, bounds_max: cell.hi };
        let (nodes, entries) = grown.size();
        memory::make_room("the nodes of the kd-tree", &mut tree.nodes, nodes + 2)?;
        memory::make_room("the leaves of the kd-tree", &mut tree.leaf_triangles, entries)?;
        // The root, and the unused node that brings pairs to even indices.
        tree.nodes.extend([KdNode::leaf(0, 0); 2]);
        grown.place(0, &mut tree);
        monitor.check()?;
        monitor.tell(1.0);
        Ok(tree)
    }
}

/// The box around all triangles, widened so that widened triangles lie within, and the epsilon for this scene.
pub(super) fn scene_cell(positions: &[Vec3], triangles: &[[u32; 3]]) -> Result<(Cell, f32)> {
    let (mut lo, mut hi) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for (i, triangle) in triangles.iter().enumerate() {
        for &corner in triangle {
            let Some(&p) = positions.get(corner as usize) else {
                let message = format!("corner {corner} is out of range, there are {} positions", positions.len());
                return Err(Error::scene(format!("triangle {i}"), message));
            };
            if p.is_nan() || p.abs().max_element() > LARGEST_COORDINATE {
                let message = format!("position {corner} is {p}; coordinates must be within +-{LARGEST_COORDINATE:e}");
                return Err(Error::scene(format!("triangle {i}"), message));
            }
            lo = lo.min(p);
            hi = hi.max(p);
        }
    }
    if triangles.is_empty() {
        (lo, hi) = (Vec3::ZERO, Vec3::ZERO);
    }
    let epsilon = cell_epsilon(lo.abs().max(hi.abs()).max_element());
    Ok((Cell { lo: (lo - 2.0 * epsilon).to_array(), hi: (hi + 2.0 * epsilon).to_array() }, epsilon))
}

/// What the nodes below the root and all leaf entries may take.
fn budget_bytes(triangles: u64, options: &BuildOptions) -> Result<u64> {
    let fixed = 2 * size_of::<KdNode>() as u64;
    let wanted = fixed + 4 * triangles;
    let allowed = options.memory_limit_bytes.min(MAX_TREE_BYTES);
    // A leaf's count has 30 bits.
    if wanted > allowed || triangles >= 1 << 30 {
        return Err(Error::LimitExceeded {
            what: format!("a kd-tree over {triangles} triangles"),
            limit: "memory_limit_bytes".into(),
            wanted: format!("at least {wanted} bytes"),
            allowed: format!("{allowed} bytes"),
            remedies: &[Remedy::SmallerScene],
        });
    }
    Ok((allowed - fixed).min((MAX_BYTES_PER_TRIANGLE * triangles).max(MIN_BUDGET_BYTES)))
}

/// Where a node stands.
#[derive(Clone, Copy)]
struct Place {
    cell: Cell,
    depth: usize,
    /// Bytes that all nodes below this one and all leaf entries may take.
    budget: u64,
    /// Share of the whole work.
    weight: f64,
}

impl Place {
    /// The children's places; the rest of the budget goes to where the triangles are.
    fn children(&self, split: &Split, lower: usize, upper: usize) -> (Place, Place) {
        let (below, above) = self.cell.split(split.axis, split.position);
        let (need_lower, need_upper) = (4 * lower as u64, 4 * upper as u64);
        let rest = self.budget.saturating_sub(PAIR_BYTES + need_lower + need_upper);
        let both = (lower + upper).max(1) as u64;
        let rest_lower = rest * lower as u64 / both;
        let weight_lower = self.weight * lower as f64 / both as f64;
        let depth = self.depth + 1;
        (
            Place { cell: below, depth, budget: need_lower + rest_lower, weight: weight_lower },
            Place { cell: above, depth, budget: need_upper + rest - rest_lower, weight: self.weight - weight_lower },
        )
    }
}

const PAIR_BYTES: u64 = 2 * size_of::<KdNode>() as u64;

/// A part of the tree that grew on its own.
enum Grown {
    /// A node that was split in parallel.
    Fork { axis: usize, position: f32, children: Box<(Grown, Grown)> },
    /// Everything below a node; indices count from the part's own beginning.
    Subtree { root: KdNode, nodes: Vec<KdNode>, leaf_triangles: Vec<u32> },
}

impl Grown {
    /// Numbers of nodes (without the topmost) and leaf entries.
    fn size(&self) -> (usize, usize) {
        match self {
            Grown::Fork { children, .. } => {
                let (a, b) = (children.0.size(), children.1.size());
                (2 + a.0 + b.0, a.1 + b.1)
            }
            Grown::Subtree { nodes, leaf_triangles, .. } => (nodes.len(), leaf_triangles.len()),
        }
    }

    /// Writes the topmost node to `slot` and appends the others.
    fn place(self, slot: usize, tree: &mut KdTree) {
        match self {
            Grown::Fork { axis, position, children } => {
                let pair = tree.nodes.len();
                tree.nodes.extend([KdNode::leaf(0, 0); 2]);
                tree.nodes[slot] = KdNode::inner(axis as u32, position, pair as u32);
                let (lower, upper) = *children;
                lower.place(pair, tree);
                upper.place(pair + 1, tree);
            }
            Grown::Subtree { root, nodes, leaf_triangles } => {
                let node_base = tree.nodes.len() as u32;
                let leaf_base = tree.leaf_triangles.len() as u32;
                tree.nodes.extend(nodes.into_iter().map(|node| relocated(node, node_base, leaf_base)));
                tree.nodes[slot] = relocated(root, node_base, leaf_base);
                tree.leaf_triangles.extend_from_slice(&leaf_triangles);
            }
        }
    }
}

/// A node of a part, when its nodes and leaf entries begin at these indices of the whole tree.
fn relocated(node: KdNode, node_base: u32, leaf_base: u32) -> KdNode {
    if node.is_leaf() {
        KdNode::leaf(node.split_or_first + leaf_base, node.payload())
    } else {
        KdNode::inner(node.axis(), node.split(), node.payload() + node_base)
    }
}

/// A subtree under construction on one thread, with memory that it uses again.
struct SerialSubtree {
    nodes: Vec<KdNode>,
    leaf_triangles: Vec<u32>,
    scratch: Scratch,
    /// Emptied lists of primitives.
    spare: Vec<Vec<Primitive>>,
}

struct Builder<'a> {
    positions: &'a [Vec3],
    triangles: &'a [[u32; 3]],
    epsilon: f32,
    costs: Costs,
    max_depth: usize,
    serial: bool,
    monitor: &'a Monitor,
    /// The shares of finished subtrees together.
    done: Mutex<f64>,
    /// There was no memory for a part of the triangles: everything comes to an end.
    starved: AtomicBool,
}

impl Builder<'_> {
    fn corners(&self, triangle: &[u32; 3]) -> [Vec3; 3] {
        triangle.map(|corner| self.positions[corner as usize])
    }

    fn exact_corners(&self, id: u32) -> Corners {
        self.corners(&self.triangles[id as usize]).map(|p| p.as_dvec3().to_array())
    }

    /// All triangles, or some of them if the work is to end.
    fn primitives(&self) -> Result<Vec<Primitive>> {
        let mut primitives = memory::with_room("the triangles of the kd-tree", self.triangles.len())?;
        for (first, chunk) in (0u32..).step_by(TRIANGLES_AT_ONCE).zip(self.triangles.chunks(TRIANGLES_AT_ONCE)) {
            if self.monitor.cancel().is_cancelled() {
                break;
            }
            primitives.extend((first..).zip(chunk).map(|(id, t)| whole(id, self.corners(t), self.epsilon)));
        }
        Ok(primitives)
    }

    /// Adds the share of a finished subtree.
    fn count(&self, share: f64) {
        // A panic in another thread poisons the lock; the number in it is still good.
        let mut done = self.done.lock().unwrap_or_else(|e| e.into_inner());
        *done += share;
        self.monitor.tell(*done as f32);
    }

    /// Grows the tree over `primitives`, in parallel while there are many.
    fn grow(&self, mut primitives: Vec<Primitive>, place: Place) -> Grown {
        let mut scratch = Scratch::new();
        let mut upper = Vec::new();
        if primitives.len() > FORK_ABOVE
            && let Some(split) = self.choose(&primitives, &place, &mut scratch, &mut upper)
        {
            self.divide(&mut primitives, &split, &mut upper);
            let (place_lower, place_upper) = place.children(&split, primitives.len(), upper.len());
            let below = || self.grow(primitives, place_lower);
            let above = || self.grow(upper, place_upper);
            let children = if self.serial { (below(), above()) } else { rayon::join(below, above) };
            return Grown::Fork { axis: split.axis, position: split.position, children: Box::new(children) };
        }
        let mut subtree = SerialSubtree { nodes: Vec::new(), leaf_triangles: Vec::new(), scratch, spare: Vec::new() };
        let root = self.grow_serially(&mut primitives, &place, &mut subtree);
        self.count(place.weight);
        Grown::Subtree { root, nodes: subtree.nodes, leaf_triangles: subtree.leaf_triangles }
    }

    /// Grows the tree over `primitives` on this thread; depth first, so that a node's descendants lie close together.
    fn grow_serially(&self, primitives: &mut Vec<Primitive>, place: &Place, subtree: &mut SerialSubtree) -> KdNode {
        let mut upper = subtree.spare.pop().unwrap_or_default();
        let Some(split) = self.choose(primitives, place, &mut subtree.scratch, &mut upper) else {
            subtree.spare.push(upper);
            let first = subtree.leaf_triangles.len() as u32;
            // Lists keep the order of ids from the root on.
            subtree.leaf_triangles.extend(primitives.iter().map(|p| p.id));
            return KdNode::leaf(first, primitives.len() as u32);
        };
        self.divide(primitives, &split, &mut upper);
        let (place_lower, place_upper) = place.children(&split, primitives.len(), upper.len());
        let pair = subtree.nodes.len();
        subtree.nodes.extend([KdNode::leaf(0, 0); 2]);
        subtree.nodes[pair] = self.grow_serially(primitives, &place_lower, subtree);
        subtree.nodes[pair + 1] = self.grow_serially(&mut upper, &place_upper, subtree);
        upper.clear();
        subtree.spare.push(upper);
        KdNode::inner(split.axis as u32, split.position, pair as u32)
    }

    /// The plane that splits a node, or `None` for a leaf: nothing is cheaper, depth or memory are used up, or the work
    /// is to end, which is seen once all has come to leaves. `upper` gets room for what lies above the plane.
    fn choose(
        &self,
        primitives: &[Primitive],
        place: &Place,
        scratch: &mut Scratch,
        upper: &mut Vec<Primitive>,
    ) -> Option<Split> {
        if place.depth >= self.max_depth || self.monitor.cancel().is_cancelled() || self.starved.load(Relaxed) {
            return None;
        }
        let split = best_split(primitives, &place.cell, &self.costs, scratch)?;
        if PAIR_BYTES + 4 * (split.lower + split.upper) as u64 > place.budget {
            return None;
        }
        if upper.try_reserve(split.upper).is_err() {
            self.starved.store(true, Relaxed);
            return None;
        }
        Some(split)
    }

    /// Keeps in `primitives` what lies below the plane and moves what lies above to `upper`, in order.
    fn divide(&self, primitives: &mut Vec<Primitive>, split: &Split, upper: &mut Vec<Primitive>) {
        let (axis, position) = (split.axis, split.position);
        let mut kept = 0;
        for i in 0..primitives.len() {
            let primitive = primitives[i];
            let below = if primitive.hi[axis] <= position {
                Some(primitive)
            } else if primitive.lo[axis] >= position {
                upper.push(primitive);
                None
            } else {
                let corners = self.exact_corners(primitive.id);
                let (below, above) = split_primitive(&primitive, &corners, axis, position, self.epsilon);
                upper.extend(above);
                below
            };
            if let Some(below) = below {
                primitives[kept] = below;
                kept += 1;
            }
        }
        primitives.truncate(kept);
    }
}
