// SPDX-License-Identifier: MIT OR Apache-2.0
//! Every way in which Rarefy can fail. Each message names the place and, where there is one, the remedy.

use std::borrow::Cow;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

pub use crate::settings::Setting;

/// The result of everything in this library that can fail.
pub type Result<T> = std::result::Result<T, Error>;

/// What went wrong, where, and what to do about it.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A file could not be read or written.
    #[error("{path}: {source}", path = shown(path))]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A text file (OBJ, MTL, `view.json`, profile) breaks its format at a known line.
    #[error("{path}:{line}: {message}", path = shown(path), message = printable(message))]
    Syntax {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// What is wrong and what would be right.
        message: String,
    },
    /// A scene (or a part of it) is readable but makes no sense.
    #[error("{place}: {message}", place = printable(place), message = printable(message))]
    InvalidScene {
        /// The file and key, or the scene's name.
        place: String,
        /// What is wrong and what would be right.
        message: String,
    },
    /// A picture file could not be decoded or encoded.
    #[error("{path}: {message}", path = shown(path), message = printable(message))]
    Image {
        /// The picture file.
        path: PathBuf,
        /// What is wrong with it.
        message: String,
    },
    /// A setting's value is not one that it may have.
    #[error("{setting}: `{value}` is not allowed; it may be {allowed}")]
    InvalidOption {
        /// The setting.
        setting: Setting,
        /// The value that was given.
        value: String,
        /// The values that are allowed: a range, or a list of names.
        allowed: String,
    },
    /// Arguments of a call do not fit each other, or what they are for.
    #[error("{what}: {message}")]
    InvalidArgument {
        /// The argument.
        what: String,
        /// What does not fit, and what would.
        message: String,
    },
    /// A plane was asked for that the last frame did not keep.
    #[error("the last frame kept no plane of {plane}; name it in the frame's `Keep`")]
    MissingPlane {
        /// What the plane holds.
        plane: &'static str,
    },
    /// A device profile has a key or a value that no profile may have.
    #[error("{place}: {message}")]
    InvalidProfile {
        /// The file or the profile's name, and the key.
        place: String,
        /// What is wrong and what would be right.
        message: String,
    },
    /// Something needs more memory or larger sizes than a limit allows.
    #[error("{what} needs {wanted}, the limit `{limit}` allows {allowed}{}", in_brackets(remedies), what = printable(what))]
    LimitExceeded {
        /// What asked for it.
        what: String,
        /// The name of the limit: an OpenCL query, a setting's path, or what is counted.
        limit: String,
        /// What was asked for, with its unit.
        wanted: String,
        /// What is allowed, with its unit.
        allowed: String,
        /// What would keep within the limit, each by itself; may be empty.
        remedies: &'static [Remedy],
    },
    /// The system has no more memory.
    #[error("not enough memory for {what}: {bytes} bytes")]
    OutOfMemory {
        /// What it is for.
        what: String,
        /// What was asked for, in bytes.
        bytes: u64,
    },
    /// A launch would reach beyond one of its buffers: a defect of this library, found before a device saw the launch.
    #[error("launch of `{kernel}` needs {wanted} {what}, there are {have}: a defect of Rarefy, please report it")]
    LaunchBeyondBuffer {
        /// The kernel.
        kernel: &'static str,
        /// What there is too little of: words of a buffer, or pixels of the frame.
        what: &'static str,
        /// What the launch needs.
        wanted: u64,
        /// What there is.
        have: u64,
    },
    /// A scene or frame handle was used with another executor than the one that made it.
    #[error("this {what} handle belongs to another device")]
    ForeignHandle {
        /// What the handle is of.
        what: &'static str,
    },
    /// No OpenCL library, platform or device could be used.
    #[error("no usable OpenCL device: {}", tried.join("; "))]
    NoOpenCl {
        /// Each thing that was tried and why it did not do.
        tried: Vec<String>,
    },
    /// An OpenCL call failed.
    #[error("{call} failed: {name} ({code})")]
    OpenCl {
        /// The OpenCL call.
        call: String,
        /// The error code's name in the OpenCL headers.
        name: String,
        /// The error code.
        code: i32,
    },
    /// A device was lost while it drew, opened again, and lost again.
    #[error("{device} was lost twice in one frame: {cause}{}", in_brackets(Remedy::OF_A_LOST_DEVICE))]
    DeviceLost {
        /// The device and its driver version.
        device: String,
        /// The call that failed the second time, with its code.
        cause: String,
    },
    /// The caller ended the work by its [`crate::monitor::Cancel`] token.
    #[error("cancelled")]
    Cancelled,
    /// A kernel did not build.
    #[error("kernel program `{program}` does not build on {device}:\n{log}")]
    KernelBuild {
        /// The program, named after its stages.
        program: String,
        /// The device and its driver version.
        device: String,
        /// The compiler's log, with kernel files and lines.
        log: String,
    },
    /// A driver ended the process at an earlier start, so that the same is not done again.
    #[error(
        "the process ended at an earlier start while {device} was {work}; that is not tried again{}",
        in_brackets(Remedy::OF_A_CRASH)
    )]
    DriverCrashed {
        /// The device and its driver version, or `OpenCL` if it was not known yet.
        device: String,
        /// What it was doing: building a program, running a kernel, telling its devices.
        work: String,
    },
    /// A device computes wrong results.
    #[error("self-test failed on {device}: {stage}: {message}")]
    SelfTest {
        /// The device and its driver version.
        device: String,
        /// The stage that failed.
        stage: String,
        /// What differed.
        message: String,
    },
}

