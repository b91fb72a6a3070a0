// SPDX-License-Identifier: MIT OR Apache-2.0
//! Post-correction against its definition: the least fixed point of "a traced adaptive pixel whose interpolated
//! neighbour differs has that neighbour traced; one that turns out changed goes on", found here by a plain worklist
//! that takes what rays find from the full picture.
#![allow(clippy::unwrap_used)]

use rarefy::internal::device::frame_memory::FrameBuffer;
use rarefy::internal::device::queue::Queue;
use rarefy::internal::device::stage::{Kernel, Stage};
use rarefy::internal::layout::*;
use rarefy::internal::method::options::{Compared, Correction, Mode, RenderOptions, Spread};
use rarefy::internal::render::renderer::Renderer;
use rarefy::internal::scene::Scene;
use rarefy::internal::scene::builtin;
use rarefy_host_tests::fixtures::*;

/// The planes of a frame that correction is about, row-major.
#[derive(Debug, Clone, PartialEq)]
struct Planes {
    width: usize,
    class: Vec<u32>,
    object: Vec<u32>,
    shadow: Vec<u32>,
    color: Vec<u32>,
}

fn planes(renderer: &mut Renderer, options: &RenderOptions) -> Planes {
    let frame = draw(renderer, options);
    planes_of(renderer, options, frame.pixels)
}

fn planes_of(renderer: &mut Renderer, options: &RenderOptions, color: Vec<u32>) -> Planes {
    let mut plane = |plane| renderer.plane(plane).unwrap();
    // Without the repeats of textures, which no rule of correction reads.
    let class = plane(PLANE_CLASS).into_iter().map(|word| word & (CLASS_MASK | CLASS_CHECKED)).collect();
    Planes { width: options.width as usize, class, object: plane(PLANE_OBJECT), shadow: plane(PLANE_SHADOW), color }
}

impl Planes {
    fn is(&self, at: usize, classes: &[u32]) -> bool {
        classes.contains(&(self.class[at] & CLASS_MASK))
    }

    fn neighbours(&self, at: usize) -> impl Iterator<Item = usize> + use<> {
        let (width, len) = (self.width, self.class.len());
        let left = (!at.is_multiple_of(width)).then(|| at - 1);
        let right = (at % width + 1 < width).then_some(at + 1);
        let up = (at >= width).then(|| at - width);
        let down = (at + width < len).then_some(at + width);
        [left, right, up, down].into_iter().flatten()
    }

    fn differ(&self, a: usize, b: usize, shadows: bool) -> bool {
        self.object[a] != self.object[b] || (shadows && self.shadow[a] != self.shadow[b])
    }

    fn spreads(&self, from: usize, to: usize, shadows: bool) -> bool {
        self.is(from, &[CLASS_TRACED, CLASS_CORRECTED])
            && self.is(to, &[CLASS_INTERPOLATED])
            && self.differ(from, to, shadows)
    }

    /// Whether `from` lies at the straight edge of something thick, or on a line that runs past, so that it misses `to`.
    fn misses_neighbour(&self, from: usize, to: usize, shadows: bool) -> bool {
        let (width, height) = (self.width as isize, (self.class.len() / self.width) as isize);
        let at = |pixel: usize| (pixel as isize % width, pixel as isize / width);
        let ((x, y), (nx, ny)) = (at(from), at(to));
        let same = |back: isize, along: isize| {
            let (bx, by) = (x - back * (nx - x) + along * (ny - y), y - back * (ny - y) + along * (nx - x));
            (0..width).contains(&bx)
                && (0..height).contains(&by)
                && !self.differ(from, (by * width + bx) as usize, shadows)
        };
        let is_edge = (-1..=1).all(|along| same(1, along)) && (same(0, -1) || same(0, 1));
        is_edge || !same(1, 0) && same(0, -1) && same(0, 1)
    }

    /// Does the pixel differ from those above and below it?
    fn is_thin(&self, at: usize, shadows: bool) -> bool {
        self.differ(at, at - self.width, shadows) && self.differ(at, at + self.width, shadows)
    }

