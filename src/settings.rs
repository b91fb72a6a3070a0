// SPDX-License-Identifier: MIT OR Apache-2.0
//! The settings that a caller can get wrong, by name: what an error is about, as data.

macro_rules! settings {
    ($($(#[$doc:meta])* $variant:ident = $path:literal,)+) => {
        /// A setting, named by the path of its field. A command or a binding words its own option for it.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum Setting {
            $($(#[$doc])* $variant,)+
        }

        impl Setting {
            /// Every setting.
            pub const ALL: &'static [Setting] = &[$(Setting::$variant),+];

            /// The path of the field, such as `method.checks.t_pos`; a tolerance of the checks stands for all levels.
            pub const fn path(self) -> &'static str {
                match self {
                    $(Setting::$variant => $path,)+
                }
            }
        }
    };
}

settings! {
    /// Width and height in pixels.
    Size = "size",
    /// Samples per pixel and axis.
    Samples = "samples",
    /// Full or adaptive.
    Mode = "mode",
    /// Most secondary rays in a chain.
    Depth = "depth",
    /// The name of a method.
    Method = "method",
    /// Side of the base blocks.
    Block = "method.block",
    /// The set of similarity tests.
    Tests = "method.checks.tests",
    /// G2's tolerance.
    TPos = "method.checks.t_pos",
    /// G3's tolerance.
    TNorm = "method.checks.t_norm",
    /// G4's tolerance.
    TConv = "method.checks.t_conv",
    /// TX's tolerance.
    TTex = "method.checks.t_tex",
    /// GC's tolerance.
    TGcol = "method.checks.t_gcol",
    /// How TX compares texture coordinates.
    Textures = "method.checks.textures",
    /// How GC compares reflected colours.
    GcolSpace = "method.checks.gcol_space",
    /// Where interpolated pixels lie.
    Interpolation = "method.interpolation",
    /// What post-correction compares.
    Correction = "method.correction",
    /// How post-correction spreads.
    CorrectionSpread = "method.correction.spread",
    /// From which visible difference on post-correction counts differences within one object.
    CorrectionTVisible = "method.correction.t_visible",
    /// Post-correction's tolerance for normals.
    CorrectionTNorm = "method.correction.t_norm",
    /// Post-correction's tolerance for reflected colours.
    CorrectionTGcol = "method.correction.t_gcol",
    /// Which device draws.
    Device = "device",
    /// The profile that a device is held to.
    Profile = "profile",
    /// Most device memory.
    MemoryBudget = "memory_budget",
    /// Shading rules.
    Shading = "shading",
    /// The walk through the kd-tree.
    Traversal = "traversal",
    /// Where nodes and triangles lie in device memory.
    MemoryPath = "memory_path",
    /// A picture of attributes.
    Layer = "layer",
    /// The name of a built-in scene.
    BuiltinScene = "scene",
    /// The kd-tree's cost of visiting a node.
    KdTraversalCost = "kdtree.traversal_cost",
    /// The kd-tree's cost of testing a triangle.
    KdIntersectionCost = "kdtree.intersection_cost",
    /// The kd-tree's bonus for empty cells.
    KdEmptyBonus = "kdtree.empty_bonus",
    /// The kd-tree's greatest depth.
    KdMaxDepth = "kdtree.max_depth",
    /// Threads that build the kd-tree.
    KdThreads = "kdtree.threads",
}

impl std::fmt::Display for Setting {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.path())
    }
}

/// `a, b or c`.
pub(crate) fn list(names: &[&str]) -> String {
    match names {
        [] => String::new(),
        [one] => (*one).to_owned(),
        [first @ .., last] => format!("{} or {last}", first.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::list;

    #[test]
    fn lists_read_as_sentences() {
        assert_eq!(list(&["a"]), "a");
        assert_eq!(list(&["a", "b", "c"]), "a, b or c");
    }
}
