// SPDX-License-Identifier: MIT OR Apache-2.0
//! Notes on disk of what is being done with a driver, there only while it is done: a driver that ends the process leaves
//! its note, and the next start knows what not to do again.
//!
//! A note that somebody still holds (by a lock on the file, which ends with the process) is of work under way in another
//! process or thread, and says nothing. Where notes cannot be written or locked, work goes on without.

use std::fs::{File, OpenOptions};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use super::cache::{CacheFolder, Key};
use super::context::lock;
use crate::error::printable;
use crate::{Error, Result};

/// How every note begins; what was being done follows.
const MAGIC: &str = "rarefy marker 1\n";

/// More is no note of ours.
const MOST_BYTES: u64 = 4096;

/// The notes that this process holds.
static HELD: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Takes back every note of this process: what is about to end it is not a driver.
pub fn withdraw_all() {
    for path in lock(&HELD).drain(..) {
        // If it cannot be removed, the next start draws on the CPU and says why.
        let _ = std::fs::remove_file(path);
    }
}

/// Where notes are kept, and whether those that are found count.
#[derive(Debug, Clone)]
pub(super) struct Markers {
    folder: Option<PathBuf>,
    retry: bool,
}

impl Markers {
    /// Notes in `folder`; `None`: none. With `retry`, what an earlier process left is forgotten.
    pub fn new(folder: Option<PathBuf>, retry: bool) -> Self {
        Markers { folder, retry }
    }

    /// Notes on the search for devices, whose drivers nobody knows yet: only where a folder was asked for.
    pub fn of_search(folder: &CacheFolder, retry: bool) -> Self {
        Markers::new(folder.is_asked_for().then(|| folder.path()).flatten(), retry)
    }

    /// Notes that `device` is doing `work`, until the result is dropped. `None`: without a note.
    ///
    /// # Errors
    /// [`Error::DriverCrashed`] if a process ended while it did this.
    pub fn guard(&self, key: &Key, device: &str, work: &str) -> Result<Option<Marker>> {
        let Some(folder) = &self.folder else { return Ok(None) };
        let path = folder.join(key.file_name("marker"));
        match self.try_guard(folder, &path) {
            Ok(Found::Nothing(file)) => {
                let mut marker = Marker { file, path };
                marker.now(work);
                lock(&HELD).push(marker.path.clone());
                Ok(Some(marker))
            }
            Ok(Found::InUse) => Ok(None),
            Ok(Found::Left(work)) => {
                Err(Error::DriverCrashed { device: device.to_owned(), work: printable(work.trim()).into_owned() })
            }
            Err(error) => {
                log::info!("{}: no note of what a driver does: {error}", path.display());
                Ok(None)
            }
        }
    }

    fn try_guard(&self, folder: &Path, path: &Path) -> io::Result<Found> {
        std::fs::create_dir_all(folder)?;
        let mut file = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path)?;
        if !try_lock(&file)? {
            return Ok(Found::InUse);
        }
        let mut text = Vec::new();
        Read::by_ref(&mut file).take(MOST_BYTES).read_to_end(&mut text)?;
        let text = String::from_utf8_lossy(&text);
        // An empty one is new, or was left between two steps of ours.
        match text.strip_prefix(MAGIC) {
            Some(work) if !self.retry => Ok(Found::Left(work.to_owned())),
            _ => Ok(Found::Nothing(file)),
        }
    }
}

enum Found {
    /// No note: here is an empty one, locked.
    Nothing(File),
    /// One of a process that is no more.
    Left(String),
    /// One that somebody holds.
    InUse,
}

/// A note, until it is dropped.
#[derive(Debug)]
pub(crate) struct Marker {
    file: File,
    path: PathBuf,
}

impl Marker {
    /// From here on it says that the device is doing `work`.
    pub fn now(&mut self, work: &str) {
        let mut write = || {
            self.file.set_len(0)?;
            self.file.seek(SeekFrom::Start(0))?;
            self.file.write_all(format!("{MAGIC}{work}\n").as_bytes())?;
            // A phone may go down with its driver.
            self.file.sync_all()
        };
        if let Err(error) = write() {
            log::info!("{}: no note of what a driver does: {error}", self.path.display());
        }
    }
}

