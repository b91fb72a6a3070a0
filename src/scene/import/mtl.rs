// SPDX-License-Identifier: MIT OR Apache-2.0
//! MTL files. `tobj` reads the OBJ file alone: of an MTL file it would take what nobody checked (it panics at `Kd 0.5`, takes
//! NaN, and keeps the options of maps as part of the file name), so that every key would have to be read before it is.
//!
//! Meaning of the keys, in any letter case: `Kd` diffuse colour; `Ks` highlight, and what a mirror reflects; `Ns`
//! Blinn-Phong exponent; `Ni` index of refraction; `Tf` colour of light through glass; `d` and `Tr` opacity and
//! 1 - opacity; `Ke` light of its own; `map_Kd` picture that `Kd` multiplies (options `-s` and `-o` apply); `map_d` (or
//! `map_opacity`) cut-out mask; `illum` what kind of surface is asked for. What a material becomes of these is decided in
//! [`super::material`]. Every other key is counted.

use std::collections::HashMap;
use std::path::Path;

use glam::{Vec2, Vec3};

use super::assemble::TexcoordMap;
use super::lines::{LogicalLines, MAX_MTL_BYTES, keyword, name_text, without_comment, words};
use super::notices::Notices;
use super::source::Source;
use super::unused::Tally;
use crate::Result;
use crate::scene::{MAX_RADIANCE, UnusedKey};

/// A `map_` line.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Map {
    /// File name as written.
    pub file: String,
    /// Options `-s` and `-o`.
    pub texcoords: TexcoordMap,
}

/// A material as the file has it; `None`: the file does not say.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct MtlMaterial {
    pub name: String,
    pub diffuse: Option<Vec3>,
    pub specular: Option<Vec3>,
    pub shininess: Option<f32>,
    pub transmission: Option<Vec3>,
    pub emission: Option<Vec3>,
    /// `map_Ke` is there, which is not read: `Ke` is then the brightest of a picture that is mostly dark.
    pub has_emission_map: bool,
    pub index_of_refraction: Option<f32>,
    /// `d`.
    pub dissolve: Option<f32>,
    /// `Tr`.
    pub transparency: Option<f32>,
    pub illumination_model: Option<u8>,
    pub diffuse_map: Option<Map>,
    pub cutout_map: Option<Map>,
}

/// Reads the MTL file at `path`; appends sentences about what was mended to `warnings`, and the keys that were not used
/// to `unused`.
pub(super) fn read(
    source: &Source,
    path: &Path,
    warnings: &mut Vec<String>,
    unused: &mut Vec<UnusedKey>,
) -> Result<Vec<MtlMaterial>> {
    let mut tally = Tally::new(path);
    let materials = parse(source, path, warnings, &mut tally)?;
    unused.append(&mut tally.into_keys());
    let (mut told, before) = (Notices::default(), warnings.len());
    for (name, line) in &materials.again {
        told.shorten(warnings, before);
        warnings.push(format!("{}:{line}: material `{name}` is defined again; this one counts", path.display()));
    }
    told.shorten(warnings, before);
    warnings.append(&mut told.take(&format!("more materials of {} are defined again", path.display())));
    Ok(materials.list)
}

/// The materials of a file so far.
#[derive(Default)]
struct Materials {
    list: Vec<MtlMaterial>,
    by_name: HashMap<String, usize>,
    /// The one that keys belong to: none before the first `newmtl`.
    current: Option<usize>,
    /// Names that were defined before, each with the line of its next definition.
    again: Vec<(String, usize)>,
}

impl Materials {
    /// Begins a material. One of the same name is forgotten.
    fn begin(&mut self, name: String, line: usize) {
        let material = MtlMaterial { name: name.clone(), ..MtlMaterial::default() };
        let at = match self.by_name.get(&name) {
            Some(&earlier) => {
                self.list[earlier] = material;
                self.again.push((name, line));
                earlier
            }
            None => {
                self.by_name.insert(name, self.list.len());
                self.list.push(material);
                self.list.len() - 1
            }
        };
        self.current = Some(at);
    }

    /// Changes the material that keys belong to.
    fn set(&mut self, change: impl FnOnce(&mut MtlMaterial)) {
        if let Some(material) = self.current.and_then(|at| self.list.get_mut(at)) {
            change(material);
        }
    }
}

