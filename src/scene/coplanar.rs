// SPDX-License-Identifier: MIT OR Apache-2.0
//! Triangles of different objects that lie in one plane and cover each other: which of the two a ray finds is left to
//! rounding, but for those with a rule: the same three places (`src/prepare/coincident.rs`), and glass, before which what
//! is opaque comes.
//!
//! Triangles are sorted into cells of like planes (normal and distance, from a hash); within a cell a sweep along strips
//! finds those whose boxes meet, and only these are cut against each other. That is close to linear in the number of
//! triangles; where a plane is too crowded for that, counting ends and says so.

use std::collections::HashMap;

use glam::{Vec2, Vec3};

use super::{Scene, Surface};
use crate::math::{cross, dot};

/// Planes whose unit normals and whose distances (in sizes of the scene) differ by less than this are compared.
const CELL: f32 = 1.0e-3;

/// How far a triangle may lie off the other's plane, in sizes of the scene: what single precision makes of one plane.
const FLAT: f32 = 1.0e-6;

/// Least part of the smaller triangle that the other must cover: edges that touch do not count.
const LEAST_SHARE: f32 = 1.0e-3;

/// Pairs that are looked at for each triangle of the scene, on average, before counting ends.
const PAIRS_A_TRIANGLE: u64 = 100;

/// Pairs that are looked at in any scene.
const LEAST_PAIRS: u64 = 1 << 20;

/// Sides of planes are told apart by this direction.
const ASKEW: Vec3 = Vec3::new(0.573_171_9, 0.604_713_3, 0.553_092_7);

/// How two triangles lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) enum Kind {
    /// The same three places, facing opposite sides: the front and the back of a sheet. Each is seen from its front.
    Sheet,
    /// They face opposite sides and share two corners: a sheet that is split in two ways.
    TwoSided,
    /// They face opposite sides and do not: bodies that touch, mostly.
    Contact,
    /// One of them bounds a body of glass. The other is seen.
    OnGlass,
    /// Both bound bodies of glass.
    BothGlass,
    /// The same three places, facing the same side. The first is seen.
    Duplicate,
    /// They face the same side: a decal, or one face left inside another.
    Decal,
}

/// What was counted.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct Overlaps {
    /// For each kind the pairs of triangles, and the first pair of objects.
    pub pairs: Vec<(Kind, usize, [u32; 2])>,
    /// All of them were counted.
    pub complete: bool,
}

/// One triangle in a cell of planes.
struct Face {
    id: u32,
    object: u32,
    /// Its normal points against the cell's.
    turned: bool,
    /// Corners in the plane, and the box around them.
    corners: [Vec2; 3],
    low: Vec2,
    high: Vec2,
}

/// Counts pairs of triangles of different objects that cover each other in one plane.
pub(super) fn overlaps(scene: &Scene) -> Overlaps {
    let (mut low, mut high) = (Vec3::splat(f32::MAX), Vec3::splat(f32::MIN));
    for &v in scene.triangles().iter().flatten() {
        let p = scene.positions()[v as usize];
        (low, high) = (low.min(p), high.max(p));
    }
    let (middle, size) = ((low + high) * 0.5, (high - low).max_element().max(f32::MIN_POSITIVE));
    let corners = |t: u32| scene.triangles()[t as usize].map(|v| (scene.positions()[v as usize] - middle) / size);

    let mut cells: HashMap<[i32; 4], Vec<(u32, bool)>> = HashMap::new();
    for t in 0..scene.triangles().len() as u32 {
        let Some((normal, distance, turned)) = plane(corners(t)) else { continue };
        for key in keys(normal, distance) {
            cells.entry(key).or_default().push((t, turned));
        }
    }
    // Order must not depend on the hash: the first pair is named.
    let mut crowded: Vec<_> = cells.into_values().filter(|cell| spans_objects(scene, cell)).collect();
    crowded.sort_unstable_by_key(|cell| cell[0]);

    let mut found: HashMap<(u32, u32), Kind> = HashMap::new();
    let mut left = PAIRS_A_TRIANGLE.saturating_mul(scene.triangles().len() as u64).max(LEAST_PAIRS);
    let mut complete = true;
    for cell in crowded {
        complete &= search(scene, &cell, &corners, &mut left, &mut found);
    }
    let mut all: Vec<_> = found.into_iter().map(|((a, b), kind)| (kind, a, b)).collect();
    all.sort_unstable();
    let object = |t: u32| scene.triangle_objects()[t as usize];
    let pairs = all
        .chunk_by(|a, b| a.0 == b.0)
        .map(|same| (same[0].0, same.len(), [object(same[0].1), object(same[0].2)]))
        .collect();
    Overlaps { pairs, complete }
}

