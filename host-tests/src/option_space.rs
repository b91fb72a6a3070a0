// SPDX-License-Identifier: MIT OR Apache-2.0
//! Options drawn from the whole space of what a caller can ask for.

use rarefy::internal::method::options::{
    Checks, Compared, Correction, GcolSpace, Interpolation, Method, Mode, RenderOptions, Test, TestSet, TextureRule,
    Tolerances,
};

use crate::fixtures::Random;

/// One of the values.
fn any<T: Copy>(random: &mut Random, values: &[T]) -> T {
    values[random.below(values.len())]
}

fn flip(random: &mut Random) -> bool {
    random.below(2) == 0
}

/// Tolerances from "every pair fails" to "every pair passes".
fn tolerances(random: &mut Random) -> Tolerances {
    Tolerances {
        t_pos: any(random, &[0.0, 0.001, 0.03, 0.06, 1.0e9]),
        t_norm: any(random, &[-1.0, 0.5, 0.9, 0.99, 2.0]),
        t_conv: any(random, &[0.0, 0.05, 0.2, 1.0]),
        t_tex: any(random, &[0.0, 0.1, 0.3, 1.0]),
        t_gcol: any(random, &[0.0, 0.05, 0.15, 10.0]),
    }
}

fn compared(random: &mut Random) -> Compared {
    let t_visible = any(random, &[0, 1, 6, 255]);
    match random.below(3) {
        0 => Compared::Object,
        1 => Compared::ObjectAndShadow { t_visible },
        _ => {
            Compared::All { t_visible, t_norm: any(random, &[-1.0, 0.9, 2.0]), t_gcol: any(random, &[0.0, 0.07, 10.0]) }
        }
    }
}

fn method(random: &mut Random) -> Method {
    let tests = Test::ALL.into_iter().filter(|_| random.below(4) > 0);
    let tests = tests.fold(TestSet::NONE, TestSet::with);
    let compared = compared(random);
    Method {
        block: any(random, &[2, 4]),
        shifted_rows: flip(random),
        checks: Checks {
            tests: if flip(random) { TestSet::ALL } else { tests },
            fine: tolerances(random),
            coarse: tolerances(random),
            textures: any(random, &TextureRule::ALL),
            secondary_textures: flip(random),
            gcol_space: any(random, &GcolSpace::ALL),
            second_pairs: flip(random),
        },
        interpolation: any(random, &Interpolation::ALL),
        correction: match random.below(5) {
            0 => Correction::Off,
            1 => Correction::Sweeps(compared),
            _ => {
                Correction::Converged { compared, thin_only: flip(random), bridges: flip(random), probes: flip(random) }
            }
        },
        reuse_shadows: flip(random),
    }
}

/// Sides from one sample to a few blocks and tiles, odd ones among them.
fn side(random: &mut Random, largest: u32) -> u32 {
    let side = match random.below(3) {
        0 => any(random, &[1, 2, 3, 4, 5, 31, 32, 33, 63, 64, 65]),
        _ => 1 + random.below(70) as u32,
    };
    if side > largest { 1 + side % largest } else { side }
}

/// Any options, for a frame of at most `largest` samples a side.
pub fn options(random: &mut Random, largest: u32) -> RenderOptions {
    let method = method(random);
    let samples = any(random, &[1, 1, 1, 2, 4]);
    let (width, height) = (side(random, largest).div_ceil(samples), side(random, largest).div_ceil(samples));
    // Sweeps cannot be drawn in bands; a frame of one band may have as many rows as it likes.
    let banded = random.below(3) == 0 && !matches!(method.correction, Correction::Sweeps(_));
    RenderOptions {
        width,
        height,
        samples,
        mode: if random.below(8) == 0 { Mode::Full } else { Mode::Adaptive },
        depth: any(random, &[0, 1, 4]),
        method,
        band_rows: banded.then(|| 1 + random.below(40) as u32),
    }
}
