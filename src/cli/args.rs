// SPDX-License-Identifier: MIT OR Apache-2.0
//! The command line's grammar, and its translation into the library's options.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
use rarefy::device::profiles::Profile;
use rarefy::method::options::{Correction, CorrectionMethod, Interpolation, Mode, RenderOptions, Test};
use rarefy::prepare::scene_buffers::Shading;
use rarefy::render::renderer::{DeviceChoice, RendererOptions};
use rarefy::{Error, Result};

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
    /// Measure the difference of two pictures of one size.
    Diff(DiffArgs),
    /// List OpenCL devices, what was skipped and why, and their limits.
    Devices(DevicesArgs),
    /// Check every kernel on this device against known answers.
    Selftest(SelftestArgs),
    /// Report what is odd about a scene.
    Doctor(DoctorArgs),
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

fn parse_device(text: &str) -> std::result::Result<DeviceChoice, String> {
    match text.split_once(':').unwrap_or((text, "")) {
        ("auto", "") => Ok(DeviceChoice::Auto),
        ("cpu", "") => Ok(DeviceChoice::Cpu),
        ("opencl", "") => Ok(DeviceChoice::OpenCl(None)),
        ("opencl", n) => {
            n.parse().map(|n| DeviceChoice::OpenCl(Some(n))).map_err(|_| format!("`{n}` is not a device number"))
        }
        _ => Err(format!("`{text}` is not auto, cpu, opencl or opencl:N")),
    }
}

/// `--correction`.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum CorrectionArg {
    /// None.
    Off,
    /// Compare object ids.
    Object,
    /// Compare object ids and shadow bits.
    #[value(name = "object+shadow")]
    ObjectAndShadow,
    /// Compare object ids, shadow bits, normals and reflected colours.
    All,
}

/// `--correction-method`.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum CorrectionMethodArg {
    /// Rounds until nothing changes.
    Converged,
    /// The paper's single round of four sweeps.
    Sweeps,
}

/// `--interpolation`.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum InterpolationArg {
    /// Midway on the screen.
    Perspective,
    /// Midway in space, as in the paper.
    Plain,
}

/// `--mode`.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum ModeArg {
    /// The method.
    Adaptive,
    /// A ray tree for every pixel.
    Full,
}

/// `--shading`.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum ShadingArg {
    /// Everything the scene asks for.
    Full,
    /// The rules of the speed anchor.
    Anchor,
}

/// `--gcol-space`.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum GcolSpaceArg {
    /// Square roots of the channels, close to what a display shows.
    Display,
    /// Linear light.
    Linear,
}

/// `--rules`.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum RulesArg {
    /// Our defaults.
    Ours,
    /// The paper's tolerances, interpolation and correction.
    Paper,
}

