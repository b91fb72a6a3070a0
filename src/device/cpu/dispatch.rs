// SPDX-License-Identifier: MIT OR Apache-2.0
//! Which instructions this processor has, and launches compiled for them.

use fearless_simd::Level;
use rayon::prelude::*;

use super::lanes::{Lanes, MOST_LANES, Mask};
use super::pack::{CHUNK, pack_count};
use super::packet::Stack;
use super::ray_tree::{Pixels, trace_pixels};
use super::similarity::Check;
use crate::device::stage::{Kernel, Stage};
use crate::device::twin::correct_tail::correct_tail;
use crate::device::twin::ray_tree::needs_correction_ray;
use crate::device::twin::{self, FrameBuffers, SceneArgs};
use crate::error::Result;
use crate::layout::*;
use crate::monitor::Monitor;

/// How many lanes packets have, and by which instructions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Width {
    /// 16 lanes by AVX-512.
    Avx512,
    /// 8 lanes by AVX2.
    Avx2,
    /// 4 lanes by SSE2.
    Sse2,
    /// 4 lanes by NEON.
    Neon,
}

impl Width {
    /// All widths.
    pub const ALL: [Width; 4] = [Width::Avx512, Width::Avx2, Width::Sse2, Width::Neon];

    /// The instruction set's name.
    pub fn name(self) -> &'static str {
        match self {
            Width::Avx512 => "AVX-512",
            Width::Avx2 => "AVX2",
            Width::Sse2 => "SSE2",
            Width::Neon => "NEON",
        }
    }

    /// Number of lanes.
    pub fn lanes(self) -> usize {
        match self {
            Width::Avx512 => 16,
            Width::Avx2 => 8,
            Width::Sse2 | Width::Neon => 4,
        }
    }

    /// The widths that this processor has, the widest first.
    pub fn available() -> impl Iterator<Item = Width> {
        Width::ALL.into_iter().filter(|width| width.run(Nothing).is_some())
    }

    /// Runs `work` with the token of the instruction set; `None` if this processor does not have it.
    fn run<W: Work>(self, work: W) -> Option<W::Output> {
        let level = Level::try_detect()?;
        match self {
            #[cfg(all(target_arch = "x86_64", not(target_os = "android")))]
            Width::Avx512 => level.as_avx512().map(|l| work.run::<_, 2>(l)),
            #[cfg(all(target_arch = "x86_64", not(target_os = "android")))]
            Width::Avx2 => level.as_avx2().map(|l| work.run::<_, 2>(l)),
            #[cfg(all(target_arch = "x86_64", not(target_os = "android")))]
            Width::Sse2 => level.as_sse2().map(|l| work.run::<_, 4>(l)),
            // Half as much code: Android's file has a limit, and only emulators are of this kind.
            #[cfg(all(target_arch = "x86_64", target_os = "android"))]
            Width::Sse2 => level.as_sse2().map(|l| work.run::<_, 2>(l)),
            #[cfg(target_arch = "aarch64")]
            Width::Neon => level.as_neon().map(|l| work.run::<_, 4>(l)),
            #[allow(unreachable_patterns)]
            _ => None,
        }
    }
}

/// What is compiled for each instruction set.
trait Work {
    type Output;
    /// `K`: vectors of a packet, which share the nodes that they visit.
    fn run<L: Lanes, const K: usize>(self, l: L) -> Self::Output;
}

/// Asks for an instruction set only.
struct Nothing;

impl Work for Nothing {
    type Output = ();
    fn run<L: Lanes, const K: usize>(self, _: L) {}
}

/// A launch.
#[derive(Clone, Copy)]
struct WideLaunch<'a> {
    stage: Stage,
    kernel: Kernel,
    scene: &'a SceneArgs<'a>,
    step: &'a StepParams,
    buffers: &'a FrameBuffers,
    monitor: &'a Monitor,
}

/// Launches `kernel` for `stage` in packets of `width`; what has no wide form, and what is counted, runs as its twin.
///
/// # Errors
/// [`crate::Error::Cancelled`]: the buffers hold anything then.
pub fn run(
    width: Width,
    (stage, kernel): (Stage, Kernel),
    scene: &SceneArgs,
    step: &StepParams,
    buffers: &FrameBuffers,
    monitor: &Monitor,
) -> Result<()> {
    // Counters are those of the scalar walk: a packet looks into cells that a ray by itself would spare.
    let is_wide = buffers.counters.is_empty()
        && match kernel {
            Kernel::Trace | Kernel::Check | Kernel::CorrectTail => true,
            Kernel::PackCount => !step.flags.contains(StepFlags::PROBES),
            _ => false,
        };
    let launch = WideLaunch { stage, kernel, scene, step, buffers, monitor };
    match is_wide.then(|| width.run(launch)).flatten() {
        Some(()) => monitor.check(),
        None => twin::run(stage, kernel, scene, step, buffers, monitor),
    }
}

