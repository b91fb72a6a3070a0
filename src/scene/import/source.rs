// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where the files of a scene come from: the file system, or a caller who opens them by name.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::io::{self, Cursor, Read, Seek, SeekFrom};
use std::path::{Component, Path, PathBuf};

use super::LoadOptions;
use crate::error::Remedy;
use crate::files::{self, InputFile};
use crate::{Error, Result};

/// The files of a scene by name, for scenes that do not lie in a folder: assets of an Android package, an archive, memory.
///
/// A closure from names to bytes is one, a map is another:
///
/// ```
/// use std::collections::BTreeMap;
///
/// let files: BTreeMap<String, Vec<u8>> =
///     [("scene.obj".into(), b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".to_vec())].into();
/// let (options, monitor) = (Default::default(), Default::default());
/// let scene = rarefy::internal::scene::load_from("scene.obj", &files, &options, &monitor)?;
/// let open = |name: &str| Ok(files.get(name).cloned());
/// assert_eq!(rarefy::internal::scene::load_from("scene.obj", &open, &options, &monitor)?, scene);
/// # Ok::<(), rarefy::Error>(())
/// ```
pub trait FileSource {
    /// The bytes of a file, or `None` if there is none of that name. Folders are parted by `/`; there is no `.` or `..`.
    ///
    /// # Errors
    /// Whatever keeps the file from being read; loading ends with it.
    fn read(&self, name: &str) -> Result<Option<Vec<u8>>>;

    /// The names of the files and folders in a folder (`""`: the outermost). They serve to find a file whose name has
    /// another letter case; a source that does not know them answers nothing.
    fn list(&self, folder: &str) -> Vec<String> {
        let _ = folder;
        Vec::new()
    }
}

impl<F: Fn(&str) -> Result<Option<Vec<u8>>>> FileSource for F {
    fn read(&self, name: &str) -> Result<Option<Vec<u8>>> {
        self(name)
    }
}

impl FileSource for BTreeMap<String, Vec<u8>> {
    fn read(&self, name: &str) -> Result<Option<Vec<u8>>> {
        Ok(self.get(name).cloned())
    }

    fn list(&self, folder: &str) -> Vec<String> {
        let below = |name: &str| match folder {
            "" => Some(name.to_owned()),
            _ => name.strip_prefix(folder)?.strip_prefix('/').map(str::to_owned),
        };
        let mut names: Vec<String> =
            self.keys().filter_map(|n| below(n)).map(|n| n.split('/').next().unwrap_or_default().to_owned()).collect();
        names.dedup();
        names
    }
}

/// Most names of a folder that are looked at to find one in another letter case.
const MAX_LISTED: usize = 100_000;

/// The source of one scene. Paths are those of the file system, or names of the caller's as paths.
pub(super) enum Source<'a> {
    /// The file system.
    Disk {
        /// The folder that everything must lie in, in full.
        confined_to: Option<PathBuf>,
        /// What was opened.
        opened: RefCell<Vec<PathBuf>>,
    },
    /// What a caller opens. Kept with the file that was asked for last: to look whether it is there is to read it.
    Caller(&'a dyn FileSource, RefCell<Option<(PathBuf, Vec<u8>)>>),
}

impl<'a> Source<'a> {
    /// The file system; a scene whose OBJ file lies in `folder`.
    pub(super) fn disk(folder: &Path, options: &LoadOptions) -> Result<Self> {
        let confined_to = match options.confined {
            true => Some(full(folder).map_err(|e| Error::io(folder, e))?),
            false => None,
        };
        Ok(Source::Disk { confined_to, opened: RefCell::default() })
    }

    /// The files of a caller.
    pub(super) fn caller(files: &'a dyn FileSource) -> Self {
        Source::Caller(files, RefCell::default())
    }

    /// Whether there is such a file, which may be read.
    pub(super) fn is_file(&self, path: &Path) -> Result<bool> {
        match self {
            Source::Disk { .. } => Ok(path.is_file() && !self.forbids(path)),
            Source::Caller(files, last) => {
                let Some(name) = plain_name(path) else { return Ok(false) };
                let mut last = last.borrow_mut();
                if last.as_ref().is_none_or(|(known, _)| known != path) {
                    *last = files.read(&name)?.map(|bytes| (path.to_path_buf(), bytes));
                }
                Ok(last.is_some())
            }
        }
    }

    /// Whether there is such a file, but outside of the folder that the scene is confined to.
    pub(super) fn forbids(&self, path: &Path) -> bool {
        match self {
            Source::Disk { confined_to: Some(folder), .. } => {
                full(path).is_ok_and(|path| !path.starts_with(folder)) && path.exists()
            }
            _ => false,
        }
    }

    /// Whether `path` lies outside of `folder`, so that its words may be none of the scene's.
    pub(super) fn is_outside(&self, folder: &Path, path: &Path) -> bool {
        match self {
            Source::Disk { .. } => match (full(folder), full(path)) {
                (Ok(folder), Ok(path)) => !path.starts_with(folder),
                _ => true,
            },
            Source::Caller(..) => false,
        }
    }

    /// The files that were opened, in order; a caller knows its own.
    pub(super) fn opened(self) -> Vec<PathBuf> {
        match self {
            Source::Disk { opened, .. } => opened.into_inner(),
            Source::Caller(..) => Vec::new(),
        }
    }

