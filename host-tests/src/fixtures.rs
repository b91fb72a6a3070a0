// SPDX-License-Identifier: MIT OR Apache-2.0
//! Scenes made in code, and short ways to look at them with the CPU twin.
#![allow(clippy::unwrap_used)]

use glam::{Vec2, Vec3};
use rarefy::internal::device::frame_memory::FrameInputs;
use rarefy::internal::device::open::{DeviceChoice, DeviceOptions};
use rarefy::internal::device::twin::SceneArgs;
use rarefy::internal::device::twin::executor::scene_args;
use rarefy::internal::device::twin::known_shadows::KnownShadows;
use rarefy::internal::device::twin::ray_tree::{SurfacePoint, gather_secondary, shadow_test, surface_point};
use rarefy::internal::device::twin::scene_args::Work;
use rarefy::internal::device::twin::shade::{ShadePoint, shade_local};
use rarefy::internal::device::twin::traverse::closest_hit;
use rarefy::internal::layout::{NO_TRIANGLE, Triangle};
use rarefy::internal::math::pack_normal;
use rarefy::internal::method::camera::frame_inputs;
use rarefy::internal::method::counts::Keep;
use rarefy::internal::method::options::{
    Checks, Compared, Correction, GcolSpace, Interpolation, Method, Mode, RenderOptions, Spread, TextureRule,
    Tolerances,
};
use rarefy::internal::prepare::kdtree::KdNode;
use rarefy::internal::prepare::{PreparedScene, Shading};
use rarefy::internal::render::renderer::Renderer;
use rarefy::internal::scene::builtin::{HUGE, NAMES};
use rarefy::internal::scene::{Light, Material, Object, Scene, SceneParts, Surface, Texture};

/// The built-in scenes that are made in a moment: all but those of millions of triangles.
pub fn quick_scenes() -> impl Iterator<Item = &'static str> {
    NAMES.into_iter().filter(|name| !HUGE.contains(name))
}

/// Shorthand for a vector.
pub fn v(x: f32, y: f32, z: f32) -> Vec3 {
    Vec3::new(x, y, z)
}

/// A matte material of one colour, linear RGB.
pub fn matte(diffuse: Vec3) -> Material {
    Material { diffuse, ..Material::default() }
}

/// A mirror of the given weight without a colour of its own.
pub fn mirror(weight: f32) -> Material {
    Material {
        diffuse: Vec3::ZERO,
        specular: Vec3::splat(weight),
        shininess: 1000.0,
        surface: Surface::Mirror,
        ..Material::default()
    }
}

/// Clear glass of the given kind and index of refraction.
pub fn glass(surface: Surface, index_of_refraction: f32) -> Material {
    Material { diffuse: Vec3::ZERO, index_of_refraction, surface, ..Material::default() }
}

/// The texture coordinates of a quad's corners that show a texture once.
pub const ONCE: [Vec2; 4] = [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y];

/// A scene under construction. Without lights, under white ambient light, every surface shows its own colour.
#[derive(Debug, Clone)]
pub struct SceneBuilder(SceneParts);

impl SceneBuilder {
    /// An empty scene: no lights, ambient light 1, black background, extent 1.
    pub fn new(name: &str) -> Self {
        let mut scene = SceneParts { name: name.into(), ..SceneParts::default() };
        scene.view.ambient = Vec3::ONE;
        SceneBuilder(scene)
    }

    /// Places the camera, upright.
    pub fn camera(mut self, eye: Vec3, look_at: Vec3, fov_y_degrees: f32) -> Self {
        let camera = &mut self.0.view.camera;
        (camera.eye, camera.look_at, camera.fov_y_degrees) = (eye, look_at, fov_y_degrees);
        self
    }

    /// Sets ambient light and background.
    pub fn environment(mut self, ambient: f32, background: Vec3) -> Self {
        (self.0.view.ambient, self.0.view.background) = (Vec3::splat(ambient), background);
        self
    }

    /// Adds a white light.
    pub fn light(mut self, position: Vec3, intensity: f32) -> Self {
        self.0.view.lights.push(Light { position, intensity: Vec3::splat(intensity) });
        self
    }

    /// Adds a texture, rows from the top, and returns its index.
    pub fn texture(&mut self, width: u32, texels: Vec<u32>) -> u32 {
        let height = texels.len() as u32 / width;
        self.0.textures.push(Texture { name: "texture".into(), width, height, texels });
        self.0.textures.len() as u32 - 1
    }