    /// The interpolated pixel beside `from` that lies midway between two parts of something thin, one of them above or
    /// below `from`.
    fn bridged(&self, from: usize, shadows: bool) -> Option<usize> {
        let (width, height) = (self.width, self.class.len() / self.width);
        let (x, y) = ((from % width) as isize, from / width);
        if y % 2 == 0 || y < 2 || y + 2 >= height {
            return None;
        }
        let (up, down) = (from - width, from + width);
        let (near, across) = if self.is_thin(up, shadows) { (up, y + 1) } else { (down, y - 1) };
        let sides = (1..=BRIDGE_REACH as isize).flat_map(|k| [-k, k]);
        let parts = sides.filter(|k| (0..width as isize).contains(&(x + 2 * k))).filter(|k| {
            let part = across * width + (x + 2 * k) as usize;
            !self.differ(near, part, shadows) && self.is_thin(part, shadows)
        });
        let middle = y * width + (x + parts.into_iter().next().filter(|_| self.is_thin(near, shadows))?) as usize;
        (self.is(middle, &[CLASS_INTERPOLATED]) && self.differ(near, middle, shadows)).then_some(middle)
    }

    fn fired(&self) -> Vec<usize> {
        (0..self.class.len()).filter(|&at| self.is(at, &[CLASS_CORRECTED, CLASS_CONFIRMED])).collect()
    }

    /// Pixels whose object (or shadow bits) are not those of full tracing.
    fn wrong(&self, full: &Planes, shadows: bool) -> Vec<usize> {
        let differs =
            |&at: &usize| self.object[at] != full.object[at] || (shadows && self.shadow[at] != full.shadow[at]);
        (0..self.class.len()).filter(differs).collect()
    }
}

/// The worklist. `order` says which waiting pixel is next; `full` what a ray finds.
fn least_fixed_point(before: &Planes, full: &Planes, shadows: bool, order: &mut dyn FnMut(usize) -> usize) -> Planes {
    fixed_point(before, full, shadows, Rules::default(), order)
}

/// What goes beyond the paper's rule.
#[derive(Debug, Clone, Copy, Default)]
struct Rules {
    thin_only: bool,
    bridges: bool,
}

impl Rules {
    /// The options with correction by these rules.
    fn of(self, options: &RenderOptions) -> RenderOptions {
        let Rules { thin_only, bridges } = self;
        with(options, |method| {
            let compared = method.correction.compared().expect("a correction");
            method.correction = Correction::Converged { compared, thin_only, bridges, probes: false };
        })
    }
}

/// What the traced pixels saw before any correction decides which of them pass a neighbour by, and where gaps are.
fn fixed_point(
    before: &Planes,
    full: &Planes,
    shadows: bool,
    rules: Rules,
    order: &mut dyn FnMut(usize) -> usize,
) -> Planes {
    let mut now = before.clone();
    let mut waiting: Vec<usize> = (0..now.class.len()).filter(|&at| now.is(at, &[CLASS_TRACED])).collect();
    while !waiting.is_empty() {
        let from = waiting.swap_remove(order(waiting.len()));
        let is_traced = before.is(from, &[CLASS_TRACED]);
        let bridged = if rules.bridges && is_traced { before.bridged(from, shadows) } else { None };
        for to in now.neighbours(from).chain(bridged) {
            let spared = rules.thin_only && is_traced && before.misses_neighbour(from, to, shadows);
            let reached = Some(to) == bridged && now.is(to, &[CLASS_INTERPOLATED]);
            if !reached && (spared || !now.spreads(from, to, shadows)) {
                continue;
            }
            let old = (now.object[to], now.shadow[to]);
            (now.object[to], now.shadow[to], now.color[to]) = (full.object[to], full.shadow[to], full.color[to]);
            let changed = old.0 != now.object[to] || (shadows && old.1 != now.shadow[to]);
            now.class[to] = if changed { CLASS_CORRECTED } else { CLASS_CONFIRMED };
            if changed {
                waiting.push(to);
            }
        }
    }
    now
}

/// Correction by the paper's rule; what goes beyond it is switched on by [`Rules::of`].
fn adaptive(width: u32, height: u32, block: u32, correction: Correction) -> RenderOptions {
    with(&options(Mode::Adaptive, width, height, block), |method| {
        method.correction = correction;
        method.reuse_shadows = false;
    })
}