/// The plane of a triangle: unit normal, distance from the origin, whether the normal was turned round to make the
/// planes of both sides one. `None` for needles, whose plane is noise.
fn plane([a, b, c]: [Vec3; 3]) -> Option<(Vec3, f32, bool)> {
    let n = cross(b - a, c - a);
    let longest2 = dot(b - a, b - a).max(dot(c - b, c - b)).max(dot(a - c, a - c));
    let length = dot(n, n).sqrt();
    if length.is_nan() || length <= 1.0e-3 * longest2 {
        return None;
    }
    let n = n / length;
    // By a direction that no face of a model is parallel to: by the largest component, 1 -1 0 would be left to rounding.
    let turned = dot(n, ASKEW) < 0.0;
    let n = if turned { -n } else { n };
    Some((n, dot(n, (a + b + c) / 3.0), turned))
}

/// The cells that a plane belongs to: its own and, near their borders, the neighbours.
fn keys(normal: Vec3, distance: f32) -> Vec<[i32; 4]> {
    let mut keys = vec![[0; 4]];
    for (i, value) in [normal.x, normal.y, normal.z, distance].into_iter().enumerate() {
        let at = value / CELL;
        let own = at.floor();
        // A hundredth of a cell is far above what rounding does to triangles that are no needles.
        let beside = if at - own < 0.01 {
            Some(own - 1.0)
        } else if at - own > 0.99 {
            Some(own + 1.0)
        } else {
            None
        };
        let count = keys.len();
        for k in 0..count {
            keys[k][i] = own as i32;
            if let Some(beside) = beside {
                let mut other = keys[k];
                other[i] = beside as i32;
                keys.push(other);
            }
        }
    }
    keys
}

fn spans_objects(scene: &Scene, cell: &[(u32, bool)]) -> bool {
    let object = |&(t, _): &(u32, bool)| scene.triangle_objects()[t as usize];
    cell.iter().any(|t| object(t) != object(&cell[0]))
}

/// Finds the pairs of one cell. `false`: there were too many to look at.
fn search(
    scene: &Scene,
    cell: &[(u32, bool)],
    corners: &impl Fn(u32) -> [Vec3; 3],
    left: &mut u64,
    found: &mut HashMap<(u32, u32), Kind>,
) -> bool {
    let Some((normal, ..)) = plane(corners(cell[0].0)) else { return true };
    // Along the two axes in which the plane is seen largest.
    let a = normal.abs();
    let flatten = |p: Vec3| match () {
        () if a.x >= a.y.max(a.z) => Vec2::new(p.y, p.z),
        () if a.y >= a.z => Vec2::new(p.x, p.z),
        () => Vec2::new(p.x, p.y),
    };
    let mut faces: Vec<Face> = cell
        .iter()
        .map(|&(id, turned)| {
            let corners = corners(id).map(flatten);
            let [a, b, c] = corners;
            let object = scene.triangle_objects()[id as usize];
            Face { id, object, turned, corners, low: a.min(b).min(c), high: a.max(b).max(c) }
        })
        .collect();
    // Strips about as high as the faces, and a sweep along each: neither many small faces nor a few long ones make
    // many pairs.
    let (low, high) = faces.iter().fold((Vec2::MAX, Vec2::MIN), |(l, h), f| (l.min(f.low), h.max(f.high)));
    let mean = faces.iter().map(|f| f64::from(f.high.y - f.low.y)).sum::<f64>() / faces.len() as f64;
    let height = f64::from(high.y - low.y);
    let count = if mean * faces.len() as f64 > height { (height / mean) as usize + 1 } else { faces.len() };
    let strip_of = |y: f32| ((f64::from(y - low.y) / height * count as f64) as usize).min(count - 1);
    faces.sort_by(|a, b| a.low.x.total_cmp(&b.low.x).then(a.id.cmp(&b.id)));
    let mut strips: Vec<Vec<u32>> = vec![Vec::new(); count];
    for (i, face) in faces.iter().enumerate() {
        let strips = &mut strips[strip_of(face.low.y)..=strip_of(face.high.y)];
        if !spend(left, strips.len()) {
            return false;
        }
        strips.iter_mut().for_each(|strip| strip.push(i as u32));
    }
    let mut active: Vec<u32> = Vec::new();
    for strip in strips {
        active.clear();
        for i in strip {
            let face = &faces[i as usize];
            active.retain(|&j| faces[j as usize].high.x > face.low.x);
            if !spend(left, active.len()) {
                return false;
            }
            for &j in &active {
                let other = &faces[j as usize];
                let apart = other.high.y <= face.low.y || face.high.y <= other.low.y;
                if apart || other.object == face.object {
                    continue;
                }
                let pair = (face.id.min(other.id), face.id.max(other.id));
                if found.contains_key(&pair) || !in_one_plane(corners(pair.0), corners(pair.1)) || !cover(face, other) {
                    continue;
                }
                found.insert(pair, kind(scene, face, other));
            }
            active.push(i);
        }
    }
    true
}

