// SPDX-License-Identifier: MIT OR Apache-2.0
//! Build flavours: which variants of the kernels there are, and the options that make them.

use super::constants::{
    FAR_AWAY, LITTLE_OWN_LIGHT, NO_OBJECT, OFFSET_ERROR, OFFSET_MOST, PLANE_ERROR, SHADOW_REACH, SHARED_CONSTANTS,
    SRGB_LEAST, WEIGHT_CUTOFF,
};
use crate::names::named;

/// How a ray remembers the way through the kd-tree. All ways come to the same leaves in the same order, so that hits and
/// triangle tests are the same; only the number of steps differs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Traversal {
    /// An indexed array in private memory: right for CPUs.
    #[default]
    PrivateStack,
    /// [`SHORT_STACK_ENTRIES`] entries in registers, then a restart: for GPUs where indexed private arrays spill to memory.
    ShortStack,
    /// No entries at all: a restart for every cell.
    Stackless,
}

// As in profiles.
named!(Traversal of Traversal { PrivateStack = "private-stack", ShortStack = "short-stack", Stackless = "stackless" });

impl Traversal {
    /// Entries of the short stack; `None` for the private stack.
    pub fn short_stack_entries(self) -> Option<u32> {
        match self {
            Traversal::PrivateStack => None,
            Traversal::ShortStack => Some(SHORT_STACK_ENTRIES),
            Traversal::Stackless => Some(0),
        }
    }
}

/// Entries of a short stack, which kernels hold in scalars of that number.
pub const SHORT_STACK_ENTRIES: u32 = 4;

/// Which flavour of the kernels is built.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct BuildFlavour {
    /// Bit for bit like the CPU twin: correctly rounded division and square root, where the device has a choice.
    pub strict: bool,
    /// Keep per-pixel work counters.
    pub count: bool,
    /// Shade by the rules of the speed anchor.
    pub anchor: bool,
    /// How rays walk through the kd-tree.
    pub traversal: Traversal,
}

/// The build options that make kernels of a flavour. The wrapper adds the language version and `-Werror`, and for strict
/// kernels the option that a device may have for correct rounding.
pub fn build_options(flavour: BuildFlavour) -> String {
    use std::fmt::Write;
    let mut options = String::new();
    for (name, value) in SHARED_CONSTANTS.iter().chain(&[("NO_OBJECT", NO_OBJECT)]) {
        // Writing to a String cannot fail.
        let _ = write!(options, "-D{name}={value}u ");
    }
    for (name, value) in [
        ("FAR_AWAY", FAR_AWAY),
        ("WEIGHT_CUTOFF", WEIGHT_CUTOFF),
        ("LITTLE_OWN_LIGHT", LITTLE_OWN_LIGHT),
        ("PLANE_ERROR", PLANE_ERROR),
        ("OFFSET_ERROR", OFFSET_ERROR),
        ("OFFSET_MOST", OFFSET_MOST),
        ("SHADOW_REACH", SHADOW_REACH),
        ("SRGB_LEAST", SRGB_LEAST),
    ] {
        let _ = write!(options, "-D{name}={value:?}f ");
    }
    for (on, name) in [(flavour.count, "RAREFY_COUNT"), (flavour.anchor, "RAREFY_ANCHOR")] {
        if on {
            let _ = write!(options, "-D{name}=1 ");
        }
    }
    if let Some(entries) = flavour.traversal.short_stack_entries() {
        let _ = write!(options, "-DRAREFY_SHORT_STACK={entries} ");
    }
    options.truncate(options.trim_end().len());
    options
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn options_name_every_constant_once() {
        let options = build_options(BuildFlavour::default());
        assert_eq!(options.matches("-DPLANE_CLAIM=11u").count(), 1);
        assert!(!options.contains("RAREFY_COUNT"));
        assert!(!options.contains("RAREFY_SHORT_STACK"));
        let mut names: Vec<&str> = SHARED_CONSTANTS.iter().map(|(name, _)| *name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), SHARED_CONSTANTS.len());
    }

    #[test]
    fn traversals_have_their_words_and_options() {
        assert!(
            "deep".parse::<Traversal>().unwrap_err().to_string().contains("private-stack, short-stack or stackless")
        );
        let options = |traversal| build_options(BuildFlavour { traversal, ..BuildFlavour::default() });
        assert!(options(Traversal::ShortStack).ends_with(" -DRAREFY_SHORT_STACK=4"));
        assert!(options(Traversal::Stackless).ends_with(" -DRAREFY_SHORT_STACK=0"));
    }
}
