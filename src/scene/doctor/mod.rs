// SPDX-License-Identifier: MIT OR Apache-2.0
//! What is odd about a scene: things that draw, but perhaps not as meant.
//!
//! The doctor reads a finished [`Scene`], so it serves built-in scenes as well as loaded ones.

mod told;

use std::borrow::Cow;

use crate::error::printable;
use crate::math::{cross, dot, unpack_normal};
use crate::scene::coplanar::{self, Kind};
use crate::scene::import::fit::Extents;
use crate::scene::{Material, Scene};

pub use told::notices;

/// How much a finding matters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Good to know; the picture is right.
    Note,
    /// The picture may not be what was meant.
    Warning,
}

/// One thing that is odd about a scene.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finding {
    /// How much it matters.
    pub severity: Severity,
    /// What it is about, in one or two words that do not change: `normals`, `texture coordinates`, `triangles`,
    /// `overlaps`, `extent`, `origin`, `names`, `winding`, `materials`, `keys`, `lights`, or `loading` for what was mended or left out then (missing
    /// textures and materials, degenerate triangles).
    pub topic: &'static str,
    /// One sentence with the numbers, and the remedy where there is one.
    pub message: String,
}

/// A triangle is huge if its longest side exceeds this many extents.
const HUGE_EXTENTS: f32 = 2.0;

/// A triangle is a needle if its longest side is more than this many times its height.
const NEEDLE_RATIO: f32 = 1.0e4;

/// Outliers dominate if the box of all vertices is this many times as long as that of the middle 98 %. (Rooms reach 2:
/// their walls have few vertices.)
const OUTLIER_RATIO: f32 = 3.0;

/// Everything odd about `scene`, warnings first.
pub fn examine(scene: &Scene) -> Vec<Finding> {
    let mut findings = Vec::new();
    let mut tell = |severity, topic, message: String| findings.push(Finding { severity, topic, message });
    for warning in scene.warnings() {
        tell(Severity::Warning, "loading", warning.clone());
    }
    origin(scene, &mut tell);
    attributes(scene, &mut tell);
    materials(scene, &mut tell);
    triangles(scene, &mut tell);
    extent(scene, &mut tell);
    winding(scene, &mut tell);
    overlaps(scene, &mut tell);
    told::examine(scene.notes(), &mut tell);
    for finding in &mut findings {
        if let Cow::Owned(escaped) = printable(&finding.message) {
            finding.message = escaped;
        }
    }
    findings.sort_by_key(|f| std::cmp::Reverse(f.severity));
    findings
}

