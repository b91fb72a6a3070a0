// SPDX-License-Identifier: MIT OR Apache-2.0
//! The steps of the method, the kernels that they launch, and the programs that these are compiled in.
//!
//! A step has one name everywhere: the paper's, the enum variant's, the profiler's. Steps share kernels: a launch names
//! both.

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

    /// The kernels that it launches.
    pub fn kernels(self) -> impl Iterator<Item = Kernel> {
        LAUNCHES.into_iter().filter(move |(stage, ..)| *stage == self).map(|(_, kernel, _)| kernel)
    }
}

/// A program: the kernels of one file of `kernels/`, compiled together when one of them is first launched.
///
/// The ray tree, most of what there is to compile, is in [`Program::Trace`] and in the two programs that few frames need.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Program {
    /// The ray tree.
    Trace,
    /// Similarity checks and interpolation.
    Check,
    /// Packing of a grid's pixels; the prefix scan.
    Pack,
    /// Which pixels post-correction traces.
    Correct,
    /// Whole rounds of post-correction in one launch; only where launches are dear.
    CorrectTail,
    /// The paper's variant of post-correction.
    CorrectSweep,
}

impl Program {
    /// All programs.
    pub const ALL: [Program; 6] =
        [Program::Trace, Program::Check, Program::Pack, Program::Correct, Program::CorrectTail, Program::CorrectSweep];

    /// The name of its file in `kernels/`, without `.cl`.
    pub fn name(self) -> &'static str {
        match self {
            Program::Trace => "trace",
            Program::Check => "check",
            Program::Pack => "pack",
            Program::Correct => "correct",
            Program::CorrectTail => "correct_tail",
            Program::CorrectSweep => "correct_sweep",
        }
    }

    /// Its kernels.
    pub fn kernels(self) -> impl Iterator<Item = Kernel> {
        Kernel::ALL.into_iter().filter(move |kernel| kernel.program() == self)
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

/// A kernel: an entry point of a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[allow(missing_docs)] // one per entry point; the kernel files document them
pub enum Kernel {
    Trace,
    Check,
    PackCount,
    PackScan,
    PackScatter,
    CorrectMark,
    CorrectCount,
    CorrectScatter,
    CorrectTail,
    CorrectSweep,
}

impl Kernel {
    /// All kernels in the order of a frame.
    pub const ALL: [Kernel; 10] = [
        Kernel::Trace,
        Kernel::Check,
        Kernel::PackCount,
        Kernel::PackScan,
        Kernel::PackScatter,
        Kernel::CorrectMark,
        Kernel::CorrectCount,
        Kernel::CorrectScatter,
        Kernel::CorrectTail,
        Kernel::CorrectSweep,
    ];

    /// The entry point's name in the kernel file.
    pub fn name(self) -> &'static str {
        match self {
            Kernel::Trace => "trace",
            Kernel::Check => "check",
            Kernel::PackCount => "pack_count",
            Kernel::PackScan => "pack_scan",
            Kernel::PackScatter => "pack_scatter",
            Kernel::CorrectMark => "correct_mark",
            Kernel::CorrectCount => "correct_count",
            Kernel::CorrectScatter => "correct_scatter",
            Kernel::CorrectTail => "correct_tail",
            Kernel::CorrectSweep => "correct_sweep",
        }
    }

    /// The program that the kernel is compiled in.
    pub fn program(self) -> Program {
        match self {
            Kernel::Trace => Program::Trace,
            Kernel::Check => Program::Check,
            Kernel::PackCount | Kernel::PackScan | Kernel::PackScatter => Program::Pack,
            Kernel::CorrectMark | Kernel::CorrectCount | Kernel::CorrectScatter => Program::Correct,
            Kernel::CorrectTail => Program::CorrectTail,
            Kernel::CorrectSweep => Program::CorrectSweep,
        }
    }

    /// What its work-items are when `stage` launches it: `trace` covers a grid in step1, a list in all other steps.
    pub fn items(self, stage: Stage) -> Items {
        match self {
            Kernel::Trace if stage == Stage::Step1 => Items::Grid,
            Kernel::Check => Items::Grid,
            Kernel::Trace | Kernel::CorrectMark | Kernel::CorrectSweep => Items::List,
            Kernel::PackCount | Kernel::PackScatter | Kernel::CorrectCount | Kernel::CorrectScatter => Items::Chunks,
            Kernel::PackScan => Items::Groups,
            Kernel::CorrectTail => Items::OneGroup,
        }
    }

    /// The label of its launches by `stage`: under it they are timed, cut into slices and named in errors.
    pub fn label(self, stage: Stage) -> &'static str {
        let launch = LAUNCHES.iter().find(|(of, kernel, _)| (*of, *kernel) == (stage, self));
        launch.map_or(self.name(), |(.., label)| label)
    }
}

