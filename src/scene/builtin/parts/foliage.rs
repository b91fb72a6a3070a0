// SPDX-License-Identifier: MIT OR Apache-2.0
//! Foliage of single leaves, each a bent card with a cut-out picture: trees, climbing plants, hedges.

use glam::{Vec2, Vec3};

use super::at;
use crate::Result;
use crate::monitor::Monitor;
use crate::scene::builtin::mesh::{Mesh, Random, cos_sin};
use crate::scene::builtin::paint::noise;

/// Leaves between two looks at the monitor.
const LOOK: u32 = 2048;

/// Adds a leaf: it begins at `foot`, runs `long` along `along`, is `wide` along `across`, and its tip bends by `droop`
/// away from the side that it looks to. Both directions have length 1.
pub fn add_leaf(mesh: &mut Mesh, foot: Vec3, along: Vec3, across: Vec3, [long, wide, droop]: [f32; 3]) {
    let up = across.cross(along);
    let first = mesh.positions.len() as u32;
    for row in 0..3 {
        let t = 0.5 * row as f32;
        let spine = foot + along * (long * t) - up * (droop * t * t);
        let normal = (up + along * (2.0 * droop * t / long)).normalize();
        for side in [-0.5, 0.5] {
            mesh.positions.push(spine + across * (wide * side));
            mesh.normals.push(normal);
            mesh.texcoords.push(Vec2::new(side + 0.5, t));
        }
    }
    for row in 0..2 {
        let a = first + 2 * row;
        mesh.triangles.push([a, a + 1, a + 3]);
        mesh.triangles.push([a, a + 3, a + 2]);
    }
}

/// A direction, all of them equally likely enough for leaves.
fn any_direction(random: &mut Random) -> Vec3 {
    let y = random.range(-1.0, 1.0);
    let (c, s) = cos_sin(random.range(0.0, 1.0));
    let r = (1.0 - y * y).max(0.0).sqrt();
    at(c * r, y, s * r)
}

/// What a tree is like.
#[derive(Debug, Clone, Copy)]
pub struct Tree {
    /// Length of the trunk below the crown.
    pub trunk: f32,
    /// Length of the longest branches.
    pub reach: f32,
    /// How many leaves.
    pub leaves: u32,
    /// Length of a leaf.
    pub leaf: f32,
    /// Its seed.
    pub seed: u32,
}

/// A branch while a tree grows.
struct Branch {
    foot: Vec3,
    direction: Vec3,
    long: f32,
    thick: f32,
    level: usize,
}

/// Branches that leave a branch of each level; those of the last level are twigs, which have the leaves.
const CHILDREN: [u32; 4] = [6, 5, 4, 4];

