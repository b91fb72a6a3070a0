// SPDX-License-Identifier: MIT OR Apache-2.0
//! The runners: bodies of limbs that flow into each other, in shirts, shorts and shoes.

use glam::{Vec2, Vec3};

use super::at;
use super::parameters::{Parameters, Pose, RunnerPlace};
use crate::scene::builtin::mesh::{Mesh, smooth_path};
use crate::scene::builtin::model::Model;
use crate::scene::builtin::parts::cupboards::Spot;
use crate::scene::builtin::parts::smooth::{Limb, blend, joined, surface};

/// The joints of a runner who looks to +z: of each pair the left one (+x) comes first.
struct Joints {
    waist: Vec3,
    chest: Vec3,
    neck: Vec3,
    head: Vec3,
    hips: [Vec3; 2],
    knees: [Vec3; 2],
    ankles: [Vec3; 2],
    toes: [Vec3; 2],
    shoulders: [Vec3; 2],
    elbows: [Vec3; 2],
    hands: [Vec3; 2],
}

/// The joints in a pose.
fn joints(pose: Pose) -> Joints {
    let right = Joints {
        waist: at(0.0, 1.02, 0.01),
        chest: at(0.0, 1.29, 0.07),
        neck: at(0.0, 1.47, 0.12),
        head: at(0.0, 1.65, 0.165),
        hips: [at(0.088, 0.94, -0.01), at(-0.088, 0.95, 0.02)],
        knees: [at(0.10, 0.57, -0.22), at(-0.10, 0.84, 0.44)],
        ankles: [at(0.10, 0.25, -0.52), at(-0.09, 0.42, 0.36)],
        toes: [at(0.10, 0.045, -0.47), at(-0.09, 0.37, 0.55)],
        shoulders: [at(0.185, 1.415, 0.14), at(-0.185, 1.415, 0.08)],
        elbows: [at(0.27, 1.18, 0.26), at(-0.27, 1.23, -0.13)],
        hands: [at(0.15, 1.36, 0.44), at(-0.25, 1.03, 0.05)],
    };
    let swap = |pair: [Vec3; 2]| [pair[1] * at(-1.0, 1.0, 1.0), pair[0] * at(-1.0, 1.0, 1.0)];
    match pose {
        Pose::Right => right,
        Pose::Left => Joints {
            hips: swap(right.hips),
            knees: swap(right.knees),
            ankles: swap(right.ankles),
            toes: swap(right.toes),
            shoulders: swap(right.shoulders),
            elbows: swap(right.elbows),
            hands: swap(right.hands),
            ..right
        },
        Pose::Wins => Joints {
            chest: at(0.0, 1.30, 0.04),
            neck: at(0.0, 1.48, 0.05),
            head: at(0.0, 1.67, 0.07),
            hips: [at(0.088, 0.95, 0.02), at(-0.088, 0.94, -0.01)],
            knees: [at(0.10, 0.60, 0.27), at(-0.10, 0.56, -0.20)],
            ankles: [at(0.10, 0.16, 0.20), at(-0.10, 0.30, -0.54)],
            toes: [at(0.10, 0.045, 0.39), at(-0.10, 0.10, -0.55)],
            shoulders: [at(0.195, 1.44, 0.05), at(-0.195, 1.44, 0.05)],
            elbows: [at(0.39, 1.63, 0.08), at(-0.37, 1.65, 0.08)],
            hands: [at(0.44, 1.90, 0.10), at(-0.47, 1.91, 0.11)],
            ..right
        },
    }
}

/// A runner's bodies: what is bare, and what is worn.
struct Body {
    joints: Joints,
    bare: Vec<Limb>,
}

impl Body {
    fn new(pose: Pose) -> Self {
        let j = joints(pose);
        let mut bare = trunk(&j);
        bare.push(Limb::new(j.neck - at(0.0, 0.03, 0.01), j.head - at(0.0, 0.06, 0.02), 0.056, 0.050));
        bare.extend(head(j.head));
        for k in 0..2 {
            let side = if k == 0 { 1.0 } else { -1.0 };
            bare.push(thigh(&j, k));
            let calf = j.knees[k].lerp(j.ankles[k], 0.30) + (j.ankles[k] - j.toes[k]).normalize_or(Vec3::Y) * 0.018;
            bare.push(Limb::new(j.knees[k], j.ankles[k], 0.052, 0.034));
            bare.push(Limb::new(calf, j.knees[k].lerp(j.ankles[k], 0.55), 0.050, 0.036));
            bare.push(Limb::new(j.ankles[k], j.toes[k], 0.034, 0.028));
            bare.push(upper_arm(&j, k));
            let wrist = j.elbows[k].lerp(j.hands[k], 0.82);
            bare.push(Limb::new(j.elbows[k], wrist, 0.040, 0.025));
            let reach = (j.hands[k] - j.elbows[k]).normalize();
            bare.push(Limb::new(j.hands[k], j.hands[k] + reach * 0.055, 0.038, 0.031));
            bare.push(Limb::new(j.hands[k], j.hands[k] + reach * 0.035 + at(-side * 0.035, 0.012, 0.02), 0.018, 0.015));
        }
        Body { joints: j, bare }
    }