    /// Starts an object of a material of its own; what follows belongs to it. Returns the object's id.
    pub fn object(&mut self, material: Material) -> u32 {
        self.0.materials.push(material);
        let material = self.0.materials.len() as u32 - 1;
        self.0.objects.push(Object { name: format!("object {material}"), material });
        self.0.objects.len() as u32 - 1
    }

    /// Adds a triangle with the given corner normals and texture coordinates to the last object.
    pub fn triangle_with(&mut self, corners: [Vec3; 3], normals: [Vec3; 3], texcoords: [Vec2; 3]) {
        let s = &mut self.0;
        let base = s.positions.len() as u32;
        s.positions.extend(corners);
        s.triangles.push([base, base + 1, base + 2]);
        s.corner_normals.push(normals.map(pack_normal));
        s.corner_texcoords.push(texcoords);
        s.triangle_objects.push(s.objects.len() as u32 - 1);
    }

    /// Adds a flat triangle to the last object.
    pub fn triangle(&mut self, [a, b, c]: [Vec3; 3]) {
        let n = (b - a).cross(c - a).normalize_or(Vec3::Y);
        self.triangle_with([a, b, c], [n; 3], [Vec2::ZERO; 3]);
    }

    /// Adds a flat quad to the last object; corners anticlockwise as seen from its front.
    pub fn quad_with(&mut self, p: [Vec3; 4], texcoords: [Vec2; 4]) {
        let n = (p[1] - p[0]).cross(p[2] - p[0]).normalize_or(Vec3::Y);
        for [i, j, k] in [[0, 1, 2], [0, 2, 3]] {
            self.triangle_with([p[i], p[j], p[k]], [n; 3], [texcoords[i], texcoords[j], texcoords[k]]);
        }
    }

    /// Adds a flat quad without texture coordinates to the last object.
    pub fn quad(&mut self, p: [Vec3; 4]) {
        self.quad_with(p, [Vec2::ZERO; 4]);
    }

    /// Adds a rectangle in the plane of constant `z` that faces +z.
    pub fn wall(&mut self, lo: Vec2, hi: Vec2, z: f32) {
        self.quad([v(lo.x, lo.y, z), v(hi.x, lo.y, z), v(hi.x, hi.y, z), v(lo.x, hi.y, z)]);
    }

    /// Adds a rectangle in the plane of constant `y` that faces +y; `lo` and `hi` are x and z.
    pub fn floor(&mut self, lo: Vec2, hi: Vec2, y: f32) {
        self.quad([v(lo.x, y, hi.y), v(hi.x, y, hi.y), v(hi.x, y, lo.y), v(lo.x, y, lo.y)]);
    }

    /// Adds a closed box.
    pub fn block(&mut self, lo: Vec3, hi: Vec3) {
        let corner = |i: usize| v([lo.x, hi.x][i & 1], [lo.y, hi.y][i >> 1 & 1], [lo.z, hi.z][i >> 2]);
        for side in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
            self.quad(side.map(corner));
        }
    }

    /// Adds a sphere of `8 n^2` triangles with smooth normals.
    pub fn sphere(&mut self, centre: Vec3, radius: f32, n: u32) {
        let step = std::f32::consts::PI / (2 * n) as f32;
        let point = |i: u32, j: u32| {
            let (theta, phi) = (i as f32 * step, (j % (2 * n)) as f32 * 2.0 * step);
            v(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin())
        };
        for i in 0..2 * n {
            for j in 0..2 * n {
                let [a, b, c, d] = [point(i, j), point(i, j + 1), point(i + 1, j + 1), point(i + 1, j)];
                for t in [[a, b, c], [a, c, d]] {
                    self.triangle_with(t.map(|p| centre + p * radius), t, [Vec2::ZERO; 3]);
                }
            }
        }
    }

    /// The scene, with the given extent.
    ///
    /// # Panics
    /// If the scene is not valid.
    pub fn build(mut self, extent: f32) -> Scene {
        self.0.view.extent = extent;
        Scene::new(self.0).unwrap()
    }
}