impl Work for WideLaunch<'_> {
    type Output = ();

    fn run<L: Lanes, const K: usize>(self, l: L) {
        match (self.kernel, self.stage) {
            (Kernel::Check, _) => self.check(l),
            (Kernel::PackCount, _) => (0..self.step.item_count.div_ceil(CHUNK))
                .into_par_iter()
                .with_min_len(CHUNKS_AT_ONCE)
                .for_each(|chunk| pack_count(self.scene, self.step, chunk, self.buffers)),
            (Kernel::CorrectTail, _) => correct_tail(self.scene, self.step, self.buffers, |round| {
                WideLaunch { step: round, ..self }.trace_list::<L, K>(l);
            }),
            (_, Stage::Step1) => self.trace_grid::<L, K>(l),
            _ => self.trace_list::<L, K>(l),
        }
    }
}

/// Chunks that a thread packs at least.
const CHUNKS_AT_ONCE: usize = 64;

/// Packets that are traced sooner than another thread wakes up.
const PACKETS_ALONE: usize = 4;

/// Entries of a list that are put in order before they are cut into packets: those of a few tiles.
const MOST_ENTRIES: usize = 512;

/// Parts of a list for each thread, at least: the dear ones are not all in one place.
const PARTS_PER_THREAD: usize = 8;

/// Where a packed pixel lies on a Z-curve: neighbours on it are near each other in both directions, so that packets of
/// listed pixels are compact. The items of a list do not depend on each other, so their order is ours to choose.
fn z_order(pixel: u32) -> u32 {
    let spread = |mut v: u32| {
        v = (v | v << 8) & 0x00ff_00ff;
        v = (v | v << 4) & 0x0f0f_0f0f;
        v = (v | v << 2) & 0x3333_3333;
        (v | v << 1) & 0x5555_5555
    };
    spread(pixel & 0xffff) | spread(pixel >> 16) << 1
}

/// Pixels of a packet's side: packets are as square as they can be.
fn packet_shape(rays: u32) -> (u32, u32) {
    let height = 1 << (rays.ilog2() / 2);
    (rays / height, height)
}

impl WideLaunch<'_> {
    fn is_cancelled(&self) -> bool {
        self.monitor.cancel().is_cancelled()
    }

    fn check<L: Lanes>(&self, l: L) {
        let step = self.step;
        let rows_done = std::sync::atomic::AtomicU32::new(0);
        (0..step.grid_height).into_par_iter().for_each(|gy| {
            l.enter(
                #[inline(always)]
                || self.check_row(l, gy),
            );
            self.tell_row(&rows_done, step.grid_height);
        });
    }

    fn tell_row(&self, rows_done: &std::sync::atomic::AtomicU32, rows: u32) {
        let done = rows_done.fetch_add(1, std::sync::atomic::Ordering::Relaxed) + 1;
        self.monitor.tell(done as f32 / rows as f32);
    }

    #[inline(always)]
    fn check_row<L: Lanes>(&self, l: L, gy: u32) {
        let Self { scene, step, buffers, .. } = *self;
        let check = Check { l, scene, step, buffers };
        for first in (0..step.grid_width).step_by(L::COUNT) {
            if self.is_cancelled() {
                return;
            }
            let (mut x, mut y, mut lanes) = ([0; MOST_LANES], 0, 0);
            for lane in 0..L::COUNT.min((step.grid_width - first) as usize) {
                (x[lane], y) = grid_pixel(scene.frame, step, first + lane as u32, gy);
                lanes |= u32::from(x[lane] < scene.frame.width) << lane;
            }
            check.check_pixels(&x, y, Mask::from_bits(l, lanes));
        }
    }

    fn trace_grid<L: Lanes, const K: usize>(&self, l: L) {
        let step = self.step;
        let (width, height) = packet_shape((K * L::COUNT) as u32);
        let rows = step.grid_height.div_ceil(height);
        let rows_done = std::sync::atomic::AtomicU32::new(0);
        (0..rows).into_par_iter().for_each_init(
            || Stack::<L, K>::new(l),
            |stack, row| {
                for column in 0..step.grid_width.div_ceil(width) {
                    if self.is_cancelled() {
                        return;
                    }
                    let mut pixels = Pixels::<K>::NONE;
                    for i in 0..(K * L::COUNT) as u32 {
                        let (gx, gy) = (column * width + i % width, row * height + i / width);
                        if gx < step.grid_width && gy < step.grid_height {
                            let (x, y) = grid_pixel(self.scene.frame, step, gx, gy);
                            if x < self.scene.frame.width {
                                pixels.set::<L>(i as usize, (x, y));
                            }
                        }
                    }
                    self.trace(l, &pixels, CLASS_BASE, stack);
                }
                self.tell_row(&rows_done, rows);
            },
        );
    }

    fn trace_list<L: Lanes, const K: usize>(&self, l: L) {
        let step = self.step;
        let rays = K * L::COUNT;
        let items = step.item_count as usize;
        // Short lists are shared out, too.
        let fair = items / (PARTS_PER_THREAD * rayon::current_num_threads());
        let part = fair.clamp(rays, MOST_ENTRIES).next_multiple_of(rays);
        let new_stack = || (Stack::<L, K>::new(l), Vec::with_capacity(part));
        let trace = |(stack, entries): &mut (Stack<L, K>, Vec<u32>), at: usize| {
            entries.clear();
            entries.extend((at..items.min(at + part)).map(|i| self.buffers.list.get(step.list_offset + i as u32)));
            entries.sort_unstable_by_key(|&pixel| z_order(pixel));
            for packet in entries.chunks(rays) {
                if self.is_cancelled() {
                    return;
                }
                self.trace_entries(l, packet, stack);
            }
        };
        let parts = items.div_ceil(part);
        if items <= PACKETS_ALONE * rays {
            let mut state = new_stack();
            (0..parts).for_each(|i| trace(&mut state, i * part));
        } else {
            (0..parts).into_par_iter().for_each_init(new_stack, |state, i| trace(state, i * part));
        }
    }

    fn trace_entries<L: Lanes, const K: usize>(&self, l: L, entries: &[u32], stack: &mut Stack<L, K>) {
        let mut pixels = Pixels::<K>::NONE;
        for (i, &pixel) in entries.iter().enumerate() {
            let at = (pixel & 0xffff, pixel >> 16);
            if self.step.pixel_class != CLASS_CORRECTED
                || needs_correction_ray(self.scene.frame, self.step, &self.buffers.attributes, at)
            {
                pixels.set::<L>(i, at);
            }
        }
        self.trace(l, &pixels, self.step.pixel_class, stack);
    }

    fn trace<L: Lanes, const K: usize>(&self, l: L, pixels: &Pixels<K>, class: u32, stack: &mut Stack<L, K>) {
        if pixels.lanes == [0; K] {
            return;
        }
        l.enter(
            #[inline(always)]
            || trace_pixels(l, self.scene, pixels, class, self.step, self.buffers, stack),
        );
    }
}

