// SPDX-License-Identifier: MIT OR Apache-2.0
//! The built-in scenes: what they hold, that they are the same every time, and that files and memory agree.
#![allow(clippy::unwrap_used)]

use std::collections::{HashMap, HashSet};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use glam::Vec3;
use rarefy::internal::layout::PLANE_OBJECT;
use rarefy::internal::scene::builtin::mesh::Mesh;
use rarefy::internal::scene::builtin::{self, Model};
use rarefy::internal::scene::doctor::{Severity, examine};
use rarefy::internal::scene::{LoadNotes, Scene, Surface};
use rarefy::{Cancel, Error, Event, Keep, Mode, Monitor};
use rarefy_host_tests::fixtures::{options, quick_scenes, twin_renderer};

fn all() -> Vec<Model> {
    quick_scenes().map(|name| builtin::generate(name).unwrap()).collect()
}

#[test]
fn triangle_counts_are_those_of_the_views() {
    let counts: Vec<(String, usize)> = all().iter().map(|m| (m.name.clone(), m.triangle_count())).collect();
    let large = [
        ("cafe", 28_000..=30_000),
        ("runner", 76_000..=80_000),
        ("kitchen", 95_000..=110_000),
        ("conference", 265_000..=285_000),
        ("bathroom", 250_000..=290_000),
    ];
    let tiny = [("wall", 2), ("spheres", 2882), ("rods", 338), ("mirror-room", 60)];
    assert_eq!(counts.len(), large.len() + tiny.len());
    for ((name, count), (expected_name, expected)) in counts.iter().zip(large.clone()) {
        assert!(name == expected_name && expected.contains(count), "{counts:?}");
    }
    for ((name, count), (expected_name, expected)) in counts[large.len()..].iter().zip(tiny) {
        assert_eq!((name.as_str(), *count), (expected_name, expected));
    }
    for model in all() {
        let view: serde_json::Value = serde_json::from_str(model.view).unwrap();
        assert_eq!(view["triangles"], model.triangle_count(), "{}", model.name);
        assert_eq!(view["name"], model.name.as_str());
    }
}

#[test]
fn unknown_names_are_refused_with_a_list() {
    let message = builtin::generate("caffe").unwrap_err().to_string();
    assert!(message.contains("`caffe`") && message.contains("mirror-room"), "{message}");
}

/// What is wrong with a mesh, if anything.
fn fault(mesh: &Mesh) -> Option<String> {
    let vertices = mesh.positions.len();
    if mesh.normals.len() != vertices || mesh.texcoords.len() != vertices {
        return Some("lists of different lengths".into());
    }
    for n in &mesh.normals {
        if (n.length() - 1.0).abs() > 2e-4 {
            return Some(format!("normal {n} of length {}", n.length()));
        }
    }
    let finite = mesh.positions.iter().all(|p| p.is_finite()) && mesh.texcoords.iter().all(|t| t.is_finite());
    if !finite {
        return Some("a number that is not finite".into());
    }
    for t in &mesh.triangles {
        if t.iter().any(|&i| i as usize >= vertices) {
            return Some(format!("index out of range in {t:?}"));
        }
        let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
        if (b - a).cross(c - a).length() < 1e-9 {
            return Some(format!("no area between {a}, {b} and {c}"));
        }
    }
    None
}

fn sound(model: &Model) {
    for group in &model.groups {
        assert_eq!(fault(&group.mesh), None, "{}: {}", model.name, group.name);
    }
}

#[test]
fn meshes_are_sound() {
    for model in all() {
        sound(&model);
    }
    // The same check finds what is wrong.
    let mut mesh = Mesh::sphere(1.0, 8, 4);
    mesh.normals[3] *= 1.01;
    assert!(fault(&mesh).unwrap().contains("normal"));
    let mut mesh = Mesh::sphere(1.0, 8, 4);
    mesh.triangles[0][1] = 10_000;
    assert!(fault(&mesh).unwrap().contains("index"));
    let mut mesh = Mesh::sphere(1.0, 8, 4);
    mesh.triangles[0][1] = mesh.triangles[0][0];
    assert!(fault(&mesh).unwrap().contains("area"));
}

