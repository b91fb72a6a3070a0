// SPDX-License-Identifier: MIT OR Apache-2.0
//! Layers: pictures of what a frame knew and did, pixel by pixel.

use glam::Vec3;

use crate::error::{Error, Result, Setting};
use crate::layout::*;
use crate::math::unpack_normal;
use crate::method::counts::Keep;
use crate::method::options::Test;
use crate::names::find;
use crate::render::frame::Frame;
use crate::render::renderer::Renderer;
use crate::settings::list;

/// A picture of one quantity of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Layer {
    /// The picture itself.
    Color,
    /// Base (grey), traced (orange), interpolated (dark blue), corrected (red), confirmed (yellow).
    Class,
    /// Each failed test in its own colour, added up.
    FailMask,
    /// White where one test failed.
    FailedTest(Test),
    /// A colour per object.
    Object,
    /// Shading normal: red, green, blue for x, y, z from -1 to 1.
    Normal,
    /// Distance from the eye: near is bright.
    Depth,
    /// Share of lights that do not reach the point: white is fully lit.
    Shadow,
    /// Traversal steps and triangle tests: blue, green, yellow, red for more.
    Rays,
}

impl Layer {
    /// Every layer's name.
    pub const NAMES: [&str; 15] = [
        "color",
        "class",
        "fail-mask",
        "test-g1",
        "test-g2",
        "test-g3",
        "test-g4",
        "test-tx",
        "test-sh",
        "test-gc",
        "object",
        "normal",
        "depth",
        "shadow",
        "rays",
    ];

    /// Every layer, in the order of [`Layer::NAMES`].
    pub const ALL: [Layer; 15] = [
        Layer::Color,
        Layer::Class,
        Layer::FailMask,
        Layer::FailedTest(Test::G1),
        Layer::FailedTest(Test::G2),
        Layer::FailedTest(Test::G3),
        Layer::FailedTest(Test::G4),
        Layer::FailedTest(Test::Tx),
        Layer::FailedTest(Test::Sh),
        Layer::FailedTest(Test::Gc),
        Layer::Object,
        Layer::Normal,
        Layer::Depth,
        Layer::Shadow,
        Layer::Rays,
    ];

    /// What a frame must keep for this layer.
    pub fn needs(self) -> Keep {
        match self {
            Layer::Color => Keep::default(),
            Layer::Class | Layer::FailMask | Layer::FailedTest(_) => Keep::planes(&[PLANE_CLASS]),
            Layer::Object => Keep::planes(&[PLANE_OBJECT]),
            Layer::Normal => Keep::planes(&[PLANE_OBJECT, PLANE_NORMAL]),
            Layer::Depth => Keep::planes(&[PLANE_OBJECT, PLANE_POSITION_X, PLANE_POSITION_Y, PLANE_POSITION_Z]),
            Layer::Shadow => Keep::planes(&[PLANE_OBJECT, PLANE_SHADOW]),
            Layer::Rays => Keep::counter_planes(&[COUNTER_TRAVERSAL_STEPS, COUNTER_TRIANGLE_TESTS]),
        }
    }

    /// Whether this is a picture of the method's decisions, which full tracing does not take.
    pub fn is_adaptive_only(self) -> bool {
        matches!(self, Layer::Class | Layer::FailMask | Layer::FailedTest(_))
    }
}

/// Colours of the tests in the fail mask: G1 red, G2 orange, G3 green, G4 cyan, TX magenta, SH blue, GC yellow.
const TEST_COLORS: [[u32; 3]; 7] =
    [[255, 40, 40], [255, 140, 0], [0, 200, 0], [0, 200, 200], [230, 0, 230], [70, 110, 255], [240, 240, 0]];

fn word(r: u32, g: u32, b: u32) -> u32 {
    r.min(255) | g.min(255) << 8 | b.min(255) << 16 | 0xff00_0000
}

fn unit_byte(v: f32) -> u32 {
    (v.clamp(0.0, 1.0) * 255.0 + 0.5) as u32
}

