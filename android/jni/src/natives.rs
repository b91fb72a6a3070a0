// SPDX-License-Identifier: MIT OR Apache-2.0
//! The native methods of `dev.rarefy.Native`: each turns Java's arguments into Rust's, makes one call, and turns the
//! result into Java's.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::os::fd::BorrowedFd;
use std::os::unix::fs::FileExt;

use jni::objects::{IntoAuto as _, JByteBuffer, JClass, JFloatArray, JObject, JObjectArray, JString};
use jni::sys::{jint, jlong};
use jni::{Env, JValue, NativeMethod, native_method};
use rarefy::internal::device::stage::Stage;
use rarefy::{Camera, Error, Frame, Light, Monitor, PreparedScene, Scene, Shading};

use crate::classes::{self, Classes, DEVICE_INFO, FRAME_STATS, OPENCL_REPORT, PICTURE, strings};
use crate::failure::{self, Failure};
use crate::guard::Guard;
use crate::listeners::{Assets, Listeners, argb_array};
use crate::picture::{self, Canvas, Format, Picture, Target};
use crate::session;
use crate::settings::{self, FrameSettings};

/// The native methods.
pub const METHODS: &[NativeMethod] = &[
    native_method! { error_policy = Guard, static fn version() -> JString },
    native_method! { error_policy = Guard, static fn create() -> jlong },
    native_method! { error_policy = Guard, static fn close(handle: jlong) },
    native_method! { error_policy = Guard, static fn release(handle: jlong) },
    native_method! { error_policy = Guard, static fn open_count() -> jint },
    native_method! { error_policy = Guard, static fn cancel(handle: jlong) },
    native_method! { error_policy = Guard,
    static fn load_files(handle: jlong, path: JString, device: JString[], progress: dev.rarefy.ProgressListener) },
    native_method! { error_policy = Guard,
    static fn load_builtin(handle: jlong, name: JString, device: JString[], progress: dev.rarefy.ProgressListener) },
    native_method! { error_policy = Guard, static fn load_assets(handle: jlong, reader: dev.rarefy.AssetReader,
    name: JString, device: JString[], progress: dev.rarefy.ProgressListener) },
    native_method! { error_policy = Guard, static fn load_baked(handle: jlong, path: JString, offset: jlong, length: jlong,
    device: JString[], progress: dev.rarefy.ProgressListener) },
    native_method! { error_policy = Guard, static fn load_baked_descriptor(handle: jlong, descriptor: jint, offset: jlong,
    length: jlong, device: JString[], progress: dev.rarefy.ProgressListener) },
    native_method! { error_policy = Guard, static fn render_buffer(handle: jlong, frame: JString[],
    buffer: java.nio.ByteBuffer, offset: jint, progress: dev.rarefy.ProgressListener,
    preview: dev.rarefy.PreviewListener) -> dev.rarefy.FrameStats },
    native_method! { error_policy = Guard, static fn render_bitmap(handle: jlong, frame: JString[],
    bitmap: java.lang.Object, progress: dev.rarefy.ProgressListener,
    preview: dev.rarefy.PreviewListener) -> dev.rarefy.FrameStats },
    native_method! { error_policy = Guard, static fn render_surface(handle: jlong, frame: JString[],
    surface: java.lang.Object, progress: dev.rarefy.ProgressListener,
    preview: dev.rarefy.PreviewListener) -> dev.rarefy.FrameStats },
    native_method! { error_policy = Guard, static fn layer(handle: jlong, name: JString) -> dev.rarefy.Picture },
    native_method! { error_policy = Guard, static fn camera(handle: jlong) -> jfloat[] },
    native_method! { error_policy = Guard, static fn set_camera(handle: jlong, camera: jfloat[]) },
    native_method! { error_policy = Guard, static fn lights(handle: jlong) -> jfloat[] },
    native_method! { error_policy = Guard, static fn set_lights(handle: jlong, lights: jfloat[]) },
    native_method! { error_policy = Guard, static fn device_info(handle: jlong) -> dev.rarefy.DeviceInfo },
    native_method! { error_policy = Guard, static fn opencl_report(device: JString[]) -> dev.rarefy.OpenClReport },
];

