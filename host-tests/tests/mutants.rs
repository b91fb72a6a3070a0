// SPDX-License-Identifier: MIT OR Apache-2.0
//! Negative controls of the parity tests: each row breaks one line of a kernel, and the comparison of that kernel with
//! its twin must see it.
//!
//! Frames are tiny and only the kernel in question runs on the device, so that a mutant costs one small program. The quick
//! tests take a mutant of each file and each launch; all of them are a matter of `--long`.
#![allow(clippy::unwrap_used, missing_docs)]

use std::collections::{BTreeSet, HashMap};
use std::path::Path;

use rarefy::internal::device::hooks::parity::KernelParity;
use rarefy::internal::device::kernels::{FILES, Mutation};
use rarefy::internal::device::open::DeviceOptions;
use rarefy::internal::device::opencl::{CacheFolder, OpenOptions};
use rarefy::internal::device::stage::{Kernel, LAUNCHES, Stage};
use rarefy::internal::layout::Traversal;
use rarefy::internal::method::options::{Method, RenderOptions};
use rarefy::internal::selftest::full;
use rarefy_host_tests::fixtures::sweeps;
use rarefy_host_tests::frames::{Prepared, mutated_device, no_opencl, walking_by};

/// The frame that a mutant is drawn in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Shot {
    /// Holes, glass, thin glass, a mirror, equal distances, three lights; counting.
    Zoo,
    /// A closed room with a mirror and a texture that repeats; counting.
    Room,
    /// Thin rods and their shadows.
    Rods,
    /// [`Shot::Rods`], corrected by sweeps.
    RodsSwept,
    /// [`Shot::Rods`], drawn in bands.
    RodsInBands,
    /// Lines thinner than a pixel, nearly level.
    Dashes,
    /// [`Shot::Dashes`], drawn in bands.
    DashesInBands,
    /// Large enough for scans of two levels.
    Large,
    /// [`Shot::Zoo`] with the strictest tolerances.
    Strictest,
    /// [`Shot::Room`] by the paper's rules.
    Paper,
    /// [`Shot::Zoo`], smaller, walked with a short stack.
    ZooShort,
    /// [`Shot::ZooShort`] without any stack.
    ZooStackless,
    /// A texture that repeats, also seen in a mirror and behind a pane.
    Window,
    /// [`Shot::Window`] in blocks of 4.
    WindowFast,
    /// [`Shot::Window`] where the whole repetitions that are stored begin anew.
    FarWindow,
}

impl Shot {
    fn scene(self) -> &'static str {
        match self {
            Shot::Zoo | Shot::Strictest | Shot::ZooShort | Shot::ZooStackless => "zoo",
            Shot::Room | Shot::Paper => "mirror-room",
            Shot::Rods | Shot::RodsSwept | Shot::RodsInBands | Shot::Large => "rods",
            Shot::Dashes | Shot::DashesInBands => "dashes",
            Shot::Window | Shot::WindowFast => "window",
            Shot::FarWindow => "far-window",
        }
    }

    fn options(self) -> RenderOptions {
        let mut options = RenderOptions { width: 50, height: 38, ..RenderOptions::default() };
        match self {
            Shot::Large => (options.width, options.height) = (210, 150),
            Shot::Rods | Shot::RodsSwept | Shot::RodsInBands => (options.width, options.height) = (100, 75),
            Shot::Strictest => options.method.checks.fine.t_pos = 0.0,
            // Large enough that smooth glass, slopes and faint shadows are interpolated too.
            Shot::Zoo => (options.width, options.height, options.depth) = (180, 136, 3),
            Shot::Dashes | Shot::DashesInBands => (options.width, options.height) = (64, 64),
            Shot::Room | Shot::ZooShort | Shot::ZooStackless => {}
            Shot::Paper => options.method = Method::paper(),
            Shot::Window | Shot::FarWindow => (options.width, options.height) = (96, 72),
            Shot::WindowFast => options = RenderOptions { width: 96, height: 72, method: Method::fast(), ..options },
        }
        if matches!(self, Shot::RodsInBands | Shot::DashesInBands) {
            options.band_rows = Some(8);
        }
        if self == Shot::RodsSwept {
            options.method = sweeps();
        }
        options
    }

    fn counters(self) -> bool {
        matches!(self, Shot::Zoo | Shot::Room | Shot::Strictest | Shot::ZooShort | Shot::ZooStackless)
    }

    fn traversal(self) -> Traversal {
        match self {
            Shot::ZooShort => Traversal::ShortStack,
            Shot::ZooStackless => Traversal::Stackless,
            _ => Traversal::PrivateStack,
        }
    }
}

/// The launches in which a mutant must be caught: a stage and its kernel.
type Launch = (Stage, Kernel);

const STEP1: Launch = (Stage::Step1, Kernel::Trace);
const STEP2A: Launch = (Stage::Step2a, Kernel::Check);
const STEP2B_COUNT: Launch = (Stage::Step2b, Kernel::PackCount);
const STEP2B_SCAN: Launch = (Stage::Step2b, Kernel::PackScan);
const STEP2B_SCATTER: Launch = (Stage::Step2b, Kernel::PackScatter);
const STEP2C: Launch = (Stage::Step2c, Kernel::Trace);
const STEP3A: Launch = (Stage::Step3a, Kernel::Check);
const STEP3B_COUNT: Launch = (Stage::Step3b, Kernel::PackCount);
const STEP3B_SCAN: Launch = (Stage::Step3b, Kernel::PackScan);
const STEP3B_SCATTER: Launch = (Stage::Step3b, Kernel::PackScatter);
const PROBE_COUNT: Launch = (Stage::Step4, Kernel::PackCount);
const PROBE_SCATTER: Launch = (Stage::Step4, Kernel::PackScatter);
const STEP3C: Launch = (Stage::Step3c, Kernel::Trace);
const MARK: Launch = (Stage::Step4, Kernel::CorrectMark);
const COUNT: Launch = (Stage::Step4, Kernel::CorrectCount);
const SCAN: Launch = (Stage::Step4, Kernel::PackScan);
const SCATTER: Launch = (Stage::Step4, Kernel::CorrectScatter);
const RETRACE: Launch = (Stage::Step4, Kernel::Trace);
const TAIL: Launch = (Stage::Step4, Kernel::CorrectTail);
const SWEEP: Launch = (Stage::Step4, Kernel::CorrectSweep);

