// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a material is: the decision from everything that its MTL entry and the lists of `view.json` say.
//!
//! `illum` alone proves nothing. Maya writes 4 for everything, Cinema 4D 7, Blender 3 for each trace of metal, and most
//! exporters 2 for glass; renderers that people trust (three.js, assimp, Blender's importer) go by `d` and hardly look at
//! `illum`. So `illum` counts only together with a key that says the same. The lists of `view.json` override all of it.
//!
//! [`RULES`] is the table: the first rule that applies decides. [`Finish`] then reads the colours for that surface.

use std::collections::HashSet;

use glam::Vec3;

use super::mtl::MtlMaterial;
use super::view::ViewFile;
use crate::scene::{Material, MaterialNote, Surface};

/// From this opacity on a material is solid: exporters round.
const SOLID: f32 = 0.999;

/// A surface as dark as this has no colour of its own: mirrors and glasses of the Cornell boxes in the McGuire archive
/// have `Kd 0.01`.
const DARK: f32 = 0.1;

/// A coloured surface with a lower exponent than this is too dull for a mirror (Blender: roughness above 0.9).
const DULL: f32 = 10.0;

/// Exponent of a highlight where the file gives none: that of three.js.
const USUAL_SHININESS: f32 = 30.0;

/// The same on mirrors and glass: the upper end of the format's usual range.
const POLISHED_SHININESS: f32 = 1000.0;

/// What there is to decide by.
#[derive(Debug, Clone, Copy)]
pub(super) struct Evidence<'a> {
    m: &'a MtlMaterial,
    /// In the list of mirrors, glass bodies, panes; `None`: no list says anything about it.
    listed: Option<Surface>,
    /// A list of glass or panes exists: no other material is see-through.
    glass_is_listed: bool,
    /// A list of mirrors exists: no other material is a mirror.
    mirrors_are_listed: bool,
    /// From `d` and `Tr`.
    opacity: Option<f32>,
}

impl Evidence<'_> {
    fn illum(&self, models: &[u8]) -> bool {
        self.m.illumination_model.is_some_and(|i| models.contains(&i))
    }

    /// Lets light through by `d` or `Tr`, and not because of holes.
    fn see_through(&self) -> bool {
        !self.glass_is_listed && self.opacity.is_some_and(|o| o < SOLID) && self.m.cutout_map.is_none()
    }

    fn index_of_refraction(&self) -> f32 {
        self.m.index_of_refraction.unwrap_or(Material::default().index_of_refraction)
    }

    /// Bends light: `Ni` is given and above 1. (Maya writes `Ni 1` for everything.)
    fn bends_light(&self) -> bool {
        self.m.index_of_refraction.is_some_and(|n| n > 1.0)
    }

    fn has_own_colour(&self) -> bool {
        self.m.diffuse_map.is_some() || self.m.diffuse.is_none_or(|kd| kd.max_element() > DARK)
    }

    fn reflects(&self) -> bool {
        self.m.specular.is_some_and(|ks| ks.max_element() > 0.0)
    }

    fn is_dull(&self) -> bool {
        self.has_own_colour() && self.m.shininess.is_some_and(|ns| ns < DULL)
    }
}

/// One row of the table.
struct Rule {
    applies: fn(&Evidence) -> bool,
    becomes: Surface,
    /// For people, after the kind of surface; empty where nothing needs to be said.
    because: &'static str,
}

const LISTED: &str = "listed in view.json";

