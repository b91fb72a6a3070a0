// SPDX-License-Identifier: MIT OR Apache-2.0
//! The Java classes that Rust makes objects of or calls, looked up once when the library is loaded.
//!
//! Only in `JNI_OnLoad` does a class look-up see the classes of the app: elsewhere, and on every thread that Rust made, it
//! sees those of the system alone. Whatever Rust needs of a class is asked for here, so that a class that does not fit is
//! refused when the library is loaded.

use std::sync::OnceLock;

use jni::objects::{IntoAuto as _, JClass, JObject};
use jni::refs::Global;
use jni::signature::MethodSignature;
use jni::strings::JNIStr;
use jni::{Env, jni_sig, jni_str};

/// A constructor: its class and what it takes.
pub struct Constructor {
    name: &'static JNIStr,
    /// Its signature.
    pub signature: MethodSignature<'static, 'static>,
}

/// `RayTracerException(String code, String place, String message, Throwable cause)`.
pub const EXCEPTION: Constructor = Constructor {
    name: jni_str!("dev/rarefy/RayTracerException"),
    signature: jni_sig!("(Ljava/lang/String;Ljava/lang/String;Ljava/lang/String;Ljava/lang/Throwable;)V"),
};

/// `FrameStats(int width, int height, double frameMs, String[] stages, double[] stagesMs, long[] counts, long[] sums)`.
pub const FRAME_STATS: Constructor =
    Constructor { name: jni_str!("dev/rarefy/FrameStats"), signature: jni_sig!("(IID[Ljava/lang/String;[D[J[J)V") };

/// `DeviceInfo(String name, String version, String backend, String profile, String[] notices, String[] codes, String[] causes)`.
pub const DEVICE_INFO: Constructor = Constructor {
    name: jni_str!("dev/rarefy/DeviceInfo"),
    signature: jni_sig!(
        "(Ljava/lang/String;Ljava/lang/String;Ljava/lang/String;Ljava/lang/String;[Ljava/lang/String;[Ljava/lang/String;[Ljava/lang/String;)V"
    ),
};

/// `OpenClReport(String library, String[] refused, String[] devices, String[] skipped, String[] profiles)`.
pub const OPENCL_REPORT: Constructor = Constructor {
    name: jni_str!("dev/rarefy/OpenClReport"),
    signature: jni_sig!(
        "(Ljava/lang/String;[Ljava/lang/String;[Ljava/lang/String;[Ljava/lang/String;[Ljava/lang/String;)V"
    ),
};

/// `Picture(int width, int height, int[] argb)`.
pub const PICTURE: Constructor = Constructor { name: jni_str!("dev/rarefy/Picture"), signature: jni_sig!("(II[I)V") };

/// A method: its class or interface, its name, and what it takes and gives.
pub struct Method {
    class: &'static JNIStr,
    /// Its name.
    pub name: &'static JNIStr,
    /// Its signature.
    pub signature: MethodSignature<'static, 'static>,
    is_static: bool,
}

/// `ProgressListener.onProgress(String phase, float share)`.
pub const ON_PROGRESS: Method = Method {
    class: jni_str!("dev/rarefy/ProgressListener"),
    name: jni_str!("onProgress"),
    signature: jni_sig!("(Ljava/lang/String;F)V"),
    is_static: false,
};

/// `PreviewListener.onPreview(int width, int height, int firstRow, int[] argb)`.
pub const ON_PREVIEW: Method = Method {
    class: jni_str!("dev/rarefy/PreviewListener"),
    name: jni_str!("onPreview"),
    signature: jni_sig!("(III[I)V"),
    is_static: false,
};

/// `Native.readAsset(AssetReader reader, String name)`, which gives the bytes or null.
pub const READ_ASSET: Method = Method {
    class: jni_str!("dev/rarefy/Native"),
    name: jni_str!("readAsset"),
    signature: jni_sig!("(Ldev/rarefy/AssetReader;Ljava/lang/String;)[B"),
    is_static: true,
};

/// The classes, kept for the life of the process.
pub struct Classes {
    /// `RayTracerException`.
    pub exception: Global<JClass<'static>>,
    /// `FrameStats`.
    pub frame_stats: Global<JClass<'static>>,
    /// `DeviceInfo`.
    pub device_info: Global<JClass<'static>>,
    /// `OpenClReport`.
    pub opencl_report: Global<JClass<'static>>,
    /// `Picture`.
    pub picture: Global<JClass<'static>>,
    /// `Native`.
    pub native: Global<JClass<'static>>,
}

static CLASSES: OnceLock<Classes> = OnceLock::new();

/// Looks all of them up; for `JNI_OnLoad`.
///
/// # Errors
/// A class, constructor or method that is not there.
pub fn load(env: &mut Env<'_>) -> jni::errors::Result<()> {
    let classes = Classes {
        exception: constructed(env, &EXCEPTION)?,
        frame_stats: constructed(env, &FRAME_STATS)?,
        device_info: constructed(env, &DEVICE_INFO)?,
        opencl_report: constructed(env, &OPENCL_REPORT)?,
        picture: constructed(env, &PICTURE)?,
        native: called(env, &READ_ASSET)?,
    };
    called(env, &ON_PROGRESS)?;
    called(env, &ON_PREVIEW)?;
    // A second load in one process would be by another class loader, which Java refuses.
    let _ = CLASSES.set(classes);
    Ok(())
}

/// The classes; `None` before the library was loaded.
pub fn get() -> Option<&'static Classes> {
    CLASSES.get()
}

fn constructed(env: &mut Env<'_>, constructor: &Constructor) -> jni::errors::Result<Global<JClass<'static>>> {
    let class = env.find_class(constructor.name)?;
    env.get_method_id(&class, jni_str!("<init>"), &constructor.signature)?;
    env.new_global_ref(class)
}

fn called(env: &mut Env<'_>, method: &Method) -> jni::errors::Result<Global<JClass<'static>>> {
    let class = env.find_class(method.class)?;
    if method.is_static {
        env.get_static_method_id(&class, method.name, &method.signature)?;
    } else {
        env.get_method_id(&class, method.name, &method.signature)?;
    }
    env.new_global_ref(class)
}

/// An array of strings.
///
/// # Errors
/// No memory in the Java VM.
pub fn strings<'local, S: AsRef<str>>(env: &mut Env<'local>, texts: &[S]) -> jni::errors::Result<JObject<'local>> {
    let array = env.new_object_array(texts.len() as jni::sys::jsize, jni_str!("java/lang/String"), JObject::null())?;
    for (at, text) in texts.iter().enumerate() {
        let text = JObject::from(env.new_string(text)?).auto();
        array.set_element(env, at, &text)?;
    }
    Ok(array.into())
}
