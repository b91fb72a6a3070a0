// SPDX-License-Identifier: MIT OR Apache-2.0
//! How every file is opened and written. Names come from users and from other people's files, so nothing here waits for
//! a pipe, reads without end, or leaves half a file behind.
//!
//! **Reading.** Only regular files are read, and none that is larger than its reader allows. Folders, pipes, sockets and
//! devices are refused without waiting for them.
//!
//! **Writing.** A file is written aside, in the folder where it will lie, and renamed into place: it is there whole or
//! not at all, and a failure leaves what was there. For what is there already, [`write_whole`] does this:
//!
//! | what | what happens |
//! |---|---|
//! | a file | replaced by the new one, which gets its permissions; one that nobody may write is refused |
//! | a symbolic link to a file | followed: the file is replaced, the link stays |
//! | a symbolic link to nothing | refused |
//! | a pipe | written to; refused if nobody reads it, or if its reader takes nothing for [`PIPE_PATIENCE`] |
//! | a character device, such as `/dev/null` | written to |
//! | a folder, a disk, a socket | refused |

use std::fs::{self, File, FileType, OpenOptions};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use crate::error::Remedy;
use crate::{Error, Result};

/// How long the reader of a pipe may take nothing before writing to it is given up.
pub const PIPE_PATIENCE: Duration = Duration::from_secs(10);

/// A regular file that is being read, up to a number of bytes.
#[derive(Debug)]
pub struct InputFile {
    file: File,
    length: u64,
    position: u64,
    max_bytes: u64,
}

/// Opens a regular file of at most `max_bytes` for reading.
///
/// # Errors
/// [`Error::Io`] if it cannot be opened or is no regular file; [`Error::LimitExceeded`] if it is too large.
pub fn open(path: &Path, max_bytes: u64) -> Result<InputFile> {
    let failed = |e: io::Error| Error::io(path, e);
    // Asked before it is opened, since opening alone does something to some devices; and once more afterwards, since
    // another process may have put something else there.
    let check = |metadata: &fs::Metadata| match kind(metadata.file_type()) {
        None => Ok(metadata.len()),
        Some(kind) => Err(failed(io::Error::new(io::ErrorKind::InvalidInput, format!("this is {kind}, not a file")))),
    };
    check(&fs::metadata(path).map_err(failed)?)?;
    let file = without_waiting(OpenOptions::new().read(true)).open(path).map_err(failed)?;
    let length = check(&file.metadata().map_err(failed)?)?;
    if length > max_bytes {
        return Err(too_large(path, &format!("{length} bytes"), max_bytes));
    }
    Ok(InputFile { file, length, position: 0, max_bytes })
}

/// Reads a regular file of at most `max_bytes` whole.
///
/// # Errors
/// As for [`open`].
pub fn read(path: &Path, max_bytes: u64) -> Result<Vec<u8>> {
    let input = open(path, max_bytes)?;
    let mut bytes = Vec::new();
    let room = usize::try_from(input.length).map_err(|_| too_large(path, "more than addresses reach", max_bytes))?;
    bytes.try_reserve_exact(room).map_err(|_| {
        Error::io(path, io::Error::new(io::ErrorKind::OutOfMemory, format!("not enough memory for its {room} bytes")))
    })?;
    // Files of `/proc` have a length of 0, and any file may grow while it is read.
    input.file.take(max_bytes.saturating_add(1)).read_to_end(&mut bytes).map_err(|e| Error::io(path, e))?;
    match bytes.len() as u64 > max_bytes {
        true => Err(too_large(path, "more", max_bytes)),
        false => Ok(bytes),
    }
}

impl InputFile {
    /// The file's length in bytes when it was opened.
    pub fn length(&self) -> u64 {
        self.length
    }
}

impl Read for InputFile {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.file.read(buffer)?;
        self.position = self.position.saturating_add(count as u64);
        if self.position > self.max_bytes {
            let message = format!("the file grew beyond {} bytes while it was read", self.max_bytes);
            return Err(io::Error::new(io::ErrorKind::FileTooLarge, message));
        }
        Ok(count)
    }
}

impl Seek for InputFile {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.position = self.file.seek(to)?;
        Ok(self.position)
    }
}

/// Writes a file whole or not at all. The module's table says what happens to what is there already.
///
/// # Errors
/// [`Error::Io`] if it cannot be written.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<()> {
    write_whole_by(path, &mut |writer| writer.write_all(bytes))
}