pub(super) type Tell<'a> = &'a mut dyn FnMut(Severity, &'static str, String);

fn percent(part: usize, whole: usize) -> String {
    format!("{part} of {whole} ({:.1} %)", 100.0 * part as f64 / whole.max(1) as f64)
}

/// The first names of a list.
fn some_of<S: AsRef<str>>(names: &[S]) -> String {
    let shown: Vec<String> = names.iter().take(5).map(|n| format!("`{}`", n.as_ref())).collect();
    let more =
        if names.len() > shown.len() { format!(" and {} more", names.len() - shown.len()) } else { String::new() };
    shown.join(", ") + &more
}

fn origin(scene: &Scene, tell: Tell) {
    let origin = scene.origin();
    if origin != glam::DVec3::ZERO {
        let message = format!(
            "the scene lies far from the origin: {origin} was taken off all positions, camera and lights included, before \
             they were rounded to single precision; positions given to the library count from there"
        );
        tell(Severity::Note, "origin", message);
    }
}

fn attributes(scene: &Scene, tell: Tell) {
    let notes = scene.notes();
    let total = scene.triangles().len();
    if notes.triangles_without_normals > 0 {
        let share = percent(notes.triangles_without_normals, total);
        let crease = crate::scene::import::normals::CREASE_DEGREES;
        let mut message =
            format!("{share} triangles have no normals; computed with a crease angle of {crease} degrees");
        if notes.triangles_smoothed_by_groups > 0 {
            message += &format!(", {} of them by smoothing groups instead", notes.triangles_smoothed_by_groups);
        }
        tell(Severity::Note, "normals", message);
    }
    if notes.triangles_without_texcoords > 0 {
        let count = notes.triangles_without_texcoords;
        let message =
            format!("{count} triangles in textured materials have no texture coordinates; one texel colours them");
        tell(Severity::Warning, "texture coordinates", message);
    }
    if !notes.duplicate_names.is_empty() {
        let names = some_of(&notes.duplicate_names);
        let count = notes.duplicate_names.len();
        let message = format!("{count} object names occur more than once and count as one object each: {names}");
        tell(Severity::Note, "names", message);
    }
}

fn materials(scene: &Scene, tell: Tell) {
    let mut names: Vec<&str> = scene.materials().iter().map(|m| m.name.as_str()).collect();
    names.sort_unstable();
    let mut twice: Vec<&str> = names.windows(2).filter(|w| w[0] == w[1]).map(|w| w[0]).collect();
    twice.dedup();
    if !twice.is_empty() {
        tell(Severity::Warning, "names", format!("{} material names occur twice: {}", twice.len(), some_of(&twice)));
    }
    let invisible = |m: &&Material| m.diffuse_texture.is_some() && m.diffuse.max_element() <= 0.0;
    let black: Vec<&str> = scene.materials().iter().filter(invisible).map(|m| m.name.as_str()).collect();
    if !black.is_empty() {
        let names = some_of(&black);
        tell(Severity::Warning, "materials", format!("Kd is 0 and blackens the texture of {names}; set Kd to 1 1 1"));
    }
    if scene.view().lights.iter().all(|l| l.intensity.max_element() <= 0.0) {
        tell(Severity::Warning, "lights", "no light shines; only ambient light is seen".into());
    }
}

/// Needles and giants. (What has no area was left out while loading, with a warning.)
fn triangles(scene: &Scene, tell: Tell) {
    let (mut needles, mut giants) = (0, Vec::new());
    for (triangle, &object) in scene.triangles().iter().zip(scene.triangle_objects()) {
        let [a, b, c] = triangle.map(|v| scene.positions()[v as usize]);
        let (e, f, g) = (b - a, c - b, a - c);
        let longest2 = dot(e, e).max(dot(f, f)).max(dot(g, g));
        let n = cross(e, -g);
        // area * 2 = longest * height
        if longest2 > NEEDLE_RATIO * dot(n, n).sqrt() {
            needles += 1;
        }
        if longest2.sqrt() > HUGE_EXTENTS * scene.view().extent {
            giants.push(object);
        }
    }
    if needles > 0 {
        let share = percent(needles, scene.triangles().len());
        let message = format!("{share} triangles are needles, more than {NEEDLE_RATIO} times as long as high");
        tell(Severity::Note, "triangles", message);
    }
    if !giants.is_empty() {
        let count = giants.len();
        giants.dedup();
        giants.sort_unstable();
        giants.dedup();
        let names: Vec<&str> = giants.iter().map(|&o| scene.objects()[o as usize].name.as_str()).collect();
        let extent = scene.view().extent;
        let message =
            format!("{count} triangles are longer than {HUGE_EXTENTS} extents ({extent} each), in {}", some_of(&names));
        tell(Severity::Note, "triangles", message);
    }
}

fn extent(scene: &Scene, tell: Tell) {
    let extents = Extents::of(scene.positions(), scene.triangles());
    let longest = |(low, high): (glam::Vec3, glam::Vec3)| (high - low).max_element();
    let (all, most) = (longest(extents.all), longest(extents.most));
    let given = scene.view().extent;
    if all > OUTLIER_RATIO * most {
        let object = outermost(scene, &extents);
        let remedy = if scene.notes().extent_given {
            format!("view.json says {given}, which counts")
        } else {
            "set `extent` in view.json to the size of the room".into()
        };
        let message = format!(
            "a few outliers dominate the extent: the box of all vertices is {all} long, that of the middle 98 % {most} \
             (farthest out: `{object}`); {remedy}"
        );
        let severity = if scene.notes().extent_given { Severity::Note } else { Severity::Warning };
        tell(severity, "extent", message);
    }
    if given > 4.0 * all || given < 0.1 * most {
        let message =
            format!("extent is {given}, but the scene is {all} long; the tolerance `t_pos` is relative to the extent");
        tell(Severity::Warning, "extent", message);
    }
}

/// Name of the object that reaches farthest from the middle of the percentile box.
fn outermost<'a>(scene: &'a Scene, extents: &Extents) -> &'a str {
    let middle = extents.most.0 + (extents.most.1 - extents.most.0) * 0.5;
    let mut farthest = (-1.0, 0);
    for (triangle, &object) in scene.triangles().iter().zip(scene.triangle_objects()) {
        for &v in triangle {
            let distance = (scene.positions()[v as usize] - middle).abs().max_element();
            if distance > farthest.0 {
                farthest = (distance, object);
            }
        }
    }
    &scene.objects()[farthest.1 as usize].name
}

