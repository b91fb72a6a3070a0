// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a report measures: a list of measurements, each with an id by which tables find it.

use crate::analysis::report::published;
use crate::analysis::report::recipe::{MIRRORS, Recipe, VIEWS};
use crate::method::options::*;
use crate::scene::builtin;

/// The built-in scenes of a report, each with the paper's scene whose place it takes.
pub const SIX: [(&str, &str); 6] = [
    ("cafe", published::SCENES[0]),
    ("runner", published::SCENES[1]),
    ("kitchen", published::SCENES[2]),
    ("conference", published::SCENES[3]),
    ("bathroom", published::SCENES[4]),
    ("courtyard", published::SCENES[5]),
];

/// The scenes of a report for which none are named: those of the six that this library has.
pub fn built_in_scenes() -> Vec<String> {
    SIX.iter().map(|(name, _)| (*name).to_owned()).filter(|name| builtin::NAMES.contains(&name.as_str())).collect()
}

/// How much a report measures.
#[derive(Debug, Clone, PartialEq)]
pub struct Extent {
    /// The scenes: names of built-in ones, or paths.
    pub scenes: Vec<String>,
    /// Side of the pictures of the main tables, in pixels.
    pub main_side: u32,
    /// Side of the pictures that are shown, and of ablation, sweeps and the wave model.
    pub shown_side: u32,
    /// Side of the pictures that are drawn with 1, 2x2 and 4x4 samples.
    pub sampled_side: u32,
    /// Sides of the scaling table.
    pub scaled_sides: Vec<u32>,
    /// Side of the picture of thin rods.
    pub rods_side: u32,
    /// Into n x n parts each triangle of `spheres` is cut, for each step of the scaling with triangles.
    pub finer: Vec<u32>,
    /// Timed frames of each kind.
    pub repeats: u32,
}

impl Extent {
    /// Everything, on these scenes.
    pub fn whole(scenes: Vec<String>) -> Self {
        Extent {
            scenes,
            main_side: 1024,
            shown_side: 512,
            // As in the paper: what supersampling does depends on the picture's size.
            sampled_side: 1024,
            scaled_sides: vec![256, 512, 1024, 2048],
            rods_side: 256,
            finer: vec![1, 2, 5, 12, 26],
            repeats: 5,
        }
    }

    /// Everything in small pictures.
    pub fn quick(scenes: Vec<String>) -> Self {
        Extent { sampled_side: 512, finer: vec![1, 2, 5, 8], repeats: 3, ..Extent::whole(scenes) }.with_side(192)
    }

    /// The same with main pictures of another side, and all others smaller or larger with them.
    #[must_use]
    pub fn with_side(self, side: u32) -> Self {
        let at_least = |side: u32| side.max(8);
        let mut scaled_sides = [side / 4, side / 2, side, 2 * side].map(at_least).to_vec();
        scaled_sides.dedup();
        let sampled_side = u64::from(self.sampled_side) * u64::from(side) / u64::from(self.main_side);
        Extent {
            main_side: side,
            shown_side: side.clamp(8, 512),
            sampled_side: at_least(u32::try_from(sampled_side).unwrap_or(side)),
            scaled_sides,
            rods_side: side.clamp(16, 256),
            ..self
        }
    }
}

/// Which pictures a measurement writes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shown {
    /// None.
    Nothing,
    /// The adaptive picture.
    Adaptive,
    /// The full and the adaptive one.
    Both,
    /// Those, ten times the difference, the classes, the failed tests together and each by itself.
    Everything,
}

/// One measurement.
#[derive(Debug, Clone, PartialEq)]
pub struct Case<'a> {
    /// By which tables find it.
    pub id: String,
    /// The scene.
    pub recipe: Recipe<'a>,
    /// The adaptive frame.
    pub options: RenderOptions,
    /// Timed frames of each kind; 0: none.
    pub repeats: u32,
    /// Whether waves are modelled.
    pub waves: bool,
    /// The pictures that it writes.
    pub shown: Shown,
}

impl Case<'_> {
    /// Roughly what it costs, for the time that remains. The unit is a sample of a frame.
    pub fn weight(&self) -> f64 {
        let (width, height) = self.options.sample_size();
        let samples = f64::from(width) * f64::from(height);
        // Loading a scene and building its tree counts as a small frame.
        4e4 + samples * (2.0 + 1.8 * f64::from(self.repeats) + if self.waves { 3.0 } else { 0.0 })
    }
}