#[test]
fn names_are_unique_and_every_material_and_picture_is_used() {
    for model in all() {
        let names: HashSet<&str> = model.groups.iter().map(|g| g.name.as_str()).collect();
        assert_eq!(names.len(), model.groups.len(), "{}", model.name);
        let used: HashSet<&str> = model.groups.iter().map(|g| g.material.as_str()).collect();
        for m in &model.materials {
            assert!(used.contains(m.name.as_str()), "{}: material `{}` is not used", model.name, m.name);
            let energy = Vec3::from(m.diffuse).max_element().max(Vec3::from(m.specular).max_element());
            assert!((0.0..=1.0).contains(&energy), "{}: {}", model.name, m.name);
        }
        let pictures: HashSet<&String> = model.materials.iter().flat_map(|m| [&m.texture, &m.mask]).flatten().collect();
        for t in &model.textures {
            assert!(pictures.contains(&t.name), "{}: picture `{}` is not used", model.name, t.name);
            assert_eq!(t.rgb.len(), (t.width * t.height * 3) as usize);
        }
        for word in names.iter().copied().chain(model.materials.iter().map(|m| m.name.as_str())) {
            assert!(!word.is_empty() && word.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'-'), "{word}");
        }
    }
}

/// Edges that are not shared by exactly two faces of opposite direction.
fn open_edges(mesh: &Mesh) -> usize {
    let key = |i: u32| mesh.positions[i as usize].to_array().map(|v| (v + 0.0).to_bits());
    let mut edges: HashMap<_, [u32; 2]> = HashMap::new();
    for t in &mesh.triangles {
        for k in 0..3 {
            let (a, b) = (key(t[k]), key(t[(k + 1) % 3]));
            let forwards = a < b;
            edges.entry(if forwards { (a, b) } else { (b, a) }).or_default()[usize::from(forwards)] += 1;
        }
    }
    edges.values().filter(|&&count| count != [1, 1]).count()
}

/// How many glass objects a model has, all closed.
fn closed_glass(model: &Model) -> usize {
    let is_glass = |name: &str| model.materials[model.material_index(name).unwrap()].surface == Surface::Glass;
    let glass: Vec<_> = model.groups.iter().filter(|group| is_glass(&group.material)).collect();
    for group in &glass {
        assert_eq!(open_edges(&group.mesh), 0, "{}: {}", model.name, group.name);
        let p = |i: u32| group.mesh.positions[i as usize].as_dvec3();
        let volume: f64 = group.mesh.triangles.iter().map(|t| p(t[0]).dot(p(t[1]).cross(p(t[2])))).sum();
        assert!(volume > 0.0, "{}: {} is inside out", model.name, group.name);
    }
    glass.len()
}

#[test]
fn glass_objects_are_closed_and_face_outwards() {
    let found: usize = all().iter().map(closed_glass).sum();
    assert!(found >= 4, "only {found} glass objects");
    let mut mesh = Mesh::sphere(1.0, 8, 4);
    mesh.triangles.swap_remove(7);
    assert_eq!(open_edges(&mesh), 3);
}

#[test]
fn two_runs_make_the_same_bytes() {
    let text = |m: &Model| (builtin::obj_text(m), builtin::mtl_text(m));
    for (a, b) in all().iter().zip(&all()) {
        assert!(a == b, "{}", a.name);
        assert!(text(a) == text(b), "{}", a.name);
    }
}

/// FNV-1a over what a model is made of.
fn fingerprint(model: &Model) -> u64 {
    let mut hash = 0xcbf2_9ce4_8422_2325u64;
    let mut eat = |bytes: &[u8]| {
        for &b in bytes {
            hash = (hash ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3);
        }
    };
    eat(builtin::obj_text(model).as_bytes());
    eat(builtin::mtl_text(model).as_bytes());
    for t in &model.textures {
        eat(&t.rgb);
    }
    hash
}

/// A change of these numbers is a change of the scenes: every platform must make these very bytes.
#[test]
fn every_platform_makes_the_same_bytes() {
    let found: Vec<String> = all().iter().map(|m| format!("{} {:016x}", m.name, fingerprint(m))).collect();
    assert_eq!(found, FINGERPRINTS);
}

const FINGERPRINTS: [&str; 9] = [
    "cafe c6cf9905b8189a25",
    "runner 009adf8c6a864d71",
    "kitchen cf832d98f397872a",
    "conference 800ee61a964ca13a",
    "bathroom f401c9e1fb9c7d16",
    "wall d0a6efcf7680eabe",
    "spheres 41b661c0471587dc",
    "rods 596a3956f97fde18",
    "mirror-room b0c4936184061361",
];

