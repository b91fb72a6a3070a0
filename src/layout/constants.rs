// SPDX-License-Identifier: MIT OR Apache-2.0
//! Numbers that host and kernels share. They exist once, here, and reach kernels as build options.

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
    /// Attribute plane: fractions of the texture coordinates ([`crate::math::pack_texcoord`]).
    PLANE_TEXCOORD = 7;
    /// Attribute plane: object id, or [`NO_OBJECT`].
    PLANE_OBJECT = 8;
    /// Attribute plane: shadow bits, one per light.
    PLANE_SHADOW = 9;
    /// Attribute plane: pixel class (`CLASS_*`) in the low bits, fail mask (`FAIL_*`) above, whole repeats of textures above
    /// that.
    PLANE_CLASS = 10;
    /// Attribute plane: step4's claims, the lowest item that wants the pixel; in sources, the pixel across a gap.
    PLANE_CLAIM = 11;
    /// Attribute plane: the object seen in a mirror or behind glass, or [`NO_OBJECT`].
    PLANE_BEHIND = 12;
    /// Number of attribute planes: 52 bytes a sample.
    PLANE_COUNT = 13;

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
    /// Class-plane bits that a pixel's check wrote above the class.
    CLASS_CHECKED = 0xff << 8;
    /// Where in the class plane the whole repeats of texture coordinate s lie, modulo 256.
    CLASS_REPEATS_S = 16;
    /// Those of t.
    CLASS_REPEATS_T = 24;

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
    /// Step flag: texture coordinates are compared and interpolated across repetitions.
    STEP_UNWRAP = 256;
    /// Step flag: lights about which a traced pixel's references agree need no shadow ray.
    STEP_REUSE_SHADOWS = 512;
    /// Step flag: in step4 sources also look for pixels between two parts of something thin.
    STEP_BRIDGE = 1024;
    /// Step flag: the rows of a grid are shifted against each other.
    STEP_SHIFTED = 2048;
    /// Step flag: the grid's items are probes of step4, one in each tile of the picture.
    STEP_PROBES = 4096;
    /// Step flag: GC looks for texture between the points that two references see in a mirror or behind glass.
    STEP_BEHIND = 8192;

    /// Side of the square tiles that have a probe each.
    PROBE_TILE = 16;
    /// Items of a source in step4's first round: four neighbours and a pixel across a gap. Later rounds have four.
    STEP4_WAYS_MOST = 5;
    /// How many columns to either side step4 looks for the other part of something thin.
    BRIDGE_REACH = 16;

    /// A round of step4 with at most this many sources is left to `correct_tail`: a wave's worth.
    TAIL_SOURCES = 64;
    /// Rounds in one launch of `correct_tail`; what it takes must stay below a slice.
    TAIL_ROUNDS = 16;
    /// What `correct_tail` leaves in the sums buffer: the first list entry of the next round's sources.
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
    /// Triangle bit: glass, which casts no shadow, and yields to what is opaque in the same plane.
    TRIANGLE_GLASS = 2;
    /// Triangle bit: rays pass it from behind, where another one faces.
    TRIANGLE_ONE_SIDED = 4;
    /// The first of the two bits of a triangle that hold the axis of its plane.
    TRIANGLE_AXIS_SHIFT = 8;

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
/// Error of a distance from a plane, in sizes (sums of absolute coordinates) of the vector to a point of that plane: five
/// roundings of at most half a unit in the last place, and some reserve.
pub const PLANE_ERROR: f32 = 4.0 * f32::EPSILON;
/// Error of a position, in sizes of the corner and the edges that it is the sum of: four such roundings, and as much again
/// for the rounding of the offset itself and for planes that are one in the file and not quite after rounding.
pub const OFFSET_ERROR: f32 = 4.0 * f32::EPSILON;
/// Most of such sizes that rays start from a position in order to leave the tree's cell around their surface.
pub const OFFSET_MOST: f32 = 48.0 * f32::EPSILON;
/// The part of the way to a light that is asked for things that cast a shadow: a light may lie on a surface.
pub const SHADOW_REACH: f32 = 0.9999;
/// Linear values below this are black; the float whose leading half word is [`SRGB_FIRST_BUCKET`].
pub const SRGB_LEAST: f32 = f32::from_bits(SRGB_FIRST_BUCKET << 16);
