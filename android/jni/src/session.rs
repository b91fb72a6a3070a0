// SPDX-License-Identifier: MIT OR Apache-2.0
//! What lies behind a `RayTracer`: a renderer that one call at a time works with, and handles that survive misuse.
//!
//! A handle is a number that is never given out twice, not an address: whoever closes twice, or uses a tracer after it was
//! closed, from any thread, finds nothing and is told so.

use std::cell::Cell;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicI64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use rarefy::{
    Cancel, DeviceOptions, Frame, Keep, Layer, Monitor, PreparedScene, RenderOptions, Renderer, View, draw_layer,
};

use crate::failure::Failure;

static SESSIONS: Mutex<BTreeMap<i64, Arc<Session>>> = Mutex::new(BTreeMap::new());
static NEXT: AtomicI64 = AtomicI64::new(1);

thread_local! {
    /// Whether this thread is within a listener of the app.
    static LISTENING: Cell<bool> = const { Cell::new(false) };
}

/// One tracer.
#[derive(Default)]
pub struct Session {
    /// Held while a call loads, draws, reads a layer or closes.
    work: Mutex<Work>,
    /// What can be asked and changed meanwhile; held for moments.
    state: Mutex<State>,
}

#[derive(Default)]
enum Work {
    /// Nothing is loaded yet, or loading failed.
    #[default]
    Empty,
    /// A scene on a device.
    Ready(Box<Loaded>),
    /// Closed, or broken by a panic.
    Closed,
}

struct Loaded {
    renderer: Renderer,
    /// Size in samples of the frame drawn last.
    drawn: Option<(u32, u32)>,
}

#[derive(Default)]
struct State {
    closed: bool,
    view: Option<View>,
    /// Tokens of the calls that have begun, each under a number of its own.
    running: BTreeMap<u64, Cancel>,
    calls: u64,
}

/// A poisoned lock is one that a panic left. What the registry and a state hold is whole all the same, for every change
/// is a single step; a renderer is not, and [`Session::begin`] looks.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A new tracer's handle.
pub fn create() -> i64 {
    let handle = NEXT.fetch_add(1, Ordering::Relaxed);
    lock(&SESSIONS).insert(handle, Arc::default());
    handle
}

/// The tracer of a handle.
///
/// # Errors
/// A handle that was closed, or that was never given out.
pub fn get(handle: i64) -> Result<Arc<Session>, Failure> {
    lock(&SESSIONS).get(&handle).cloned().ok_or_else(Failure::closed)
}

/// How many tracers are open.
pub fn count() -> usize {
    lock(&SESSIONS).len()
}

/// Closes a tracer: cancels what it does and waits for its end, except within a listener, whose work cannot end before the
/// listener does. Does nothing to one that is closed.
pub fn close(handle: i64) {
    let Some(session) = lock(&SESSIONS).remove(&handle) else { return };
    lock(&session.state).closed = true;
    session.cancel();
    if !LISTENING.get() {
        let work = std::mem::replace(&mut *lock(&session.work), Work::Closed);
        drop(work);
    }
}

/// Forgets a tracer that nobody can reach any more. A call that still runs, whose Java object the collector did not wait
/// for, comes to its end first.
pub fn release(handle: i64) {
    let session = lock(&SESSIONS).remove(&handle);
    drop(session);
}

/// Runs an app's listener on this thread.
pub fn within_listener<T>(call: impl FnOnce() -> T) -> T {
    struct Leave(bool);
    impl Drop for Leave {
        fn drop(&mut self) {
            LISTENING.set(self.0);
        }
    }
    let _leave = Leave(LISTENING.replace(true));
    call()
}

/// A call that has begun and can be cancelled.
struct Call<'a> {
    session: &'a Session,
    number: u64,
}

impl Drop for Call<'_> {
    fn drop(&mut self) {
        lock(&self.session.state).running.remove(&self.number);
    }
}

impl Session {
    /// Ends every call of this tracer that has begun.
    pub fn cancel(&self) {
        for cancel in lock(&self.state).running.values() {
            cancel.cancel();
        }
    }

