// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cheapest plane through a cell by the surface area heuristic (MacDonald and Booth, "Heuristics for ray tracing
//! using space subdivision", 1990).
//!
//! Candidates are the ends of all primitives' bounds on all three axes. The result is that of the full sweep over all
//! candidates, found without sorting them all: primitives are counted into bins; what is known at a bin's two edges
//! bounds the cost of every plane within it from below, and the cost at the edges themselves bounds the cheapest plane
//! from above. Only the few bins that can hold the cheapest plane are sorted and swept.

use super::clip::{Cell, Primitive};
use crate::math::{clamp, max2, min2};

/// Up to here every candidate is counted against every primitive: no sorting at all.
const SMALL: usize = 32;

/// Candidates that are counted together.
const BLOCK: usize = 8;

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
    /// `half_area` of the cell.
    fn new(cell: &Cell, half_area: f64, axis: usize, costs: &Costs) -> Self {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let (du, dv) = (cell.hi[u] as f64 - cell.lo[u] as f64, cell.hi[v] as f64 - cell.lo[v] as f64);
        AxisCost {
            costs: *costs,
            lo: cell.lo[axis],
            hi: cell.hi[axis],
            section: (du * dv / half_area) as f32,
            slope: ((du + dv) / half_area) as f32,
        }
    }

    /// With the lower child ending at `end` and the upper one starting at `start` (the same for a real plane).
    #[inline]
    fn of_parts(&self, end: f32, start: f32, lower: f32, upper: f32) -> f32 {
        let lower_area = self.section + self.slope * (end - self.lo);
        let upper_area = self.section + self.slope * (self.hi - start);
        let tests = lower * lower_area + upper * upper_area;
        let cost = self.costs.traversal + self.costs.intersection * tests;
        if min2(lower, upper) == 0.0 { cost * self.costs.empty_factor } else { cost }
    }

    /// With the plane at `position`, if it lies strictly within the cell; else infinite.
    #[inline]
    fn at(&self, position: f32, lower: f32, upper: f32) -> f32 {
        let cost = self.of_parts(position, position, lower, upper);
        if (position > self.lo) & (position < self.hi) { cost } else { f32::INFINITY }
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
    axes: [AxisCounts; 3],
    lows: Vec<i32>,
    highs: Vec<i32>,
}

impl Scratch {
    pub fn new() -> Self {
        Scratch { axes: [AxisCounts::NEW; 3], lows: Vec::new(), highs: Vec::new() }
    }
}

/// What is known about the bins of an axis.
#[derive(Clone, Copy)]
struct AxisCounts {
    /// Primitives whose bounds start in a bin.
    starts: [i32; MAX_BINS],
    /// Primitives whose bounds end in a bin.
    ends: [i32; MAX_BINS],
    /// Primitives that start below a bin.
    lower: [i32; MAX_BINS],
    /// Primitives that end in a bin or above it; one more entry for what lies behind the last bin.
    upper: [i32; MAX_BINS + 1],
    /// No plane in a bin is cheaper than this.
    floors: [f32; MAX_BINS],
    /// Whether the cheapest plane may lie in a bin.
    open: [bool; MAX_BINS],
}

impl AxisCounts {
    const NEW: Self = AxisCounts {
        starts: [0; MAX_BINS],
        ends: [0; MAX_BINS],
        lower: [0; MAX_BINS],
        upper: [0; MAX_BINS + 1],
        floors: [0.0; MAX_BINS],
        open: [false; MAX_BINS],
    };

