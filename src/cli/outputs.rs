// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a command is about to write, checked before any long work: every file can be written, no two are the same, and
//! none is one that the command reads.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use rarefy::internal::files;
use rarefy::{Error, Result};

use super::output::STANDARD_OUTPUT;

/// Endings of pictures that are not written.
const OTHER_PICTURES: [&str; 14] =
    ["jpg", "jpeg", "jpe", "jfif", "bmp", "gif", "tif", "tiff", "webp", "exr", "hdr", "ppm", "tga", "avif"];

/// Why an input is no output.
const IS_READ: &str = "this file is read by the same command";

/// Files that a command reads and writes.
#[derive(Debug, Default)]
pub struct Outputs {
    inputs: Vec<PathBuf>,
    /// Full names, each with the option that it comes from.
    outputs: Vec<(PathBuf, String)>,
}

impl Outputs {
    /// Nothing is written yet by a command that reads these files. One that is not there is no matter: reading it will
    /// fail, or it is the name of something built in.
    pub fn of_inputs<'a>(inputs: impl IntoIterator<Item = &'a Path>) -> Self {
        Outputs {
            inputs: inputs.into_iter().filter_map(|path| path.canonicalize().ok()).collect(),
            outputs: Vec::new(),
        }
    }

    /// The same for a scene, whose folder or OBJ file is given, and a profile.
    pub fn of_scene(scene: &Path, profile: &Path) -> Self {
        let folder = if scene.is_dir() { scene.to_path_buf() } else { scene.with_file_name("") };
        Self::of_inputs([scene, &folder.join("scene.obj"), &folder.join("view.json"), profile])
    }

    /// `option` asks for a picture at `path`.
    ///
    /// # Errors
    /// If it cannot be written there.
    pub fn picture(&mut self, option: &str, path: &Path) -> Result<()> {
        let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        if let Some(ending) = ending.filter(|ending| OTHER_PICTURES.contains(&ending.as_str())) {
            let shown = path.display();
            let message =
                format!("{shown}: pictures are written as PNG, not as {ending}; give the file a name in .png");
            return Err(Error::argument(option, message));
        }
        self.file(option, path)
    }

    /// `--json` asks for a file, for standard output, or for nothing.
    ///
    /// # Errors
    /// If it cannot be written there.
    pub fn json(&mut self, path: Option<&Path>) -> Result<()> {
        match path {
            Some(path) if path != Path::new(STANDARD_OUTPUT) => self.file("--json", path),
            _ => Ok(()),
        }
    }

    /// `option` asks for a file at `path`.
    ///
    /// # Errors
    /// If it cannot be written there.
    pub fn file(&mut self, option: &str, path: &Path) -> Result<()> {
        let Some(full_name) = files::check_writable(path)? else { return Ok(()) };
        let refuse =
            |why: String| Err(Error::argument(option, format!("{}: {why}; name another file", path.display())));
        if self.inputs.contains(&full_name) {
            return refuse(IS_READ.to_owned());
        }
        if let Some((_, other)) = self.outputs.iter().find(|(taken, _)| *taken == full_name) {
            return refuse(format!("{other} writes to the same file"));
        }
        self.outputs.push((full_name, option.to_owned()));
        Ok(())
    }

    /// The command has read these files, too, as a scene names its materials and textures.
    ///
    /// # Errors
    /// If one of them is about to be overwritten.
    pub fn were_read(&self, files: &[PathBuf]) -> Result<()> {
        // Few outputs, maybe many textures.
        let read: HashSet<PathBuf> = files.iter().filter_map(|path| path.canonicalize().ok()).collect();
        match self.outputs.iter().find(|(output, _)| read.contains(output)) {
            Some((output, option)) => {
                Err(Error::argument(option, format!("{}: {IS_READ}; name another file", output.display())))
            }
            None => Ok(()),
        }
    }
}
