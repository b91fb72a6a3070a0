// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cheapest plane through a cell by the surface area heuristic (MacDonald and Booth, "Heuristics for ray tracing
//! using space subdivision", 1990).
//!
//! Candidates are the ends of all primitives' bounds on all three axes. The result is that of the full sweep over all
//! candidates, found without sorting them all: primitives are counted into bins; what is known at a bin's two edges
//! bounds the cost of every plane within it from below, and the cost at the edges themselves bounds the cheapest plane
//! from above. Only the few bins that can hold the cheapest plane are sorted and swept.

use super::clip::{Cell, Primitive};

/// Up to here every candidate is counted against every primitive: no sorting at all.
const SMALL: usize = 16;

/// Most bins on an axis.
const MAX_BINS: usize = 256;

/// Bins per axis for a number of primitives.
fn bins_for(count: usize) -> usize {
    match count {
        0..=127 => 16,
        128..=1023 => 32,
        1024..=16383 => 64,
        _ => MAX_BINS,
    }
}

/// The costs that decide on splits, in any common unit.
#[derive(Debug, Clone, Copy)]
pub(super) struct Costs {
    /// One inner node on a ray's way.
    pub traversal: f32,
    /// One triangle test.
    pub intersection: f32,
    /// What the cost of a split that cuts off empty space is multiplied with.
    pub empty_factor: f32,
}

/// A chosen plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Split {
    pub axis: usize,
    pub position: f32,
    /// Expected cost of a ray through the cell if it is split here.
    pub cost: f32,
    /// Primitives that reach below the plane.
    pub lower: usize,
    /// Primitives that reach above the plane.
    pub upper: usize,
}

/// The cost of planes on one axis of a cell: linear in the position between two candidates.
#[derive(Clone, Copy)]
struct AxisCost {
    costs: Costs,
    lo: f32,
    hi: f32,
    /// Share of the cell's area in one cross-section.
    section: f32,
    /// Share of the cell's area per unit of length along the axis.
    slope: f32,
}

impl AxisCost {
    fn new(cell: &Cell, axis: usize, costs: &Costs) -> Self {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let (du, dv) = (cell.hi[u] as f64 - cell.lo[u] as f64, cell.hi[v] as f64 - cell.lo[v] as f64);
        let area = cell.half_area();
        AxisCost {
            costs: *costs,
            lo: cell.lo[axis],
            hi: cell.hi[axis],
            section: (du * dv / area) as f32,
            slope: ((du + dv) / area) as f32,
        }
    }

    /// With the lower child ending at `end` and the upper one starting at `start` (the same for a real plane).
    #[inline]
    fn of_parts(&self, end: f32, start: f32, lower: usize, upper: usize) -> f32 {
        let lower_area = self.section + self.slope * (end - self.lo);
        let upper_area = self.section + self.slope * (self.hi - start);
        let tests = lower as f32 * lower_area + upper as f32 * upper_area;
        let cost = self.costs.traversal + self.costs.intersection * tests;
        if lower == 0 || upper == 0 { cost * self.costs.empty_factor } else { cost }
    }

    /// With the plane at `position`, if it lies strictly within the cell; else infinite.
    #[inline]
    fn at(&self, position: f32, lower: usize, upper: usize) -> f32 {
        if position > self.lo && position < self.hi {
            self.of_parts(position, position, lower, upper)
        } else {
            f32::INFINITY
        }
    }
}

/// The best plane so far: the cheapest; among equals the first axis, then the lowest position.
struct Best {
    split: Option<Split>,
    cost: f32,
}

impl Best {
    #[inline]
    fn offer(&mut self, cost: f32, axis: usize, position: f32, lower: usize, upper: usize) {
        let better = cost < self.cost
            || (cost == self.cost && self.split.is_some_and(|s| s.axis == axis && position < s.position));
        if better {
            self.cost = cost;
            self.split = Some(Split { axis, position, cost, lower, upper });
        }
    }
}