/// A text with everything escaped that would do something to a terminal or look like something else there: control
/// characters, line ends, and marks that turn the direction of writing. Names in other people's files may have such.
pub fn printable(text: &str) -> Cow<'_, str> {
    let is_unfit = |c: char| {
        c.is_control() || matches!(c, '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
    };
    if !text.contains(is_unfit) {
        return Cow::Borrowed(text);
    }
    let mut escaped = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if is_unfit(c) {
            // Writing to a String cannot fail.
            let _ = write!(escaped, "{}", c.escape_default());
        } else {
            escaped.push(c);
        }
    }
    Cow::Owned(escaped)
}

fn shown(path: &Path) -> String {
    printable(&path.to_string_lossy()).into_owned()
}

/// What would keep within a limit, as data: a command or a binding names its own options for it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Remedy {
    /// A larger [`Setting::MemoryBudget`].
    LargerBudget,
    /// A smaller [`Setting::Size`].
    SmallerPicture,
    /// Fewer [`Setting::Samples`].
    FewerSamples,
    /// Correction that converges, in place of sweeps.
    ConvergedCorrection,
    /// A scene of fewer triangles or textures.
    SmallerScene,
    /// Polygons that the modelling program cut into triangles.
    TriangulatedFaces,
    /// A scene of fewer lights.
    FewerLights,
    /// A smaller file.
    SmallerFile,
    /// Textures or pictures of fewer pixels.
    ScaledPictures,
    /// Another [`Setting::Device`].
    OtherDevice,
    /// The CPU as [`Setting::Device`].
    Cpu,
    /// A smaller work-group among the choices of a profile.
    SmallerWorkGroup,
    /// Shorter slices among the choices of a profile.
    ShorterSlices,
    /// Buffers as the memory path of a profile.
    BufferMemory,
    /// A start that is rounded up.
    RoundedStart,
    /// Doing again what ended the process.
    Retry,
}

impl Remedy {
    /// What helps where drawing takes a device too long.
    pub const OF_A_LOST_DEVICE: &'static [Remedy] =
        &[Remedy::ShorterSlices, Remedy::SmallerPicture, Remedy::FewerSamples, Remedy::Cpu];

    /// What can be done where a driver ended the process.
    pub const OF_A_CRASH: &'static [Remedy] = &[Remedy::Retry, Remedy::Cpu];
}

impl std::fmt::Display for Remedy {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(match self {
            Remedy::LargerBudget => "a larger memory budget",
            Remedy::SmallerPicture => "a smaller picture",
            Remedy::FewerSamples => "fewer samples",
            Remedy::ConvergedCorrection => "converged correction",
            Remedy::SmallerScene => "a smaller scene",
            Remedy::TriangulatedFaces => "faces that were triangulated in the modelling program",
            Remedy::FewerLights => "fewer lights",
            Remedy::SmallerFile => "a smaller file",
            Remedy::ScaledPictures => "pictures that are scaled down",
            Remedy::OtherDevice => "another device",
            Remedy::Cpu => "the CPU",
            Remedy::SmallerWorkGroup => "a smaller work-group in the profile's `choices`",
            Remedy::ShorterSlices => "a lower `slice_ms` in the profile's `choices`",
            Remedy::BufferMemory => "the memory path `buffers` in the profile's `choices`",
            Remedy::RoundedStart => "a start that is rounded up",
            Remedy::Retry => "`retry_crashed` after a system update",
        })
    }
}

/// ` (use this, that or another thing)`, or nothing.
fn in_brackets(remedies: &[Remedy]) -> String {
    let words: Vec<String> = remedies.iter().map(Remedy::to_string).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    if words.is_empty() { String::new() } else { format!(" (use {})", crate::settings::list(&words)) }
}

impl Error {
    /// An [`Error::Io`] at `path`.
    pub fn io(path: impl Into<PathBuf>, source: std::io::Error) -> Self {
        Error::Io { path: path.into(), source }
    }

    /// An [`Error::InvalidScene`] at `place`.
    pub fn scene(place: impl Into<String>, message: impl Into<String>) -> Self {
        Error::InvalidScene { place: place.into(), message: message.into() }
    }

    /// An [`Error::InvalidOption`]: `value` is none of the `allowed` ones.
    pub fn option(setting: Setting, value: impl ToString, allowed: impl Into<String>) -> Self {
        Error::InvalidOption { setting, value: value.to_string(), allowed: allowed.into() }
    }

    /// An [`Error::InvalidArgument`].
    pub fn argument(what: impl Into<String>, message: impl Into<String>) -> Self {
        Error::InvalidArgument { what: what.into(), message: message.into() }
    }

    /// An [`Error::InvalidProfile`] at `place`.
    pub fn profile(place: impl Into<String>, message: impl ToString) -> Self {
        Error::InvalidProfile { place: place.into(), message: message.to_string() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_have_one_line_and_no_control_characters() {
        assert!(matches!(printable("Wände.png, 木"), Cow::Borrowed(_)));
        assert_eq!(printable("a\u{1b}[2Jb\r\n\u{9b}c\u{202e}d\u{7f}"), r"a\u{1b}[2Jb\r\n\u{9b}c\u{202e}d\u{7f}");
        let path = PathBuf::from("x\u{7}.obj");
        for error in [
            Error::scene("a\nb", "c\u{7}"),
            Error::Syntax { path: path.clone(), line: 3, message: "d\u{7}".into() },
            Error::Image { path: path.clone(), message: "d\ne".into() },
            Error::io(path, std::io::ErrorKind::NotFound.into()),
            Error::LimitExceeded {
                what: "a\u{7}".into(),
                limit: "b".into(),
                wanted: "c".into(),
                allowed: "d".into(),
                remedies: &[],
            },
        ] {
            let message = error.to_string();
            assert!(!message.contains(char::is_control) && message.contains('\\'), "{message:?}");
        }
    }
}
