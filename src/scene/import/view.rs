// SPDX-License-Identifier: MIT OR Apache-2.0
//! `view.json`: how a scene is looked at.
//!
//! Every key may be left out; what then holds is in the last column. RGB is linear; one number means grey.
//!
//! | key | value | if absent |
//! |---|---|---|
//! | `camera.eye`, `camera.look_at` | positions in scene units; must differ | camera fitted to the scene, with a warning |
//! | `camera.up` | direction, not parallel to the line of sight | `[0, 1, 0]` |
//! | `camera.fov_y_degrees` | vertical field of view, above 0 and below 180 | 45 |
//! | `extent` | size of the room in scene units, above 0: what the tolerance `t_pos` is relative to | longest side of the 1st-99th percentile box of the vertices, with a warning |
//! | `lights[].position` | in scene units; at most 32 lights | one light fitted to the scene, with a warning |
//! | `lights[].intensity` | RGB or number, not negative; reflected radiance is `Kd * intensity * cos / distance^2` | 1 |
//! | `suggested_ambient` | RGB or number, not negative: the ambient light | 0.12 |
//! | `background` | RGB or number, not negative: what rays see that hit nothing | black |
//! | `mirror_materials` | names of materials that reflect; no others do | by all keys of the material: `illum` 3 or 5 with a `Ks`, mostly |
//! | `glass_materials` | names of closed glass bodies; if this list or the next exists, no others let light through | by all keys of the material: `d` below 1 with `illum` 6 or 7, mostly |
//! | `thin_glass_materials` | names of panes without thickness; wins over `glass_materials` | by all keys of the material: `d` or `Tr` below 1 |
//! | `alpha_masked_materials` | names of materials with holes where `map_d` (or, without one, the alpha of `map_Kd`) is below one half; materials with `map_d` are cut out in any case | materials whose `map_Kd` has an alpha of all or nothing |
//! | `triangles` | how many triangles the OBJ file makes; a warning if it is another number | not checked |
//! | `name`, `title`, `bounding_box`, `groups`, `materials`, `textures`, `units`, `up_axis`, `license`, `notes` | for people; not used | |
//!
//! Other keys are named in a warning: most are misspelt.

use std::path::Path;

use glam::{DVec3, Vec3};
use serde_json::{Map, Value};

use super::lines::read_text;
use super::source::Source;
use crate::scene::{Camera, Light, MAX_INTENSITY, MAX_LIGHTS, MAX_RADIANCE, MAX_VIEW_COORDINATE, View, check};
use crate::{Error, Result};

/// Largest file that is read: far above any view, and what its numbers become in memory is some 50 times as large.
const MAX_BYTES: u64 = 1 << 20;

/// Keys that are for people.
const FOR_PEOPLE: [&str; 10] =
    ["name", "title", "bounding_box", "groups", "materials", "textures", "units", "up_axis", "license", "notes"];

/// The contents of a `view.json`, checked. `None`: the file does not say.
#[derive(Debug, Default, PartialEq)]
pub(super) struct ViewFile {
    pub camera: Option<Camera>,
    pub lights: Option<Vec<Light>>,
    pub ambient: Option<Vec3>,
    pub background: Option<Vec3>,
    pub extent: Option<f32>,
    pub triangles: Option<u64>,
    pub mirror_materials: Option<Vec<String>>,
    pub glass_materials: Option<Vec<String>>,
    pub thin_glass_materials: Option<Vec<String>>,
    pub alpha_masked_materials: Option<Vec<String>>,
    pub warnings: Vec<String>,
}

/// Reads the view at `path`, with `origin` taken off all positions.
pub(super) fn read(source: &Source, path: &Path, origin: DVec3) -> Result<ViewFile> {
    parse(path, &read_text(source, path, MAX_BYTES)?, origin)
}

