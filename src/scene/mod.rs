// SPDX-License-Identifier: MIT OR Apache-2.0
//! What is drawn: triangles, objects, materials, textures, and the view (camera, lights, environment).
//!
//! A [`Scene`] is valid by construction: every index is in range, every number is finite, and it has at least one
//! triangle with an area. [`load()`] makes one from files, [`crate::scene::builtin`] from parameters, [`Scene::new`] from
//! [`SceneParts`], plain data in scene units.

pub mod builtin;
pub(crate) mod check;
mod coplanar;
pub mod doctor;
mod import;

use glam::{DVec3, Vec2, Vec3};

use crate::Result;

pub use check::{
    MAX_COORDINATE, MAX_INDEX_OF_REFRACTION, MAX_INTENSITY, MAX_RADIANCE, MAX_SHININESS, MAX_TEXCOORD,
    MAX_TEXTURE_SIDE, MAX_TRIANGLES, MAX_VIEW_COORDINATE,
};
pub(crate) use import::complete_view;
pub use import::{FileSource, LoadOptions, load, load_from, load_listing, load_with};

pub use crate::layout::NO_OBJECT;

/// Most lights a scene may have: one bit each in a 32-bit word of shadow flags.
pub const MAX_LIGHTS: usize = 32;

/// Everything that is drawn, and how it is looked at. Valid: whoever reads it need not check an index or a number.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    parts: SceneParts,
}

impl Scene {
    /// The scene made of these parts, once all of them are checked.
    ///
    /// ```
    /// use glam::{Vec2, Vec3};
    /// use rarefy::internal::scene::{Material, Object, SceneParts};
    ///
    /// let mut parts = SceneParts {
    ///     positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
    ///     triangles: vec![[0, 1, 2]],
    ///     corner_normals: vec![[rarefy::internal::math::pack_normal(Vec3::Z); 3]],
    ///     corner_texcoords: vec![[Vec2::ZERO; 3]],
    ///     triangle_objects: vec![0],
    ///     objects: vec![Object { name: "triangle".into(), material: 0 }],
    ///     materials: vec![Material::default()],
    ///     ..SceneParts::default()
    /// };
    /// assert!(rarefy::Scene::new(parts.clone()).is_ok());
    /// parts.triangles[0][2] = 3;
    /// let error = rarefy::Scene::new(parts).unwrap_err();
    /// assert_eq!(error.to_string(), "triangles[0]: [0, 1, 3] names a vertex that is not one of the 3");
    /// ```
    ///
    /// # Errors
    /// [`crate::Error::InvalidScene`] with the first part that breaks a rule: lists that do not fit together, an index
    /// out of range, a number that is not finite or beyond its limit (`MAX_...` of this module), texels that do not fill
    /// their texture, more than [`MAX_LIGHTS`] lights, a camera without a direction, no triangle with an area.
    pub fn new(parts: SceneParts) -> Result<Self> {
        check::scene(&parts)?;
        Ok(Scene { parts })
    }

    /// The parts, to be changed and made a scene again.
    pub fn into_parts(self) -> SceneParts {
        self.parts
    }

    /// Looks at the scene in another way.
    ///
    /// # Errors
    /// As for [`View::validate`]; the view then stays.
    pub fn set_view(&mut self, view: View) -> Result<()> {
        view.validate()?;
        self.parts.view = view;
        Ok(())
    }

    /// Short name: the folder's or file's, or the built-in scene's.
    pub fn name(&self) -> &str {
        &self.parts.name
    }

    /// What was taken off all positions of the scene's files, vertices, camera and lights alike, in scene units: 0 unless
    /// the scene lies so far from the origin that single precision would not do. Every position that the library takes
    /// or gives, in a [`View`] as well, is relative to this one; add it to have the file's coordinates.
    pub fn origin(&self) -> DVec3 {
        self.parts.origin
    }

    /// Vertex positions, in scene units, relative to [`Scene::origin`].
    pub fn positions(&self) -> &[Vec3] {
        &self.parts.positions
    }

