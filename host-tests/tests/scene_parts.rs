// SPDX-License-Identifier: MIT OR Apache-2.0
//! Scenes that a caller makes: whatever breaks a rule is refused with its place, before anything reads it.
#![allow(clippy::unwrap_used)]

use glam::{Vec2, Vec3};
use rarefy::internal::scene::{
    Camera, Light, MAX_LIGHTS, Material, Object, Scene, SceneParts, Surface, Texture, View, builtin,
};

/// A triangle with everything a scene can have.
fn whole() -> SceneParts {
    SceneParts {
        name: "made".into(),
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        triangles: vec![[0, 1, 2]],
        corner_normals: vec![[0; 3]],
        corner_texcoords: vec![[Vec2::ZERO; 3]],
        triangle_objects: vec![0],
        objects: vec![Object { name: "triangle".into(), material: 0 }],
        materials: vec![Material {
            name: "paint".into(),
            diffuse_texture: Some(0),
            cutout_texture: Some(0),
            surface: Surface::Glass,
            ..Material::default()
        }],
        textures: vec![Texture { name: "t.png".into(), width: 2, height: 1, texels: vec![0, 1] }],
        view: View { lights: vec![Light { position: Vec3::Z, intensity: Vec3::ONE }], ..View::default() },
        ..SceneParts::default()
    }
}

