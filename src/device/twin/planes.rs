// SPDX-License-Identifier: MIT OR Apache-2.0
//! Twin of `kernels/common/attributes.clh`: the buffers that stages read and write.
//!
//! Words are atomics with relaxed order, so that items may run on any thread without unsafe code; on every platform
//! that is an ordinary load or store.

use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use glam::Vec3;

use super::scene_args::{Work, xyz};
use crate::error::Result;
use crate::layout::*;
pub use crate::layout::{color_index, plane_index};
use crate::math::{clamp, dot, fraction, pack_normal, pack_texcoord, unpack_normal, unpack_texcoord, whole_repeats};
use crate::memory;
use crate::monitor::Monitor;

/// A buffer of 32-bit words that items on any thread may read and write.
#[derive(Debug, Default)]
pub struct Words(Vec<AtomicU32>);

impl Words {
    /// A buffer of zeros.
    pub fn zeroed(len: usize) -> Self {
        Words(std::iter::repeat_with(AtomicU32::default).take(len).collect())
    }

    /// A buffer of zeros. It takes a while to make a large one.
    ///
    /// # Errors
    /// [`crate::Error::Cancelled`], [`crate::Error::OutOfMemory`].
    pub fn zeroed_unless_cancelled(len: usize, monitor: &Monitor) -> Result<Self> {
        const AT_ONCE: usize = 4 << 20;
        let mut words = memory::with_room("a buffer of the frame", len)?;
        while words.len() < len {
            monitor.check()?;
            words.resize_with(len.min(words.len() + AT_ONCE), AtomicU32::default);
        }
        Ok(Words(words))
    }

    /// A buffer with the given contents.
    pub fn from_words(words: &[u32]) -> Self {
        Words(words.iter().map(|&w| AtomicU32::new(w)).collect())
    }

    /// Number of words.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether there are no words.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The word at `at`.
    #[inline]
    pub fn get(&self, at: u32) -> u32 {
        self.0[at as usize].load(Relaxed)
    }

    /// Replaces the word at `at`.
    #[inline]
    pub fn set(&self, at: u32, word: u32) {
        self.0[at as usize].store(word, Relaxed);
    }

    /// Replaces the word at `at` by the lesser of it and `word`.
    #[inline]
    pub fn min(&self, at: u32, word: u32) {
        self.0[at as usize].fetch_min(word, Relaxed);
    }

    /// A copy of a range of words.
    ///
    /// # Errors
    /// [`crate::Error::OutOfMemory`].
    pub fn to_vec(&self, range: std::ops::Range<usize>) -> Result<Vec<u32>> {
        memory::collected("a copy of a buffer", self.0[range].iter().map(|w| w.load(Relaxed)))
    }
}

/// What is kept of a pixel's first hit (paper section 3).
#[derive(Debug, Clone, Copy, PartialEq)]
#[allow(missing_docs)] // documented in kernels/common/attributes.clh
pub struct Attributes {
    pub position: Vec3,
    pub normal: Vec3,
    pub s: f32,
    pub t: f32,
    pub gcol: Vec3,
    pub object: u32,
    pub shadow_bits: u32,
    pub behind: u32,
}

impl Attributes {
    /// What is kept of a pixel whose ray hits nothing.
    pub const MISS: Attributes = Attributes {
        position: Vec3::ZERO,
        normal: Vec3::ZERO,
        s: 0.0,
        t: 0.0,
        gcol: Vec3::ZERO,
        object: NO_OBJECT,
        shadow_bits: 0,
        behind: NO_OBJECT,
    };
}

/// Writes all attributes of the pixel at plane index `at`, and its class with what is above it.
pub fn store_attributes(planes: &Words, pitch: u32, at: u32, a: &Attributes, pixel_class: u32) {
    let put = |plane: u32, value: f32| planes.set(plane * pitch + at, value.to_bits());
    put(PLANE_POSITION_X, a.position.x);
    put(PLANE_POSITION_Y, a.position.y);
    put(PLANE_POSITION_Z, a.position.z);
    put(PLANE_GCOL_R, a.gcol.x);
    put(PLANE_GCOL_G, a.gcol.y);
    put(PLANE_GCOL_B, a.gcol.z);
    planes.set(PLANE_NORMAL * pitch + at, pack_normal(a.normal));
    planes.set(PLANE_TEXCOORD * pitch + at, pack_texcoord(fraction(a.s), fraction(a.t)));
    planes.set(PLANE_OBJECT * pitch + at, a.object);
    planes.set(PLANE_SHADOW * pitch + at, a.shadow_bits);
    planes.set(PLANE_BEHIND * pitch + at, a.behind);
    let repeats = whole_repeats(a.s) << CLASS_REPEATS_S | whole_repeats(a.t) << CLASS_REPEATS_T;
    planes.set(PLANE_CLASS * pitch + at, pixel_class | repeats);
}

/// Reads all attributes of the pixel at plane index `at`.
pub fn load_attributes(planes: &Words, pitch: u32, at: u32) -> Attributes {
    let get = |plane: u32| f32::from_bits(planes.get(plane * pitch + at));
    let texcoord = planes.get(PLANE_TEXCOORD * pitch + at);
    let repeats = planes.get(PLANE_CLASS * pitch + at);
    Attributes {
        position: Vec3::new(get(PLANE_POSITION_X), get(PLANE_POSITION_Y), get(PLANE_POSITION_Z)),
        normal: unpack_normal(planes.get(PLANE_NORMAL * pitch + at)),
        // From -128 on: near 0 a float holds all of a coordinate.
        s: ((repeats << (24 - CLASS_REPEATS_S)) as i32 >> 24) as f32 + unpack_texcoord(texcoord & 0xffff),
        t: ((repeats << (24 - CLASS_REPEATS_T)) as i32 >> 24) as f32 + unpack_texcoord(texcoord >> 16),
        gcol: Vec3::new(get(PLANE_GCOL_R), get(PLANE_GCOL_G), get(PLANE_GCOL_B)),
        object: planes.get(PLANE_OBJECT * pitch + at),
        shadow_bits: planes.get(PLANE_SHADOW * pitch + at),
        behind: planes.get(PLANE_BEHIND * pitch + at),
    }
}

