// SPDX-License-Identifier: MIT OR Apache-2.0
//! Finds the textures and MTL files that a scene names, where people and programs really leave them.
//!
//! A name is looked for, in this order:
//!
//! 1. as written, beside the file that names it, then beside the OBJ file; with slashes turned; without quotes and
//!    trailing comment;
//! 2. by its last parts, the most first (of `C:\work\maps\oak.png`: `work/maps/oak.png`, `maps/oak.png`, `oak.png`), and
//!    in usual folders ([`USUAL_FOLDERS`]) there and beside the OBJ file's folder;
//! 3. the same in another letter case.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::rc::Rc;

use super::source::Source;
use crate::Result;
use crate::monitor::Monitor;

/// Folders that programs put textures into.
const USUAL_FOLDERS: [&str; 8] = ["textures", "texture", "tex", "maps", "images", "image", "img", "materials"];

/// Most names that are looked for beyond step 1: a file may name many that are nowhere, each of which costs some
/// hundred questions to the file system.
pub(super) const MAX_SEARCHES: usize = 1000;

/// Most parts of a name that are kept in step 2.
const MAX_PARTS: usize = 6;

/// What a search came to.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Found {
    /// At the place that the name says (or with slashes turned).
    There(PathBuf),
    /// Somewhere else, or by another name.
    Elsewhere(PathBuf),
    /// There is one, but it may not be read: the scene is confined to its folder.
    Forbidden,
    /// Nowhere.
    Nowhere,
}

/// Finds files of one scene.
pub(super) struct Finder<'a> {
    source: &'a Source<'a>,
    /// The folder of the OBJ file.
    root: PathBuf,
    monitor: &'a Monitor,
    /// Names by their lower case, folder by folder.
    listings: HashMap<PathBuf, Rc<HashMap<String, PathBuf>>>,
    searches: usize,
}

impl<'a> Finder<'a> {
    /// For the scene of the OBJ file `obj`.
    pub(super) fn new(source: &'a Source<'a>, obj: &Path, monitor: &'a Monitor) -> Self {
        let root = obj.parent().unwrap_or(Path::new("")).to_path_buf();
        Finder { source, root, monitor, listings: HashMap::new(), searches: 0 }
    }

    /// The source.
    pub(super) fn source(&self) -> &'a Source<'a> {
        self.source
    }

    /// Looks for `name`, which a file in `folder` has written.
    pub(super) fn find(&mut self, folder: &Path, name: &str) -> Result<Found> {
        let found = self.find_as_written(folder, name)?;
        if matches!(found, Found::There(_) | Found::Elsewhere(_)) || self.searches == MAX_SEARCHES {
            return Ok(found);
        }
        self.searches += 1;
        // A file of the same name within the scene's folder serves in place of one that may not be read.
        match self.search(folder, name)? {
            Found::Nowhere => Ok(found),
            elsewhere => Ok(elsewhere),
        }
    }

    /// The first step alone.
    pub(super) fn find_as_written(&mut self, folder: &Path, name: &str) -> Result<Found> {
        self.monitor.check()?;
        let mut is_forbidden = false;
        let folders = self.folders(folder);
        for (is_exact, spelling) in spellings(name) {
            for base in &folders {
                for relative in encodings(&spelling) {
                    let path = base.join(relative);
                    if self.source.is_file(&path)? {
                        let is_there = is_exact && base == folder;
                        return Ok(if is_there { Found::There(path) } else { Found::Elsewhere(path) });
                    }
                    is_forbidden |= self.source.forbids(&path);
                }
            }
        }
        Ok(if is_forbidden { Found::Forbidden } else { Found::Nowhere })
    }

    /// The folders that names are relative to.
    fn folders(&self, folder: &Path) -> Vec<PathBuf> {
        let mut folders = vec![folder.to_path_buf()];
        if folder != self.root {
            folders.push(self.root.clone());
        }
        folders
    }

