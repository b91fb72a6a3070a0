// SPDX-License-Identifier: MIT OR Apache-2.0
//! Carries measurements out, one after the other, and writes their pictures.

use std::path::Path;

use crate::analysis::compare::counted::{Counted, Reference};
use crate::analysis::compare::rounds::{Rounds, warm_up};
use crate::analysis::layers::{class_picture, fail_mask_picture, failed_test_picture};
use crate::analysis::metrics::{CUSTOMARY_GAIN, Rgb8, difference_picture};
use crate::analysis::report::figures::{Figures, Times, Waves};
use crate::analysis::report::plan::{Case, Shown};
use crate::analysis::report::recipe::Recipe;
use crate::analysis::report::table::Picture;
use crate::analysis::wave_model::wave_model;
use crate::device::executor::ExecutorInfo;
use crate::device::open::DeviceOptions;
use crate::error::Result;
use crate::layout::{NO_OBJECT, SURFACE_OPAQUE};
use crate::method::counts::Keep;
use crate::method::options::{Mode, RenderOptions, Test};
use crate::monitor::Monitor;
use crate::prepare::PreparedScene;
use crate::render::picture::write_small_png;
use crate::render::renderer::Renderer;

/// The folder of the pictures, in that of the report.
pub const PICTURES: &str = "pictures";

/// Carries out measurements; the scene and the full frame of the one before are kept, since the next one mostly needs them
/// again.
pub struct Laboratory<'a> {
    device: DeviceOptions,
    monitor: Monitor,
    current: Option<Current<'a>>,
}

struct Current<'a> {
    recipe: Recipe<'a>,
    renderer: Renderer,
    reference: Option<(RenderOptions, Reference)>,
    reflective: f64,
}

impl<'a> Laboratory<'a> {
    /// A laboratory with a device that `monitor` can end the work on.
    pub fn new(device: DeviceOptions, monitor: &Monitor) -> Self {
        Laboratory { device, monitor: monitor.clone(), current: None }
    }

    /// What draws.
    ///
    /// # Errors
    /// Whatever opening the device reports.
    pub fn info(&mut self) -> Result<ExecutorInfo> {
        match &self.current {
            Some(current) => Ok(current.renderer.info()),
            None => Ok(self.at(Recipe::AsItIs("wall"))?.renderer.info()),
        }
    }

    fn at(&mut self, recipe: Recipe<'a>) -> Result<&mut Current<'a>> {
        if self.current.as_ref().is_none_or(|current| current.recipe != recipe) {
            // The old scene's memory goes before the new one's is taken.
            self.current = None;
            let scene = std::sync::Arc::new(recipe.prepare(&self.monitor)?);
            let renderer = Renderer::new(scene, &self.device, &self.monitor)?;
            self.current = Some(Current { recipe, renderer, reference: None, reflective: 0.0 });
        }
        self.current.as_mut().ok_or(crate::Error::ForeignHandle { what: "scene" })
    }

    /// Carries out `case` and writes its pictures into the report's `folder`.
    ///
    /// # Errors
    /// Whatever loading, drawing and writing report; [`crate::Error::Cancelled`].
    pub fn measure(&mut self, case: &Case<'a>, folder: &Path) -> Result<Figures> {
        let monitor = self.monitor.clone();
        let current = self.at(case.recipe)?;
        current.refer_to(&case.options)?;
        let Current { renderer, reference, reflective, .. } = current;
        // It has just been made.
        let Some((_, reference)) = reference else { return Err(crate::Error::MissingPlane { plane: "full frame" }) };
        let counted = Counted::draw(renderer, reference, &case.options)?;
        monitor.check()?;
        let quality = counted.quality_of(&counted.frame.pixels, &reference.frame.pixels, &case.options)?;
        let (triangles, samples) = (renderer.triangle_count(), case.options.samples);
        let mut figures = Figures::new(reference, &counted, &quality, triangles, samples, *reflective);
        if case.repeats > 0 {
            figures.times = Some(Times::new(&time(renderer, &case.options, case.repeats)?));
        }
        if case.waves {
            figures.waves = Some(Waves::new(&wave_model(renderer, &case.options)?));
        }
        monitor.check()?;
        figures.pictures = write_pictures(case, renderer.name(), reference, &counted, folder)?;
        Ok(figures)
    }
}

impl Current<'_> {
    /// Draws the full frame of `options` unless it is there.
    fn refer_to(&mut self, options: &RenderOptions) -> Result<()> {
        let wanted = RenderOptions { mode: Mode::Full, method: Default::default(), ..options.clone() };
        if self.reference.as_ref().is_none_or(|(options, _)| *options != wanted) {
            self.reference = None;
            let reference = Reference::draw(&mut self.renderer, &wanted)?;
            self.reflective = reflective(self.renderer.scene(), &reference.objects);
            self.reference = Some((wanted, reference));
        }
        Ok(())
    }
}

