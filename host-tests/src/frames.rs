// SPDX-License-Identifier: MIT OR Apache-2.0
//! Scenes ready to draw, devices to draw them on, and frames drawn without a renderer around them.

use std::sync::Arc;

use rarefy::Scene;
use rarefy::internal::device::executor::Executor;
use rarefy::internal::device::frame_memory::{FrameBuffer, FrameHandle};
use rarefy::internal::device::hooks::parity::{KernelParity, Parity};
use rarefy::internal::device::kernels::Mutation;
use rarefy::internal::device::open::DeviceOptions;
use rarefy::internal::device::opencl::executor::OpenClExecutor;
use rarefy::internal::device::opencl::{OpenOptions, Profile, open_with};
use rarefy::internal::device::queue::{Hook, Queue};
use rarefy::internal::device::stage::{Kernel, Stage};
use rarefy::internal::device::twin::executor::TwinExecutor;
use rarefy::internal::layout::*;
use rarefy::internal::method::bands::{FrameBudget, Plan, read_frame_plane};
use rarefy::internal::method::camera::frame_inputs;
use rarefy::internal::method::counts::{Keep, PixelCounts};
use rarefy::internal::method::frame::draw_frame;
use rarefy::internal::method::options::{Mode, RenderOptions};
use rarefy::internal::prepare::{PreparedScene, Shading};
use rarefy::internal::render::renderer::Renderer;
use rarefy::internal::scene::builtin;
use rarefy::internal::scene::{Object, SceneParts, Surface, Texture};

/// A test that finds no OpenCL fails, unless this variable says `none`.
pub const WITHOUT_OPENCL: &str = "RAREFY_TEST_OPENCL";

/// Whether the tests that need OpenCL are waived; says so.
pub fn no_opencl() -> bool {
    let none = std::env::var(WITHOUT_OPENCL).is_ok_and(|value| value == "none");
    if none {
        println!("skipped: {WITHOUT_OPENCL}=none");
    }
    none
}

/// Opens a device whose kernels walk through the tree by `traversal`, whatever its type.
pub fn walking_by(traversal: Traversal) -> OpenOptions {
    let word = traversal.name();
    let text = format!(
        r#"{{"limits":{{}},"choices":{{"traversal":{{"value":"{word}","certainty":"inferred","source":"test"}}}}}}"#
    );
    OpenOptions { profile: Some(Profile::from_json(word, &text).unwrap()), ..OpenOptions::default() }
}

/// Prepares `scene`, which is shaded by all its rules, and makes a renderer of it.
///
/// # Errors
/// Whatever these report.
pub fn renderer_of(scene: &Scene, options: &DeviceOptions, monitor: &rarefy::Monitor) -> rarefy::Result<Renderer> {
    let prepared = PreparedScene::new(scene, Shading::Full, &monitor.part("prepare", 0.0, 0.5))?;
    Renderer::new(Arc::new(prepared), options, &monitor.part("open", 0.5, 1.0))
}

/// A scene and what is prepared of it.
pub struct Prepared {
    /// The scene.
    pub scene: Scene,
    /// What is uploaded of it.
    pub prepared: Arc<PreparedScene>,
}

impl Prepared {
    /// `scene`, by the rules of `shading`.
    pub fn new(scene: Scene, shading: Shading) -> Self {
        let prepared = PreparedScene::new(&scene, shading, &rarefy::Monitor::default()).unwrap();
        Prepared { scene, prepared: Arc::new(prepared) }
    }

    /// A built-in scene, [`zoo`], [`window`], or [`crate::fixtures::dashes`] that fall and rise.
    pub fn named(name: &str) -> Self {
        let scene = match name {
            "zoo" => zoo(),
            "window" => window(0.0),
            "far-window" => window(128.0),
            "dashes" => crate::fixtures::dashes(&[(12.3, 6.0), (52.3, -9.0)]),
            _ => builtin::to_scene(name).unwrap(),
        };
        Prepared::new(scene, Shading::Full)
    }