type Done<T> = Result<T, Failure>;

/// The texts of an array. Each reference is freed at once: an array may have more of them than a call may hold.
fn texts(env: &mut Env<'_>, array: &JObjectArray<'_, JString<'_>>) -> Done<Vec<String>> {
    (0..array.len(env)?).map(|at| Ok(array.get_element(env, at)?.auto().try_to_string(env)?)).collect()
}

fn loaded_classes() -> Done<&'static Classes> {
    classes::get().ok_or_else(|| jni::errors::Error::UninitializedJavaVM.into())
}

fn version<'local>(env: &mut Env<'local>, _class: JClass<'local>) -> Done<JString<'local>> {
    Ok(env.new_string(env!("CARGO_PKG_VERSION"))?)
}

fn create<'local>(_env: &mut Env<'local>, _class: JClass<'local>) -> Done<jlong> {
    Ok(session::create())
}

fn close<'local>(_env: &mut Env<'local>, _class: JClass<'local>, handle: jlong) -> Done<()> {
    session::close(handle);
    Ok(())
}

fn release<'local>(_env: &mut Env<'local>, _class: JClass<'local>, handle: jlong) -> Done<()> {
    session::release(handle);
    Ok(())
}

fn open_count<'local>(_env: &mut Env<'local>, _class: JClass<'local>) -> Done<jint> {
    Ok(jint::try_from(session::count()).unwrap_or(jint::MAX))
}

fn cancel<'local>(_env: &mut Env<'local>, _class: JClass<'local>, handle: jlong) -> Done<()> {
    // A tracer that was closed has nothing left to cancel.
    if let Ok(session) = session::get(handle) {
        session.cancel();
    }
    Ok(())
}

/// Loads what `scene` prepares.
fn load<'local>(
    env: &mut Env<'local>,
    handle: jlong,
    device: &JObjectArray<'local, JString<'local>>,
    progress: &JObject<'local>,
    scene: impl FnOnce(&mut Env<'local>, &Monitor) -> Done<PreparedScene>,
) -> Done<()> {
    let session = session::get(handle)?;
    let device = settings::device(&texts(env, device)?)?;
    let listeners = Listeners::new(env, progress, &JObject::null())?;
    let loaded = session.load(&listeners.monitor(), &device, |monitor| scene(env, monitor));
    listeners.rethrow(env, loaded)
}

fn load_files<'local>(
    env: &mut Env<'local>,
    _class: JClass<'local>,
    handle: jlong,
    path: JString<'local>,
    device: JObjectArray<'local, JString<'local>>,
    progress: JObject<'local>,
) -> Done<()> {
    let path = path.try_to_string(env)?;
    load(env, handle, &device, &progress, |_, monitor| prepare(&rarefy::load(path.as_ref(), monitor)?, monitor))
}

fn load_builtin<'local>(
    env: &mut Env<'local>,
    _class: JClass<'local>,
    handle: jlong,
    name: JString<'local>,
    device: JObjectArray<'local, JString<'local>>,
    progress: JObject<'local>,
) -> Done<()> {
    let name = name.try_to_string(env)?;
    load(env, handle, &device, &progress, |_, monitor| prepare(&rarefy::builtin(&name)?, monitor))
}

fn load_assets<'local>(
    env: &mut Env<'local>,
    _class: JClass<'local>,
    handle: jlong,
    reader: JObject<'local>,
    name: JString<'local>,
    device: JObjectArray<'local, JString<'local>>,
    progress: JObject<'local>,
) -> Done<()> {
    let name = name.try_to_string(env)?;
    load(env, handle, &device, &progress, |env, monitor| {
        let assets = Assets::new(env, &reader);
        let scene = rarefy::load_from(&name, &assets, &Default::default(), monitor);
        prepare(&scene.map_err(|error| assets.failure(error))?, monitor)
    })
}

