// SPDX-License-Identifier: MIT OR Apache-2.0
//! The command line's grammar, and its translation into the library's options.

use std::ffi::{OsStr, OsString};
use std::path::PathBuf;
use std::str::FromStr;

use clap::{Args, Parser, Subcommand, ValueEnum};
use rarefy::internal::device::open::{DeviceChoice, DeviceOptions};
use rarefy::internal::device::profiles::Profile;
use rarefy::internal::error::Setting;
use rarefy::internal::method::options::{Mode, RenderOptions};
use rarefy::internal::prepare::Shading;
use rarefy::{Error, Result};

use super::method::MethodArgs;

/// A ray tracer that traces a quarter to a third of the pixels and rebuilds the rest.
#[derive(Debug, Parser)]
#[command(name = "rarefy", version, propagate_version = true)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Draw a scene into a PNG file.
    Render(Box<RenderArgs>),
    /// Draw a scene in full and adaptively, in turn, and compare speed, work and quality.
    Compare(Box<CompareArgs>),
    /// Measure every table and figure of the paper, and write a report beside the published results.
    Bench(BenchArgs),
    /// Measure the difference of two pictures of one size.
    Diff(DiffArgs),
    /// List OpenCL devices, what was skipped and why, and their limits.
    Devices(DevicesArgs),
    /// Check every kernel on this device against known answers.
    Selftest(SelftestArgs),
    /// Report what is odd about a scene.
    Doctor(DoctorArgs),
    /// Write a scene as one file that loads in a fraction of the time: for apps.
    Bake(BakeArgs),
    /// Write a built-in scene as OBJ, MTL, PNG and view.json.
    MakeScene(MakeSceneArgs),
}

/// Width and height in pixels.
#[derive(Debug, Clone, Copy)]
pub struct Size {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
}

fn parse_size(text: &str) -> std::result::Result<Size, String> {
    let bad = || format!("`{text}` is not WIDTHxHEIGHT in pixels, such as 1024x768");
    let (width, height) = text.split_once(['x', 'X']).ok_or_else(bad)?;
    Ok(Size { width: width.trim().parse().map_err(|_| bad())?, height: height.trim().parse().map_err(|_| bad())? })
}

/// Reads what the library names: a mode, a device, a set of tests.
pub fn named<T: FromStr<Err = Error>>(text: &str) -> std::result::Result<T, String> {
    text.parse().map_err(|error| match error {
        Error::InvalidOption { value, allowed, .. } => format!("`{value}` is not one of these: {allowed}"),
        other => other.to_string(),
    })
}

/// `--build`: the one choice of the command that the library has as a switch.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum BuildArg {
    /// What the device does fastest.
    Fast,
    /// Bit for bit like the CPU twin.
    Strict,
}

/// What commands that draw have in common.
#[derive(Debug, Args)]
pub struct DrawArgs {
    /// A folder with scene.obj and view.json, an OBJ file, a baked file, or the name of a built-in scene.
    pub scene: PathBuf,
    /// Size of the picture in pixels.
    #[arg(long, value_parser = parse_size, default_value = "1024x1024", allow_hyphen_values = true)]
    pub size: Size,
    /// Samples per pixel and axis: 1, 2 or 4.
    #[arg(long, default_value_t = 1)]
    pub samples: u32,
    /// Most secondary rays in a chain; straight ones through panes of thin glass do not count.
    #[arg(long, default_value_t = 4)]
    pub depth: u32,
    /// How adaptive frames are drawn.
    #[command(flatten)]
    pub method: MethodArgs,
    /// Which device draws: auto, cpu, twin, opencl or opencl:N.
    #[arg(long, value_parser = named::<DeviceChoice>, default_value = "auto")]
    pub device: DeviceChoice,
    /// Hold the OpenCL device to a profile's limits: none, a built-in name such as adreno-420, or a file.
    #[arg(long, default_value = "none")]
    pub profile: OsString,
    /// Try again what ended the process, or did not build, at an earlier start.
    #[arg(long)]
    pub retry_crashed: bool,
    /// Most device memory in MiB.
    #[arg(long, value_name = "MiB")]
    pub memory_budget: Option<u64>,
    /// Shading rules.
    #[arg(long, value_parser = named::<Shading>, default_value = "full", value_name = "full|anchor")]
    pub shading: Shading,
    /// Kernels: the device's fastest, or bit for bit like the CPU twin.
    #[arg(long, value_enum, default_value = "fast")]
    pub build: BuildArg,
    /// Write statistics as JSON into this file; `-` is standard output.
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
}

impl DrawArgs {
    /// The renderer's options.
    pub fn device_options(&self) -> Result<DeviceOptions> {
        let budget = self.memory_budget.map(|mib| {
            let bytes = mib.checked_mul(1 << 20).filter(|&bytes| bytes > 0);
            bytes.ok_or_else(|| Error::option(Setting::MemoryBudget, format!("{mib} MiB"), "1 MiB or more"))
        });
        Ok(DeviceOptions {
            device: self.device,
            profile: profile(&self.profile)?,
            strict: matches!(self.build, BuildArg::Strict),
            memory_budget_bytes: budget.transpose()?,
            retry_crashed: self.retry_crashed,
            ..DeviceOptions::default()
        })
    }

