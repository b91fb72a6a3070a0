// SPDX-License-Identifier: MIT OR Apache-2.0
//! Meshes to build trees over: random, regular and awkward ones.

use glam::Vec3;

/// Positions and triangles.
pub type Mesh = (Vec<Vec3>, Vec<[u32; 3]>);

/// Triangles that share no corners.
pub fn soup(triangles: impl IntoIterator<Item = [Vec3; 3]>) -> Mesh {
    let positions: Vec<Vec3> = triangles.into_iter().flatten().collect();
    let triangles = (0..positions.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    (positions, triangles)
}

/// Random numbers that are the same everywhere (xorshift).
pub struct Random(pub u64);

impl Random {
    /// In `[0, 1)`.
    pub fn unit(&mut self) -> f32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 40) as f32 / (1u64 << 24) as f32
    }

    pub fn point(&mut self, size: f32) -> Vec3 {
        Vec3::new(self.unit(), self.unit(), self.unit()) * size
    }
}

/// `count` triangles of about `size` in a unit cube.
pub fn random_soup(seed: u64, count: usize, size: f32) -> Mesh {
    let mut random = Random(seed);
    soup((0..count).map(|_| {
        let at = random.point(1.0);
        [at + random.point(size), at + random.point(size), at + random.point(size)]
    }))
}

/// A closed sphere of `8 n^2` triangles.
pub fn sphere(n: u32) -> Mesh {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for i in 0..=2 * n {
        for j in 0..2 * n {
            let step = std::f32::consts::PI / (2 * n) as f32;
            let (theta, phi) = (i as f32 * step, j as f32 * 2.0 * step);
            positions.push(Vec3::new(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin()));
            if i < 2 * n {
                let (a, b) = (2 * n * i + j, 2 * n * i + (j + 1) % (2 * n));
                triangles.extend([[a, b, a + 2 * n], [b, b + 2 * n, a + 2 * n]]);
            }
        }
    }
    (positions, triangles)
}

/// A grid of `2 n^2` triangles in the plane where `axis` is `at`.
pub fn flat_grid(n: u32, axis: usize, at: f32) -> Mesh {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for i in 0..=n {
        for j in 0..=n {
            let mut p = [0.0; 3];
            p[axis] = at;
            p[(axis + 1) % 3] = i as f32 * 0.1;
            p[(axis + 2) % 3] = j as f32 * 0.1;
            positions.push(p.into());
            if i < n && j < n {
                let a = i * (n + 1) + j;
                triangles.extend([[a, a + 1, a + n + 1], [a + 1, a + n + 2, a + n + 1]]);
            }
        }
    }
    (positions, triangles)
}

pub fn joined(meshes: impl IntoIterator<Item = Mesh>) -> Mesh {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for (p, t) in meshes {
        let base = positions.len() as u32;
        positions.extend(p);
        triangles.extend(t.into_iter().map(|t| t.map(|corner| corner + base)));
    }
    (positions, triangles)
}

/// Every awkward input that the builder must cope with.
pub fn awkward_meshes() -> Vec<(&'static str, Mesh)> {
    let one = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let slanted = [Vec3::ZERO, Vec3::new(1.0, 0.3, 0.2), Vec3::new(0.1, 1.0, 0.9)];
    let mut random = Random(5);
    let needles: Vec<[Vec3; 3]> = (0..300)
        .map(|_| {
            let (a, b) = (random.point(10.0), random.point(10.0));
            [a, b, b + random.point(1e-5)]
        })
        .collect();
    let huge_and_tiny = joined([
        soup([[Vec3::new(-111.0, 0.0, -111.0), Vec3::new(111.0, 0.0, -111.0), Vec3::new(0.0, 0.0, 111.0)]]),
        {
            let (mut positions, triangles) = random_soup(9, 500, 0.001);
            positions.iter_mut().for_each(|p| *p = *p * 0.05 + Vec3::new(3.0, 0.7, 2.0));
            (positions, triangles)
        },
        flat_grid(10, 1, 0.0),
    ]);
    let nearly_axis_parallel: Vec<[Vec3; 3]> = (0..200)
        .map(|i| {
            let x = 1.0 + (i % 5) as f32 * f32::EPSILON;
            let y = (i / 5) as f32 * 0.01;
            [Vec3::new(x, y, 0.0), Vec3::new(1.0, y + 1.0, f32::EPSILON), Vec3::new(1.0 + f32::EPSILON, y, 1.0)]
        })
        .collect();
    vec![
        ("no triangle", soup([])),
        ("one triangle", soup([one])),
        ("two", soup([one, slanted])),
        ("all corners in the origin", soup([[Vec3::ZERO; 3]; 20])),
        ("points and lines", soup((0..50).map(|i| [Vec3::X * i as f32, Vec3::X * i as f32, Vec3::Y * (i / 2) as f32]))),
        ("3000 equal flat triangles", soup(vec![one; 3000])),
        ("3000 equal slanted triangles", soup(vec![slanted; 3000])),
        ("flat in x", flat_grid(20, 0, 3.7)),
        ("flat in y", flat_grid(20, 1, 0.0)),
        ("flat in z", flat_grid(20, 2, -1e4)),
        ("stacked planes", joined((0..20).map(|i| flat_grid(5, i % 3, i as f32 * 0.025)))),
        ("needles", soup(needles)),
        ("huge and tiny", huge_and_tiny),
        ("nearly axis-parallel", soup(nearly_axis_parallel)),
        ("sphere", sphere(12)),
        ("nested equal spheres", joined([sphere(6), sphere(6), sphere(6)])),
        ("big coordinates", {
            let (mut positions, triangles) = random_soup(3, 200, 0.3);
            positions.iter_mut().for_each(|p| *p *= 7e11);
            (positions, triangles)
        }),
        ("tiny coordinates", {
            let (mut positions, triangles) = random_soup(3, 200, 0.3);
            positions.iter_mut().for_each(|p| *p *= 1e-20);
            (positions, triangles)
        }),
        ("far from the origin", {
            let (mut positions, triangles) = random_soup(4, 300, 0.2);
            positions.iter_mut().for_each(|p| *p = *p * 0.01 + Vec3::splat(1000.0));
            (positions, triangles)
        }),
        ("one far outlier", {
            joined([random_soup(4, 300, 0.2), soup([[Vec3::splat(1e9), Vec3::splat(1.1e9), Vec3::X * 1e9]])])
        }),
        ("random, large", random_soup(1, 300, 1.0)),
        ("random, small", random_soup(2, 3000, 0.05)),
    ]
}

/// The `v` and `f` lines of an OBJ text; faces with more corners become fans.
pub fn positions_and_faces(text: &str) -> Mesh {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for line in text.lines() {
        let mut words = line.split_ascii_whitespace();
        match words.next() {
            Some("v") => {
                let c: Vec<f32> = words.take(3).map(|w| w.parse().unwrap()).collect();
                positions.push(Vec3::new(c[0], c[1], c[2]));
            }
            Some("f") => {
                let number = |w: &str| w.split('/').next().unwrap().parse::<i64>().unwrap();
                let index = |n: i64| if n < 0 { positions.len() as i64 + n } else { n - 1 } as u32;
                let face: Vec<u32> = words.map(|w| index(number(w))).collect();
                triangles.extend((2..face.len()).map(|i| [face[0], face[i - 1], face[i]]));
            }
            _ => {}
        }
    }
    (positions, triangles)
}