    fn bare(&self, p: Vec3) -> f32 {
        joined(&self.bare, 0.035, p)
    }

    /// The shirt, whose sleeves end above the elbows.
    fn shirt(&self, p: Vec3) -> f32 {
        let j = &self.joints;
        let trunk: Vec<Limb> = trunk(j).iter().map(|l| l.thicker(0.014)).collect();
        let mut d = joined(&trunk, 0.06, p);
        for k in 0..2 {
            let arm = upper_arm(j, k).thicker(0.017);
            let end = (p - arm.a.lerp(arm.b, 0.62)).dot((arm.b - arm.a).normalize());
            d = blend(d, arm.distance(p).max(end), 0.04);
        }
        let up = (j.chest - j.waist).normalize();
        let collar = j.neck + at(0.0, 0.005, 0.015);
        d.max((j.waist - up * 0.09 - p).dot(up)).max(0.078 - (p - collar).length())
    }

    /// The shorts, which end above the knees.
    fn shorts(&self, p: Vec3) -> f32 {
        let j = &self.joints;
        let mut d =
            Limb::new(j.hips[0] + at(-0.01, 0.04, 0.0), j.hips[1] + at(0.01, 0.04, 0.0), 0.128, 0.128).distance(p);
        for k in 0..2 {
            let leg = thigh(j, k);
            // They widen towards the knee.
            let leg = Limb { ra: leg.ra + 0.018, rb: leg.rb + 0.050, ..leg };
            let end = (p - leg.a.lerp(leg.b, 0.60)).dot((leg.b - leg.a).normalize());
            d = blend(d, leg.distance(p).max(end), 0.03);
        }
        d.max(p.y - j.waist.y - 0.03)
    }

    /// Both shoes.
    fn shoes(&self, p: Vec3) -> f32 {
        let j = &self.joints;
        let mut least = f32::MAX;
        for k in 0..2 {
            let (ankle, toe) = (j.ankles[k], j.toes[k]);
            let forth = (toe - ankle).normalize();
            let shin = (j.knees[k] - ankle).normalize();
            let heel = ankle - shin * 0.055 - (forth - shin * forth.dot(shin)).normalize_or(Vec3::Z) * 0.035;
            let shoe = [
                Limb::new(ankle - shin * 0.01, heel, 0.046, 0.040),
                Limb::new(heel, toe, 0.040, 0.040),
                Limb::new(ankle - shin * 0.02, toe, 0.045, 0.036),
            ];
            let collar = (p - ankle - shin * 0.018).dot(shin);
            least = least.min(joined(&shoe, 0.03, p).max(collar));
        }
        // The ground presses the soles flat.
        least.max(0.004 - p.y)
    }

    /// Hair from the brow to the neck.
    fn hair(&self, p: Vec3) -> f32 {
        let c = self.joints.head;
        let cap = [
            Limb::new(c + at(0.0, 0.020, -0.022), c + at(0.0, 0.030, 0.016), 0.112, 0.102),
            Limb::new(c + at(0.0, 0.0, -0.045), c + at(0.0, -0.05, -0.055), 0.085, 0.060),
        ];
        let brow = (c + at(0.0, 0.050, 0.050) - p).dot(at(0.0, 0.66, -0.75));
        joined(&cap, 0.03, p).max(brow)
    }
}

/// Pelvis, belly, chest and shoulders.
fn trunk(j: &Joints) -> Vec<Limb> {
    let mut limbs = vec![Limb::new(j.hips[0] + at(-0.02, 0.03, 0.0), j.hips[1] + at(0.02, 0.03, 0.0), 0.105, 0.105)];
    let wide = at(0.055, 0.0, 0.0);
    for side in [-1.0, 1.0] {
        limbs.push(Limb::new(j.waist + wide * side, j.chest + wide * (1.35 * side), 0.092, 0.105));
    }
    let top = j.chest + (j.neck - j.chest) * 0.45;
    for shoulder in j.shoulders {
        limbs.push(Limb::new(top, shoulder, 0.085, 0.062));
        limbs.push(Limb::new(j.neck, shoulder, 0.050, 0.050));
    }
    limbs
}

