// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options that choose a method, each for one field of it.

use clap::Args;
use rarefy::internal::method::options::{
    Compared, Correction, GcolSpace, Interpolation, Method, Preset, Spread, Test, TextureRule,
};
use rarefy::{Error, Result};

use super::args::named;

/// A tolerance of the checks at the two levels of blocks.
#[derive(Debug, Clone, Copy)]
pub struct Levels {
    fine: f32,
    coarse: f32,
}

fn levels(text: &str) -> std::result::Result<Levels, String> {
    let number = |text: &str| text.trim().parse().map_err(|_| format!("`{text}` is not a number"));
    let (fine, coarse) = text.split_once(',').unwrap_or((text, text));
    Ok(Levels { fine: number(fine)?, coarse: number(coarse)? })
}

/// What `--correction` compares; `None` is off.
#[derive(Debug, Clone, Copy)]
pub struct ComparedOrOff(Option<Compared>);

fn compared_or_off(text: &str) -> std::result::Result<ComparedOrOff, String> {
    if text.eq_ignore_ascii_case("off") {
        return Ok(ComparedOrOff(None));
    }
    let compared = named::<Compared>(text).map_err(|error| format!("{error} or off"))?;
    Ok(ComparedOrOff(Some(compared)))
}

/// A method: a preset, and what differs from it.
#[derive(Debug, Args)]
#[command(next_help_heading = "Method")]
pub struct MethodArgs {
    /// The method that the options below change.
    #[arg(long, value_parser = named::<Preset>, default_value_t, value_name = "balanced|fast|paper")]
    pub method: Preset,
    /// Side of the blocks of which one pixel is always traced: 2, or 4 for two levels.
    #[arg(long, value_name = "2|4")]
    pub blocks: Option<u32>,
    /// Whether base pixels of successive rows of blocks lie in different columns; in the paper they do not.
    #[arg(long, value_name = "true|false")]
    pub shifted_rows: Option<bool>,
    /// G2: largest distance of two references, as a share of the scene's extent. As for all tolerances of tests: one
    /// number counts at both levels of blocks, FINE,COARSE at references two and four pixels apart.
    #[arg(long, value_parser = levels, allow_hyphen_values = true, value_name = "SHARE")]
    pub t_pos: Option<Levels>,
    /// G3: least dot product of the normals.
    #[arg(long, value_parser = levels, allow_hyphen_values = true, value_name = "DOT")]
    pub t_norm: Option<Levels>,
    /// G4: sine of the slope below which a surface counts as flat.
    #[arg(long, value_parser = levels, allow_hyphen_values = true, value_name = "SINE")]
    pub t_conv: Option<Levels>,
    /// TX: how many repetitions texture coordinates may lie apart; with `--textures border` how near to the border of its repetition
    /// one counts as at the border.
    #[arg(long, value_parser = levels, allow_hyphen_values = true, value_name = "SHARE")]
    pub t_tex: Option<Levels>,
    /// GC: largest distance of the reflected colours.
    #[arg(long, value_parser = levels, allow_hyphen_values = true, value_name = "DISTANCE")]
    pub t_gcol: Option<Levels>,
    /// Tests to switch off, such as gc,tx.
    #[arg(long, value_parser = named::<Test>, value_delimiter = ',', value_name = "TEST,...")]
    pub disable_test: Vec<Test>,
    /// TX: compare texture coordinates with their whole repetitions, or by the border of one as in the paper.
    #[arg(long, value_parser = named::<TextureRule>, value_name = "joined|border")]
    pub textures: Option<TextureRule>,
    /// Compare reflected colours as displayed, or linearly.
    #[arg(long, value_parser = named::<GcolSpace>, value_name = "display|linear")]
    pub gcol_space: Option<GcolSpace>,
    /// GC: whether it looks for texture between what two references see in a mirror or behind glass.
    #[arg(long, value_name = "true|false")]
    pub secondary_textures: Option<bool>,
    /// Whether a pixel whose upper and lower references differ may lie between two others.
    #[arg(long, value_name = "true|false")]
    pub second_pairs: Option<bool>,
    /// Where between its references an interpolated pixel lies: midway on the screen, or in space as in the paper.
    #[arg(long, value_parser = named::<Interpolation>, value_name = "perspective|plain")]
    pub interpolation: Option<Interpolation>,
    /// Whether packed pixels take over the shadow bits about which their references agree.
    #[arg(long, value_name = "true|false")]
    pub reuse_shadows: Option<bool>,
    /// What post-correction compares.
    #[arg(long, value_parser = compared_or_off, value_name = "off|object|object+shadow|all")]
    pub correction: Option<ComparedOrOff>,
    /// How post-correction spreads: until nothing changes, or in the paper's single round.
    #[arg(long, value_parser = named::<Spread>, value_name = "converged|sweeps")]
    pub correction_method: Option<Spread>,
    /// Post-correction: from which difference in a channel of 0 to 255 of the shown colours on a difference within one
    /// object counts; 0: always.
    #[arg(long, value_name = "0..255")]
    pub correction_t_visible: Option<u8>,
    /// Post-correction: least dot product of normals that are taken to be the same.
    #[arg(long, allow_negative_numbers = true, value_name = "DOT")]
    pub correction_t_norm: Option<f32>,
    /// Post-correction: largest distance of reflected colours that are taken to be the same.
    #[arg(long, allow_negative_numbers = true, value_name = "DISTANCE")]
    pub correction_t_gcol: Option<f32>,
    /// Converged post-correction: whether neighbours that a straight edge or line passes by are spared.
    #[arg(long, value_name = "true|false")]
    pub correction_thin_only: Option<bool>,
    /// Converged post-correction: whether it looks across the gaps of lines thinner than a pixel.
    #[arg(long, value_name = "true|false")]
    pub correction_bridges: Option<bool>,
    /// Converged post-correction: whether one pixel of every 16x16 that nothing has asked for is traced.
    #[arg(long, value_name = "true|false")]
    pub correction_probes: Option<bool>,
}