/// A tree on the origin: its wood, its leaves, and places from which fruit may hang.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub fn tree(what: &Tree, monitor: &Monitor) -> Result<(Mesh, Mesh, Vec<Vec3>)> {
    let mut random = Random::new(what.seed);
    let (mut wood, mut leaves) = (Mesh::default(), Mesh::default());
    let mut twigs = Vec::new();
    let start = Branch {
        foot: at(0.0, -0.05, 0.0),
        direction: Vec3::Y,
        long: what.trunk,
        thick: 0.035 * (what.trunk + what.reach),
        level: 0,
    };
    let mut open = vec![start];
    while let Some(b) = open.pop() {
        let bend = any_direction(&mut random) * (0.08 * b.long);
        let tip = b.foot + b.direction * b.long;
        let path = [b.foot, b.foot.lerp(tip, 0.33) + bend * 0.7, b.foot.lerp(tip, 0.67) + bend, tip];
        let thin = if b.level == 0 { 0.30 } else { 0.55 };
        let sides = [14, 8, 6, 4, 3][b.level];
        let path = crate::scene::builtin::mesh::smooth_path(&path, if b.level < 2 { 4 } else { 1 }, false);
        wood.append(&Mesh::tapered_tube(&path, |t| b.thick * (1.0 - thin * t), sides, false));
        if b.level == CHILDREN.len() {
            twigs.push((b.foot, tip));
            continue;
        }
        for k in 0..CHILDREN[b.level] {
            // Around the branch by the golden angle, most of them near its tip.
            let t = 1.0 - 0.55 * (k as f32 / CHILDREN[b.level] as f32) * if b.level == 0 { 0.35 } else { 1.0 };
            let side = b.direction.cross(if b.direction.y.abs() < 0.9 { Vec3::Y } else { Vec3::X }).normalize();
            let (c, s) = cos_sin(0.381_966 * k as f32 + random.range(-0.06, 0.06));
            let out = side * c + b.direction.cross(side) * s;
            let spread = random.range(0.65, 1.05) * if b.level == 0 { 0.9 } else { 0.85 };
            let direction = (b.direction + out * spread + Vec3::Y * random.range(-0.10, 0.28)).normalize();
            let long =
                if b.level == 0 { what.reach * random.range(0.40, 0.52) } else { b.long * random.range(0.52, 0.72) };
            open.push(Branch {
                foot: b.foot.lerp(tip, t) + bend * (1.0 - t),
                direction,
                long,
                thick: b.thick * (1.0 - thin * t) * 0.62,
                level: b.level + 1,
            });
        }
    }
    let centre = at(0.0, what.trunk + 0.45 * what.reach, 0.0);
    for k in 0..what.leaves {
        if k % LOOK == 0 {
            monitor.check()?;
        }
        let (a, b) = twigs[k as usize % twigs.len()];
        let foot = a.lerp(b, random.range(0.0, 1.15)) + any_direction(&mut random) * (0.55 * what.leaf);
        let outwards = (foot - centre).normalize_or(Vec3::Y);
        let along = (outwards * 0.7 + any_direction(&mut random) - Vec3::Y * 0.25).normalize_or(Vec3::X);
        // The upper side looks outwards and up.
        let light = (outwards + Vec3::Y * 0.8 + any_direction(&mut random) * 0.6).normalize_or(Vec3::Y);
        let across = along.cross(light).normalize_or(along.any_orthonormal_vector());
        let long = what.leaf * random.range(0.75, 1.2);
        add_leaf(&mut leaves, foot, along, across, [long, 0.52 * long, 0.16 * long]);
    }
    let ends = twigs.iter().map(|t| t.1).collect();
    Ok((wood, leaves, ends))
}

/// Leaves of a plant that climbs on the plane z = 0, which looks to +z: `count` of them between two corners, in patches.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub fn climber(lo: Vec2, hi: Vec2, count: u32, leaf: f32, seed: u32, monitor: &Monitor) -> Result<Mesh> {
    let mut random = Random::new(seed.wrapping_add(401));
    let mut mesh = Mesh::default();
    let mut left = count;
    // Most places near the roots are taken, few near the upper border.
    for tries in 0..count.saturating_mul(8) {
        if tries % LOOK == 0 {
            monitor.check()?;
        }
        if left == 0 {
            break;
        }
        let p = Vec2::new(random.range(lo.x, hi.x), random.range(lo.y, hi.y));
        let t = (p - lo) / (hi - lo);
        let edge = t.x.min(1.0 - t.x).min(0.25) * 4.0;
        let patch = 0.6 * noise(p.x * 1.3, p.y * 0.9, 64, seed) + 0.4 * noise(p.x * 4.0, p.y * 4.0, 256, seed + 1);
        if patch + 0.30 * edge - 0.35 * t.y < 0.42 {
            continue;
        }
        left -= 1;
        let lift = random.range(0.01, 0.09);
        let along = at(random.range(-0.7, 0.7), -1.0, random.range(0.05, 0.6)).normalize();
        let look = at(random.range(-0.4, 0.4), 0.35, 1.0).normalize();
        let across = along.cross(look).normalize();
        let long = leaf * random.range(0.7, 1.25);
        add_leaf(&mut mesh, at(p.x, p.y, lift), along, across, [long, 0.95 * long, 0.2 * long]);
    }
    Ok(mesh)
}

