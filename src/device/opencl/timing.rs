// SPDX-License-Identifier: MIT OR Apache-2.0
//! Events of launches: what each stage took, what failed on the device, and what the slice planner learns.

use std::collections::VecDeque;

use opencl3::event::{
    CL_EVENT_COMMAND_EXECUTION_STATUS, CL_PROFILING_COMMAND_END, CL_PROFILING_COMMAND_START, get_event_data,
    get_event_profiling_data, wait_for_events,
};

use super::codes;
use super::handle::Handle;
use super::slices::Planner;
use crate::error::Remedy;
use crate::{Error, Result};

/// One launch whose event was not yet read.
struct Pending {
    label: &'static str,
    event: Handle,
    items: u64,
    /// Whether the planner could have made it shorter.
    divisible: bool,
    expected_ms: f64,
}

/// How long to wait for launches in flight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Wait {
    /// Not at all.
    No,
    /// Until the others are expected to take no longer than this, in milliseconds.
    UntilBelow(f64),
    /// For all of them.
    ForAll,
}

/// The launches in flight and the sums of those that ended.
pub(super) struct Timing {
    pending: VecDeque<Pending>,
    /// What all of `pending` are expected to take, in milliseconds.
    pending_ms: f64,
    sums: Vec<(&'static str, f64)>,
    /// The stages that were measured before.
    known: Vec<&'static str>,
    /// An enqueue beyond this would be killed on the phone, in milliseconds.
    watchdog_ms: Option<u64>,
    failure: Option<Error>,
}

impl Timing {
    pub fn new(watchdog_ms: Option<u64>) -> Self {
        Timing {
            pending: VecDeque::new(),
            pending_ms: 0.0,
            sums: Vec::new(),
            known: Vec::new(),
            watchdog_ms,
            failure: None,
        }
    }

    /// Takes the event of an enqueued launch.
    pub fn push(&mut self, label: &'static str, event: Handle, items: u64, divisible: bool, expected_ms: f64) {
        self.pending.push_back(Pending { label, event, items, divisible, expected_ms });
        self.pending_ms += expected_ms;
    }

    /// Reads the events of launches that ended, and waits for some or all of the others. A launch that failed on the
    /// device is an error here, once.
    pub fn harvest(&mut self, planner: &mut Planner, wait: Wait) -> Result<()> {
        while let Some(first) = self.pending.front() {
            let mut status = status(&first.event);
            let wait = match wait {
                Wait::No => false,
                Wait::UntilBelow(ms) => self.pending_ms > ms,
                Wait::ForAll => true,
            };
            if wait && matches!(status, Ok(status) if status > 0) {
                // A failing wait means a failed command: its status, asked again, has the code.
                let waited = wait_for_events(&[first.event.raw()]);
                status = self::status(&first.event).and_then(|status| match waited {
                    Err(code) if status > 0 => Err(code),
                    _ => Ok(status),
                });
            }
            match status {
                Ok(status) if status > 0 => break,
                Ok(0) => self.read_first(planner),
                Ok(code) | Err(code) => {
                    let call = format!("running `{}`", first.label);
                    self.failure.get_or_insert_with(|| codes::error(call, code));
                    self.pop_first();
                }
            }
        }
        self.failure.take().map_or(Ok(()), Err)
    }

    fn pop_first(&mut self) -> Option<Pending> {
        let first = self.pending.pop_front();
        let rest = self.pending_ms - first.as_ref().map_or(0.0, |first| first.expected_ms);
        // What is left of many sums and differences is not nothing.
        self.pending_ms = if self.pending.is_empty() { 0.0 } else { rest };
        first
    }

    fn read_first(&mut self, planner: &mut Planner) {
        let Some(done) = self.pop_first() else { return };
        let time = |name| number(get_event_profiling_data(done.event.raw(), name).ok()?);
        // Some drivers answer no times at all; the picture does not depend on them.
        let (Some(start), Some(end)) = (time(CL_PROFILING_COMMAND_START), time(CL_PROFILING_COMMAND_END)) else {
            return;
        };
        let ms = end.saturating_sub(start) as f64 * 1e-6;
        planner.learn(done.label, done.items, ms);
        // The first run of a stage may include compilation at launch, as in PoCL, so it is not judged.
        let first = !self.known.contains(&done.label);
        if first {
            self.known.push(done.label);
        }
        if let Some(allowed) = self.watchdog_ms.filter(|&allowed| ms > allowed as f64 && !first) {
            if done.divisible {
                self.failure.get_or_insert_with(|| Error::LimitExceeded {
                    what: format!("an enqueue of `{}` of {} work-items", done.label, done.items),
                    limit: "gpu_batch_timeout_ms of the profile".into(),
                    wanted: format!("{ms:.0} ms"),
                    allowed: format!("{allowed} ms"),
                    remedies: &[Remedy::ShorterSlices],
                });
            } else {
                log::warn!("one work-group of `{}` took {ms:.0} ms: the phone would kill it", done.label);
            }
        }
        match self.sums.iter_mut().find(|(label, _)| *label == done.label) {
            Some((_, sum)) => *sum += ms,
            None => self.sums.push((done.label, ms)),
        }
    }

    /// The sums since the last call, in the order of first use.
    pub fn take(&mut self) -> Vec<(&'static str, f64)> {
        std::mem::take(&mut self.sums)
    }
}

/// The execution status: above 0 running, 0 done, below 0 failed.
fn status(event: &Handle) -> std::result::Result<i32, i32> {
    let bytes = get_event_data(event.raw(), CL_EVENT_COMMAND_EXECUTION_STATUS)?;
    <[u8; 4]>::try_from(bytes.as_slice()).map(i32::from_ne_bytes).map_err(|_| codes::INVALID_VALUE)
}

fn number(bytes: Vec<u8>) -> Option<u64> {
    <[u8; 8]>::try_from(bytes.as_slice()).ok().map(u64::from_ne_bytes)
}