/// Neighbouring triangles that are wound in opposite senses: both run along their common edge in the same direction.
fn winding(scene: &Scene, tell: Tell) {
    // Vertices at the same place are one: files split them where attributes differ.
    let mut order: Vec<u32> = (0..scene.positions().len() as u32).collect();
    let key = |v: u32| (scene.positions()[v as usize] + glam::Vec3::ZERO).to_array().map(f32::to_bits);
    order.sort_unstable_by_key(|&v| (key(v), v));
    let mut place = vec![0u32; scene.positions().len()];
    let mut last = 0;
    for (i, &v) in order.iter().enumerate() {
        if i == 0 || key(order[i - 1]) != key(v) {
            last = v;
        }
        place[v as usize] = last;
    }
    drop(order);
    // An edge as (lower vertex, higher vertex, object), and whether the triangle runs from higher to lower.
    let mut edges: Vec<(u32, u32, u32, bool)> = Vec::with_capacity(scene.triangles().len() * 3);
    for (triangle, &object) in scene.triangles().iter().zip(scene.triangle_objects()) {
        let [a, b, c] = triangle.map(|v| place[v as usize]);
        for (from, to) in [(a, b), (b, c), (c, a)] {
            edges.push((from.min(to), from.max(to), object, from > to));
        }
    }
    edges.sort_unstable();
    let (mut shared, mut disagreeing, mut crowded) = (0, 0, 0);
    let mut objects = Vec::new();
    for run in edges.chunk_by(|a, b| (a.0, a.1, a.2) == (b.0, b.1, b.2)) {
        match run {
            [a, b] => {
                shared += 1;
                if a.3 == b.3 {
                    disagreeing += 1;
                    objects.push(a.2);
                }
            }
            [_] => {}
            _ => crowded += 1,
        }
    }
    if disagreeing > 0 {
        objects.sort_unstable();
        objects.dedup();
        let share = percent(disagreeing, shared);
        let names: Vec<&str> = objects.iter().map(|&o| scene.objects()[o as usize].name.as_str()).collect();
        let message = format!(
            "winding is mixed: at {share} edges the two faces run in opposite senses, in {}; drawn two-sided, but glass \
             needs to know inside from outside",
            some_of(&names)
        );
        tell(Severity::Note, "winding", message);
    }
    let against = wound_against_normals(scene);
    if against > 0 {
        let share = percent(against, scene.triangles().len());
        let message = format!("{share} triangles are wound against their shading normals; drawn two-sided");
        tell(Severity::Note, "winding", message);
    }
    if crowded > 0 {
        let message = format!("{crowded} edges belong to more than two triangles (duplicate or inner faces)");
        tell(Severity::Note, "triangles", message);
    }
}

