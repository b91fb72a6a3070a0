// SPDX-License-Identifier: MIT OR Apache-2.0
//! Ctrl-C: the first one cancels long work, which then ends cleanly; a second one, or one outside of such work, ends the
//! process at once. Either way the exit status is 130 and standard error has one line.

use std::process::ExitCode;
use std::sync::{Arc, Mutex, PoisonError};

use rarefy::{Cancel, Result};

use super::output::complain;

/// What a shell reports of a command that Ctrl-C ended: 128 and the number of the signal.
const STATUS: u8 = 130;

/// Where Ctrl-C goes.
pub struct Interrupt {
    /// The work that can be cancelled, if any is under way.
    current: Arc<Mutex<Option<Cancel>>>,
}

impl Interrupt {
    /// Takes Ctrl-C over from the system. Where that is not possible, it ends the process as ever.
    pub fn catch() -> Self {
        let current: Arc<Mutex<Option<Cancel>>> = Arc::default();
        let handled = Arc::clone(&current);
        let caught = ctrlc::set_handler(move || {
            let current = handled.lock().unwrap_or_else(PoisonError::into_inner);
            match current.as_ref().filter(|cancel| !cancel.is_cancelled()) {
                Some(cancel) => cancel.cancel(),
                None => {
                    say();
                    rarefy::internal::device::opencl::markers::withdraw_all();
                    std::process::exit(STATUS.into());
                }
            }
        });
        match caught {
            Ok(()) => keep_from_children(),
            Err(error) => log::warn!("Ctrl-C cannot be caught: {error}"),
        }
        Interrupt { current }
    }

    /// Does `work`, which Ctrl-C cancels.
    pub fn watch<T>(&self, work: impl FnOnce(&Cancel) -> Result<T>) -> Result<T> {
        let cancel = Cancel::default();
        self.set(Some(cancel.clone()));
        // Whatever failed after the cancel failed because of it, or does not matter any more.
        let done = work(&cancel);
        let done = cancel.check().and(done);
        self.set(None);
        done
    }

    fn set(&self, cancel: Option<Cancel>) {
        *self.current.lock().unwrap_or_else(PoisonError::into_inner) = cancel;
    }
}

/// Keeps Ctrl-C, which a terminal sends to every process in the foreground, from compilers and linkers that a driver
/// starts: PoCL ends the whole process when its linker is ended. Threads that are made from here on, and processes that
/// they start, inherit the mask; the handler's own thread, which is there already, still gets the signal.
#[cfg(unix)]
fn keep_from_children() {
    use nix::sys::signal::{SigSet, Signal};
    if let Err(error) = SigSet::from(Signal::SIGINT).thread_block() {
        log::warn!("a driver's compiler may be interrupted: {error}");
    }
}

#[cfg(not(unix))]
fn keep_from_children() {}

/// Says that the command was interrupted; its exit status.
pub fn end() -> ExitCode {
    say();
    ExitCode::from(STATUS)
}

fn say() {
    complain("interrupted");
}