    /// Draws a frame as a renderer does.
    ///
    /// # Errors
    /// Whatever the executor reports.
    pub fn draw(&self, executor: &mut dyn Executor, options: &RenderOptions, counters: bool) -> rarefy::Result<Drawn> {
        self.draw_observed(executor, options, counters, &mut []).map(|(drawn, _)| drawn)
    }

    /// Draws a frame as a renderer does, observed by `hooks`, and leaves its buffers to be read.
    ///
    /// # Errors
    /// Whatever the executor or a hook reports.
    pub fn draw_observed(
        &self,
        executor: &mut dyn Executor,
        options: &RenderOptions,
        counters: bool,
        hooks: &mut [&mut dyn Hook],
    ) -> rarefy::Result<(Drawn, FrameHandle)> {
        options.validate()?;
        let block = if options.mode == Mode::Full { 1 } else { options.method.block };
        let view = self.scene.view();
        let inputs = frame_inputs(view, &self.prepared, options.width, options.height, block, options.depth);
        let budget = FrameBudget {
            total_bytes: u64::MAX,
            allocation_bytes: u64::MAX,
            scene_bytes: 0,
            attributes: true,
            counters,
            scan_group: executor.scan_group(),
        };
        let plan = Plan::new(&inputs.params, &budget, options.band_rows)?;
        let keep = Keep::planes(&[PLANE_CLASS]).and(if counters { Keep::COUNTERS } else { Keep::default() });
        let uploaded = executor.upload(&self.prepared)?;
        let mut frame = executor.allocate(&inputs, &plan.sizes)?;
        let mut queue = Queue::new(executor, &uploaded, &mut frame, hooks);
        let drawn = draw_frame(&mut queue, &inputs, &plan, options, view.extent, keep)?;
        let classes = match drawn.collected.planes.get(&PLANE_CLASS) {
            Some(classes) => classes.clone(),
            None => read_frame_plane(executor, &frame, PLANE_CLASS)?,
        };
        Ok((Drawn { pixels: drawn.collected.colors, classes, counts: drawn.counts }, frame))
    }

    /// Draws a frame on the twin, each launch once more on `device`, and compares: only those of a stage and kernel, if these are given.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn parity(
        &self,
        device: &mut dyn Executor,
        options: &RenderOptions,
        counters: bool,
        only: Option<(Stage, Kernel)>,
    ) -> rarefy::Result<Vec<KernelParity>> {
        let mut twin = TwinExecutor::imitating(device);
        let parity = Parity::new(device, &self.prepared)?;
        let mut parity = match only {
            Some((stage, kernel)) => parity.only(stage, kernel),
            None => parity,
        };
        self.draw_observed(&mut twin, options, counters, &mut [&mut parity])?;
        Ok(parity.results)
    }
}

/// The CPU twin.
pub fn twin() -> TwinExecutor {
    TwinExecutor::default()
}

/// An OpenCL device.
///
/// # Panics
/// If there is none.
pub fn device(strict: bool, open: &OpenOptions) -> OpenClExecutor {
    mutated_device(strict, open, None)
}

/// An OpenCL device with kernels broken on purpose.
///
/// # Panics
/// If there is none.
pub fn mutated_device(strict: bool, open: &OpenOptions, mutation: Option<Mutation>) -> OpenClExecutor {
    let context = open_with(open).unwrap_or_else(|error| panic!("{error} (or set {WITHOUT_OPENCL}=none)"));
    OpenClExecutor::new(context, strict, mutation)
}

/// All words of one of a frame's buffers.
pub fn words(executor: &mut dyn Executor, frame: &FrameHandle, buffer: FrameBuffer) -> Vec<u32> {
    executor.read(frame, buffer, 0..frame.sizes().of(buffer)).unwrap()
}

/// A frame, to be compared.
#[derive(Debug, PartialEq, Eq)]
pub struct Drawn {
    /// The picture, row-major.
    pub pixels: Vec<u32>,
    /// The class plane, row-major.
    pub classes: Vec<u32>,
    /// Pixels by class.
    pub counts: PixelCounts,
}