/// What writes a file's bytes to the writer that it is given.
pub(crate) type Fill<'a> = dyn FnMut(&mut dyn Write) -> io::Result<()> + 'a;

/// As [`write_whole`], with what `fill` writes: a large file need not be in memory, except on its way into a pipe.
///
/// # Errors
/// [`Error::Io`] if it cannot be written, or `fill` fails.
pub(crate) fn write_whole_by(path: &Path, fill: &mut Fill) -> Result<()> {
    match target(path)? {
        Target::New => replace(path, path, fill, None),
        Target::File(target, permissions) => replace(path, &target, fill, Some(permissions)),
        Target::Stream => {
            let mut bytes = Vec::new();
            fill(&mut bytes).and_then(|()| write_to_stream(path, &bytes)).map_err(|e| Error::io(path, e))
        }
    }
}

/// Refuses, without writing anything, what [`write_whole`] would refuse as well: for checks before long work. Returns
/// what tells the file from others: its full name without links, or none where writing replaces nothing (a pipe, a
/// device).
///
/// # Errors
/// [`Error::Io`] if it cannot be written.
pub fn check_writable(path: &Path) -> Result<Option<PathBuf>> {
    let folder = match target(path)? {
        Target::Stream => return Ok(None),
        Target::File(target, _) => return Ok(Some(target)),
        Target::New => folder_of(path),
    };
    match fs::metadata(&folder) {
        Ok(m) if !m.is_dir() => Err(Error::io(&folder, io::Error::other("this is not a folder"))),
        Ok(_) => {
            let folder = fs::canonicalize(&folder).map_err(|e| Error::io(&folder, e))?;
            Ok(path.file_name().map(|name| folder.join(name)))
        }
        Err(e) => Err(Error::io(&folder, e)),
    }
}

/// What writing to a path means.
enum Target {
    /// Nothing is there.
    New,
    /// This file is replaced by one with these permissions.
    File(PathBuf, fs::Permissions),
    /// A pipe or a device.
    Stream,
}

fn target(path: &Path) -> Result<Target> {
    let failed = |e: io::Error| Error::io(path, e);
    let refuse = |message: &str| Err(failed(io::Error::new(io::ErrorKind::InvalidInput, message)));
    if path.as_os_str().is_empty() {
        return refuse("the file name is empty");
    }
    let existing = match fs::metadata(path) {
        Ok(existing) => existing,
        Err(_) if fs::symlink_metadata(path).is_ok_and(|m| m.is_symlink()) => {
            return refuse("this is a symbolic link to nothing; remove it or name its target");
        }
        Err(_) => return Ok(Target::New),
    };
    if existing.is_dir() {
        return Err(failed(io::Error::new(io::ErrorKind::IsADirectory, "this is a folder, name a file in it")));
    }
    if existing.is_file() {
        if existing.permissions().readonly() {
            let message = "the file is write-protected; name another one or change its permissions";
            return Err(failed(io::Error::new(io::ErrorKind::PermissionDenied, message)));
        }
        return Ok(Target::File(fs::canonicalize(path).map_err(failed)?, existing.permissions()));
    }
    if !takes_a_stream(existing.file_type()) {
        let kind = kind(existing.file_type()).unwrap_or("no file");
        return refuse(&format!("this is {kind}, name a file"));
    }
    Ok(Target::Stream)
}

/// Puts a file in place of whatever has its name, a symbolic link as well: for files that are ours alone.
///
/// # Errors
/// [`Error::Io`] if it cannot be written.
pub(crate) fn write_own(path: &Path, bytes: &[u8]) -> Result<()> {
    replace(path, path, &mut |writer| writer.write_all(bytes), None)
}