/// `--build`.
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
    /// A folder with scene.obj and view.json, an OBJ file, or the name of a built-in scene.
    pub scene: String,
    /// Size of the picture in pixels.
    #[arg(long, value_parser = parse_size, default_value = "1024x1024", allow_hyphen_values = true)]
    pub size: Size,
    /// Samples per pixel and axis: 1, 2 or 4.
    #[arg(long, default_value_t = 1)]
    pub samples: u32,
    /// Side of the base blocks: 2, or 4 for two levels.
    #[arg(long, default_value_t = 2)]
    pub blocks: u32,
    /// Most secondary rays in a chain; straight ones through panes of thin glass do not count.
    #[arg(long, default_value_t = 4)]
    pub depth: u32,
    /// Whose defaults count for the options below.
    #[arg(long, value_enum, default_value = "ours")]
    pub rules: RulesArg,
    /// What post-correction compares; all by default.
    #[arg(long, value_enum)]
    pub correction: Option<CorrectionArg>,
    /// How post-correction spreads; converged by default.
    #[arg(long, value_enum)]
    pub correction_method: Option<CorrectionMethodArg>,
    /// Where between its references an interpolated pixel lies; perspective by default.
    #[arg(long, value_enum)]
    pub interpolation: Option<InterpolationArg>,
    /// From which difference of a colour channel of 0 to 255 on pixels look different, for the lenient shadow test and
    /// for correction; 0: always.
    #[arg(long)]
    pub t_visible: Option<u32>,
    /// G2: largest distance of the two hits, as a share of the scene's extent.
    #[arg(long, allow_negative_numbers = true)]
    pub t_pos: Option<f32>,
    /// G3: least dot product of the normals.
    #[arg(long, allow_negative_numbers = true)]
    pub t_norm: Option<f32>,
    /// G4: sine of the slope below which a surface counts as flat.
    #[arg(long, allow_negative_numbers = true)]
    pub t_conv: Option<f32>,
    /// TX: how near to the border of its repetition a texture coordinate counts as at the border.
    #[arg(long, allow_negative_numbers = true)]
    pub t_tex: Option<f32>,
    /// GC: largest distance of the reflected colours.
    #[arg(long, allow_negative_numbers = true)]
    pub t_gcol: Option<f32>,
    /// GC: compare reflected colours as displayed or linearly.
    #[arg(long, value_enum)]
    pub gcol_space: Option<GcolSpaceArg>,
    /// Tests to switch off, such as gc,tx.
    #[arg(long, value_delimiter = ',')]
    pub disable_test: Vec<String>,
    /// Which device draws: auto, cpu, opencl or opencl:N.
    #[arg(long, value_parser = parse_device, default_value = "auto")]
    pub device: DeviceChoice,
    /// Hold the OpenCL device to a profile's limits: none, a built-in name such as adreno-420, or a file.
    #[arg(long, default_value = "none")]
    pub profile: String,
    /// Rays per work-item.
    #[arg(long, default_value = "auto")]
    pub lanes: String,
    /// Most device memory in MiB.
    #[arg(long, value_name = "MiB")]
    pub memory_budget: Option<u64>,
    /// Shading rules.
    #[arg(long, value_enum, default_value = "full")]
    pub shading: ShadingArg,
    /// Kernels: the device's fastest, or bit for bit like the CPU twin.
    #[arg(long, value_enum, default_value = "fast")]
    pub build: BuildArg,
    /// Write statistics as JSON into this file; `-` is standard output.
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
}

impl DrawArgs {
    /// The renderer's options.
    pub fn renderer_options(&self) -> Result<RendererOptions> {
        if !matches!(self.lanes.as_str(), "auto" | "1" | "1:1") {
            let message = format!("`{}` is not available; one ray per work-item is: 1", self.lanes);
            return Err(Error::option("--lanes", message));
        }
        let budget = self.memory_budget.map(|mib| {
            let bytes = mib.checked_mul(1 << 20).filter(|&bytes| bytes > 0);
            bytes.ok_or_else(|| Error::option("--memory-budget", format!("{mib} MiB is out of range")))
        });
        Ok(RendererOptions {
            device: self.device,
            profile: profile(&self.profile)?,
            strict: matches!(self.build, BuildArg::Strict),
            shading: match self.shading {
                ShadingArg::Full => Shading::Full,
                ShadingArg::Anchor => Shading::Anchor,
            },
            memory_budget_bytes: budget.transpose()?,
            ..RendererOptions::default()
        })
    }

