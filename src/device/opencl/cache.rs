// SPDX-License-Identifier: MIT OR Apache-2.0
//! What is kept on disk: compiled programs, since phones take seconds to build kernels; which of them do not build; and
//! verdicts of self-tests. All are made once per driver.
//!
//! An entry names everything that it depends on, and carries a checksum; whatever does not fit is built anew. Entries
//! are written aside and renamed, so that processes may race. A cache that cannot be written costs time, nothing else.

use std::path::{Path, PathBuf};
use std::time::SystemTime;

use super::context::Context;
use super::markers::Marker;
use crate::{Error, Result, files};

/// The variable that names the cache folder.
pub(super) const FOLDER_VARIABLE: &str = "RAREFY_CACHE_DIR";

/// Beyond this many entries of a kind the oldest go: each edit of a kernel leaves one behind.
const MOST_ENTRIES: usize = 256;

/// The largest entry that is read: a compiled program has a hundredth of it.
const MAX_ENTRY_BYTES: u64 = 64 << 20;

/// A kind of entries: how their files begin and end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Kind {
    magic: &'static [u8],
    suffix: &'static str,
}

const PROGRAMS: Kind = Kind { magic: b"rarefy program 1\n", suffix: "clbin" };
const VERDICTS: Kind = Kind { magic: b"rarefy verdict 1\n", suffix: "verdict" };
const FAILURES: Kind = Kind { magic: b"rarefy failure 1\n", suffix: "failure" };

/// Where compiled programs and what is known of drivers are kept: which programs do not build, verdicts of self-tests, what
/// ended the process.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum CacheFolder {
    /// `RAREFY_CACHE_DIR`, else `rarefy` in `XDG_CACHE_HOME`, else `.cache/rarefy` in the home folder, else nowhere. On
    /// PoCL nowhere without `RAREFY_CACHE_DIR`: it keeps compiled kernels itself, and gives out a program's binary only
    /// after it has compiled all kernels once more for any size of work-group.
    #[default]
    Usual,
    /// This folder, made when needed. An app gives its own cache folder.
    At(PathBuf),
    /// Nowhere: every program is built from its source.
    Off,
}

impl CacheFolder {
    /// The folder, if there is one.
    pub fn path(&self) -> Option<PathBuf> {
        let variable = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
        match self {
            CacheFolder::At(path) => Some(path.clone()),
            CacheFolder::Off => None,
            CacheFolder::Usual => variable(FOLDER_VARIABLE)
                .or_else(|| variable("XDG_CACHE_HOME").map(|path| path.join("rarefy")))
                .or_else(|| variable("HOME").map(|path| path.join(".cache").join("rarefy"))),
        }
    }
}

impl CacheFolder {
    /// Whether somebody named it, or the variable does.
    pub(super) fn is_asked_for(&self) -> bool {
        *self != CacheFolder::Usual || std::env::var_os(FOLDER_VARIABLE).is_some_and(|value| !value.is_empty())
    }

    /// The folder for what a driver's compiler gave; `driver_caches`: the driver keeps compiled kernels itself.
    pub(super) fn of_programs(&self, driver_caches: bool) -> Option<PathBuf> {
        if driver_caches && !self.is_asked_for() { None } else { self.path() }
    }
}

/// A cache of entries of one kind.
pub(super) struct Cache {
    folder: Option<PathBuf>,
    kind: Kind,
}

/// FNV-1a, 128 bits: no defence against malice, but no two of a person's kernels will ever meet.
fn hash(parts: &[&[u8]]) -> u128 {
    let mut state: u128 = 0x6c62_272e_07bb_0142_62b8_2175_6295_c58d;
    let mut take = |byte: u8| state = (state ^ u128::from(byte)).wrapping_mul((1 << 88) + 0x13b);
    for part in parts {
        // The length first, so that moving a byte from one part to the next changes the hash.
        (part.len() as u64).to_le_bytes().into_iter().for_each(&mut take);
        part.iter().copied().for_each(&mut take);
    }
    state
}

/// What an entry depends on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Key(u128);

impl Key {
    pub fn new(parts: &[&str]) -> Self {
        Key(hash(&parts.iter().map(|part| part.as_bytes()).collect::<Vec<_>>()))
    }

    /// The name of its entry of this kind.
    pub fn file_name(&self, suffix: &str) -> String {
        format!("{:032x}.{suffix}", self.0)
    }
}

impl Cache {
    /// Compiled programs. `driver_caches`: the driver keeps compiled kernels itself.
    pub fn programs(folder: &CacheFolder, driver_caches: bool) -> Self {
        Cache { folder: folder.of_programs(driver_caches), kind: PROGRAMS }
    }

