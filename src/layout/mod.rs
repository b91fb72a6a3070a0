// SPDX-License-Identifier: MIT OR Apache-2.0
//! Rust mirror of `kernels/types.h`, and the numbers that host and kernels share.
//!
//! `kernels/types.h` is the truth for structs: sizes are asserted here, sizes and offsets by a probe kernel in the
//! tests and in `rarefy selftest`. Numbers exist once, here, and reach kernels as build options ([`build_options`]).

use bytemuck::{Pod, Zeroable};

/// Object id of "no hit": an object of its own (paper section 3, `OID`).
pub const NO_OBJECT: u32 = u32::MAX;

/// Declares constants and lists them for the kernels under the same names.
macro_rules! shared_constants {
    ($($(#[$doc:meta])* $name:ident = $value:expr;)*) => {
        $($(#[$doc])* pub const $name: u32 = $value;)*
        /// Every shared whole number with its name in kernels.
        pub const SHARED_CONSTANTS: &[(&str, u32)] = &[$((stringify!($name), $name)),*];
    };
}

shared_constants! {
    /// Attribute plane: x of the hit position, scene units (float bits).
    PLANE_POSITION_X = 0;
    /// Attribute plane: y of the hit position.
    PLANE_POSITION_Y = 1;
    /// Attribute plane: z of the hit position.
    PLANE_POSITION_Z = 2;
    /// Attribute plane: red of the light gathered by secondary rays, linear (float bits).
    PLANE_GCOL_R = 3;
    /// Attribute plane: green of it.
    PLANE_GCOL_G = 4;
    /// Attribute plane: blue of it.
    PLANE_GCOL_B = 5;
    /// Attribute plane: the unit shading normal ([`crate::math::pack_normal`]).
    PLANE_NORMAL = 6;
    /// Attribute plane: texture coordinates in `[0, 1)` ([`crate::math::pack_texcoord`]).
    PLANE_TEXCOORD = 7;
    /// Attribute plane: object id, or [`NO_OBJECT`].
    PLANE_OBJECT = 8;
    /// Attribute plane: shadow bits, one per light.
    PLANE_SHADOW = 9;
    /// Attribute plane: pixel class (`CLASS_*`) in the low bits, fail mask (`FAIL_*`) above.
    PLANE_CLASS = 10;
    /// Attribute plane: step4's claims, the lowest item that wants the pixel.
    PLANE_CLAIM = 11;
    /// Number of attribute planes: 48 bytes a sample.
    PLANE_COUNT = 12;

    /// Counter plane: inner kd-tree nodes visited.
    COUNTER_TRAVERSAL_STEPS = 0;
    /// Counter plane: ray-triangle tests.
    COUNTER_TRIANGLE_TESTS = 1;
    /// Counter plane: shadow rays.
    COUNTER_SHADOW_RAYS = 2;
    /// Counter plane: reflection rays.
    COUNTER_REFLECTION_RAYS = 3;
    /// Counter plane: refraction rays, straight ones through thin glass included.
    COUNTER_REFRACTION_RAYS = 4;
    /// Counter plane: surface points shaded.
    COUNTER_SHADED = 5;
    /// Number of counter planes.
    COUNTER_COUNT = 6;

    /// Bits of the class plane that hold the class.
    CLASS_MASK = 0xff;
    /// Not yet reached.
    CLASS_NONE = 0;
    /// Base pixel, traced in step1.
    CLASS_BASE = 1;
    /// Adaptive pixel whose checks failed, waiting for its ray.
    CLASS_PENDING = 2;
    /// Adaptive pixel traced in step2c or step3c.
    CLASS_TRACED = 3;
    /// Adaptive pixel rebuilt from its references.
    CLASS_INTERPOLATED = 4;
    /// Traced in step4, and changed by it.
    CLASS_CORRECTED = 5;
    /// Traced in step4, and found to be what interpolation had said.
    CLASS_CONFIRMED = 6;

    /// Class-plane bit: test G1 (same object) failed.
    FAIL_G1 = 1 << 8;
    /// Class-plane bit: test G2 (close positions) failed.
    FAIL_G2 = 1 << 9;
    /// Class-plane bit: test G3 (similar normals) failed.
    FAIL_G3 = 1 << 10;
    /// Class-plane bit: test G4 (convexity) failed.
    FAIL_G4 = 1 << 11;
    /// Class-plane bit: test TX (texture border) failed.
    FAIL_TX = 1 << 12;
    /// Class-plane bit: test SH (shadow bits) failed.
    FAIL_SH = 1 << 13;
    /// Class-plane bit: test GC (reflected colour) failed.
    FAIL_GC = 1 << 14;
    /// All fail bits.
    FAIL_ALL = 0x7f << 8;

    /// Class-plane bit: a reference of this pixel is a mirror or glass, so that its ray may send secondary rays.
    CLASS_SECONDARY = 1 << 15;

    /// Step flag: write attributes and class.
    STEP_STORE = 1;
    /// Step flag: step4 compares shadow bits too.
    STEP_COMPARE_SHADOW = 2;
    /// Step flag: perspective-correct interpolation.
    STEP_PERSPECTIVE = 4;
    /// Step flag: test GC compares linear colours, not their square roots.
    STEP_GCOL_LINEAR = 8;
    /// Step flag: step4 compares normals (by `t_norm`) and reflected colours (by `t_gcol`) too.
    STEP_COMPARE_SHADING = 16;
    /// Step flag: step4's listed pixels had their rays already and are only marked.
    STEP_SETTLE = 32;
    /// Step flag: in step4 traced pixels do not spread to what a straight edge or line would pass by.
    STEP_THIN_ONLY = 64;
    /// Step flag: a pixel whose own references fail may be interpolated between other neighbours.
    STEP_OTHER_PAIRS = 128;
    /// Step flag: texture coordinates are compared and interpolated the shorter way around.
    STEP_UNWRAP = 256;
    /// Step flag: lights about which a traced pixel's references agree need no shadow ray.
    STEP_REUSE_SHADOWS = 512;
    /// Step flag: in step4 sources also look for pixels between two parts of something thin.
    STEP_BRIDGE = 1024;

    /// How many columns to either side step4 looks for the other part of something thin.
    BRIDGE_REACH = 16;

    /// A round of step4 with at most this many sources is left to step4_tail: a wave's worth.
    TAIL_SOURCES = 64;
    /// Rounds in one launch of step4_tail; what it takes must stay below a slice.
    TAIL_ROUNDS = 16;
    /// What step4_tail leaves in the sums buffer: the first list entry of the next round's sources.
    TAIL_SUM_SOURCES = 0;
    /// The end of the list.
    TAIL_SUM_LIST = 1;
    /// How many rounds it did.
    TAIL_SUM_ROUNDS = 2;
    /// From here on, the end of the list after each round.
    TAIL_SUM_ENDS = 3;

    /// Surface kind: diffuse and highlight only.
    SURFACE_OPAQUE = 0;
    /// Surface kind: mirror.
    SURFACE_MIRROR = 1;
    /// Surface kind: refracting glass.
    SURFACE_GLASS = 2;
    /// Surface kind: a pane without thickness.
    SURFACE_THIN_GLASS = 3;

    /// A chain of secondary rays ends behind this many panes of thin glass.
    PANES_MOST = 16;

    /// Triangle bit: a cut-out texture may make holes.
    TRIANGLE_CUTOUT = 1;
    /// Triangle bit: casts no shadow (glass).
    TRIANGLE_NO_SHADOW = 2;

    /// "No texture" in a material.
    NO_TEXTURE = u32::MAX;
    /// "No triangle" in a hit.
    NO_TRIANGLE = u32::MAX;
    /// "No pixel" in a pixel address.
    NO_PIXEL = u32::MAX;
    /// "Nobody" in the claim plane.
    NO_CLAIM = u32::MAX;

    /// Axis bits of a kd-tree leaf.
    LEAF = 3;
    /// Entries of a traversal stack.
    MAX_DEPTH = 48;
    /// Side of the square tiles in whose order pixels are packed, in grid items.
    PACK_TILE_SIDE = 32;

    /// First word of the sRGB thresholds in the tables buffer (257 floats).
    TABLE_SRGB_THRESHOLD = 256;
    /// First word of the sRGB guesses in the tables buffer.
    TABLE_SRGB_GUESS = 256 + 257;
    /// Leading half word of the least linear value that the guesses cover.
    SRGB_FIRST_BUCKET = 0x3900;
}

/// Hits lie nearer than this; scene units.
pub const FAR_AWAY: f32 = 1.0e30;
/// A chain of secondary rays ends when no channel of its weight reaches this.
pub const WEIGHT_CUTOFF: f32 = 1.0 / 512.0;
/// A mirror or glass whose own colour has at most this weight has little light of its own.
pub const LITTLE_OWN_LIGHT: f32 = 0.5;
/// Linear values below this are black; the float whose leading half word is [`SRGB_FIRST_BUCKET`].
pub const SRGB_LEAST: f32 = f32::from_bits(SRGB_FIRST_BUCKET << 16);

/// How a ray remembers the way through the kd-tree. All ways come to the same leaves in the same order, so that hits and
/// triangle tests are the same; only the number of steps differs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Traversal {
    /// An indexed array in private memory: right for CPUs.
    #[default]
    PrivateStack,
    /// [`SHORT_STACK_ENTRIES`] entries in registers, then a restart: for GPUs where indexed private arrays spill to memory.
    ShortStack,
    /// No entries at all: a restart for every cell.
    Stackless,
}

impl Traversal {
    /// Every variant with the word that stands for it in a profile.
    pub const NAMES: [(&'static str, Traversal); 3] = [
        ("private-stack", Traversal::PrivateStack),
        ("short-stack", Traversal::ShortStack),
        ("stackless", Traversal::Stackless),
    ];

    /// The word that stands for it in a profile.
    pub fn name(self) -> &'static str {
        Self::NAMES[self as usize].0
    }

    /// Entries of the short stack; `None` for the private stack.
    pub fn short_stack_entries(self) -> Option<u32> {
        match self {
            Traversal::PrivateStack => None,
            Traversal::ShortStack => Some(SHORT_STACK_ENTRIES),
            Traversal::Stackless => Some(0),
        }
    }
}

/// Entries of a short stack, which kernels hold in scalars of that number.
pub const SHORT_STACK_ENTRIES: u32 = 4;

/// Which flavour of the kernels is built.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct BuildFlavour {
    /// Bit for bit like the CPU twin: correctly rounded division and square root, where the device has a choice.
    pub strict: bool,
    /// Keep per-pixel work counters.
    pub count: bool,
    /// Shade by the rules of the speed anchor.
    pub anchor: bool,
    /// How rays walk through the kd-tree.
    pub traversal: Traversal,
}

/// The build options that make kernels of a flavour; the wrapper adds the language version and `-Werror`.
pub fn build_options(flavour: BuildFlavour) -> String {
    use std::fmt::Write;
    let mut options = String::new();
    for (name, value) in SHARED_CONSTANTS.iter().chain(&[("NO_OBJECT", NO_OBJECT)]) {
        // Writing to a String cannot fail.
        let _ = write!(options, "-D{name}={value}u ");
    }
    for (name, value) in [
        ("FAR_AWAY", FAR_AWAY),
        ("WEIGHT_CUTOFF", WEIGHT_CUTOFF),
        ("LITTLE_OWN_LIGHT", LITTLE_OWN_LIGHT),
        ("SRGB_LEAST", SRGB_LEAST),
    ] {
        let _ = write!(options, "-D{name}={value:?}f ");
    }
    for (on, name) in
        [(flavour.strict, "RAREFY_STRICT"), (flavour.count, "RAREFY_COUNT"), (flavour.anchor, "RAREFY_ANCHOR")]
    {
        if on {
            let _ = write!(options, "-D{name}=1 ");
        }
    }
    if let Some(entries) = flavour.traversal.short_stack_entries() {
        let _ = write!(options, "-DRAREFY_SHORT_STACK={entries} ");
    }
    options.truncate(options.trim_end().len());
    options
}

/// `FrameParams` of `kernels/types.h`: what stays the same for a whole frame or one window of it.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[allow(missing_docs)] // documented member by member in kernels/types.h
pub struct FrameParams {
    pub eye: [f32; 4],
    pub forward: [f32; 4],
    pub right: [f32; 4],
    pub up: [f32; 4],
    pub ambient: [f32; 4],
    pub background: [f32; 4],
    pub bounds_min: [f32; 4],
    pub bounds_max: [f32; 4],
    pub width: u32,
    pub height: u32,
    pub block: u32,
    pub phase_width: u32,
    pub phase_height: u32,
    pub plane_pitch: u32,
    pub light_count: u32,
    pub depth_limit: u32,
    pub epsilon: f32,
    pub window_begin: u32,
    pub window_end: u32,
    pub interior_begin: u32,
    pub interior_end: u32,
    pub pad: [u32; 3],
}
const _: () = assert!(size_of::<FrameParams>() == 192);

/// `StepParams` of `kernels/types.h`: what one launch works on.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[allow(missing_docs)] // documented member by member in kernels/types.h
pub struct StepParams {
    pub origin_x: u32,
    pub origin_y: u32,
    pub step_x: u32,
    pub step_y: u32,
    pub grid_width: u32,
    pub grid_height: u32,
    pub reference_dx: u32,
    pub reference_dy: u32,
    pub item_count: u32,
    pub list_offset: u32,
    pub source_offset: u32,
    pub sums_offset: u32,
    pub t_pos: f32,
    pub t_norm: f32,
    pub t_conv: f32,
    pub t_tex: f32,
    pub t_gcol: f32,
    pub tests: u32,
    pub flags: u32,
    pub scan_group: u32,
    pub lenient_tests: u32,
    pub t_visible: u32,
    pub pad: [u32; 2],
}
const _: () = assert!(size_of::<StepParams>() == 96);

/// `Light` of `kernels/types.h`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[allow(missing_docs)] // documented member by member in kernels/types.h
pub struct Light {
    pub position: [f32; 4],
    pub intensity: [f32; 4],
}
const _: () = assert!(size_of::<Light>() == 32);

/// `Material` of `kernels/types.h`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[allow(missing_docs)] // documented member by member in kernels/types.h
pub struct Material {
    pub diffuse: [f32; 4],
    pub specular: [f32; 4],
    pub reflectance: [f32; 4],
    pub transmission: [f32; 4],
    pub surface: u32,
    pub diffuse_texture: u32,
    pub cutout_texture: u32,
    pub pad0: u32,
}
const _: () = assert!(size_of::<Material>() == 80);

/// `Texture` of `kernels/types.h`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[allow(missing_docs)] // documented member by member in kernels/types.h
pub struct Texture {
    pub offset: u32,
    pub width: u32,
    pub height: u32,
    pub pad0: u32,
}
const _: () = assert!(size_of::<Texture>() == 16);

/// A triangle as traversal reads it: a corner and two edges; `corner[3]` holds `TRIANGLE_*` bits.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Triangle {
    /// First corner; the fourth float's bits are flags.
    pub corner: [f32; 4],
    /// Second corner minus the first; the fourth float is unused.
    pub edge1: [f32; 4],
    /// Third corner minus the first; the fourth float is unused.
    pub edge2: [f32; 4],
}
const _: () = assert!(size_of::<Triangle>() == 48);

/// `TriangleShading` of `kernels/types.h`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[allow(missing_docs)] // documented member by member in kernels/types.h
pub struct TriangleShading {
    pub normals: [u32; 3],
    pub object: u32,
    /// `s` and `t` of the three corners in turn.
    pub texcoords: [f32; 6],
    pub material: u32,
    pub pad0: u32,
}
const _: () = assert!(size_of::<TriangleShading>() == 48);

/// What the probe kernel must report: sizes and offsets in bytes, in its order.
pub fn expected_probe() -> Vec<u32> {
    use std::mem::offset_of;
    let bytes: [usize; 25] = [
        size_of::<FrameParams>(),
        offset_of!(FrameParams, up),
        offset_of!(FrameParams, bounds_max),
        offset_of!(FrameParams, width),
        offset_of!(FrameParams, plane_pitch),
        offset_of!(FrameParams, epsilon),
        offset_of!(FrameParams, interior_end),
        size_of::<StepParams>(),
        offset_of!(StepParams, reference_dx),
        offset_of!(StepParams, item_count),
        offset_of!(StepParams, t_pos),
        offset_of!(StepParams, tests),
        offset_of!(StepParams, scan_group),
        size_of::<Light>(),
        offset_of!(Light, intensity),
        size_of::<Material>(),
        offset_of!(Material, transmission),
        offset_of!(Material, surface),
        offset_of!(Material, cutout_texture),
        size_of::<Texture>(),
        offset_of!(Texture, height),
        size_of::<TriangleShading>(),
        offset_of!(TriangleShading, object),
        offset_of!(TriangleShading, texcoords) + 5 * size_of::<f32>(),
        offset_of!(TriangleShading, material),
    ];
    bytes.iter().map(|&b| b as u32).collect()
}

/// The tables buffer: 256 decoded sRGB bytes, 257 thresholds, and the guesses of the encoder.
pub fn tables() -> Vec<u32> {
    let decode = |value: f64| if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) };
    let mut words: Vec<u32> = (0..256).map(|byte| (decode(byte as f64 / 255.0) as f32).to_bits()).collect();
    // thresholds[i] is the least linear value that is shown as byte i or more.
    let thresholds: Vec<f32> =
        (0..=256).map(|byte| if byte == 0 { 0.0 } else { decode((byte as f64 - 0.5) / 255.0) as f32 }).collect();
    words.extend(thresholds.iter().map(|t| t.to_bits()));
    for bucket in SRGB_FIRST_BUCKET..=(1.0f32.to_bits() >> 16) {
        let least = f32::from_bits(bucket << 16);
        words.push(thresholds.iter().rposition(|&t| t <= least).unwrap_or(0).min(255) as u32);
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_srgb_encoder_needs_at_most_one_step_from_its_guess() {
        let words = tables();
        let threshold = |i: usize| f32::from_bits(words[TABLE_SRGB_THRESHOLD as usize + i]);
        assert!(SRGB_LEAST < threshold(1), "values below the first bucket must be black");
        for bucket in SRGB_FIRST_BUCKET..(1.0f32.to_bits() >> 16) {
            let guess = words[(TABLE_SRGB_GUESS + bucket - SRGB_FIRST_BUCKET) as usize] as usize;
            let last = f32::from_bits(((bucket + 1) << 16) - 1);
            assert!(threshold(guess) <= f32::from_bits(bucket << 16) || guess == 0);
            assert!(guess >= 254 || last < threshold(guess + 2), "bucket {bucket:#x} spans three bytes");
        }
    }

    #[test]
    fn options_name_every_constant_once() {
        let options = build_options(BuildFlavour { strict: true, ..BuildFlavour::default() });
        assert_eq!(options.matches("-DPLANE_CLAIM=11u").count(), 1);
        assert!(options.contains("-DRAREFY_STRICT=1") && !options.contains("RAREFY_COUNT"));
        assert!(!options.contains("RAREFY_SHORT_STACK"));
        let mut names: Vec<&str> = SHARED_CONSTANTS.iter().map(|(name, _)| *name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), SHARED_CONSTANTS.len());
    }

    #[test]
    fn traversals_have_their_words_and_options() {
        assert!(Traversal::NAMES.iter().all(|(name, value)| value.name() == *name));
        let options = |traversal| build_options(BuildFlavour { traversal, ..BuildFlavour::default() });
        assert!(options(Traversal::ShortStack).ends_with(" -DRAREFY_SHORT_STACK=4"));
        assert!(options(Traversal::Stackless).ends_with(" -DRAREFY_SHORT_STACK=0"));
    }
}
