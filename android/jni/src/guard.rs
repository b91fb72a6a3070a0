// SPDX-License-Identifier: MIT OR Apache-2.0
//! The guard around every native method: an error or a panic becomes a Java exception and never crosses into the Java
//! VM, which would end the process.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

use jni::errors::ErrorPolicy;
use jni::objects::{JObject, JThrowable};
use jni::strings::{JNIStr, JNIString};
use jni::vm::{AttachConfig, AttachmentExceptionPolicy};
use jni::{DEFAULT_LOCAL_FRAME_CAPACITY, Env, JValue, JavaVM, NativeMethod, jni_str};

use crate::classes::{self, EXCEPTION};
use crate::failure::{self, Failure};

/// Throws what fits a failure, and `java.lang.Error` for a panic, with the whole text of either: `RayTracerException` for
/// what the library refused, `IllegalStateException` for a closed tracer, `IllegalArgumentException` and
/// `NullPointerException` for arguments. An exception that is pending already stays: it names the cause.
///
/// The policies that `jni` brings lose the text of formatted panics, among them every failed bounds check.
pub struct Guard;

impl<T: Default> ErrorPolicy<T, Failure> for Guard {
    type Captures<'unowned_env_local: 'native_method, 'native_method> = ();

    fn on_error<'unowned_env_local: 'native_method, 'native_method>(
        env: &mut Env<'unowned_env_local>,
        _captures: &mut (),
        failure: Failure,
    ) -> jni::errors::Result<T> {
        if env.exception_check() {
            return Ok(T::default());
        }
        let text = failure.to_string();
        match &failure {
            Failure::Rarefy(error) => {
                throw_coded(env, failure::code(error), failure::place(error).as_deref(), &text, None);
            }
            Failure::Asset { name, cause } => throw_coded(env, "IO", Some(name), &text, Some(cause)),
            Failure::Target(_) => throw_coded(env, "TARGET_LOST", None, &text, None),
            Failure::State(_) => throw(env, jni_str!("java/lang/IllegalStateException"), &text),
            Failure::Argument(_) => throw(env, jni_str!("java/lang/IllegalArgumentException"), &text),
            Failure::Jni(jni::errors::Error::NullPtr(_)) => {
                throw(env, jni_str!("java/lang/NullPointerException"), &text);
            }
            Failure::Jni(_) => throw(env, jni_str!("java/lang/IllegalStateException"), &text),
        }
        Ok(T::default())
    }

    fn on_panic<'unowned_env_local: 'native_method, 'native_method>(
        env: &mut Env<'unowned_env_local>,
        _captures: &mut (),
        payload: Box<dyn Any + Send + 'static>,
    ) -> jni::errors::Result<T> {
        throw(env, jni_str!("java/lang/Error"), &format!("internal error in Rarefy: {}", panic_text(&*payload)));
        Ok(T::default())
    }
}

/// The text of a panic.
fn panic_text(payload: &(dyn Any + Send)) -> &str {
    if let Some(text) = payload.downcast_ref::<&'static str>() {
        text
    } else if let Some(text) = payload.downcast_ref::<String>() {
        text
    } else {
        "a panic without a text"
    }
}

/// Makes a `RayTracerException` pending; where that fails, for want of memory say, an `IllegalStateException`.
fn throw_coded(env: &mut Env<'_>, code: &str, place: Option<&str>, text: &str, cause: Option<&JThrowable<'static>>) {
    let made = (|| {
        let Some(classes) = classes::get() else { return Err(jni::errors::Error::UninitializedJavaVM) };
        let code = JObject::from(env.new_string(code)?);
        let place = place.map_or(Ok(JObject::null()), |place| env.new_string(place).map(JObject::from))?;
        let message = JObject::from(env.new_string(text)?);
        let none = JObject::null();
        let cause: &JObject<'_> = cause.map_or(&none, |cause| cause);
        let arguments =
            [JValue::Object(&code), JValue::Object(&place), JValue::Object(&message), JValue::Object(cause)];
        let exception = env.new_object(&classes.exception, &EXCEPTION.signature, &arguments)?;
        env.cast_local::<JThrowable<'_>>(exception)
    })();
    match made.and_then(|exception| env.throw(exception)) {
        Ok(()) | Err(jni::errors::Error::JavaException) if env.exception_check() => {}
        _ => throw(env, jni_str!("java/lang/IllegalStateException"), text),
    }
}

/// Makes an exception pending, unless one is: the first one names the cause.
fn throw(env: &mut Env<'_>, class: &JNIStr, text: &str) {
    if env.exception_check() {
        return;
    }
    // `Err(JavaException)` is what success looks like here: the exception is pending.
    match env.throw_new(class, JNIString::from(text)) {
        Ok(()) | Err(jni::errors::Error::JavaException) => {}
        Err(error) => log::error!("cannot throw {class:?} ({error}): {text}"),
    }
}

/// Looks up the classes that Rust uses and registers `methods` on the Java class `class` (with slashes): the whole work of
/// a `JNI_OnLoad`.
///
/// Returns the JNI version that the library needs, or `JNI_ERR` with a pending `UnsatisfiedLinkError` that says why.
///
/// # Safety
///
/// `vm` must be the pointer that the Java VM gave to `JNI_OnLoad`. Each method must be static or not as its declaration
/// in `class` is.
pub unsafe fn register(vm: *mut jni::sys::JavaVM, class: &JNIStr, methods: &[NativeMethod]) -> jni::sys::jint {
    let result = catch_unwind(AssertUnwindSafe(|| {
        // SAFETY: the caller passes the Java VM's own pointer.
        let vm = unsafe { JavaVM::from_raw(vm) };
        // The default policy would swallow the exception that is to stay pending.
        let config = || AttachConfig::new().exceptions_policy(AttachmentExceptionPolicy::Ignore);
        vm.attach_current_thread_with_config(config, Some(DEFAULT_LOCAL_FRAME_CAPACITY), |env| {
            let registered = env
                .find_class(class)
                .and_then(|class| {
                    // SAFETY: the caller vouches for static or not; the macro that made the table vouches for the rest.
                    unsafe { env.register_native_methods(&class, methods) }
                })
                .and_then(|()| classes::load(env));
            if let Err(error) = &registered {
                let text = format!("librarefy_jni does not fit the Java class {class}: {error}");
                log::error!("{text}");
                // Without it Java would only say "unsupported JNI version 0xFFFFFFFF".
                throw(env, jni_str!("java/lang/UnsatisfiedLinkError"), &text);
            }
            registered
        })
    }));
    match result {
        Ok(Ok(())) => jni::sys::JNI_VERSION_1_6,
        Ok(Err(_)) => jni::sys::JNI_ERR,
        Err(payload) => {
            log::error!("internal error in Rarefy: {}", panic_text(&*payload));
            jni::sys::JNI_ERR
        }
    }
}
