// SPDX-License-Identifier: MIT OR Apache-2.0
//! The JNI library: a thin bridge from the Java package `dev.rarefy` to the Rarefy library.
//!
//! `JNI_OnLoad` is the only exported symbol. It registers every native method of `dev.rarefy.Native` by name and
//! signature, so a Java class that does not fit is refused when the library is loaded, not at some later call.

mod guard;

use guard::{Failure, Guard};
use jni::objects::{JClass, JString};
use jni::{Env, NativeMethod, jni_str, native_method};
use std::ffi::c_void;

/// The native methods of `dev.rarefy.Native`.
const METHODS: &[NativeMethod] = &[native_method! { error_policy = Guard, static fn version() -> JString }];

/// `Native.version()`: the version of the native library, such as `0.1.0`.
fn version<'local>(env: &mut Env<'local>, _class: JClass<'local>) -> Result<JString<'local>, Failure> {
    Ok(JString::from_str(env, env!("CARGO_PKG_VERSION"))?)
}

/// Called by the Java VM when the library is loaded: registers the native methods.
///
/// Returns the JNI version that the library needs, or `JNI_ERR` with a pending `UnsatisfiedLinkError` that says why.
///
/// # Safety
///
/// For the Java VM alone to call, with its own pointer.
#[unsafe(no_mangle)]
pub unsafe extern "system" fn JNI_OnLoad(vm: *mut jni::sys::JavaVM, _reserved: *mut c_void) -> jni::sys::jint {
    // SAFETY: the Java VM calls this function with its own valid pointer; each function in METHODS is static, as is its
    // declaration in Native.java, and `native_method!` made its signature from the function's types.
    unsafe { guard::register(vm, jni_str!("dev/rarefy/Native"), METHODS) }
}