/// A broken line: file, text, its replacement, the frame that shows it, the launches that must be caught.
type Mutant = (&'static str, &'static str, &'static str, Shot, Launch);

const SCAN_LEVEL: &str = "scan_level(&step, sums, scratch);";
const SCAN_ONE_SHORT: &str = "StepParams s = step; s.item_count -= 1u; scan_level(&s, sums, scratch);";
const ENTRY: &str = "list[step.list_offset + item]";
const EVEN_ENTRY: &str = "list[step.list_offset + (item & ~1u)]";
const LISTED_X: &str = "list[step.list_offset + item];\n    x = pixel & 0xffffu";
const LISTED_EVEN_X: &str = "list[step.list_offset + item];\n    x = pixel & 0xfffeu";

/// Each entry point on its own.
#[rustfmt::skip]
const ENTRY_POINTS: &[Mutant] = &[
    ("trace.cl", "grid_pixel(frame, &step, gx, gy)", "grid_pixel(frame, &step, gx & ~1u, gy)", Shot::Zoo, STEP1),
    ("trace.cl", "gy >= step.grid_height", "gy + 1u >= step.grid_height", Shot::Zoo, STEP1),
    ("check.cl", "grid_pixel(frame, &step, gx, gy)", "grid_pixel(frame, &step, gx, gy & ~1u)", Shot::Zoo, STEP2A),
    ("check.cl", "grid_pixel(frame, &step, gx, gy)", "grid_pixel(frame, &step, gx & ~1u, gy)", Shot::Zoo, STEP3A),
    ("pack.cl", "chunk * 32u < step.item_count", "chunk * 64u < step.item_count", Shot::Zoo, STEP2B_COUNT),
    ("pack.cl", SCAN_LEVEL, SCAN_ONE_SHORT, Shot::Zoo, STEP2B_SCAN),
    ("pack.cl", "if (chunk < chunk_count)", "if (chunk < chunk_count / 2u)", Shot::Zoo, STEP2B_SCATTER),
    ("pack.cl", "chunk * 32u < step.item_count", "chunk * 64u < step.item_count", Shot::Zoo, STEP3B_COUNT),
    ("pack.cl", SCAN_LEVEL, SCAN_ONE_SHORT, Shot::Zoo, STEP3B_SCAN),
    ("pack.cl", "if (chunk < chunk_count)", "if (chunk < chunk_count / 2u)", Shot::Zoo, STEP3B_SCATTER),
    ("trace.cl", ENTRY, EVEN_ENTRY, Shot::Zoo, STEP2C),
    ("trace.cl", "x, y, step.pixel_class, &step", "x, y, CLASS_CORRECTED, &step", Shot::Zoo, STEP2C),
    ("trace.cl", "step.pixel_class == CLASS_CORRECTED &&", "step.pixel_class != CLASS_CORRECTED &&", Shot::Zoo, STEP3C),
    ("trace.cl", ENTRY, EVEN_ENTRY, Shot::Zoo, STEP3C),
    ("trace.cl", "get_local_size(1) + gy)", "get_local_size(1))", Shot::Zoo, STEP2C),
    ("trace.cl", LISTED_X, LISTED_EVEN_X, Shot::Zoo, STEP3C),
    ("common/correction.clh", "atomic_min(", "atomic_max(", Shot::Rods, MARK),
    ("correct.cl", "chunk * 32u < step.item_count", "chunk * 64u < step.item_count", Shot::Rods, COUNT),
    ("pack.cl", "chunk * 32u < step.item_count", "chunk * 512u < step.item_count", Shot::Rods, PROBE_COUNT),
    ("pack.cl", SCAN_LEVEL, SCAN_ONE_SHORT, Shot::Rods, SCAN),
    ("pack.cl", "if (chunk < chunk_count)", "if (chunk < 1u)", Shot::Large, PROBE_SCATTER),
    ("correct.cl", "if (chunk < chunk_count)", "if (chunk < chunk_count / 2u)", Shot::Rods, SCATTER),
    ("trace.cl", ENTRY, EVEN_ENTRY, Shot::Rods, RETRACE),
    ("correct_tail.cl", "begin = lane * share", "begin = lane", Shot::Rods, TAIL),
    ("correct_tail.cl", "const uint share = (round.item_count + lanes - 1u) / lanes", "const uint share = round.item_count / lanes", Shot::Rods, TAIL),
    ("correct_tail.cl", "round.source_offset = round.list_offset;", "", Shot::Rods, TAIL),
    ("correct_tail.cl", "rounds < TAIL_ROUNDS &&", "rounds < 1u &&", Shot::Rods, TAIL),
    ("correct_tail.cl", "round.item_count <= 4u * TAIL_SOURCES", "round.item_count <= 8u", Shot::Rods, TAIL),
    ("correct_sweep.cl", "if (k == length) continue;", "if (k >= length) continue;", Shot::RodsSwept, SWEEP),
];

/// What spreads in step 4.
#[rustfmt::skip]
const CORRECTION: &[Mutant] = &[
    ("common/correction.clh", " && from_class != CLASS_CORRECTED", "", Shot::Rods, MARK),
    ("common/attributes.clh", "if (a->object != b->object) return true;", "if (a->object == b->object) return true;", Shot::Rods, MARK),
    ("common/attributes.clh", "(step->flags & STEP_COMPARE_SHADOW)", "(step->flags & STEP_GCOL_LINEAR)", Shot::Rods, MARK),
    ("common/correction.clh", "!(step->flags & STEP_THIN_ONLY) || from_class == CLASS_CORRECTED", "!(step->flags & STEP_THIN_ONLY) || from_class == CLASS_TRACED", Shot::Zoo, MARK),
    ("common/correction.clh", "(is_edge && is_surface)", "is_edge", Shot::Zoo, MARK),
    ("common/correction.clh", "|| is_line;", ";", Shot::Zoo, MARK),
    ("common/correction.clh", "!(same & SAME_BEHIND) &&", "", Shot::Zoo, MARK),
    ("common/correction.clh", "(same & SAME_BOTH_SIDES) == SAME_BOTH_SIDES", "(same & SAME_BOTH_SIDES)", Shot::Zoo, MARK),
    ("common/correction.clh", "(same & SAME_BEHIND_ALL) == SAME_BEHIND_ALL", "(same & SAME_BEHIND)", Shot::Zoo, MARK),
    ("common/correction.clh", "&& (same & SAME_BOTH_SIDES);", "&& (same & 64u);", Shot::Zoo, MARK),
    ("common/correction.clh", "const uint bx = x - back * (nx - x)", "const uint bx = x + back * (nx - x)", Shot::Zoo, MARK),
    ("common/attributes.clh", "return a->object != b->object ||", "return a->object == b->object ||", Shot::Zoo, MARK),
    ("common/correction.clh", "case 0u: return x > 0u ?", "case 0u: return x > 25u ?", Shot::Rods, MARK),
    ("common/correction.clh", "case 1u: return x + 1u < frame->width ?", "case 1u: return x + 25u < frame->width ?", Shot::Rods, MARK),
    ("common/correction.clh", "case 2u: return y > frame->window_begin ?", "case 2u: return y > frame->window_begin + 19u ?", Shot::Rods, MARK),
    ("common/correction.clh", "case 3u: return y + 1u < frame->window_end ?", "case 3u: return y + 19u < frame->window_end ?", Shot::Rods, MARK),
    ("common/ray_tree.clh", "!(step->flags & STEP_SETTLE) &&", "", Shot::RodsInBands, RETRACE),
    ("common/ray_tree.clh", "y < frame->interior_end) return true", "y <= frame->interior_end) return true", Shot::RodsInBands, RETRACE),
    ("common/ray_tree.clh", "y < frame->interior_end) return true", "y <= frame->interior_end) return true", Shot::DashesInBands, TAIL),
    ("common/ray_tree.clh", "y >= frame->interior_begin", "y + 1u >= frame->interior_begin", Shot::RodsInBands, RETRACE),
    ("common/attributes.clh", "(y - frame->window_begin) >> shift", "(frame->window_end - 1u - y) >> shift", Shot::RodsInBands, STEP1),
    ("common/attributes.clh", "(y - frame->window_begin) * frame->width", "(frame->window_end - 1u - y) * frame->width", Shot::RodsInBands, STEP1),
    ("common/correction.clh", "attributes[PLANE_CLAIM * pitch + to] == i", "attributes[PLANE_CLAIM * pitch + to] != i", Shot::Rods, COUNT),
    ("common/ray_tree.clh", "? CLASS_CORRECTED : CLASS_CONFIRMED", "? CLASS_CORRECTED : CLASS_CORRECTED", Shot::Rods, RETRACE),
    ("common/ray_tree.clh", "out_attributes[PLANE_CLAIM * pitch + at] = NO_CLAIM", "out_attributes[PLANE_CLAIM * pitch + at] = 0u", Shot::Rods, RETRACE),
    ("common/ray_tree.clh", "pixel_class == CLASS_BASE ? 0u : out_attributes[PLANE_CLASS * pitch + at] & CLASS_CHECKED", "0u", Shot::Zoo, STEP2C),
];

/// Pixels across gaps.
#[rustfmt::skip]
const BRIDGES: &[Mutant] = &[
    ("common/correction.clh", "if (i % items_per_source(step) == BRIDGE_ITEM ||", "if (", Shot::Dashes, MARK),
    ("common/correction.clh", "STEP_BRIDGE ? 5u : 4u", "STEP_BRIDGE ? 6u : 4u", Shot::Dashes, MARK),
    ("correct.cl", "#define PACK_PIXEL(i) target(frame, &step, attributes, list, i)", "#define PACK_PIXEL(i) target(frame, &step, attributes, list, i ^ 1u)", Shot::Dashes, SCATTER),
    ("correct.cl", "if (i % items_per_source(&step) == BRIDGE_ITEM) {", "if (0) {", Shot::Dashes, MARK),
    ("common/bridge.clh", "if (!(y & 1u) ||", "if ((y & 1u) ||", Shot::Dashes, MARK),
    ("common/bridge.clh", "color, x, y, x, y - 1u) &&", "color, x, y, x, y - 1u) ||", Shot::Rods, MARK),
    ("common/bridge.clh", "above ? y - 1u : y + 1u, across", "above ? y + 1u : y - 1u, across", Shot::Dashes, MARK),
    ("common/bridge.clh", "k <= BRIDGE_REACH", "k <= 1u", Shot::Dashes, MARK),
    ("common/bridge.clh", "right < 2u", "right < 1u", Shot::Dashes, MARK),
    ("common/bridge.clh", "right ? x + k : x - k", "right ? x + k : x - 2u * k", Shot::Dashes, MARK),
    ("common/bridge.clh", "!is_thin(frame, step, attributes, color, px, across))", "false)", Shot::Rods, MARK),
    ("common/bridge.clh", "return interpolated && pixels_differ(frame, step, attributes, color, x, near, qx, y) ?", "return interpolated ?", Shot::Zoo, MARK),
    ("common/bridge.clh", "y < frame->interior_begin ||", "y < frame->interior_begin + 4u ||", Shot::DashesInBands, MARK),
];

/// Lights that need no shadow ray.
#[rustfmt::skip]
const KNOWN_SHADOWS: &[Mutant] = &[
    ("common/known_shadows.clh", "(mask & FAIL_GC) || mask == FAIL_SH", "(mask & FAIL_SH)", Shot::Zoo, STEP3C),
    ("common/known_shadows.clh", "!(mask & (FAIL_G1 | FAIL_G2)) &&", "", Shot::Strictest, STEP3C),
    ("common/known_shadows.clh", "known.lights = ~(known.bits ^", "known.lights = ~(known.bits &", Shot::Zoo, STEP3C),
    ("common/known_shadows.clh", "attributes[PLANE_OBJECT * pitch + a] != object ||", "attributes[PLANE_OBJECT * pitch + a] == object ||", Shot::Zoo, STEP2C),
    ("common/known_shadows.clh", "reflectance.w <= LITTLE_OWN_LIGHT", "reflectance.w > LITTLE_OWN_LIGHT", Shot::Zoo, RETRACE),
    ("common/known_shadows.clh", "known.lights = ~0u;", "known.lights = 0u;", Shot::Zoo, RETRACE),
    ("common/ray_tree.clh", "shadowed = known->bits >> i & 1u;", "shadowed = true;", Shot::Zoo, STEP3C),
    ("common/ray_tree.clh", "shadow_test(SCENE_ARGS, &at, &nothing, work)", "shadow_test(SCENE_ARGS, p, &nothing, work)", Shot::Zoo, STEP1),
];

/// The walk through the tree and the tests of triangles.
#[rustfmt::skip]
const TRAVERSAL: &[Mutant] = &[
    ("common/kdtree.clh", "#define WIDEN_UP 1.0000005f", "#define WIDEN_UP 0.9f", Shot::Room, STEP1),
    ("common/kdtree.clh", "#define WIDEN_DOWN 0.9999995f", "#define WIDEN_DOWN 1.1f", Shot::Room, STEP1),
    ("common/walk_stack.clh", "| side[axis]", "| (side[axis] ^ 2u)", Shot::Zoo, STEP1),
    ("common/kdtree.clh", "if (best.t < t_min) return best;", "", Shot::Zoo, STEP1),
    ("common/kdtree.clh", "id < best.triangle", "id > best.triangle", Shot::Zoo, STEP1),
    ("common/kdtree.clh", "ahead + 2.0f * error : ahead", "ahead : ahead", Shot::Zoo, STEP1),
    ("common/kdtree.clh", ">> 24) < 128u", ">> 24) >= 128u", Shot::Zoo, STEP1),
    ("common/kdtree.clh", "(!(bits & TRIANGLE_CUTOUT) || !is_hole(", "((bits & TRIANGLE_CUTOUT) || !is_hole(", Shot::Zoo, STEP1),
    ("common/kdtree.clh", "!is_hole(triangle_shading + id, materials, textures, texels, u, v))\n            return true", "1)\n            return true", Shot::Zoo, STEP1),
    ("common/kdtree.clh", "!(bits & TRIANGLE_GLASS)", "!(bits & 64u)", Shot::Zoo, STEP1),
    ("common/kdtree.clh", "t_limit * slope", "2.0f * t_limit * slope", Shot::Room, STEP1),
    ("common/ray_tree.clh", "COUNT(shadow_rays)", "COUNT(refraction_rays)", Shot::Zoo, STEP1),
    ("common/triangle_test.clh", "axis == 1u ? y : z", "axis == 1u ? z : y", Shot::Zoo, STEP1),
    ("common/triangle_test.clh", "x > z ? 0u : 2u", "x > z ? 0u : 1u", Shot::Zoo, STEP1),
    ("common/triangle_test.clh", "(y > z ? 1u : 2u)", "2u", Shot::Zoo, STEP1),
    ("common/triangle_test.clh", "pick(axis, 1.0f, q, p)", "pick(axis, 1.0f, p, q)", Shot::Zoo, STEP1),
    ("common/triangle_test.clh", "pick(axis, p, 1.0f, q)", "pick(axis, q, 1.0f, p)", Shot::Zoo, STEP1),
    ("common/triangle_test.clh", "pick(axis, q, p, 1.0f)", "pick(axis, p, q, 1.0f)", Shot::Zoo, STEP1),
    ("common/triangle_test.clh", "- ray_x * za", "- 0.9f * ray_x * za", Shot::Zoo, STEP1),
    ("common/triangle_test.clh", "- ray_y * zb", "- 0.9f * ray_y * zb", Shot::Zoo, STEP1),
    ("common/triangle_test.clh", "wb = xa * yc - ya * xc", "wb = xa * yc + ya * xc", Shot::Zoo, STEP1),
    ("common/triangle_test.clh", "|| max2(a, max2(b, c)) < 0.0f", "|| max2(a, b) < 0.0f", Shot::Zoo, STEP1),
    ("common/triangle_test.clh", "FROM_Y(c) pick(kz, c.z, c.x, c.y)", "FROM_Y(c) pick(kz, c.z, c.y, c.x)", Shot::Zoo, STEP1),
    ("common/triangle_test.clh", "max2(wa, max2(wb, wc)) > 0.0f", "max2(wa, wb) > 0.0f", Shot::Zoo, STEP1),
    ("common/triangle_test.clh", "from_behind && (bits & TRIANGLE_ONE_SIDED)", "0", Shot::Zoo, STEP1),
    ("common/triangle_test.clh", "!= (ray_z < 0.0f)", "== (ray_z < 0.0f)", Shot::Zoo, STEP1),
    ("common/triangle_test.clh", "+ ray_x * pick(kz, n.y, n.z, n.x)", "+ ray_x * pick(kz, n.x, n.y, n.z)", Shot::Zoo, STEP1),
    ("common/triangle_test.clh", "+ ray_y * pick(kz, n.z, n.x, n.y)", "+ ray_y * pick(kz, n.x, n.y, n.z)", Shot::Zoo, STEP1),
    ("common/triangle_test.clh", "across < 0.0f ? -height : height", "height", Shot::Zoo, STEP1),
    ("common/triangle_test.clh", "fabs(ray_z) * PLANE_ERROR", "fabs(ray_z) * 0.2f", Shot::Zoo, STEP1),
    ("common/attributes.clh", "] = work->triangle_tests", "] = work->traversal_steps", Shot::Zoo, STEP1),
];

/// The walk without arrays.
#[rustfmt::skip]
const SHORT_WALK: &[Mutant] = &[
    ("common/walk_short.clh", "(inv_y < 0.0f ? 4u : 0u)", "(inv_y < 0.0f ? 8u : 0u)", Shot::ZooShort, STEP1),
    ("common/walk_short.clh", "((sides >> axis) & 2u)", "((~sides >> axis) & 2u)", Shot::ZooShort, STEP1),
    ("common/walk_short.clh", "const bool again = level < replay;", "const bool again = level <= replay;", Shot::ZooShort, STEP1),
    ("common/walk_short.clh", "again ? !IS_WAITING(level) : t_split < t_min", "t_split < t_min", Shot::ZooStackless, STEP1),
    ("common/walk_short.clh", "if (!again) FLIP_WAITING(level)", "if (!again && level < 9u) FLIP_WAITING(level)", Shot::ZooShort, STEP1),
    ("common/walk_short.clh", "t_max = t_split * WIDEN_UP;", "t_max = again ? t_max : t_split * WIDEN_UP;", Shot::ZooStackless, STEP1),
    ("common/walk_short.clh", "exit_b = exit_a, exit_a = t_max;", "exit_b = exit_a, exit_a = t_exit;", Shot::ZooShort, STEP1),
    ("common/walk_short.clh", "held = min(held + 1u, 4u);", "held = min(held + 1u, 3u);", Shot::ZooShort, STEP1),
    ("common/walk_short.clh", "node_c = node_b, node_b = node_a", "node_c = node_a, node_b = node_a", Shot::ZooShort, STEP1),
    ("common/walk_short.clh", "node_a = node_b, node_b = node_c, node_c = node_d;", "node_a = node_b, node_b = node_c;", Shot::ZooShort, STEP1),
    ("common/walk_short.clh", "exit_b = exit_c, exit_c = exit_d;", "exit_b = exit_c;", Shot::ZooShort, STEP1),
    ("common/walk_short.clh", "31u - clz(waiting)", "31u - clz(waiting & (0u - waiting))", Shot::ZooShort, STEP1),
    ("common/walk_short.clh", "t_max = t_exit;", "", Shot::ZooStackless, STEP1),
];

/// Surface points, shadows, the ray tree.
#[rustfmt::skip]
const RAY_TREE: &[Mutant] = &[
    ("common/attributes.clh", "((float)(2u * y + 1u))", "((float)(2u * y))", Shot::Zoo, STEP1),
    ("common/attributes.clh", "((y & mask) << shift) + (x & mask)", "((x & mask) << shift) + (y & mask)", Shot::Zoo, STEP2C),
    ("common/attributes.clh", "= pack_normal(a->normal)", "= pack_normal(-a->normal)", Shot::Zoo, STEP3C),
    ("common/ray_tree.clh", "dot3(g, d) > 0.0f ? -g : g", "g", Shot::Zoo, STEP1),
    ("common/ray_tree.clh", "dot3(unit, p.geometric_normal) < 0.0f ? -unit : unit", "unit", Shot::Zoo, STEP1),
    ("common/ray_tree.clh", "float3 o = p->position + p->geometric_normal * p->offset", "float3 o = p->position - p->geometric_normal * 0.3f", Shot::Room, STEP1),
    ("common/ray_tree.clh", "float3 outside = p->position + p->geometric_normal * p->offset", "float3 outside = p->position - p->geometric_normal * p->offset", Shot::Zoo, STEP1),
    ("common/ray_tree.clh", "sum * OFFSET_ERROR", "sum * 0.01f", Shot::Zoo, STEP1),
    ("common/ray_tree.clh", "a + e1 * u + e2 * v", "a + e1 * v + e2 * u", Shot::Zoo, STEP1),
    ("common/ray_tree.clh", "distance * SHADOW_REACH", "distance * 0.2f", Shot::Zoo, STEP1),
    ("common/ray_tree.clh", "dot3(p->normal, to_light) > 0.0f", "dot3(p->normal, to_light) > -1.0e9f", Shot::Zoo, STEP1),
    ("common/ray_tree.clh", "shadowed ? 1u << i", "shadowed ? 1u << (i ^ 1u)", Shot::Zoo, STEP1),
    ("common/ray_tree.clh", "(2.0f * dot3(d, p->normal))", "(1.9f * dot3(d, p->normal))", Shot::Room, STEP1),
    ("common/ray_tree.clh", "c->weight * m->reflectance.xyz", "c->weight", Shot::Room, STEP1),
    ("common/ray_tree.clh", "(cos_i - eta * cos_t)", "(cos_i - cos_t)", Shot::Zoo, STEP1),
    ("common/ray_tree.clh", "sin2_t >= 1.0f", "sin2_t >= 0.5f", Shot::Zoo, STEP1),
    ("common/ray_tree.clh", "c->inside && !thin ? ior : 1.0f / ior", "1.0f / ior", Shot::Zoo, STEP1),
    ("common/ray_tree.clh", "thin ? c->direction : refracted", "refracted", Shot::Zoo, STEP1),
    ("common/ray_tree.clh", "thin ? c->inside : !c->inside", "c->inside", Shot::Zoo, STEP1),
    ("common/ray_tree.clh", "m->transmission.xyz * (1.0f - f)", "m->transmission.xyz", Shot::Zoo, STEP1),
    ("common/ray_tree.clh", "p->position - p->geometric_normal * p->offset", "p->position + p->geometric_normal * (2.0f * p->offset)", Shot::Zoo, STEP1),
    ("common/ray_tree.clh", "< WEIGHT_CUTOFF", "< 0.2f", Shot::Zoo, STEP1),
    ("common/ray_tree.clh", "spent < frame->depth_limit", "spent + 1u < frame->depth_limit", Shot::Zoo, STEP1),
    ("common/ray_tree.clh", "if (at_pane && c.refracted)", "if (c.refracted)", Shot::Zoo, STEP1),
    ("common/ray_tree.clh", "sum + c.weight * frame->background.xyz", "sum", Shot::Zoo, STEP1),
    ("common/ray_tree.clh", "surface == SURFACE_MIRROR ? 1u : 2u", "1u", Shot::Zoo, STEP1),
    ("common/ray_tree.clh", "a.gcol = gather_secondary", "a.position = gather_secondary", Shot::Zoo, RETRACE),
];

/// Textures, lighting, the encoding of colours, the shared maths.
#[rustfmt::skip]
const SHADING: &[Mutant] = &[
    ("common/shade.clh", "a + (b - a) * wx", "a + (b - a) * wy", Shot::Room, STEP1),
    ("common/shade.clh", "ix < 0 ? width - 1u", "ix < 0 ? 0u", Shot::Zoo, STEP1),
    ("common/shade.clh", "(1.0f - t) * (float)height", "t * (float)height", Shot::Zoo, STEP1),
    ("common/shade.clh", "m->diffuse.xyz * own", "m->diffuse.xyz", Shot::Room, STEP1),
    ("common/shade.clh", "kd * frame->ambient.xyz", "kd", Shot::Rods, STEP1),
    ("common/shade.clh", " + m->emission.xyz", "", Shot::Zoo, STEP1),
    ("common/shade.clh", "(shadow_bits >> i) & 1u", "(shadow_bits >> i) & 2u", Shot::Rods, STEP1),
    ("common/shade.clh", "radiance * inverse_d2", "radiance", Shot::Rods, STEP1),
    ("common/shade.clh", "normalize3(l + view)", "normalize3(l - view)", Shot::Zoo, STEP1),
    ("common/shade.clh", "TABLE_SRGB_THRESHOLD + guess + 1u", "TABLE_SRGB_THRESHOLD + guess", Shot::Rods, STEP1),
    ("common/shade.clh", "srgb_byte(tables, linear.y) << 8", "srgb_byte(tables, linear.x) << 8", Shot::Rods, STEP1),
    ("common/math.clh", "y * log2_poly(x)", "0.9f * y * log2_poly(x)", Shot::Zoo, STEP1),
    ("common/math.clh", "0x3f3504f3u", "0x3f800000u", Shot::Zoo, STEP1),
    ("common/math.clh", "f * (0.6931472f +", "f * (0.6f +", Shot::Zoo, STEP1),
    ("common/math.clh", "x >= 0.0f ? x - fold : x + fold", "x + fold", Shot::Zoo, STEP1),
    ("common/math.clh", "x = x >= 0.0f ? 1.0f - ay : ay - 1.0f", "x = 1.0f - ay", Shot::Zoo, STEP1),
    ("common/math.clh", "round(y * 32767.0f)", "floor(y * 32767.0f)", Shot::Zoo, STEP1),
    ("common/math.clh", "(uint)(t * 65536.0f) << 16", "(uint)(s * 65536.0f) << 16", Shot::Room, STEP1),
    ("common/math.clh", "f = x - floor(x)", "f = ceil(x) - x", Shot::Zoo, STEP1),
];

/// The seven tests and the interpolation.
#[rustfmt::skip]
const SIMILARITY: &[Mutant] = &[
    ("common/similarity.clh", "return FAIL_G1 & step->tests", "return FAIL_G2 & step->tests", Shot::Zoo, STEP2A),
    ("common/similarity.clh", "!(distance <= step->t_pos)", "!(distance <= 0.3f * step->t_pos)", Shot::Zoo, STEP2A),
    ("common/similarity.clh", "? 0u : FAIL_G2 & step->tests", "? 0u : 0u", Shot::Strictest, STEP3A),
    ("common/similarity.clh", ">= step->t_norm", ">= 0.5f * step->t_norm", Shot::Zoo, STEP2A),
    ("common/similarity.clh", "step->t_conv * distance", "0.0f * distance", Shot::Zoo, STEP2A),
    ("common/similarity.clh", "!= NO_TEXTURE", "== NO_TEXTURE", Shot::Room, STEP3A),
    ("common/similarity.clh", "a < t_tex && b > 1.0f - t_tex", "a < t_tex && b < 1.0f - t_tex", Shot::Paper, STEP2A),
    ("common/similarity.clh", "a->shadow_bits != b->shadow_bits", "(a->shadow_bits ^ b->shadow_bits) > 1u", Shot::Zoo, STEP2A),
    ("common/similarity.clh", "b->gcol, step->flags) <= step->t_gcol", "b->gcol, step->flags) <= 8.0f * step->t_gcol", Shot::Zoo, STEP3A),
    ("common/attributes.clh", "!(flags & STEP_GCOL_LINEAR)", "(flags & STEP_GCOL_LINEAR)", Shot::Zoo, STEP2A),
    ("common/attributes.clh", "(p > q ? p - q : q - p) >= t_visible", "(p > q ? p - q : 0u) >= t_visible", Shot::Zoo, MARK),
    ("common/attributes.clh", "(step->flags & STEP_COMPARE_SHADING)", "(step->flags & STEP_GCOL_LINEAR)", Shot::Zoo, MARK),
    ("common/similarity.clh", "k < 3u", "k < 1u", Shot::Zoo, STEP3A),
    ("common/similarity.clh", "k == 1u ? dy : 0u - dy", "dy", Shot::Zoo, STEP3A),
    ("common/similarity.clh", "((b_is_wide && ", "((", Shot::Zoo, STEP3A),
    ("common/similarity.clh", "(a_is_wide && ", "(", Shot::Zoo, STEP3A),
    ("common/similarity.clh", "*b = q;", "", Shot::Zoo, STEP3A),
    ("common/similarity.clh", "step, b, &p)", "step, a, &p)", Shot::Zoo, STEP3A),
    ("common/similarity.clh", "wa = zb / (za + zb)", "wa = za / (za + zb)", Shot::Zoo, STEP3A),
    ("common/similarity.clh", "m.normal = normalize3(a->normal * wa + b->normal * wb)", "m.normal = a->normal * wa + b->normal * wb", Shot::Zoo, STEP2A),
    ("common/similarity.clh", "m.gcol = a->gcol * wa + b->gcol * wb", "m.gcol = a->gcol", Shot::Zoo, STEP3A),
    ("common/similarity.clh", "x + step->reference_dx >= frame->width", "x + step->reference_dx > frame->width", Shot::Zoo, STEP2A),
    ("common/similarity.clh", "attributes[PLANE_CLAIM * pitch + at] = NO_CLAIM", "attributes[PLANE_CLAIM * pitch + at] = 0u", Shot::Zoo, STEP3A),
    ("common/attributes.clh", "unpack_texcoord(texcoord & 0xffffu)", "unpack_texcoord(texcoord >> 16)", Shot::Room, STEP2A),
];

/// Packing.
#[rustfmt::skip]
const PACKING: &[Mutant] = &[
    ("common/pack_order.clh", "wanted = CLASS_INTERPOLATED;", "", Shot::Rods, PROBE_COUNT),
    ("common/pack.clh", "k < 32u &&", "k < 31u &&", Shot::Zoo, STEP2B_COUNT),
    ("common/pack.clh", "popcount(mask)", "popcount(mask >> 1)", Shot::Zoo, STEP3B_COUNT),
    ("common/pack.clh", "lane >= stride ?", "lane > stride ?", Shot::Rods, SCAN),
    ("common/pack.clh", "= prefix - value", "= prefix", Shot::Zoo, STEP3B_SCAN),
    ("common/pack.clh", "+ element / lanes] = total", "+ element / lanes] = value", Shot::Rods, SCAN),
    ("common/pack.clh", "base += sums[offset + element]", "base = sums[offset + element]", Shot::Large, STEP2B_SCATTER),
    ("common/pack.clh", "offset += count", "offset += 0u", Shot::Large, STEP2B_SCATTER),
    ("common/pack_order.clh", "within / PACK_TILE_SIDE", "within % PACK_TILE_SIDE", Shot::Zoo, STEP2B_SCATTER),
    ("common/pack.clh", "*total = scratch[from + lanes - 1u]", "*total = scratch[from]", Shot::Rods, TAIL),
    ("common/pack_order.clh", "CLASS_SECONDARY)) == wanted", "CLASS_SECONDARY)) != wanted", Shot::Zoo, STEP3B_COUNT),
    ("common/pack_order.clh", "i < grid_items(step) ? CLASS_PENDING | CLASS_SECONDARY", "i >= grid_items(step) ? CLASS_PENDING | CLASS_SECONDARY", Shot::Zoo, STEP2B_COUNT),
    ("common/pack_order.clh", "i < half_items ? i : i - half_items", "i", Shot::Zoo, STEP3B_SCATTER),
    ("common/similarity.clh", "sends_secondary(materials, object_materials, &a) ||", "", Shot::Zoo, STEP2A),
    ("common/similarity.clh", "surface != SURFACE_OPAQUE", "surface == SURFACE_OPAQUE", Shot::Zoo, STEP3A),
];

/// Whole repetitions of textures, shifted rows, textures in mirrors and behind glass.
#[rustfmt::skip]
const DETAIL: &[Mutant] = &[
    ("common/attributes.clh", "whole_repeats(a->s) << CLASS_REPEATS_S", "whole_repeats(a->t) << CLASS_REPEATS_S", Shot::Window, STEP1),
    ("common/attributes.clh", "(24u - CLASS_REPEATS_T)", "(24u - CLASS_REPEATS_S)", Shot::Window, STEP2A),
    ("common/attributes.clh", "block == 2u ? y >> 1 & 1u", "block == 2u ? 0u", Shot::Window, STEP1),
    ("common/attributes.clh", "(y >> 1 & 2u) | (y >> 3 & 1u)", "(y >> 1 & 2u)", Shot::WindowFast, STEP1),
    ("common/math.clh", "(uint)(whole - 256.0f", "(uint)(fabs(whole) - 256.0f", Shot::Window, STEP1),
    ("common/similarity.clh", "!(fabs(unwrap(a->s, b->s) - a->s) <= step->t_tex)", "!(fabs(unwrap(a->s, b->s) - a->s) <= 0.1f * step->t_tex)", Shot::Window, STEP2A),
    ("common/similarity.clh", "!(fabs(unwrap(a->t, b->t) - a->t) <= step->t_tex)", "!(fabs(unwrap(a->t, b->t) - a->t) <= 0.1f * step->t_tex)", Shot::Window, STEP3A),
    ("common/similarity.clh", "b - a > 128.0f ? b - 256.0f", "b - a > 128.0f ? b", Shot::FarWindow, STEP3A),
    ("common/similarity.clh", "a - b > 128.0f ? b + 256.0f", "a - b > 128.0f ? b", Shot::FarWindow, STEP2A),
    ("common/similarity.clh", "a->behind != b->behind) return false", "a->behind == b->behind) return false", Shot::WindowFast, STEP2A),
    ("common/similarity.clh", "fraction1((a->s + bs) * 0.5f)", "fraction1(a->s)", Shot::WindowFast, STEP2A),
    ("common/similarity.clh", "fraction1((a->t + bt) * 0.5f)", "fraction1(a->t)", Shot::Window, STEP3A),
    ("common/similarity.clh", "m->surface == SURFACE_MIRROR ? m->reflectance", "m->surface != SURFACE_MIRROR ? m->reflectance", Shot::WindowFast, STEP2A),
    ("common/similarity.clh", "if (a->behind != b->behind) m.behind", "if (a->behind == b->behind) m.behind", Shot::Window, STEP3A),
    ("common/similarity.clh", "m.s = a->s * wa + unwrap(a->s, b->s) * wb", "m.s = a->s", Shot::Window, STEP2A),
    ("common/ray_tree.clh", "seen->s = at.s", "seen->s = at.t", Shot::Window, STEP1),
    ("common/ray_tree.clh", "chain + 1u == chains &&", "", Shot::Window, STEP1),
    ("common/ray_tree.clh", "seen->behind == NO_OBJECT &&", "", Shot::Zoo, STEP1),
];

/// A cache of its own, kept from run to run: mutants shall not crowd the user's.
fn open(shot: Shot) -> OpenOptions {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("mutants");
    OpenOptions { cache: CacheFolder::At(folder), ..walking_by(shot.traversal()) }
}

fn parity(prepared: &Prepared, shot: Shot, launch: Launch, mutation: Option<Mutation>) -> Vec<KernelParity> {
    let mut device = mutated_device(true, &open(shot), mutation);
    prepared.parity(&mut device, &shot.options(), shot.counters(), Some(launch)).unwrap()
}

/// All tables.
const TABLES: [&[Mutant]; 11] = [
    ENTRY_POINTS,
    CORRECTION,
    BRIDGES,
    KNOWN_SHADOWS,
    TRAVERSAL,
    SHORT_WALK,
    RAY_TREE,
    SHADING,
    SIMILARITY,
    DETAIL,
    PACKING,
];

/// Of each file, and of each launch that these leave out, the first mutant: a mutant costs a program.
fn sample() -> Vec<&'static Mutant> {
    let all = || TABLES.into_iter().flatten();
    let mut chosen: Vec<&Mutant> = Vec::new();
    for &(file, _) in FILES {
        chosen.extend(all().find(|mutant| mutant.0 == file));
    }
    for (stage, kernel, _) in LAUNCHES {
        if chosen.iter().all(|mutant| mutant.4 != (stage, kernel)) {
            chosen.extend(all().find(|mutant| mutant.4 == (stage, kernel)));
        }
    }
    chosen
}