fn full(renderer: &mut Renderer, width: u32, height: u32) -> Planes {
    planes(renderer, &options(Mode::Full, width, height, 2))
}

/// A lattice of thin bars of many objects under two lights, in front of a wall and the background.
fn lattice() -> Scene {
    let mut builder = SceneBuilder::new("lattice").camera(v(0.3, 0.2, 3.0), v(0.0, 0.0, 0.0), 45.0);
    builder = builder.light(v(2.0, 2.0, 3.0), 6.0).light(v(-1.5, 1.0, 2.0), 4.0).environment(0.1, v(0.3, 0.4, 0.5));
    builder.object(matte(v(0.8, 0.8, 0.7)));
    builder.wall(glam::Vec2::splat(-0.9), glam::Vec2::splat(0.9), -0.5);
    let mut random = Random::new(3);
    for i in 0..24 {
        builder.object(matte(random.point(1.0)));
        let at = (i as f32 - 11.5) * 0.11;
        let (thick, lean) = (random.range(0.002, 0.03), random.range(-0.3, 0.3));
        let (a, b) = if i % 2 == 0 {
            (v(at, -1.2, 0.0), v(at + lean, 1.2, 0.3))
        } else {
            (v(-1.2, at, 0.2), v(1.2, at + lean, 0.0))
        };
        let aside = if i % 2 == 0 { v(thick, 0.0, 0.0) } else { v(0.0, thick, 0.0) };
        builder.quad([a, a + aside, b + aside, b]);
    }
    builder.build(4.0)
}

fn scenes() -> Vec<Scene> {
    let mut scenes = vec![lattice()];
    scenes.extend(["rods", "spheres", "mirror-room"].map(|name| builtin::to_scene(name).unwrap()));
    scenes
}

const SIZES: [(u32, u32); 6] = [(1, 1), (7, 1), (1, 7), (33, 17), (64, 64), (129, 95)];
const SHADOWS: [(Compared, bool); 2] = [(Compared::Object, false), (Compared::PAPER, true)];

/// Draws every scene in every size with both sizes of blocks and both corrections.
fn for_all(mut check: impl FnMut(&mut Renderer, RenderOptions, bool, &str)) {
    for scene in scenes() {
        let mut renderer = twin_renderer(scene);
        for (width, height) in SIZES {
            for (block, (compared, shadows)) in [2, 4].into_iter().flat_map(|b| SHADOWS.map(|s| (b, s))) {
                let options = adaptive(width, height, block, plainly_converged(compared));
                let name = format!("{} {width}x{height}, blocks of {block}, {compared}", renderer.name());
                check(&mut renderer, options, shadows, &name);
            }
        }
    }
}

fn without_correction(renderer: &mut Renderer, options: &RenderOptions) -> Planes {
    planes(renderer, &with(options, |method| method.correction = Correction::Off))
}

#[test]
fn converged_correction_is_the_least_fixed_point_in_any_order() {
    let mut random = Random::new(9);
    let (mut fired, mut confirmed, mut controls) = (0, 0, 0);
    for_all(|renderer, options, shadows, name| {
        let full = full(renderer, options.width, options.height);
        let before = without_correction(renderer, &options);
        let found = planes(renderer, &options);
        let expected = least_fixed_point(&before, &full, shadows, &mut |n| n - 1);
        assert!(found == expected, "{name}: {:?} instead of {:?}", found.fired(), expected.fired());
        assert!(least_fixed_point(&before, &full, shadows, &mut |_| 0) == expected, "{name}: first come");
        assert!(least_fixed_point(&before, &full, shadows, &mut |n| random.below(n)) == expected, "{name}: at random");
        fired += expected.fired().len();
        confirmed += (0..expected.class.len()).filter(|&at| expected.is(at, &[CLASS_CONFIRMED])).count();
        // Negative control: the other comparison gives another set.
        controls += usize::from(least_fixed_point(&before, &full, !shadows, &mut |n| n - 1) != found);
    });
    println!("{fired} pixels fired, {confirmed} confirmed, {controls} told apart");
    assert!(fired > 2000 && confirmed > 50 && controls > 10, "{fired} fired, {confirmed} confirmed, {controls}");
}