/// Reads the text of a view; `path` is named in messages, `origin` is taken off all positions.
pub(super) fn parse(path: &Path, text: &str, origin: DVec3) -> Result<ViewFile> {
    let value: Value = serde_json::from_str(text).map_err(|e| {
        let mut message = format!("not JSON: {e}");
        if text.contains("NaN") || text.contains("Infinity") {
            message += " (numbers must be finite: JSON has no NaN or Infinity)";
        }
        Error::Syntax { path: path.to_path_buf(), line: e.line().max(1), message }
    })?;
    let place = path.display().to_string();
    let Value::Object(top) = value else {
        return Err(Error::scene(place, format!("an object {{...}} is needed, this is {}", kind(&value))));
    };
    let mut view = ViewFile::default();
    for (key, value) in &top {
        let at = At { file: &place, key: key.clone() };
        match key.as_str() {
            "camera" => view.camera = camera(&at, value, origin, &mut view.warnings)?,
            "lights" => view.lights = Some(lights(&at, value, origin, &mut view.warnings)?),
            "suggested_ambient" => view.ambient = Some(colour(&at, value, MAX_RADIANCE)?),
            "background" => view.background = Some(colour(&at, value, MAX_RADIANCE)?),
            "extent" => {
                let extent = number(&at, value)?;
                check::extent(extent).map_err(|message| at.error(message))?;
                view.extent = Some(extent);
            }
            "triangles" => match value.as_u64() {
                Some(count) => view.triangles = Some(count),
                None => return Err(at.error(format!("a count is needed, this is {}", kind(value)))),
            },
            "mirror_materials" => view.mirror_materials = Some(names(&at, value)?),
            "glass_materials" => view.glass_materials = Some(names(&at, value)?),
            "thin_glass_materials" => view.thin_glass_materials = Some(names(&at, value)?),
            "alpha_masked_materials" => view.alpha_masked_materials = Some(names(&at, value)?),
            _ if FOR_PEOPLE.contains(&key.as_str()) => {}
            _ => view.warnings.push(at.unknown()),
        }
    }
    Ok(view)
}

/// The complete view in `text`, for scenes that are part of the library; `place` is named in messages. Also what is odd
/// about it.
///
/// # Errors
/// As for a `view.json` that is read from a file; and if camera, lights or extent are missing.
pub(crate) fn complete(place: &str, text: &str) -> Result<(View, Vec<String>)> {
    let file = parse(Path::new(place), text, DVec3::ZERO)?;
    let base = View::default();
    let lacks = |key: &str| Error::scene(place, format!("`{key}` is missing"));
    let view = View {
        camera: file.camera.ok_or_else(|| lacks("camera"))?,
        lights: file.lights.ok_or_else(|| lacks("lights"))?,
        ambient: file.ambient.unwrap_or(base.ambient),
        background: file.background.unwrap_or(base.background),
        extent: file.extent.ok_or_else(|| lacks("extent"))?,
    };
    Ok((view, file.warnings))
}

/// Where in the file a value is.
struct At<'a> {
    file: &'a str,
    key: String,
}

impl At<'_> {
    fn error(&self, message: impl Into<String>) -> Error {
        Error::scene(format!("{}: {}", self.file, self.key), message)
    }

    fn member(&self, key: &str) -> Self {
        At { file: self.file, key: format!("{}.{key}", self.key) }
    }

    fn item(&self, index: usize) -> Self {
        At { file: self.file, key: format!("{}[{index}]", self.key) }
    }

    fn unknown(&self) -> String {
        format!("{}: unknown key `{}` is not used", self.file, self.key)
    }
}

fn kind(value: &Value) -> &'static str {
    match value {
        Value::Null => "null",
        Value::Bool(_) => "true or false",
        Value::Number(_) => "a number",
        Value::String(_) => "a string",
        Value::Array(_) => "a list",
        Value::Object(_) => "an object",
    }
}

fn object<'a>(at: &At, value: &'a Value) -> Result<&'a Map<String, Value>> {
    value.as_object().ok_or_else(|| at.error(format!("an object {{...}} is needed, this is {}", kind(value))))
}

fn list<'a>(at: &At, value: &'a Value) -> Result<&'a Vec<Value>> {
    value.as_array().ok_or_else(|| at.error(format!("a list [...] is needed, this is {}", kind(value))))
}

/// A finite number in single precision.
fn number(at: &At, value: &Value) -> Result<f32> {
    number_from(at, value, 0.0)
}

/// A finite number in single precision, counted from `origin`.
fn number_from(at: &At, value: &Value, origin: f64) -> Result<f32> {
    let wide = value.as_f64().ok_or_else(|| at.error(format!("a number is needed, this is {}", kind(value))))?;
    let single = (wide - origin) as f32;
    if single.is_finite() { Ok(single) } else { Err(at.error(format!("{wide} is too large for single precision"))) }
}

