// SPDX-License-Identifier: MIT OR Apache-2.0
//! Polygons that are there twice, as modelling programs write the front and the back of a face.
//!
//! Both are split along the same diagonals, so that each triangle of the one lies exactly on a triangle of the other:
//! which of the two a ray finds is then decided by a rule (`src/prepare/coincident.rs`) and not by rounding.

use std::collections::{HashMap, HashSet};
use std::path::Path;

use glam::Vec3;

use super::options::reserve;
use crate::Result;

/// The polygons of a file that may be there twice.
#[derive(Default)]
pub(super) struct Twins {
    /// Hashes that several polygons have.
    repeated: HashSet<u64>,
    /// By hash, polygons that were split.
    split: HashMap<u64, Vec<Polygon>>,
}

/// The corners of a polygon, and its triangles.
type Polygon = (Vec<Vec3>, Vec<[u32; 3]>);

impl Twins {
    /// Looks through all polygons of the file at `path`.
    pub(super) fn find(models: &[tobj::Model], path: &Path) -> Result<Self> {
        let polygons = |m: &tobj::Model| m.mesh.face_arities.iter().filter(|&&n| n > 3).count();
        let mut hashes: Vec<u64> = Vec::new();
        reserve(&mut hashes, models.iter().map(polygons).sum(), path)?;
        let mut corners = Vec::new();
        for mesh in models.iter().map(|m| &m.mesh) {
            let mut first = 0;
            for arity in mesh.face_arities.iter().map(|&n| n as usize) {
                if arity > 3 {
                    corners.clear();
                    let places = mesh.indices[first..first + arity].iter().map(|&i| i as usize * 3);
                    corners.extend(places.map(|i| Vec3::from_slice(&mesh.positions[i..i + 3])));
                    hashes.push(hash(&corners));
                }
                first += arity;
            }
        }
        hashes.sort_unstable();
        let repeated = hashes.windows(2).filter(|w| w[0] == w[1]).map(|w| w[0]).collect();
        Ok(Twins { repeated, split: HashMap::new() })
    }

    /// The triangles of the polygon with these corners, if it was split before, forwards or backwards.
    pub(super) fn known(&self, corners: &[Vec3]) -> Option<Vec<[u32; 3]>> {
        if self.repeated.is_empty() {
            return None;
        }
        let before = self.split.get(&hash(corners))?;
        before.iter().find_map(|(other, split)| {
            let (at, backwards) = place_of(other, corners)?;
            let n = corners.len() as u32;
            let turn = |t: &[u32; 3]| {
                let [i, j, k] = t.map(|i| if backwards { (at + n - i) % n } else { (at + i) % n });
                if backwards { [i, k, j] } else { [i, j, k] }
            };
            Some(split.iter().map(turn).collect())
        })
    }

    /// Remembers how a polygon was split, if it may come again.
    pub(super) fn remember(&mut self, corners: &[Vec3], split: &[[u32; 3]]) {
        let hash = hash(corners);
        if self.repeated.contains(&hash) {
            self.split.entry(hash).or_default().push((corners.to_vec(), split.to_vec()));
        }
    }
}

/// A hash that neither the first corner nor the sense of the walk changes.
fn hash(corners: &[Vec3]) -> u64 {
    corners.iter().fold(0, |sum: u64, &p| {
        let mixed = (p + Vec3::ZERO).to_array().into_iter().fold(0x9e37_79b9_7f4a_7c15u64, |h, c| {
            let h = (h ^ u64::from(c.to_bits())).wrapping_mul(0xff51_afd7_ed55_8ccd);
            h ^ (h >> 29)
        });
        sum.wrapping_add(mixed)
    })
}

/// Which corner of `ring` the first one of `other` is, and whether `other` goes round the other way; `None` if they are
/// not the same.
fn place_of(other: &[Vec3], ring: &[Vec3]) -> Option<(u32, bool)> {
    let n = ring.len();
    if n != other.len() {
        return None;
    }
    (0..n).filter(|&at| ring[at] == other[0]).find_map(|at| {
        let forwards = (1..n).all(|i| ring[(at + i) % n] == other[i]);
        let backwards = !forwards && (1..n).all(|i| ring[(at + n - i) % n] == other[i]);
        (forwards || backwards).then_some((at as u32, backwards))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polygon_is_found_again_from_any_corner_and_from_behind() {
        let ring: Vec<Vec3> = (0..5).map(|i| Vec3::new((i * i) as f32, i as f32, 0.5)).collect();
        let mut twins = Twins { repeated: HashSet::from([hash(&ring)]), ..Twins::default() };
        let split = [[0, 1, 2], [0, 2, 3], [0, 3, 4]];
        twins.remember(&ring, &split);
        let places = |ring: &[Vec3], split: &[[u32; 3]]| -> Vec<[Vec3; 3]> {
            split.iter().map(|t| t.map(|i| ring[i as usize])).collect()
        };
        for turn in 0..5 {
            let mut other = ring.clone();
            other.rotate_left(turn);
            let found = twins.known(&other).unwrap_or_default();
            assert_eq!(places(&other, &found), places(&ring, &split));
            other.reverse();
            let found = places(&other, &twins.known(&other).unwrap_or_default());
            let behind: Vec<[Vec3; 3]> = places(&ring, &split).into_iter().map(|[a, b, c]| [a, c, b]).collect();
            assert_eq!(found, behind);
        }
        // The same places in another order, and another polygon.
        let mut other = ring.clone();
        other.swap(1, 3);
        assert_eq!(hash(&other), hash(&ring));
        assert!(twins.known(&other).is_none());
        other[0].x += 1.0;
        assert!(twins.known(&other).is_none());
    }
}
