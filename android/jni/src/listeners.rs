// SPDX-License-Identifier: MIT OR Apache-2.0
//! An app's listeners behind a `Monitor`, and its `AssetReader` behind a `FileSource`.

use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

use jni::objects::{JByteArray, JIntArray, JObject, JThrowable};
use jni::refs::Global;
use jni::vm::{AttachConfig, AttachmentExceptionPolicy};
use jni::{Env, JValue, JavaVM, jni_str};
use rarefy::model::FileSource;
use rarefy::{Cancel, Error, Event, Monitor};

use crate::classes::{self, ON_PREVIEW, ON_PROGRESS, READ_ASSET};
use crate::failure::Failure;
use crate::session::within_listener;

/// Local references that a call of a listener may need.
const LISTENER_FRAME: usize = 8;

/// The listeners of one call. A listener may be called from any thread, also from those that Rust made.
#[derive(Clone)]
pub struct Listeners(Arc<Heard>);

struct Heard {
    progress: Option<Global<JObject<'static>>>,
    preview: Option<Global<JObject<'static>>>,
    cancel: Cancel,
    /// What a listener threw first.
    thrown: Mutex<Option<Global<JThrowable<'static>>>>,
}

impl Listeners {
    /// Listeners of Java, each of which may be null.
    ///
    /// # Errors
    /// No memory in the Java VM.
    pub fn new(env: &Env<'_>, progress: &JObject<'_>, preview: &JObject<'_>) -> Result<Self, Failure> {
        let kept = |listener: &JObject<'_>| match listener.is_null() {
            true => Ok(None),
            false => env.new_global_ref(listener).map(Some),
        };
        Ok(Listeners(Arc::new(Heard {
            progress: kept(progress)?,
            preview: kept(preview)?,
            cancel: Cancel::default(),
            thrown: Mutex::default(),
        })))
    }

    /// A monitor that tells them, with a token of its own.
    pub fn monitor(&self) -> Monitor {
        let heard = Arc::clone(&self.0);
        let tell = move |event: Event<'_>| heard.tell(event);
        let monitor = match (&self.0.progress, &self.0.preview) {
            (None, None) => Monitor::default(),
            (_, None) => Monitor::new(tell),
            _ => Monitor::with_previews(tell),
        };
        monitor.with_cancel(&self.0.cancel)
    }

    /// Throws what a listener threw, in the thread of the call that it watched; else gives back `result`.
    ///
    /// # Errors
    /// `result`'s own; an exception that is pending.
    pub fn rethrow<T>(&self, env: &mut Env<'_>, result: Result<T, Failure>) -> Result<T, Failure> {
        let thrown = self.0.thrown.lock().unwrap_or_else(PoisonError::into_inner).take();
        match thrown {
            Some(thrown) => Err(env.throw(&thrown).err().unwrap_or(jni::errors::Error::JavaException).into()),
            None => result,
        }
    }
}

impl Heard {
    fn tell(&self, event: Event<'_>) {
        if self.thrown.lock().unwrap_or_else(PoisonError::into_inner).is_some() {
            return;
        }
        // Scoped: a Java VM waits for attached threads before it ends, and those of a thread pool never end.
        let config = || {
            AttachConfig::new()
                .scoped(true)
                .thread_name(jni_str!("rarefy"))
                .exceptions_policy(AttachmentExceptionPolicy::Ignore)
        };
        let told = JavaVM::singleton().and_then(|vm| {
            vm.attach_current_thread_with_config(config, Some(LISTENER_FRAME), |env| {
                let told = within_listener(|| self.call(env, event));
                if let Some(thrown) = env.exception_occurred() {
                    env.exception_clear();
                    let thrown = env.new_global_ref(thrown)?;
                    self.thrown.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(thrown);
                    self.cancel.cancel();
                    return Ok(());
                }
                told
            })
        });
        if let Err(error) = told {
            log::error!("a listener could not be called: {error}");
        }
    }