/// What a material becomes: the first rule that applies.
const RULES: [Rule; 10] = [
    // The lists are the user's own words about this scene.
    Rule { applies: |e| e.listed == Some(Surface::ThinGlass), becomes: Surface::ThinGlass, because: LISTED },
    Rule { applies: |e| e.listed == Some(Surface::Glass), becomes: Surface::Glass, because: LISTED },
    Rule { applies: |e| e.listed == Some(Surface::Mirror), becomes: Surface::Mirror, because: LISTED },
    // Two keys agree, and of the models only 6 and 7 refract by the format's specification.
    Rule {
        applies: |e| e.see_through() && e.illum(&[6, 7]) && e.index_of_refraction() > 1.0,
        becomes: Surface::Glass,
        because: "d or Tr below 1 and illum asks for refraction",
    },
    // Models 3 and 5 are ray-traced reflection, and `Ks` is what they reflect: none, no mirror. A coloured surface with a
    // very wide highlight is rough metal, which a mirror would misrepresent.
    Rule {
        applies: |e| !e.mirrors_are_listed && e.illum(&[3, 5]) && e.reflects() && !e.is_dull(),
        becomes: Surface::Mirror,
        because: "illum asks for reflection and Ks has a colour",
    },
    // Every renderer that is trusted draws `d 0.3` see-through, whatever `illum` says: as a sheet, for most are panes
    // or films without a thickness.
    Rule { applies: |e| e.see_through(), becomes: Surface::ThinGlass, because: "d or Tr below 1" },
    // Ray tracers' own scenes leave `d` out (rightSphere of the McGuire archive: Kd 0.01, Ni 2.5, illum 7). Exporters'
    // ordinary materials have a colour, or `Ni 1`, or none.
    Rule {
        applies: |e| {
            !e.glass_is_listed
                && e.illum(&[4, 6, 7, 9])
                && e.opacity.is_none()
                && e.m.cutout_map.is_none()
                && e.bends_light()
                && !e.has_own_colour()
        },
        becomes: Surface::Glass,
        because: "illum asks for glass, Ni is above 1, and it has no colour of its own",
    },
    // Maya's and Cinema 4D's ordinary materials.
    Rule {
        applies: |e| !e.glass_is_listed && e.illum(&[4, 6, 7, 9]),
        becomes: Surface::Opaque,
        because: "illum asks for glass, no other key does; list it in view.json if it is glass",
    },
    Rule {
        applies: |e| !e.mirrors_are_listed && e.illum(&[3, 5]),
        becomes: Surface::Opaque,
        because: "illum asks for a mirror, but Ks is 0 or Ns too low for one; list it in view.json if it is a mirror",
    },
    Rule { applies: |_| true, becomes: Surface::Opaque, because: "" },
];

/// Opacity by `d` and `Tr`, and what is odd about them. `None`: the file does not say.
fn opacity(m: &MtlMaterial) -> (Option<f32>, Option<&'static str>) {
    match (m.dissolve, m.transparency) {
        // MeshLab writes opacity under this name, hence 1 for whatever is solid; and nobody exports what cannot be seen.
        (None, Some(t)) if t > SOLID => (None, Some("Tr 1 without d is taken for solid, as MeshLab means it")),
        (None, Some(t)) => (Some(1.0 - t), None),
        // `d` is in the format's specification, `Tr` is not and is inverted by some; but where one of them hides the
        // material altogether, the other is believed.
        (Some(d), Some(t)) if (d - (1.0 - t)).abs() > 0.01 => {
            let told = Some("d and Tr contradict each other; d counts, unless it is 0");
            (Some(if d > 1.0 - SOLID { d } else { 1.0 - t }), told)
        }
        (Some(d), _) if d <= 1.0 - SOLID => (Some(d), Some("d 0 cannot be seen; write d 1 if it is solid")),
        (d, _) => (d, None),
    }
}

/// A material decided on, without its textures.
pub(super) struct Finish {
    /// The material.
    pub material: Material,
    /// What there is to say about it.
    pub note: MaterialNote,
}