fn parse(source: &Source, path: &Path, warnings: &mut Vec<String>, tally: &mut Tally) -> Result<Materials> {
    let mut lines = LogicalLines::open(source, path, MAX_MTL_BYTES)?;
    let mut materials = Materials::default();
    let (mut told, before) = (Notices::default(), warnings.len());
    while let Some((number, line)) = lines.next_line()? {
        told.shorten(warnings, before);
        // A value that makes no sense has what it would be without it to fall back on.
        let at = path.display();
        let mut left_out = |message: String| warnings.push(format!("{at}:{number}: {message}; left out"));
        let (written, rest) = keyword(line);
        // As the format's specification writes it: exporters differ in letter case.
        let key = match written.to_ascii_lowercase().as_slice() {
            b"" | [b'#', ..] => continue,
            b"newmtl" => "newmtl",
            b"kd" => "Kd",
            b"ks" => "Ks",
            b"tf" => "Tf",
            b"ke" => "Ke",
            b"ns" => "Ns",
            b"ni" => "Ni",
            b"d" => "d",
            b"tr" => "Tr",
            b"illum" => "illum",
            b"map_kd" => "map_Kd",
            b"map_d" | b"map_opacity" => "map_d",
            // Blender writes these for every material, mostly as 0: that asks for nothing.
            b"ka" | b"pm" | b"ps" | b"pc" | b"aniso" | b"anisor"
                if numbers(rest).is_ok_and(|values| values.iter().all(|&v| v == 0.0)) =>
            {
                continue;
            }
            other => {
                if other == b"map_ke" {
                    materials.set(|m| m.has_emission_map = true);
                }
                tally.note(written, number);
                continue;
            }
        };
        if key == "newmtl" {
            let name = name_text(rest);
            if name.is_empty() {
                warnings.push(format!("{at}:{number}: `newmtl` without a name; faces of `usemtl` without one get it"));
            }
            materials.begin(name, number);
            continue;
        }
        let mut wrong = |message: String| left_out(format!("`{key}`: {message}"));
        match key {
            "Kd" | "Ks" | "Tf" | "Ke" => {
                if let Some(first @ (b"spectral" | b"xyz")) = words(rest).next() {
                    let first = String::from_utf8_lossy(first);
                    wrong(format!("`{first}` is not supported"));
                    continue;
                }
                let rgb = match numbers(rest).as_deref() {
                    Ok([grey]) => [*grey; 3],
                    Ok([r, g, b, ..]) => [*r, *g, *b],
                    Ok(values) => {
                        wrong(format!("{} numbers; 3 are right", values.len()));
                        continue;
                    }
                    Err(message) => {
                        wrong(message.clone());
                        continue;
                    }
                };
                // Surfaces shine as brightly as they like; they reflect no more than what they get.
                let most = if key == "Ke" { MAX_RADIANCE } else { 1.0 };
                if rgb.iter().any(|v| !(0.0..=most).contains(v)) {
                    warnings.push(format!("{}:{number}: `{key}` is limited to 0 .. {most}", path.display()));
                }
                let rgb = Some(Vec3::from(rgb.map(|v| v.clamp(0.0, most))));
                materials.set(|m| match key {
                    "Kd" => m.diffuse = rgb,
                    "Ks" => m.specular = rgb,
                    "Ke" => m.emission = rgb,
                    _ => m.transmission = rgb,
                });
            }
            "Ns" | "Ni" | "d" | "Tr" => {
                let rest = rest.strip_prefix(b"-halo").unwrap_or(rest);
                let first = numbers(rest).and_then(|v| v.first().copied().ok_or_else(|| "a number is missing".into()));
                let value = match first {
                    Ok(value) => value,
                    Err(message) => {
                        wrong(message);
                        continue;
                    }
                };
                let (low, high) = match key {
                    "Ns" => (0.0, 1.0e6),
                    "Ni" => (1.0, 100.0),
                    _ => (0.0, 1.0),
                };
                // Exporters write `Ni 0` or `Ni 0.001` for what does not refract.
                if !(low..=high).contains(&value) && key != "Ni" {
                    warnings.push(format!("{at}:{number}: `{key} {value}` is limited to {low} .. {high}"));
                }
                let value = Some(value.clamp(low, high));
                materials.set(|m| match key {
                    "Ns" => m.shininess = value,
                    "Ni" => m.index_of_refraction = value,
                    "d" => m.dissolve = value,
                    _ => m.transparency = value,
                });
            }
            "illum" => {
                let text = name_text(words(rest).next().unwrap_or_default());
                match text.parse::<f32>() {
                    Ok(value) if (0.0..=10.0).contains(&value) => {
                        // Some write `2.0`.
                        let whole = value as u8;
                        if text.parse() != Ok(whole) {
                            warnings.push(format!("{at}:{number}: `illum {text}` is taken for {whole}"));
                        }
                        materials.set(|m| m.illumination_model = Some(whole));
                    }
                    _ => wrong(format!("`{text}` is not an illumination model; 0 to 10 are right")),
                }
            }
            // map_Kd, map_d
            _ => {
                let (map, ignored) = parse_map(&name_text(rest));
                if map.file.is_empty() {
                    wrong("a file name is missing".into());
                    continue;
                }
                if !ignored.is_empty() {
                    warnings.push(format!("{at}:{number}: `{key}` options not used: {}", ignored.join(", ")));
                }
                materials.set(|m| match key {
                    "map_Kd" => m.diffuse_map = Some(map),
                    _ => m.cutout_map = Some(map),
                });
            }
        }
    }
    told.shorten(warnings, before);
    warnings.append(&mut told.take(&format!("more things are wrong in {}", path.display())));
    Ok(materials)
}