/// Makes a folder of files whole or not at all: `fill` gets a folder beside it, which is renamed at the end. What is at
/// `folder` must be nothing or an empty folder.
///
/// # Errors
/// [`Error::Io`] if it cannot be made, and the errors of `fill`.
pub(crate) fn write_folder(folder: &Path, fill: impl FnOnce(&Path) -> Result<()>) -> Result<()> {
    let failed = |e: io::Error| Error::io(folder, e);
    let parent = folder_of(folder);
    fs::create_dir_all(&parent).map_err(|e| Error::io(&parent, e))?;
    let aside = tempfile::Builder::new().prefix(".rarefy-").tempdir_in(&parent).map_err(|e| Error::io(&parent, e))?;
    // A folder within, since `tempfile` makes its own private.
    let inner = aside.path().join("new");
    fs::create_dir(&inner).map_err(failed)?;
    fill(&inner)?;
    // Renaming onto an empty folder works on Unix only, so it is taken away first.
    match fs::remove_dir(folder) {
        Err(e) if e.kind() != io::ErrorKind::NotFound => return Err(failed(e)),
        _ => {}
    }
    fs::rename(&inner, folder).map_err(failed)
}

/// The folder that a path lies in.
pub(crate) fn folder_of(path: &Path) -> PathBuf {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent.to_path_buf(),
        _ => PathBuf::from("."),
    }
}

/// Writes a file beside `target` and renames it to that; `path` is what messages name.
fn replace(path: &Path, target: &Path, fill: &mut Fill, permissions: Option<fs::Permissions>) -> Result<()> {
    let failed = |e: io::Error| Error::io(path, e);
    let folder = folder_of(target);
    // The system's message alone ("No such file") would leave open which file is meant.
    let no_folder = |e: io::Error| {
        failed(io::Error::new(e.kind(), format!("cannot write into the folder {}: {e}", folder.display())))
    };
    // Opened here, not by `tempfile`, whose files are private: the result is an ordinary file under the user's umask.
    let create = |aside: &Path| OpenOptions::new().write(true).create_new(true).open(aside);
    let made = tempfile::Builder::new().prefix(".rarefy-").suffix(".part").make_in(&folder, create);
    let mut file = made.map_err(no_folder)?;
    if let Some(permissions) = permissions {
        file.as_file().set_permissions(permissions).map_err(failed)?;
    }
    fill(file.as_file_mut()).map_err(failed)?;
    // Some file systems report a full disk only now.
    file.as_file().sync_all().map_err(failed)?;
    file.persist(target).map_err(|e| failed(e.error))?;
    Ok(())
}

/// Writes to a pipe or device, which cannot be replaced, without waiting for longer than [`PIPE_PATIENCE`].
fn write_to_stream(path: &Path, mut bytes: &[u8]) -> io::Result<()> {
    // A pipe that nobody reads cannot be opened without waiting: that is an error of its own on Unix.
    let mut stream = without_waiting(OpenOptions::new().write(true)).open(path)?;
    let mut since = Instant::now();
    while !bytes.is_empty() {
        match stream.write(bytes) {
            Ok(0) => return Err(io::ErrorKind::WriteZero.into()),
            Ok(count) => {
                bytes = &bytes[count..];
                since = Instant::now();
            }
            Err(e) if e.kind() == io::ErrorKind::Interrupted => {}
            Err(e) if e.kind() == io::ErrorKind::WouldBlock && since.elapsed() < PIPE_PATIENCE => {
                std::thread::sleep(Duration::from_millis(2));
            }
            Err(e) if e.kind() == io::ErrorKind::WouldBlock => {
                return Err(io::Error::new(io::ErrorKind::TimedOut, "nothing is read from it"));
            }
            Err(e) => return Err(e),
        }
    }
    stream.flush()
}

fn too_large(path: &Path, wanted: &str, max_bytes: u64) -> Error {
    Error::LimitExceeded {
        what: path.display().to_string(),
        limit: "file size".to_owned(),
        wanted: wanted.to_owned(),
        allowed: format!("{max_bytes} bytes"),
        remedies: &[Remedy::SmallerFile],
    }
}

/// Opening then fails, or succeeds at once, where it would wait for a pipe's other end; and no terminal becomes the
/// process's own.
#[cfg(unix)]
fn without_waiting(options: &mut OpenOptions) -> &OpenOptions {
    use std::os::unix::fs::OpenOptionsExt;
    options.custom_flags(libc::O_NONBLOCK | libc::O_NOCTTY)
}

#[cfg(not(unix))]
fn without_waiting(options: &mut OpenOptions) -> &OpenOptions {
    options
}

/// What something is that is no regular file, in words.
fn kind(file_type: FileType) -> Option<&'static str> {
    if file_type.is_file() {
        return None;
    }
    if file_type.is_dir() {
        return Some("a folder");
    }
    Some(special_kind(file_type))
}