impl Drawn {
    /// Pixels with a channel that is more than `most` apart.
    pub fn pixels_apart(&self, other: &Drawn, most: u8) -> usize {
        let apart =
            |(a, b): (&u32, &u32)| a.to_le_bytes().iter().zip(b.to_le_bytes()).any(|(&x, y)| x.abs_diff(y) > most);
        self.pixels.iter().zip(&other.pixels).filter(|&pair| apart(pair)).count()
    }

    /// Pixels whose class or fail mask differs.
    pub fn classes_apart(&self, other: &Drawn) -> usize {
        self.classes.iter().zip(&other.classes).filter(|(a, b)| a != b).count()
    }
}

/// A wall whose texture coordinates go from `middle - 2` to `middle + 2`. A pane hides its lower right quarter, and a mirror its upper left one;
/// there the same texture is seen on a wall behind the camera.
pub fn window(middle: f32) -> Scene {
    use crate::fixtures::{ONCE, SceneBuilder, glass, matte, mirror, v};
    let mut builder = SceneBuilder::new("window").camera(v(0.0, 0.0, 2.4), glam::Vec3::ZERO, 45.0);
    builder = builder.light(v(0.5, 1.0, 2.0), 4.0).environment(0.3, glam::Vec3::ZERO);
    let texels = (0..64u32).map(|i| if (i / 32 + i / 4) % 2 == 0 { 0xff30_4050 } else { 0xffe0_d0c0 - 0x21 * (i % 8) });
    let texture = builder.texture(8, texels.collect());
    let textured = rarefy::internal::scene::Material { diffuse_texture: Some(texture), ..matte(glam::Vec3::ONE) };
    let corners = ONCE.map(|c| (2.0 * c - glam::Vec2::ONE) * 2.0);
    builder.object(textured.clone());
    let texcoords = corners.map(|c| c + middle);
    builder.quad_with(corners.map(|c| c.extend(0.0)), texcoords);
    builder.object(textured);
    builder.quad_with(corners.map(|c| v(-c.x, c.y, 3.0)), texcoords);
    builder.object(glass(Surface::ThinGlass, 1.5));
    builder.wall(glam::Vec2::new(0.1, -2.0), glam::Vec2::new(2.0, -0.1), 0.2);
    builder.object(mirror(0.9));
    builder.wall(glam::Vec2::new(-2.0, 0.1), glam::Vec2::new(-0.1, 2.0), 0.1);
    builder.build(4.0)
}

