// SPDX-License-Identifier: MIT OR Apache-2.0
//! The steps of the method and the kernels that they are made of.
//!
//! A step has one name everywhere: the paper's, the kernel file's, the twin's, the enum variant's, the profiler's.

/// A step of the method (paper, Steps I to III-c, and the post-correction as step 4).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Stage {
    /// Trace the base pixels.
    Step1,
    /// Check and interpolate the A1 pixels.
    Step2a,
    /// Pack the A1 pixels that need rays.
    Step2b,
    /// Trace the packed A1 pixels.
    Step2c,
    /// Check and interpolate the A2 pixels.
    Step3a,
    /// Pack the A2 pixels that need rays.
    Step3b,
    /// Trace the packed A2 pixels.
    Step3c,
    /// Post-correction.
    Step4,
}

impl Stage {
    /// All stages in the order of a frame.
    pub const ALL: [Stage; 8] = [
        Stage::Step1,
        Stage::Step2a,
        Stage::Step2b,
        Stage::Step2c,
        Stage::Step3a,
        Stage::Step3b,
        Stage::Step3c,
        Stage::Step4,
    ];

    /// The stage's one name.
    pub fn name(self) -> &'static str {
        match self {
            Stage::Step1 => "step1",
            Stage::Step2a => "step2a",
            Stage::Step2b => "step2b",
            Stage::Step2c => "step2c",
            Stage::Step3a => "step3a",
            Stage::Step3b => "step3b",
            Stage::Step3c => "step3c",
            Stage::Step4 => "step4",
        }
    }
}

/// How many work-items a kernel is launched with, and what one of them is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Items {
    /// One per item of the step's grid: `grid_width` by `grid_height`.
    Grid,
    /// One per list entry, source and direction, or line: `item_count`.
    List,
    /// One per chunk of 32 of `item_count` items.
    Chunks,
    /// Work-groups of `scan_group` that cover `item_count` elements.
    Groups,
    /// One work-group of any size; no more than `scan_group`.
    OneGroup,
}

/// A kernel: an entry point of its stage's file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[allow(missing_docs)] // one per entry point; the kernel files document them
pub enum Kernel {
    Step1,
    Step2a,
    Step2bCount,
    Step2bScan,
    Step2bScatter,
    Step2c,
    Step3a,
    Step3bCount,
    Step3bScan,
    Step3bScatter,
    Step3c,
    Step4Mark,
    Step4Count,
    Step4Scan,
    Step4Scatter,
    Step4Trace,
    Step4Tail,
    Step4Sweep,
}

impl Kernel {
    /// All kernels in the order of a frame.
    pub const ALL: [Kernel; 18] = [
        Kernel::Step1,
        Kernel::Step2a,
        Kernel::Step2bCount,
        Kernel::Step2bScan,
        Kernel::Step2bScatter,
        Kernel::Step2c,
        Kernel::Step3a,
        Kernel::Step3bCount,
        Kernel::Step3bScan,
        Kernel::Step3bScatter,
        Kernel::Step3c,
        Kernel::Step4Mark,
        Kernel::Step4Count,
        Kernel::Step4Scan,
        Kernel::Step4Scatter,
        Kernel::Step4Trace,
        Kernel::Step4Tail,
        Kernel::Step4Sweep,
    ];