impl Finish {
    fn decide(e: &Evidence, texture_loaded: bool, oddity: Option<&'static str>) -> Self {
        // The last rule always applies.
        let rule = RULES.iter().find(|rule| (rule.applies)(e)).unwrap_or(&RULES[RULES.len() - 1]);
        let (m, surface) = (e.m, rule.becomes);
        let base = Material::default();
        let mut mended: Vec<&'static str> = oddity.into_iter().collect();
        let by_list = rule.because == LISTED;

        let diffuse = match m.diffuse {
            // Maya's exporter: the texture replaces the colour. Nobody wants a black texture.
            Some(kd) if kd == Vec3::ZERO && m.diffuse_map.is_some() && surface != Surface::Mirror => {
                mended.push("Kd 0 with a texture: the texture is drawn as it is");
                if texture_loaded { Vec3::ONE } else { base.diffuse }
            }
            Some(kd) => kd,
            // A picture without `Kd` shows as it is.
            None if m.diffuse_map.is_some() => Vec3::ONE,
            None => base.diffuse,
        };

        let polished = surface != Surface::Opaque;
        let mut specular = m.specular.unwrap_or(base.specular);
        let shines = specular.max_element() > 0.0;
        // Models 0 and 1 have no highlight by the format's specification.
        if shines && surface != Surface::Mirror && !by_list && e.illum(&[0, 1]) {
            specular = Vec3::ZERO;
            mended.push("illum 0 and 1 have no highlight: Ks is not used");
        }
        let shininess = match m.shininess {
            Some(ns) if ns >= 1.0 => ns,
            _ if polished => POLISHED_SHININESS,
            // A highlight wider than the diffuse lobe is none: exporters that know none write Ks 1 and Ns 0, and a power
            // of 0 would paint everything white.
            Some(_) => {
                if specular.max_element() > 0.0 {
                    specular = Vec3::ZERO;
                    mended.push("Ns below 1 is no highlight: Ks is not used");
                }
                base.shininess
            }
            None if shines => USUAL_SHININESS,
            None => base.shininess,
        };
        if by_list && surface == Surface::Mirror && !shines {
            mended.push("a mirror with Ks 0 reflects nothing; set Ks");
        }

        // A pane shows as much of its own colour as it is opaque; a body of glass too, if it has any.
        let opacity = match surface {
            Surface::ThinGlass | Surface::Glass if by_list => 0.0,
            Surface::Glass if !e.has_own_colour() => 0.0,
            Surface::ThinGlass | Surface::Glass => e.opacity.unwrap_or(0.0),
            Surface::Opaque | Surface::Mirror => base.opacity,
        };
        let transmission = match m.transmission {
            // Glass that lets nothing through is what 3ds Max writes for materials without a filter.
            Some(tf) if !by_list && tf == Vec3::ZERO && polished => {
                mended.push("Tf 0 is not used: glass that lets no light through is not meant");
                Vec3::ONE
            }
            // A grey filter says `d` again.
            Some(tf) if !by_list && opacity > 0.0 && tf.max_element() - tf.min_element() < 0.01 => Vec3::ONE,
            Some(tf) => tf,
            None => base.transmission,
        };
        let emission = match m.emission {
            Some(ke) if ke != Vec3::ZERO && m.has_emission_map => {
                mended.push("Ke with map_Ke is not used: no picture shines");
                base.emission
            }
            Some(ke) if ke != Vec3::ZERO => {
                mended.push("Ke: it shines, but lights nothing else; place lights in view.json");
                ke
            }
            _ => base.emission,
        };
        let index_of_refraction = match surface {
            // Models below 3 ask for no reflection: a film, not a pane.
            Surface::ThinGlass if !by_list && !e.illum(&[3, 4, 5, 6, 7, 9]) => 1.0,
            _ => e.index_of_refraction(),
        };
        let material = Material {
            name: m.name.clone(),
            diffuse,
            specular,
            shininess,
            transmission,
            emission,
            index_of_refraction,
            opacity,
            surface,
            ..base
        };
        let note = MaterialNote {
            material: m.name.clone(),
            surface,
            because: rule.because,
            cutout_because: "",
            keys: keys_of(m),
            mended,
        };
        Finish { material, note }
    }
}