/// Faces of different objects in one plane.
fn overlaps(scene: &Scene, tell: Tell) {
    let found = coplanar::overlaps(scene);
    for (kind, count, objects) in found.pairs {
        let at_least = if found.complete { "" } else { "at least " };
        let [a, b] = objects.map(|o| &scene.objects()[o as usize]);
        let pairs = format!("{at_least}{count} pairs of triangles (first in `{}` and `{}`)", a.name, b.name);
        let (severity, what, remedy) = match kind {
            Kind::Sheet => (Severity::Note, "are the two sides of one sheet", ""),
            Kind::Duplicate => (Severity::Note, "are the same twice", ""),
            Kind::OnGlass => (Severity::Note, "touch, and one is glass", ""),
            Kind::TwoSided => (Severity::Warning, "are the two sides of one sheet, split in two ways", "keep one side"),
            Kind::Contact => (Severity::Note, "touch face to face", "where both are seen, move them apart"),
            Kind::BothGlass => (Severity::Warning, "touch, and both are glass", "move them apart, or let them overlap"),
            Kind::Decal => (Severity::Warning, "cover each other in one plane", "move the one to be seen to the front"),
        };
        let rule = match kind {
            Kind::Sheet => "each is seen from its front".into(),
            Kind::Duplicate => "the first is seen".into(),
            Kind::OnGlass => "the other one is seen, as if it lay before the glass".into(),
            _ => format!("rounding decides which of them is seen, with noise; {remedy}"),
        };
        let message = format!("{pairs} {what}: {rule}");
        tell(severity, "overlaps", message);
    }
}