    /// The entry point's name in the kernel file.
    pub fn name(self) -> &'static str {
        match self {
            Kernel::Step1 => "step1",
            Kernel::Step2a => "step2a",
            Kernel::Step2bCount => "step2b_count",
            Kernel::Step2bScan => "step2b_scan",
            Kernel::Step2bScatter => "step2b_scatter",
            Kernel::Step2c => "step2c",
            Kernel::Step3a => "step3a",
            Kernel::Step3bCount => "step3b_count",
            Kernel::Step3bScan => "step3b_scan",
            Kernel::Step3bScatter => "step3b_scatter",
            Kernel::Step3c => "step3c",
            Kernel::Step4Mark => "step4_mark",
            Kernel::Step4Count => "step4_count",
            Kernel::Step4Scan => "step4_scan",
            Kernel::Step4Scatter => "step4_scatter",
            Kernel::Step4Trace => "step4_trace",
            Kernel::Step4Tail => "step4_tail",
            Kernel::Step4Sweep => "step4_sweep",
        }
    }

    /// The stage that the kernel belongs to.
    pub fn stage(self) -> Stage {
        match self {
            Kernel::Step1 => Stage::Step1,
            Kernel::Step2a => Stage::Step2a,
            Kernel::Step2bCount | Kernel::Step2bScan | Kernel::Step2bScatter => Stage::Step2b,
            Kernel::Step2c => Stage::Step2c,
            Kernel::Step3a => Stage::Step3a,
            Kernel::Step3bCount | Kernel::Step3bScan | Kernel::Step3bScatter => Stage::Step3b,
            Kernel::Step3c => Stage::Step3c,
            Kernel::Step4Mark
            | Kernel::Step4Count
            | Kernel::Step4Scan
            | Kernel::Step4Scatter
            | Kernel::Step4Trace
            | Kernel::Step4Tail
            | Kernel::Step4Sweep => Stage::Step4,
        }
    }

    /// What its work-items are.
    pub fn items(self) -> Items {
        match self {
            Kernel::Step1 | Kernel::Step2a | Kernel::Step3a => Items::Grid,
            Kernel::Step2c | Kernel::Step3c | Kernel::Step4Mark | Kernel::Step4Trace | Kernel::Step4Sweep => {
                Items::List
            }
            Kernel::Step2bCount
            | Kernel::Step3bCount
            | Kernel::Step4Count
            | Kernel::Step2bScatter
            | Kernel::Step3bScatter
            | Kernel::Step4Scatter => Items::Chunks,
            Kernel::Step2bScan | Kernel::Step3bScan | Kernel::Step4Scan => Items::Groups,
            Kernel::Step4Tail => Items::OneGroup,
        }
    }
}

/// What a kernel argument is bound to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Binding {
    /// The frame's parameters alone.
    Frame,
    /// The frame's parameters and all scene arrays: `SCENE_PARAMS` of `kernels/types.h`.
    Scene,
    /// The launch's `StepParams`, by value.
    Step,
    /// Attribute planes.
    Attributes,
    /// The picture.
    Color,
    /// Counter planes.
    Counters,
    /// Packed pixel addresses.
    List,
    /// Mask words of the packing.
    Masks,
    /// Scan levels of the packing.
    Sums,
    /// Local memory for a scan: two words per work-item of `scan_group`.
    Scratch,
}

impl Kernel {
    /// The kernel's arguments, in order.
    pub fn bindings(self) -> &'static [Binding] {
        use Binding::*;
        match self {
            Kernel::Step1 | Kernel::Step2a | Kernel::Step3a | Kernel::Step4Sweep => {
                &[Scene, Step, Attributes, Color, Counters]
            }
            Kernel::Step2c | Kernel::Step3c | Kernel::Step4Trace => &[Scene, Step, List, Attributes, Color, Counters],
            Kernel::Step2bCount | Kernel::Step3bCount => &[Frame, Step, Attributes, Masks, Sums],
            Kernel::Step2bScan | Kernel::Step3bScan | Kernel::Step4Scan => &[Step, Sums, Scratch],
            Kernel::Step2bScatter | Kernel::Step3bScatter => &[Step, Masks, Sums, List],
            Kernel::Step4Tail => &[Scene, Step, Attributes, Color, Counters, List, Sums, Scratch],
            Kernel::Step4Mark => &[Frame, Step, Attributes, List, Color],
            Kernel::Step4Count => &[Frame, Step, Attributes, Color, List, Masks, Sums],
            Kernel::Step4Scatter => &[Frame, Step, Attributes, Color, Masks, Sums, List, List],
        }
    }
}
