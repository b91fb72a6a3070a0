// SPDX-License-Identifier: MIT OR Apache-2.0
//! How soon a cancelled call returns: `cargo bench -p rarefy-host-tests --bench cancel -- [MOMENTS] [SCENE]`.
//!
//! Cancels at MOMENTS (200) random moments each: loading a scene and making a renderer of it, adaptive and full frames,
//! supersampled frames in bands, on the CPU twin and on the first OpenCL device. Prints the median, the 95th percentile
//! and the longest time from the cancel to the return, in ms, of the moments that met work, and what was being done in
//! the three longest. Programs are built before.
//! SCENE is a folder; without one, `../shared/scenes/living-room` if it is there, else the built-in café.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use rarefy::internal::device::open::{DeviceChoice, DeviceOptions};
use rarefy::internal::method::counts::Keep;
use rarefy::internal::method::options::{Mode, RenderOptions};
use rarefy::internal::monitor::{Cancel, Event, Monitor};
use rarefy::internal::scene::{self, builtin};
use rarefy::{Error, Result};
use rarefy_host_tests::frames::renderer_of;

/// Random numbers, the same on every machine.
struct Random(u32);

impl Random {
    /// In [0, 1).
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(self.0 >> 8) / f64::from(1 << 24)
    }
}

/// Does `work` once for its time, then cancels it at random moments; prints a line.
fn measure(name: &str, moments: u32, work: &mut dyn FnMut(&Monitor) -> Result<()>) -> Result<()> {
    work(&Monitor::default())?;
    let started = Instant::now();
    work(&Monitor::default())?;
    let whole = started.elapsed();
    let mut random = Random(7);
    let mut latencies = Vec::new();
    for _ in 0..moments {
        let cancel = Cancel::default();
        let phase = Arc::new(Mutex::new(String::new()));
        let last = Arc::clone(&phase);
        let monitor = Monitor::new(move |event| {
            if let (Event::Progress { phase, share }, Ok(mut last)) = (event, last.lock()) {
                *last = format!("{phase} at {:.0} %", 100.0 * share);
            }
        })
        .with_cancel(&cancel);
        let pause = whole.mul_f64(random.unit());
        let (done, returned, cancelled) = std::thread::scope(|threads| {
            let canceller = threads.spawn(move || {
                std::thread::sleep(pause);
                let now = Instant::now();
                cancel.cancel();
                now
            });
            let done = work(&monitor);
            let returned = Instant::now();
            (done, returned, canceller.join().unwrap_or(returned))
        });
        match done {
            Err(Error::Cancelled) => {
                let phase = phase.lock().map(|phase| phase.clone()).unwrap_or_default();
                latencies.push((returned.saturating_duration_since(cancelled), phase));
            }
            other => other?,
        }
    }
    latencies.sort();
    let ms = |at: usize| latencies.get(at).map_or(Duration::ZERO, |found| found.0).as_secs_f64() * 1e3;
    let count = latencies.len();
    println!(
        "{name:34} {:8.0} {count:8} {:8.1} {:8.1} {:8.1}  {}",
        whole.as_secs_f64() * 1e3,
        ms(count / 2),
        ms((count * 95).div_ceil(100).saturating_sub(1)),
        ms(count.saturating_sub(1)),
        latencies.iter().rev().take(3).map(|(_, phase)| phase.as_str()).collect::<Vec<_>>().join(", ")
    );
    Ok(())
}

fn scene_folder(argument: Option<String>, temporary: &Path) -> Result<PathBuf> {
    let real = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/scenes/living-room");
    if let Some(folder) = argument.map(PathBuf::from).or(real.is_dir().then_some(real)) {
        return Ok(folder);
    }
    let folder = temporary.join("cafe");
    builtin::write("cafe", &folder)?;
    Ok(folder)
}

fn main() -> Result<()> {
    let mut arguments = std::env::args().skip(1).filter(|argument| argument != "--bench");
    let moments = arguments.next().and_then(|text| text.parse().ok()).unwrap_or(200);
    let temporary = tempfile::tempdir().map_err(|error| Error::io("temporary folder", error))?;
    let folder = scene_folder(arguments.next(), temporary.path())?;
    let sized = |width, height| RenderOptions { width, height, ..RenderOptions::default() };
    let frames = [
        ("adaptive 1024x1024", sized(1024, 1024)),
        ("full 1024x1024", RenderOptions { mode: Mode::Full, ..sized(1024, 1024) }),
        ("4x4 samples 480x270, bands", RenderOptions { samples: 4, band_rows: Some(256), ..sized(480, 270) }),
    ];
    println!(
        "{}\n{:34} {:>8} {:>8} {:>8} {:>8} {:>8}",
        folder.display(),
        "ms",
        "whole",
        "met",
        "median",
        "95 %",
        "most"
    );
    for (device_name, device) in [("twin", DeviceChoice::Twin), ("opencl", DeviceChoice::OpenCl(None))] {
        let options = DeviceOptions { device, ..DeviceOptions::default() };
        let make = |monitor: &Monitor| renderer_of(&scene::load(&folder, monitor)?, &options, monitor);
        measure(&format!("{device_name}: load and make ready"), moments, &mut |monitor| make(monitor).map(drop))?;
        let mut renderer = make(&Monitor::default())?;
        for (name, frame) in &frames {
            measure(&format!("{device_name}: {name}"), moments, &mut |monitor| {
                renderer.set_monitor(monitor);
                renderer.render_exactly(frame, Keep::default()).map(drop)
            })?;
        }
    }
    Ok(())
}
