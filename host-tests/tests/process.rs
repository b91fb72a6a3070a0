// SPDX-License-Identifier: MIT OR Apache-2.0
//! What may go wrong around the `rarefy` command: streams and files that are none, names that are no text, results that
//! would overwrite each other or what was read, memory that cannot be had.
#![cfg(unix)]
#![allow(clippy::unwrap_used, missing_docs)]

use std::ffi::{OsStr, OsString};
use std::fs::File;
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Command, Stdio};

use rarefy::internal::render::picture::read_rgb8;
use rarefy_host_tests::command::{Run, executable, rarefy_in};

const OBJ: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

fn run(folder: &Path, arguments: &str) -> Run {
    rarefy_in(folder, &arguments.split_whitespace().collect::<Vec<_>>(), &[])
}

/// What lies in a folder.
fn entries(folder: &Path) -> Vec<OsString> {
    let mut names: Vec<OsString> = folder.read_dir().unwrap().map(|e| e.unwrap().file_name()).collect();
    names.sort();
    names
}

fn pipe(path: &Path) {
    assert!(Command::new("mkfifo").arg(path).status().unwrap().success());
}

/// Runs the command with streams that nothing can be written to; its exit status.
fn unheard(folder: &Path, arguments: &str, streams: &dyn Fn() -> Stdio) -> Option<i32> {
    let mut command = Command::new(executable());
    command.args(arguments.split_whitespace()).current_dir(folder).stdout(streams()).stderr(streams());
    command.status().unwrap().code()
}

#[test]
fn streams_that_cannot_be_written_to_cost_no_picture() {
    let folder = tempfile::tempdir().unwrap();
    // Without a view there are warnings, before the picture.
    std::fs::write(folder.path().join("a.obj"), OBJ).unwrap();
    let closed = || {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        Stdio::from(writer)
    };
    let mut streams: Vec<&dyn Fn() -> Stdio> = vec![&closed];
    let full = || Stdio::from(File::options().write(true).open("/dev/full").unwrap());
    if Path::new("/dev/full").exists() {
        streams.push(&full);
    }
    for stream in streams {
        let picture = folder.path().join("a.png");
        assert_eq!(unheard(folder.path(), "render a.obj --device cpu --size 16x16 -o a.png", stream), Some(0));
        assert_eq!(read_rgb8(&picture).unwrap().0, 16);
        std::fs::remove_file(picture).unwrap();
        for (arguments, status) in [
            ("doctor a.obj", 0),
            ("doctor missing.obj", 2),
            ("render a.obj --device cpu --size 16x16 -o no/such.png", 2),
            ("--no-such-option", 2),
            // Whoever asks for the figures on standard output is told that they are not there.
            ("doctor a.obj --json -", 2),
        ] {
            assert_eq!(unheard(folder.path(), arguments, stream), Some(status), "{arguments}");
        }
    }
}

#[test]
fn what_is_no_file_is_never_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    pipe(&path("fifo"));
    symlink("/dev/zero", path("zero")).unwrap();
    std::fs::create_dir(path("folder")).unwrap();
    for (name, kind) in [("./fifo", "a pipe"), ("./zero", "a device")] {
        let kind = format!("this is {kind}");
        for arguments in [
            format!("render wall --size 16x16 -o out.png --profile {name}"),
            format!("devices --profile {name}"),
            format!("doctor {name}"),
            format!("diff {name} {name}"),
        ] {
            println!("{arguments}");
            run(folder.path(), &arguments).expect_error(&[name, &kind]);
        }
    }
    run(folder.path(), "diff folder folder").expect_error(&["folder", "this is a folder, not a file"]);
    std::fs::create_dir(path("scene")).unwrap();
    symlink("/dev/zero", path("scene/scene.obj")).unwrap();
    run(folder.path(), "doctor scene").expect_error(&["scene.obj"]);
}

#[test]
fn a_file_that_is_too_large_is_refused_by_its_size() {
    let folder = tempfile::tempdir().unwrap();
    // Sparse: a length without contents.
    File::create(folder.path().join("p.json")).unwrap().set_len(5 << 20).unwrap();
    run(folder.path(), "devices --profile p.json").expect_error(&["p.json", "5242880 bytes", "4194304 bytes"]);
}

