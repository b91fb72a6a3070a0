// SPDX-License-Identifier: MIT OR Apache-2.0
//! Measurements that are kept in the report's folder while a report is being made, so that a run that was ended goes on
//! where it was.
//!
//! Each lies in a file of its own with all that it depends on: the program, the device, the scene, the options. One that
//! depends on anything else than what is asked for is measured again.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::analysis::report::figures::Figures;
use crate::analysis::report::plan::Case;
use crate::analysis::report::recipe::Recipe;
use crate::error::{Error, Result};
use crate::files;

/// The folder of the measurements, in that of the report.
pub const MEASUREMENTS: &str = "measurements";

/// The largest such file that is read.
const MAX_BYTES: u64 = 1 << 20;

/// A folder of measurements.
#[derive(Debug)]
pub struct Kept {
    report: PathBuf,
    run: String,
}

#[derive(Serialize, Deserialize)]
struct Entry {
    depends_on: String,
    figures: Figures,
}

impl Kept {
    /// Those in the folder of a report; `run` is what all measurements of a run depend on: program, device, its driver.
    pub fn new(report: &Path, run: String) -> Self {
        Kept { report: report.to_path_buf(), run }
    }

    /// What was kept of `case`, if anything was, and its pictures are there.
    pub fn find(&self, case: &Case) -> Option<Figures> {
        let bytes = files::read(&self.file(case), MAX_BYTES).ok()?;
        let entry: Entry = serde_json::from_slice(&bytes).ok()?;
        let pictures_are_there = || entry.figures.pictures.iter().all(|p| self.report.join(&p.file).is_file());
        (entry.depends_on == self.key(case) && pictures_are_there()).then_some(entry.figures)
    }

    /// Keeps `figures`.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn keep(&self, case: &Case, figures: &Figures) -> Result<()> {
        let entry = Entry { depends_on: self.key(case), figures: figures.clone() };
        let path = self.file(case);
        let text = serde_json::to_vec(&entry).map_err(|e| Error::io(&path, std::io::Error::other(e)))?;
        files::write_whole(&path, &text)
    }

    fn file(&self, case: &Case) -> PathBuf {
        let sum = crc32fast::hash(self.key(case).as_bytes());
        self.report.join(MEASUREMENTS).join(format!("{sum:08x}.json"))
    }

    /// All that the figures of `case` depend on.
    fn key(&self, case: &Case) -> String {
        format!("{}; {}; {case:?}", self.run, scene_state(case.recipe))
    }
}

/// What tells whether a scene's files have changed: their lengths and times.
fn scene_state(recipe: Recipe) -> String {
    let Recipe::AsItIs(path) = recipe else { return String::new() };
    let path = Path::new(path);
    let mut files = vec![path.to_path_buf()];
    files.extend(path.read_dir().into_iter().flatten().flatten().map(|entry| entry.path()));
    files.sort();
    let state = |file: &PathBuf| {
        let metadata = file.metadata().ok()?;
        Some(format!("{} {} {:?}", file.display(), metadata.len(), metadata.modified().ok()?))
    };
    files.iter().filter_map(state).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::analysis::report::plan::{Extent, cases};
    use crate::analysis::report::testing::figures;

    #[test]
    fn what_is_kept_is_found_again_unless_anything_differs() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join(MEASUREMENTS)).unwrap();
        let extent = Extent::quick(vec!["spheres".into()]);
        let all = cases(&extent);
        let kept = Kept::new(folder.path(), "this program".into());
        let mut measured = figures(1);
        assert_eq!(kept.find(&all[0]), None);
        kept.keep(&all[0], &measured).unwrap();
        assert_eq!(kept.find(&all[0]), Some(measured.clone()));
        assert_eq!(kept.find(&all[1]), None);
        assert_eq!(Kept::new(folder.path(), "another program".into()).find(&all[0]), None);
        let mut other = all[0].clone();
        other.repeats += 1;
        assert_eq!(kept.find(&other), None);
        // A file that ended early, and a picture that is gone.
        std::fs::write(kept.file(&all[0]), "{").unwrap();
        assert_eq!(kept.find(&all[0]), None);
        measured.pictures = vec![crate::analysis::report::table::Picture {
            file: "pictures/gone.png".into(),
            width: 1,
            height: 1,
            alt: "a".into(),
            caption: "b".into(),
        }];
        kept.keep(&all[0], &measured).unwrap();
        assert_eq!(kept.find(&all[0]), None);
    }
}