    /// Notes that a call begins, so that it can be cancelled even while it waits for its turn.
    fn call(&self, cancel: &Cancel) -> Call<'_> {
        let mut state = lock(&self.state);
        state.calls += 1;
        let number = state.calls;
        state.running.insert(number, cancel.clone());
        Call { session: self, number }
    }

    /// Waits until no other call works with the renderer.
    fn begin(&self) -> Result<MutexGuard<'_, Work>, Failure> {
        if LISTENING.get() {
            // The work that called the listener waits for it, so that this would never end.
            let text = "a listener may not load, draw or read a layer; do it after the call that the listener watches";
            return Err(Failure::State(text.to_owned()));
        }
        let work = self.work.lock().unwrap_or_else(|poisoned| {
            let mut work = poisoned.into_inner();
            *work = Work::Closed;
            self.work.clear_poison();
            work
        });
        if lock(&self.state).closed {
            return Err(Failure::closed());
        }
        match &*work {
            Work::Closed => Err(Failure::State("an internal error broke this RayTracer; close it".to_owned())),
            _ => Ok(work),
        }
    }

    /// Puts the scene that `scene` prepares on a device, in place of what was loaded before.
    ///
    /// # Errors
    /// What `scene` reports; whatever keeps the device from being opened.
    pub fn load(
        &self,
        monitor: &Monitor,
        device: &DeviceOptions,
        scene: impl FnOnce(&Monitor) -> Result<PreparedScene, Failure>,
    ) -> Result<(), Failure> {
        let _call = self.call(monitor.cancel());
        let mut work = self.begin()?;
        *work = Work::Empty;
        let prepared = scene(monitor)?;
        let mut renderer = Renderer::new(Arc::new(prepared), device, monitor)?;
        // A renderer keeps its monitor, and with it the app's listeners.
        renderer.set_monitor(&Monitor::default());
        lock(&self.state).view = Some(renderer.view().clone());
        *work = Work::Ready(Box::new(Loaded { renderer, drawn: None }));
        Ok(())
    }

    /// Draws a frame and gives it to `take` before another call or a close can come between.
    ///
    /// # Errors
    /// Nothing loaded; as for [`Renderer::render`]; what `take` reports.
    pub fn draw<T>(
        &self,
        monitor: &Monitor,
        options: &RenderOptions,
        keep: Keep,
        take: impl FnOnce(&Frame) -> Result<T, Failure>,
    ) -> Result<T, Failure> {
        let _call = self.call(monitor.cancel());
        let mut work = self.begin()?;
        let loaded = work.loaded()?;
        if let Some(view) = lock(&self.state).view.clone() {
            loaded.renderer.set_view(view)?;
        }
        loaded.renderer.set_monitor(monitor);
        let frame = loaded.renderer.render(options, keep);
        loaded.renderer.set_monitor(&Monitor::default());
        let frame = frame?;
        loaded.drawn = Some(options.sample_size());
        take(&frame)
    }

    /// A picture of what the last frame kept: width, height, and a word a sample.
    ///
    /// # Errors
    /// No frame, or one that did not keep this layer; a failing read.
    pub fn layer(&self, layer: Layer) -> Result<(u32, u32, Vec<u32>), Failure> {
        let mut work = self.begin()?;
        let loaded = work.loaded()?;
        let (width, height) =
            loaded.drawn.ok_or_else(|| Failure::State("no frame was drawn yet, so there are no layers".to_owned()))?;
        // The picture itself is the caller's, and no layer that Java can name needs it.
        let frame = Frame { width, height, pixels: Vec::new(), stats: Default::default() };
        let pixels = draw_layer(layer, &mut loaded.renderer, &frame)?;
        Ok((width, height, pixels))
    }

    /// The view that the next frame is drawn from.
    ///
    /// # Errors
    /// Nothing loaded.
    pub fn view(&self) -> Result<View, Failure> {
        lock(&self.state).view.clone().ok_or_else(nothing_loaded)
    }

    /// Changes the view that the next frame is drawn from; a frame that is being drawn keeps its own.
    ///
    /// # Errors
    /// Nothing loaded; a view that cannot be drawn, and then the old one stays.
    pub fn change_view(&self, change: impl FnOnce(&mut View)) -> Result<(), Failure> {
        let mut state = lock(&self.state);
        let mut view = state.view.clone().ok_or_else(nothing_loaded)?;
        change(&mut view);
        view.validate()?;
        state.view = Some(view);
        Ok(())
    }

    /// The device that draws.
    ///
    /// # Errors
    /// Nothing loaded.
    pub fn device<T>(&self, read: impl FnOnce(&Renderer) -> T) -> Result<T, Failure> {
        let mut work = self.begin()?;
        Ok(read(&work.loaded()?.renderer))
    }
}

impl Work {
    fn loaded(&mut self) -> Result<&mut Loaded, Failure> {
        match self {
            Work::Ready(loaded) => Ok(loaded),
            _ => Err(nothing_loaded()),
        }
    }
}

