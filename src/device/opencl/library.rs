// SPDX-License-Identifier: MIT OR Apache-2.0
//! Finding the OpenCL library.
//!
//! The binding knows one name, `libOpenCL.so.1`, which no phone has, and remembers a failure for the whole process. So
//! the search happens here, by trial; then the binding is told the path that worked. Phones differ in where they keep
//! the library: up to Android 6 any absolute path works, from 7 on only the names that the vendor made public.

use std::path::Path;
use std::sync::OnceLock;

use dlopen2::raw::Library;

/// The variable by which a user names the library: a `;` list of paths.
pub const PATH_VARIABLE: &str = "OPENCL_DYLIB_PATH";

/// What the search for the library found.
#[derive(Debug, Clone)]
pub struct Search {
    /// The accepted path or name, if any.
    pub accepted: Option<String>,
    /// Each path or name that was refused before, and why.
    pub refused: Vec<(String, String)>,
}

impl Search {
    /// The refusals as lines for a report.
    pub fn reasons(&self) -> Vec<String> {
        self.refused.iter().map(|(path, reason)| format!("{path}: {reason}")).collect()
    }
}

static SEARCH: OnceLock<Search> = OnceLock::new();

/// Searches for the library, once for the process: `preferred` first if given, then [`PATH_VARIABLE`], then the names
/// and paths of this system. Later calls return the first call's outcome.
///
/// A program with other threads that read the environment should call this before it starts them (an Android library
/// in `JNI_OnLoad`), because the outcome may have to be put into [`PATH_VARIABLE`].
pub fn find(preferred: Option<&Path>) -> &'static Search {
    SEARCH.get_or_init(|| search(preferred))
}

fn search(preferred: Option<&Path>) -> Search {
    let mut refused = Vec::new();
    let preferred = preferred.map(|path| path.to_string_lossy().into_owned());
    let named = std::env::var(PATH_VARIABLE).unwrap_or_default();
    let named: Vec<String> = named.split(';').filter(|part| !part.is_empty()).map(str::to_string).collect();
    let own = candidates().into_iter();
    for path in preferred.iter().cloned().chain(named.iter().cloned()).chain(own) {
        if refused.iter().any(|(refused, _)| *refused == path) {
            continue;
        }
        match trial(&path) {
            Ok(()) => {
                // The binding tries the variable's paths in order, then its default, so it may need no telling.
                let first_named = named.first() == Some(&path);
                let default = named.is_empty() && path == BINDING_DEFAULT;
                if !(first_named || default) {
                    // SAFETY: runs once, inside `OnceLock`, before the first OpenCL call. Rust's own reads of the
                    // environment are locked against this; `find` asks callers to come before threads of other
                    // languages read it.
                    unsafe { std::env::set_var(PATH_VARIABLE, &path) };
                }
                log::debug!("OpenCL library: {path}");
                return Search { accepted: Some(path), refused };
            }
            Err(reason) => refused.push((path, reason)),
        }
    }
    if cfg!(target_os = "android") {
        refused.push(("AndroidManifest.xml".into(), MANIFEST.into()));
    }
    Search { accepted: None, refused }
}

/// What an app can do where the system hides a library that is there.
const MANIFEST: &str = "from Android 12 on a vendor's library is found only if the app names it in <uses-native-library> \
                        (libOpenCL.so, libOpenCL-pixel.so, libOpenCL-car.so, each with required=\"false\")";

/// Opens `path` and looks for OpenCL's first function in it.
fn trial(path: &str) -> std::result::Result<(), String> {
    if path.contains('\0') {
        return Err("the path contains a NUL character".into());
    }
    let library = Library::open(path).map_err(|error| match error {
        dlopen2::Error::OpeningLibraryError(reason) => reason.to_string(),
        other => other.to_string(),
    })?;
    // SAFETY: the symbol is only tested for presence, through a pointer that is never called or read.
    let symbol = unsafe { library.symbol::<*const u8>("clGetPlatformIDs") };
    let symbol_missing = symbol.is_err();
    // SAFETY: as above.
    let by_pointer = symbol_missing && unsafe { library.symbol::<*const u8>("loadOpenCLPointer") }.is_ok();
    // Vendor libraries start threads and register exit handlers: closing them crashes later.
    std::mem::forget(library);
    match (symbol_missing, by_pointer) {
        (false, _) => Ok(()),
        (true, true) => {
            Err("is the OpenCL of Pixel phones, which gives its functions through loadOpenCLPointer only; \
                             Rarefy does not use it"
                .into())
        }
        (true, false) => Err("opens, but has no function clGetPlatformIDs".into()),
    }
}

/// What the binding opens when it is told nothing.
#[cfg(windows)]
const BINDING_DEFAULT: &str = "OpenCL.dll";
#[cfg(target_os = "macos")]
const BINDING_DEFAULT: &str = "/System/Library/Frameworks/OpenCL.framework/OpenCL";
#[cfg(not(any(windows, target_os = "macos")))]
const BINDING_DEFAULT: &str = "libOpenCL.so.1";

fn candidates() -> Vec<String> {
    if cfg!(any(windows, target_os = "macos")) {
        return vec![BINDING_DEFAULT.to_string()];
    }
    if !cfg!(target_os = "android") {
        return ["libOpenCL.so.1", "libOpenCL.so", "libmali.so", "libGLES_mali.so", "libPVROCL.so"]
            .map(str::to_string)
            .to_vec();
    }
    android_candidates(cfg!(target_pointer_width = "64"))
}

/// Names, then absolute paths of the running ABI only: a library of the other ABI could never be loaded.
fn android_candidates(wide: bool) -> Vec<String> {
    let folder = if wide { "lib64" } else { "lib" };
    let mut paths: Vec<String> = [
        "libOpenCL.so",
        "libOpenCL.so.1",
        "libOpenCL-pixel.so",
        "libOpenCL-car.so",
        "libGLES_mali.so",
        "libmali.so",
        "libPVROCL.so",
    ]
    .map(str::to_string)
    .to_vec();
    for root in ["/vendor", "/system/vendor", "/system"] {
        for file in [
            "libOpenCL.so",
            "libOpenCL-pixel.so",
            "libOpenCL-car.so",
            "egl/libGLES_mali.so",
            "libmali.so",
            "libPVROCL.so",
        ] {
            paths.push(format!("{root}/{folder}/{file}"));
        }
    }
    paths
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_refused_path_comes_with_its_reason() {
        assert!(trial("/nonexistent/libOpenCL.so").unwrap_err().contains("nonexistent"));
        assert!(trial("lib\0x").is_err());
        #[cfg(target_os = "linux")]
        assert_eq!(trial("libc.so.6").unwrap_err(), "opens, but has no function clGetPlatformIDs");
    }

    #[test]
    fn android_paths_are_of_one_abi() {
        let narrow = android_candidates(false);
        assert!(narrow.contains(&"/system/vendor/lib/libOpenCL.so".to_string()));
        assert!(narrow.iter().all(|path| !path.contains("lib64")));
        let wide = android_candidates(true);
        assert!(wide.iter().filter(|path| path.starts_with('/')).all(|path| path.contains("/lib64/")));
        assert_eq!(wide[0], "libOpenCL.so");
        for car_or_pixel in ["libOpenCL-pixel.so", "libOpenCL-car.so"] {
            assert!(wide.iter().any(|path| path == car_or_pixel), "{car_or_pixel}");
        }
    }
}
