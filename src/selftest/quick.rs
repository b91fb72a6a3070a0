// SPDX-License-Identifier: MIT OR Apache-2.0
//! The quick self-test: a driver that this version has not met draws one tiny frame, and what it computes is compared
//! with the CPU twin before it may draw for anyone.
//!
//! The programs are those that the first adaptive frame needs anyway, and stay built. The verdict is kept on disk beside
//! the compiled programs, for this device, driver, version, kernels and profile; only a verdict is kept, not a failing
//! call, which may have had other reasons.

use std::sync::Arc;

use crate::device::backend::{Backend, BufferSizes};
use crate::device::hooks::parity::{KernelParity, ParityBackend};
use crate::device::opencl::executor::OpenClBackend;
use crate::device::profiles::Profile;
use crate::device::stage::{Kernel, LAUNCHES};
use crate::device::twin::executor::TwinBackend;
use crate::error::{Error, Result};
use crate::layout;
use crate::method::camera::frame_params;
use crate::method::options::RenderOptions;
use crate::method::pipeline;
use crate::prepare::kdtree::{BuildOptions, KdTree};
use crate::prepare::scene_buffers::{SceneBuffers, Shading};
use crate::scene::Scene;
use crate::scene::builtin;

/// Few triangles, but mirror, glass, textures and shadows among them.
const SCENE: &str = "spheres";
const WIDTH: u32 = 100;
const HEIGHT: u32 = 76;
/// The first line of a verdict; after `failed` follow the stage and what was wrong.
const PASSED: &str = "passed";
const FAILED: &str = "failed";
/// Share of words that a device may get wrong because it rounds otherwise; a broken kernel gets far more wrong.
const WRONG_LIMIT: f64 = 0.005;

/// The result of one check.
#[derive(Debug, Clone)]
pub struct Check {
    /// What was checked: a stage and its kernel, or `layout`, `twin`.
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

/// What is known of a device after [`check`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Known {
    /// It was tested now, and passed.
    Tested,
    /// It passed in an earlier run.
    FromCache,
    /// A limit of the device or its profile is in the way of even a tiny frame; the frame that is wanted will say which.
    Untested,
}

/// Tests `device`, which is held to `profile`, unless an earlier run left its verdict.
///
/// # Errors
/// [`Error::SelfTest`] with the driver's version and the stage that failed; [`Error::KernelBuild`].
pub fn check(device: &mut OpenClBackend, profile: Option<&Profile>) -> Result<Known> {
    let profile = profile.map_or(String::new(), |profile| profile.to_json().to_string());
    let texts = device.program_texts();
    let about = [texts.as_str(), &profile];
    let kept = device.door().verdict(&about);
    if let Some(verdict) = kept.as_deref().and_then(|text| read_verdict(&describe(device), text)) {
        return verdict.map(|()| Known::FromCache);
    }
    let outcome = test(device);
    let test = match outcome {
        Ok(test) => test,
        Err(Error::LimitExceeded { what, limit, .. }) => {
            log::info!("no quick self-test: {what} is beyond {limit}");
            return Ok(Known::Untested);
        }
        Err(error @ Error::OpenCl { .. }) => {
            return Err(Error::SelfTest {
                device: describe(device),
                stage: stage_in(&error.to_string()),
                message: error.to_string(),
            });
        }
        Err(error) => return Err(error),
    };
    let failed = test.checks.iter().find(|check| !check.passed);
    let verdict = failed.map_or(PASSED.into(), |check| format!("{FAILED}\n{}\n{}", check.name, check.detail));
    device.door().keep_verdict(&about, &verdict);
    test.require().map(|()| Known::Tested)
}

fn describe(device: &OpenClBackend) -> String {
    let info = device.info();
    format!("{}, {}", info.name, info.version)
}

/// What a kept verdict says; `None` if it is none.
fn read_verdict(device: &str, text: &str) -> Option<Result<()>> {
    if text == PASSED {
        return Some(Ok(()));
    }
    let (stage, message) = text.strip_prefix(FAILED)?.strip_prefix('\n')?.split_once('\n')?;
    Some(Err(Error::SelfTest { device: device.into(), stage: stage.into(), message: message.into() }))
}

/// The launch that an error of a call names between backquotes.
fn stage_in(message: &str) -> String {
    let named = message.split('`').nth(1).unwrap_or_default();
    let known = LAUNCHES.iter().find(|(.., label)| *label == named);
    known.map_or("calls", |(.., label)| label).into()
}