/// A scene with its arrays, ready for single rays of the twin.
pub struct Stand {
    /// The tree's nodes, to be tampered with.
    pub nodes: Vec<KdNode>,
    /// The tree's leaf entries, likewise.
    pub leaf_triangles: Vec<u32>,
    /// The triangles, likewise.
    pub triangles: Vec<Triangle>,
    /// What else twin functions read of the scene.
    pub prepared: PreparedScene,
    /// What they read of a frame.
    pub inputs: FrameInputs,
}

/// What a single ray finds, in linear colours.
#[derive(Debug, Clone, Copy)]
pub struct Look {
    /// Triangle that was hit.
    pub triangle: u32,
    /// The point that was hit.
    pub point: SurfacePoint,
    /// One bit for each light that does not reach it.
    pub shadow_bits: u32,
    /// Light without secondary rays.
    pub local: Vec3,
    /// Light gathered by secondary rays.
    pub gcol: Vec3,
    /// Work counters.
    pub work: Work,
}

impl Stand {
    /// Makes `scene` ready, with a frame of `width` by `height` and chains of at most `depth` secondary rays.
    pub fn new(scene: &Scene, width: u32, height: u32, depth: u32) -> Self {
        let prepared = PreparedScene::new(scene, Shading::Full, &rarefy::Monitor::default()).unwrap();
        prepared.tree().assert_well_formed(scene.positions(), scene.triangles());
        let inputs = frame_inputs(scene.view(), &prepared, width, height, 1, depth);
        let args = scene_args(&prepared, &inputs);
        let (nodes, leaf_triangles, triangles) =
            (args.nodes.to_vec(), args.leaf_triangles.to_vec(), args.triangles.to_vec());
        Stand { nodes, leaf_triangles, triangles, prepared, inputs }
    }

    /// The arguments of twin functions.
    pub fn args(&self) -> SceneArgs<'_> {
        SceneArgs {
            nodes: &self.nodes,
            leaf_triangles: &self.leaf_triangles,
            triangles: &self.triangles,
            ..scene_args(&self.prepared, &self.inputs)
        }
    }

    /// Follows the ray from `o` along `d` as the twin follows a pixel's.
    pub fn look(&self, o: Vec3, d: Vec3) -> Option<Look> {
        let scene = self.args();
        let d = rarefy::internal::math::normalize(d);
        let mut work = Work::default();
        let hit = closest_hit(&scene, o, d, &mut work);
        if hit.triangle == NO_TRIANGLE {
            return None;
        }
        let point = surface_point(&scene, o, d, &hit);
        let shadow_bits = shadow_test(&scene, &point, &KnownShadows::default(), &mut work);
        let gcol = gather_secondary(&scene, &point, d, &mut work).gcol;
        let shade = ShadePoint {
            material: point.material,
            position: point.position,
            normal: point.normal,
            s: point.s,
            t: point.t,
            shadow_bits,
        };
        let local = shade_local(&scene, &shade, -d);
        Some(Look { triangle: hit.triangle, point, shadow_bits, local, gcol, work })
    }
}

/// A wall, and before it lines of half a pixel's height at 64x64 pixels: each begins at a height in pixels at the left
/// border and falls by one pixel in so many columns. Each row shows dashes of half as many pixels. The eye holds the
/// light, so that nothing is in shadow.
pub fn dashes(lines: &[(f32, f32)]) -> Scene {
    let half_height_degrees = 0.25_f32.atan().to_degrees();
    let mut builder = SceneBuilder::new("dashes").camera(v(0.0, 0.0, 4.0), v(0.0, 0.0, 0.0), 2.0 * half_height_degrees);
    builder = builder.light(v(0.0, 0.0, 4.0), 8.0);
    builder.object(matte(v(0.8, 0.2, 0.2)));
    builder.wall(Vec2::splat(-3.0), Vec2::splat(3.0), 0.0);
    let place = |x: f32, y: f32| v(x / 32.0 - 1.0, 1.0 - y / 32.0, 0.001);
    for &(top, run) in lines {
        builder.object(matte(v(0.1, 0.1, 0.9)));
        let end = top + 80.0 / run;
        builder.quad([place(-8.0, top + 0.5), place(72.0, end + 0.5), place(72.0, end), place(-8.0, top)]);
    }
    builder.build(40.0)
}