/// A method with what tables call it.
pub type Variant = (&'static str, Method);

/// The methods whose correction the correction table compares.
pub fn corrections() -> [Variant; 4] {
    let balanced = Method::balanced();
    let off = Method { correction: Correction::Off, ..balanced };
    let paper = Method { correction: balanced.correction.comparing(Compared::PAPER), ..balanced };
    let sweeps = Method { correction: balanced.correction.spreading(Spread::Sweeps), ..balanced };
    [("off", off), ("objects and shadows, as in the paper", paper), ("one round", sweeps), ("converged", balanced)]
}

/// The presets.
pub fn presets() -> [Variant; 3] {
    [("balanced", Method::balanced()), ("fast", Method::fast()), ("paper", Method::paper())]
}

/// `balanced` with each test switched off.
pub fn ablations() -> [Variant; 7] {
    Test::ALL.map(|test| {
        let mut method = Method::balanced();
        method.checks.tests = method.checks.tests.without(test);
        (test.name(), method)
    })
}

/// Factors by which the quality table scales the tolerances of each preset.
pub const FACTORS: [f32; 4] = [0.5, 1.0, 2.0, 4.0];

/// `method` with both levels' tolerances scaled: distances and slopes times `factor`, and as much farther from 1 the dot
/// product.
pub fn scaled(mut method: Method, factor: f32) -> Method {
    for t in [&mut method.checks.fine, &mut method.checks.coarse] {
        let t_norm = 1.0 - factor * (1.0 - t.t_norm);
        *t = Tolerances {
            t_pos: factor * t.t_pos,
            t_norm,
            t_conv: (factor * t.t_conv).min(1.0),
            t_gcol: factor * t.t_gcol,
            ..*t
        };
    }
    method
}

/// The measurements of a report, scene by scene.
pub fn cases(extent: &Extent) -> Vec<Case<'_>> {
    let mut cases = Vec::new();
    let mut add = |id: String, recipe, side: u32, samples: u32, method: Method, repeats, shown| {
        let options = RenderOptions { width: side, height: side, samples, method, ..RenderOptions::default() };
        let waves = shown == Shown::Everything;
        cases.push(Case { id, recipe, options, repeats, waves, shown });
    };
    let off = corrections()[0].1;
    for scene in &extent.scenes {
        let recipe = Recipe::AsItIs(scene);
        for (name, method) in presets() {
            let id = format!("presets/{name}/{scene}");
            add(id, recipe, extent.main_side, 1, method, extent.repeats, Shown::Nothing);
        }
        for (name, method) in corrections() {
            let repeats = if name == "off" { extent.repeats } else { 0 };
            add(format!("correction/{name}/{scene}"), recipe, extent.main_side, 1, method, repeats, Shown::Nothing);
        }
        for samples in [1, 2, 4] {
            let id = format!("samples/{samples}/{scene}");
            add(id, recipe, extent.sampled_side, samples, Method::balanced(), extent.repeats.min(2), Shown::Nothing);
        }
        let side = extent.shown_side;
        add(format!("shown/balanced/{scene}"), recipe, side, 1, Method::balanced(), 0, Shown::Everything);
        add(format!("shown/off/{scene}"), recipe, side, 1, off, 0, Shown::Adaptive);
        for (name, method) in ablations() {
            add(format!("ablation/{name}/{scene}"), recipe, side, 1, method, 0, Shown::Nothing);
        }
        for (name, method) in presets() {
            for factor in FACTORS {
                let id = format!("quality/{name}/{factor}/{scene}");
                add(id, recipe, side, 1, scaled(method, factor), 0, Shown::Nothing);
            }
        }
        if is_scaled(scene, &extent.scenes) {
            for &side in &extent.scaled_sides {
                let repeats = if side > 1024 { 1 } else { extent.repeats };
                add(format!("pixels/{side}/{scene}"), recipe, side, 1, Method::balanced(), repeats, Shown::Nothing);
            }
        }
    }
    let side = extent.shown_side;
    let balanced = Method::balanced();
    for steps in 1..=MIRRORS.len() {
        let recipe = Recipe::Mirrors(steps);
        add(format!("mirrors/{steps}"), recipe, side, 1, balanced, extent.repeats, Shown::Adaptive);
    }
    for view in 0..VIEWS.len() {
        add(format!("views/{view}"), Recipe::View(view), side, 1, balanced, extent.repeats, Shown::Adaptive);
    }
    for &parts in &extent.finer {
        add(format!("finer/{parts}"), Recipe::Finer(parts), side, 1, balanced, extent.repeats, Shown::Nothing);
    }
    for samples in [1, 4] {
        let (recipe, side) = (Recipe::AsItIs("rods"), extent.rods_side);
        add(format!("rods/off/{samples}"), recipe, side, samples, off, 0, Shown::Adaptive);
        add(format!("rods/balanced/{samples}"), recipe, side, samples, balanced, 0, Shown::Both);
    }
    cases
}

/// The scenes of the scaling table: the paper's two, or all where neither is among them.
pub fn is_scaled(scene: &str, scenes: &[String]) -> bool {
    let two = ["kitchen", "bathroom"];
    two.contains(&scene) || !scenes.iter().any(|s| two.contains(&s.as_str()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_measurement_has_its_own_id_and_valid_options() {
        for extent in [
            Extent::whole(built_in_scenes()),
            Extent::quick(vec!["a".into(), "b".into()]),
            Extent::quick(vec!["a".into()]).with_side(16),
        ] {
            let cases = cases(&extent);
            let ids: BTreeSet<&str> = cases.iter().map(|case| case.id.as_str()).collect();
            assert_eq!(ids.len(), cases.len());
            for case in &cases {
                assert!(case.options.validate().is_ok(), "{}: {:?}", case.id, case.options);
                assert!(case.weight() > 0.0);
            }
        }
    }

    #[test]
    fn the_scenes_are_those_that_exist_in_the_papers_order() {
        let scenes = built_in_scenes();
        assert!(scenes.contains(&"cafe".to_owned()) && !scenes.is_empty());
        assert!(scenes.iter().all(|name| builtin::NAMES.contains(&name.as_str())));
    }

    #[test]
    fn scaling_moves_every_tolerance_one_way() {
        let method = scaled(Method::paper(), 2.0);
        let (loose, paper) = (method.checks.fine, Method::paper().checks.fine);
        assert!(loose.t_pos > paper.t_pos && loose.t_norm < paper.t_norm && loose.t_conv > paper.t_conv);
        assert!(loose.t_gcol > paper.t_gcol);
        // 0.9 is not exact in binary.
        assert!((scaled(Method::paper(), 1.0).checks.fine.t_norm - paper.t_norm).abs() < 1e-6);
    }
}