    fn call(&self, env: &mut Env<'_>, event: Event<'_>) -> jni::errors::Result<()> {
        match (event, &self.progress, &self.preview) {
            (Event::Progress { phase, share }, Some(listener), _) => {
                let phase = JObject::from(env.new_string(phase)?);
                let arguments = [JValue::Object(&phase), JValue::Float(share)];
                env.call_method(listener, ON_PROGRESS.name, &ON_PROGRESS.signature, &arguments)?;
            }
            (Event::Preview(preview), _, Some(listener)) => {
                let argb = JObject::from(argb_array(env, preview.pixels)?);
                let arguments = [
                    JValue::Int(preview.width as i32),
                    JValue::Int(preview.height as i32),
                    JValue::Int(preview.first_row as i32),
                    JValue::Object(&argb),
                ];
                env.call_method(listener, ON_PREVIEW.name, &ON_PREVIEW.signature, &arguments)?;
            }
            _ => {}
        }
        Ok(())
    }
}

/// Pixels as Android's colour integers: alpha in the highest byte, then red, green, blue.
///
/// # Errors
/// No memory in the Java VM.
pub fn argb_array<'local>(env: &mut Env<'local>, pixels: &[u32]) -> jni::errors::Result<JIntArray<'local>> {
    let array = env.new_int_array(pixels.len())?;
    let mut part = [0i32; 1024];
    for (at, pixels) in pixels.chunks(part.len()).enumerate() {
        let argb = &mut part[..pixels.len()];
        for (to, from) in argb.iter_mut().zip(pixels) {
            let [red, green, blue, alpha] = from.to_le_bytes();
            *to = i32::from_be_bytes([alpha, red, green, blue]);
        }
        array.set_region(env, (at * 1024) as jni::sys::jsize, argb)?;
    }
    Ok(array)
}

/// The files of a scene, opened by an app's `AssetReader`.
pub struct Assets<'a, 'local, 'reader> {
    env: std::cell::RefCell<&'a mut Env<'local>>,
    reader: &'a JObject<'reader>,
    thrown: std::cell::RefCell<Option<(String, Global<JThrowable<'static>>)>>,
}

impl<'a, 'local, 'reader> Assets<'a, 'local, 'reader> {
    /// The files that `reader` opens, on this thread.
    pub fn new(env: &'a mut Env<'local>, reader: &'a JObject<'reader>) -> Self {
        Assets { env: env.into(), reader, thrown: None.into() }
    }

    /// What went wrong: what the app's code threw, if it did, else `error`.
    pub fn failure(&self, error: Error) -> Failure {
        match self.thrown.borrow_mut().take() {
            Some((name, cause)) => Failure::Asset { name, cause },
            None => error.into(),
        }
    }

    fn bytes(&self, env: &mut Env<'_>, name: &str) -> jni::errors::Result<Option<Vec<u8>>> {
        let Some(classes) = classes::get() else { return Err(jni::errors::Error::UninitializedJavaVM) };
        let text = JObject::from(env.new_string(name)?);
        let arguments = [JValue::Object(self.reader), JValue::Object(&text)];
        let call = within_listener(|| {
            env.call_static_method(&classes.native, READ_ASSET.name, &READ_ASSET.signature, &arguments)
        });
        let bytes = call?.l()?;
        match bytes.is_null() {
            true => Ok(None),
            false => {
                let bytes = env.cast_local::<JByteArray<'_>>(bytes)?;
                env.convert_byte_array(&bytes).map(Some)
            }
        }
    }
}

impl FileSource for Assets<'_, '_, '_> {
    fn read(&self, name: &str) -> rarefy::Result<Option<Vec<u8>>> {
        let env = self.env.borrow_mut();
        let read = env.with_local_frame(LISTENER_FRAME, |env| {
            self.bytes(env, name).inspect_err(|_| {
                if let Some(thrown) = env.exception_occurred() {
                    env.exception_clear();
                    if let Ok(thrown) = env.new_global_ref(thrown) {
                        *self.thrown.borrow_mut() = Some((name.to_owned(), thrown));
                    }
                }
            })
        });
        read.map_err(|error| Error::io(Path::new(name), std::io::Error::other(error.to_string())))
    }
}