    /// Programs that do not build, each with the compiler's log.
    pub fn failures(folder: &CacheFolder, driver_caches: bool) -> Self {
        Cache { folder: folder.of_programs(driver_caches), kind: FAILURES }
    }

    /// Verdicts of self-tests: no driver keeps those.
    pub fn verdicts(folder: &CacheFolder) -> Self {
        Cache { folder: folder.path(), kind: VERDICTS }
    }

    /// Whether anything is kept.
    pub fn is_on(&self) -> bool {
        self.folder.is_some()
    }

    fn entry(&self, key: &Key) -> Option<PathBuf> {
        Some(self.folder.as_ref()?.join(key.file_name(self.kind.suffix)))
    }

    /// The binary for `key`, if there is a sound one.
    pub fn load(&self, key: &Key) -> Option<Vec<u8>> {
        let path = self.entry(key)?;
        let bytes = match files::read(&path, MAX_ENTRY_BYTES) {
            Ok(bytes) => bytes,
            Err(error) => {
                log::debug!("no cache entry: {error}");
                return None;
            }
        };
        let binary = unpack(self.kind, key, &bytes);
        if binary.is_none() {
            log::info!("{}: a damaged or foreign cache entry, made anew", path.display());
        }
        binary.map(<[u8]>::to_vec)
    }

    /// Keeps the binary for `key`; failures are logged only.
    pub fn store(&self, key: &Key, binary: &[u8]) {
        let (Some(folder), Some(path)) = (&self.folder, self.entry(key)) else { return };
        if let Err(error) = write_whole(folder, &path, &pack(self.kind, key, binary)) {
            log::info!("{}: nothing is kept: {error}", folder.display());
            return;
        }
        prune(folder, self.kind);
    }

    /// Forgets the entry for `key`, which turned out to be of no use.
    pub fn remove(&self, key: &Key) {
        if let Some(path) = self.entry(key) {
            // If it cannot be removed, it will be refused again the next time.
            let _ = std::fs::remove_file(path);
        }
    }
}

impl Context {
    fn verdict_key(&self, about: &[&str]) -> Key {
        let info = self.info();
        let who = [&info.platform, &info.name, &info.version, &info.driver, env!("CARGO_PKG_VERSION")];
        Key::new(&[&who, about].concat())
    }

    /// The verdict that was kept about this device and driver, this version of the library and `about`.
    pub(crate) fn verdict(&self, about: &[&str]) -> Option<String> {
        String::from_utf8(self.verdicts.load(&self.verdict_key(about))?).ok()
    }

    /// Notes that the device runs kernels of `about` for the first time, until the result is dropped.
    ///
    /// # Errors
    /// [`Error::DriverCrashed`] if a process ended when it did.
    pub(crate) fn guard_first_run(&self, about: &[&str]) -> Result<Option<Marker>> {
        let key = self.verdict_key(&[about, &["first run"]].concat());
        self.markers.guard(&key, &self.info().describe(), "running kernels for the first time")
    }

    /// Keeps a verdict for later runs; if that fails, they come to their own.
    pub(crate) fn keep_verdict(&self, about: &[&str], verdict: &str) {
        self.verdicts.store(&self.verdict_key(about), verdict.as_bytes());
    }
}

fn pack(kind: Kind, key: &Key, binary: &[u8]) -> Vec<u8> {
    let mut bytes = kind.magic.to_vec();
    bytes.extend_from_slice(&key.0.to_le_bytes());
    bytes.extend_from_slice(&hash(&[binary]).to_le_bytes());
    bytes.extend_from_slice(binary);
    bytes
}

fn unpack<'a>(kind: Kind, key: &Key, bytes: &'a [u8]) -> Option<&'a [u8]> {
    let rest = bytes.strip_prefix(kind.magic)?.strip_prefix(&key.0.to_le_bytes())?;
    let (checksum, binary) = rest.split_first_chunk::<16>()?;
    (!binary.is_empty() && u128::from_le_bytes(*checksum) == hash(&[binary])).then_some(binary)
}

fn write_whole(folder: &Path, path: &Path, bytes: &[u8]) -> Result<()> {
    std::fs::create_dir_all(folder).map_err(|error| Error::io(folder, error))?;
    files::write_own(path, bytes)
}