    /// Three indices into the positions for each triangle. Triangle ids everywhere are indices into this list.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.parts.triangles
    }

    /// Shading normals at the three corners of each triangle, packed by [`crate::math::pack_normal`].
    pub fn corner_normals(&self) -> &[[u32; 3]] {
        &self.parts.corner_normals
    }

    /// Texture coordinates at the three corners of each triangle; not wrapped, `t` upwards.
    pub fn corner_texcoords(&self) -> &[[Vec2; 3]] {
        &self.parts.corner_texcoords
    }

    /// The object of each triangle.
    pub fn triangle_objects(&self) -> &[u32] {
        &self.parts.triangle_objects
    }

    /// Objects: what the similarity test G1 tells apart.
    pub fn objects(&self) -> &[Object] {
        &self.parts.objects
    }

    /// Materials that objects refer to.
    pub fn materials(&self) -> &[Material] {
        &self.parts.materials
    }

    /// Textures that materials refer to.
    pub fn textures(&self) -> &[Texture] {
        &self.parts.textures
    }

    /// Camera, lights and environment.
    pub fn view(&self) -> &View {
        &self.parts.view
    }

    /// Things that were mended or left out while loading, one sentence each, with their place.
    pub fn warnings(&self) -> &[String] {
        &self.parts.warnings
    }

    /// What loading counted; for [`doctor::examine`].
    pub fn notes(&self) -> &LoadNotes {
        &self.parts.notes
    }
}

/// What a [`Scene`] is made of: plain lists, to be filled or changed by anyone and checked by [`Scene::new`].
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SceneParts {
    /// Short name: the folder's or file's, or the built-in scene's.
    pub name: String,
    /// Where the positions count from, in the coordinates of the scene's files; see [`Scene::origin`]. Nothing that is
    /// drawn depends on it.
    pub origin: DVec3,
    /// Vertex positions, in scene units.
    pub positions: Vec<Vec3>,
    /// Three indices into `positions` for each triangle. Triangle ids everywhere are indices into this list.
    pub triangles: Vec<[u32; 3]>,
    /// Shading normals at the three corners of each triangle, packed by [`crate::math::pack_normal`].
    pub corner_normals: Vec<[u32; 3]>,
    /// Texture coordinates at the three corners of each triangle (0 where the file has none); not wrapped.
    /// `t` runs upwards, as in OBJ files.
    pub corner_texcoords: Vec<[Vec2; 3]>,
    /// The object of each triangle: an index into `objects`.
    pub triangle_objects: Vec<u32>,
    /// Objects: what the similarity test G1 tells apart.
    pub objects: Vec<Object>,
    /// Materials that objects refer to.
    pub materials: Vec<Material>,
    /// Textures that materials refer to.
    pub textures: Vec<Texture>,
    /// Camera, lights and environment.
    pub view: View,
    /// Things that were mended or left out while loading, one sentence each, with their place.
    pub warnings: Vec<String>,
    /// What loading counted; for [`doctor::examine`].
    pub notes: LoadNotes,
}

/// What was counted while a scene was loaded, and cannot be seen in the scene any more.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct LoadNotes {
    /// Triangles with a corner whose normal was computed since the file has none.
    pub triangles_without_normals: usize,
    /// Those of them that are smooth or flat as the file's smoothing groups say.
    pub triangles_smoothed_by_groups: usize,
    /// Triangles in a textured material with a corner without texture coordinates.
    pub triangles_without_texcoords: usize,
    /// Triangles left out because they have no area.
    pub dropped_triangles: usize,
    /// Names of OBJ objects and groups that the file opens again after others.
    pub duplicate_names: Vec<String>,
    /// Texture files that were not found or have an unknown format.
    pub missing_textures: Vec<String>,
    /// Whether the view says how large the room is.
    pub extent_given: bool,
    /// Keys of OBJ and MTL files that were not used, file by file.
    pub unused_keys: Vec<UnusedKey>,
    /// Materials on faces about which there is something to say: that are not plain opaque surfaces, or that were mended.
    pub materials: Vec<MaterialNote>,
}

/// A key of an OBJ or MTL file that was not used.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnusedKey {
    /// Path of the file.
    pub file: String,
    /// The key as it is written first, or a word for what has none.
    pub key: String,
    /// How often it occurs.
    pub count: usize,
    /// Where first, from 1.
    pub first_line: usize,
}

/// What became of a material, and why.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MaterialNote {
    /// Its name.
    pub material: String,
    /// What it is.
    pub surface: Surface,
    /// Why; empty where an opaque surface is all that it asks for.
    pub because: &'static str,
    /// Why it has holes; empty where it has none.
    pub cutout_because: &'static str,
    /// The keys that were looked at, as the MTL file has them.
    pub keys: String,
    /// What was not taken as it is written.
    pub mended: Vec<&'static str>,
}

impl MaterialNote {
    /// Whether there is anything to say.
    pub fn says_something(&self) -> bool {
        !self.because.is_empty() || !self.cutout_because.is_empty() || !self.mended.is_empty()
    }
}

/// One object: an OBJ object or group in one material.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Object {
    /// Name of the OBJ object or group.
    pub name: String,
    /// Index into [`SceneParts::materials`].
    pub material: u32,
}

