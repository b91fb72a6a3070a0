// SPDX-License-Identifier: MIT OR Apache-2.0
//! A tally of what a file says and nobody reads: nothing is passed over without a word, and no word is said twice.

use std::path::Path;

use crate::scene::UnusedKey;

/// Most different keys of one file that are told apart; what a binary file takes for keys is without end.
const MOST_KEYS: usize = 64;

/// Longest key that is shown.
const MOST_BYTES: usize = 24;

/// The keys of one file that were not used, in order of first appearance.
#[derive(Debug)]
pub(super) struct Tally {
    file: String,
    keys: Vec<UnusedKey>,
}

impl Tally {
    pub(super) fn new(path: &Path) -> Self {
        Tally { file: path.display().to_string(), keys: Vec::new() }
    }

    /// Counts `key`, as the file writes it, in line `line`. Letter case makes no difference.
    pub(super) fn note(&mut self, key: &[u8], line: usize) {
        let plain = key.len() <= MOST_BYTES && key.iter().all(u8::is_ascii_graphic);
        self.count(std::str::from_utf8(key).ok().filter(|_| plain).unwrap_or("(unreadable)"), line);
    }

    /// Counts something that has no key of its own.
    pub(super) fn count(&mut self, what: &str, line: usize) {
        if let Some(known) = self.keys.iter_mut().find(|k| k.key.eq_ignore_ascii_case(what)) {
            known.count += 1;
            return;
        }
        let key = if self.keys.len() < MOST_KEYS { what } else { "(others)" };
        match self.keys.last_mut() {
            Some(last) if last.key == key => last.count += 1,
            _ => self.keys.push(UnusedKey { file: self.file.clone(), key: key.into(), count: 1, first_line: line }),
        }
    }

    pub(super) fn into_keys(self) -> Vec<UnusedKey> {
        self.keys
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_is_counted_once_in_any_letter_case() {
        let mut tally = Tally::new(Path::new("a.mtl"));
        for (key, line) in [("Ke", 3), ("map_Bump", 4), ("KE", 9), ("\u{1b}[31m", 10)] {
            tally.note(key.as_bytes(), line);
        }
        let keys: Vec<_> = tally.into_keys().into_iter().map(|k| (k.key, k.count, k.first_line)).collect();
        assert_eq!(keys, [("Ke".into(), 2, 3), ("map_Bump".into(), 1, 4), ("(unreadable)".into(), 1, 10)]);
    }

    #[test]
    fn noise_does_not_fill_the_memory() {
        let mut tally = Tally::new(Path::new("a.obj"));
        (0..10_000).for_each(|i| tally.note(format!("k{i}").as_bytes(), i));
        let keys = tally.into_keys();
        assert_eq!(keys.len(), MOST_KEYS + 1);
        assert_eq!(keys.iter().map(|k| k.count).sum::<usize>(), 10_000);
    }
}