/// The numbers of a line.
fn numbers(rest: &[u8]) -> std::result::Result<Vec<f32>, String> {
    words(without_comment(rest))
        .map(|word| {
            let text = String::from_utf8_lossy(&word[..word.len().min(60)]);
            match text.parse::<f32>() {
                Ok(value) if value.is_finite() => Ok(value),
                Ok(_) => Err(format!("`{text}` is not a finite number")),
                Err(_) => Err(format!("`{text}` is not a number")),
            }
        })
        .collect()
}

/// Splits a map's arguments into options and file name (which may have spaces, or be missing). Also the options that are
/// not applied, some with the reason.
fn parse_map(text: &str) -> (Map, Vec<String>) {
    let mut rest = text.trim();
    let mut ignored = Vec::new();
    let mut texcoords = TexcoordMap::default();
    while rest.starts_with('-') {
        let (option, after) = rest.split_once(char::is_whitespace).unwrap_or((rest, ""));
        // How many words follow: (at least, at most); all but the first must be numbers where the count varies.
        let (least, most) = match option {
            "-s" | "-o" | "-t" => (1, 3),
            "-mm" => (2, 2),
            "-blendu" | "-blendv" | "-cc" | "-clamp" | "-imfchan" | "-texres" | "-bm" | "-boost" | "-type" => (1, 1),
            // A file name that begins with a dash.
            _ => break,
        };
        let mut after = after.trim_start();
        let mut values = Vec::new();
        for i in 0..most {
            let (word, further) = after.split_once(char::is_whitespace).unwrap_or((after, ""));
            let number = word.parse::<f32>().ok();
            if i >= least && (number.is_none() || further.trim().is_empty()) {
                break;
            }
            values.push((word, number));
            after = further.trim_start();
        }
        let mut number = |i: usize, default: f32| match values.get(i) {
            None => default,
            Some((_, Some(v))) if v.abs() <= 1.0e6 => *v,
            Some((word, _)) => {
                ignored.push(format!("{option} (`{word}` is not a number in -1e6 .. 1e6)"));
                default
            }
        };
        match option {
            "-s" => texcoords.scale = Vec2::new(number(0, 1.0), number(1, 1.0)),
            "-o" => texcoords.offset = Vec2::new(number(0, 0.0), number(1, 0.0)),
            // Without effect here, or asking for what is done anyway.
            "-blendu" | "-blendv" | "-texres" | "-boost" | "-imfchan" | "-bm" => {}
            "-clamp" if values.first().is_some_and(|(word, _)| *word == "off") => {}
            _ => ignored.push(option.to_string()),
        }
        rest = after;
    }
    (Map { file: rest.to_string(), texcoords }, ignored)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::notices::MOST_TOLD;
    use super::*;

    fn read_text(text: &str) -> (Result<Vec<MtlMaterial>>, Vec<String>) {
        let (materials, warnings, _) = read_all(text);
        (materials, warnings)
    }

    fn read_all(text: &str) -> (Result<Vec<MtlMaterial>>, Vec<String>, Vec<UnusedKey>) {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("m.mtl");
        std::fs::write(&path, text).unwrap();
        let (mut warnings, mut unused) = (Vec::new(), Vec::new());
        let materials =
            read(&Source::Disk { confined_to: None, opened: Default::default() }, &path, &mut warnings, &mut unused);
        (materials, warnings, unused)
    }

    #[test]
    fn every_key_arrives() {
        let text = "# c\nnewmtl red glass\nKa 1 1 1\nKd 0.5\nKs .1 .2 .3\nNs 30\nNi 1.45\nTf 1 .5 .25\nTr 0.25\nillum 7\n\
                    map_Kd -s 2 3 1 -clamp off my wood.jpg\nmap_d a.png\nKe 30 4 0\nnewmtl b\nd 0.5\nKe 0 0 0\n";
        let (materials, warnings) = read_text(text);
        let materials = materials.unwrap();
        assert!(warnings.is_empty(), "{warnings:?}");
        let m = &materials[0];
        assert_eq!(
            (m.name.as_str(), m.diffuse, m.specular),
            ("red glass", Some(Vec3::splat(0.5)), Some(Vec3::new(0.1, 0.2, 0.3)))
        );
        assert_eq!((m.shininess, m.index_of_refraction), (Some(30.0), Some(1.45)));
        assert_eq!((m.dissolve, m.transparency), (None, Some(0.25)));
        assert_eq!((m.transmission, m.illumination_model), (Some(Vec3::new(1.0, 0.5, 0.25)), Some(7)));
        assert_eq!((m.emission, materials[1].emission), (Some(Vec3::new(30.0, 4.0, 0.0)), Some(Vec3::ZERO)));
        let map = m.diffuse_map.as_ref().unwrap();
        assert_eq!((map.file.as_str(), map.texcoords.scale), ("my wood.jpg", Vec2::new(2.0, 3.0)));
        assert_eq!(m.cutout_map.as_ref().unwrap().file, "a.png");
        assert_eq!((materials[1].dissolve, materials[1].transparency), (Some(0.5), None));
    }

    #[test]
    fn keys_count_in_any_letter_case() {
        let (plain, _) =
            read_text("newmtl a\nKd 1 0 0\nKs 1 1 1\nNs 9\nmap_Kd a.png\nmap_d b.png\nillum 2\nTr .5\nd .5\n");
        for other in [
            "NEWMTL a\nKD 1 0 0\nKS 1 1 1\nNS 9\nMAP_KD a.png\nMAP_D b.png\nILLUM 2\nTR .5\nD .5\n",
            "newmtl a\nkd 1 0 0\nks 1 1 1\nns 9\nmap_kd a.png\nmap_opacity b.png\nillum 2\ntr .5\nd .5\n",
        ] {
            let (materials, warnings, unused) = read_all(other);
            assert_eq!(&materials.unwrap(), plain.as_ref().unwrap());
            assert!(warnings.is_empty() && unused.is_empty(), "{warnings:?} {unused:?}");
        }
    }

    #[test]
    fn keys_that_are_not_used_are_counted() {
        let (materials, warnings, unused) =
            read_all("newmtl a\n# Pm\n\nPm 1\nmap_Bump -bm 1 b.png\nnewmtl b\nPM 0.5\nfoo\nPs 0\nPm 0\n");
        assert!(materials.is_ok() && warnings.is_empty());
        let keys: Vec<_> = unused.iter().map(|k| (k.key.as_str(), k.count, k.first_line)).collect();
        assert_eq!(keys, [("Pm", 2, 4), ("map_Bump", 1, 5), ("foo", 1, 8)]);
        assert!(unused[0].file.ends_with("m.mtl"));
    }

    #[test]
    fn a_file_name_may_look_like_a_number_or_an_option() {
        let file = |text: &str| parse_map(text).0.file;
        assert_eq!(file("-s 2 3.png"), "3.png");
        assert_eq!(file("-o 1 2 3 4 5.png"), "4 5.png");
        assert_eq!(file("-odd.png"), "-odd.png");
        assert_eq!(parse_map("-mm 0 1 x.png").1, ["-mm"]);
        assert_eq!(file("-s 1"), "");
        let (map, ignored) = parse_map("-s nan 2 1 x.png");
        assert_eq!((map.file.as_str(), map.texcoords.scale), ("x.png", Vec2::new(1.0, 2.0)));
        assert_eq!(ignored, ["-s (`nan` is not a number in -1e6 .. 1e6)"]);
    }

    #[test]
    fn wrong_values_are_left_out_and_named_with_their_line() {
        let plain = MtlMaterial { name: "a".into(), ..MtlMaterial::default() };
        for (text, expected) in [
            ("newmtl a\nKd 1 2\n", "m.mtl:2: `Kd`: 2 numbers; 3 are right; left out"),
            ("newmtl a\n\nNs nan\n", "m.mtl:3: `Ns`: `nan` is not a finite number; left out"),
            ("newmtl a\nNi\n", "m.mtl:2: `Ni`: a number is missing"),
            ("newmtl a\nillum 99\n", "m.mtl:2: `illum`: `99` is not an illumination model"),
            ("newmtl a\nillum -1\n", "m.mtl:2: `illum`: `-1` is not"),
            ("newmtl a\nillum\n", "m.mtl:2: `illum`: `` is not"),
            ("newmtl a\nmap_Kd\n", "m.mtl:2: `map_Kd`: a file name is missing; left out"),
            ("newmtl a\nmap_d   # none\n", ""),
            ("newmtl a\nKs spectral f.rfl\n", "m.mtl:2: `Ks`: `spectral` is not supported"),
        ] {
            let (materials, warnings) = read_text(text);
            match expected {
                // The name of a file may begin so.
                "" => assert_eq!(materials.unwrap()[0].cutout_map.as_ref().unwrap().file, "# none"),
                _ => {
                    assert_eq!(materials.unwrap(), std::slice::from_ref(&plain), "{text:?}");
                    assert!(warnings.len() == 1 && warnings[0].contains(expected), "{warnings:?}");
                }
            }
        }
        let (materials, warnings) = read_text("newmtl a\nillum 2\nnewmtl a\nillum 2.0\nnewmtl\nKd 1 0 0\n");
        let materials = materials.unwrap();
        assert_eq!((materials[0].illumination_model, materials[1].name.as_str()), (Some(2), ""));
        assert!(warnings.iter().any(|w| w.contains("m.mtl:4: `illum 2.0` is taken for 2")), "{warnings:?}");
        assert!(warnings.iter().any(|w| w.contains("m.mtl:5: `newmtl` without a name")), "{warnings:?}");
    }

    #[test]
    fn of_thousands_of_warnings_the_first_are_told() {
        let (_, warnings) = read_text(&("newmtl a\n".to_owned() + &"Kd x\n".repeat(3000)));
        assert_eq!(warnings.len(), MOST_TOLD + 1);
        assert!(warnings[MOST_TOLD - 1].contains("m.mtl:51: ") && warnings[MOST_TOLD].contains("2950 more things"));
        let (_, warnings) = read_text(&"newmtl a\n".repeat(3000));
        assert!(
            warnings.len() == MOST_TOLD + 1 && warnings[MOST_TOLD].starts_with("2949 more materials"),
            "{warnings:?}"
        );
    }

    #[test]
    fn a_second_definition_counts_and_is_told() {
        let (materials, warnings) = read_text("newmtl a\nKd 0 0 0\nnewmtl b\nnewmtl a\nKd 1 1 1\n");
        let materials = materials.unwrap();
        assert_eq!(materials.iter().map(|m| m.name.as_str()).collect::<Vec<_>>(), ["a", "b"]);
        assert_eq!(materials[0].diffuse, Some(Vec3::ONE));
        assert!(warnings[0].contains("m.mtl:4"), "{warnings:?}");
    }
}