    /// The frame's options in `mode`.
    pub fn render_options(&self, mode: Mode) -> Result<RenderOptions> {
        let base = match self.rules {
            RulesArg::Ours => RenderOptions::default(),
            RulesArg::Paper => RenderOptions::paper(),
        };
        let mut options = RenderOptions {
            width: self.size.width,
            height: self.size.height,
            samples: self.samples,
            mode,
            block: self.blocks,
            depth: self.depth,
            correction: match self.correction {
                None => base.correction,
                Some(CorrectionArg::Off) => Correction::Off,
                Some(CorrectionArg::Object) => Correction::Object,
                Some(CorrectionArg::ObjectAndShadow) => Correction::ObjectAndShadow,
                Some(CorrectionArg::All) => Correction::All,
            },
            correction_method: match self.correction_method {
                None => base.correction_method,
                Some(CorrectionMethodArg::Converged) => CorrectionMethod::Converged,
                Some(CorrectionMethodArg::Sweeps) => CorrectionMethod::Sweeps,
            },
            interpolation: match self.interpolation {
                None => base.interpolation,
                Some(InterpolationArg::Perspective) => Interpolation::Perspective,
                Some(InterpolationArg::Plain) => Interpolation::Plain,
            },
            gcol_linear: match self.gcol_space {
                None => base.gcol_linear,
                Some(GcolSpaceArg::Display) => false,
                Some(GcolSpaceArg::Linear) => true,
            },
            t_visible: self.t_visible.unwrap_or(base.t_visible),
            correction_t_visible: self.t_visible.unwrap_or(base.correction_t_visible),
            ..base
        };
        // A tolerance that is given counts at every level of blocks.
        for tolerances in [&mut options.tolerances, &mut options.coarse_tolerances] {
            let given = [self.t_pos, self.t_norm, self.t_conv, self.t_tex, self.t_gcol];
            let members = [
                &mut tolerances.t_pos,
                &mut tolerances.t_norm,
                &mut tolerances.t_conv,
                &mut tolerances.t_tex,
                &mut tolerances.t_gcol,
            ];
            for (member, value) in members.into_iter().zip(given) {
                *member = value.unwrap_or(*member);
            }
        }
        for name in &self.disable_test {
            let test = Test::from_name(name).ok_or_else(|| {
                let known = Test::ALL.map(Test::name).join(", ");
                Error::option("--disable-test", format!("there is no test `{name}`; the tests are {known}"))
            })?;
            options.tests &= !test.fail_bit();
        }
        options.validate()?;
        Ok(options)
    }
}

/// The profile that `name` means: none, a built-in one, or a file's.
pub fn profile(name: &str) -> Result<Option<Profile>> {
    if name == "none" {
        return Ok(None);
    }
    if Profile::names().contains(&name) { Profile::named(name).map(Some) } else { load_profile(name).map(Some) }
}

fn load_profile(name: &str) -> Result<Profile> {
    let looks_like_a_path = name.contains(['/', '.', '#']);
    if looks_like_a_path { Profile::load(std::path::Path::new(name)) } else { Profile::named(name) }
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
    #[arg(long, value_enum, default_value = "adaptive")]
    pub mode: ModeArg,
    /// Also write a layer: color, class, fail-mask, test-g1 to test-gc, object, normal, depth, shadow, rays.
    #[arg(long, value_name = "NAME=FILE.png")]
    pub layer: Vec<String>,
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

/// `rarefy diff`.
#[derive(Debug, Args)]
pub struct DiffArgs {
    /// The reference picture.
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
    pub profile: String,
}

/// `rarefy selftest`.
#[derive(Debug, Args)]
pub struct SelftestArgs {
    /// Which device to test: auto, cpu, opencl or opencl:N.
    #[arg(long, value_parser = parse_device, default_value = "auto")]
    pub device: DeviceChoice,
    /// Hold the OpenCL device to a profile's limits.
    #[arg(long, default_value = "none")]
    pub profile: String,
    /// Break this stage's kernel on purpose: the self-test must fail and name it.
    #[arg(long, value_name = "STAGE")]
    pub break_stage: Option<String>,
}

/// `rarefy doctor`.
#[derive(Debug, Args)]
pub struct DoctorArgs {
    /// A folder with scene.obj and view.json, an OBJ file, or the name of a built-in scene.
    pub scene: String,
    /// Write the findings as JSON into this file; `-` is standard output.
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
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