fn prepare(scene: &Scene, monitor: &Monitor) -> Done<PreparedScene> {
    Ok(PreparedScene::new(scene, Shading::Full, monitor)?)
}

#[allow(clippy::too_many_arguments)] // Java's signature.
fn load_baked<'local>(
    env: &mut Env<'local>,
    _class: JClass<'local>,
    handle: jlong,
    path: JString<'local>,
    offset: jlong,
    length: jlong,
    device: JObjectArray<'local, JString<'local>>,
    progress: JObject<'local>,
) -> Done<()> {
    let path = path.try_to_string(env)?;
    load(env, handle, &device, &progress, |_, monitor| match length {
        -1 => Ok(PreparedScene::from_baked_file(path.as_ref(), monitor)?),
        _ => {
            let file = File::open(&path).map_err(|error| Error::io(&path, error))?;
            baked_part(&file, offset, length, monitor)
        }
    })
}

#[allow(clippy::too_many_arguments)] // Java's signature.
fn load_baked_descriptor<'local>(
    env: &mut Env<'local>,
    _class: JClass<'local>,
    handle: jlong,
    descriptor: jint,
    offset: jlong,
    length: jlong,
    device: JObjectArray<'local, JString<'local>>,
    progress: JObject<'local>,
) -> Done<()> {
    load(env, handle, &device, &progress, |_, monitor| {
        if descriptor < 0 {
            return Err(Failure::Argument(format!("{descriptor} is no file descriptor")));
        }
        // SAFETY: it is borrowed for the duplication alone, which fails if it is no open file's.
        let borrowed = unsafe { BorrowedFd::borrow_raw(descriptor) };
        let own = borrowed.try_clone_to_owned().map_err(|error| Error::io("file descriptor", error))?;
        baked_part(&File::from(own), offset, length, monitor)
    })
}

fn baked_part(file: &File, offset: jlong, length: jlong, monitor: &Monitor) -> Done<PreparedScene> {
    let (Ok(offset), Ok(length)) = (u64::try_from(offset), u64::try_from(length)) else {
        return Err(Failure::Argument(format!("{length} bytes at {offset} are no part of a file")));
    };
    Ok(PreparedScene::from_baked_part(&mut AtPosition { file, position: 0 }, offset, length, monitor)?)
}

/// A file with a position of its own: a duplicated descriptor shares that of the app's, which may read from it as well.
struct AtPosition<'a> {
    file: &'a File,
    position: u64,
}

impl Read for AtPosition<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.file.read_at(buffer, self.position)?;
        self.position += read as u64;
        Ok(read)
    }
}

impl Seek for AtPosition<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.position = match to {
            SeekFrom::Start(position) => position,
            SeekFrom::Current(by) => self.position.checked_add_signed(by).ok_or(io::ErrorKind::InvalidInput)?,
            SeekFrom::End(by) => {
                self.file.metadata()?.len().checked_add_signed(by).ok_or(io::ErrorKind::InvalidInput)?
            }
        };
        Ok(self.position)
    }
}

/// Draws a frame into a target.
fn render<'local>(
    env: &mut Env<'local>,
    handle: jlong,
    frame: &FrameSettings,
    (progress, preview): (&JObject<'local>, &JObject<'local>),
    target: &mut dyn Target,
) -> Done<JObject<'local>> {
    let session = session::get(handle)?;
    let listeners = Listeners::new(env, progress, preview)?;
    let drawn = session.draw(&listeners.monitor(), &frame.options, frame.keep, |drawn| {
        let (width, height) = (drawn.width as usize, drawn.height as usize);
        picture::show(target, Picture { width, height, pixels: &drawn.pixels })?;
        Ok(Frame { width: drawn.width, height: drawn.height, pixels: Vec::new(), stats: drawn.stats.clone() })
    });
    let drawn = listeners.rethrow(env, drawn)?;
    frame_stats(env, &drawn)
}

