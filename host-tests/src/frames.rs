// SPDX-License-Identifier: MIT OR Apache-2.0
//! Scenes ready to draw, devices to draw them on, and frames drawn without a renderer around them.

use std::sync::Arc;

use rarefy::Scene;
use rarefy::device::backend::{Backend, BufferSizes, FrameBuffer};
use rarefy::device::opencl::executor::OpenClBackend;
use rarefy::device::opencl::{OpenOptions, Profile, open_with};
use rarefy::device::twin::executor::TwinBackend;
use rarefy::layout::*;
use rarefy::method::bands::{self, Plan, Room};
use rarefy::method::camera::frame_params;
use rarefy::method::frame::Keep;
use rarefy::method::options::{Mode, RenderOptions};
use rarefy::method::pipeline::{self, PixelCounts};
use rarefy::prepare::kdtree::{BuildOptions, KdTree};
use rarefy::prepare::scene_buffers::{SceneBuffers, Shading};
use rarefy::scene::builtin;
use rarefy::scene::{Object, SceneParts, Surface, Texture};

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

/// A scene with its buffers.
pub struct Prepared {
    /// The scene.
    pub scene: Scene,
    /// What is uploaded of it.
    pub buffers: Arc<SceneBuffers>,
}

impl Prepared {
    /// `scene`, by the rules of `shading`.
    pub fn new(scene: Scene, shading: Shading) -> Self {
        let tree =
            KdTree::build(scene.positions(), scene.triangles(), &BuildOptions::default(), &rarefy::Monitor::default())
                .unwrap();
        let buffers = Arc::new(SceneBuffers::new(&scene, tree, shading).unwrap());
        Prepared { scene, buffers }
    }

    /// A built-in scene, [`zoo`], or [`crate::fixtures::dashes`] that fall and rise.
    pub fn named(name: &str) -> Self {
        let scene = match name {
            "zoo" => zoo(),
            "dashes" => crate::fixtures::dashes(&[(12.3, 6.0), (52.3, -9.0)]),
            _ => builtin::to_scene(name).unwrap(),
        };
        Prepared::new(scene, Shading::Full)
    }

    /// The CPU twin with this scene.
    pub fn twin(&self) -> TwinBackend {
        TwinBackend::new(Arc::clone(&self.buffers))
    }

    /// An OpenCL device with this scene.
    ///
    /// # Panics
    /// If there is none.
    pub fn device(&self, strict: bool, open: &OpenOptions) -> OpenClBackend {
        let door = open_with(open).unwrap_or_else(|error| panic!("{error} (or set {WITHOUT_OPENCL}=none)"));
        OpenClBackend::new(door, &self.buffers, strict).unwrap()
    }

    /// Draws a frame as a renderer does, but leaves the buffers to be read.
    ///
    /// # Errors
    /// Whatever the back end reports.
    pub fn draw(&self, backend: &mut dyn Backend, options: &RenderOptions, counters: bool) -> rarefy::Result<Drawn> {
        options.validate()?;
        let full = options.mode == Mode::Full;
        let block = if full { 1 } else { options.method.block };
        let (width, height) = (options.width, options.height);
        let frame = frame_params(self.scene.view(), &self.buffers, width, height, block, options.depth);
        if options.band_rows.is_some() {
            return self.draw_in_bands(backend, &frame, options, counters);
        }
        let sizes = BufferSizes::new(&frame, true, counters, backend.scan_group()).unwrap();
        backend.begin(&frame, &sizes)?;
        let counts = if full {
            pipeline::full_frame(backend, &frame, true)?
        } else {
            pipeline::adaptive_frame(backend, &frame, options, self.scene.view().extent)?
        };
        let pixels = backend.read(FrameBuffer::Color, 0..sizes.color)?;
        let planes = backend.read(FrameBuffer::Attributes, 0..sizes.attributes)?;
        let at = |x, y| PLANE_CLASS * frame.plane_pitch + plane_index(&frame, x, y);
        let classes = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let classes = classes.map(|(x, y)| planes[at(x, y) as usize]).collect();
        Ok(Drawn { pixels, classes, counts })
    }

    fn draw_in_bands(
        &self,
        backend: &mut dyn Backend,
        frame: &FrameParams,
        options: &RenderOptions,
        counters: bool,
    ) -> rarefy::Result<Drawn> {
        let room = Room {
            total_bytes: u64::MAX,
            allocation_bytes: u64::MAX,
            scene_bytes: 0,
            attributes: true,
            counters,
            scan_group: backend.scan_group(),
        };
        let plan = Plan::new(frame, &room, options.band_rows)?;
        let keep = Keep::planes(&[PLANE_CLASS]).and(if counters { Keep::COUNTERS } else { Keep::default() });
        let (counts, collected) = bands::draw(backend, &plan, options, self.scene.view().extent, keep)?;
        Ok(Drawn { pixels: collected.colors, classes: collected.planes[&PLANE_CLASS].clone(), counts })
    }
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

/// The built-in spheres with everything else that a kernel can meet: the clay sphere full of holes, its floor there
/// twice (two objects, equal distances), a sphere of thin glass, and shadow bits of three lights.
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
    let thin =
        rarefy::scene::Material { name: "thin".into(), surface: Surface::ThinGlass, ..scene.materials[glass].clone() };
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
    let mut light = scene.view.lights[0];
    light.position = glam::Vec3::new(0.0, 3.0, -4.0);
    scene.view.lights.push(light);
    Scene::new(scene).unwrap()
}
