// SPDX-License-Identifier: MIT OR Apache-2.0
//! Java programs as tests: compiled by the machine's JDK, run with the library that cargo built.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::command::root;

/// The Java tools of this machine.
pub struct Jdk {
    javac: PathBuf,
    java: PathBuf,
    /// Keeps signal handlers in order between the Java VM and libraries that install their own; part of most JDKs.
    libjsig: Option<PathBuf>,
}

impl Jdk {
    /// The JDK in `JAVA_HOME`, else on `PATH`; `None` if the environment waives these tests.
    pub fn find() -> Option<Jdk> {
        if std::env::var_os("RAREFY_TEST_JVM").is_some_and(|v| v == "none") {
            println!("skipped: RAREFY_TEST_JVM=none");
            return None;
        }
        let mut folders = Vec::new();
        folders.extend(std::env::var_os("JAVA_HOME").map(|home| Path::new(&home).join("bin")));
        folders.extend(std::env::var_os("PATH").iter().flat_map(std::env::split_paths));
        let Some(javac) = folders.iter().map(|folder| folder.join("javac")).find(|file| file.is_file()) else {
            panic!(
                "no JDK: `javac` is neither in JAVA_HOME nor on PATH. Install one (Debian, Ubuntu: \
                 `apt-get install default-jdk-headless`) or waive these tests with RAREFY_TEST_JVM=none"
            );
        };
        // The real folder of the JDK, behind the links in /usr/bin: it holds a matching `java` and libjsig.
        let bin = javac.canonicalize().unwrap().parent().unwrap().to_path_buf();
        let libjsig = bin.parent().map(|home| home.join("lib/libjsig.so")).filter(|file| file.is_file());
        Some(Jdk { javac, java: bin.join("java"), libjsig })
    }

    /// Compiles `sources` into `classes`, with warnings being errors, as Java 8 (what Android takes everywhere).
    pub fn compile(&self, sources: &[PathBuf], classes: &Path) {
        let mut javac = Command::new(&self.javac);
        // `try`: the tests close tracers early on purpose.
        javac
            .args(["--release", "8", "-Xlint:all,-options,-try", "-Werror", "-cp"])
            .arg(classes)
            .arg("-d")
            .arg(classes);
        let output = javac.args(sources).output().unwrap();
        assert!(output.status.success(), "{javac:?}\n{}", String::from_utf8_lossy(&output.stderr));
    }

    /// Runs a class under `-Xcheck:jni`, whatever becomes of it. The library is that of `dev.rarefy.library`.
    pub fn output(
        &self,
        classes: &Path,
        class: &str,
        properties: &[(&str, &Path)],
        arguments: &[&str],
        variables: &[(&str, &str)],
    ) -> Output {
        let mut java = Command::new(&self.java);
        if let Some(libjsig) = &self.libjsig {
            java.env("LD_PRELOAD", libjsig);
        }
        java.args(["-Xcheck:jni", "-Xshare:auto", "-Xmx512m", "-Dfile.encoding=UTF-8"]);
        let library = built_library("librarefy_jni.so");
        for (name, value) in [("dev.rarefy.library", &*library)].iter().chain(properties) {
            let mut property = OsString::from(format!("-D{name}="));
            property.push(value);
            java.arg(property);
        }
        java.arg("-cp").arg(classes).arg(class).args(arguments);
        java.envs(variables.iter().copied()).output().unwrap()
    }
}

/// Standard output, then standard error.
pub fn all_text(output: &Output) -> String {
    [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text).into_owned()).concat()
}

/// The Java files in a folder; of the library those that do not need Android's classes.
pub fn java_files(folder: &str) -> Vec<PathBuf> {
    let files = root().join(folder).read_dir().unwrap().map(|entry| entry.unwrap().path());
    let java = files.filter(|file| file.extension().is_some_and(|extension| extension == "java"));
    let mut files: Vec<PathBuf> =
        java.filter(|file| !std::fs::read_to_string(file).unwrap().contains("\nimport android.")).collect();
    files.sort();
    assert!(!files.is_empty(), "{folder}");
    files
}

/// A library that cargo built beside this test, not older than its sources.
pub fn built_library(name: &str) -> PathBuf {
    let test = std::env::current_exe().unwrap();
    let folder = test.parent().unwrap().parent().unwrap();
    let library = folder.join(name);
    let remedy = "build it: `cargo build --workspace && cargo build --workspace --examples` (with --release for a \
                  release test)";
    let Ok(built) = library.metadata().and_then(|m| m.modified()) else {
        panic!("{} is not here; {remedy}", library.display());
    };
    for folder in ["android/jni/src", "android/jni/examples"] {
        for source in root().join(folder).read_dir().unwrap() {
            let source = source.unwrap();
            let part_of_it = folder.ends_with("src") || name.contains("probe");
            let stale = part_of_it && source.metadata().unwrap().modified().unwrap() > built;
            assert!(!stale, "{} is older than {}; {remedy}", library.display(), source.path().display());
        }
    }
    library
}

/// What `-Xcheck:jni` found wrong; it does not change the exit status.
pub fn jni_complaints(output: &str) -> Vec<&str> {
    const MARKS: [&str; 4] = ["WARNING in native", "FATAL ERROR", "WARNING: JNI", "handler was modified"];
    output.lines().filter(|line| MARKS.iter().any(|mark| line.contains(mark))).collect()
}
