// SPDX-License-Identifier: MIT OR Apache-2.0
//! A method as kernels read it: members of [`StepParams`].

use super::{Compared, Correction, GcolSpace, Interpolation, Method, TextureRule};
use crate::layout::*;

fn flag(is_on: bool, flag: StepFlags) -> StepFlags {
    if is_on { flag } else { StepFlags::empty() }
}

impl Method {
    /// `step` with what the checks of one level read. Positions are compared in scene units, hence the `extent`.
    pub(crate) fn check_params(&self, step: StepParams, is_finest: bool, extent: f32) -> StepParams {
        let checks = &self.checks;
        let tolerances = if is_finest { &checks.fine } else { &checks.coarse };
        StepParams {
            t_pos: tolerances.t_pos * extent,
            t_norm: tolerances.t_norm,
            t_conv: tolerances.t_conv,
            t_tex: tolerances.t_tex,
            t_gcol: tolerances.t_gcol,
            tests: checks.tests.fail_mask(),
            flags: StepFlags::STORE
                | flag(self.interpolation == Interpolation::Perspective, StepFlags::PERSPECTIVE)
                | flag(checks.gcol_space == GcolSpace::Linear, StepFlags::GCOL_LINEAR)
                | flag(checks.textures == TextureRule::Joined, StepFlags::UNWRAP)
                | flag(checks.secondary_textures, StepFlags::BEHIND)
                // References four pixels apart agree about too little.
                | flag(self.reuse_shadows && is_finest, StepFlags::REUSE_SHADOWS),
            ..step
        }
    }

    /// What every launch of post-correction reads; `None` without correction.
    pub(crate) fn correction_params(&self) -> Option<StepParams> {
        let compared = self.correction.compared()?;
        let (t_norm, t_gcol) = match compared {
            Compared::All { t_norm, t_gcol, .. } => (t_norm, t_gcol),
            Compared::Object | Compared::ObjectAndShadow { .. } => (0.0, 0.0),
        };
        // Sweeps walk lines side by side: what lies beside a line may be changing.
        let thin_only = matches!(self.correction, Correction::Converged { thin_only: true, .. });
        Some(StepParams {
            flags: StepFlags::STORE
                | flag(compared != Compared::Object, StepFlags::COMPARE_SHADOW)
                | flag(matches!(compared, Compared::All { .. }), StepFlags::COMPARE_SHADING)
                | flag(self.checks.gcol_space == GcolSpace::Linear, StepFlags::GCOL_LINEAR)
                | flag(thin_only, StepFlags::THIN_ONLY)
                | flag(self.reuse_shadows, StepFlags::REUSE_SHADOWS),
            t_visible: compared.t_visible().unwrap_or(0).into(),
            t_norm,
            t_gcol,
            ..bytemuck::Zeroable::zeroed()
        })
    }
}