/// A clipped hedge along a path: its dark core, and `count` leaves on it; `wide` and `high`.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub fn hedge(path: &[Vec3], wide: f32, high: f32, count: u32, seed: u32, monitor: &Monitor) -> Result<[Mesh; 2]> {
    let mut random = Random::new(seed.wrapping_add(733));
    let pieces = path.len() - 1;
    let mut core = Mesh::default();
    for (k, pair) in path.windows(2).enumerate() {
        let d = (pair[1] - pair[0]).normalize();
        let side = d.cross(Vec3::Y).normalize() * (0.44 * wide);
        let top = Vec3::Y * (high - 0.06 * wide);
        let [a, b] = [pair[0], pair[1]];
        core.append(&Mesh::quad([a + side, b + side, b + side + top, a + side + top], Vec2::ONE));
        core.append(&Mesh::quad([b - side, a - side, a - side + top, b - side + top], Vec2::ONE));
        core.append(&Mesh::quad([a + side + top, b + side + top, b - side + top, a - side + top], Vec2::ONE));
        if k == 0 {
            core.append(&Mesh::quad([a - side, a + side, a + side + top, a - side + top], Vec2::ONE));
        }
        if k + 1 == pieces {
            core.append(&Mesh::quad([b + side, b - side, b - side + top, b + side + top], Vec2::ONE));
        }
    }
    let mut leaves = Mesh::default();
    for k in 0..count {
        if k % LOOK == 0 {
            monitor.check()?;
        }
        let t = random.range(0.0, pieces as f32);
        let i = (t as usize).min(pieces - 1);
        let d = (path[i + 1] - path[i]).normalize();
        let side = d.cross(Vec3::Y).normalize();
        let spine = path[i].lerp(path[i + 1], t - i as f32);
        // Around the cross-section: one side, the top, the other side.
        let around = random.range(0.0, 2.0 * high + wide);
        let (foot, outwards) = if around < high {
            (spine + side * (0.5 * wide) + Vec3::Y * around, side)
        } else if around < high + wide {
            (spine + side * (0.5 * wide - (around - high)) + Vec3::Y * high, Vec3::Y)
        } else {
            (spine - side * (0.5 * wide) + Vec3::Y * (around - high - wide), -side)
        };
        let foot = foot + outwards * random.range(-0.03, 0.005);
        let along = (outwards * 0.6 + any_direction(&mut random)).normalize_or(Vec3::Y);
        let look = (outwards + any_direction(&mut random) * 0.5).normalize_or(Vec3::Y);
        let across = along.cross(look).normalize_or(along.any_orthonormal_vector());
        let long = random.range(0.028, 0.045);
        add_leaf(&mut leaves, foot, along, across, [long, 0.6 * long, 0.1 * long]);
    }
    Ok([core, leaves])
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::monitor::Cancel;
    use crate::scene::builtin::solid::normals_agree;

    const SMALL: Tree = Tree { trunk: 1.2, reach: 1.5, leaves: 500, leaf: 0.1, seed: 3 };

    #[test]
    fn trees_have_their_leaves_around_the_crown() {
        let (wood, leaves, ends) = tree(&SMALL, &Monitor::default()).unwrap();
        assert_eq!(leaves.triangles.len(), 4 * 500);
        assert_eq!(ends.len(), CHILDREN.iter().product::<u32>() as usize);
        normals_agree(&leaves);
        normals_agree(&wood);
        assert!(leaves.positions.iter().all(|p| p.y > 0.4 && p.y < 4.5 && p.x.abs() < 2.5 && p.z.abs() < 2.5));
        assert!(wood.positions.iter().any(|p| p.y < 0.0));
    }

    #[test]
    fn climbers_hug_their_wall_and_hedges_their_path() {
        let monitor = Monitor::default();
        let mesh = climber(Vec2::ZERO, Vec2::new(4.0, 3.0), 800, 0.1, 5, &monitor).unwrap();
        normals_agree(&mesh);
        assert!(mesh.triangles.len() > 800 && mesh.triangles.len() <= 3200);
        assert!(mesh.positions.iter().all(|p| p.z > -0.1 && p.z < 0.3));
        let path = [Vec3::ZERO, at(1.0, 0.0, 0.0), at(2.0, 0.0, 0.5)];
        let [core, leaves] = hedge(&path, 0.3, 0.4, 300, 1, &monitor).unwrap();
        normals_agree(&core);
        normals_agree(&leaves);
        assert!(leaves.positions.iter().all(|p| p.y > -0.1 && p.y < 0.5));
    }

    #[test]
    fn growing_ends_when_it_is_cancelled() {
        let cancel = Cancel::default();
        cancel.cancel();
        let monitor = Monitor::default().with_cancel(&cancel);
        assert!(matches!(tree(&SMALL, &monitor), Err(crate::Error::Cancelled)));
    }
}