/// The share of `objects` that are mirrors or glass.
fn reflective(scene: &PreparedScene, objects: &[u32]) -> f64 {
    let surface_of = |material: &u32| scene.materials[*material as usize].surface;
    let surfaces: Vec<u32> = scene.object_materials.iter().map(surface_of).collect();
    let is_reflective = |object: u32| object != NO_OBJECT && surfaces[object as usize] != SURFACE_OPAQUE;
    let count = objects.iter().filter(|&&object| is_reflective(object)).count();
    count as f64 / objects.len() as f64
}

/// Draws `repeats` frames of each kind in turn.
fn time(renderer: &mut Renderer, options: &RenderOptions, repeats: u32) -> Result<Rounds> {
    warm_up(renderer, options)?;
    let mut rounds = Rounds::default();
    let mut draw = |mode| renderer.render_exactly(&RenderOptions { mode, ..options.clone() }, Keep::default());
    for _ in 0..repeats {
        let full = draw(Mode::Full)?;
        rounds.add(full.stats.frame_ms, &draw(Mode::Adaptive)?.stats);
    }
    Ok(rounds)
}

/// A name for a file that has nothing but letters, digits and dashes of `id`.
pub fn file_stem(id: &str) -> String {
    let words = id.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    words.collect::<Vec<_>>().join("-")
}

fn write_pictures(
    case: &Case,
    scene: &str,
    reference: &Reference,
    counted: &Counted,
    folder: &Path,
) -> Result<Vec<Picture>> {
    let (width, height) = (case.options.width, case.options.height);
    let (full, adaptive) = (&reference.frame.pixels, &counted.frame.pixels);
    let mut wanted: Vec<(&str, String, Vec<u32>)> = Vec::new();
    if matches!(case.shown, Shown::Both | Shown::Everything) {
        wanted.push(("full", format!("{scene}, every pixel traced"), full.clone()));
    }
    if case.shown != Shown::Nothing {
        wanted.push(("adaptive", format!("{scene}, drawn adaptively"), adaptive.clone()));
    }
    if case.shown == Shown::Everything {
        let difference =
            difference_picture(Rgb8::new(width, height, full)?, Rgb8::new(width, height, adaptive)?, CUSTOMARY_GAIN)?;
        wanted.push(("difference", format!("{scene}, ten times the difference"), difference));
        wanted.push(("class", format!("{scene}, which pixels have rays"), class_picture(&counted.classes)));
        wanted.push(("fail-mask", format!("{scene}, which tests failed"), fail_mask_picture(&counted.classes)));
        for test in Test::ALL {
            let alt = format!("{scene}, where test {} failed", test.name().to_uppercase());
            wanted.push((test.name(), alt, failed_test_picture(&counted.classes, test)));
        }
    }
    let mut pictures = Vec::new();
    for (kind, alt, pixels) in wanted {
        let file = format!("{PICTURES}/{}-{kind}.png", file_stem(&case.id));
        write_small_png(folder.join(&file), width, height, &pixels)?;
        pictures.push(Picture { file, width, height, caption: alt.clone(), alt });
    }
    Ok(pictures)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::device::open::DeviceChoice;
    use crate::method::options::Method;

    #[test]
    fn file_names_are_plain() {
        assert_eq!(file_stem("presets/fast/../a b/x.obj"), "presets-fast-a-b-x-obj");
    }

    #[test]
    fn a_measurement_has_all_that_was_asked_for() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join(PICTURES)).unwrap();
        let device = DeviceOptions { device: DeviceChoice::Twin, ..DeviceOptions::default() };
        let mut laboratory = Laboratory::new(device, &Monitor::default());
        let options = RenderOptions { width: 48, height: 48, method: Method::balanced(), ..RenderOptions::default() };
        let recipe = Recipe::AsItIs("spheres");
        let case = Case { id: "a/b".into(), recipe, options, repeats: 2, waves: true, shown: Shown::Everything };
        let figures = laboratory.measure(&case, folder.path()).unwrap();
        assert!(figures.reflective > 0.1 && figures.reflective < 0.6, "{}", figures.reflective);
        assert!(figures.traced > 0.25 && figures.traced <= figures.traced_with_correction);
        assert!(figures.work_speedup() > 1.0 && figures.adaptive_work() < figures.full_work);
        let times = figures.times.as_ref().unwrap();
        assert_eq!(times.repeats, 2);
        assert!(times.speedup.least <= times.speedup.median && times.speedup.median <= times.speedup.most);
        assert!(figures.waves.as_ref().unwrap().by_loop.speedup[1] > 0.0);
        assert_eq!(figures.pictures.len(), 12);
        for picture in &figures.pictures {
            assert!(folder.path().join(&picture.file).is_file(), "{}", picture.file);
        }
        assert_eq!(figures.picture("tx").unwrap().file, "pictures/a-b-tx.png");
        // The JSON holds all of it, to the last digit but one.
        let read: Figures = serde_json::from_str(&serde_json::to_string(&figures).unwrap()).unwrap();
        assert_eq!((&read.pictures, read.work_by_class), (&figures.pictures, figures.work_by_class));
        assert!((read.traced - figures.traced).abs() < 1e-12);
    }
}
