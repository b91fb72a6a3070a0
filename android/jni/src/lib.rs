// SPDX-License-Identifier: MIT OR Apache-2.0
//! The JNI library: a thin bridge from the Java package `dev.rarefy` to the Rarefy library.
//!
//! `JNI_OnLoad` is the only exported symbol. It registers every native method of `dev.rarefy.Native` by name and
//! signature, and looks up every class that Rust uses, so that Java classes that do not fit are refused when the library
//! is loaded, not at some later call.

#[cfg(target_os = "android")]
mod android;
mod classes;
mod failure;
mod guard;
mod listeners;
mod natives;
mod picture;
mod session;
mod settings;

use std::ffi::c_void;

use jni::jni_str;

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
    unsafe { guard::register(vm, jni_str!("dev/rarefy/Native"), natives::METHODS) }
}