/// The keys that decide, as the file has them.
fn keys_of(m: &MtlMaterial) -> String {
    let mut keys = Vec::new();
    let mut number = |key: &str, value: Option<f32>| keys.extend(value.map(|v| format!("{key} {v}")));
    number("illum", m.illumination_model.map(f32::from));
    number("d", m.dissolve);
    number("Tr", m.transparency);
    number("Ni", m.index_of_refraction);
    number("Ns", m.shininess);
    for (key, colour) in [("Kd", m.diffuse), ("Ks", m.specular), ("Tf", m.transmission), ("Ke", m.emission)] {
        keys.extend(colour.map(|c| format!("{key} {} {} {}", c.x, c.y, c.z)));
    }
    keys.join(", ")
}

/// The name lists of a view.
pub(super) struct Kinds<'a> {
    lists: [(&'static str, Option<HashSet<&'a str>>); 4],
}

const MIRROR: usize = 0;
const GLASS: usize = 1;
const THIN_GLASS: usize = 2;
const MASKED: usize = 3;

impl<'a> Kinds<'a> {
    pub(super) fn new(view: &'a ViewFile) -> Self {
        fn set(names: &Option<Vec<String>>) -> Option<HashSet<&str>> {
            names.as_ref().map(|n| n.iter().map(String::as_str).collect())
        }
        Kinds {
            lists: [
                ("mirror_materials", set(&view.mirror_materials)),
                ("glass_materials", set(&view.glass_materials)),
                ("thin_glass_materials", set(&view.thin_glass_materials)),
                ("alpha_masked_materials", set(&view.alpha_masked_materials)),
            ],
        }
    }

    fn exists(&self, kind: usize) -> bool {
        self.lists[kind].1.is_some()
    }

    fn lists(&self, kind: usize, name: &str) -> bool {
        self.lists[kind].1.as_ref().is_some_and(|list| list.contains(name))
    }

    /// Whether `alpha_masked_materials` has `name`; `None`: there is no such list.
    pub(super) fn masked(&self, name: &str) -> Option<bool> {
        self.exists(MASKED).then(|| self.lists(MASKED, name))
    }

    /// What `m` becomes. `texture_loaded`: its `map_Kd` was found.
    pub(super) fn decide(&self, m: &MtlMaterial, texture_loaded: bool, warnings: &mut Vec<String>) -> Finish {
        let name = &m.name;
        let listed = match (self.lists(THIN_GLASS, name), self.lists(GLASS, name), self.lists(MIRROR, name)) {
            (true, _, _) => Some(Surface::ThinGlass),
            (_, true, _) => Some(Surface::Glass),
            (_, _, true) => Some(Surface::Mirror),
            _ => None,
        };
        if self.lists(MIRROR, name) && listed != Some(Surface::Mirror) {
            warnings.push(format!("view.json: material `{name}` is listed as mirror and as glass; drawn as glass"));
        }
        let (opacity, oddity) = opacity(m);
        let evidence = Evidence {
            m,
            listed,
            glass_is_listed: self.exists(GLASS) || self.exists(THIN_GLASS),
            mirrors_are_listed: self.exists(MIRROR),
            opacity,
        };
        let finish = Finish::decide(&evidence, texture_loaded, oddity);
        if finish.material.surface == Surface::Opaque
            && m.cutout_map.is_none()
            && let Some(opacity) = opacity.filter(|&o| o < SOLID)
        {
            warnings.push(format!(
                "material `{name}` has opacity {opacity} and is drawn opaque; list it in view.json under thin_glass_materials"
            ));
        }
        finish
    }