    /// Opens a file of at most `max_bytes`.
    pub(super) fn open(&self, path: &Path, max_bytes: u64) -> Result<Input> {
        match self {
            Source::Disk { opened, .. } => {
                opened.borrow_mut().push(path.to_path_buf());
                files::open(path, max_bytes).map(Input::File)
            }
            Source::Caller(..) => Ok(Input::Bytes(Cursor::new(self.bytes(path, max_bytes)?))),
        }
    }

    /// Reads a file of at most `max_bytes` whole.
    pub(super) fn read(&self, path: &Path, max_bytes: u64) -> Result<Vec<u8>> {
        match self {
            Source::Disk { opened, .. } => {
                opened.borrow_mut().push(path.to_path_buf());
                files::read(path, max_bytes)
            }
            Source::Caller(..) => self.bytes(path, max_bytes),
        }
    }

    fn bytes(&self, path: &Path, max_bytes: u64) -> Result<Vec<u8>> {
        let Source::Caller(_, last) = self else { return files::read(path, max_bytes) };
        let found = if self.is_file(path)? { last.borrow_mut().take() } else { None };
        let (_, bytes) = found.ok_or_else(|| Error::io(path, io::ErrorKind::NotFound.into()))?;
        if bytes.len() as u64 > max_bytes {
            return Err(Error::LimitExceeded {
                what: path.display().to_string(),
                limit: "file size".to_owned(),
                wanted: format!("{} bytes", bytes.len()),
                allowed: format!("{max_bytes} bytes"),
                remedies: &[Remedy::SmallerFile],
            });
        }
        Ok(bytes)
    }

    /// The names in a folder, in order; none if there is no such folder.
    pub(super) fn list(&self, folder: &Path) -> Vec<PathBuf> {
        let mut names: Vec<PathBuf> = match self {
            Source::Disk { .. } if self.forbids(folder) => Vec::new(),
            Source::Disk { .. } => {
                let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
                let entries = std::fs::read_dir(folder).into_iter().flatten().take(MAX_LISTED);
                entries.filter_map(|e| Some(e.ok()?.file_name().into())).collect()
            }
            Source::Caller(files, _) => match plain_name(folder) {
                Some(name) => files.list(&name).into_iter().take(MAX_LISTED).map(PathBuf::from).collect(),
                None => Vec::new(),
            },
        };
        names.sort();
        names
    }
}

/// A path without links and `..`, from the root; an empty path is the folder we are in.
fn full(path: &Path) -> io::Result<PathBuf> {
    std::fs::canonicalize(if path.as_os_str().is_empty() { Path::new(".") } else { path })
}

/// A caller's name for `path`; `None` if it leads out of what the caller has.
fn plain_name(path: &Path) -> Option<String> {
    let mut parts: Vec<&str> = Vec::new();
    for component in path.components() {
        match component {
            Component::Normal(part) => parts.push(part.to_str()?),
            Component::CurDir => {}
            Component::ParentDir => drop(parts.pop()?),
            Component::RootDir | Component::Prefix(_) => return None,
        }
    }
    Some(parts.join("/"))
}

/// An open file.
pub(super) enum Input {
    /// Of the file system.
    File(InputFile),
    /// In memory.
    Bytes(Cursor<Vec<u8>>),
}

impl Input {
    /// Its length in bytes.
    pub(super) fn length(&self) -> u64 {
        match self {
            Input::File(file) => file.length(),
            Input::Bytes(bytes) => bytes.get_ref().len() as u64,
        }
    }
}

impl Read for Input {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        match self {
            Input::File(file) => file.read(buffer),
            Input::Bytes(bytes) => bytes.read(buffer),
        }
    }
}

impl Seek for Input {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        match self {
            Input::File(file) => file.seek(to),
            Input::Bytes(bytes) => bytes.seek(to),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn names_of_a_caller_lead_nowhere_else() {
        let name = |path: &str| plain_name(Path::new(path));
        assert_eq!(name("a/./b/../c.png").as_deref(), Some("a/c.png"));
        assert_eq!(name("a/../../c.png"), None);
        assert_eq!(name("/etc/passwd"), None);
    }

    #[test]
    fn a_map_lists_its_folders() {
        let files: BTreeMap<String, Vec<u8>> =
            ["a/b.png", "a/c/d.png", "a/c/e.png", "ab/x.png", "f.obj"].map(|n| (n.to_owned(), Vec::new())).into();
        assert_eq!(files.list(""), ["a", "ab", "f.obj"]);
        assert_eq!(files.list("a"), ["b.png", "c"]);
        assert_eq!(files.list("none"), [""; 0]);
    }

    #[test]
    fn a_caller_is_asked_once_for_a_file_that_is_looked_for_and_read() {
        let asked = RefCell::new(Vec::new());
        let open = |name: &str| {
            asked.borrow_mut().push(name.to_owned());
            Ok((name == "a.png").then(|| vec![1, 2, 3]))
        };
        let source = Source::caller(&open);
        assert!(!source.is_file(Path::new("b.png")).unwrap());
        assert!(source.is_file(Path::new("./a.png")).unwrap());
        assert_eq!(source.read(Path::new("./a.png"), 3).unwrap(), [1, 2, 3]);
        assert!(source.read(Path::new("a.png"), 2).unwrap_err().to_string().contains("allows 2 bytes"));
        assert!(matches!(source.open(Path::new("b.png"), 2), Err(Error::Io { .. })));
        assert_eq!(*asked.borrow(), ["b.png", "a.png", "a.png", "b.png"]);
    }
}