/// The share of a small picture's pixels that see a mirror, and glass.
fn shares(name: &str) -> [f64; 2] {
    let scene = builtin::to_scene(name).unwrap();
    let options = options(Mode::Full, 96, 96, 2);
    let surfaces: Vec<Surface> =
        scene.objects().iter().map(|o| scene.materials()[o.material as usize].surface).collect();
    let mut renderer = twin_renderer(scene);
    renderer.render_exactly(&options, Keep::planes(&[PLANE_OBJECT])).unwrap();
    let objects = renderer.plane(PLANE_OBJECT).unwrap();
    let share = |wanted: &[Surface]| {
        let seen = objects.iter().filter(|&&o| surfaces.get(o as usize).is_some_and(|s| wanted.contains(s))).count();
        seen as f64 / objects.len() as f64
    };
    [share(&[Surface::Mirror]), share(&[Surface::Glass, Surface::ThinGlass])]
}

#[test]
fn scenes_show_mirrors_and_glass_as_they_promise() {
    // Sunglasses, rods and a cup; two bottles far away.
    let [mirrors, glass] = shares("runner");
    assert!((0.005..0.1).contains(&mirrors) && glass < 0.01, "{mirrors} {glass}");
    // Metal all over, with jars, glasses and a window; a mirror that fills a wall.
    let [mirrors, glass] = shares("kitchen");
    assert!((0.04..0.25).contains(&mirrors) && (0.005..0.1).contains(&glass), "{mirrors} {glass}");
    // Chairs on chromed tubes, carafes and glasses, windows behind blinds.
    let [mirrors, glass] = shares("conference");
    assert!((0.01..0.1).contains(&mirrors) && (0.005..0.1).contains(&glass), "{mirrors} {glass}");
    let [mirrors, glass] = shares("bathroom");
    assert!((0.04..0.2).contains(&mirrors) && (0.04..0.2).contains(&glass), "{mirrors} {glass}");
    assert_eq!(shares("wall"), [0.0, 0.0]);
}

#[test]
fn the_doctor_warns_of_nothing_in_the_rooms() {
    for name in ["runner", "kitchen", "conference", "bathroom"] {
        nothing_bad(name, &builtin::to_scene(name).unwrap());
    }
}

fn nothing_bad(name: &str, scene: &Scene) {
    let findings = examine(scene);
    let bad: Vec<_> = findings.iter().filter(|f| f.severity == Severity::Warning || f.topic == "winding").collect();
    assert!(bad.is_empty(), "{name}: {bad:?}");
}

#[test]
#[ignore = "long: makes and examines millions of triangles"]
fn huge_scenes_are_what_they_say_too() {
    for name in builtin::HUGE {
        let model = builtin::generate(name).unwrap();
        let view: serde_json::Value = serde_json::from_str(model.view).unwrap();
        assert!(model.triangle_count() >= 2_000_000);
        assert_eq!(view["triangles"], model.triangle_count());
        sound(&model);
        closed_glass(&model);
        assert_eq!(format!("{name} {:016x}", fingerprint(&model)), "courtyard 1becc45f87bec3a1");
        nothing_bad(name, &builtin::to_scene(name).unwrap());
    }
}

/// A monitor that cancels at the first report of progress beyond `share`, and counts the reports.
fn cancelling(share: f32) -> (Monitor, Arc<AtomicUsize>) {
    let (cancel, count) = (Cancel::default(), Arc::new(AtomicUsize::new(0)));
    let (token, reports) = (cancel.clone(), Arc::clone(&count));
    let monitor = Monitor::new(move |event| {
        if let Event::Progress { share: done, .. } = event {
            reports.fetch_add(1, Ordering::Relaxed);
            if done > share {
                token.cancel();
            }
        }
    });
    (monitor.with_cancel(&cancel), count)
}

#[test]
fn making_a_scene_can_be_watched_and_cancelled() {
    // Early, while pictures are painted.
    let (monitor, reports) = cancelling(0.02);
    assert!(matches!(builtin::generate_watched("courtyard", &monitor), Err(Error::Cancelled)));
    assert!(reports.load(Ordering::Relaxed) > 1);
    // Late: the model is there, and is being written.
    let folder = tempfile::tempdir().unwrap();
    let (monitor, reports) = cancelling(0.6);
    let written = builtin::write_watched("cafe", &folder.path().join("cafe"), &monitor);
    assert!(matches!(written, Err(Error::Cancelled)) && reports.load(Ordering::Relaxed) > 10);
    assert_eq!(entries(folder.path()), Vec::<String>::new());
    let (monitor, _) = cancelling(0.85);
    assert!(matches!(builtin::to_scene_watched("cafe", &monitor), Err(Error::Cancelled)));
    let (monitor, reports) = cancelling(2.0);
    assert_eq!(
        difference(&builtin::to_scene_watched("rods", &monitor).unwrap(), &builtin::to_scene("rods").unwrap()),
        None
    );
    assert!(reports.load(Ordering::Relaxed) > 1);
}

