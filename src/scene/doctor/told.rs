// SPDX-License-Identifier: MIT OR Apache-2.0
//! What is said about a loaded scene: what its materials became and why, and which keys of its files were not used.
//!
//! The same facts twice: in a line for whoever draws the scene, in full for whoever examines it.

use std::collections::BTreeMap;

use super::{Severity, Tell};
use crate::scene::{LoadNotes, MaterialNote, Scene, Surface, UnusedKey};

/// Names and keys that a short line shows of each kind.
const SHOWN: usize = 3;

/// Names that are listed in full.
const ALL: usize = 1000;

/// Keys that a short line shows of each file.
const KEYS_SHOWN: usize = 8;

/// What the loading of `scene` decided, in a few lines for whoever draws it; [`super::examine`] says it in full.
/// Empty for scenes in which nothing is special.
pub fn notices(scene: &Scene) -> Vec<String> {
    notices_of(scene.notes())
}

fn notices_of(notes: &LoadNotes) -> Vec<String> {
    let mut lines = Vec::new();
    let surfaces: Vec<String> = kinds(notes).iter().map(|kind| kind.text(SHOWN, false)).collect();
    if !surfaces.is_empty() {
        lines.push(format!("materials: {}", surfaces.join("; ")));
    }
    let mended: Vec<String> = mended(notes).iter().map(|kind| kind.text(SHOWN, false)).collect();
    if !mended.is_empty() {
        lines.push(format!("materials, not as written: {}", mended.join("; ")));
    }
    for keys in notes.unused_keys.chunk_by(|a, b| a.file == b.file) {
        let told: Vec<&UnusedKey> = keys.iter().filter(|k| !is_told_in_full_only(k)).collect();
        let shown: Vec<String> = told.iter().take(KEYS_SHOWN).map(|k| place(k)).collect();
        if !shown.is_empty() {
            let more = and_more(told.len() - shown.len());
            lines.push(format!("{}: not used: {}{more}", keys[0].file, shown.join(", ")));
        }
    }
    lines
}

/// The same in full, each fact a finding.
pub(super) fn examine(notes: &LoadNotes, tell: Tell) {
    for kind in kinds(notes) {
        tell(Severity::Note, "materials", kind.text(ALL, true));
    }
    for kind in mended(notes) {
        tell(Severity::Note, "materials", kind.text(ALL, true));
    }
    for key in &notes.unused_keys {
        tell(Severity::Note, "keys", format!("{}: {} is not used: {}", key.file, place(key), reason(&key.key)));
    }
}

/// Materials of which one thing can be said.
struct Kind<'a> {
    /// What they are: `mirror`; or what was done to them.
    what: &'a str,
    because: &'a str,
    materials: Vec<&'a MaterialNote>,
}

impl Kind<'_> {
    /// At most `shown` names, with the keys that decided if wanted.
    fn text(&self, shown: usize, with_keys: bool) -> String {
        let listed = self.because.contains("listed in view.json");
        let name = |m: &&MaterialNote| match &m.keys {
            keys if with_keys && !listed && !keys.is_empty() => format!("`{}` [{keys}]", m.material),
            _ => format!("`{}`", m.material),
        };
        let names: Vec<String> = self.materials.iter().take(shown).map(name).collect();
        let count = self.materials.len();
        let names = names.join(", ") + &and_more(count - names.len());
        if self.because.is_empty() {
            return format!("{} ({names})", self.what);
        }
        let plural = if count != 1 && self.what == "mirror" { "s" } else { "" };
        format!("{count} {}{plural} ({}): {names}", self.what, self.because)
    }
}

fn and_more(count: usize) -> String {
    if count > 0 { format!(" and {count} more") } else { String::new() }
}

/// The materials by what they are and why. Opaque ones only where their keys ask for something else.
fn kinds(notes: &LoadNotes) -> Vec<Kind<'_>> {
    let name = |surface| match surface {
        Surface::Mirror => (0, "mirror"),
        Surface::Glass => (1, "glass"),
        Surface::ThinGlass => (2, "thin glass"),
        Surface::Opaque => (4, "opaque"),
    };
    let surfaces = notes.materials.iter().map(|m| (name(m.surface), m.because, m));
    let cut_out = notes.materials.iter().map(|m| ((3, "cut-out"), m.cutout_because, m));
    grouped(surfaces.chain(cut_out).filter(|(_, because, _)| !because.is_empty()))
}

/// The materials by what was done to them.
fn mended(notes: &LoadNotes) -> Vec<Kind<'_>> {
    grouped(notes.materials.iter().flat_map(|m| m.mended.iter().map(move |what| ((0, *what), "", m))))
}

fn grouped<'a>(all: impl Iterator<Item = ((u8, &'a str), &'a str, &'a MaterialNote)>) -> Vec<Kind<'a>> {
    let mut groups: BTreeMap<_, Vec<&MaterialNote>> = BTreeMap::new();
    for (what, because, material) in all {
        groups.entry((what, because)).or_default().push(material);
    }
    groups.into_iter().map(|(((_, what), because), materials)| Kind { what, because, materials }).collect()
}