/// Triangles all of whose corners have a shading normal on the other side than the winding says.
fn wound_against_normals(scene: &Scene) -> usize {
    let against = |(triangle, normals): (&[u32; 3], &[u32; 3])| {
        let [a, b, c] = triangle.map(|v| scene.positions()[v as usize]);
        let face = cross(b - a, c - a);
        normals.iter().all(|&n| dot(face, unpack_normal(n)) < 0.0)
    };
    scene.triangles().iter().zip(scene.corner_normals()).filter(|&both| against(both)).count()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use glam::{Vec2, Vec3};

    use super::*;
    use crate::math::pack_normal;
    use crate::scene::{Light, Object, SceneParts, Texture};

    /// A sheet of `n` by `n` unit squares in the xy plane, wound counter-clockwise, with a light: nothing is odd.
    fn sheet(n: u32) -> SceneParts {
        let mut scene = SceneParts { materials: vec![Material::default()], ..SceneParts::default() };
        for y in 0..=n {
            scene.positions.extend((0..=n).map(|x| Vec3::new(x as f32, y as f32, 0.0)));
        }
        for y in 0..n {
            for x in 0..n {
                let at = |dx: u32, dy: u32| (y + dy) * (n + 1) + x + dx;
                scene.triangles.extend([[at(0, 0), at(1, 0), at(1, 1)], [at(0, 0), at(1, 1), at(0, 1)]]);
            }
        }
        let count = scene.triangles.len();
        scene.corner_normals = vec![[pack_normal(Vec3::Z); 3]; count];
        scene.corner_texcoords = vec![[Vec2::ZERO; 3]; count];
        scene.triangle_objects = vec![0; count];
        scene.objects = vec![Object { name: "sheet".into(), material: 0 }];
        scene.view.lights = vec![Light { position: Vec3::Z, intensity: Vec3::ONE }];
        scene.view.extent = n as f32;
        scene
    }

    #[track_caller]
    fn finds(parts: &SceneParts, severity: Severity, topic: &str, words: &str) {
        let findings = examine(&Scene::new(parts.clone()).unwrap());
        let fits = |f: &Finding| f.severity == severity && f.topic == topic && f.message.contains(words);
        assert!(findings.iter().any(fits), "no {severity:?} about {topic} with `{words}`: {findings:#?}");
    }

    #[test]
    fn nothing_is_odd_about_a_plain_sheet() {
        assert_eq!(examine(&Scene::new(sheet(20)).unwrap()), []);
    }

    #[test]
    fn turned_triangles_are_counted_by_edges_and_by_normals() {
        let mut scene = sheet(20);
        // In the middle: all three edges have a neighbour.
        scene.triangles[411].swap(0, 1);
        finds(&scene, Severity::Note, "winding", "mixed: at 3 of 1160 (0.3 %) edges");
        finds(&scene, Severity::Note, "winding", "1 of 800 (0.1 %) triangles are wound against their shading normals");
        // Vertices that are doubled do not hide it.
        let turned = scene.triangles[411];
        for (corner, v) in turned.into_iter().enumerate() {
            scene.positions.push(scene.positions[v as usize]);
            scene.triangles[411][corner] = scene.positions.len() as u32 - 1;
        }
        finds(&scene, Severity::Note, "winding", "mixed: at 3 of 1160");
    }

    #[test]
    fn an_outlier_is_named_with_its_object_and_its_size() {
        let mut scene = sheet(20);
        scene.positions.extend([Vec3::new(500.0, 0.0, 0.0), Vec3::new(500.0, 1.0, 0.0)]);
        scene.triangles.push([0, 441, 442]);
        scene.corner_normals.push([pack_normal(Vec3::Z); 3]);
        scene.corner_texcoords.push([Vec2::ZERO; 3]);
        scene.triangle_objects.push(1);
        scene.objects.push(Object { name: "ground".into(), material: 0 });
        finds(&scene, Severity::Warning, "extent", "500 long, that of the middle 98 % 20 (farthest out: `ground`)");
        finds(&scene, Severity::Note, "triangles", "1 triangles are longer than 2 extents (20 each), in `ground`");
        scene.notes.extent_given = true;
        finds(&scene, Severity::Note, "extent", "view.json says 20, which counts");
    }

    #[test]
    fn needles_crowded_edges_and_wrong_extents_are_told() {
        let mut scene = sheet(20);
        scene.positions.push(Vec3::new(10.0, 1.0e-4, 0.0));
        scene.triangles[0] = [0, 20, 441];
        finds(&scene, Severity::Note, "triangles", "1 of 800 (0.1 %) triangles are needles");
        let mut scene = sheet(20);
        scene.triangles[700] = scene.triangles[411];
        finds(&scene, Severity::Note, "triangles", "3 edges belong to more than two triangles");
        scene.view.extent = 1000.0;
        finds(&scene, Severity::Warning, "extent", "extent is 1000, but the scene is 20 long");
    }

    #[test]
    fn what_loading_counted_and_said_is_passed_on() {
        let mut scene = sheet(2);
        scene.warnings.push("a.png: texture not found".into());
        scene.notes.triangles_without_normals = 4;
        scene.notes.triangles_without_texcoords = 3;
        scene.notes.duplicate_names.push("chair".into());
        finds(&scene, Severity::Warning, "loading", "a.png: texture not found");
        finds(&scene, Severity::Note, "normals", "4 of 8 (50.0 %)");
        finds(&scene, Severity::Warning, "texture coordinates", "3 triangles");
        finds(&scene, Severity::Note, "names", "`chair`");
        assert_eq!(examine(&Scene::new(scene).unwrap())[0].severity, Severity::Warning);
    }

    #[test]
    fn materials_and_lights_that_show_nothing_are_told() {
        let mut scene = sheet(2);
        scene.textures.push(Texture { name: "t.png".into(), width: 1, height: 1, texels: vec![0] });
        scene.materials.push(Material { diffuse: Vec3::ZERO, diffuse_texture: Some(0), ..Material::default() });
        scene.view.lights.clear();
        finds(&scene, Severity::Warning, "materials", "blackens the texture of `(default)`");
        finds(&scene, Severity::Warning, "names", "1 material names occur twice: `(default)`");
        finds(&scene, Severity::Warning, "lights", "no light shines");
    }
}