/// Draws `layer` of the frame that `renderer` drew last: a pixel for each sample, but for [`Layer::Color`].
///
/// # Errors
/// [`Error::MissingPlane`] if the frame kept too little for this layer; a failing read.
pub fn draw(layer: Layer, renderer: &mut Renderer, frame: &Frame) -> Result<Vec<u32>> {
    match layer {
        Layer::Color => Ok(frame.pixels.clone()),
        Layer::Class => Ok(class_picture(&renderer.plane(PLANE_CLASS)?)),
        Layer::FailMask => Ok(fail_mask_picture(&renderer.plane(PLANE_CLASS)?)),
        Layer::FailedTest(test) => Ok(failed_test_picture(&renderer.plane(PLANE_CLASS)?, test)),
        Layer::Object => Ok(renderer.plane(PLANE_OBJECT)?.into_iter().map(object_color).collect()),
        Layer::Normal => normal(renderer),
        Layer::Depth => depth(renderer),
        Layer::Shadow => shadow(renderer),
        Layer::Rays => rays(renderer),
    }
}

/// [`Layer::Class`] of a class plane.
pub fn class_picture(classes: &[u32]) -> Vec<u32> {
    classes.iter().copied().map(class_color).collect()
}

/// [`Layer::FailedTest`] of a class plane.
pub fn failed_test_picture(classes: &[u32], test: Test) -> Vec<u32> {
    let lit = |c: &u32| if c & test.fail_bit() != 0 { word(255, 255, 255) } else { word(0, 0, 0) };
    classes.iter().map(lit).collect()
}

/// [`Layer::FailMask`] of a class plane.
pub fn fail_mask_picture(classes: &[u32]) -> Vec<u32> {
    classes.iter().copied().map(fail_mask_color).collect()
}

fn class_color(word_of_class: u32) -> u32 {
    match word_of_class & CLASS_MASK {
        CLASS_BASE => word(110, 110, 110),
        CLASS_TRACED => word(255, 150, 30),
        CLASS_INTERPOLATED => word(20, 30, 70),
        CLASS_CORRECTED => word(255, 30, 30),
        CLASS_CONFIRMED => word(250, 240, 60),
        _ => word(255, 0, 255),
    }
}

fn fail_mask_color(word_of_class: u32) -> u32 {
    let mut sum = [0; 3];
    for (test, color) in Test::ALL.into_iter().zip(TEST_COLORS) {
        if word_of_class & test.fail_bit() != 0 {
            for (s, c) in sum.iter_mut().zip(color) {
                *s += c;
            }
        }
    }
    word(sum[0], sum[1], sum[2])
}

fn object_color(object: u32) -> u32 {
    if object == NO_OBJECT {
        return word(0, 0, 0);
    }
    // An integer hash spreads neighbouring ids over the colours.
    let mut h = object.wrapping_add(1).wrapping_mul(0x9e37_79b9);
    h = (h ^ (h >> 15)).wrapping_mul(0x85eb_ca6b);
    h ^= h >> 13;
    word(64 + (h & 0xbf), 64 + ((h >> 8) & 0xbf), 64 + ((h >> 16) & 0xbf))
}

fn positions(renderer: &mut Renderer) -> Result<Vec<Vec3>> {
    let [x, y, z] = [PLANE_POSITION_X, PLANE_POSITION_Y, PLANE_POSITION_Z].map(|plane| renderer.plane(plane));
    let float = f32::from_bits;
    let vectors = x?.into_iter().zip(y?).zip(z?).map(|((x, y), z)| Vec3::new(float(x), float(y), float(z)));
    Ok(vectors.collect())
}