#[test]
fn correction_of_thin_things_is_the_same_in_any_order_and_spares_edges_of_thick_ones() {
    let mut random = Random::new(9);
    let (mut fired, mut of) = (0, 0);
    for_all(|renderer, options, shadows, name| {
        let full = full(renderer, options.width, options.height);
        let before = without_correction(renderer, &options);
        let rules = Rules { thin_only: true, bridges: false };
        let found = planes(renderer, &rules.of(&options));
        let expected = fixed_point(&before, &full, shadows, rules, &mut |n| n - 1);
        assert!(found == expected, "{name}: {:?} instead of {:?}", found.fired(), expected.fired());
        let at_random = fixed_point(&before, &full, shadows, rules, &mut |n| random.below(n));
        assert!(at_random == expected, "{name}: at random");
        let all = planes(renderer, &options);
        assert!(found.fired().iter().all(|at| all.fired().contains(at)), "{name}: fired more than without the rule");
        fired += found.fired().len();
        of += all.fired().len();
    });
    println!("{fired} of {of} pixels fired");
    assert!(fired > 500 && fired * 10 < of * 9, "{fired} of {of} pixels fired");
}

#[test]
fn correction_across_gaps_is_the_same_in_any_order_and_only_adds() {
    let mut random = Random::new(9);
    let (mut added, mut right) = (0, 0);
    for_all(|renderer, options, shadows, name| {
        let full = full(renderer, options.width, options.height);
        let before = without_correction(renderer, &options);
        for thin_only in [false, true] {
            let rules = Rules { thin_only, bridges: true };
            let found = planes(renderer, &rules.of(&options));
            let expected = fixed_point(&before, &full, shadows, rules, &mut |n| n - 1);
            assert!(found == expected, "{name}: {:?} instead of {:?}", found.fired(), expected.fired());
            let at_random = fixed_point(&before, &full, shadows, rules, &mut |n| random.below(n));
            assert!(at_random == expected, "{name}: at random");
            let without = planes(renderer, &Rules { thin_only, bridges: false }.of(&options));
            assert!(without.fired().iter().all(|at| found.fired().contains(at)), "{name}: fired less across gaps");
            added += found.fired().len() - without.fired().len();
            right += without.wrong(&full, shadows).len() - found.wrong(&full, shadows).len();
        }
    });
    println!("{added} pixels fired across gaps and from there, {right} of them wrong before");
    assert!(added > 100 && right > 30, "{added} pixels, {right} wrong before");
}

#[test]
fn dashes_of_odd_rows_are_found_across_the_gaps() {
    // Half a pixel high: in each row a dash of run / 2 pixels, the next row's begins run / 2 pixels behind it.
    for run in [6.0, 9.0] {
        let mut renderer = twin_renderer(dashes(&[(26.3, run)]));
        let options = adaptive(64, 64, 2, plainly_converged(Compared::Object));
        let full = full(&mut renderer, 64, 64);
        let mut wrong = |bridges, thin_only| {
            planes(&mut renderer, &Rules { thin_only, bridges }.of(&options)).wrong(&full, false).len()
        };
        let (without, with) = (wrong(false, false), wrong(true, false));
        println!("run {run}: {without} wrong pixels, {with} across gaps");
        // The dashes next to the picture's border have no partner.
        assert!(without >= 12 && with * 4 <= without, "run {run}: {without} wrong pixels, {with} across gaps");
        assert_eq!(wrong(true, true), with, "run {run}: with the edges of thick things spared");
    }
    // Beyond the reach nothing is found.
    let mut renderer = twin_renderer(dashes(&[(26.3, 4.0 * BRIDGE_REACH as f32)]));
    let options = adaptive(64, 64, 2, plainly_converged(Compared::Object));
    let plain = planes(&mut renderer, &options);
    assert_eq!(planes(&mut renderer, &Rules { thin_only: false, bridges: true }.of(&options)), plain);
}