fn nothing_loaded() -> Failure {
    Failure::State("no scene was loaded, for loading failed".to_owned())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use rarefy::{DeviceChoice, Error, Shading};

    fn wall(session: &Session) {
        let device = DeviceOptions { device: DeviceChoice::Cpu, ..DeviceOptions::default() };
        let wall = |monitor: &Monitor| Ok(PreparedScene::new(&rarefy::builtin("wall")?, Shading::Full, monitor)?);
        session.load(&Monitor::default(), &device, wall).unwrap();
    }

    fn small() -> RenderOptions {
        RenderOptions { width: 8, height: 8, ..RenderOptions::default() }
    }

    #[test]
    fn handles_are_never_given_out_twice_and_closed_ones_find_nothing() {
        let first = create();
        close(first);
        close(first);
        release(first);
        let second = create();
        assert_ne!(first, second);
        for handle in [first, 0, -1, i64::MAX, second + 1000] {
            assert!(matches!(get(handle), Err(Failure::State(text)) if text == crate::failure::CLOSED));
        }
        assert!(get(second).is_ok());
        release(second);
        assert!(get(second).is_err());
    }

    #[test]
    fn closing_cancels_a_frame_and_waits_for_it() {
        let handle = create();
        let session = get(handle).unwrap();
        wall(&session);
        let (began, begun) = std::sync::mpsc::channel();
        let monitor = Monitor::new(move |_| {
            let _ = began.send(());
        });
        let worker = std::thread::spawn(move || {
            let options = RenderOptions { width: 2000, height: 2000, samples: 4, ..RenderOptions::default() };
            session.draw(&monitor, &options, Keep::default(), |_| Ok(()))
        });
        begun.recv().unwrap();
        close(handle);
        let ended = worker.join().unwrap().unwrap_err();
        assert!(matches!(ended, Failure::Rarefy(Error::Cancelled)), "{ended}");
    }

    #[test]
    fn a_listener_may_close_but_not_draw() {
        let handle = create();
        let session = get(handle).unwrap();
        wall(&session);
        let heard = Arc::new(Mutex::new(String::new()));
        let (log, inner) = (Arc::clone(&heard), Arc::clone(&session));
        let monitor = Monitor::new(move |_| {
            within_listener(|| {
                let refused = inner.draw(&Monitor::default(), &small(), Keep::default(), |_| Ok(())).unwrap_err();
                *lock(&log) = refused.to_string();
                close(handle);
            });
        });
        let ended = session.draw(&monitor, &small(), Keep::default(), |_| Ok(()));
        assert!(lock(&heard).contains("listener"));
        // It may have been over before the listener of its last step closed.
        assert!(matches!(ended, Ok(()) | Err(Failure::Rarefy(Error::Cancelled))));
        let again = session.draw(&Monitor::default(), &small(), Keep::default(), |_| Ok(())).unwrap_err();
        assert_eq!(again.to_string(), crate::failure::CLOSED);
    }

    #[test]
    fn a_panic_breaks_its_tracer_and_no_other() {
        let session = Session::default();
        wall(&session);
        let panicked = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
            session
                .draw(&Monitor::default(), &small(), Keep::default(), |_| -> Result<(), Failure> { panic!("broken") })
        }));
        assert!(panicked.is_err());
        for _ in 0..2 {
            let error = session.draw(&Monitor::default(), &small(), Keep::default(), |_| Ok(())).unwrap_err();
            assert!(error.to_string().contains("internal error"), "{error}");
        }
        let other = Session::default();
        wall(&other);
        other.draw(&Monitor::default(), &small(), Keep::default(), |_| Ok(())).unwrap();
    }

    #[test]
    fn nothing_is_drawn_of_nothing_and_a_bad_view_changes_nothing() {
        let session = Session::default();
        assert!(session.draw(&Monitor::default(), &small(), Keep::default(), |_| Ok(())).is_err());
        assert!(session.view().is_err() && session.layer(Layer::Class).is_err());
        wall(&session);
        assert!(session.layer(Layer::Class).unwrap_err().to_string().contains("no frame"));
        let before = session.view().unwrap();
        assert!(session.change_view(|view| view.camera.fov_y_degrees = 200.0).is_err());
        assert_eq!(session.view().unwrap(), before);
        session.change_view(|view| view.camera.fov_y_degrees = 20.0).unwrap();
        assert_eq!(session.view().unwrap().camera.fov_y_degrees, 20.0);
    }
}