/// A position, counted from `origin`.
fn position(at: &At, value: &Value, origin: DVec3) -> Result<Vec3> {
    three(at, value, MAX_VIEW_COORDINATE, origin)
}

/// Three numbers, counted from `origin`, of at most `limit` in size.
fn three(at: &At, value: &Value, limit: f32, origin: DVec3) -> Result<Vec3> {
    let values = list(at, value)?;
    if values.len() != 3 {
        return Err(at.error(format!("three numbers are needed, this list has {}", values.len())));
    }
    let mut v = [0.0; 3];
    for (i, value) in values.iter().enumerate() {
        v[i] = number_from(&at.item(i), value, origin[i])?;
        if v[i].abs() > limit {
            return Err(at.item(i).error(format!("{} is out of range (at most {limit:e})", v[i])));
        }
    }
    Ok(Vec3::from(v))
}

/// RGB or grey, not negative, at most `limit`.
fn colour(at: &At, value: &Value, limit: f32) -> Result<Vec3> {
    let rgb = if value.is_number() { Vec3::splat(number(at, value)?) } else { three(at, value, limit, DVec3::ZERO)? };
    check::radiance(rgb, limit).map_err(|message| at.error(message))?;
    Ok(rgb)
}

fn names(at: &At, value: &Value) -> Result<Vec<String>> {
    let mut names = Vec::new();
    for (i, value) in list(at, value)?.iter().enumerate() {
        match value {
            Value::String(name) => names.push(name.trim().to_string()),
            _ => return Err(at.item(i).error(format!("a material's name is needed, this is {}", kind(value)))),
        }
    }
    Ok(names)
}

/// The camera; `None` (and a warning) if it says neither where it is nor where it looks.
fn camera(at: &At, value: &Value, origin: DVec3, warnings: &mut Vec<String>) -> Result<Option<Camera>> {
    let members = object(at, value)?;
    let (mut eye, mut look_at) = (None, None);
    let mut camera = Camera::default();
    for (key, value) in members {
        let at = at.member(key);
        match key.as_str() {
            "eye" => eye = Some(position(&at, value, origin)?),
            "look_at" => look_at = Some(position(&at, value, origin)?),
            "up" => camera.up = three(&at, value, MAX_VIEW_COORDINATE, DVec3::ZERO)?,
            "fov_y_degrees" => {
                let degrees = number(&at, value)?;
                check::field_of_view(degrees).map_err(|message| at.error(message))?;
                camera.fov_y_degrees = degrees;
            }
            _ => warnings.push(at.unknown()),
        }
    }
    let (Some(eye), Some(look_at)) = (eye, look_at) else {
        if eye.is_none() && look_at.is_none() {
            return Ok(None);
        }
        let absent = if eye.is_none() { "eye" } else { "look_at" };
        return Err(at.member(absent).error("is missing; a camera needs both `eye` and `look_at`"));
    };
    (camera.eye, camera.look_at) = (eye, look_at);
    check::camera(&camera).map_err(|(key, message)| at.member(key).error(message))?;
    Ok(Some(camera))
}

fn lights(at: &At, value: &Value, origin: DVec3, warnings: &mut Vec<String>) -> Result<Vec<Light>> {
    let items = list(at, value)?;
    if items.len() > MAX_LIGHTS {
        return Err(at.error(format!("{} lights; at most {MAX_LIGHTS} are drawn, join or remove some", items.len())));
    }
    let mut lights = Vec::with_capacity(items.len());
    for (i, value) in items.iter().enumerate() {
        let at = at.item(i);
        let mut place = None;
        let mut intensity = Vec3::ONE;
        for (key, value) in object(&at, value)? {
            let at = at.member(key);
            match key.as_str() {
                "position" => place = Some(position(&at, value, origin)?),
                "intensity" => intensity = colour(&at, value, MAX_INTENSITY)?,
                _ => warnings.push(at.unknown()),
            }
        }
        let Some(position) = place else { return Err(at.member("position").error("is missing")) };
        lights.push(Light { position, intensity });
    }
    Ok(lights)
}
