// SPDX-License-Identifier: MIT OR Apache-2.0
//! The table of sizes that kernels with bounds checks read, and what they left in it.

use super::{Arg, Buffer, Context};
use crate::device::bounds::{HEADER, SIZES, fault};
use crate::device::frame_memory::FrameBuffer;
use crate::device::launch::Launch;
use crate::error::{Error, Result};
use crate::layout::MAX_DEPTH;

/// The table of kernels with bounds checks.
pub(super) struct BoundsTable {
    words: Buffer<u32>,
    /// A buffer that is told to have fewer words than it has.
    understated: Option<(FrameBuffer, usize)>,
}

impl BoundsTable {
    pub(super) fn new(context: &Context, understated: Option<(FrameBuffer, usize)>) -> Result<Self> {
        Ok(BoundsTable { words: context.buffer("bounds", HEADER + SIZES)?, understated })
    }

    /// The sizes of everything that a launch indexes, behind an empty record.
    fn sizes(&self, launch: &Launch) -> Vec<u32> {
        let (scene, frame) = (launch.scene.prepared(), launch.frame.params());
        let of = |buffer: FrameBuffer| match self.understated {
            Some((told, words)) if told == buffer => words,
            _ => launch.frame.sizes().of(buffer),
        };
        let sizes: [usize; SIZES] = [
            of(FrameBuffer::Attributes),
            of(FrameBuffer::Counters),
            of(FrameBuffer::Color),
            of(FrameBuffer::List),
            of(FrameBuffer::Masks),
            of(FrameBuffer::Sums),
            2 * launch.step.scan_group as usize,
            frame.light_count as usize,
            2 * scene.tree.nodes.len(),
            scene.tree.leaf_triangles.len(),
            3 * scene.triangles.len(),
            scene.triangle_shading.len(),
            scene.materials.len(),
            scene.object_materials.len(),
            scene.textures.len(),
            scene.texels.len(),
            scene.tables.len(),
            MAX_DEPTH as usize,
        ];
        let sizes = sizes.into_iter().map(|size| u32::try_from(size).unwrap_or(u32::MAX));
        std::iter::repeat_n(0, HEADER).chain(sizes).collect()
    }

    /// Writes the sizes for a launch; its first argument.
    pub(super) fn prepare(&self, context: &Context, launch: &Launch) -> Result<Arg<'_>> {
        context.write(&self.words, 0, &self.sizes(launch))?;
        Ok(Arg::Buffer(&self.words))
    }

    /// Looks at what the launch left.
    pub(super) fn look(&self, context: &Context, launch: &Launch) -> Result<()> {
        match fault(&context.read(&self.words, 0..HEADER + SIZES)?) {
            Some((what, wanted, have)) => {
                Err(Error::LaunchBeyondBuffer { kernel: launch.kernel.label(launch.stage), what, wanted, have })
            }
            None => Ok(()),
        }
    }

    /// The same table on another context.
    pub(super) fn again(&self, context: &Context) -> Result<Self> {
        BoundsTable::new(context, self.understated)
    }
}