fn set<T>(field: &mut T, given: Option<T>) {
    if let Some(value) = given {
        *field = value;
    }
}

impl MethodArgs {
    /// The preset with all that was given beside it.
    ///
    /// # Errors
    /// An option of post-correction for which the chosen one has no field.
    pub fn method(&self) -> Result<Method> {
        let mut method = Method::from(self.method);
        set(&mut method.block, self.blocks);
        set(&mut method.shifted_rows, self.shifted_rows);
        let checks = &mut method.checks;
        for (tolerances, level) in
            [(&mut checks.fine, (|l| l.fine) as fn(Levels) -> f32), (&mut checks.coarse, |l| l.coarse)]
        {
            set(&mut tolerances.t_pos, self.t_pos.map(level));
            set(&mut tolerances.t_norm, self.t_norm.map(level));
            set(&mut tolerances.t_conv, self.t_conv.map(level));
            set(&mut tolerances.t_tex, self.t_tex.map(level));
            set(&mut tolerances.t_gcol, self.t_gcol.map(level));
        }
        set(&mut checks.textures, self.textures);
        set(&mut checks.gcol_space, self.gcol_space);
        set(&mut checks.secondary_textures, self.secondary_textures);
        set(&mut checks.second_pairs, self.second_pairs);
        for &test in &self.disable_test {
            checks.tests = checks.tests.without(test);
        }
        set(&mut method.interpolation, self.interpolation);
        set(&mut method.reuse_shadows, self.reuse_shadows);
        method.correction = self.correction(method.correction)?;
        Ok(method)
    }

    fn correction(&self, base: Correction) -> Result<Correction> {
        let mut correction = match self.correction {
            None => base,
            Some(ComparedOrOff(None)) => Correction::Off,
            Some(ComparedOrOff(Some(compared))) => {
                base.comparing(base.compared().map_or(compared, |given| compared.with_tolerances_of(given)))
            }
        };
        if let Some(spread) = self.correction_method {
            correction = correction.spreading(spread);
        }
        let (mut visible, mut norm, mut gcol) = (None, None, None);
        let (mut thin, mut gaps, mut chance) = (None, None, None);
        match &mut correction {
            Correction::Off => {}
            Correction::Sweeps(compared) => (visible, norm, gcol) = tolerances(compared),
            Correction::Converged { compared, thin_only, bridges, probes } => {
                (visible, norm, gcol) = tolerances(compared);
                (thin, gaps, chance) = (Some(thin_only), Some(bridges), Some(probes));
            }
        }
        give("--correction-t-visible", visible, self.correction_t_visible)?;
        give("--correction-t-norm", norm, self.correction_t_norm)?;
        give("--correction-t-gcol", gcol, self.correction_t_gcol)?;
        give("--correction-thin-only", thin, self.correction_thin_only)?;
        give("--correction-bridges", gaps, self.correction_bridges)?;
        give("--correction-probes", chance, self.correction_probes)?;
        if correction == Correction::Off && self.correction_method.is_some() {
            return Err(unused("--correction-method"));
        }
        Ok(correction)
    }
}

type Fields<'a> = (Option<&'a mut u8>, Option<&'a mut f32>, Option<&'a mut f32>);

fn tolerances(compared: &mut Compared) -> Fields<'_> {
    match compared {
        Compared::Object => (None, None, None),
        Compared::ObjectAndShadow { t_visible } => (Some(t_visible), None, None),
        Compared::All { t_visible, t_norm, t_gcol } => (Some(t_visible), Some(t_norm), Some(t_gcol)),
    }
}

/// Sets a field that is there.
fn give<T: Copy>(option: &str, field: Option<&mut T>, given: Option<T>) -> Result<()> {
    match (field, given) {
        (Some(field), Some(value)) => *field = value,
        (None, Some(_)) => return Err(unused(option)),
        (_, None) => {}
    }
    Ok(())
}

fn unused(option: &str) -> Error {
    Error::argument(option, "the chosen --correction and --correction-method have no use for it; leave it out")
}
