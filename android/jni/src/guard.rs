// SPDX-License-Identifier: MIT OR Apache-2.0
//! The guard around every native method: an error or a panic becomes a Java exception and never crosses into the Java
//! VM, which would end the process.

use jni::errors::ErrorPolicy;
use jni::strings::{JNIStr, JNIString};
use jni::vm::{AttachConfig, AttachmentExceptionPolicy};
use jni::{DEFAULT_LOCAL_FRAME_CAPACITY, Env, JavaVM, NativeMethod, jni_str};
use std::any::Any;
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Why a native method failed.
#[derive(Debug)]
pub enum Failure {
    /// The Rarefy library refused or failed.
    Rarefy(rarefy::Error),
    /// A call into the Java VM failed.
    Jni(jni::errors::Error),
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Failure::Rarefy(error) => error.fmt(f),
            Failure::Jni(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for Failure {}

impl From<rarefy::Error> for Failure {
    fn from(error: rarefy::Error) -> Self {
        Failure::Rarefy(error)
    }
}

impl From<jni::errors::Error> for Failure {
    fn from(error: jni::errors::Error) -> Self {
        Failure::Jni(error)
    }
}

/// Throws `IllegalStateException` for an error and `java.lang.Error` for a panic, with the whole text of either.
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
        throw(env, jni_str!("java/lang/IllegalStateException"), &failure.to_string());
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

/// Registers `methods` on the Java class `class` (with slashes): the whole work of a `JNI_OnLoad`.
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
            let registered = env.find_class(class).and_then(|class| {
                // SAFETY: the caller vouches for static or not; the macro that made the table vouches for the rest.
                unsafe { env.register_native_methods(&class, methods) }
            });
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