/// Distance of two reflected colours: linear with `STEP_GCOL_LINEAR`, else of the square roots of clamped channels.
pub fn gcol_distance(a: Vec3, b: Vec3, flags: StepFlags) -> f32 {
    let shown = |c: Vec3| {
        if flags.contains(StepFlags::GCOL_LINEAR) {
            return c;
        }
        Vec3::new(clamp(c.x, 0.0, 1.0).sqrt(), clamp(c.y, 0.0, 1.0).sqrt(), clamp(c.z, 0.0, 1.0).sqrt())
    };
    let e = shown(a) - shown(b);
    dot(e, e).sqrt()
}

/// Whether two pixels differ visibly: by `t_visible`, the smallest 8-bit channel difference treated as visible, or more.
pub fn look_different(a: u32, b: u32, t_visible: u32) -> bool {
    [0, 8, 16].iter().any(|shift| ((a >> shift) & 255).abs_diff((b >> shift) & 255) >= t_visible)
}

/// What post-correction compares of a hit.
#[allow(missing_docs)] // members of `Attributes`
pub trait Compared {
    fn object(&self) -> u32;
    fn shadow_bits(&self) -> u32;
    fn normal(&self) -> Vec3;
    fn gcol(&self) -> Vec3;
}

impl Compared for Attributes {
    fn object(&self) -> u32 {
        self.object
    }
    fn shadow_bits(&self) -> u32 {
        self.shadow_bits
    }
    fn normal(&self) -> Vec3 {
        self.normal
    }
    fn gcol(&self) -> Vec3 {
        self.gcol
    }
}

/// The hit of the pixel at plane index `at`, of which is read what is asked for: most pixels differ in the first word, or show
/// the same colour.
#[derive(Debug, Clone, Copy)]
pub struct StoredHit<'a> {
    /// The attributes.
    pub planes: &'a Words,
    /// Words from one plane to the next.
    pub pitch: u32,
    /// Where the pixel lies within a plane.
    pub at: u32,
}

impl StoredHit<'_> {
    fn get(&self, plane: u32) -> u32 {
        self.planes.get(plane * self.pitch + self.at)
    }
}

impl Compared for StoredHit<'_> {
    fn object(&self) -> u32 {
        self.get(PLANE_OBJECT)
    }
    fn shadow_bits(&self) -> u32 {
        self.get(PLANE_SHADOW)
    }
    fn normal(&self) -> Vec3 {
        unpack_normal(self.get(PLANE_NORMAL))
    }
    fn gcol(&self) -> Vec3 {
        Vec3::from([PLANE_GCOL_R, PLANE_GCOL_G, PLANE_GCOL_B].map(|plane| f32::from_bits(self.get(plane))))
    }
}

/// Whether post-correction takes two hits to be of different things.
pub fn hits_differ(
    step: &StepParams,
    a: &impl Compared,
    b: &impl Compared,
    color_a: impl FnOnce() -> u32,
    color_b: impl FnOnce() -> u32,
) -> bool {
    let object = a.object();
    if object != b.object() {
        return true;
    }
    if object == NO_OBJECT || !look_different(color_a(), color_b(), step.t_visible) {
        return false;
    }
    if step.flags.contains(StepFlags::COMPARE_SHADOW) && a.shadow_bits() != b.shadow_bits() {
        return true;
    }
    // Comparisons are written so that NaN differs, as in the kernel.
    step.flags.contains(StepFlags::COMPARE_SHADING)
        && (!(dot(a.normal(), b.normal()) >= step.t_norm)
            || !(gcol_distance(a.gcol(), b.gcol(), step.flags) <= step.t_gcol))
}

/// Of two hits that differ, whether they differ in more than reflected colours.
pub fn surfaces_differ(step: &StepParams, a: &impl Compared, b: &impl Compared) -> bool {
    a.object() != b.object()
        || (step.flags.contains(StepFlags::COMPARE_SHADOW) && a.shadow_bits() != b.shadow_bits())
        || (step.flags.contains(StepFlags::COMPARE_SHADING) && !(dot(a.normal(), b.normal()) >= step.t_norm))
}

/// Writes the work counters of the pixel at plane index `at`, if counters are kept.
pub fn store_work(counters: &Words, pitch: u32, at: u32, work: &Work) {
    if counters.is_empty() {
        return;
    }
    counters.set(COUNTER_TRAVERSAL_STEPS * pitch + at, work.traversal_steps);
    counters.set(COUNTER_TRIANGLE_TESTS * pitch + at, work.triangle_tests);
    counters.set(COUNTER_SHADOW_RAYS * pitch + at, work.shadow_rays);
    counters.set(COUNTER_REFLECTION_RAYS * pitch + at, work.reflection_rays);
    counters.set(COUNTER_REFRACTION_RAYS * pitch + at, work.refraction_rays);
    counters.set(COUNTER_SHADED * pitch + at, work.shaded);
}

/// Direction from the eye through the middle of pixel `(x, y)`; not unit.
pub fn pixel_direction(frame: &FrameParams, x: u32, y: u32) -> Vec3 {
    let sx = (2 * x + 1) as f32 / frame.width as f32 - 1.0;
    let sy = 1.0 - (2 * y + 1) as f32 / frame.height as f32;
    xyz(frame.forward) + xyz(frame.right) * sx + xyz(frame.up) * sy
}