/// The built-in spheres with everything else that a kernel can meet: the clay sphere full of holes, its floor there
/// twice (two objects, equal distances), a sphere of thin glass, a sheet of two sides with glass in its plane, of which one
/// shines, and shadow bits of three lights.
pub fn zoo() -> Scene {
    let mut scene = builtin::to_scene("spheres").unwrap().into_parts();
    let find = |scene: &SceneParts, name: &str| scene.materials.iter().position(|m| m.name == name).unwrap();
    // Holes: a checkerboard of opacity.
    let texels = (0..64u32).map(|i| if (i / 8 + i) % 2 == 0 { 0xff40_80c0 } else { 0x0040_80c0 }).collect();
    scene.textures.push(Texture { name: "holes".into(), width: 8, height: 8, texels });
    let holes = scene.textures.len() as u32 - 1;
    let clay = find(&scene, "clay");
    scene.materials[clay].cutout_texture = Some(holes);
    scene.materials[clay].diffuse_texture = Some(holes);
    // The floor once more, as another object in another material.
    let floor = find(&scene, "floor") as u32;
    scene.objects.push(Object { name: "floor-again".into(), material: clay as u32 });
    let again = scene.objects.len() as u32 - 1;
    for id in 0..scene.triangles.len() {
        if scene.objects[scene.triangle_objects[id] as usize].material == floor {
            scene.triangles.push(scene.triangles[id]);
            scene.corner_normals.push(scene.corner_normals[id]);
            scene.corner_texcoords.push(scene.corner_texcoords[id]);
            scene.triangle_objects.push(again);
        }
    }
    // A copy of the glass sphere, moved to the front, of thin glass.
    let glass = find(&scene, "glass");
    let thin = rarefy::internal::scene::Material {
        name: "thin".into(),
        surface: Surface::ThinGlass,
        ..scene.materials[glass].clone()
    };
    scene.materials.push(thin);
    scene.objects.push(Object { name: "bubble".into(), material: scene.materials.len() as u32 - 1 });
    let bubble = scene.objects.len() as u32 - 1;
    for id in 0..scene.triangles.len() {
        if scene.objects[scene.triangle_objects[id] as usize].material == glass as u32 {
            let corners = scene.triangles[id].map(|i| {
                scene.positions.push(scene.positions[i as usize] * 0.5 + glam::Vec3::new(-1.0, 0.3, 2.6));
                scene.positions.len() as u32 - 1
            });
            scene.triangles.push(corners);
            scene.corner_normals.push(scene.corner_normals[id]);
            scene.corner_texcoords.push(scene.corner_texcoords[id]);
            scene.triangle_objects.push(bubble);
        }
    }
    // A slanted sheet whose back comes first in the list, and a smaller piece of glass in its plane.
    let paint = |name: &str, diffuse, surface| rarefy::internal::scene::Material {
        name: name.into(),
        diffuse,
        emission: glam::Vec3::new(0.0, 0.05, 0.2) * if name == "front" { 1.0 } else { 0.0 },
        surface,
        ..Default::default()
    };
    let (red, blue) = (glam::Vec3::new(0.8, 0.1, 0.1), glam::Vec3::new(0.1, 0.1, 0.8));
    let middle = glam::Vec3::new(1.0, 0.6, 2.0);
    let (right, up) = (glam::Vec3::new(0.7, 0.05, 0.31), glam::Vec3::new(0.07, 0.5, -0.13));
    let facing = if right.cross(up).z > 0.0 { 1.0 } else { -1.0 };
    for (name, diffuse, surface, size, side) in [
        ("back", blue, Surface::Opaque, 1.0, -facing),
        ("front", red, Surface::Opaque, 1.0, facing),
        ("label", blue, Surface::Glass, 0.61, facing),
    ] {
        scene.materials.push(paint(name, diffuse, surface));
        scene.objects.push(Object { name: name.into(), material: scene.materials.len() as u32 - 1 });
        let first = scene.positions.len() as u32;
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        scene.positions.extend(corners.map(|(x, y)| middle + right * (x * size) + up * (y * size)));
        for [i, j, k] in [[0, 1, 2], [0, 2, 3]] {
            let t = if side > 0.0 { [i, j, k] } else { [i, k, j] };
            let normal = rarefy::internal::math::pack_normal(right.cross(up).normalize());
            scene.triangles.push(t.map(|v| first + v));
            scene.corner_normals.push([normal; 3]);
            scene.corner_texcoords.push([glam::Vec2::ZERO; 3]);
            scene.triangle_objects.push(scene.objects.len() as u32 - 1);
        }
    }
    let mut light = scene.view.lights[0];
    light.position = glam::Vec3::new(0.0, 3.0, -4.0);
    scene.view.lights.push(light);
    Scene::new(scene).unwrap()
}

/// Draws `frames`, each with counters or without, launch by launch on the twin and on `device`, each launch fed the twin's
/// own inputs.
///
/// # Panics
/// If a word differs.
pub fn compare(
    prepared: &Prepared,
    device: &mut dyn Executor,
    frames: impl IntoIterator<Item = (RenderOptions, bool)>,
) -> Vec<KernelParity> {
    let mut all = Vec::new();
    for (options, counters) in frames {
        let results = prepared.parity(device, &options, counters, None).unwrap();
        let clean = results.iter().all(|r| r.different == 0);
        assert!(clean, "{}: {options:?}, counters {counters}: {:#?}", prepared.scene.name(), differing(&results));
        all.extend(results);
    }
    all
}

/// Results with a word that differs.
pub fn differing(results: &[KernelParity]) -> Vec<&KernelParity> {
    results.iter().filter(|r| r.different > 0).collect()
}