impl Drop for Marker {
    fn drop(&mut self) {
        lock(&HELD).retain(|held| *held != self.path);
        // Emptied first: whoever opened it meanwhile finds nothing. The lock ends when the file is closed.
        let emptied = self.file.set_len(0);
        if let Err(error) = emptied.and_then(|()| std::fs::remove_file(&self.path)) {
            log::info!("{}: the note stays: {error}", self.path.display());
        }
    }
}

/// Locks a file for this process; `false` if another one, or another handle of this one, has it.
#[cfg(unix)]
fn try_lock(file: &File) -> io::Result<bool> {
    use std::os::fd::AsRawFd;
    // SAFETY: the descriptor is open as long as `file` lives; the call touches no memory of ours.
    if unsafe { libc::flock(file.as_raw_fd(), libc::LOCK_EX | libc::LOCK_NB) } == 0 {
        return Ok(true);
    }
    let error = io::Error::last_os_error();
    if error.kind() == io::ErrorKind::WouldBlock { Ok(false) } else { Err(error) }
}

/// Nobody tells here whether a note is held: those of other processes under way are taken for left ones.
#[cfg(not(unix))]
fn try_lock(_: &File) -> io::Result<bool> {
    Ok(true)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn names(folder: &Path) -> usize {
        std::fs::read_dir(folder).map_or(0, |files| files.count())
    }

    #[test]
    fn a_note_is_there_while_the_work_lasts() {
        let folder = tempfile::tempdir().unwrap();
        let markers = Markers::new(Some(folder.path().join("sub")), false);
        let key = Key::new(&["a"]);
        let marker = markers.guard(&key, "Adreno", "building `trace`").unwrap().unwrap();
        assert_eq!(names(&folder.path().join("sub")), 1);
        // Work under way elsewhere is no crash, and is not noted twice.
        #[cfg(unix)]
        assert!(markers.guard(&key, "Adreno", "building `trace`").unwrap().is_none());
        assert!(markers.guard(&Key::new(&["b"]), "Adreno", "building `check`").unwrap().is_some());
        drop(marker);
        assert_eq!(names(&folder.path().join("sub")), 0);
        assert!(markers.guard(&key, "Adreno", "building `trace`").unwrap().is_some());
    }

    #[test]
    fn a_note_that_was_left_says_what_not_to_do() {
        let folder = tempfile::tempdir().unwrap();
        let key = Key::new(&["a"]);
        let path = folder.path().join(key.file_name("marker"));
        let markers = |retry| Markers::new(Some(folder.path().into()), retry);
        std::fs::write(&path, "rarefy marker 1\nrunning `step2c/trace`\u{7}\n").unwrap();
        for _ in 0..2 {
            let error = markers(false).guard(&key, "Adreno", "building").unwrap_err();
            let Error::DriverCrashed { device, work } = &error else { panic!("{error}") };
            assert_eq!((device.as_str(), work.as_str()), ("Adreno", "running `step2c/trace`\\u{7}"));
        }
        assert!(markers(false).guard(&Key::new(&["b"]), "Adreno", "building").is_ok());
        // An app may want to know whether it still is so; if it goes well, the note is gone.
        drop(markers(true).guard(&key, "Adreno", "building").unwrap().unwrap());
        assert!(markers(false).guard(&key, "Adreno", "building").unwrap().is_some());
        // What is no note of ours counts as none.
        for foreign in ["", "rarefy", "something else"] {
            std::fs::write(&path, foreign).unwrap();
            assert!(markers(false).guard(&key, "Adreno", "building").unwrap().is_some(), "{foreign}");
        }
    }

    #[test]
    fn without_a_folder_nothing_is_noted() {
        let key = Key::new(&["a"]);
        assert!(Markers::new(None, false).guard(&key, "x", "y").unwrap().is_none());
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        std::fs::write(&file, "x").unwrap();
        assert!(Markers::new(Some(file.join("sub")), false).guard(&key, "x", "y").unwrap().is_none());
    }

    #[test]
    fn a_note_says_what_is_done_now() {
        let folder = tempfile::tempdir().unwrap();
        let key = Key::new(&["a"]);
        let mut marker = Markers::new(Some(folder.path().into()), false).guard(&key, "x", "a long first text").unwrap();
        marker.as_mut().unwrap().now("then");
        let path = folder.path().join(key.file_name("marker"));
        assert_eq!(std::fs::read_to_string(path).unwrap(), "rarefy marker 1\nthen\n");
    }
}