/// How the surface treats a ray.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Surface {
    /// Diffuse and highlight only.
    #[default]
    Opaque,
    /// Reflects with weight `specular`; own colour is `diffuse * (1 - max(specular))`.
    Mirror,
    /// Refracts and reflects by Fresnel's equations; closed surfaces with `index_of_refraction` inside.
    Glass,
    /// A pane without thickness: reflects by Fresnel's equations, lets the rest through unbent.
    ThinGlass,
}

/// A surface material, from MTL and the name lists of `view.json`.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// Name in the MTL file.
    pub name: String,
    /// `Kd`, linear RGB; multiplies the texture where there is one.
    pub diffuse: Vec3,
    /// `Ks`, linear RGB.
    pub specular: Vec3,
    /// `Ns`: Blinn-Phong exponent, at least 0.
    pub shininess: f32,
    /// `Tf`, linear RGB: colour of light that passes through glass.
    pub transmission: Vec3,
    /// `Ke`, linear RGB: light that the surface sends of its own. It lights no other surface; mirrors show it.
    pub emission: Vec3,
    /// `Ni`: index of refraction, at least 1.
    pub index_of_refraction: f32,
    /// Share of its own colour that glass shows, from 0 (clear) to 1; it lets the rest through. Other surfaces show all
    /// of theirs.
    pub opacity: f32,
    /// How rays are treated.
    pub surface: Surface,
    /// `map_Kd`: index into [`SceneParts::textures`].
    pub diffuse_texture: Option<u32>,
    /// `map_d` of an alpha-masked material: texels below one half are holes. Index into [`SceneParts::textures`].
    pub cutout_texture: Option<u32>,
}

impl Default for Material {
    /// Light grey and matte: what faces without a material get.
    fn default() -> Self {
        Material {
            name: "(default)".into(),
            diffuse: Vec3::splat(0.7),
            specular: Vec3::ZERO,
            shininess: 1.0,
            transmission: Vec3::ONE,
            emission: Vec3::ZERO,
            index_of_refraction: 1.5,
            opacity: 0.0,
            surface: Surface::Opaque,
            diffuse_texture: None,
            cutout_texture: None,
        }
    }
}

/// A picture on a surface.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Texture {
    /// File name as the MTL file gives it.
    pub name: String,
    /// Width in texels, at least 1.
    pub width: u32,
    /// Height in texels, at least 1.
    pub height: u32,
    /// One word a texel, rows from the top: red in the lowest byte, then green, blue, alpha; sRGB.
    /// For a cut-out texture the opacity is in alpha.
    pub texels: Vec<u32>,
}

/// How the scene is looked at: the contents of `view.json`. [`Scene::new`] and [`View::validate`] check it.
#[derive(Debug, Clone, PartialEq)]
pub struct View {
    /// The camera.
    pub camera: Camera,
    /// Point lights, at most [`MAX_LIGHTS`].
    pub lights: Vec<Light>,
    /// Ambient light, linear RGB; multiplies `diffuse`.
    pub ambient: Vec3,
    /// What a ray that hits nothing sees, linear RGB.
    pub background: Vec3,
    /// Size of the room in scene units: the length that the tolerance `t_pos` is relative to.
    pub extent: f32,
}

impl View {
    /// Goes on if this view can be drawn.
    ///
    /// # Errors
    /// [`crate::Error::InvalidScene`] with the field: a number that is not finite or beyond its limit, a camera without a
    /// direction, more than [`MAX_LIGHTS`] lights.
    pub fn validate(&self) -> Result<()> {
        check::view(self)
    }
}

impl Default for View {
    fn default() -> Self {
        View {
            camera: Camera::default(),
            lights: Vec::new(),
            ambient: Vec3::splat(0.12),
            background: Vec3::ZERO,
            extent: 1.0,
        }
    }
}

/// A pinhole camera, right-handed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// Position in scene units.
    pub eye: Vec3,
    /// A point in the middle of the picture; differs from `eye`.
    pub look_at: Vec3,
    /// Roughly upwards; not parallel to the line of sight.
    pub up: Vec3,
    /// Vertical field of view in degrees, above 0 and below 180.
    pub fov_y_degrees: f32,
}

impl Default for Camera {
    fn default() -> Self {
        Camera { eye: Vec3::ZERO, look_at: Vec3::NEG_Z, up: Vec3::Y, fov_y_degrees: 45.0 }
    }
}

/// A point light whose light falls off with the square of the distance.
///
/// Reflected radiance is `diffuse * intensity * cos / distance^2`, without a further factor of pi.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Light {
    /// Position in scene units.
    pub position: Vec3,
    /// Linear RGB times squared scene units.
    pub intensity: Vec3,
}