#[test]
fn no_result_overwrites_another_or_what_was_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    std::fs::create_dir(path("scene")).unwrap();
    std::fs::write(path("scene/scene.obj"), OBJ).unwrap();
    // A scene whose OBJ file names others.
    std::fs::create_dir(path("textured")).unwrap();
    std::fs::write(path("textured/scene.obj"), format!("mtllib m.mtl\nusemtl a\n{OBJ}")).unwrap();
    std::fs::write(path("textured/m.mtl"), "newmtl a\nmap_Kd t.png\nmap_d ../opacity.png\n").unwrap();
    image::RgbImage::new(2, 2).save(path("textured/t.png")).unwrap();
    image::RgbImage::new(2, 2).save(path("opacity.png")).unwrap();
    std::fs::write(path("profile.json"), "{}").unwrap();
    symlink(path("scene"), path("same")).unwrap();
    std::fs::write(path("a.png"), "").unwrap();
    symlink(path("a.png"), path("b.png")).unwrap();
    let before = entries(folder.path());
    let draw = "render scene --device cpu --size 16x16";
    let twice = "writes to the same file";
    let read = "is read by the same command";
    for (arguments, parts) in [
        (format!("{draw} -o c.png --layer class=c.png"), ["--layer", "c.png", twice]),
        (format!("{draw} -o c.png --layer class=./c.png"), ["--layer", "./c.png", twice]),
        (format!("{draw} -o a.png --layer class=b.png"), ["--layer", "b.png", twice]),
        (format!("{draw} -o c.png --layer class=d.png --layer normal=scene/../d.png"), ["--layer", "d.png", twice]),
        (format!("{draw} -o c.png --json c.png"), ["--json", "c.png", twice]),
        (format!("{draw} -o scene/scene.obj"), ["-o", "scene.obj", read]),
        (format!("{draw} -o c.png --json same/scene.obj"), ["--json", "scene.obj", read]),
        (format!("{draw} -o c.png --json profile.json --profile profile.json"), ["--json", "profile.json", read]),
        ("diff a.png c.png -o a.png".to_owned(), ["-o", "a.png", read]),
        ("diff c.png a.png -o b.png".to_owned(), ["-o", "b.png", read]),
        ("diff a.png a.png -o c.png --json c.png".to_owned(), ["--json", "c.png", twice]),
        ("doctor scene --json scene/scene.obj".to_owned(), ["--json", "scene.obj", read]),
        (format!("{draw} -o textured/t.png").replace("scene --", "textured --"), ["-o", "t.png", read]),
        (
            format!("{draw} -o c.png --layer class=opacity.png").replace("scene --", "textured --"),
            ["--layer", "opacity.png", read],
        ),
        ("compare textured --device cpu --frames 1 --json textured/m.mtl".to_owned(), ["--json", "m.mtl", read]),
        ("doctor textured --json textured/m.mtl".to_owned(), ["--json", "m.mtl", read]),
        ("bake textured -o textured/m.mtl".to_owned(), ["-o", "m.mtl", read]),
        ("compare scene --device cpu --frames 1 -o . --json full.png".to_owned(), ["-o", "full.png", twice]),
    ] {
        println!("{arguments}");
        run(folder.path(), &arguments).expect_error(&parts);
    }
    assert_eq!(entries(folder.path()), before);
    assert_eq!(std::fs::read_to_string(path("scene/scene.obj")).unwrap(), OBJ);
    assert!(std::fs::read_to_string(path("textured/m.mtl")).unwrap().starts_with("newmtl"));
    // Different files are no matter, and neither are devices, which nothing is lost in.
    run(folder.path(), &format!("{draw} -o c.png --layer class=d.png --json scene/e.json")).expect(0);
    run(folder.path(), &format!("{draw} -o /dev/null --layer class=/dev/null")).expect(0);
}

#[test]
fn pictures_of_other_formats_are_refused_before_work_begins() {
    let folder = tempfile::tempdir().unwrap();
    for arguments in ["render nosuch -o x.jpg", "render nosuch -o a.png --layer class=x.jpg", "diff no such -o x.jpg"] {
        run(folder.path(), arguments).expect_error(&["x.jpg", "written as PNG, not as jpg"]);
    }
    run(folder.path(), "render nosuch -o x.TIFF").expect_error(&["not as tiff"]);
    // Any other name will do.
    run(folder.path(), "render wall --device cpu --size 16x16 -o x.part").expect(0);
    assert_eq!(entries(folder.path()), ["x.part"]);
}

#[test]
fn results_go_where_a_link_leads_and_nowhere_by_a_pipe_that_nobody_reads() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let draw = "render wall --device cpu --size 16x16";
    std::fs::write(path("real"), "old").unwrap();
    symlink(path("real"), path("link")).unwrap();
    run(folder.path(), &format!("{draw} -o link")).expect(0);
    assert!(path("link").symlink_metadata().unwrap().is_symlink());
    assert_eq!(read_rgb8(path("real")).unwrap().0, 16);
    symlink(path("missing"), path("nowhere")).unwrap();
    run(folder.path(), &format!("{draw} -o nowhere")).expect_error(&["nowhere", "symbolic link to nothing"]);
    pipe(&path("fifo"));
    run(folder.path(), &format!("{draw} -o fifo")).expect_error(&["fifo"]);
    assert_eq!(entries(folder.path()), ["fifo", "link", "nowhere", "real"]);
    // One that is read gets the picture whole.
    let reader = Command::new("cat").arg(path("fifo")).stdout(File::create(path("copy")).unwrap()).spawn().unwrap();
    // The pipe has a reader once `cat` has opened it, which a writer without a wait has to wait for itself.
    while run(folder.path(), &format!("{draw} -o fifo")).status == 2 {
        std::thread::yield_now();
    }
    assert!(reader.wait_with_output().unwrap().status.success());
    assert_eq!(std::fs::read(path("copy")).unwrap(), std::fs::read(path("real")).unwrap());
}

