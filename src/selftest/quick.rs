// SPDX-License-Identifier: MIT OR Apache-2.0
//! The quick self-test: a driver that this version has not met draws one tiny frame, and what it computes is compared
//! with the CPU twin before it may draw for anyone.
//!
//! The programs are those that the first adaptive frame needs anyway, and stay built. The verdict is kept on disk beside
//! the compiled programs, for this device, driver, version, kernels and profile; only a verdict is kept, not a failing
//! call, which may have had other reasons.

use std::sync::Arc;

use crate::device::executor::Executor;
use crate::device::frame_memory::{FrameBuffer, FrameSizes};
use crate::device::hooks::parity::{KernelParity, Parity};
use crate::device::launch::Launch;
use crate::device::opencl::executor::OpenClExecutor;
use crate::device::opencl::markers::Marker;
use crate::device::profiles::Profile;
use crate::device::queue::{Hook, Queue};
use crate::device::stage::{Kernel, LAUNCHES};
use crate::device::twin::executor::TwinExecutor;
use crate::error::{Error, Result};
use crate::layout;
use crate::method::camera::frame_inputs;
use crate::method::options::RenderOptions;
use crate::method::window::{CorrectionSeeds, adaptive_window};
use crate::monitor::Monitor;
use crate::prepare::{PreparedScene, Shading};
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
/// [`Error::SelfTest`] with the driver's version and the stage that failed; [`Error::KernelBuild`];
/// [`Error::DriverCrashed`] if a process ended in the compiler or in the self-test before.
pub fn check(device: &mut OpenClExecutor, shading: Shading, profile: Option<&Profile>) -> Result<Known> {
    let profile = profile.map_or(String::new(), |profile| profile.to_json().to_string());
    let texts = device.program_texts(shading);
    let about = [texts.as_str(), &profile];
    let kept = device.context().verdict(&about);
    if let Some(verdict) = kept.as_deref().and_then(|text| read_verdict(&device.info().describe(), text)) {
        return verdict.map(|()| Known::FromCache);
    }
    let outcome = device.build_usual(shading).and_then(|()| test(device, shading, &about));
    let test = match outcome {
        Ok(test) => test,
        Err(Error::LimitExceeded { what, limit, .. }) => {
            log::info!("no quick self-test: {what} is beyond {limit}");
            return Ok(Known::Untested);
        }
        Err(error @ Error::OpenCl { .. }) => {
            return Err(Error::SelfTest {
                device: device.info().describe(),
                stage: stage_in(&error.to_string()),
                message: error.to_string(),
            });
        }
        Err(error) => return Err(error),
    };
    let failed = test.checks.iter().find(|check| !check.passed);
    let verdict = failed.map_or(PASSED.into(), |check| format!("{FAILED}\n{}\n{}", check.name, check.detail));
    device.context().keep_verdict(&about, &verdict);
    test.require().map(|()| Known::Tested)
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

/// Notes which kernel is about to run.
struct Notes(Option<Marker>);

impl Hook for Notes {
    fn before(&mut self, _: &mut dyn Executor, launch: &Launch) -> Result<()> {
        if let Some(marker) = &mut self.0 {
            marker.now(&format!("running `{}` for the first time", launch.kernel.label(launch.stage)));
        }
        Ok(())
    }
}

fn test(device: &mut OpenClExecutor, shading: Shading, about: &[&str]) -> Result<SelfTest> {
    let scene = prepared(SCENE, shading)?;
    let options = RenderOptions { width: WIDTH, height: HEIGHT, ..RenderOptions::default() };
    let mut notes = Notes(device.context().guard_first_run(about)?);
    let mut checks = vec![check_layout(&device.probe()?)];
    let mut twin = TwinExecutor::imitating(device).preferring_few_launches(device.prefers_few_launches());
    let mut parity = Parity::new(device, &scene)?;
    draw_test_frame(&mut twin, &scene, &options, false, &mut [&mut notes, &mut parity])?;
    checks.extend(parity.results.iter().map(check_parity));
    drop(parity);
    device.context().start_afresh()?;
    drop(notes);
    Ok(SelfTest { device: device.info().describe(), checks })
}

/// A built-in scene, prepared.
pub(crate) fn prepared(name: &str, shading: Shading) -> Result<Arc<PreparedScene>> {
    Ok(Arc::new(PreparedScene::new(&builtin::to_scene(name)?, shading, &Monitor::default())?))
}

/// Draws an adaptive frame on `executor` and returns its picture.
pub(crate) fn draw_test_frame(
    executor: &mut dyn Executor,
    scene: &Arc<PreparedScene>,
    options: &RenderOptions,
    counters: bool,
    hooks: &mut [&mut dyn Hook],
) -> Result<Vec<u32>> {
    let RenderOptions { width, height, depth, .. } = *options;
    let inputs = frame_inputs(scene.view(), scene, width, height, options.method.block, depth);
    let sizes = FrameSizes::new(&inputs.params, true, counters, executor.scan_group());
    let sizes = sizes.ok_or_else(|| Error::argument("size", "a self-test frame does not fit the address space"))?;
    let uploaded = executor.upload(scene)?;
    let mut frame = executor.allocate(&inputs, &sizes)?;
    let mut queue = Queue::new(executor, &uploaded, &mut frame, hooks);
    queue.begin(&inputs)?;
    adaptive_window(&mut queue, options, scene.view().extent, &CorrectionSeeds::default())?;
    queue.read(FrameBuffer::Color, 0..sizes.color)
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
        let scene = prepared(SCENE, Shading::Full).unwrap();
        let options = RenderOptions { width: WIDTH, height: HEIGHT, ..RenderOptions::default() };
        let mut other = TwinExecutor::default();
        let mut parity = Parity::new(&mut other, &scene).unwrap();
        draw_test_frame(&mut TwinExecutor::default(), &scene, &options, false, &mut [&mut parity]).unwrap();
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