/// A renderer on the CPU twin.
pub fn twin_renderer(scene: Scene) -> Renderer {
    let options = DeviceOptions { device: DeviceChoice::Twin, ..DeviceOptions::default() };
    crate::frames::renderer_of(&scene, &options, &rarefy::Monitor::default()).unwrap()
}

/// The given mode and size with the paper's tolerances at all levels and without correction.
pub fn options(mode: Mode, width: u32, height: u32, block: u32) -> RenderOptions {
    let method = Method::default();
    let checks =
        Checks { secondary_textures: false, second_pairs: false, textures: TextureRule::Border, ..method.checks };
    let checks = checks.at_all_levels(Tolerances::PAPER);
    let method = Method { block, shifted_rows: false, checks, correction: Correction::Off, ..method };
    RenderOptions { width, height, mode, method, ..RenderOptions::default() }
}

/// The options with a changed method.
pub fn with(options: &RenderOptions, change: impl FnOnce(&mut Method)) -> RenderOptions {
    let mut changed = options.clone();
    change(&mut changed.method);
    changed
}

/// The default method in blocks of this side.
pub fn blocks(block: u32) -> Method {
    Method { block, ..Method::default() }
}

/// The default method, corrected in a single round of sweeps.
pub fn sweeps() -> Method {
    let method = Method::default();
    Method { correction: method.correction.spreading(Spread::Sweeps), ..method }
}

/// Off, and every comparison in every spread.
pub fn corrections() -> Vec<Correction> {
    let compared = [Compared::Object, Compared::PAPER, Compared::VISIBLE];
    let spread = |compared| [Correction::converged(compared), Correction::Sweeps(compared)];
    std::iter::once(Correction::Off).chain(compared.into_iter().flat_map(spread)).collect()
}

/// Converged correction by the paper's rule alone: no neighbour is spared, no gap looked across.
pub fn plainly_converged(compared: Compared) -> Correction {
    Correction::Converged { compared, thin_only: false, bridges: false, probes: false }
}

/// Draws a frame without the fall-back and keeps its attributes. Returns picture and statistics.
pub fn draw(renderer: &mut Renderer, options: &RenderOptions) -> rarefy::internal::render::frame::Frame {
    renderer.render_exactly(options, Keep::EVERYTHING).unwrap()
}

/// Random numbers that are the same everywhere (xorshift).
#[derive(Debug, Clone)]
pub struct Random(u64);

impl Random {
    /// Starts with a seed other than 0.
    pub fn new(seed: u64) -> Self {
        Random(seed)
    }

    /// 24 random bits.
    pub fn bits(&mut self) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 40) as u32
    }

    /// Below `n`.
    pub fn below(&mut self, n: usize) -> usize {
        self.bits() as usize % n
    }

    /// In `[0, 1)`.
    pub fn unit(&mut self) -> f32 {
        self.bits() as f32 / (1u32 << 24) as f32
    }

    /// In `[lo, hi)`.
    pub fn range(&mut self, lo: f32, hi: f32) -> f32 {
        lo + (hi - lo) * self.unit()
    }

    /// In the cube `[0, size)`.
    pub fn point(&mut self, size: f32) -> Vec3 {
        v(self.unit(), self.unit(), self.unit()) * size
    }

    /// Any direction.
    pub fn direction(&mut self) -> Vec3 {
        (self.point(2.0) - Vec3::ONE).normalize_or(Vec3::Z)
    }
}

/// Default options at a size.
pub fn sized(width: u32, height: u32) -> RenderOptions {
    RenderOptions { width, height, ..RenderOptions::default() }
}

/// The same frame, fully traced.
pub fn full(options: &RenderOptions) -> RenderOptions {
    RenderOptions { mode: Mode::Full, ..options.clone() }
}

/// Every combination of the options that choose between paths through the kernels.
pub fn combinations(width: u32, height: u32) -> Vec<RenderOptions> {
    let mut all = vec![full(&sized(width, height)), sized(width, height)];
    all.push(RenderOptions { method: Method::paper(), ..sized(width, height) });
    for block in [2, 4] {
        for correction in corrections() {
            for interpolation in Interpolation::ALL {
                for gcol_space in GcolSpace::ALL {
                    let mut method = Method { correction, interpolation, ..blocks(block) };
                    method.checks.gcol_space = gcol_space;
                    all.push(RenderOptions { method, ..sized(width, height) });
                }
            }
        }
    }
    all
}