fn test(device: &mut OpenClBackend) -> Result<SelfTest> {
    let scene = builtin::to_scene(SCENE)?;
    let buffers = scene_buffers(&scene, device.shading())?;
    let options = RenderOptions { width: WIDTH, height: HEIGHT, ..RenderOptions::default() };
    let checks = device.with_scene(&buffers, |device| {
        let mut checks = vec![check_layout(&device.probe()?)];
        let mut parity = ParityBackend::new(TwinBackend::new(Arc::clone(&buffers)), device).as_the_device_likes();
        run_frame(&mut parity, &scene, &buffers, &options, false)?;
        checks.extend(parity.results.iter().map(check_parity));
        Ok(checks)
    })?;
    Ok(SelfTest { device: describe(device), checks })
}

pub(crate) fn scene_buffers(scene: &Scene, shading: Shading) -> Result<Arc<SceneBuffers>> {
    let tree =
        KdTree::build(scene.positions(), scene.triangles(), &BuildOptions::default(), &crate::Monitor::default())?;
    Ok(Arc::new(SceneBuffers::new(scene, tree, shading)?))
}

pub(crate) fn run_frame(
    backend: &mut dyn Backend,
    scene: &Scene,
    buffers: &SceneBuffers,
    options: &RenderOptions,
    counters: bool,
) -> Result<()> {
    let params =
        frame_params(scene.view(), buffers, options.width, options.height, options.method.block, options.depth);
    let sizes = BufferSizes::new(&params, true, counters, backend.scan_group());
    let sizes = sizes.ok_or_else(|| Error::argument("size", "a self-test frame does not fit the address space"))?;
    backend.begin(&params, &sizes)?;
    pipeline::adaptive_frame(backend, &params, options, scene.view().extent)?;
    Ok(())
}

pub(crate) fn check_layout(probe: &[u32]) -> Check {
    let expected = layout::struct_layout();
    let wrong = expected.iter().zip(probe).find(|(entry, bytes)| entry.bytes != **bytes);
    let passed = wrong.is_none() && probe.len() == expected.len();
    let detail = match wrong {
        Some((entry, bytes)) => format!("{} is {bytes} bytes on the device, {} on the host", entry.name, entry.bytes),
        None if passed => format!("{} sizes and offsets agree", expected.len()),
        None => format!("{} of {} sizes and offsets were reported", probe.len(), expected.len()),
    };
    Check { name: "layout".into(), passed, detail }
}

pub(crate) fn check_parity(result: &KernelParity) -> Check {
    // A packing or a claim is either right or wrong; rounding can only move what rays and shading compute.
    let exact = !matches!(result.kernel, Kernel::Trace | Kernel::Check | Kernel::CorrectTail | Kernel::CorrectSweep);
    let limit = if exact { 0 } else { (result.words as f64 * WRONG_LIMIT) as u64 };
    let mut detail = match result.different {
        0 => format!("all {} words equal the twin's", result.words),
        n => format!("{n} of {} words differ from the twin's, {} beyond rounding", result.words, result.wrong),
    };
    if let Some((buffer, at, twin, device)) = result.first {
        detail += &format!("; first at {buffer:?}[{at}]: {device:#010x} instead of {twin:#010x}");
    }
    Check { name: result.kernel.label(result.stage).into(), passed: result.wrong <= limit, detail }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn the_tiny_frame_launches_every_kernel_of_a_usual_frame() {
        let scene = builtin::to_scene(SCENE).unwrap();
        let buffers = scene_buffers(&scene, Shading::Full).unwrap();
        let options = RenderOptions { width: WIDTH, height: HEIGHT, ..RenderOptions::default() };
        let mut other = TwinBackend::new(Arc::clone(&buffers));
        let mut parity = ParityBackend::new(TwinBackend::new(Arc::clone(&buffers)), &mut other);
        run_frame(&mut parity, &scene, &buffers, &options, false).unwrap();
        let launched: Vec<_> = parity.results.iter().map(|result| (result.stage, result.kernel)).collect();
        for (stage, kernel, label) in LAUNCHES.into_iter().filter(|(_, kernel, _)| *kernel != Kernel::CorrectSweep) {
            assert!(launched.contains(&(stage, kernel)), "{label}");
        }
        assert!(parity.results.iter().map(check_parity).all(|check| check.passed));
    }

    #[test]
    fn a_verdict_that_is_none_is_not_believed() {
        let says = |text: &str| read_verdict("Adreno", text).map(|verdict| verdict.map_err(|error| error.to_string()));
        assert_eq!(says("passed"), Some(Ok(())));
        assert_eq!(says("failed\nstep2c\n7 words"), Some(Err("self-test failed on Adreno: step2c: 7 words".into())));
        for none in ["", "Passed", "passed\n", "failed", "failed\nstep2c"] {
            assert_eq!(says(none), None, "{none}");
        }
    }

    #[test]
    fn a_failing_call_names_its_kernel() {
        assert_eq!(stage_in("running `step2c/trace` failed: CL_OUT_OF_RESOURCES (-5)"), "step2c/trace");
        assert_eq!(stage_in("clFinish failed: CL_OUT_OF_RESOURCES (-5)"), "calls");
    }
}