    /// The second and third step.
    fn search(&mut self, folder: &Path, name: &str) -> Result<Found> {
        self.monitor.check()?;
        let spelling = cleaned(name);
        let parts: Vec<&str> =
            spelling.split('/').filter(|part| !matches!(*part, "" | "." | "..") && !part.ends_with(':')).collect();
        let Some(&last) = parts.last() else { return Ok(Found::Nowhere) };
        let folders = self.folders(folder);
        let mut candidates: Vec<(PathBuf, String)> = Vec::new();
        for kept in (1..=parts.len().min(MAX_PARTS)).rev() {
            let tail = parts[parts.len() - kept..].join("/");
            candidates.extend(folders.iter().map(|base| (base.clone(), tail.clone())));
        }
        let beside_root = self.root.join("..");
        for base in folders.iter().chain([&beside_root]) {
            candidates.extend(USUAL_FOLDERS.iter().map(|usual| (base.clone(), format!("{usual}/{last}"))));
        }
        for (base, relative) in &candidates {
            for relative in encodings(relative) {
                let path = base.join(relative);
                if self.source.is_file(&path)? {
                    return Ok(Found::Elsewhere(path));
                }
            }
        }
        // As written, but in another letter case, comes before other places.
        let written = folders.iter().map(|base| (base.clone(), spelling.clone()));
        for (base, relative) in written.chain(candidates.iter().cloned()) {
            if let Some(path) = self.in_any_case(&base, &relative)
                && self.source.is_file(&path)?
            {
                return Ok(Found::Elsewhere(path));
            }
        }
        Ok(Found::Nowhere)
    }

    /// The path of `relative` in `base` with every part in the letter case that it has there.
    fn in_any_case(&mut self, base: &Path, relative: &str) -> Option<PathBuf> {
        let mut path = base.to_path_buf();
        for part in relative.split('/').filter(|part| !part.is_empty()) {
            if matches!(part, "." | "..") {
                path.push(part);
                continue;
            }
            let found = self.listing(&path).get(&part.to_lowercase()).cloned()?;
            path.push(found);
        }
        Some(path)
    }

    fn listing(&mut self, folder: &Path) -> Rc<HashMap<String, PathBuf>> {
        if let Some(known) = self.listings.get(folder) {
            return Rc::clone(known);
        }
        let mut names = HashMap::new();
        for name in self.source.list(folder) {
            names.entry(name.to_string_lossy().to_lowercase()).or_insert(name);
        }
        let names = Rc::new(names);
        self.listings.insert(folder.to_path_buf(), Rc::clone(&names));
        names
    }
}

/// The ways in which a name may be meant; whether it is still the name that was written.
fn spellings(name: &str) -> Vec<(bool, String)> {
    let mut seen = HashSet::new();
    [(true, name.to_owned()), (true, name.replace('\\', "/")), (false, cleaned(name))]
        .into_iter()
        .filter(|(_, spelling)| !spelling.is_empty() && seen.insert(spelling.clone()))
        .collect()
}

/// A name without quotes around it and a comment behind it, with slashes.
fn cleaned(name: &str) -> String {
    let name = without_comment_and_quotes(name);
    name.replace('\\', "/")
}

/// A name without quotes around it and a comment behind it.
pub(super) fn without_comment_and_quotes(name: &str) -> &str {
    let name = name.trim();
    if let Some(quote @ ('"' | '\'')) = name.chars().next()
        && let Some((inner, rest)) = name[1..].split_once(quote)
        && (rest.trim().is_empty() || rest.trim_start().starts_with('#'))
    {
        return inner.trim();
    }
    match name.find(" #").or_else(|| name.find("\t#")) {
        Some(comment) => name[..comment].trim_end(),
        None => name,
    }
}