#[cfg(unix)]
fn special_kind(file_type: FileType) -> &'static str {
    use std::os::unix::fs::FileTypeExt;
    match file_type {
        t if t.is_fifo() => "a pipe",
        t if t.is_socket() => "a socket",
        t if t.is_block_device() => "a disk",
        _ => "a device",
    }
}

#[cfg(not(unix))]
fn special_kind(_: FileType) -> &'static str {
    "a device"
}

/// Whether bytes may be written to it as they come: a pipe or a character device.
#[cfg(unix)]
fn takes_a_stream(file_type: FileType) -> bool {
    use std::os::unix::fs::FileTypeExt;
    file_type.is_fifo() || file_type.is_char_device()
}

#[cfg(not(unix))]
fn takes_a_stream(_: FileType) -> bool {
    true
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> =
            fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    #[test]
    fn a_file_is_read_up_to_its_cap() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        fs::write(&path, "12345").unwrap();
        assert_eq!(read(&path, 5).unwrap(), b"12345");
        assert_eq!(open(&path, 5).unwrap().length(), 5);
        for error in [read(&path, 4).unwrap_err(), open(&path, 4).unwrap_err()] {
            let message = error.to_string();
            assert!(message.contains("5 bytes") && message.contains("allows 4 bytes"), "{message}");
            assert!(message.contains(path.to_str().unwrap()), "{message}");
        }
        assert!(matches!(read(&folder.path().join("b"), 4), Err(Error::Io { .. })));
    }

    #[test]
    fn a_file_that_grows_is_read_no_further_than_its_cap() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        fs::write(&path, "12").unwrap();
        let mut input = open(&path, 4).unwrap();
        fs::write(&path, "123456").unwrap();
        let mut bytes = Vec::new();
        assert_eq!(input.read_to_end(&mut bytes).unwrap_err().kind(), io::ErrorKind::FileTooLarge);
        // What was read already can be read again.
        input.seek(SeekFrom::Start(3)).unwrap();
        assert_eq!(input.read(&mut [0]).unwrap(), 1);
    }

    #[cfg(unix)]
    fn pipe(path: &Path) {
        assert!(std::process::Command::new("mkfifo").arg(path).status().unwrap().success());
    }

    #[cfg(unix)]
    #[test]
    fn what_is_no_file_is_refused_by_its_kind() {
        let folder = tempfile::tempdir().unwrap();
        let fifo = folder.path().join("fifo");
        pipe(&fifo);
        let link = folder.path().join("link");
        std::os::unix::fs::symlink(&fifo, &link).unwrap();
        let socket = folder.path().join("socket");
        let _listener = std::os::unix::net::UnixListener::bind(&socket).unwrap();
        let cases = [
            (fifo.as_path(), "a pipe"),
            (&link, "a pipe"),
            (&socket, "a socket"),
            (Path::new("/dev/zero"), "a device"),
            (folder.path(), "a folder"),
        ];
        for (path, kind) in cases {
            let message = read(path, 10).unwrap_err().to_string();
            assert!(message.contains(&format!("this is {kind}, not a file")), "{message}");
        }
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn files_without_a_length_are_capped_as_well() {
        assert!(!read(Path::new("/proc/self/status"), 1 << 20).unwrap().is_empty());
        let message = read(Path::new("/proc/self/status"), 10).unwrap_err().to_string();
        assert!(message.contains("needs more, the limit `file size` allows 10 bytes"), "{message}");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn names_need_not_be_utf_8() {
        use std::os::unix::ffi::OsStrExt;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(std::ffi::OsStr::from_bytes(b"\xff\xfe.png"));
        write_whole(&path, b"x").unwrap();
        assert_eq!(read(&path, 1).unwrap(), b"x");
        assert!(path.is_file());
    }

    #[test]
    fn a_new_file_replaces_an_older_one_and_leaves_nothing_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        write_whole(&path, b"a longer first text").unwrap();
        write_whole(&path, b"new").unwrap();
        write_own(&path, b"newer").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"newer");
        assert_eq!(names(folder.path()), ["a"]);
    }

    #[test]
    fn what_cannot_be_written_leaves_what_was_there() {
        let folder = tempfile::tempdir().unwrap();
        let missing = folder.path().join("none").join("a.png");
        let message = write_whole(&missing, b"x").unwrap_err().to_string();
        assert!(message.contains("a.png") && message.contains("cannot write into the folder"), "{message}");
        assert!(!message.contains(".part"), "{message}");
        let file = folder.path().join("file");
        fs::write(&file, "x").unwrap();
        assert!(write_whole(&file.join("a.json"), b"{}").is_err());
        assert!(write_whole(folder.path(), b"{}").unwrap_err().to_string().contains("this is a folder"));
        assert!(write_whole(Path::new(""), b"{}").is_err());
        let mut protected = fs::metadata(&file).unwrap().permissions();
        protected.set_readonly(true);
        fs::set_permissions(&file, protected).unwrap();
        assert!(write_whole(&file, b"y").unwrap_err().to_string().contains("write-protected"));
        assert_eq!(names(folder.path()), ["file"]);
        assert_eq!(fs::read(&file).unwrap(), b"x");
    }

    #[cfg(unix)]
    #[test]
    fn links_are_followed_and_permissions_kept() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().unwrap();
        let [real, link, plain, new] = ["real", "link", "plain", "new"].map(|name| folder.path().join(name));
        fs::write(&real, "old").unwrap();
        fs::write(&plain, "").unwrap();
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
        fs::set_permissions(&real, fs::Permissions::from_mode(0o640)).unwrap();
        symlink(&real, &link).unwrap();
        write_whole(&link, b"new").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read_to_string(&real).unwrap(), "new");
        assert_eq!(mode(&real), 0o640);
        write_whole(&new, b"").unwrap();
        assert_eq!(mode(&new), mode(&plain));
        // Files that are ours take the link's place.
        write_own(&link, b"own").unwrap();
        assert!(!fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read_to_string(&real).unwrap(), "new");
        let nowhere = folder.path().join("nowhere");
        symlink(folder.path().join("missing"), &nowhere).unwrap();
        assert!(write_whole(&nowhere, b"x").unwrap_err().to_string().contains("symbolic link to nothing"));
        assert!(fs::symlink_metadata(&nowhere).unwrap().is_symlink());
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn devices_stay_devices_and_a_full_one_is_an_error() {
        use std::os::unix::fs::FileTypeExt;
        let message = write_whole(Path::new("/dev/full"), b"x").unwrap_err().to_string();
        assert!(message.contains("/dev/full") && message.contains("No space left"), "{message}");
        write_whole(Path::new("/dev/null"), b"x").unwrap();
        assert!(fs::metadata("/dev/null").unwrap().file_type().is_char_device());
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_pipe_is_written_to_if_it_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let fifo = folder.path().join("fifo");
        pipe(&fifo);
        // Nobody reads: an error, no wait.
        assert!(write_whole(&fifo, b"x").unwrap_err().to_string().contains("fifo"));
        // More than a pipe holds.
        let bytes = vec![7u8; 300_000];
        let reader = without_waiting(OpenOptions::new().read(true)).open(&fifo).unwrap();
        let drain = |mut reader: File| {
            let mut got = Vec::new();
            let mut buffer = [0; 4096];
            while got.len() < 300_000 {
                match reader.read(&mut buffer) {
                    Ok(count) => got.extend_from_slice(&buffer[..count]),
                    Err(e) if e.kind() == io::ErrorKind::WouldBlock => std::thread::yield_now(),
                    Err(e) => panic!("{e}"),
                }
            }
            got
        };
        let got = std::thread::scope(|scope| {
            let drained = scope.spawn(|| drain(reader));
            write_whole(&fifo, &bytes).unwrap();
            drained.join().unwrap()
        });
        assert_eq!(got, bytes);
    }

    #[test]
    fn a_folder_is_there_whole_or_not_at_all() {
        let folder = tempfile::tempdir().unwrap();
        let made = folder.path().join("made");
        let failed = write_folder(&made, |inner| {
            write_own(&inner.join("a"), b"a")?;
            Err(Error::Cancelled)
        });
        assert!(matches!(failed, Err(Error::Cancelled)));
        assert_eq!(names(folder.path()), [""; 0]);
        write_folder(&made, |inner| write_own(&inner.join("a"), b"a")).unwrap();
        assert_eq!((names(folder.path()), names(&made)), (vec!["made".to_owned()], vec!["a".to_owned()]));
        assert!(write_folder(&made, |_| Ok(())).is_err(), "a folder with files was replaced");
        assert_eq!(names(&made), ["a"]);
    }
}