/// Memory that is used again from node to node.
pub(super) struct Scratch {
    starts: [[u32; MAX_BINS]; 3],
    ends: [[u32; MAX_BINS]; 3],
    lows: Vec<i32>,
    highs: Vec<i32>,
}

impl Scratch {
    pub fn new() -> Self {
        Scratch { starts: [[0; MAX_BINS]; 3], ends: [[0; MAX_BINS]; 3], lows: Vec::new(), highs: Vec::new() }
    }
}

/// The cheapest plane for `primitives` in `cell`, if it is cheaper than a leaf.
pub(super) fn best_split(primitives: &[Primitive], cell: &Cell, costs: &Costs, scratch: &mut Scratch) -> Option<Split> {
    let leaf_cost = costs.intersection * primitives.len() as f32;
    if leaf_cost <= costs.traversal * costs.empty_factor {
        return None;
    }
    let axes = [0, 1, 2].map(|axis| AxisCost::new(cell, axis, costs));
    let mut best = Best { split: None, cost: leaf_cost };
    if primitives.len() <= SMALL {
        search_small(primitives, &axes, &mut best);
    } else {
        search_binned(primitives, &axes, &mut best, scratch);
    }
    best.split
}

fn search_small(primitives: &[Primitive], axes: &[AxisCost; 3], best: &mut Best) {
    for (axis, axis_cost) in axes.iter().enumerate() {
        // Padded with what counts on neither side, so that the compiler can count in vectors.
        let mut lows = [f32::INFINITY; SMALL];
        let mut highs = [f32::NEG_INFINITY; SMALL];
        for (i, p) in primitives.iter().enumerate() {
            lows[i] = p.lo[axis];
            highs[i] = p.hi[axis];
        }
        for i in 0..primitives.len() {
            for position in [lows[i], highs[i]] {
                let lower: u32 = lows.iter().map(|&lo| (lo < position) as u32).sum();
                let upper: u32 = highs.iter().map(|&hi| (hi > position) as u32).sum();
                let (lower, upper) = (lower as usize, upper as usize);
                best.offer(axis_cost.at(position, lower, upper), axis, position, lower, upper);
            }
        }
    }
}

/// Maps positions to bins; never decreasing, so that equal positions share a bin.
#[derive(Clone, Copy)]
struct Binning {
    base: f32,
    scale: f32,
    last: i32,
    width: f32,
}

impl Binning {
    fn new(lo: f32, hi: f32, bins: usize) -> Self {
        let width = (hi - lo) / bins as f32;
        let scale = if width > 0.0 { 1.0 / width } else { 0.0 };
        Binning { base: lo, scale: if scale.is_finite() { scale } else { 0.0 }, last: bins as i32 - 1, width }
    }

    #[inline]
    fn bin(&self, position: f32) -> usize {
        // The conversion saturates, and NaN (from infinite ranges) becomes 0.
        (((position - self.base) * self.scale) as i32).clamp(0, self.last) as usize
    }

    /// The lower edge of a bin.
    fn edge(&self, bin: usize) -> f32 {
        self.base + bin as f32 * self.width
    }
}

/// Maps floats to integers of the same order, for sorting.
#[inline]
fn sort_key(x: f32) -> i32 {
    let bits = x.to_bits() as i32;
    bits ^ (((bits >> 31) as u32) >> 1) as i32
}

#[inline]
fn from_sort_key(key: i32) -> f32 {
    f32::from_bits((key ^ (((key >> 31) as u32) >> 1) as i32) as u32)
}