/// Takes `steps` from what is left; `false` if that is less.
fn spend(left: &mut u64, steps: usize) -> bool {
    let enough = *left >= steps as u64;
    *left = left.saturating_sub(steps as u64);
    enough
}

/// Whether the corners of `b` lie in the plane of `a`.
fn in_one_plane(a: [Vec3; 3], b: [Vec3; 3]) -> bool {
    plane(a).is_some_and(|(n, ..)| b.iter().all(|&p| dot(n, p - a[0]).abs() <= FLAT))
}

fn kind(scene: &Scene, a: &Face, b: &Face) -> Kind {
    let is_glass = |f: &Face| {
        let material = scene.objects()[f.object as usize].material;
        scene.materials()[material as usize].surface == Surface::Glass
    };
    let shared = a.corners.iter().filter(|c| b.corners.contains(c)).count();
    match (a.turned != b.turned, shared) {
        _ if is_glass(a) && is_glass(b) => Kind::BothGlass,
        _ if is_glass(a) || is_glass(b) => Kind::OnGlass,
        (true, 3) => Kind::Sheet,
        (true, 2) => Kind::TwoSided,
        (true, _) => Kind::Contact,
        (false, 3) => Kind::Duplicate,
        (false, _) => Kind::Decal,
    }
}

/// Whether two triangles of one plane share more than [`LEAST_SHARE`] of the smaller one's area: one is cut along the
/// other's sides (Sutherland and Hodgman 1974).
fn cover(a: &Face, b: &Face) -> bool {
    let area2 = |c: &[Vec2]| -> f32 {
        (1..c.len().saturating_sub(1)).map(|i| (c[i] - c[0]).perp_dot(c[i + 1] - c[0])).sum::<f32>().abs()
    };
    let mut cutter = b.corners;
    if (cutter[1] - cutter[0]).perp_dot(cutter[2] - cutter[0]) < 0.0 {
        cutter.swap(1, 2);
    }
    let mut shape = a.corners.to_vec();
    for i in 0..3 {
        let (from, along) = (cutter[i], cutter[(i + 1) % 3] - cutter[i]);
        let side = |p: Vec2| along.perp_dot(p - from);
        let before = std::mem::take(&mut shape);
        for (k, &p) in before.iter().enumerate() {
            let q = before[(k + 1) % before.len()];
            let (s, t) = (side(p), side(q));
            if s >= 0.0 {
                shape.push(p);
            }
            if (s >= 0.0) != (t >= 0.0) {
                shape.push(p + (q - p) * (s / (s - t)));
            }
        }
    }
    area2(&shape) > LEAST_SHARE * area2(&a.corners).min(area2(&b.corners))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::scene::{Material, Object, SceneParts};

    /// A scene of squares, each its own object: middle, side, and whether it is wound the other way round. All lie in
    /// planes across `normal`; the third coordinate is the height above the first of them.
    fn squares(normal: Vec3, squares: &[(f32, f32, f32, f32, bool)]) -> SceneParts {
        let u = normal.any_orthonormal_vector();
        let v = normal.cross(u);
        let mut scene = SceneParts { materials: vec![Material::default()], ..SceneParts::default() };
        for (i, &(x, y, z, side, turned)) in squares.iter().enumerate() {
            let first = scene.positions.len() as u32;
            for (dx, dy) in [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)] {
                scene.positions.push(u * (x + dx * side) + v * (y + dy * side) + normal * (0.3 + z));
            }
            let mut triangles = [[0, 1, 2], [0, 2, 3]].map(|t| t.map(|k| first + k));
            if turned {
                triangles.iter_mut().for_each(|t| t.swap(1, 2));
            }
            scene.triangles.extend(triangles);
            scene.corner_normals.extend([[0; 3]; 2]);
            scene.corner_texcoords.extend([[Vec2::ZERO; 3]; 2]);
            scene.triangle_objects.extend([i as u32; 2]);
            scene.objects.push(Object { name: format!("square {i}"), material: 0 });
        }
        scene
    }

    fn found(scene: &SceneParts) -> Overlaps {
        overlaps(&Scene::new(scene.clone()).unwrap())
    }

    fn counted(scene: &SceneParts) -> Vec<(Kind, usize)> {
        let found = found(scene);
        assert!(found.complete);
        found.pairs.into_iter().map(|(kind, count, _)| (kind, count)).collect()
    }

    /// Directions of planes, among them those where two components tie.
    fn normals() -> Vec<Vec3> {
        let mut all = vec![Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_Z];
        for v in
            [Vec3::new(1.0, -1.0, 0.0), Vec3::new(0.0, 1.0, -1.0), Vec3::new(1.0, 2.0, 3.0), Vec3::new(-0.3, 0.1, 0.9)]
        {
            all.push(v.normalize());
        }
        all
    }

    #[test]
    fn squares_that_cover_each_other_are_counted_by_kind() {
        for n in normals() {
            // The same square from behind: each triangle lies on one of the other's.
            let two = squares(n, &[(0.0, 0.0, 0.0, 1.0, false), (0.0, 0.0, 0.0, 1.0, true)]);
            assert_eq!(counted(&two), [(Kind::Sheet, 2)], "{n}");
            let twice = squares(n, &[(0.0, 0.0, 0.0, 1.0, false), (0.0, 0.0, 0.0, 1.0, false)]);
            assert_eq!(counted(&twice), [(Kind::Duplicate, 2)], "{n}");
            // A smaller one in the middle: the diagonals lie on each other.
            let decal = squares(n, &[(0.0, 0.0, 0.0, 3.0, false), (0.0, 0.0, 0.0, 0.5, false)]);
            assert_eq!(counted(&decal), [(Kind::Decal, 2)], "{n}");
            let touching = squares(n, &[(0.0, 0.0, 0.0, 3.0, false), (0.0, 0.0, 0.0, 0.5, true)]);
            assert_eq!(counted(&touching), [(Kind::Contact, 2)], "{n}");
            let aside = squares(n, &[(0.0, 0.0, 0.0, 3.0, false), (1.0, -0.9, 0.0, 0.5, false)]);
            assert_eq!(counted(&aside).len(), 1, "{n}");
        }
    }

    #[test]
    fn what_does_not_cover_is_not_counted() {
        for n in normals() {
            // Side by side, corner to corner, above each other, one object.
            let apart = [(0.0, 0.0, 0.0, 1.0, false), (1.0, 0.0, 0.0, 1.0, false), (1.0, 1.0, 0.0, 1.0, true)];
            assert_eq!(counted(&squares(n, &apart)), [], "{n}");
            let above = [(0.0, 0.0, 0.0, 1.0, false), (0.0, 0.0, 1.0e-4, 1.0, true)];
            assert_eq!(counted(&squares(n, &above)), [], "{n}");
            let mut one = squares(n, &[(0.0, 0.0, 0.0, 1.0, false), (0.0, 0.0, 0.0, 1.0, false)]);
            one.triangle_objects = vec![0; 4];
            assert_eq!(counted(&one), [], "{n}");
        }
        // Planes that cross.
        let mut crossed = squares(Vec3::Z, &[(0.0, 0.0, 0.0, 1.0, false)]);
        let other = squares(Vec3::X, &[(0.0, 0.0, 0.0, 1.0, false)]);
        crossed.positions.extend(other.positions);
        crossed.triangles.extend(other.triangles.iter().map(|t| t.map(|v| v + 4)));
        crossed.triangle_objects.extend([1, 1]);
        crossed.corner_normals.extend(other.corner_normals);
        crossed.corner_texcoords.extend(other.corner_texcoords);
        crossed.objects.extend(other.objects);
        assert_eq!(counted(&crossed), []);
    }

    #[test]
    fn glass_is_a_kind_of_its_own() {
        let mut scene = squares(Vec3::Y, &[(0.0, 0.0, 0.0, 3.0, false), (0.0, 0.0, 0.0, 0.5, true)]);
        scene.materials.push(Material { surface: Surface::Glass, ..Material::default() });
        scene.objects[1].material = 1;
        assert_eq!(counted(&scene), [(Kind::OnGlass, 2)]);
    }

    #[test]
    fn a_crowded_plane_ends_the_search_and_says_so() {
        // All over each other: the pairs grow with the square.
        let many: Vec<_> = (0..2000).map(|i| (i as f32 * 1.0e-5, 0.0, 0.0, 1.0, i % 2 == 0)).collect();
        let found = found(&squares(Vec3::Z, &many));
        assert!(!found.complete);
        assert!(found.pairs.iter().map(|p| p.1).sum::<usize>() > 1000);
        // A large floor of tiles beside each other is not crowded.
        let tiles: Vec<_> = (0..10_000).map(|i| ((i % 100) as f32, (i / 100) as f32, 0.0, 1.0, false)).collect();
        assert_eq!(counted(&squares(Vec3::Y, &tiles)), []);
    }
}