/// Every launch of the method: the stage, its kernel, and the label of both.
pub const LAUNCHES: [(Stage, Kernel, &str); 20] = [
    (Stage::Step1, Kernel::Trace, "step1/trace"),
    (Stage::Step2a, Kernel::Check, "step2a/check"),
    (Stage::Step2b, Kernel::PackCount, "step2b/pack_count"),
    (Stage::Step2b, Kernel::PackScan, "step2b/pack_scan"),
    (Stage::Step2b, Kernel::PackScatter, "step2b/pack_scatter"),
    (Stage::Step2c, Kernel::Trace, "step2c/trace"),
    (Stage::Step3a, Kernel::Check, "step3a/check"),
    (Stage::Step3b, Kernel::PackCount, "step3b/pack_count"),
    (Stage::Step3b, Kernel::PackScan, "step3b/pack_scan"),
    (Stage::Step3b, Kernel::PackScatter, "step3b/pack_scatter"),
    (Stage::Step3c, Kernel::Trace, "step3c/trace"),
    (Stage::Step4, Kernel::CorrectMark, "step4/correct_mark"),
    (Stage::Step4, Kernel::CorrectCount, "step4/correct_count"),
    (Stage::Step4, Kernel::PackScan, "step4/pack_scan"),
    (Stage::Step4, Kernel::CorrectScatter, "step4/correct_scatter"),
    (Stage::Step4, Kernel::Trace, "step4/trace"),
    (Stage::Step4, Kernel::CorrectTail, "step4/correct_tail"),
    (Stage::Step4, Kernel::PackCount, "step4/pack_count"),
    (Stage::Step4, Kernel::PackScatter, "step4/pack_scatter"),
    (Stage::Step4, Kernel::CorrectSweep, "step4/correct_sweep"),
];

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
            Kernel::Trace => &[Scene, Step, List, Attributes, Color, Counters],
            Kernel::Check | Kernel::CorrectSweep => &[Scene, Step, Attributes, Color, Counters],
            Kernel::PackCount => &[Frame, Step, Attributes, Masks, Sums],
            Kernel::PackScan => &[Step, Sums, Scratch],
            Kernel::PackScatter => &[Frame, Step, Masks, Sums, List],
            Kernel::CorrectMark => &[Frame, Step, Attributes, List, Color],
            Kernel::CorrectCount => &[Frame, Step, Attributes, List, Masks, Sums],
            Kernel::CorrectScatter => &[Frame, Step, Attributes, Masks, Sums, List, List],
            Kernel::CorrectTail => &[Scene, Step, Attributes, Color, Counters, List, Sums, Scratch],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_launch_has_its_own_label_and_every_kernel_a_launch() {
        for (stage, kernel, label) in LAUNCHES {
            assert_eq!(label, format!("{}/{}", stage.name(), kernel.name()));
            assert_eq!(kernel.label(stage), label);
        }
        assert!(Kernel::ALL.into_iter().all(|kernel| LAUNCHES.iter().any(|(_, of, _)| *of == kernel)));
        assert!(Stage::ALL.into_iter().all(|stage| stage.kernels().next().is_some()));
        assert_eq!(Program::ALL.map(|program| program.kernels().count()).iter().sum::<usize>(), Kernel::ALL.len());
    }
}