    /// Adds up the counts, sets `floors`, and returns a cost that the cheapest plane does not exceed: the lowest at a
    /// bin's edge, for between two candidates the cost is linear, so that one of them is at least as cheap.
    fn bound(&mut self, bins: usize, cost: &AxisCost, binning: &Binning, count: usize) -> f32 {
        let (mut lower, mut upper) = (0, count as i32);
        for bin in 0..bins {
            self.lower[bin] = lower;
            self.upper[bin] = upper;
            lower += self.starts[bin];
            upper -= self.ends[bin];
        }
        self.upper[bins] = upper;
        // Edges are known only to within rounding (which matters in thin cells far from the origin).
        let reach = max2(cost.lo.abs(), cost.hi.abs());
        let slack = 0.01 * binning.width + 2.0 * f32::EPSILON * reach;
        let mut ceiling = f32::INFINITY;
        let (lowers, uppers) = (&self.lower[..bins], &self.upper[..bins + 1]);
        for (bin, floor) in self.floors[..bins].iter_mut().enumerate() {
            let (edge, next) = (binning.edge(bin as i32 as f32), binning.edge(bin as i32 as f32 + 1.0));
            let (lower, upper, upper_next) = (lowers[bin] as f32, uppers[bin] as f32, uppers[bin + 1] as f32);
            let at_edge = cost.of_parts(edge + slack, edge - slack, lower, upper);
            let inside = (edge > cost.lo) & (edge < cost.hi);
            ceiling = min2(if inside { at_edge } else { f32::INFINITY }, ceiling);
            *floor = cost.of_parts(max2(edge - slack, cost.lo), min2(next + slack, cost.hi), lower, upper_next);
        }
        ceiling
    }
}

/// The cheapest plane for `primitives` in `cell`, if it is cheaper than a leaf.
pub(super) fn best_split(primitives: &[Primitive], cell: &Cell, costs: &Costs, scratch: &mut Scratch) -> Option<Split> {
    let leaf_cost = costs.intersection * primitives.len() as f32;
    if leaf_cost <= costs.traversal * costs.empty_factor {
        return None;
    }
    let half_area = cell.half_area();
    let axes = [0, 1, 2].map(|axis| AxisCost::new(cell, half_area, axis, costs));
    let mut best = Best { split: None, cost: leaf_cost };
    match primitives.len() {
        0..=SMALL => search_small(primitives, &axes, &mut best),
        _ => search_binned(primitives, &axes, &mut best, scratch),
    }
    best.split
}

/// Counts every candidate against every primitive, on all axes; a block of candidates at a time, in arrays of fixed
/// size and without branches, so that the compiler does it in vectors. Ends on the cell's own sides, of which small cells
/// have many, are no candidates and are counted at once.
fn search_small(primitives: &[Primitive], axes: &[AxisCost; 3], best: &mut Best) {
    let count = primitives.len().min(SMALL);
    for (axis, axis_cost) in axes.iter().enumerate() {
        let (mut lows, mut highs) = ([0.0; SMALL], [0.0; SMALL]);
        let (mut low_count, mut high_count) = (0, 0);
        // Written always and kept if wanted: no branch that depends on the data.
        for p in &primitives[..count] {
            lows[low_count % SMALL] = p.lo[axis];
            low_count += (p.lo[axis] > axis_cost.lo) as usize;
            highs[high_count % SMALL] = p.hi[axis];
            high_count += (p.hi[axis] < axis_cost.hi) as usize;
        }
        let (lows, highs) = (&lows[..low_count], &highs[..high_count]);
        // What follows the last candidate lies in no cell.
        let mut positions = [f32::INFINITY; 2 * SMALL];
        positions[..low_count].copy_from_slice(lows);
        positions[low_count..low_count + high_count].copy_from_slice(highs);
        let blocks = (low_count + high_count).div_ceil(BLOCK);
        let (below, above) = ((count - low_count) as i32, (count - high_count) as i32);
        for block in positions.as_chunks::<BLOCK>().0[..blocks].iter() {
            let (mut lower, mut upper) = ([below; BLOCK], [above; BLOCK]);
            for &lo in lows {
                for k in 0..BLOCK {
                    lower[k] += (lo < block[k]) as i32;
                }
            }
            for &hi in highs {
                for k in 0..BLOCK {
                    upper[k] += (hi > block[k]) as i32;
                }
            }
            let mut costs = [0.0; BLOCK];
            for k in 0..BLOCK {
                costs[k] = axis_cost.at(block[k], lower[k] as f32, upper[k] as f32);
            }
            let mut halves = [0.0; BLOCK / 2];
            for (k, half) in halves.iter_mut().enumerate() {
                *half = min2(costs[k], costs[k + BLOCK / 2]);
            }
            let cheapest = halves.into_iter().fold(f32::INFINITY, min2);
            if cheapest <= best.cost {
                for k in (0..BLOCK).filter(|&k| costs[k] == cheapest) {
                    best.offer(cheapest, axis, block[k], lower[k] as usize, upper[k] as usize);
                }
            }
        }
    }
}

