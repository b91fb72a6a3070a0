// SPDX-License-Identifier: MIT OR Apache-2.0
//! `rarefy render`.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use rarefy::internal::analysis::layers::{self, Layer};
use rarefy::internal::analysis::report::RenderReport;
use rarefy::internal::method::counts::Keep;
use rarefy::internal::method::options::Mode;
use rarefy::internal::render::picture::{write_png, write_small_png};
use rarefy::{Error, Result};

use super::args::RenderArgs;
use super::interrupt::Interrupt;
use super::output::{say, traced, warn_all, write_json};
use super::outputs::Outputs;
use super::progress::{make_renderer, watched};

/// Draws one frame; writes the picture, the layers and the statistics.
pub fn run(args: &RenderArgs, interrupt: &Interrupt) -> Result<()> {
    let mode = args.mode;
    let options = args.draw.render_options(mode)?;
    let layers = args.layer.iter().map(|text| parse_layer(text)).collect::<Result<Vec<_>>>()?;
    let mut keep = Keep::default();
    for (layer, _) in &layers {
        if mode == Mode::Full && layer.is_adaptive_only() {
            return Err(Error::argument(
                "--layer",
                format!("full tracing has no layer `{layer}`; use --mode adaptive"),
            ));
        }
        keep = keep.and(layer.needs());
    }
    let mut outputs = Outputs::of_scene(&args.draw.scene, Path::new(&args.draw.profile));
    outputs.picture("-o", &args.output)?;
    for (_, path) in &layers {
        outputs.picture("--layer", path)?;
    }
    outputs.json(args.draw.json.as_deref())?;

    let (mut renderer, load_ms) =
        make_renderer(&args.draw.scene, args.draw.shading, &args.draw.device_options()?, &outputs, interrupt)?;
    let notices = renderer.notices().len();
    // Whoever looks at what the method did wants to see it where it may lose detail too.
    let wants_method = layers.iter().any(|(layer, _)| layer.is_adaptive_only());
    let frame = watched(&mut renderer, interrupt, |renderer| match wants_method {
        true => renderer.render_exactly(&options, keep),
        false => renderer.render(&options, keep),
    })?;
    warn_all(&renderer.notices()[notices..]);
    // File by file: Ctrl-C lets the one that is being written be finished.
    interrupt.watch(|cancel| {
        write_png(&args.output, frame.width, frame.height, &frame.pixels)?;
        for (layer, path) in &layers {
            cancel.check()?;
            let is_color = *layer == Layer::Color;
            let (width, height) = if is_color { (frame.width, frame.height) } else { options.sample_size() };
            write_small_png(path, width, height, &layers::draw(*layer, &mut renderer, &frame)?)?;
        }
        Ok(())
    })?;
    let json = args.draw.json.as_deref();
    let info = renderer.info();
    say(
        json,
        &format!(
            "{}: {}x{} on {} in {:.0} ms, traced {}",
            args.output.display(),
            frame.width,
            frame.height,
            info.name,
            frame.stats.frame_ms,
            traced(&frame.stats)
        ),
    );
    if frame.stats.fell_back {
        say(
            json,
            "traced in full: the adaptive frame may have lost detail, or frames before cost as much as full ones",
        );
    }
    match json {
        Some(path) => write_json(path, &RenderReport::new(&mut renderer, &options, &frame, load_ms)),
        None => Ok(()),
    }
}

fn parse_layer(text: &OsStr) -> Result<(Layer, PathBuf)> {
    let (name, path) = split_at_equals(text)
        .filter(|(_, path)| !path.as_os_str().is_empty())
        .ok_or_else(|| Error::argument("--layer", format!("`{}` is not NAME=FILE.png", text.display())))?;
    Ok((name.parse()?, path))
}

/// What stands before and after the first `=`; names of files need not be UTF-8.
#[cfg(unix)]
fn split_at_equals(text: &OsStr) -> Option<(String, PathBuf)> {
    use std::os::unix::ffi::OsStrExt;
    let bytes = text.as_bytes();
    let at = bytes.iter().position(|&byte| byte == b'=')?;
    Some((String::from_utf8_lossy(&bytes[..at]).into_owned(), OsStr::from_bytes(&bytes[at + 1..]).into()))
}

#[cfg(not(unix))]
fn split_at_equals(text: &OsStr) -> Option<(String, PathBuf)> {
    let (name, path) = text.to_str()?.split_once('=')?;
    Some((name.to_owned(), path.into()))
}
