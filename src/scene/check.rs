// SPDX-License-Identifier: MIT OR Apache-2.0
//! The rules that every scene and view keeps: sizes, indices, ranges. Each is checked once, here, so that kernels and
//! their twins can trust what they read.

use glam::{Vec2, Vec3};

use super::{Camera, MAX_LIGHTS, Material, SceneParts, Texture, View};
use crate::math::{cross, dot};
use crate::{Error, Result};

/// Largest coordinate of a vertex, in scene units: squares of areas of such triangles are still finite in single
/// precision.
pub const MAX_COORDINATE: f32 = 1.0e9;

/// Largest coordinate of a camera or light, and largest extent: room for looking at any scene from outside.
pub const MAX_VIEW_COORDINATE: f32 = 16.0 * MAX_COORDINATE;

/// Largest texture coordinate.
pub const MAX_TEXCOORD: f32 = 1.0e16;

/// Brightest light, in squared scene units: times a reflectance and over a squared distance it is still finite.
pub const MAX_INTENSITY: f32 = 1.0e30;

/// Brightest ambient light and background.
pub const MAX_RADIANCE: f32 = 1.0e9;

/// Most texels along a side of a texture.
pub const MAX_TEXTURE_SIDE: u32 = 16384;

/// Highest Blinn-Phong exponent.
pub const MAX_SHININESS: f32 = 1.0e6;

/// Highest index of refraction.
pub const MAX_INDEX_OF_REFRACTION: f32 = 100.0;

/// Most triangles and most vertices of a scene: three corners each are counted in 32 bits.
pub const MAX_TRIANGLES: usize = (u32::MAX / 4) as usize;

/// What is wrong, and where in the scene.
type Wrong = (String, String);

/// Checks a whole scene.
pub(super) fn scene(parts: &SceneParts) -> Result<()> {
    check_parts(parts).map_err(|wrong| error(&parts.name, wrong))?;
    check_view(&parts.view).map_err(|(place, message)| error(&parts.name, (format!("view.{place}"), message)))
}

/// Checks a view.
pub(super) fn view(view: &View) -> Result<()> {
    check_view(view).map_err(|wrong| error("view", wrong))
}

fn error(name: &str, (place, message): Wrong) -> Error {
    Error::scene(if name.is_empty() { place } else { format!("{name}: {place}") }, message)
}

fn wrong<T>(place: impl Into<String>, message: impl Into<String>) -> std::result::Result<T, Wrong> {
    Err((place.into(), message.into()))
}

