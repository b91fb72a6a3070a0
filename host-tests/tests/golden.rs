// SPDX-License-Identifier: MIT OR Apache-2.0
//! Golden pictures of intermediate layers: they say where a picture went wrong, not only that it did.
//!
//! `host-tests/golden/SCENE-LAYER.png` holds what the CPU twin draws. After an intended change, look at the pictures in
//! the folder that a failing test names, then `RAREFY_BLESS=1 cargo test -p rarefy-host-tests --test golden`.

use std::path::{Path, PathBuf};

use rarefy::internal::analysis::layers::{self, Layer};
use rarefy::internal::device::open::{DeviceChoice, DeviceOptions};
use rarefy::internal::method::counts::Keep;
use rarefy::internal::method::options::{Mode, RenderOptions};
use rarefy::internal::render::picture::{read_rgb8, write_png};
use rarefy::internal::scene::builtin;
use rarefy_host_tests::command::root;
use rarefy_host_tests::frames::renderer_of;

const WIDTH: u32 = 128;
const HEIGHT: u32 = 96;
const SCENES: [&str; 3] = ["spheres", "mirror-room", "rods"];
const LAYERS: [&str; 8] = ["color", "object", "normal", "depth", "shadow", "rays", "class", "fail-mask"];
/// A golden picture may not grow beyond this.
const MOST_BYTES: u64 = 40 << 10;

fn golden(scene: &str, layer: &str) -> PathBuf {
    root().join("host-tests/golden").join(format!("{scene}-{layer}.png"))
}

/// Pixels that differ, or what is wrong with the stored picture.
fn pixels_apart(path: &Path, drawn: &[u32]) -> Result<usize, String> {
    let (width, height, stored) = read_rgb8(path).map_err(|e| e.to_string())?;
    if (width, height) != (WIDTH, HEIGHT) {
        return Err(format!("{}: {width}x{height} instead of {WIDTH}x{HEIGHT}", path.display()));
    }
    Ok(stored.iter().zip(drawn).filter(|(a, b)| a != b).count())
}

#[test]
fn layers_are_what_they_were() {
    let bless = std::env::var_os("RAREFY_BLESS").is_some();
    let failed_folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("golden");
    let mut failures = Vec::new();
    for name in SCENES {
        let options = DeviceOptions { device: DeviceChoice::Twin, ..DeviceOptions::default() };
        let mut renderer =
            renderer_of(&builtin::to_scene(name).unwrap(), &options, &rarefy::Monitor::default()).unwrap();
        let options = RenderOptions { width: WIDTH, height: HEIGHT, mode: Mode::Adaptive, ..RenderOptions::default() };
        let frame = renderer.render_exactly(&options, Keep::EVERYTHING).unwrap();
        for layer in LAYERS {
            let drawn = layers::draw(layer.parse::<Layer>().unwrap(), &mut renderer, &frame).unwrap();
            let path = golden(name, layer);
            if bless {
                write_png(&path, WIDTH, HEIGHT, &drawn).unwrap();
            }
            match pixels_apart(&path, &drawn) {
                Ok(0) => assert!(path.metadata().unwrap().len() <= MOST_BYTES, "{} is too large", path.display()),
                other => {
                    std::fs::create_dir_all(&failed_folder).unwrap();
                    let now = failed_folder.join(format!("{name}-{layer}.png"));
                    write_png(&now, WIDTH, HEIGHT, &drawn).unwrap();
                    failures.push(format!("{name} {layer}: {other:?} pixels differ; now {}", now.display()));
                }
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn one_changed_pixel_is_seen() {
    let path = golden("spheres", "normal");
    let (_, _, mut pixels) = read_rgb8(&path).unwrap();
    assert_eq!(pixels_apart(&path, &pixels), Ok(0));
    pixels[4321] ^= 1;
    assert_eq!(pixels_apart(&path, &pixels), Ok(1));
}
