// SPDX-License-Identifier: MIT OR Apache-2.0
//! Devices that are lost on purpose, for tests.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex};

use super::context::lock;

/// When a device is to be lost: an enqueue fails with a status, as on a phone whose watchdog struck, and then nothing
/// made on that context works any more. Clones share their plan; a device that is opened again goes on with it.
#[derive(Debug, Clone, Default)]
pub struct Faults(Arc<Mutex<VecDeque<(u64, i32)>>>);

impl Faults {
    /// Plans a fault: after `enqueues` more that go well, counted from the fault that was planned before this one, else
    /// from now, an enqueue fails with `code`.
    pub fn after(&self, enqueues: u64, code: i32) {
        lock(&self.0).push_back((enqueues, code));
    }

    /// How many planned faults have not struck yet.
    pub fn left(&self) -> usize {
        lock(&self.0).len()
    }

    /// Counts an enqueue; the status that it fails with.
    pub(super) fn strike(&self) -> Option<i32> {
        let mut plan = lock(&self.0);
        let (enqueues, _) = plan.front_mut()?;
        if *enqueues > 0 {
            *enqueues -= 1;
            return None;
        }
        plan.pop_front().map(|(_, code)| code)
    }
}

#[cfg(test)]
mod tests {
    use super::Faults;

    #[test]
    fn faults_strike_when_they_are_due_and_once() {
        let faults = Faults::default();
        faults.after(2, -5);
        faults.clone().after(0, -36);
        let struck: Vec<_> = (0..5).map(|_| faults.strike()).collect();
        assert_eq!(struck, [None, None, Some(-5), Some(-36), None]);
        assert_eq!(faults.left(), 0);
    }
}
