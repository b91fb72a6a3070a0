// SPDX-License-Identifier: MIT OR Apache-2.0
//! How a caller watches long work and ends it: progress, previews, and a token that cancels.
//!
//! Loading a scene, making a renderer and drawing frames take a [`Monitor`]. It reports [`Event`]s; its
//! [`Cancel`] token, kept or shared with another thread, ends the work at any time with [`Error::Cancelled`].
//!
//! ```
//! use rarefy::internal::monitor::{Cancel, Event, Monitor};
//!
//! let cancel = Cancel::default(); // give a clone to whoever may end the work
//! let monitor = Monitor::new(|event| {
//!     if let Event::Progress { phase, share } = event {
//!         println!("{phase}: {:.0} %", 100.0 * share);
//!     }
//! })
//! .with_cancel(&cancel);
//! cancel.cancel();
//! let tree = rarefy::internal::prepare::kdtree::KdTree::build(&[], &[], &Default::default(), &monitor);
//! assert!(matches!(tree, Err(rarefy::Error::Cancelled)));
//! ```

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, TryLockError};

use crate::error::{Error, Result};

/// Ends work from any thread. Clones are one token. A token that was cancelled stays so: new work takes a new one.
#[derive(Debug, Clone, Default)]
pub struct Cancel(Arc<AtomicBool>);

impl Cancel {
    /// Ends the work that watches this token, as soon as it looks.
    pub fn cancel(&self) {
        self.0.store(true, Ordering::Release);
    }

    /// Whether the work is to end.
    pub fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Acquire)
    }

    /// Goes on unless the work is to end.
    ///
    /// # Errors
    /// [`Error::Cancelled`].
    pub fn check(&self) -> Result<()> {
        if self.is_cancelled() { Err(Error::Cancelled) } else { Ok(()) }
    }
}

/// What a monitor reports.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub enum Event<'a> {
    /// How far a call is.
    Progress {
        /// What is being done, such as `kd-tree` or `frame`.
        phase: &'a str,
        /// The share of the call that is done, from 0 to 1; an estimate. Within one call it does not decrease, unless a
        /// lost device makes a frame start again.
        share: f32,
    },
    /// A part of a frame in low resolution, long before the frame is done.
    Preview(Preview<'a>),
}

/// Rows of the picture that the base pixels make: one pixel a block, so a quarter of the samples with blocks of 2. They
/// are the very pixels of the final picture (with one sample a pixel), which fill a block each. A frame that is drawn in
/// bands gives a preview for each band, from the top; any other gives one.
#[derive(Debug, Clone, Copy)]
pub struct Preview<'a> {
    /// Width of the whole preview in pixels.
    pub width: u32,
    /// Height of the whole preview in pixels.
    pub height: u32,
    /// The row of the preview at which `pixels` begin.
    pub first_row: u32,
    /// Whole rows of sRGB words, as in [`crate::render::frame::Frame`].
    pub pixels: &'a [u32],
}

/// Watches work. Clones report to and end the same.
#[derive(Clone, Default)]
pub struct Monitor {
    cancel: Cancel,
    listener: Option<Arc<Listener>>,
    part: Part,
}