    /// The frame's options in `mode`.
    pub fn render_options(&self, mode: Mode) -> Result<RenderOptions> {
        let options = RenderOptions {
            width: self.size.width,
            height: self.size.height,
            samples: self.samples,
            mode,
            depth: self.depth,
            method: self.method.method()?,
            ..RenderOptions::default()
        };
        options.validate()?;
        Ok(options)
    }
}

/// The profile that `name` means: none, a built-in one, or a file's.
pub fn profile(name: &OsStr) -> Result<Option<Profile>> {
    Profile::find(name)
}

/// `rarefy render`.
#[derive(Debug, Args)]
pub struct RenderArgs {
    /// Scene and options.
    #[command(flatten)]
    pub draw: DrawArgs,
    /// Where the picture goes.
    #[arg(short, long, default_value = "out.png")]
    pub output: PathBuf,
    /// Which pixels get rays.
    #[arg(long, value_parser = named::<Mode>, default_value = "adaptive", value_name = "adaptive|full")]
    pub mode: Mode,
    /// Also write a layer: color, class, fail-mask, test-g1 to test-gc, object, normal, depth, shadow, rays.
    #[arg(long, value_name = "NAME=FILE.png")]
    pub layer: Vec<OsString>,
}

/// `rarefy compare`.
#[derive(Debug, Args)]
pub struct CompareArgs {
    /// Scene and options.
    #[command(flatten)]
    pub draw: DrawArgs,
    /// Timed frames of each mode, in turn.
    #[arg(long, default_value_t = 3)]
    pub frames: u32,
    /// Folder for full.png, adaptive.png, difference.png, class.png and fail-mask.png.
    #[arg(short, long)]
    pub output: Option<PathBuf>,
    /// Also model what lock-step waves of 32, 64 and 128 lanes pay for both ways of drawing.
    #[arg(long)]
    pub wave_model: bool,
}

/// `rarefy bench`.
#[derive(Debug, Args)]
pub struct BenchArgs {
    /// Scenes in place of the built-in ones: folders, OBJ files, baked files or names. The sweeps keep their own.
    pub scenes: Vec<PathBuf>,
    /// Folder for report.html, report.md, report.json and pictures. A run that was ended goes on where it was.
    #[arg(short, long)]
    pub output: PathBuf,
    /// Small pictures: minutes, where all of it takes far longer.
    #[arg(long)]
    pub quick: bool,
    /// Side of the pictures of the main tables, in pixels; the others are larger or smaller with it.
    #[arg(long, value_name = "PIXELS")]
    pub size: Option<u32>,
    /// Which device draws: auto, cpu, twin, opencl or opencl:N.
    #[arg(long, value_parser = named::<DeviceChoice>, default_value = "auto")]
    pub device: DeviceChoice,
    /// Hold the OpenCL device to a profile's limits: none, a built-in name such as adreno-420, or a file.
    #[arg(long, default_value = "none")]
    pub profile: OsString,
}

/// `rarefy diff`.
#[derive(Debug, Args)]
pub struct DiffArgs {
    /// The reference picture, PNG or JPEG, of at most 67,108,864 pixels (8192x8192).
    pub reference: PathBuf,
    /// The picture to judge.
    pub test: PathBuf,
    /// Where the 10x difference goes.
    #[arg(short, long)]
    pub output: Option<PathBuf>,
    /// Write the figures as JSON into this file; `-` is standard output.
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
}

/// `rarefy devices`.
#[derive(Debug, Args)]
pub struct DevicesArgs {
    /// Write all limits as JSON into this file; `-` is standard output. Such a file is a device profile.
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Show limits and choices beside those under this profile; `none`: the device's alone.
    #[arg(long, default_value = "adreno-420")]
    pub profile: OsString,
}

/// `rarefy selftest`.
#[derive(Debug, Args)]
pub struct SelftestArgs {
    /// Which device to test: auto, cpu, twin, opencl or opencl:N.
    #[arg(long, value_parser = named::<DeviceChoice>, default_value = "auto")]
    pub device: DeviceChoice,
    /// Hold the OpenCL device to a profile's limits.
    #[arg(long, default_value = "none")]
    pub profile: OsString,
    /// Break this stage's kernel on purpose: the self-test must fail and name it.
    #[arg(long, value_name = "STAGE")]
    pub break_stage: Option<String>,
}

/// `rarefy doctor`.
#[derive(Debug, Args)]
pub struct DoctorArgs {
    /// A folder with scene.obj and view.json, an OBJ file, a baked file, or the name of a built-in scene.
    pub scene: PathBuf,
    /// Write the findings as JSON into this file; `-` is standard output.
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
}

/// `rarefy bake`.
#[derive(Debug, Args)]
pub struct BakeArgs {
    /// A folder with scene.obj and view.json, an OBJ file, a baked file, or the name of a built-in scene.
    pub scene: PathBuf,
    /// The file to write.
    #[arg(short, long)]
    pub output: PathBuf,
    /// Shading rules, which stay those of the file.
    #[arg(long, value_parser = named::<Shading>, default_value = "full", value_name = "full|anchor")]
    pub shading: Shading,
}

/// `rarefy make-scene`.
#[derive(Debug, Args)]
pub struct MakeSceneArgs {
    /// Name of the built-in scene.
    pub name: String,
    /// The folder to write; must be empty or not exist.
    #[arg(short, long)]
    pub output: PathBuf,
}