fn every_broken_line_is_caught(mutants: impl IntoIterator<Item = &'static Mutant>) {
    if no_opencl() {
        return;
    }
    // For whoever changes one kernel: only mutants of a file, or of lines, that have one of these parts.
    let only = std::env::var("MUTANTS_OF").unwrap_or_default();
    let is_wanted = |m: &&Mutant| only.split('|').any(|part| m.0.contains(part) || m.1.contains(part));
    let mutants: Vec<&Mutant> = mutants.into_iter().filter(is_wanted).collect();
    let mut scenes: HashMap<&str, Prepared> = HashMap::new();
    let mut sound: BTreeSet<String> = BTreeSet::new();
    let mut missed = Vec::new();
    println!("{:22} {:24} caught by", "launch", "file");
    for &&(file, from, to, shot, launch) in &mutants {
        let label = launch.1.label(launch.0);
        let Some((_, text)) = FILES.iter().find(|(name, _)| *name == file).filter(|(_, text)| text.contains(from))
        else {
            missed.push(format!("{file}: `{from}` is not there any more: write the mutant anew"));
            continue;
        };
        assert_ne!(*text, text.replacen(from, to, 1));
        let prepared = scenes.entry(shot.scene()).or_insert_with(|| Prepared::named(shot.scene()));
        // What is caught must come from the mutation.
        if sound.insert(format!("{shot:?} {label}")) {
            let results = parity(prepared, shot, launch, None);
            assert!(results.iter().all(|r| r.different == 0), "unbroken kernels differ: {shot:?} {results:#?}");
        }
        let mutation = Mutation { file: file.into(), from: from.into(), to: to.into() };
        let results = parity(prepared, shot, launch, Some(mutation));
        let caught: Vec<&KernelParity> = results.iter().filter(|r| r.different > 0).collect();
        let words: u64 = caught.iter().map(|r| r.different).sum();
        println!("{label:22} {file:24} {words} words\n      {from}\n   -> {to}");
        if caught.is_empty() {
            missed.push(format!("{file}: `{from}` -> `{to}` in {shot:?}: {label} does not show it"));
        }
    }
    assert!(missed.is_empty(), "{} of {} mutants live:\n{}", missed.len(), mutants.len(), missed.join("\n"));
    println!("{} mutants, all caught", mutants.len());
}