/// A key, how often and where.
fn place(key: &UnusedKey) -> String {
    match key.count {
        1 => format!("`{}` (line {})", key.key, key.first_line),
        count => format!("`{}` ({count} times from line {})", key.key, key.first_line),
    }
}

/// `Ka` is in every MTL file, and nobody expects it to do anything.
fn is_told_in_full_only(key: &UnusedKey) -> bool {
    key.key.eq_ignore_ascii_case("Ka")
}

/// Why a key is not used, and what to do instead.
fn reason(key: &str) -> &'static str {
    match key.to_ascii_lowercase().as_str() {
        "ka" | "map_ka" => "ambient light is the view's (`suggested_ambient`), and what reflects it is Kd and map_Kd",
        "map_ke" => "a surface shines in one colour (`Ke`), or not at all",
        "bump" | "map_bump" | "norm" | "map_norm" | "map_kn" | "disp" | "map_disp" => {
            "surfaces are as smooth as their normals (`vn`) say"
        }
        "map_ks" | "map_ns" => "Ks and Ns are the same all over a material",
        "map_tr" => "programs differ in whether it shows what is solid or what is not; write map_d",
        "refl" | "map_refl" => "mirrors reflect the scene itself",
        "pr" | "pm" | "ps" | "pc" | "pcr" | "aniso" | "anisor" | "map_pr" | "map_pm" | "map_ps" | "map_rma"
        | "map_orm" => "of physically based keys none is used; Kd, Ks and Ns are",
        "vertex colours" | "#mrgb" => "a surface has the colour of its material; bake the colours into a texture",
        "s" => "its value is neither `off` nor a number",
        "vp" | "cstype" | "deg" | "bmat" | "step" | "parm" | "trim" | "hole" | "scrv" | "sp" | "end" | "con"
        | "ctech" | "stech" => "free-form geometry is not drawn; export polygons",
        _ => "it is unknown",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn note(name: &str, surface: Surface, because: &'static str) -> MaterialNote {
        let keys = "illum 4".to_string();
        MaterialNote { material: name.into(), surface, because, cutout_because: "", keys, mended: Vec::new() }
    }

    fn key(file: &str, key: &str, count: usize) -> UnusedKey {
        UnusedKey { file: file.into(), key: key.into(), count, first_line: 7 }
    }

    fn notes() -> LoadNotes {
        let listed = "listed in view.json";
        let mut all: Vec<_> = ["a", "b", "c", "d"].map(|n| note(n, Surface::Mirror, listed)).into();
        all.push(note("e", Surface::ThinGlass, "d or Tr below 1"));
        let mut leaf = note("leaf", Surface::Opaque, "");
        leaf.cutout_because = "map_d";
        leaf.mended.push("Kd 0: mended");
        all.push(leaf);
        let mut unused_keys = vec![key("x.mtl", "Ka", 3), key("x.mtl", "map_Ke", 1), key("x.mtl", "norm", 2)];
        unused_keys.push(key("x.obj", "foo", 2));
        LoadNotes { materials: all, unused_keys, ..LoadNotes::default() }
    }

    #[test]
    fn whoever_draws_gets_a_line_of_each_sort() {
        assert_eq!(
            notices_of(&notes()),
            [
                "materials: 4 mirrors (listed in view.json): `a`, `b`, `c` and 1 more; 1 thin glass (d or Tr below 1): `e`; \
                 1 cut-out (map_d): `leaf`",
                "materials, not as written: Kd 0: mended (`leaf`)",
                "x.mtl: not used: `map_Ke` (line 7), `norm` (2 times from line 7)",
                "x.obj: not used: `foo` (2 times from line 7)",
            ]
        );
        assert!(notices_of(&LoadNotes::default()).is_empty());
    }

    #[test]
    fn whoever_examines_gets_all_of_it() {
        let mut told = Vec::new();
        examine(&notes(), &mut |severity, topic, message| told.push((severity, topic, message)));
        let messages: Vec<&str> = told.iter().map(|t| t.2.as_str()).collect();
        assert_eq!(
            messages,
            [
                "4 mirrors (listed in view.json): `a`, `b`, `c`, `d`",
                "1 thin glass (d or Tr below 1): `e` [illum 4]",
                "1 cut-out (map_d): `leaf` [illum 4]",
                "Kd 0: mended (`leaf` [illum 4])",
                "x.mtl: `Ka` (3 times from line 7) is not used: ambient light is the view's (`suggested_ambient`), and what \
                 reflects it is Kd and map_Kd",
                "x.mtl: `map_Ke` (line 7) is not used: a surface shines in one colour (`Ke`), or not at all",
                "x.mtl: `norm` (2 times from line 7) is not used: surfaces are as smooth as their normals (`vn`) say",
                "x.obj: `foo` (2 times from line 7) is not used: it is unknown",
            ]
        );
        assert!(told.iter().all(|t| t.0 == Severity::Note));
    }
}