/// A direct buffer's memory as rows without gaps.
struct Buffer<'a> {
    bytes: &'a mut [u8],
    width: usize,
    height: usize,
}

impl Target for Buffer<'_> {
    fn with_canvas(&mut self, draw: &mut dyn FnMut(&mut Canvas<'_>) -> Result<(), Failure>) -> Result<(), Failure> {
        let (width, height, format) = (self.width, self.height, Format::Rgba8888);
        draw(&mut Canvas { width, height, stride_bytes: width * format.bytes(), format, bytes: self.bytes })
    }
}

#[allow(clippy::too_many_arguments)] // Java's signature.
fn render_buffer<'local>(
    env: &mut Env<'local>,
    _class: JClass<'local>,
    handle: jlong,
    frame: JObjectArray<'local, JString<'local>>,
    buffer: JByteBuffer<'local>,
    offset: jint,
    progress: JObject<'local>,
    preview: JObject<'local>,
) -> Done<JObject<'local>> {
    let frame = settings::frame(&texts(env, &frame)?)?;
    if !frame.has_size {
        return Err(Failure::Argument(
            "a ByteBuffer has no size of its own: set RenderOptions.Builder.size".to_owned(),
        ));
    }
    frame.options.validate()?;
    let (width, height) = (frame.options.width as usize, frame.options.height as usize);
    let capacity = env.get_direct_buffer_capacity(&buffer)?;
    let address = env.get_direct_buffer_address(&buffer)?;
    let wanted = width.checked_mul(height).and_then(|pixels| pixels.checked_mul(4));
    let offset = usize::try_from(offset).ok().filter(|&offset| offset <= capacity);
    let (Some(wanted), Some(offset)) = (wanted, offset) else {
        return Err(Failure::Argument("the ByteBuffer does not reach to its position".to_owned()));
    };
    if capacity - offset < wanted {
        let text = format!("{width}x{height} pixels take {wanted} bytes, the ByteBuffer has {}", capacity - offset);
        return Err(Failure::Argument(text));
    }
    // SAFETY: Java allocated the buffer with `capacity` bytes at `address`, zeroed, and keeps them where they are as long
    // as the reference that this native method was given is alive. What Java code writes there meanwhile is a race of
    // bytes with this method's, which RayTracer.render forbids; no value of them is invalid.
    let bytes = unsafe { std::slice::from_raw_parts_mut(address.add(offset), wanted) };
    render(env, handle, &frame, (&progress, &preview), &mut Buffer { bytes, width, height })
}

#[cfg(target_os = "android")]
fn render_bitmap<'local>(
    env: &mut Env<'local>,
    _class: JClass<'local>,
    handle: jlong,
    frame: JObjectArray<'local, JString<'local>>,
    bitmap: JObject<'local>,
    progress: JObject<'local>,
    preview: JObject<'local>,
) -> Done<JObject<'local>> {
    let mut frame = settings::frame(&texts(env, &frame)?)?;
    let mut target = crate::android::BitmapTarget::new(env, &bitmap)?;
    if !frame.has_size {
        (frame.options.width, frame.options.height) = target.size()?;
    }
    render(env, handle, &frame, (&progress, &preview), &mut target)
}

#[cfg(target_os = "android")]
fn render_surface<'local>(
    env: &mut Env<'local>,
    _class: JClass<'local>,
    handle: jlong,
    frame: JObjectArray<'local, JString<'local>>,
    surface: JObject<'local>,
    progress: JObject<'local>,
    preview: JObject<'local>,
) -> Done<JObject<'local>> {
    let mut frame = settings::frame(&texts(env, &frame)?)?;
    let mut target = crate::android::SurfaceTarget::new(env, &surface)?;
    if !frame.has_size {
        (frame.options.width, frame.options.height) = target.size();
    }
    frame.options.validate()?;
    target.set_size(frame.options.width, frame.options.height)?;
    render(env, handle, &frame, (&progress, &preview), &mut target)
}

#[cfg(not(target_os = "android"))]
use {self::no_target as render_bitmap, self::no_target as render_surface};

