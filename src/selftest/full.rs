// SPDX-License-Identifier: MIT OR Apache-2.0
//! The self-test: every kernel on tiny inputs with known answers.
//!
//! The CPU twin and the wide engine must reproduce stored checksums; an OpenCL device must lay out structs as the host does and agree with
//! the twin, launch by launch, each fed the twin's own inputs. A smaller one runs by itself on a driver's first use: see
//! [`crate::selftest::quick`].

use std::sync::Arc;

use crate::device::cpu::executor::CpuExecutor;
use crate::device::executor::Executor;
use crate::device::hooks::parity::KernelParity;
use crate::device::hooks::parity::Parity;
use crate::device::kernels::Mutation;
use crate::device::open::{DeviceOptions, open_opencl};
use crate::device::stage::Stage;
use crate::device::twin::executor::TwinExecutor;
use crate::error::Result;
use crate::method::options::{Method, RenderOptions, Spread};
use crate::prepare::{PreparedScene, Shading};
use crate::selftest::quick::{check_layout, check_parity, draw_test_frame, prepared};

pub use crate::selftest::quick::{Check, SelfTest};

/// Scene of the self-test: mirror, glass, textures and shadows in a few triangles.
const SCENE: &str = "spheres";
const WIDTH: u32 = 100;
const HEIGHT: u32 = 76;
/// The twin's pictures of [`frames`], FNV-1a over their words. Changes only with the method, its defaults or the scene:
/// then put in the checksum that the self-test of the CPU twin prints.
const TWIN_CHECKSUM: u64 = 0x4df1_e22d_2a25_07e8;

/// A change that breaks `stage` on purpose, for negative controls. Stages that share a kernel differ in the parameters of
/// their launches: step2 has its references in a row, step3 in a column.
pub fn breaking_mutation(stage: Stage) -> Mutation {
    const GRID_ROW: &str = "grid_pixel(frame, &step, gx, gy)";
    const PACKED: &str = "#define PACK_PIXEL(i) grid_item_pixel(frame, &step, i)";
    const ENTRY: &str = "list[step.list_offset + item]";
    let (file, from, to) = match stage {
        Stage::Step1 => ("trace.cl", GRID_ROW, "grid_pixel(frame, &step, gx, gy & ~1u)"),
        Stage::Step2a => ("check.cl", GRID_ROW, "grid_pixel(frame, &step, gx, step.reference_dx ? gy & ~1u : gy)"),
        Stage::Step2b => (
            "pack.cl",
            PACKED,
            "#define PACK_PIXEL(i) grid_item_pixel(frame, &step, step.reference_dx ? (i) ^ 1u : (i))",
        ),
        Stage::Step2c => ("trace.cl", ENTRY, "list[step.list_offset + (step.reference_dx ? 0u : item)]"),
        Stage::Step3a => ("check.cl", GRID_ROW, "grid_pixel(frame, &step, gx, step.reference_dy ? gy & ~1u : gy)"),
        Stage::Step3b => (
            "pack.cl",
            PACKED,
            "#define PACK_PIXEL(i) grid_item_pixel(frame, &step, step.reference_dy ? (i) ^ 1u : (i))",
        ),
        Stage::Step3c => ("trace.cl", ENTRY, "list[step.list_offset + (step.reference_dy ? 0u : item)]"),
        Stage::Step4 => ("common/correction.clh", "case 0u: return x > 0u", "case 0u: return x > 1000u"),
    };
    Mutation { file: file.into(), from: from.into(), to: to.into() }
}

/// Tests the device of `options`. `options.mutation` breaks kernels on purpose.
///
/// # Errors
/// No device, a kernel that does not build, or a failing call; wrong results are not errors but failed checks.
pub fn run(options: &DeviceOptions) -> Result<SelfTest> {
    let scene = prepared(SCENE, Shading::Full)?;
    let mut checks = vec![
        check_known("twin", &mut TwinExecutor::default(), &scene)?,
        check_known("cpu", &mut CpuExecutor::default(), &scene)?,
    ];
    let Some(mut device) = open_opencl(&DeviceOptions { strict: true, ..options.clone() })? else {
        return Ok(SelfTest { device: CpuExecutor::default().info().describe(), checks });
    };
    checks.push(check_layout(&device.probe()?));
    for result in stage_parity(&scene, &mut device)? {
        checks.push(check_parity(&result));
    }
    Ok(SelfTest { device: device.info().describe(), checks })
}

/// The options of the frames that the self-test draws: together they launch every kernel.
fn frames() -> [RenderOptions; 3] {
    let base = RenderOptions { width: WIDTH, height: HEIGHT, ..RenderOptions::default() };
    [
        base.clone(),
        RenderOptions { method: Method { block: 4, ..base.method }, ..base.clone() },
        RenderOptions {
            method: Method { correction: base.method.correction.spreading(Spread::Sweeps), ..base.method },
            ..base
        },
    ]
}

/// Runs every kernel on the twin and on `device`, each launch fed the twin's own inputs, and compares all buffers.
///
/// # Errors
/// A limit of the device, a kernel that does not build, or a failing call.
pub fn stage_parity(scene: &Arc<PreparedScene>, device: &mut dyn Executor) -> Result<Vec<KernelParity>> {
    parity_of_frames(scene, device, true)
}

fn parity_of_frames(
    scene: &Arc<PreparedScene>,
    device: &mut dyn Executor,
    counters: bool,
) -> Result<Vec<KernelParity>> {
    let mut twin = TwinExecutor::imitating(device);
    let mut parity = Parity::new(device, scene)?;
    for options in frames() {
        draw_test_frame(&mut twin, scene, &options, counters, &mut [&mut parity])?;
    }
    Ok(parity.results)
}

/// Whether an executor on the CPU draws the known frames, to the last bit.
fn check_known(name: &str, executor: &mut dyn Executor, scene: &Arc<PreparedScene>) -> Result<Check> {
    let mut checksum = 0xcbf2_9ce4_8422_2325u64;
    for options in frames() {
        for word in draw_test_frame(executor, scene, &options, false, &mut [])? {
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
    Ok(Check { name: name.into(), passed, detail })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::cpu::Width;
    use crate::device::open::DeviceChoice;

    #[test]
    fn the_twin_gives_the_known_answer() {
        let options = DeviceOptions { device: DeviceChoice::Cpu, ..DeviceOptions::default() };
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

    /// Here as well as in the tests on the desktop, since this is what runs on other processors.
    #[test]
    fn every_launch_of_the_engine_equals_the_twin_on_every_width() {
        for name in [SCENE, "mirror-room", "cafe"] {
            let scene = prepared(name, Shading::Full).unwrap();
            for width in Width::available() {
                let mut engine = CpuExecutor::of_width(width).unwrap();
                let results = parity_of_frames(&scene, &mut engine, false).unwrap();
                assert!(results.len() >= 8, "{}", results.len());
                for result in results {
                    assert_eq!((result.different, result.first), (0, None), "{name}, {width:?}, {:?}", result.stage);
                }
            }
        }
    }
}