fn thigh(j: &Joints, k: usize) -> Limb {
    Limb::new(j.hips[k], j.knees[k], 0.092, 0.056)
}

fn upper_arm(j: &Joints, k: usize) -> Limb {
    Limb::new(j.shoulders[k], j.elbows[k], 0.056, 0.040)
}

/// Skull, jaw, nose and ears about the head's middle.
fn head(c: Vec3) -> Vec<Limb> {
    vec![
        Limb::new(c + at(0.0, 0.020, -0.020), c + at(0.0, 0.025, 0.010), 0.100, 0.092),
        Limb::new(c + at(0.0, -0.01, 0.015), c + at(0.0, -0.085, 0.045), 0.080, 0.042),
        Limb::new(c + at(0.0, 0.010, 0.098), c + at(0.0, -0.025, 0.118), 0.010, 0.015),
        Limb::new(c + at(0.090, 0.012, -0.005), c + at(0.088, -0.02, 0.0), 0.018, 0.012),
        Limb::new(c + at(-0.090, 0.012, -0.005), c + at(-0.088, -0.02, 0.0), 0.018, 0.012),
    ]
}

/// Glasses against the sun: their two lenses, and their frame.
fn glasses(c: Vec3) -> [Mesh; 2] {
    let (mut lenses, mut frame) = (Mesh::default(), Mesh::default());
    for side in [-1.0, 1.0] {
        let lens = Mesh::sphere(1.0, 20, 10).stretched(at(0.034, 0.022, 0.008)).turned_y(side * 0.055);
        lenses.append(&lens.moved(c + at(side * 0.040, 0.016, 0.101)));
        let arm = [at(side * 0.072, 0.020, 0.094), at(side * 0.099, 0.020, 0.055), at(side * 0.112, 0.018, -0.01)];
        let arm: Vec<Vec3> = arm.iter().map(|&p| c + p).collect();
        frame.append(&Mesh::tube(&smooth_path(&arm, 4, false), 0.0045, 6, false));
    }
    let bridge = [c + at(-0.012, 0.024, 0.109), c + at(0.0, 0.028, 0.114), c + at(0.012, 0.024, 0.109)];
    frame.append(&Mesh::tube(&smooth_path(&bridge, 3, false), 0.0045, 6, false));
    [lenses, frame]
}

/// Adds the runners.
pub fn add(model: &mut Model, p: &Parameters) {
    for (n, place) in p.runners.iter().enumerate() {
        runner(model, n + 1, place, p.cell);
    }
}

fn runner(model: &mut Model, n: usize, place: &RunnerPlace, cell: f32) {
    let body = Body::new(place.pose);
    let spot = Spot::new(place.turns, at(place.at[0], 0.0, place.at[1]));
    let (lo, hi) = (at(-0.62, -0.05, -0.80), at(0.62, 2.06, 0.75));
    let mut skin = surface(lo, hi, cell, |q| body.bare(q));
    // What is worn hides what is below it.
    let hidden: Vec<bool> = skin
        .positions
        .iter()
        .map(|&q| body.shirt(q).min(body.shorts(q)).min(body.shoes(q)).min(body.hair(q)) < -0.006)
        .collect();
    skin.triangles.retain(|t| !t.iter().all(|&i| hidden[i as usize]));
    let mut shirt = surface(lo, hi, cell, |q| body.shirt(q));
    // The number is painted on the breast.
    for (t, q) in shirt.texcoords.iter_mut().zip(&shirt.positions) {
        *t = Vec2::new(0.5 + q.x / 0.8, (q.y - 0.86) / 0.8);
    }
    let shorts = surface(lo, hi, cell, |q| body.shorts(q));
    let shoes = surface(lo, hi, 0.8 * cell, |q| body.shoes(q));
    let c = body.joints.head;
    let hair = surface(c - Vec3::splat(0.2), c + Vec3::splat(0.2), 0.7 * cell, |q| body.hair(q));
    let [lenses, frame] = glasses(c);
    for (what, material, mesh) in [
        ("skin", format!("skin-{n}"), skin),
        ("shirt", format!("shirt-{n}"), shirt),
        ("shorts", format!("shorts-{n}"), shorts),
        ("shoes", format!("shoes-{n}"), shoes),
        ("hair", format!("hair-{n}"), hair),
        ("lenses", "lenses".into(), lenses),
        ("frame", "black-plastic".into(), frame),
    ] {
        model.add(format!("runner-{n}-{what}"), &material, spot.put(mesh));
    }
}