/// A relative path as bytes of the file system: in UTF-8, and in Latin-1 where that is another: names that are not valid
/// UTF-8 were read as Latin-1, byte by byte, so this gives back the very bytes of the file.
fn encodings(name: &str) -> Vec<PathBuf> {
    let mut paths = vec![PathBuf::from(name)];
    #[cfg(unix)]
    if !name.is_ascii()
        && let Some(bytes) = name.chars().map(|c| u8::try_from(u32::from(c)).ok()).collect::<Option<Vec<u8>>>()
    {
        use std::os::unix::ffi::OsStringExt;
        paths.push(std::ffi::OsString::from_vec(bytes).into());
    }
    paths
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use std::collections::BTreeMap;

    use super::*;

    /// Finds `name`, written by a file in `folder`, for the OBJ file `scene/a.obj`.
    fn find(files: &[&str], folder: &str, name: &str) -> Found {
        let files: BTreeMap<String, Vec<u8>> = files.iter().map(|&n| (n.to_owned(), Vec::new())).collect();
        let (source, monitor) = (Source::caller(&files), Monitor::default());
        Finder::new(&source, Path::new("scene/a.obj"), &monitor).find(Path::new(folder), name).unwrap()
    }

    #[track_caller]
    fn finds(files: &[&str], name: &str, path: &str) {
        assert_eq!(find(files, "scene/mtl", name), Found::Elsewhere(path.into()), "{name}");
    }

    #[test]
    fn a_name_is_taken_as_written_first() {
        let files = ["scene/mtl/a b.png", "scene/a b.png", "scene/mtl/a.png", "scene/mtl/sub/x #1.png"];
        for (name, path) in [
            ("a b.png", "scene/mtl/a b.png"),
            ("sub\\x #1.png", "scene/mtl/sub/x #1.png"),
            ("../a b.png", "scene/mtl/../a b.png"),
        ] {
            assert_eq!(find(&files, "scene/mtl", name), Found::There(path.into()));
        }
    }

    #[test]
    fn quotes_and_comments_are_left_out() {
        for name in ["\"a b.png\"", "a b.png # oak", "'a b.png' # oak", "\"a b.png\"  ", "a b.png\t# 'x'"] {
            finds(&["scene/mtl/a b.png"], name, "scene/mtl/a b.png");
        }
        assert_eq!(find(&["scene/mtl/b.png"], "scene/mtl", "\"a\" b.png"), Found::Nowhere);
        assert_eq!(without_comment_and_quotes("wood#2"), "wood#2");
    }

    #[test]
    fn the_nearest_place_counts() {
        let name = "C:\\Work\\maps\\oak.png";
        let mut files = vec![
            "scene/mtl/Work/maps/oak.png",
            "scene/Work/maps/oak.png",
            "scene/mtl/maps/oak.png",
            "scene/maps/oak.png",
            "scene/mtl/oak.png",
            "scene/oak.png",
            "scene/mtl/textures/oak.png",
            "scene/tex/oak.png",
            "textures/oak.png",
            "scene/mtl/work/Maps/Oak.PNG",
            "scene/Textures/OAK.png",
        ];
        while let Some(&nearest) = files.first() {
            let expected = if nearest == "textures/oak.png" { "scene/../textures/oak.png" } else { nearest };
            finds(&files, name, expected);
            files.remove(0);
        }
        assert_eq!(find(&files, "scene/mtl", name), Found::Nowhere);
        assert_eq!(find(&files, "scene/mtl", "C:\\"), Found::Nowhere);
        assert_eq!(find(&files, "scene/mtl", "/"), Found::Nowhere);
    }

    #[test]
    fn many_names_that_are_nowhere_are_not_searched_for() {
        let files: BTreeMap<String, Vec<u8>> = [("scene/textures/a.png".to_owned(), Vec::new())].into();
        let (source, monitor) = (Source::caller(&files), Monitor::default());
        let mut finder = Finder::new(&source, Path::new("scene/a.obj"), &monitor);
        for i in 0..MAX_SEARCHES {
            assert_eq!(finder.find(Path::new("scene"), &format!("{i}.png")).unwrap(), Found::Nowhere);
        }
        assert_eq!(finder.find(Path::new("scene"), "a.png").unwrap(), Found::Nowhere);
        let there = Found::There("scene/textures/a.png".into());
        assert_eq!(finder.find(Path::new("scene"), "textures/a.png").unwrap(), there);
    }
}
