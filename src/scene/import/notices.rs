// SPDX-License-Identifier: MIT OR Apache-2.0
//! Warnings of which only the first few of a kind are kept: a file may give cause for millions.

/// Sentences of a kind that are kept.
pub(super) const MOST_TOLD: usize = 50;

/// Sentences of one kind.
#[derive(Debug, Default)]
pub(super) struct Notices {
    told: Vec<String>,
    more: usize,
}

impl Notices {
    /// Keeps a sentence, or counts it.
    pub(super) fn push(&mut self, sentence: String) {
        if self.told.len() < MOST_TOLD {
            self.told.push(sentence);
        } else {
            self.more += 1;
        }
    }

    /// Counts what `sentences` has beyond the first few, not counting those that were there `before`, and leaves those.
    pub(super) fn shorten(&mut self, sentences: &mut Vec<String>, before: usize) {
        let most = before + MOST_TOLD;
        self.more += sentences.len().saturating_sub(most);
        sentences.truncate(most);
    }

    /// What was kept, and a sentence with the number of others before `what_more`.
    pub(super) fn take(&mut self, what_more: &str) -> Vec<String> {
        if self.more > 0 {
            self.told.push(format!("{} {what_more}", self.more));
        }
        self.more = 0;
        std::mem::take(&mut self.told)
    }
}