/// Some systems refuse names that are no text.
#[cfg(target_os = "linux")]
#[test]
fn names_of_files_need_not_be_text() {
    let folder = tempfile::tempdir().unwrap();
    let name = |suffix: &str| OsStr::from_bytes(&[b"\xffscene", suffix.as_bytes()].concat()).to_owned();
    let scene = folder.path().join(name(""));
    std::fs::create_dir(&scene).unwrap();
    std::fs::write(scene.join("scene.obj"), OBJ).unwrap();
    std::fs::write(folder.path().join(name(".json")), r#"{"limits":{}}"#).unwrap();
    let layer = [b"class=".as_slice(), name(".class.png").as_bytes()].concat();
    let draw = |arguments: &[&OsStr]| {
        let mut command = Command::new(executable());
        let output = command.args(arguments).current_dir(folder.path()).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    };
    let word = OsStr::new;
    draw(&[
        word("render"),
        &name(""),
        word("--device=cpu"),
        word("--size=16x16"),
        word("-o"),
        &name(".png"),
        word("--layer"),
        OsStr::from_bytes(&layer),
        word("--profile"),
        &name(".json"),
        word("--json"),
        &name(".figures"),
    ]);
    draw(&[word("doctor"), &name("")]);
    draw(&[word("diff"), &name(".png"), &name(".class.png"), word("-o"), &name(".difference.png")]);
    let mut wanted = ["", ".class.png", ".difference.png", ".figures", ".json", ".png"].map(name).to_vec();
    wanted.sort();
    assert_eq!(entries(folder.path()), wanted);
}

/// Runs the command with so much address space.
#[cfg(target_os = "linux")]
fn run_within(folder: &Path, megabytes: u32, arguments: &str) -> Run {
    let limited = format!("ulimit -v {} && exec \"$0\" \"$@\"", megabytes * 1024);
    let mut command = Command::new("sh");
    command.args(["-c", &limited]).arg(executable()).args(arguments.split_whitespace()).current_dir(folder);
    let output = command.output().unwrap();
    Run {
        status: output.status.code().unwrap_or(-1),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}

/// A PNG whose pixels are all black: small as a file, large in memory.
fn black_png(path: &Path, width: u32, height: u32) {
    let mut file = std::io::BufWriter::new(File::create(path).unwrap());
    let encoder = image::codecs::png::PngEncoder::new(&mut file);
    let pixels = vec![0; width as usize * height as usize];
    image::ImageEncoder::write_image(encoder, &pixels, width, height, image::ExtendedColorType::L8).unwrap();
}

#[test]
fn a_small_file_of_a_huge_picture_is_refused_by_its_pixels() {
    let folder = tempfile::tempdir().unwrap();
    black_png(&folder.path().join("a.png"), 16_384, 4097);
    assert!(folder.path().join("a.png").metadata().unwrap().len() < 1 << 20);
    run(folder.path(), "diff a.png a.png -o b.png").expect_error(&["a.png", "16384x4097", "67108864 pixels"]);
    assert_eq!(entries(folder.path()), ["a.png"]);
}

#[cfg(target_os = "linux")]
#[test]
fn memory_that_cannot_be_had_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let wall = "render wall --device cpu -o out.png --size";
    // The buffers of a frame, at once and in bands; what the host keeps of all bands.
    run_within(folder.path(), 300, &format!("{wall} 4096x4096")).expect_error(&["not enough memory", "buffer"]);
    run_within(folder.path(), 300, &format!("{wall} 8192x8192 --memory-budget 64"))
        .expect_error(&["not enough memory", "samples"]);
    // Pictures.
    black_png(&folder.path().join("a.png"), 8192, 8192);
    run_within(folder.path(), 200, "diff a.png a.png").expect_error(&["not enough memory", "a.png"]);
    assert_eq!(entries(folder.path()), ["a.png"]);
    // With enough of it all goes well.
    run_within(folder.path(), 300, &format!("{wall} 64x64")).expect(0);
}

#[test]
fn a_budget_that_is_too_small_is_named_as_it_was_given() {
    let folder = tempfile::tempdir().unwrap();
    for mib in [1, 5] {
        run(folder.path(), &format!("render cafe --device cpu --size 64x64 --memory-budget {mib}"))
            .expect_error(&["--memory-budget", &format!("allows {} KiB in all (", mib * 1024)]);
    }
}