#[test]
fn every_file_and_every_launch_has_a_mutant() {
    let launches: BTreeSet<Launch> = ENTRY_POINTS.iter().map(|m| m.4).collect();
    let all = LAUNCHES.into_iter().map(|(stage, kernel, _)| (stage, kernel)).collect();
    assert_eq!(launches, all, "a launch without a mutant of its own");
    let sampled: BTreeSet<Launch> = sample().into_iter().map(|m| m.4).collect();
    assert_eq!(sampled, all, "a launch that the quick tests leave out");
    // Structs are probed, and the probe has nothing to break.
    let files = FILES.iter().map(|(file, _)| *file).filter(|file| !matches!(*file, "types.h" | "probe.cl"));
    let without: Vec<&str> = files.filter(|file| sample().iter().all(|mutant| mutant.0 != *file)).collect();
    assert!(without.is_empty(), "no mutant of {without:?}");
}

// Each a test of its own, so that they run side by side.

#[test]
fn a_first_half_of_the_sample_is_caught() {
    every_broken_line_is_caught(sample().into_iter().step_by(2));
}

#[test]
fn a_second_half_of_the_sample_is_caught() {
    every_broken_line_is_caught(sample().into_iter().skip(1).step_by(2));
}

#[test]
#[ignore = "long: a mutant of each entry point and of every line of correction"]
fn mutants_of_entry_points_and_correction_are_caught() {
    every_broken_line_is_caught([ENTRY_POINTS, CORRECTION].into_iter().flatten());
}