impl<const K: usize> Pixels<K> {
    /// Gives the `i`-th ray of the packet a pixel.
    fn set<L: Lanes>(&mut self, i: usize, (x, y): (u32, u32)) {
        let (k, lane) = (i / L::COUNT, i % L::COUNT);
        (self.x[k][lane], self.y[k][lane]) = (x, y);
        self.lanes[k] |= 1 << lane;
    }
}

#[cfg(test)]
mod tests {
    use super::super::lanes::Floats;
    use super::*;
    use crate::math::{max2, min2};

    #[test]
    fn the_z_curve_goes_through_blocks_before_it_leaves_them() {
        let at = |x: u32, y: u32| z_order(x | y << 16);
        assert_eq!([at(0, 0), at(1, 0), at(0, 1), at(1, 1), at(2, 0)], [0, 1, 2, 3, 4]);
        assert_eq!(at(0xffff, 0xffff), u32::MAX);
        // The 64 pixels of any aligned 8x8 block follow each other.
        let mut block: Vec<u32> = (0..64).map(|i| at(136 + i % 8, 4096 + i / 8)).collect();
        block.sort_unstable();
        assert!(block.windows(2).all(|pair| pair[0] + 1 == pair[1]));
    }

    /// The bits of the lesser and of the greater of each pair, lane by lane.
    struct Extremes<'a>(&'a [(f32, f32)]);

    impl Work for Extremes<'_> {
        type Output = Vec<(u32, u32)>;

        fn run<L: Lanes, const K: usize>(self, l: L) -> Self::Output {
            self.0
                .iter()
                .flat_map(|&(a, b)| {
                    // Other values in the other lanes, so that a lane that takes its neighbour's is seen.
                    let (mut first, mut second) = ([7.0; MOST_LANES], [8.0; MOST_LANES]);
                    (first[L::COUNT - 1], second[L::COUNT - 1]) = (a, b);
                    let (a, b) = (Floats::from_array(l, &first), Floats::from_array(l, &second));
                    let (lesser, greater) = (a.min2(b).to_array(), a.max2(b).to_array());
                    [0, L::COUNT - 1].map(|lane| (lesser[lane].to_bits(), greater[lane].to_bits()))
                })
                .collect()
        }
    }

    #[test]
    fn extremes_of_the_engine_are_those_of_the_twin_also_of_nan_and_zeros() {
        let values = [0.0, -0.0, 1.0, -1.0, 1e-40, f32::NAN, -f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX];
        let pairs: Vec<(f32, f32)> = values.iter().flat_map(|&a| values.map(|b| (a, b))).collect();
        let bits = |(a, b)| (min2(a, b).to_bits(), max2(a, b).to_bits());
        let expected: Vec<(u32, u32)> = pairs.iter().flat_map(|&pair| [bits((7.0, 8.0)), bits(pair)]).collect();
        for width in Width::available() {
            assert_eq!(width.run(Extremes(&pairs)), Some(expected.clone()), "{width:?}");
        }
    }
}
