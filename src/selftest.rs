// SPDX-License-Identifier: MIT OR Apache-2.0
//! The self-test: every kernel on tiny inputs with known answers.
//!
//! The CPU twin must reproduce stored checksums; an OpenCL device must lay out structs as the host does and agree with
//! the twin, launch by launch, each fed the twin's own inputs.

use std::sync::Arc;

use crate::backend::parity::{KernelParity, ParityBackend};
use crate::backend::twin::TwinBackend;
use crate::backend::{Backend, BufferSizes, FrameBuffer};
use crate::builtin;
use crate::camera::frame_params;
use crate::error::{Error, Result};
use crate::kdtree::{BuildOptions, KdTree};
use crate::kernels::Mutation;
use crate::layout;
use crate::options::{CorrectionMethod, RenderOptions};
use crate::pipeline;
use crate::renderer::{DeviceChoice, RendererOptions};
use crate::scene::Scene;
use crate::scene_buffers::{SceneBuffers, Shading};
use crate::stage::{Kernel, Stage};

/// Scene of the self-test: mirror, glass, textures and shadows in a few triangles.
const SCENE: &str = "spheres";
const WIDTH: u32 = 100;
const HEIGHT: u32 = 76;
/// Share of words that a device may get wrong because it rounds otherwise; a broken kernel gets far more wrong.
const WRONG_LIMIT: f64 = 0.005;
/// The twin's pictures of [`frames`], FNV-1a over their words. Changes only with the method, its defaults or the scene:
/// then put in the checksum that `rarefy selftest --device cpu` prints.
const TWIN_CHECKSUM: u64 = 0x9147_142f_6fe4_133c;

/// The result of one check.
#[derive(Debug, Clone)]
pub struct Check {
    /// What was checked: a kernel's name, or `layout`, `twin`.
    pub name: String,
    /// Whether it passed.
    pub passed: bool,
    /// The numbers.
    pub detail: String,
}

/// The self-test's outcome.
#[derive(Debug, Clone)]
pub struct SelfTest {
    /// Device and driver version.
    pub device: String,
    /// Every check, in order.
    pub checks: Vec<Check>,
}

impl SelfTest {
    /// Whether all checks passed.
    pub fn passed(&self) -> bool {
        self.checks.iter().all(|c| c.passed)
    }

    /// The first failure as an error that names the device and the stage.
    ///
    /// # Errors
    /// [`Error::SelfTest`] unless all passed.
    pub fn require(&self) -> Result<()> {
        match self.checks.iter().find(|c| !c.passed) {
            None => Ok(()),
            Some(c) => {
                Err(Error::SelfTest { device: self.device.clone(), stage: c.name.clone(), message: c.detail.clone() })
            }
        }
    }
}

/// A change that breaks `stage` on purpose, for negative controls.
pub fn breaking_mutation(stage: Stage) -> Mutation {
    let (file, from, to) = match stage {
        Stage::Step1 => ("step1.cl", "step.step_x * gx", "step.step_x * (gx & ~1u)"),
        Stage::Step2a => ("step2a.cl", "step.step_y * gy", "step.step_y * (gy & ~1u)"),
        Stage::Step2b => (
            "step2b.cl",
            "#define PACK_PIXEL(i) grid_item_pixel(&step, i)",
            "#define PACK_PIXEL(i) grid_item_pixel(&step, i ^ 1u)",
        ),
        Stage::Step2c => ("step2c.cl", "list[step.list_offset + item]", "list[step.list_offset]"),
        Stage::Step3a => ("step3a.cl", "step.step_y * gy", "step.step_y * (gy & ~1u)"),
        Stage::Step3b => (
            "step3b.cl",
            "#define PACK_PIXEL(i) grid_item_pixel(&step, i)",
            "#define PACK_PIXEL(i) grid_item_pixel(&step, i ^ 1u)",
        ),
        Stage::Step3c => ("step3c.cl", "list[step.list_offset + item]", "list[step.list_offset]"),
        Stage::Step4 => ("step4.cl", "case 0u: return x > 0u", "case 0u: return x > 1000u"),
    };
    Mutation { file: file.into(), from: from.into(), to: to.into() }
}

/// Tests the device of `options`. `options.mutation` breaks kernels on purpose.
///
/// # Errors
/// No device, a kernel that does not build, or a failing call; wrong results are not errors but failed checks.
pub fn run(options: &RendererOptions) -> Result<SelfTest> {
    let scene = builtin::to_scene(SCENE)?;
    let buffers = scene_buffers(&scene)?;
    let twin_check = check_twin(&scene, &buffers)?;
    let opened = match options.device {
        DeviceChoice::Cpu => None,
        _ => crate::renderer::open_opencl(&buffers, &RendererOptions { strict: true, ..options.clone() })?,
    };
    let Some(mut device) = opened else {
        let info = TwinBackend::new(buffers).info();
        return Ok(SelfTest { device: format!("{}, {}", info.name, info.version), checks: vec![twin_check] });
    };
    let info = device.info();
    let mut checks = vec![twin_check, check_layout(&device.probe()?)];
    for result in stage_parity(&scene, &buffers, &mut device)? {
        checks.push(check_parity(&result));
    }
    Ok(SelfTest { device: format!("{}, {}", info.name, info.version), checks })
}