#[test]
fn lights_stand_below_the_lamps() {
    a_light_below_each_lamp("cafe");
    a_light_below_each_lamp("kitchen");
    a_light_below_each_lamp("conference");
}

fn a_light_below_each_lamp(name: &str) {
    let model = builtin::generate(name).unwrap();
    let scene = builtin::to_scene(name).unwrap();
    let below = |light: Vec3, mesh: &Mesh| {
        let lo = mesh.positions.iter().copied().reduce(Vec3::min).unwrap();
        let hi = mesh.positions.iter().copied().reduce(Vec3::max).unwrap();
        let (x, z) = (0.5 * (lo.x + hi.x), 0.5 * (lo.z + hi.z));
        (light.x - x).abs() < 0.01 && (light.z - z).abs() < 0.01 && light.y < lo.y && light.y > lo.y - 0.4
    };
    let shades: Vec<&Mesh> = model.groups.iter().filter(|g| g.name.ends_with("-shade")).map(|g| &g.mesh).collect();
    assert!(shades.len() >= 2);
    for shade in shades {
        assert_eq!(scene.view().lights.iter().filter(|l| below(l.position, shade)).count(), 1);
    }
}

/// The first difference between two scenes, if any.
fn difference(a: &Scene, b: &Scene) -> Option<&'static str> {
    let same_bits = |a: &[Vec3], b: &[Vec3]| {
        a.len() == b.len()
            && a.iter().zip(b).all(|(a, b)| a.to_array().map(f32::to_bits) == b.to_array().map(f32::to_bits))
    };
    [
        ("name", a.name() == b.name()),
        ("positions", same_bits(a.positions(), b.positions())),
        ("triangles", a.triangles() == b.triangles()),
        ("corner_normals", a.corner_normals() == b.corner_normals()),
        ("corner_texcoords", a.corner_texcoords() == b.corner_texcoords()),
        ("triangle_objects", a.triangle_objects() == b.triangle_objects()),
        ("objects", a.objects() == b.objects()),
        ("materials", a.materials() == b.materials()),
        ("textures", a.textures() == b.textures()),
        ("view", a.view() == b.view()),
        ("warnings", a.warnings() == b.warnings()),
        // Why materials became what they are, only files can say.
        ("notes", without_reasons(a.notes()) == without_reasons(b.notes())),
    ]
    .into_iter()
    .find_map(|(what, same)| (!same).then_some(what))
}

fn without_reasons(notes: &LoadNotes) -> LoadNotes {
    LoadNotes { materials: Vec::new(), ..notes.clone() }
}

#[test]
fn files_and_memory_give_the_same_scene() {
    let folder = tempfile::tempdir().unwrap();
    for name in quick_scenes() {
        let path = folder.path().join("made").join(name);
        builtin::write(name, &path).unwrap();
        let loaded = rarefy::internal::scene::load(&path, &rarefy::Monitor::default()).unwrap();
        let made = builtin::to_scene(name).unwrap();
        assert_eq!(difference(&loaded, &made), None, "{name}");
        assert_eq!(loaded.warnings(), Vec::<String>::new());
        let mut parts = loaded.into_parts();
        parts.corner_texcoords.last_mut().unwrap()[2].x += 1e-4;
        assert_eq!(difference(&Scene::new(parts).unwrap(), &made), Some("corner_texcoords"));
    }
}

fn entries(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

#[test]
fn writing_takes_an_empty_folder_and_refuses_others() {
    let base = tempfile::tempdir().unwrap();
    let empty = base.path().join("empty");
    std::fs::create_dir(&empty).unwrap();
    builtin::write("wall", &empty).unwrap();
    assert_eq!(entries(&empty), ["scene.mtl", "scene.obj", "view.json"]);

    // Now it is not empty any more, and nothing in it changes.
    std::fs::write(empty.join("scene.obj"), "mine").unwrap();
    let error = builtin::write("wall", &empty).unwrap_err();
    assert!(matches!(error, Error::Io { .. }) && error.to_string().contains("not empty"), "{error}");
    assert_eq!(std::fs::read_to_string(empty.join("scene.obj")).unwrap(), "mine");

    let file = base.path().join("file");
    std::fs::write(&file, "mine").unwrap();
    let error = builtin::write("wall", &file).unwrap_err().to_string();
    assert!(error.contains("this is a file"), "{error}");

    // A folder below a file cannot be made; nothing is left behind.
    assert!(builtin::write("wall", &file.join("below")).is_err());
    assert!(builtin::write("no such scene", &base.path().join("none")).is_err());
    assert_eq!(entries(base.path()), ["empty", "file"]);
}