#[test]
#[ignore = "long: every mutant of bridges, known shadows, checks, detail and packing"]
fn mutants_of_bridges_shadows_checks_detail_and_packing_are_caught() {
    every_broken_line_is_caught([BRIDGES, KNOWN_SHADOWS, SIMILARITY, DETAIL, PACKING].into_iter().flatten());
}

#[test]
#[ignore = "long: every mutant of walks, rays and shading"]
fn mutants_of_walks_rays_and_shading_are_caught() {
    every_broken_line_is_caught([TRAVERSAL, SHORT_WALK, RAY_TREE, SHADING].into_iter().flatten());
}

/// Breaks a stage and looks at what the self-test says.
fn the_self_test_names(stage: Stage) {
    if no_opencl() {
        return;
    }
    let mutation = Some(full::breaking_mutation(stage));
    let result = full::run(&DeviceOptions { mutation, ..DeviceOptions::default() }).unwrap();
    let wrong: Vec<&str> = result.checks.iter().filter(|c| !c.passed).map(|c| c.name.as_str()).collect();
    assert!(!wrong.is_empty(), "{}: passes", stage.name());
    assert!(wrong.iter().all(|name| name.starts_with(stage.name())), "{}: {wrong:?}", stage.name());
    let error = result.require().unwrap_err().to_string();
    assert!(error.contains(&format!(": {}", stage.name())), "{error}");
}

#[test]
fn the_self_test_names_a_stage_that_is_broken() {
    the_self_test_names(Stage::Step2b);
}

#[test]
#[ignore = "long: the self-test with each stage broken in turn"]
fn the_self_test_names_every_stage_that_is_broken() {
    Stage::ALL.into_iter().for_each(the_self_test_names);
}