fn scene_buffers(scene: &Scene) -> Result<Arc<SceneBuffers>> {
    let tree = KdTree::build(&scene.positions, &scene.triangles, &BuildOptions::default(), &|_| ())?;
    Ok(Arc::new(SceneBuffers::new(scene, tree, Shading::Full)?))
}

/// The options of the frames that the self-test draws: together they launch every kernel.
fn frames() -> [RenderOptions; 3] {
    let base = RenderOptions { width: WIDTH, height: HEIGHT, ..RenderOptions::default() };
    [
        base.clone(),
        RenderOptions { block: 4, ..base.clone() },
        RenderOptions { correction_method: CorrectionMethod::Sweeps, ..base },
    ]
}

/// Runs every kernel on the twin and on `device`, each launch fed the twin's own inputs, and compares all buffers.
///
/// # Errors
/// A limit of the device, a kernel that does not build, or a failing call.
pub fn stage_parity(scene: &Scene, buffers: &Arc<SceneBuffers>, device: &mut dyn Backend) -> Result<Vec<KernelParity>> {
    let mut parity = ParityBackend::new(TwinBackend::new(Arc::clone(buffers)), device);
    for options in frames() {
        run_frame(&mut parity, scene, buffers, &options, true)?;
    }
    Ok(parity.results)
}

fn run_frame(
    backend: &mut dyn Backend,
    scene: &Scene,
    buffers: &SceneBuffers,
    options: &RenderOptions,
    counters: bool,
) -> Result<()> {
    let params = frame_params(&scene.view, buffers, options.width, options.height, options.block, options.depth);
    let sizes = BufferSizes::new(&params, true, counters, backend.scan_group());
    let sizes = sizes.ok_or_else(|| Error::option("size", "a self-test frame does not fit the address space"))?;
    backend.begin(&params, &sizes)?;
    pipeline::adaptive_frame(backend, &params, options, scene.view.extent)?;
    Ok(())
}

fn check_twin(scene: &Scene, buffers: &Arc<SceneBuffers>) -> Result<Check> {
    let mut twin = TwinBackend::new(Arc::clone(buffers));
    let mut checksum = 0xcbf2_9ce4_8422_2325u64;
    for options in frames() {
        run_frame(&mut twin, scene, buffers, &options, false)?;
        for word in twin.read(FrameBuffer::Color, 0..(WIDTH * HEIGHT) as usize)? {
            for byte in word.to_le_bytes() {
                checksum = (checksum ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
            }
        }
    }
    let passed = checksum == TWIN_CHECKSUM;
    let detail = if passed {
        format!("checksum {checksum:#018x}, as it should be")
    } else {
        format!("checksum {checksum:#018x} instead of {TWIN_CHECKSUM:#018x}")
    };
    Ok(Check { name: "twin".into(), passed, detail })
}

fn check_layout(probe: &[u32]) -> Check {
    let expected = layout::expected_probe();
    let passed = probe == expected.as_slice();
    let detail = if passed {
        format!("{} sizes and offsets agree", expected.len())
    } else {
        format!("the device lays structs out as {probe:?}, the host as {expected:?}")
    };
    Check { name: "layout".into(), passed, detail }
}

fn check_parity(result: &KernelParity) -> Check {
    // A packing or a claim is either right or wrong; rounding can only move what rays and shading compute.
    let exact = !matches!(
        result.kernel,
        Kernel::Step1
            | Kernel::Step2a
            | Kernel::Step2c
            | Kernel::Step3a
            | Kernel::Step3c
            | Kernel::Step4Trace
            | Kernel::Step4Sweep
    );
    let limit = if exact { 0 } else { (result.words as f64 * WRONG_LIMIT) as u64 };
    let mut detail = match result.different {
        0 => format!("all {} words equal the twin's", result.words),
        n => format!("{n} of {} words differ from the twin's, {} beyond rounding", result.words, result.wrong),
    };
    if let Some((buffer, at, twin, device)) = result.first {
        detail += &format!("; first at {buffer:?}[{at}]: {device:#010x} instead of {twin:#010x}");
    }
    Check { name: result.kernel.name().into(), passed: result.wrong <= limit, detail }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_twin_gives_the_known_answer() {
        let options = RendererOptions { device: DeviceChoice::Cpu, ..RendererOptions::default() };
        let result = run(&options).unwrap();
        let remedy =
            "if the method, its defaults or the scene changed on purpose, put the first number into TWIN_CHECKSUM";
        assert!(result.passed(), "{}: {remedy}", result.checks[0].detail);
        assert!(result.require().is_ok());
    }

    #[test]
    fn a_failed_check_names_device_and_stage() {
        let failed = Check { name: "step2c".into(), passed: false, detail: "7 words".into() };
        let result = SelfTest { device: "Adreno".into(), checks: vec![failed] };
        assert!(!result.passed());
        assert_eq!(result.require().unwrap_err().to_string(), "self-test failed on Adreno: step2c: 7 words");
    }
}