#[cfg(not(target_os = "android"))]
fn no_target<'local>(
    _env: &mut Env<'local>,
    _class: JClass<'local>,
    _handle: jlong,
    _frame: JObjectArray<'local, JString<'local>>,
    _target: JObject<'local>,
    _progress: JObject<'local>,
    _preview: JObject<'local>,
) -> Done<JObject<'local>> {
    let text = "there are no Bitmaps and no Surfaces here: this library was built for another system than Android";
    Err(Failure::Target(text.to_owned()))
}

/// A `FrameStats` of a frame.
fn frame_stats<'local>(env: &mut Env<'local>, frame: &Frame) -> Done<JObject<'local>> {
    let stats = &frame.stats;
    let names = strings(env, &Stage::ALL.map(Stage::name))?;
    let stages_ms = env.new_double_array(stats.stages_ms.len())?;
    stages_ms.set_region(env, 0, &stats.stages_ms)?;
    let pixels = &stats.pixels;
    let counts = [pixels.base, pixels.traced, pixels.interpolated, pixels.corrected, u64::from(stats.fell_back)]
        .map(|n| n as i64);
    let mut sums: Vec<i64> = Vec::new();
    if let (Some(rays), Some(work)) = (stats.rays, stats.work) {
        sums.extend([rays.primary, rays.shadow, rays.reflection, rays.refraction].map(|n| n as i64));
        sums.extend([work.traversal_steps, work.triangle_tests, work.shaded_pixels].map(|n| n as i64));
    }
    let count_array = env.new_long_array(counts.len())?;
    count_array.set_region(env, 0, &counts)?;
    let sum_array = env.new_long_array(sums.len())?;
    sum_array.set_region(env, 0, &sums)?;
    let arguments = [
        JValue::Int(frame.width as jint),
        JValue::Int(frame.height as jint),
        JValue::Double(stats.frame_ms),
        JValue::Object(&names),
        JValue::Object(&stages_ms),
        JValue::Object(&count_array),
        JValue::Object(&sum_array),
    ];
    Ok(env.new_object(&loaded_classes()?.frame_stats, &FRAME_STATS.signature, &arguments)?)
}

fn layer<'local>(
    env: &mut Env<'local>,
    _class: JClass<'local>,
    handle: jlong,
    name: JString<'local>,
) -> Done<JObject<'local>> {
    let layer = name.try_to_string(env)?.parse()?;
    let (width, height, pixels) = session::get(handle)?.layer(layer)?;
    let argb = argb_array(env, &pixels)?;
    let arguments = [JValue::Int(width as jint), JValue::Int(height as jint), JValue::Object(&argb)];
    Ok(env.new_object(&loaded_classes()?.picture, &PICTURE.signature, &arguments)?)
}

/// A new array of numbers.
fn floats<'local>(env: &mut Env<'local>, numbers: &[f32]) -> Done<JFloatArray<'local>> {
    let array = env.new_float_array(numbers.len())?;
    array.set_region(env, 0, numbers)?;
    Ok(array)
}

/// The numbers of an array, which come in groups of `N`.
fn groups<const N: usize>(env: &Env<'_>, array: &JFloatArray<'_>) -> Done<Vec<[f32; N]>> {
    let mut numbers = vec![0.0; array.len(env)?];
    array.get_region(env, 0, &mut numbers)?;
    let (groups, []) = numbers.as_chunks::<N>() else {
        return Err(Failure::Argument(format!("{} numbers, which is no multiple of {N}", numbers.len())));
    };
    Ok(groups.to_vec())
}

fn camera<'local>(env: &mut Env<'local>, _class: JClass<'local>, handle: jlong) -> Done<JFloatArray<'local>> {
    let camera = session::get(handle)?.view()?.camera;
    let vectors = [camera.eye, camera.look_at, camera.up].map(|v| v.to_array());
    floats(env, &[&vectors.concat()[..], &[camera.fov_y_degrees]].concat())
}

