// SPDX-License-Identifier: MIT OR Apache-2.0
//! Not an example to follow: a library that the desktop tests load beside `librarefy_jni.so`, to see what the guard
//! makes of errors and panics. It is never part of what ships.

#[path = "../src/guard.rs"]
mod guard;

use guard::{Failure, Guard};
use jni::objects::{JClass, JString};
use jni::{Env, NativeMethod, jni_str, native_method};
use std::ffi::c_void;

/// The native methods of `dev.rarefy.GuardProbe`.
const METHODS: &[NativeMethod] = &[
    native_method! { error_policy = Guard, static fn fail(text: JString) -> jint },
    native_method! { error_policy = Guard, static fn panic(text: JString) -> jint },
    native_method! { error_policy = Guard, static fn call_with_exception_pending() -> jint },
];

/// Fails with an error of the Rarefy library.
fn fail<'local>(env: &mut Env<'local>, _class: JClass<'local>, text: JString<'local>) -> Result<i32, Failure> {
    let text = text.try_to_string(env)?;
    Err(rarefy::Error::argument("--probe", text).into())
}

/// Panics with a formatted text.
fn panic<'local>(env: &mut Env<'local>, _class: JClass<'local>, text: JString<'local>) -> Result<i32, Failure> {
    let text = text.try_to_string(env)?;
    panic!("{text}");
}

/// Breaks a rule of JNI, so that a test can see that such a thing would be noticed.
fn call_with_exception_pending<'local>(env: &mut Env<'local>, _class: JClass<'local>) -> Result<i32, Failure> {
    let thrown = env.throw_new(jni_str!("java/lang/IllegalStateException"), jni_str!("pending"));
    let raw = env.get_raw();
    // SAFETY: the pointer is this thread's valid environment and the arguments are a valid class name. The call is
    // forbidden while an exception is pending, which the Java VM checks and survives under -Xcheck:jni.
    let _class = unsafe { ((**raw).v1_1.FindClass)(raw, c"java/lang/String".as_ptr()) };
    thrown?;
    Ok(0)
}

/// Called by the Java VM when the library is loaded.
///
/// # Safety
///
/// For the Java VM alone to call, with its own pointer.
#[unsafe(no_mangle)]
pub unsafe extern "system" fn JNI_OnLoad(vm: *mut jni::sys::JavaVM, _reserved: *mut c_void) -> jni::sys::jint {
    // SAFETY: the Java VM calls this function with its own valid pointer; all methods are static on both sides.
    unsafe { guard::register(vm, jni_str!("dev/rarefy/GuardProbe"), METHODS) }
}