fn check_parts(s: &SceneParts) -> std::result::Result<(), Wrong> {
    if !s.origin.is_finite() {
        return wrong("origin", format!("{} is not finite", s.origin));
    }
    let count = s.triangles.len();
    if count == 0 {
        return wrong("triangles", "there are none; nothing to draw");
    }
    for (what, number) in [("triangles", count), ("positions", s.positions.len())] {
        if number > MAX_TRIANGLES {
            return wrong(what, format!("{number} are too many; at most {MAX_TRIANGLES} can be drawn"));
        }
    }
    for (what, length) in [
        ("corner_normals", s.corner_normals.len()),
        ("corner_texcoords", s.corner_texcoords.len()),
        ("triangle_objects", s.triangle_objects.len()),
    ] {
        if length != count {
            return wrong(what, format!("{length} entries for {count} triangles"));
        }
    }
    if let Some((i, p)) = first(&s.positions, |p: &Vec3| !within(*p, MAX_COORDINATE)) {
        return wrong(format!("positions[{i}]"), format!("{p} is not finite or beyond {MAX_COORDINATE:e}"));
    }
    let vertices = s.positions.len();
    if let Some((i, t)) = first(&s.triangles, |t: &[u32; 3]| t.iter().any(|&v| v as usize >= vertices)) {
        return wrong(format!("triangles[{i}]"), format!("{t:?} names a vertex that is not one of the {vertices}"));
    }
    let texcoord = |t: &[Vec2; 3]| t.iter().all(|t| t.abs().max_element() <= MAX_TEXCOORD && t.is_finite());
    if let Some((i, t)) = first(&s.corner_texcoords, |t| !texcoord(t)) {
        return wrong(format!("corner_texcoords[{i}]"), format!("{t:?} is not finite or beyond {MAX_TEXCOORD:e}"));
    }
    let objects = s.objects.len();
    if let Some((i, o)) = first(&s.triangle_objects, |&o: &u32| o as usize >= objects) {
        return wrong(format!("triangle_objects[{i}]"), format!("there is no object {o}; the scene has {objects}"));
    }
    let materials = s.materials.len();
    if let Some((i, o)) = first(&s.objects, |o| o.material as usize >= materials) {
        let message = format!("object `{}` has material {}; the scene has {materials}", o.name, o.material);
        return wrong(format!("objects[{i}]"), message);
    }
    for (i, m) in s.materials.iter().enumerate() {
        check_material(m, s.textures.len())
            .map_err(|(key, message)| (format!("materials[{i}] `{}`.{key}", m.name), message))?;
    }
    for (i, t) in s.textures.iter().enumerate() {
        check_texture(t).map_err(|message| (format!("textures[{i}] `{}`", t.name), message))?;
    }
    let area = |t: &[u32; 3]| has_area(t.map(|v| s.positions[v as usize]));
    if !s.triangles.iter().any(area) {
        return wrong("triangles", format!("all {count} are degenerate (no area); nothing to draw"));
    }
    Ok(())
}

/// The first value that `is_wrong`, with its place.
fn first<T>(values: &[T], is_wrong: impl Fn(&T) -> bool) -> Option<(usize, &T)> {
    values.iter().enumerate().find(|(_, value)| is_wrong(value))
}

/// Whether all components are numbers of at most `limit` in size.
fn within(v: Vec3, limit: f32) -> bool {
    v.x.abs() <= limit && v.y.abs() <= limit && v.z.abs() <= limit
}

/// Whether the intersection test can divide by the triangle's squared normal.
pub(crate) fn has_area([a, b, c]: [Vec3; 3]) -> bool {
    let normal = cross(b - a, c - a);
    dot(normal, normal) >= f32::MIN_POSITIVE
}

/// What is wrong with a material: field and message.
fn check_material(m: &Material, textures: usize) -> std::result::Result<(), Wrong> {
    for (key, v) in
        [("diffuse", m.diffuse), ("specular", m.specular), ("transmission", m.transmission), ("emission", m.emission)]
    {
        if !(v.is_finite() && v.min_element() >= 0.0 && v.max_element() <= MAX_RADIANCE) {
            return wrong(key, format!("{v} is out of range (0 to {MAX_RADIANCE:e})"));
        }
    }
    if !(0.0..=MAX_SHININESS).contains(&m.shininess) {
        return wrong("shininess", format!("{} is out of range (0 to {MAX_SHININESS:e})", m.shininess));
    }
    if !(1.0..=MAX_INDEX_OF_REFRACTION).contains(&m.index_of_refraction) {
        let message = format!("{} is out of range (1 to {MAX_INDEX_OF_REFRACTION})", m.index_of_refraction);
        return wrong("index_of_refraction", message);
    }
    if !(0.0..=1.0).contains(&m.opacity) {
        return wrong("opacity", format!("{} is out of range (0 to 1)", m.opacity));
    }
    for (key, texture) in [("diffuse_texture", m.diffuse_texture), ("cutout_texture", m.cutout_texture)] {
        if let Some(t) = texture.filter(|&t| t as usize >= textures) {
            return wrong(key, format!("there is no texture {t}; the scene has {textures}"));
        }
    }
    Ok(())
}