fn set_camera<'local>(
    env: &mut Env<'local>,
    _class: JClass<'local>,
    handle: jlong,
    camera: JFloatArray<'local>,
) -> Done<()> {
    let groups = groups::<10>(env, &camera)?;
    let [[ex, ey, ez, lx, ly, lz, ux, uy, uz, fov_y_degrees]] = groups[..] else {
        return Err(Failure::Argument("a camera is ten numbers".to_owned()));
    };
    let (eye, look_at, up) = ([ex, ey, ez].into(), [lx, ly, lz].into(), [ux, uy, uz].into());
    session::get(handle)?.change_view(|view| view.camera = Camera { eye, look_at, up, fov_y_degrees })
}

fn lights<'local>(env: &mut Env<'local>, _class: JClass<'local>, handle: jlong) -> Done<JFloatArray<'local>> {
    let lights = session::get(handle)?.view()?.lights;
    let numbers: Vec<f32> =
        lights.iter().flat_map(|light| [light.position.to_array(), light.intensity.to_array()].concat()).collect();
    floats(env, &numbers)
}

fn set_lights<'local>(
    env: &mut Env<'local>,
    _class: JClass<'local>,
    handle: jlong,
    lights: JFloatArray<'local>,
) -> Done<()> {
    let light = |[x, y, z, r, g, b]: [f32; 6]| Light { position: [x, y, z].into(), intensity: [r, g, b].into() };
    let lights: Vec<Light> = groups::<6>(env, &lights)?.into_iter().map(light).collect();
    session::get(handle)?.change_view(|view| view.lights = lights)
}

fn device_info<'local>(env: &mut Env<'local>, _class: JClass<'local>, handle: jlong) -> Done<JObject<'local>> {
    let (info, notices, codes, causes) = session::get(handle)?.device(|renderer| {
        let passed_over = renderer.passed_over();
        let codes: Vec<&str> = passed_over.iter().map(failure::code).collect();
        let causes: Vec<String> = passed_over.iter().map(Error::to_string).collect();
        (renderer.info(), renderer.notices().to_vec(), codes, causes)
    })?;
    let [name, version, backend, profile] = [&info.name, &info.version, info.backend, &info.profile];
    let name = env.new_string(name)?.into();
    let version = env.new_string(version)?.into();
    let backend = env.new_string(backend)?.into();
    let profile = env.new_string(profile)?.into();
    let notices = strings(env, &notices)?;
    let codes = strings(env, &codes)?;
    let causes = strings(env, &causes)?;
    let arguments: [&JObject<'_>; 7] = [&name, &version, &backend, &profile, &notices, &codes, &causes];
    let arguments = arguments.map(JValue::Object);
    Ok(env.new_object(&loaded_classes()?.device_info, &DEVICE_INFO.signature, &arguments)?)
}

fn opencl_report<'local>(
    env: &mut Env<'local>,
    _class: JClass<'local>,
    device: JObjectArray<'local, JString<'local>>,
) -> Done<JObject<'local>> {
    let report = rarefy::devices(&settings::device(&texts(env, &device)?)?);
    let library = match &report.library {
        Some(library) => env.new_string(library)?.into(),
        None => JObject::null(),
    };
    let refused: Vec<String> = report.refused.iter().map(|r| format!("{}: {}", r.path, r.reason)).collect();
    let devices: Vec<String> =
        report.devices.iter().map(|d| format!("{}, {}, {}, {}", d.name, d.version, d.driver, d.platform)).collect();
    let refused = strings(env, &refused)?;
    let devices = strings(env, &devices)?;
    let skipped = strings(env, &report.skipped)?;
    let profiles: Vec<&str> = report.devices.iter().map(|d| d.profile.as_str()).collect();
    let profiles = strings(env, &profiles)?;
    let arguments: [&JObject<'_>; 5] = [&library, &refused, &devices, &skipped, &profiles];
    let arguments = arguments.map(JValue::Object);
    Ok(env.new_object(&loaded_classes()?.opencl_report, &OPENCL_REPORT.signature, &arguments)?)
}