/// Adding this leaves the nearest integer to a small float in the lowest bits.
const ROUND: f32 = (1 << 23) as f32;

/// Maps positions on an axis to bins; never decreasing, so that equal positions share a bin.
#[derive(Clone, Copy)]
struct Binning {
    base: f32,
    scale: f32,
    last: f32,
    width: f32,
}

impl Binning {
    fn new(lo: f32, hi: f32, bins: usize) -> Self {
        let width = (hi - lo) / bins as f32;
        let scale = if width > 0.0 { 1.0 / width } else { 0.0 };
        // Bins are rounded to nearest, hence the half.
        let last = bins as f32 - 1.0;
        Binning { base: lo + 0.5 * width, scale: if scale.is_finite() { scale } else { 0.0 }, last, width }
    }

    #[inline]
    fn bin(&self, position: f32) -> usize {
        let scaled = clamp((position - self.base) * self.scale, 0.0, self.last);
        // Faster than a conversion, and all axes at once in vectors.
        (scaled + ROUND).to_bits() as usize % MAX_BINS
    }

    /// The lower edge of a bin.
    #[inline]
    fn edge(&self, bin: f32) -> f32 {
        self.base + (bin - 0.5) * self.width
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
    let binnings = [0, 1, 2].map(|a| Binning::new(axes[a].lo, axes[a].hi, bins));
    for axis in &mut scratch.axes {
        axis.starts[..bins].fill(0);
        axis.ends[..bins].fill(0);
    }
    for p in primitives {
        for (a, counts) in scratch.axes.iter_mut().enumerate() {
            counts.starts[binnings[a].bin(p.lo[a])] += 1;
            counts.ends[binnings[a].bin(p.hi[a])] += 1;
        }
    }

    let mut ceiling = best.cost;
    for a in 0..3 {
        ceiling = min2(scratch.axes[a].bound(bins, &axes[a], &binnings[a], primitives.len()), ceiling);
    }
    // Rounding must not hide a candidate that is as cheap as an edge.
    ceiling *= 1.0 + 1.0e-5;

    for (a, (axis_cost, binning)) in axes.iter().zip(&binnings).enumerate() {
        let counts = &mut scratch.axes[a];
        let mut any = false;
        for bin in 0..bins {
            counts.open[bin] = counts.floors[bin] <= ceiling && counts.starts[bin] + counts.ends[bin] > 0;
            any |= counts.open[bin];
        }
        if !any {
            continue;
        }
        // Written always and kept if wanted: no branch that depends on the data.
        scratch.lows.resize(primitives.len() + 1, 0);
        scratch.highs.resize(primitives.len() + 1, 0);
        let (mut i, mut j) = (0, 0);
        for p in primitives {
            scratch.lows[i] = sort_key(p.lo[a]);
            i += counts.open[binning.bin(p.lo[a])] as usize;
            scratch.highs[j] = sort_key(p.hi[a]);
            j += counts.open[binning.bin(p.hi[a])] as usize;
        }
        scratch.lows[..i].sort_unstable();
        scratch.highs[..j].sort_unstable();
        let (mut i, mut j) = (0, 0);
        for bin in (0..bins).filter(|&bin| counts.open[bin]) {
            let (first, last) = (counts.starts[bin] as usize, counts.ends[bin] as usize);
            let (lows, highs) = (&scratch.lows[i..i + first], &scratch.highs[j..j + last]);
            sweep(lows, highs, a, axis_cost, counts.lower[bin] as usize, counts.upper[bin] as usize, best);
            i += first;
            j += last;
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
        best.offer(axis_cost.at(position, lower as f32, upper as f32), axis, position, lower, upper);
        while i < lows.len() && from_sort_key(lows[i]) == position {
            i += 1;
            lower += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const COSTS: Costs = Costs { traversal: 1.0, intersection: 0.5, empty_factor: 0.8 };

    /// The plain search: every candidate, everything counted anew.
    fn full_sweep(primitives: &[Primitive], cell: &Cell) -> Option<Split> {
        let mut best = Best { split: None, cost: COSTS.intersection * primitives.len() as f32 };
        for axis in 0..3 {
            let axis_cost = AxisCost::new(cell, cell.half_area(), axis, &COSTS);
            let mut positions: Vec<f32> = primitives.iter().flat_map(|p| [p.lo[axis], p.hi[axis]]).collect();
            positions.sort_by(f32::total_cmp);
            positions.dedup();
            for position in positions {
                let lower = primitives.iter().filter(|p| p.lo[axis] < position).count();
                let upper = primitives.iter().filter(|p| p.hi[axis] > position).count();
                let cost = axis_cost.at(position, lower as f32, upper as f32);
                best.offer(cost, axis, position, lower, upper);
            }
        }
        best.split
    }

    struct Random(u32);

    impl Random {
        fn unit(&mut self) -> f32 {
            self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (self.0 >> 8) as f32 / (1 << 24) as f32
        }
    }

    /// Boxes in `cell`, on a grid of `grid` steps if that is not 0.
    fn boxes(random: &mut Random, count: usize, size: f32, grid: f32, cell: &Cell) -> Vec<Primitive> {
        (0..count as u32)
            .map(|id| {
                let mut p = Primitive { lo: [0.0; 3], id, hi: [0.0; 3], unused: 0 };
                for a in 0..3 {
                    let mut lo = random.unit();
                    // Squared, so that boxes are crowded on one side.
                    lo *= lo;
                    let mut hi = lo + random.unit() * size;
                    if grid > 0.0 {
                        (lo, hi) = ((lo * grid).floor() / grid, (hi * grid).floor() / grid);
                    }
                    let extent = cell.hi[a] - cell.lo[a];
                    p.lo[a] = (cell.lo[a] + lo * extent).min(cell.hi[a].next_down());
                    p.hi[a] = (cell.lo[a] + hi * extent).min(cell.hi[a]).max(p.lo[a].next_up());
                }
                p
            })
            .collect()
    }

    #[test]
    fn the_search_finds_what_the_full_sweep_finds() {
        let cells = [
            Cell { lo: [0.0; 3], hi: [1.0; 3] },
            Cell { lo: [-5.0, 1.0, -0.001], hi: [9.0, 1.25, 0.001] },
            // A few dozen units in the last place thick, far from the origin.
            Cell { lo: [100.0, 0.0, 0.0], hi: [100.0 + 64.0 * 7.6e-6, 7.0, 8.0] },
        ];
        let mut random = Random(1);
        let mut scratch = Scratch::new();
        let mut splits = 0;
        for count in (1..70).chain([100, 127, 128, 300, 1000, 1024, 3000]) {
            for (i, cell) in cells.iter().enumerate() {
                for (size, grid) in [(0.02, 0.0), (0.3, 0.0), (0.1, 16.0), (0.1, 100.0)] {
                    let primitives = boxes(&mut random, count, size, grid, cell);
                    let found = best_split(&primitives, cell, &COSTS, &mut scratch);
                    assert_eq!(found, full_sweep(&primitives, cell), "{count} boxes of {size}, grid {grid}, cell {i}");
                    splits += found.is_some() as usize;
                }
            }
        }
        assert!(splits > 500, "only {splits} splits");
    }

    #[test]
    fn equal_boxes_are_not_split_but_cut_out() {
        let cell = Cell { lo: [0.0; 3], hi: [1.0; 3] };
        let full = Primitive { lo: cell.lo, id: 0, hi: cell.hi, unused: 0 };
        let mut scratch = Scratch::new();
        for count in [3, 20, 1000] {
            assert_eq!(best_split(&vec![full; count], &cell, &COSTS, &mut scratch), None);
            let small = Primitive { hi: [1.0, 0.125, 1.0], ..full };
            let split = best_split(&vec![small; count], &cell, &COSTS, &mut scratch);
            let split = split.map(|s| (s.axis, s.position, s.lower, s.upper));
            assert_eq!(split, Some((1, 0.125, count, 0)));
        }
    }

    #[test]
    fn sort_keys_keep_the_order() {
        let values = [f32::NEG_INFINITY, -3.0, -1e-30, -0.0, 0.0, 1e-30, 2.0, f32::INFINITY];
        assert!(values.map(sort_key).is_sorted_by(|a, b| a < b));
        assert!(values.iter().all(|&v| from_sort_key(sort_key(v)).to_bits() == v.to_bits()));
    }
}