    /// Names the entries of the lists that no material has.
    pub(super) fn tell_unknown(
        &self,
        view: &std::path::Path,
        known: impl Fn(&str) -> bool,
        warnings: &mut Vec<String>,
    ) {
        for (key, list) in &self.lists {
            let mut unknown: Vec<&str> = list.iter().flatten().copied().filter(|name| !known(name)).collect();
            unknown.sort_unstable();
            if !unknown.is_empty() {
                let (at, names) = (view.display(), unknown.iter().map(|n| format!("`{n}`")).collect::<Vec<_>>());
                warnings.push(format!("{at}: {key}: no material is named {}", names.join(", ")));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::scene::Surface::{Glass, Mirror, Opaque, ThinGlass};

    /// The material that these lines of an MTL file and keys of a `view.json` make; its textures are found.
    fn decided(mtl: &str, view: &str) -> (Material, MaterialNote, Vec<String>) {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("m.mtl");
        std::fs::write(&path, format!("newmtl a\n{}\n", mtl.replace("; ", "\n"))).unwrap();
        let (mut warnings, mut unused) = (Vec::new(), Vec::new());
        let source = super::super::source::Source::Disk { confined_to: None, opened: Default::default() };
        let materials = super::super::mtl::read(&source, &path, &mut warnings, &mut unused).unwrap();
        let view =
            super::super::view::parse(std::path::Path::new("view.json"), &format!("{{{view}}}"), glam::DVec3::ZERO)
                .unwrap();
        let m = &materials[0];
        let finish = Kinds::new(&view).decide(m, m.diffuse_map.is_some(), &mut warnings);
        (finish.material, finish.note, warnings)
    }

    #[track_caller]
    fn becomes(mtl: &str, view: &str, surface: Surface, because: &str) -> Material {
        let (material, note, _) = decided(mtl, view);
        assert_eq!(material.surface, surface, "{mtl} with {view}: {note:?}");
        assert_eq!(note.surface, surface);
        assert!(note.because.contains(because) && note.because.is_empty() == because.is_empty(), "{mtl}: {note:?}");
        material
    }

    #[test]
    fn what_exporters_write_for_ordinary_materials_is_opaque() {
        let only_illum = "illum asks for glass, no other key does";
        // Maya, with a texture and with a colour; Cinema 4D.
        let maya = becomes("illum 4; Kd 0 0 0; Ka 0 0 0; Tf 1 1 1; map_Kd t.png; Ni 1.00", "", Opaque, only_illum);
        assert_eq!(maya.diffuse, Vec3::ONE);
        becomes("illum 4; Kd .8 .2 .2; Tf 1 1 1; Ni 1", "", Opaque, only_illum);
        becomes("illum 4; Kd 0 0 0; Ks .5 .5 .5; Ns 20; Ni 1", "", Opaque, only_illum);
        becomes("illum 7; Kd .9 .9 .1; Ks 1 1 1; Ns 50", "", Opaque, only_illum);
        // Any of the four models, with a colour, with `d 1`, with a mask.
        for illum in [4, 6, 7, 9] {
            becomes(&format!("illum {illum}"), "", Opaque, only_illum);
            becomes(&format!("illum {illum}; Kd .5 .5 .5; Ni 1.5"), "", Opaque, only_illum);
            becomes(&format!("illum {illum}; Kd 0 0 0; Ni 1.5; map_Kd t.png"), "", Opaque, only_illum);
            becomes(&format!("illum {illum}; Kd 0 0 0; Ni 1.5; d 1"), "", Opaque, only_illum);
            becomes(&format!("illum {illum}; Kd 0 0 0; Ni 1.5; map_d m.png; d .5"), "", Opaque, only_illum);
        }
        // 3ds Max, Blender.
        becomes("Ns 10; Ni 1.5; d 1; Tr 0; Tf 1 1 1; illum 2; Kd .6 .6 .6; Ks 0 0 0", "", Opaque, "");
        becomes("Ns 250; Ka 1 1 1; Kd .8 .8 .8; Ks .5 .5 .5; Ke 0 0 0; Ni 1.45; d 1; illum 2", "", Opaque, "");
        for illum in [0, 1, 2, 8, 10] {
            becomes(&format!("illum {illum}; Ks 1 1 1; Ns 50; Kd .5 .5 .5"), "", Opaque, "");
        }
        becomes("", "", Opaque, "");
    }

    #[test]
    fn light_of_its_own_has_the_colour_of_ke_and_is_told() {
        let (lamp, note, _) = decided("Kd 0 0 0; Ke 30 20 10", "");
        assert_eq!((lamp.emission, lamp.surface), (Vec3::new(30.0, 20.0, 10.0), Opaque));
        assert!(note.mended.iter().any(|m| m.contains("lights nothing else")), "{note:?}");
        let (dark, note, _) = decided("Kd 0 0 0; Ke 0 0 0; map_Ke t.png", "");
        assert!(dark.emission == Vec3::ZERO && note.mended.is_empty(), "{note:?}");
        let (unread, note, _) = decided("map_Ke t.png; Ke 1 1 1", "");
        assert!(unread.emission == Vec3::ZERO && note.mended.len() == 1, "{note:?}");
        let (limited, _, warnings) = decided("Ke -1 0 1e30", "");
        assert_eq!(limited.emission, Vec3::new(0.0, 0.0, crate::scene::MAX_RADIANCE));
        assert!(warnings[0].contains("`Ke` is limited to 0 .. "), "{warnings:?}");
    }

    #[test]
    fn glass_needs_two_keys_that_agree() {
        let refracts = "d or Tr below 1 and illum asks for refraction";
        let m = becomes("illum 7; Kd 0 0 0; Ks 1 1 1; Ns 1000; Ni 1.5; d .1; Tf 1 .5 1", "", Glass, refracts);
        assert_eq!((m.opacity, m.transmission, m.index_of_refraction), (0.0, Vec3::new(1.0, 0.5, 1.0), 1.5));
        let m = becomes("illum 6; Kd .8 0 0; d .25", "", Glass, refracts);
        assert_eq!((m.opacity, m.index_of_refraction), (0.25, 1.5));
        // Ray tracers' own scenes.
        let own = "no colour of its own";
        becomes("illum 7; Kd .01 .01 .01; Ks .3 .3 .3; Tf .1 .1 .1; Ns 1024; Ni 2.5", "", Glass, own);
        for illum in [4, 6, 7, 9] {
            becomes(&format!("illum {illum}; Kd 0 0 0; Ks 1 1 1; Ns 200; Ni 1.5"), "", Glass, own);
            // As MeshLab writes what is solid: no evidence.
            becomes(&format!("illum {illum}; Kd 0 0 0; Ni 1.5; Tr 1"), "", Glass, own);
        }
    }

    #[test]
    fn what_lets_light_through_is_a_pane_of_its_own_colour() {
        for (keys, opacity) in
            [("d .3", 0.3), ("Tr .7", 0.3), ("d .3; Tr .7", 0.3), ("d .3; illum 2", 0.3), ("d 0", 0.0)]
        {
            let m = becomes(&format!("{keys}; Kd 1 0 0"), "", ThinGlass, "d or Tr below 1");
            assert!((m.opacity - opacity).abs() < 1e-6, "{keys}: {}", m.opacity);
            // A film that reflects nothing.
            assert_eq!((m.index_of_refraction, m.transmission), (1.0, Vec3::ONE));
        }
        // Models 4 and 9 are glass without refraction, 6 and 7 bend nothing at `Ni 1`.
        for (keys, index) in
            [("illum 4", 1.5), ("illum 9; Ni 1.45", 1.45), ("illum 6; Ni 1", 1.0), ("illum 3; Ni 1.3", 1.3)]
        {
            assert_eq!(
                becomes(&format!("{keys}; d .5"), "", ThinGlass, "d or Tr").index_of_refraction,
                index,
                "{keys}"
            );
        }
        // A filter that repeats `d` is not applied twice, one with a hue is.
        assert_eq!(becomes("d .3; Tf .3 .3 .3", "", ThinGlass, "d or Tr").transmission, Vec3::ONE);
        assert_eq!(becomes("d .3; Tf 1 .3 .3", "", ThinGlass, "d or Tr").transmission, Vec3::new(1.0, 0.3, 0.3));
        // Exporters round.
        becomes("d .9995", "", Opaque, "");
        becomes("d .3; map_d m.png", "", Opaque, "");
    }

    #[test]
    fn mirrors_need_something_to_reflect() {
        let asks = "illum asks for reflection and Ks has a colour";
        for illum in [3, 5] {
            becomes(&format!("illum {illum}; Kd .01 .01 .01; Ks .95 .95 .95; Ns 10"), "", Mirror, asks);
            becomes(&format!("illum {illum}; Kd .8 .8 .8; Ks .8 .8 .8; Ns 50"), "", Mirror, asks);
            becomes(&format!("illum {illum}; Kd 0 0 0; Ks 1 1 1; Ns 0"), "", Mirror, asks);
            becomes(&format!("illum {illum}; Ks 1 1 1; d .5"), "", Mirror, asks);
            let none = "illum asks for a mirror, but Ks is 0 or Ns too low";
            becomes(&format!("illum {illum}"), "", Opaque, none);
            becomes(&format!("illum {illum}; Ks 0 0 0; Ns 100"), "", Opaque, none);
            becomes(&format!("illum {illum}; Kd .8 .8 .8; Ks 1 1 1; Ns 0"), "", Opaque, none);
        }
        // Without an exponent the highlight is small, not a veil.
        assert_eq!(becomes("illum 3; Ks 1 1 1", "", Mirror, asks).shininess, POLISHED_SHININESS);
    }

    #[test]
    fn the_lists_of_the_view_override_everything() {
        let listed = |list: &str| format!("\"{list}\": [\"a\"]");
        for keys in ["illum 4; Kd 1 1 1; d 1", "illum 3; Ks 1 1 1; Ns 90", "d .3", ""] {
            becomes(keys, &listed("mirror_materials"), Mirror, LISTED);
            becomes(keys, &listed("glass_materials"), Glass, LISTED);
            becomes(keys, &listed("thin_glass_materials"), ThinGlass, LISTED);
        }
        let both = format!("{}, {}", listed("glass_materials"), listed("thin_glass_materials"));
        becomes("", &both, ThinGlass, LISTED);
        let clash = format!("{}, {}", listed("glass_materials"), listed("mirror_materials"));
        becomes("", &clash, Glass, LISTED);
        assert_eq!(decided("", &clash).2.len(), 1);
        // A list that leaves a material out says that it is not one.
        becomes("illum 3; Ks 1 1 1", "\"mirror_materials\": []", Opaque, "");
        for list in ["glass_materials", "thin_glass_materials"] {
            let none = format!("\"{list}\": []");
            becomes("illum 7; Kd 0 0 0; Ni 1.5; d .1", &none, Opaque, "");
            let (_, _, warnings) = decided("d .3", &none);
            assert!(warnings[0].contains("has opacity 0.3 and is drawn opaque"), "{warnings:?}");
        }
        becomes("illum 7; Kd 0 0 0; Ni 1.5; d .1", "\"mirror_materials\": []", Glass, "d or Tr");
        // Listed glass is as its keys say: clear but for `Tf`, black where that is black.
        let m = becomes("d .4; Kd .5 .5 .5; Tf 0 0 0", &listed("glass_materials"), Glass, LISTED);
        assert_eq!((m.opacity, m.transmission), (0.0, Vec3::ZERO));
    }

    #[test]
    fn d_and_tr_are_made_one() {
        let of = |keys: &str| {
            let (material, note, warnings) = decided(keys, "");
            assert!(warnings.is_empty(), "{keys}: {warnings:?}");
            let opaque = material.surface == Opaque;
            (if opaque { 1.0 } else { material.opacity }, note.mended.join(", "))
        };
        for (keys, opacity, told) in [
            ("d 1", 1.0, ""),
            ("Tr 0", 1.0, ""),
            ("d 1; Tr 0", 1.0, ""),
            // MeshLab.
            ("Tr 1", 1.0, "Tr 1 without d is taken for solid"),
            ("Tr 1; d 1", 1.0, "contradict"),
            ("d .3; Tr .3", 0.3, "contradict"),
            ("d 0; Tr 0", 1.0, "contradict"),
            ("d 0", 0.0, "d 0 cannot be seen"),
            ("d 0; Tr 1", 0.0, "d 0 cannot be seen"),
        ] {
            let (found, mended) = of(keys);
            assert_eq!(found, opacity, "{keys}");
            assert!(mended.contains(told) && mended.is_empty() == told.is_empty(), "{keys}: {mended}");
        }
    }

    #[test]
    fn highlights_that_are_none_are_switched_off_and_told() {
        let of = |keys: &str| {
            let (material, note, _) = decided(keys, "");
            (material.specular.x, material.shininess, note.mended.join(", "))
        };
        for keys in ["Ks 1 1 1; Ns 0", "Ks 1 1 1; Ns .5; illum 2"] {
            let (specular, _, mended) = of(keys);
            assert!(specular == 0.0 && mended.contains("Ns below 1"), "{keys}: {mended}");
        }
        for keys in ["Ks 1 1 1; Ns 50; illum 1", "Ks 1 1 1; Ns 0; illum 0", "Ks 1 1 1; illum 1; d .5"] {
            let (specular, _, mended) = of(keys);
            assert!(specular == 0.0 && mended.contains("illum 0 and 1 have no highlight"), "{keys}: {mended}");
        }
        // What means a highlight keeps it; nothing is said where there is none.
        assert_eq!(of("Ks 1 1 1; Ns 50; illum 2"), (1.0, 50.0, String::new()));
        assert_eq!(of("Ks 1 1 1"), (1.0, USUAL_SHININESS, String::new()));
        assert_eq!(of("Ks 0 0 0; Ns 0; illum 1"), (0.0, 1.0, String::new()));
        let (mirror, _, warnings) = decided("Ks .5 .5 .5; illum 1", "\"mirror_materials\": [\"a\"]");
        assert_eq!((mirror.specular.x, mirror.shininess, warnings.len()), (0.5, POLISHED_SHININESS, 0));
        assert!(decided("", "\"mirror_materials\": [\"a\"]").1.mended[0].contains("reflects nothing"));
    }

    #[test]
    fn black_textures_and_black_filters_are_not_meant() {
        let (m, note, _) = decided("Kd 0 0 0; map_Kd t.png", "");
        assert_eq!(m.diffuse, Vec3::ONE);
        assert!(note.mended[0].contains("drawn as it is"));
        assert_eq!(decided("Kd .1 .1 .1; map_Kd t.png", "").0.diffuse, Vec3::splat(0.1));
        assert_eq!(decided("Kd 0 0 0", "").0.diffuse, Vec3::ZERO);
        let (m, note, _) = decided("illum 7; d .1; Kd 0 0 0; Tf 0 0 0; Ni 1.5", "");
        assert_eq!((m.surface, m.transmission), (Glass, Vec3::ONE));
        assert!(note.mended[0].contains("Tf 0 is not used"));
    }

    #[test]
    fn the_keys_that_decided_are_kept_for_the_doctor() {
        let (_, note, _) = decided("illum 7; d .25; Ni 1.5; Kd 0 0 0; Tf 1 0.5 1", "");
        assert_eq!(note.keys, "illum 7, d 0.25, Ni 1.5, Kd 0 0 0, Tf 1 0.5 1");
    }
}