fn check_texture(t: &Texture) -> std::result::Result<(), String> {
    let (width, height) = (t.width, t.height);
    if width == 0 || height == 0 || width > MAX_TEXTURE_SIDE || height > MAX_TEXTURE_SIDE {
        return Err(format!("{width}x{height} texels; sides are 1 to {MAX_TEXTURE_SIDE}"));
    }
    if t.texels.len() as u64 != u64::from(width) * u64::from(height) {
        return Err(format!("{} texels for a texture of {width}x{height}", t.texels.len()));
    }
    Ok(())
}

fn check_view(view: &View) -> std::result::Result<(), Wrong> {
    camera(&view.camera).map_err(|(key, message)| (format!("camera.{key}"), message))?;
    let count = view.lights.len();
    if count > MAX_LIGHTS {
        return wrong("lights", format!("{count} lights; at most {MAX_LIGHTS} are drawn, join or remove some"));
    }
    for (i, light) in view.lights.iter().enumerate() {
        if !within(light.position, MAX_VIEW_COORDINATE) {
            let message = format!("{} is not finite or beyond {MAX_VIEW_COORDINATE:e}", light.position);
            return wrong(format!("lights[{i}].position"), message);
        }
        radiance(light.intensity, MAX_INTENSITY).map_err(|message| (format!("lights[{i}].intensity"), message))?;
    }
    radiance(view.ambient, MAX_RADIANCE).map_err(|message| ("ambient".into(), message))?;
    radiance(view.background, MAX_RADIANCE).map_err(|message| ("background".into(), message))?;
    extent(view.extent).map_err(|message| ("extent".into(), message))
}

/// Checks a colour of light: finite, not negative, at most `limit`.
pub(super) fn radiance(rgb: Vec3, limit: f32) -> std::result::Result<(), String> {
    let fine = |v: f32| (0.0..=limit).contains(&v);
    if fine(rgb.x) && fine(rgb.y) && fine(rgb.z) {
        return Ok(());
    }
    Err(format!("{rgb} is out of range (0 to {limit:e})"))
}

/// Checks the size of the room.
pub(super) fn extent(extent: f32) -> std::result::Result<(), String> {
    if (f32::MIN_POSITIVE..=MAX_VIEW_COORDINATE).contains(&extent) {
        return Ok(());
    }
    Err(format!("{extent} is out of range (above 0, at most {MAX_VIEW_COORDINATE:e})"))
}

/// Checks the vertical field of view.
pub(super) fn field_of_view(degrees: f32) -> std::result::Result<(), String> {
    if degrees > 0.0 && degrees < 180.0 {
        return Ok(());
    }
    Err(format!("{degrees} is out of range (above 0 and below 180 degrees)"))
}

/// Checks that the camera's axes exist, in single precision as kernels compute them. On failure: the key, and why.
pub(super) fn camera(camera: &Camera) -> std::result::Result<(), (&'static str, String)> {
    for (key, v) in [("eye", camera.eye), ("look_at", camera.look_at), ("up", camera.up)] {
        if !within(v, MAX_VIEW_COORDINATE) {
            return Err((key, format!("{v} is not finite or beyond {MAX_VIEW_COORDINATE:e}")));
        }
    }
    field_of_view(camera.fov_y_degrees).map_err(|message| ("fov_y_degrees", message))?;
    let direction = camera.look_at - camera.eye;
    let scale = direction.abs().max_element();
    if direction.length_squared() < f32::MIN_POSITIVE {
        return Err(("look_at", format!("is the same point as `eye` {}: no direction to look in", camera.eye)));
    }
    let up_scale = camera.up.abs().max_element();
    if camera.up.length_squared() < f32::MIN_POSITIVE {
        return Err(("up", format!("{} has no length", camera.up)));
    }
    let sine = (direction / scale).normalize().cross((camera.up / up_scale).normalize()).length();
    if sine < 1.0e-4 {
        return Err(("up", format!("{} is parallel to the line of sight {direction}", camera.up)));
    }
    Ok(())
}