/// A bar over the pixels `lo` to `hi` of 64x64, before a wall. The eye holds the light, so that nothing is in shadow.
fn bar(lo: (f32, f32), hi: (f32, f32)) -> Scene {
    let half_height_degrees = 0.25_f32.atan().to_degrees();
    let mut builder = SceneBuilder::new("bar").camera(v(0.0, 0.0, 4.0), v(0.0, 0.0, 0.0), 2.0 * half_height_degrees);
    builder = builder.light(v(0.0, 0.0, 4.0), 8.0);
    builder.object(matte(v(0.8, 0.2, 0.2)));
    builder.wall(glam::Vec2::splat(-3.0), glam::Vec2::splat(3.0), 0.0);
    builder.object(matte(v(0.1, 0.1, 0.9)));
    let place = |x: f32, y: f32| glam::vec2(x / 32.0 - 1.0, 1.0 - y / 32.0);
    builder.wall(place(lo.0, hi.1), place(hi.0, lo.1), 0.001);
    builder.build(40.0)
}

/// How many pixels of each row, and of each column, correction fired at a bar.
fn fired_at(lo: (f32, f32), hi: (f32, f32), thin_only: bool) -> [Vec<(usize, usize)>; 2] {
    let mut renderer = twin_renderer(bar(lo, hi));
    let options = adaptive(64, 64, 2, plainly_converged(Compared::Object));
    let found = planes(&mut renderer, &Rules { thin_only, bridges: false }.of(&options));
    [|at: usize| at / 64, |at: usize| at % 64].map(|line| {
        let count = |i: usize| found.fired().iter().filter(|&&at| line(at) == i).count();
        (0..64).map(|i| (i, count(i))).filter(|&(_, fired)| fired > 0).collect()
    })
}

#[test]
fn edges_of_a_thick_bar_ask_for_no_rays_and_a_thin_bar_is_found_along_its_length() {
    // Rows 9 and 19 are traced, since the rows beside them differ: what they see differs from the interpolated odd
    // pixels of rows 10 and 20, and fills the row behind it.
    let thick = ((-9.0, 10.0), (99.0, 20.0));
    assert_eq!(fired_at(thick.0, thick.1, false)[0], [(10, 31), (20, 31)]);
    assert_eq!(fired_at(thick.0, thick.1, true)[0], []);
    // One odd column, between references: only the last row is traced, and has nothing behind it. From there the bar is
    // followed upwards, and asks on either side.
    for thin_only in [false, true] {
        assert_eq!(fired_at((11.0, -9.0), (12.0, 99.0), thin_only)[1], [(10, 31), (11, 63), (12, 31)]);
    }
}

#[test]
fn nothing_that_correction_can_reach_stays_wrong() {
    let (mut wrong_before, mut wrong_after) = (0, 0);
    for_all(|renderer, options, shadows, name| {
        let full = full(renderer, options.width, options.height);
        let before = without_correction(renderer, &options);
        let after = planes(renderer, &options);
        for at in 0..after.class.len() {
            for to in after.neighbours(at) {
                assert!(!after.spreads(at, to, shadows), "{name}: {at} still wants {to}");
            }
            if !after.is(at, &[CLASS_INTERPOLATED]) {
                let same = (after.object[at], after.shadow[at], after.color[at]);
                assert_eq!(same, (full.object[at], full.shadow[at], full.color[at]), "{name}: {at}");
            }
        }
        let wrong = [before.wrong(&full, shadows), after.wrong(&full, shadows)];
        assert!(wrong[1].iter().all(|at| wrong[0].contains(at)), "{name}: correction broke a pixel");
        wrong_before += wrong[0].len();
        wrong_after += wrong[1].len();
    });
    println!("wrong pixels: {wrong_before}, corrected {wrong_after}");
    assert!(wrong_after * 4 < wrong_before * 3, "{wrong_before} wrong pixels, {wrong_after} after correction");
}

/// For each object of a full picture: its pixels with another object and those with other shadow bits.
fn broken(renderer: &mut Renderer, full: &Planes, size: u32, correction: Correction) -> Vec<(usize, usize)> {
    let found = planes(renderer, &adaptive(size, size, 2, correction));
    let mut broken = vec![(0, 0); 13];
    for (at, &object) in full.object.iter().enumerate() {
        broken[object as usize].0 += usize::from(found.object[at] != object);
        broken[object as usize].1 += usize::from(found.shadow[at] != full.shadow[at]);
    }
    broken
}