fn search_binned(primitives: &[Primitive], axes: &[AxisCost; 3], best: &mut Best, scratch: &mut Scratch) {
    let bins = bins_for(primitives.len());
    let (mut lo, mut hi) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for p in primitives {
        for a in 0..3 {
            lo[a] = if p.lo[a] < lo[a] { p.lo[a] } else { lo[a] };
            hi[a] = if p.hi[a] > hi[a] { p.hi[a] } else { hi[a] };
        }
    }
    let binnings = [0, 1, 2].map(|a| Binning::new(lo[a], hi[a], bins));
    for a in 0..3 {
        scratch.starts[a][..bins].fill(0);
        scratch.ends[a][..bins].fill(0);
    }
    for p in primitives {
        for a in 0..3 {
            scratch.starts[a][binnings[a].bin(p.lo[a])] += 1;
            scratch.ends[a][binnings[a].bin(p.hi[a])] += 1;
        }
    }

    // From above: the cost of planes at bin edges. Between candidates the cost is linear, so a candidate is as cheap.
    let count = primitives.len();
    let mut ceiling = best.cost;
    for a in 0..3 {
        let (mut lower, mut upper) = (0, count);
        for bin in 0..bins {
            let cost = axes[a].at(binnings[a].edge(bin), lower, upper);
            ceiling = if cost < ceiling { cost } else { ceiling };
            lower += scratch.starts[a][bin] as usize;
            upper -= scratch.ends[a][bin] as usize;
        }
    }
    // Rounding must not hide a candidate that is as cheap as an edge.
    ceiling *= 1.0 + 1.0e-5;

    for a in 0..3 {
        let (starts, ends) = (&scratch.starts[a], &scratch.ends[a]);
        let mut open = [false; MAX_BINS];
        let mut any = false;
        let (mut lower, mut upper) = (0, count);
        for bin in 0..bins {
            let (first, last) = (starts[bin] as usize, ends[bin] as usize);
            upper -= last;
            if first + last > 0 {
                // Edges moved outwards a little: positions near them may have been rounded into this bin.
                let slack = 0.01 * binnings[a].width;
                let end = (binnings[a].edge(bin) - slack).max(axes[a].lo);
                let start = (binnings[a].edge(bin + 1) + slack).min(axes[a].hi);
                let floor = axes[a].of_parts(end, start, lower, upper);
                open[bin] = floor <= ceiling;
                any |= open[bin];
            }
            lower += first;
        }
        if !any {
            continue;
        }
        scratch.lows.clear();
        scratch.highs.clear();
        for p in primitives {
            if open[binnings[a].bin(p.lo[a])] {
                scratch.lows.push(sort_key(p.lo[a]));
            }
            if open[binnings[a].bin(p.hi[a])] {
                scratch.highs.push(sort_key(p.hi[a]));
            }
        }
        scratch.lows.sort_unstable();
        scratch.highs.sort_unstable();
        let (mut i, mut j) = (0, 0);
        let (mut lower, mut upper) = (0, count);
        for bin in 0..bins {
            let (first, last) = (starts[bin] as usize, ends[bin] as usize);
            if open[bin] {
                let lows = &scratch.lows[i..i + first];
                let highs = &scratch.highs[j..j + last];
                sweep(lows, highs, a, &axes[a], lower, upper, best);
                i += first;
                j += last;
            }
            lower += first;
            upper -= last;
        }
    }
}

/// Offers every candidate of a sorted stretch; `lower` primitives start below it, `upper` end in or above it.
fn sweep(
    lows: &[i32],
    highs: &[i32],
    axis: usize,
    axis_cost: &AxisCost,
    mut lower: usize,
    mut upper: usize,
    best: &mut Best,
) {
    let (mut i, mut j) = (0, 0);
    while i < lows.len() || j < highs.len() {
        let key = match (lows.get(i), highs.get(j)) {
            (Some(&lo), Some(&hi)) => lo.min(hi),
            (Some(&key), None) | (None, Some(&key)) => key,
            (None, None) => break,
        };
        let position = from_sort_key(key);
        while j < highs.len() && from_sort_key(highs[j]) == position {
            j += 1;
            upper -= 1;
        }
        best.offer(axis_cost.at(position, lower, upper), axis, position, lower, upper);
        while i < lows.len() && from_sort_key(lows[i]) == position {
            i += 1;
            lower += 1;
        }
    }
}