fn normal(renderer: &mut Renderer) -> Result<Vec<u32>> {
    let objects = renderer.plane(PLANE_OBJECT)?;
    let normals = renderer.plane(PLANE_NORMAL)?.into_iter().map(unpack_normal);
    let color = |(object, n): (u32, Vec3)| match object {
        NO_OBJECT => word(0, 0, 0),
        _ => word(unit_byte(n.x * 0.5 + 0.5), unit_byte(n.y * 0.5 + 0.5), unit_byte(n.z * 0.5 + 0.5)),
    };
    Ok(objects.into_iter().zip(normals).map(color).collect())
}

fn depth(renderer: &mut Renderer) -> Result<Vec<u32>> {
    let objects = renderer.plane(PLANE_OBJECT)?;
    let positions = positions(renderer)?;
    let (eye, extent) = (renderer.view().camera.eye, renderer.view().extent);
    let color = |(object, p): (u32, Vec3)| {
        // Half as bright at a distance of half the extent: works without knowing the farthest hit.
        let v = if object == NO_OBJECT { 0.0 } else { 1.0 / (1.0 + 2.0 * (p - eye).length() / extent) };
        word(unit_byte(v), unit_byte(v), unit_byte(v))
    };
    Ok(objects.into_iter().zip(positions).map(color).collect())
}

fn shadow(renderer: &mut Renderer) -> Result<Vec<u32>> {
    let objects = renderer.plane(PLANE_OBJECT)?;
    let bits = renderer.plane(PLANE_SHADOW)?;
    let lights = renderer.view().lights.len().max(1) as f32;
    let color = |(object, bits): (u32, u32)| {
        let lit = if object == NO_OBJECT { 0.0 } else { 1.0 - bits.count_ones() as f32 / lights };
        word(unit_byte(lit), unit_byte(lit), unit_byte(lit))
    };
    Ok(objects.into_iter().zip(bits).map(color).collect())
}

fn rays(renderer: &mut Renderer) -> Result<Vec<u32>> {
    let steps = renderer.counter_plane(COUNTER_TRAVERSAL_STEPS)?;
    let tests = renderer.counter_plane(COUNTER_TRIANGLE_TESTS)?;
    let cost: Vec<u32> = steps.into_iter().zip(tests).map(|(s, t)| s + t).collect();
    // The scale ends at the 99th percentile of the pixels that cost anything.
    let mut sorted: Vec<u32> = cost.iter().copied().filter(|&c| c > 0).collect();
    sorted.sort_unstable();
    let top = sorted.get(sorted.len() * 99 / 100).copied().unwrap_or(1).max(1) as f32;
    Ok(cost.into_iter().map(|c| if c == 0 { word(0, 0, 0) } else { heat(c as f32 / top) }).collect())
}

/// Blue, green, yellow, red for 0 to 1.
fn heat(share: f32) -> u32 {
    let v = share.clamp(0.0, 1.0) * 3.0;
    match v as u32 {
        0 => word(0, unit_byte(v), unit_byte(1.0 - v * 0.7)),
        1 => word(unit_byte(v - 1.0), 255, unit_byte((2.0 - v) * 0.3)),
        _ => word(255, unit_byte(3.0 - v), 0),
    }
}

impl std::fmt::Display for Layer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let at = Layer::ALL.iter().position(|layer| layer == self);
        f.pad(at.map_or("", |at| Layer::NAMES[at]))
    }
}

impl std::str::FromStr for Layer {
    type Err = Error;

    fn from_str(name: &str) -> Result<Layer> {
        let at = find(&Layer::NAMES, name);
        at.map(|at| Layer::ALL[at]).ok_or_else(|| Error::option(Setting::Layer, name, list(&Layer::NAMES)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_is_a_layer() {
        for (name, layer) in Layer::NAMES.into_iter().zip(Layer::ALL) {
            assert_eq!(name.parse::<Layer>().unwrap(), layer);
            assert_eq!(layer.to_string(), name);
        }
        for test in Test::ALL {
            assert_eq!(Layer::FailedTest(test).to_string(), format!("test-{test}"));
        }
        assert!("test-xy".parse::<Layer>().unwrap_err().to_string().contains("fail-mask"));
    }
}