#[test]
fn thin_rods_and_their_shadows_are_broken_without_correction_and_whole_with_it() {
    // Object 0 is the wall, 1 to 12 are rods, ever thicker: 0.6 to 3.4 pixels wide at 256x256, twice that at 512x512.
    let mut renderer = twin_renderer(builtin::to_scene("rods").unwrap());
    let mut by_correction = |size| {
        let full = full(&mut renderer, size, size);
        [Correction::Off, plainly_converged(Compared::Object), plainly_converged(Compared::PAPER)].map(|correction| {
            let broken = broken(&mut renderer, &full, size, correction);
            println!("{size}x{size}, {correction:?}: {broken:?}");
            broken
        })
    };
    let [off, object, both] = by_correction(512);
    assert!(off[1].0 > 100 && off[2].0 > 50 && off[0].1 > 100, "nothing to correct: {off:?}");
    assert!(object.iter().all(|rod| rod.0 == 0), "rods are still broken: {object:?}");
    // Object ids alone leave the shadows broken.
    assert_eq!(object[0].1, off[0].1);
    assert!(both.iter().all(|&rod| rod == (0, 0)), "rods or shadows are still broken: {both:?}");

    // Where a rod is narrower than a pixel, no adaptive ray need find it, and nothing starts a correction.
    let [off, object, both] = by_correction(256);
    assert!((1..=6).all(|rod| off[rod].0 > 10), "nothing to correct: {off:?}");
    assert!(object[3..].iter().all(|rod| rod.0 == 0), "rods are still broken: {object:?}");
    assert!(object[1].0 > 0 && object[2].0 > 0, "rods narrower than a pixel are whole: is the picture right?");
    assert!(both.iter().zip(&object).all(|(b, o)| b.0 <= o.0 && b.1 <= o.1));
    assert!(both[0].1 * 4 < off[0].1, "shadows are still broken: {both:?}");
}

#[test]
fn the_sweeps_fire_part_of_the_fixed_point_and_all_of_it_when_repeated() {
    let (mut once_in_all, mut converged_in_all, mut proper) = (0, 0, 0);
    for_all(|renderer, options, shadows, name| {
        let converged = planes(renderer, &options);
        let sweeps = with(&options, |method| method.correction = method.correction.spreading(Spread::Sweeps));
        let once = planes(renderer, &sweeps);
        for at in once.fired() {
            assert_eq!(once.class[at], converged.class[at], "{name}: {at} fired by the sweeps");
        }
        let full = full(renderer, options.width, options.height);
        let before = without_correction(renderer, &options);
        let expected = sweep_once(&before, &full, shadows);
        assert!(once == expected, "{name}: {:?} instead of {:?}", once.fired(), expected.fired());
        let mut repeated = once.clone();
        loop {
            let next = sweep_once(&repeated, &full, shadows);
            if next == repeated {
                break;
            }
            repeated = next;
        }
        assert!(repeated == converged, "{name}: repeated sweeps end elsewhere");
        once_in_all += once.fired().len();
        converged_in_all += converged.fired().len();
        proper += usize::from(once != converged);
    });
    println!("{once_in_all} of {converged_in_all} fired by one round of sweeps; fewer in {proper} pictures");
    assert!(once_in_all * 2 > converged_in_all && proper > 0, "{once_in_all} of {converged_in_all}, {proper}");
}

/// The paper's round: each row there and back, then each column, one pixel after the other.
fn sweep_once(before: &Planes, full: &Planes, shadows: bool) -> Planes {
    let mut now = before.clone();
    let (width, height) = (now.width, now.class.len() / now.width);
    let rows = (0..height).map(|y| (0..width).map(|x| y * width + x).collect::<Vec<_>>());
    let columns = (0..width).map(|x| (0..height).map(|y| y * width + x).collect::<Vec<_>>());
    for line in rows.chain(columns) {
        let forth = line.windows(2).map(|w| (w[0], w[1]));
        let back = line.windows(2).rev().map(|w| (w[1], w[0]));
        for (from, to) in forth.chain(back) {
            if now.spreads(from, to, shadows) {
                let changed = now.object[to] != full.object[to] || (shadows && now.shadow[to] != full.shadow[to]);
                now.class[to] = if changed { CLASS_CORRECTED } else { CLASS_CONFIRMED };
                (now.object[to], now.shadow[to], now.color[to]) = (full.object[to], full.shadow[to], full.color[to]);
            }
        }
    }
    now
}