/// A change that breaks a rule, and the message it must give.
type Breakage<T> = (fn(&mut T), &'static str);

/// What no scene may have.
const BREAKAGES: &[Breakage<SceneParts>] = &[
    (|s| s.triangles.clear(), "made: triangles: there are none; nothing to draw"),
    (|s| s.corner_normals.clear(), "made: corner_normals: 0 entries for 1 triangles"),
    (|s| s.corner_texcoords.push([Vec2::ZERO; 3]), "made: corner_texcoords: 2 entries for 1 triangles"),
    (|s| s.triangle_objects.push(0), "made: triangle_objects: 2 entries for 1 triangles"),
    (|s| s.positions[2].y = f32::NAN, "made: positions[2]: [0, NaN, 0] is not finite or beyond 1e9"),
    (|s| s.positions[1].x = f32::NEG_INFINITY, "made: positions[1]: [-inf, 0, 0] is not finite"),
    (|s| s.positions.push(Vec3::splat(2.0e9)), "made: positions[3]: "),
    (|s| s.triangles[0][2] = 3, "made: triangles[0]: [0, 1, 3] names a vertex that is not one of the 3"),
    (|s| s.triangles[0][0] = u32::MAX, "made: triangles[0]: "),
    (|s| s.corner_texcoords[0][1].y = f32::NAN, "made: corner_texcoords[0]: "),
    (|s| s.corner_texcoords[0][1].x = 1.0e17, "made: corner_texcoords[0]: "),
    (|s| s.triangle_objects[0] = 1, "made: triangle_objects[0]: there is no object 1; the scene has 1"),
    (|s| s.objects[0].material = 1, "made: objects[0]: object `triangle` has material 1; the scene has 1"),
    (|s| s.materials.clear(), "made: objects[0]: object `triangle` has material 0; the scene has 0"),
    (
        |s| s.materials[0].diffuse_texture = Some(1),
        "made: materials[0] `paint`.diffuse_texture: there is no texture 1; the scene has 1",
    ),
    (
        |s| s.materials[0].cutout_texture = Some(70_000),
        "made: materials[0] `paint`.cutout_texture: there is no texture",
    ),
    (|s| s.textures.clear(), "made: materials[0] `paint`.diffuse_texture: there is no texture 0; the scene has 0"),
    (|s| s.materials[0].diffuse.x = f32::NAN, "made: materials[0] `paint`.diffuse: "),
    (|s| s.materials[0].specular.y = -0.5, "made: materials[0] `paint`.specular: "),
    (|s| s.materials[0].transmission.z = f32::INFINITY, "made: materials[0] `paint`.transmission: "),
    (|s| s.materials[0].opacity = 1.5, "made: materials[0] `paint`.opacity: 1.5 is out of range"),
    (|s| s.materials[0].shininess = -1.0, "made: materials[0] `paint`.shininess: -1 is out of range"),
    (
        |s| s.materials[0].index_of_refraction = 0.5,
        "made: materials[0] `paint`.index_of_refraction: 0.5 is out of range",
    ),
    (|s| s.textures[0].texels.truncate(1), "made: textures[0] `t.png`: 1 texels for a texture of 2x1"),
    (|s| s.textures[0].height = 0, "made: textures[0] `t.png`: 2x0 texels; sides are 1 to 16384"),
    (|s| s.textures[0].width = 16_385, "made: textures[0] `t.png`: 16385x1 texels; sides are 1 to 16384"),
    (|s| s.positions[2] = Vec3::X, "made: triangles: all 1 are degenerate (no area); nothing to draw"),
    (|s| s.view.extent = 0.0, "made: view.extent: 0 is out of range"),
];

/// What no view may have.
const VIEW_BREAKAGES: &[Breakage<View>] = &[
    (|v| v.lights = vec![v.lights[0]; 40], "lights: 40 lights; at most 32 are drawn"),
    (|v| v.lights = vec![v.lights[0]; 3000], "lights: 3000 lights; at most 32 are drawn"),
    (|v| v.lights[0].position.x = f32::NAN, "lights[0].position: [NaN, 0, 1] is not finite"),
    (|v| v.lights[0].intensity.x = -1.0, "lights[0].intensity: [-1, 1, 1] is out of range (0 to 1e30)"),
    (|v| v.lights[0].intensity.z = f32::NAN, "lights[0].intensity: "),
    (|v| v.ambient.y = f32::INFINITY, "ambient: "),
    (|v| v.background.y = -1.0, "background: "),
    (|v| v.extent = f32::NAN, "extent: NaN is out of range"),
    (|v| v.extent = -1.0, "extent: -1 is out of range"),
    (|v| v.camera.eye.x = f32::NAN, "camera.eye: "),
    (|v| v.camera.look_at.x = f32::INFINITY, "camera.look_at: "),
    (|v| v.camera.look_at = v.camera.eye, "camera.look_at: is the same point as `eye`"),
    (|v| v.camera.up = Vec3::ZERO, "camera.up: [0, 0, 0] has no length"),
    (|v| v.camera.up = v.camera.look_at - v.camera.eye, "camera.up: "),
    (|v| v.camera.fov_y_degrees = 180.0, "camera.fov_y_degrees: 180 is out of range"),
    (|v| v.camera.fov_y_degrees = f32::NAN, "camera.fov_y_degrees: NaN is out of range"),
];

#[test]
fn a_scene_that_breaks_a_rule_is_refused_with_its_place() {
    assert!(Scene::new(whole()).is_ok());
    for (breaks, expected) in BREAKAGES {
        let mut parts = whole();
        breaks(&mut parts);
        let message = Scene::new(parts).unwrap_err().to_string();
        assert!(message.starts_with(expected), "`{message}` instead of `{expected}`");
    }
}

#[test]
fn a_view_that_breaks_a_rule_is_refused_alone_and_in_a_scene() {
    for (breaks, expected) in VIEW_BREAKAGES {
        let mut parts = whole();
        breaks(&mut parts.view);
        let message = parts.view.validate().unwrap_err().to_string();
        assert!(message.starts_with(&format!("view: {expected}")), "`{message}` instead of `{expected}`");
        let mut scene = Scene::new(whole()).unwrap();
        assert!(scene.set_view(parts.view.clone()).is_err());
        assert_eq!(*scene.view(), whole().view, "a refused view stayed");
        let message = Scene::new(parts).unwrap_err().to_string();
        assert!(message.starts_with(&format!("made: view.{expected}")), "`{message}` instead of `{expected}`");
    }
}

#[test]
fn the_most_that_is_allowed_is_accepted() {
    let mut scene = Scene::new(whole()).unwrap();
    for lights in [0, MAX_LIGHTS] {
        let light = Light { position: Vec3::splat(1.0e9), intensity: Vec3::splat(1.0e30) };
        let view = View { lights: vec![light; lights], ..View::default() };
        scene.set_view(view.clone()).unwrap();
        assert_eq!(*scene.view(), view);
    }
    let far =
        Camera { eye: Vec3::splat(1.0e9), look_at: Vec3::splat(-1.0e9), fov_y_degrees: 179.9, ..Camera::default() };
    scene.set_view(View { camera: far, extent: 2.0e9, ..View::default() }).unwrap();
    let mut parts = whole();
    parts.textures[0] = Texture { name: "wide".into(), width: 16_384, height: 1, texels: vec![0; 16_384] };
    parts.positions[2] = Vec3::Y * 1.0e9;
    parts.corner_texcoords[0][0] = Vec2::splat(-1.0e16);
    Scene::new(parts).unwrap();
}

#[test]
fn parts_come_back_as_they_were() {
    for name in rarefy_host_tests::fixtures::quick_scenes() {
        let scene = builtin::to_scene(name).unwrap();
        assert_eq!(Scene::new(scene.clone().into_parts()).unwrap(), scene);
    }
}