/// The callback, and what it was told last.
struct Listener {
    callback: Box<dyn Fn(Event<'_>) + Send + Sync>,
    last: Mutex<LastProgress>,
    previews: bool,
}

#[derive(Default)]
struct LastProgress {
    phase: &'static str,
    share: f32,
}

/// Which part of the whole a monitor reports on.
#[derive(Debug, Clone, Copy)]
struct Part {
    /// Empty: not a part.
    phase: &'static str,
    from: f32,
    to: f32,
}

impl Default for Part {
    fn default() -> Self {
        Part { phase: "", from: 0.0, to: 1.0 }
    }
}

/// Steps of progress below this are not reported.
const LEAST_STEP: f32 = 0.002;

impl Monitor {
    /// A monitor that reports to `callback`, which may be called from any thread; calls do not overlap. It should
    /// return soon, for the work waits. It gets no previews.
    pub fn new(callback: impl Fn(Event<'_>) + Send + Sync + 'static) -> Self {
        Monitor::with_callback(Box::new(callback), false)
    }

    /// As [`Monitor::new`], with previews, which cost reading a frame's colours once more.
    pub fn with_previews(callback: impl Fn(Event<'_>) + Send + Sync + 'static) -> Self {
        Monitor::with_callback(Box::new(callback), true)
    }

    fn with_callback(callback: Box<dyn Fn(Event<'_>) + Send + Sync>, previews: bool) -> Self {
        let listener = Listener { callback, last: Mutex::default(), previews };
        Monitor { listener: Some(Arc::new(listener)), ..Monitor::default() }
    }

    /// The same monitor with this token.
    pub fn with_cancel(self, cancel: &Cancel) -> Self {
        Monitor { cancel: cancel.clone(), ..self }
    }

    /// Its token.
    pub fn cancel(&self) -> &Cancel {
        &self.cancel
    }

    /// Goes on unless the work is to end.
    ///
    /// # Errors
    /// [`Error::Cancelled`].
    pub fn check(&self) -> Result<()> {
        self.cancel.check()
    }

    /// Whether previews are wanted.
    pub fn wants_previews(&self) -> bool {
        self.listener.as_ref().is_some_and(|listener| listener.previews)
    }

    /// A monitor for the part `from` to `to` of this one's work, which does `phase`. A part of a part keeps the phase.
    pub fn part(&self, phase: &'static str, from: f32, to: f32) -> Monitor {
        let own = self.part;
        let phase = if own.phase.is_empty() { phase } else { own.phase };
        let part = Part { phase, from: own.place(from), to: own.place(to) };
        Monitor { part, ..self.clone() }
    }

    /// Begins anew: what is reported next may be less than what was reported last. Does nothing to a part.
    pub(crate) fn restart(&self) {
        if let (Some(listener), "") = (&self.listener, self.part.phase) {
            listener.restart();
        }
    }

    /// Tells that `share` of this part is done.
    pub(crate) fn tell(&self, share: f32) {
        if let Some(listener) = &self.listener {
            listener.tell(self.part.phase, self.part.place(share));
        }
    }

    /// Shows a preview.
    pub(crate) fn show(&self, preview: Preview<'_>) {
        if let Some(listener) = self.listener.as_ref().filter(|listener| listener.previews) {
            listener.show(preview);
        }
    }
}

impl Part {
    fn place(&self, share: f32) -> f32 {
        self.from + (self.to - self.from) * share.clamp(0.0, 1.0)
    }
}

impl Listener {
    /// Calls `callback` unless another call is under way: progress can wait for the next step.
    fn locked(&self, act: impl FnOnce(&mut LastProgress)) {
        match self.last.try_lock() {
            Ok(mut last) => act(&mut last),
            // After a panic of `callback` in another thread: what was reported is as good as before.
            Err(TryLockError::Poisoned(poisoned)) => act(&mut poisoned.into_inner()),
            Err(TryLockError::WouldBlock) => {}
        }
    }

    fn tell(&self, phase: &'static str, share: f32) {
        self.locked(|last| {
            let is_new = last.phase != phase;
            let is_end = share >= 1.0 && last.share < 1.0;
            if is_new || is_end || share >= last.share + LEAST_STEP {
                *last = LastProgress { phase, share: if is_new { share } else { share.max(last.share) } };
                (self.callback)(Event::Progress { phase, share: last.share });
            }
        });
    }

    fn restart(&self) {
        self.locked(|last| *last = LastProgress::default());
    }

    fn show(&self, preview: Preview<'_>) {
        self.locked(|_| (self.callback)(Event::Preview(preview)));
    }
}

impl std::fmt::Debug for Monitor {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Monitor")
            .field("cancel", &self.cancel)
            .field("reports", &self.listener.is_some())
            .field("previews", &self.wants_previews())
            .field("part", &self.part)
            .finish()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    type Heard = Arc<Mutex<Vec<(String, f32)>>>;

    fn listening() -> (Monitor, Heard) {
        let heard = Arc::new(Mutex::new(Vec::new()));
        let log = Arc::clone(&heard);
        let monitor = Monitor::new(move |event| match event {
            Event::Progress { phase, share } => log.lock().unwrap().push((phase.to_owned(), share)),
            Event::Preview(_) => log.lock().unwrap().push(("preview".into(), 0.0)),
        });
        (monitor, heard)
    }

    #[test]
    fn a_token_is_shared_and_stays_cancelled() {
        let cancel = Cancel::default();
        let monitor = Monitor::default().with_cancel(&cancel);
        let part = monitor.part("tree", 0.0, 0.5);
        assert!(part.check().is_ok());
        cancel.clone().cancel();
        assert!(matches!(part.check(), Err(Error::Cancelled)));
        assert!(monitor.cancel().is_cancelled());
        assert!(!Monitor::default().cancel().is_cancelled());
    }

    #[test]
    fn shares_of_parts_are_shares_of_the_whole() {
        let (monitor, heard) = listening();
        let half = monitor.part("tree", 0.5, 1.0);
        half.tell(0.0);
        half.part("root", 0.5, 1.0).tell(0.5);
        half.tell(1.0);
        half.tell(1.0);
        let expected = [("tree", 0.5), ("tree", 0.875), ("tree", 1.0)].map(|(phase, share)| (phase.to_owned(), share));
        assert_eq!(*heard.lock().unwrap(), expected);
    }

    #[test]
    fn shares_do_not_decrease_until_it_begins_anew() {
        let (monitor, heard) = listening();
        let frame = monitor.part("frame", 0.0, 1.0);
        for share in [0.0, 0.5, 0.25, 0.5 + LEAST_STEP / 2.0, 1.0] {
            frame.tell(share);
        }
        frame.restart();
        frame.tell(0.0);
        assert_eq!(heard.lock().unwrap().iter().map(|(_, share)| *share).collect::<Vec<_>>(), [0.0, 0.5, 1.0]);
        monitor.restart();
        frame.tell(0.0);
        assert_eq!(heard.lock().unwrap().len(), 4);
    }

    #[test]
    fn previews_are_shown_to_those_who_want_them() {
        let preview = Preview { width: 1, height: 1, first_row: 0, pixels: &[7] };
        let (monitor, heard) = listening();
        monitor.show(preview);
        assert!(!monitor.wants_previews() && heard.lock().unwrap().is_empty());
        let seen = Arc::new(Mutex::new(Vec::new()));
        let log = Arc::clone(&seen);
        let monitor = Monitor::with_previews(move |event| {
            if let Event::Preview(preview) = event {
                log.lock().unwrap().extend_from_slice(preview.pixels);
            }
        });
        monitor.show(preview);
        assert!(monitor.wants_previews());
        assert_eq!(*seen.lock().unwrap(), [7]);
    }

    #[test]
    fn whoever_hears_may_tell_again() {
        let slot: Arc<Mutex<Option<Monitor>>> = Arc::default();
        let inner = Arc::clone(&slot);
        let monitor = Monitor::new(move |_| {
            let monitor = inner.lock().unwrap().clone();
            monitor.unwrap().part("again", 0.0, 1.0).tell(1.0);
        });
        *slot.lock().unwrap() = Some(monitor.clone());
        monitor.part("frame", 0.0, 1.0).tell(1.0);
    }
}
