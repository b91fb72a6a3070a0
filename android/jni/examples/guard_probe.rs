// SPDX-License-Identifier: MIT OR Apache-2.0
//! Not an example to follow: a library that the desktop tests load beside `librarefy_jni.so`, to see what the guard
//! makes of errors and panics. It is never part of what ships.

#[path = "../src/classes.rs"]
#[allow(dead_code)] // The probe makes nothing but exceptions.
mod classes;
#[path = "../src/failure.rs"]
#[allow(dead_code)]
mod failure;
#[path = "../src/guard.rs"]
mod guard;

use failure::Failure;
use guard::Guard;
use jni::errors::ErrorPolicy;
use jni::objects::{JClass, JString};
use jni::{Env, NativeMethod, jni_sig, jni_str, native_method};
use rarefy::{Error, Setting};
use std::ffi::c_void;

/// The native methods of `dev.rarefy.GuardProbe`.
const METHODS: &[NativeMethod] = &[
    native_method! { error_policy = Guard, static fn fail(text: JString) -> jint },
    native_method! { error_policy = Guard, static fn fail_with(kind: jint) -> jint },
    native_method! { error_policy = Guard, static fn fail_on_rust_thread() -> JString },
    native_method! { error_policy = Guard, static fn panic(text: JString) -> jint },
    native_method! { error_policy = Guard, static fn call_with_exception_pending() -> jint },
];

/// Fails with an error of the Rarefy library.
fn fail<'local>(env: &mut Env<'local>, _class: JClass<'local>, text: JString<'local>) -> Result<i32, Failure> {
    let text = text.try_to_string(env)?;
    Err(Error::argument("--probe", text).into())
}

/// Fails with one error of each kind; returns -1 where there are no more.
fn fail_with<'local>(_env: &mut Env<'local>, _class: JClass<'local>, kind: i32) -> Result<i32, Failure> {
    let text = || "T".to_owned();
    let mut kinds = [
        Error::io("F", std::io::ErrorKind::NotFound.into()),
        Error::Syntax { path: "F".into(), line: 7, message: text() },
        Error::scene("P", "T"),
        Error::Image { path: "F".into(), message: text() },
        Error::option(Setting::TPos, -1, "T"),
        Error::argument("A", "T"),
        Error::profile("P", "T"),
        Error::MissingPlane { plane: "T" },
        Error::LimitExceeded { what: "W".to_owned(), limit: text(), wanted: text(), allowed: text(), remedies: &[] },
        Error::OutOfMemory { what: "W".to_owned(), bytes: 7 },
        Error::NoOpenCl { tried: vec![text()] },
        Error::OpenCl { call: "C".to_owned(), name: text(), code: -5 },
        Error::KernelBuild { program: text(), device: "D".to_owned(), log: text() },
        Error::SelfTest { device: "D".to_owned(), stage: text(), message: text() },
        Error::DriverCrashed { device: "D".to_owned(), work: text() },
        Error::DeviceLost { device: "D".to_owned(), cause: text() },
        Error::Cancelled,
        Error::ForeignHandle { what: "T" },
        Error::LaunchBeyondBuffer { kernel: "T", what: "words", wanted: 2, have: 1 },
    ]
    .into_iter();
    match kinds.nth(usize::try_from(kind).unwrap_or(usize::MAX)) {
        Some(error) => Err(error.into()),
        None => Ok(-1),
    }
}

/// Makes an exception on a thread that Java did not make, where a class look-up sees the system's classes only, and says
/// what it was, and whether the look-up was `lost`.
fn fail_on_rust_thread<'local>(env: &mut Env<'local>, _class: JClass<'local>) -> Result<JString<'local>, Failure> {
    let vm = env.get_java_vm()?;
    let made = std::thread::spawn(move || {
        vm.attach_current_thread_for_scope(|env| -> jni::errors::Result<String> {
            let lost = env.find_class(jni_str!("dev/rarefy/RayTracerException")).is_err();
            env.exception_clear();
            <Guard as ErrorPolicy<i32, Failure>>::on_error(env, &mut (), Error::scene("P", "T").into())?;
            let Some(thrown) = env.exception_occurred() else { return Ok("nothing was thrown".to_owned()) };
            env.exception_clear();
            let text = env.call_method(&thrown, jni_str!("toString"), jni_sig!("()Ljava/lang/String;"), &[])?.l()?;
            let text = env.cast_local::<JString<'_>>(text)?.try_to_string(env)?;
            Ok(format!("{} {text}", if lost { "lost" } else { "found" }))
        })
    })
    .join();
    match made {
        Ok(text) => Ok(env.new_string(text?)?),
        Err(_) => Err(Error::argument("thread", "it panicked").into()),
    }
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