/// One launch of post-correction at a time, as the method does it, from `sources` in any order.
fn rounds_by_hand(queue: &mut Queue, mut sources: Vec<u32>, flags: StepFlags) -> u32 {
    let mut fired = 0;
    while !sources.is_empty() {
        let count = sources.len() as u32;
        queue.write(FrameBuffer::List, &sources).unwrap();
        let step =
            StepParams { flags, item_count: 4 * count, list_offset: count, scan_group: queue.scan_group(), ..NO_STEP };
        let mut run = |kernel, step: &StepParams| queue.launch(Stage::Step4, kernel, step).unwrap();
        run(Kernel::CorrectMark, &step);
        run(Kernel::CorrectCount, &step);
        let (mut level, mut sums_offset) = (step.item_count.div_ceil(32), 0);
        loop {
            run(Kernel::PackScan, &StepParams { item_count: level, sums_offset, ..step });
            sums_offset += level;
            level = level.div_ceil(step.scan_group);
            if level == 1 {
                break;
            }
        }
        let found = queue.read_sum(sums_offset).unwrap();
        if found > 0 {
            let mut run = |kernel, step: &StepParams| queue.launch(Stage::Step4, kernel, step).unwrap();
            run(Kernel::CorrectScatter, &StepParams { list_end: count + found, ..step });
            run(Kernel::Trace, &StepParams { item_count: found, ..step });
        }
        fired += found;
        sources = queue.read(FrameBuffer::List, count as usize..(count + found) as usize).unwrap();
    }
    fired
}

const NO_STEP: StepParams = StepParams {
    origin_x: 0,
    origin_y: 0,
    step_x: 0,
    step_y: 0,
    grid_width: 0,
    grid_height: 0,
    reference_dx: 0,
    reference_dy: 0,
    item_count: 0,
    list_offset: 0,
    source_offset: 0,
    sums_offset: 0,
    t_pos: 0.0,
    t_norm: 0.0,
    t_conv: 0.0,
    t_tex: 0.0,
    t_gcol: 0.0,
    tests: FailMask::empty(),
    flags: StepFlags::empty(),
    scan_group: 0,
    t_visible: 0,
    list_end: 0,
    pixel_class: CLASS_CORRECTED,
    pad0: 0,
};

#[test]
fn the_kernels_give_the_same_for_sources_in_any_order() {
    let mut random = Random::new(4);
    let (width, height) = (129, 95);
    for scene in [lattice(), builtin::to_scene("rods").unwrap()] {
        let mut renderer = twin_renderer(scene);
        for block in [2, 4] {
            let options = adaptive(width, height, block, plainly_converged(Compared::PAPER));
            let expected = planes(&mut renderer, &options);
            for order in 0..4 {
                let before = without_correction(&mut renderer, &options);
                let traced = (0..before.class.len() as u32).filter(|&at| before.is(at as usize, &[CLASS_TRACED]));
                let mut sources: Vec<u32> = traced.map(|at| (at % width) | ((at / width) << 16)).collect();
                match order {
                    0 => (),
                    1 => sources.reverse(),
                    _ => (1..sources.len()).for_each(|i| sources.swap(i, random.below(i + 1))),
                }
                // Negative control: without the last sources, something stays uncorrected.
                let complete = order != 3;
                if !complete {
                    sources.truncate(sources.len() / 2);
                }
                let fired = renderer
                    .on_last_frame(|_, queue| {
                        rounds_by_hand(queue, sources, StepFlags::STORE | StepFlags::COMPARE_SHADOW)
                    })
                    .unwrap();
                let color = renderer
                    .on_last_frame(|_, queue| queue.read(FrameBuffer::Color, 0..before.class.len()).unwrap())
                    .unwrap();
                let found = planes_of(&mut renderer, &options, color);
                assert_eq!(fired as usize, found.fired().len(), "each pixel is fired once");
                assert_eq!(found == expected, complete, "{} in order {order}", renderer.name());
            }
        }
    }
}