/// Removes the oldest entries beyond [`MOST_ENTRIES`].
fn prune(folder: &Path, kind: Kind) {
    let Ok(files) = std::fs::read_dir(folder) else { return };
    let mut entries: Vec<(SystemTime, PathBuf)> = files
        .flatten()
        .filter(|file| file.path().extension().is_some_and(|suffix| suffix == kind.suffix))
        .filter_map(|file| Some((file.metadata().ok()?.modified().ok()?, file.path())))
        .collect();
    entries.sort();
    let surplus = entries.len().saturating_sub(MOST_ENTRIES);
    for (_, path) in entries.into_iter().take(surplus) {
        // Another process may have been faster.
        let _ = std::fs::remove_file(path);
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn scratch() -> (tempfile::TempDir, Cache) {
        let folder = tempfile::tempdir().unwrap();
        let cache = Cache::programs(&CacheFolder::At(folder.path().join("sub").join("cache")), false);
        (folder, cache)
    }

    #[test]
    fn what_is_stored_is_loaded() {
        let (_folder, cache) = scratch();
        let key = Key::new(&["device", "driver", "options", "source"]);
        assert_eq!(cache.load(&key), None);
        cache.store(&key, b"binary");
        assert_eq!(cache.load(&key).unwrap(), b"binary");
        cache.store(&key, b"newer");
        assert_eq!(cache.load(&key).unwrap(), b"newer");
        assert_eq!(cache.load(&Key::new(&["device", "driver", "options2", "source"])), None);
        cache.remove(&key);
        assert_eq!(cache.load(&key), None);
    }

    #[test]
    fn every_damage_is_noticed() {
        let (_folder, cache) = scratch();
        let key = Key::new(&["a"]);
        cache.store(&key, b"binary");
        let path = cache.entry(&key).unwrap();
        let sound = std::fs::read(&path).unwrap();
        for index in 0..sound.len() {
            let mut damaged = sound.clone();
            damaged[index] ^= 0x10;
            std::fs::write(&path, &damaged).unwrap();
            assert_eq!(cache.load(&key), None, "byte {index}");
            std::fs::write(&path, &sound[..index]).unwrap();
            assert_eq!(cache.load(&key), None, "cut at {index}");
        }
        std::fs::write(&path, &sound).unwrap();
        assert!(cache.load(&key).is_some());
        // An entry of another key under this key's name.
        let other = Key::new(&["b"]);
        std::fs::copy(&path, cache.entry(&other).unwrap()).unwrap();
        assert_eq!(cache.load(&other), None);
    }

    /// An entry that leads to a file without an end once filled the memory.
    #[cfg(target_os = "linux")]
    #[test]
    fn an_entry_that_is_no_file_is_made_anew() {
        let (_folder, cache) = scratch();
        let key = Key::new(&["a"]);
        cache.store(&key, b"binary");
        let path = cache.entry(&key).unwrap();
        std::fs::remove_file(&path).unwrap();
        std::os::unix::fs::symlink("/dev/zero", &path).unwrap();
        assert_eq!(cache.load(&key), None);
        cache.store(&key, b"newer");
        assert_eq!(cache.load(&key).unwrap(), b"newer");
        // One that is too large: sparse, so that it takes no space.
        std::fs::File::create(&path).unwrap().set_len(MAX_ENTRY_BYTES + 1).unwrap();
        assert_eq!(cache.load(&key), None);
    }

    #[test]
    fn an_unusable_folder_is_no_error() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        std::fs::write(&file, "in the way").unwrap();
        let key = Key::new(&["a"]);
        for cache in
            [Cache::programs(&CacheFolder::At(file.join("sub")), false), Cache::programs(&CacheFolder::Off, true)]
        {
            cache.store(&key, b"binary");
            assert_eq!(cache.load(&key), None);
        }
    }

    #[test]
    fn old_entries_go() {
        let (_folder, cache) = scratch();
        for number in 0..MOST_ENTRIES + 3 {
            cache.store(&Key::new(&[&number.to_string()]), b"x");
        }
        let count = std::fs::read_dir(cache.folder.as_ref().unwrap()).unwrap().count();
        assert_eq!(count, MOST_ENTRIES);
    }

    #[test]
    fn verdicts_and_programs_do_not_meet() {
        let (folder, programs) = scratch();
        let verdicts = Cache::verdicts(&CacheFolder::At(folder.path().join("sub").join("cache")));
        let key = Key::new(&["a"]);
        verdicts.store(&key, b"passed");
        assert_eq!(programs.load(&key), None);
        std::fs::copy(verdicts.entry(&key).unwrap(), programs.entry(&key).unwrap()).unwrap();
        assert_eq!(programs.load(&key), None);
        assert_eq!(verdicts.load(&key).unwrap(), b"passed");
    }

    #[test]
    fn the_hash_tells_parts_apart() {
        assert_ne!(Key::new(&["ab", "c"]), Key::new(&["a", "bc"]));
        assert_ne!(Key::new(&["ab"]), Key::new(&["ab", ""]));
        // Of nothing: FNV's published offset basis for 128 bits.
        assert_eq!(hash(&[]), 0x6c62272e07bb014262b821756295c58d);
    }
}
