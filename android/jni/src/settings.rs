// SPDX-License-Identifier: MIT OR Apache-2.0
//! Settings as Java's builders send them: names and values in turn, as text.
//!
//! The names are those of the builders' methods. A number's text is read back as the very same number.

use std::str::FromStr;

use rarefy::tuning::{Compared, Correction, Test, Tolerances};
use rarefy::{CacheFolder, DeviceOptions, Error, Keep, Layer, Method, Profile, RenderOptions, Result, Setting};

/// What a frame is asked for.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FrameSettings {
    /// How it is drawn.
    pub options: RenderOptions,
    /// Whether the size was given; else it is the target's.
    pub has_size: bool,
    /// What stays of it.
    pub keep: Keep,
}

/// The pairs of a list in which names and values take turns.
fn pairs(settings: &[String]) -> impl Iterator<Item = Result<(&str, &str)>> {
    settings.chunks(2).map(|pair| match pair {
        [name, value] => Ok((name.as_str(), value.as_str())),
        _ => Err(Error::argument("settings", "a name without a value")),
    })
}

fn unknown(name: &str) -> Error {
    Error::argument(name, "this library knows no such setting; are the Java classes of another version?")
}

/// A number of a setting.
fn number<T: FromStr>(setting: Setting, text: &str) -> Result<T> {
    text.parse().map_err(|_| Error::option(setting, text, "a number"))
}

fn truth(name: &str, text: &str) -> Result<bool> {
    text.parse().map_err(|_| Error::argument(name, format!("`{text}` is neither true nor false")))
}

/// A number for each of `N` things, parted by commas.
fn numbers<T: FromStr, const N: usize>(setting: Setting, text: &str) -> Result<[T; N]> {
    let numbers = text.split(',').map(|part| number(setting, part)).collect::<Result<Vec<T>>>()?;
    numbers.try_into().map_err(|_| Error::option(setting, text, format!("{N} numbers")))
}

/// Sets a tolerance at the two levels of blocks.
fn tolerance(method: &mut Method, setting: Setting, text: &str, field: fn(&mut Tolerances) -> &mut f32) -> Result<()> {
    let [fine, coarse] = numbers(setting, text)?;
    *field(&mut method.checks.fine) = fine;
    *field(&mut method.checks.coarse) = coarse;
    Ok(())
}

/// Reads the settings of `RenderOptions`. What they say together is checked when a frame is drawn.
///
/// # Errors
/// A name that is not known, a value that is no number or name of its kind.
pub fn frame(settings: &[String]) -> Result<FrameSettings> {
    let mut frame = FrameSettings::default();
    let FrameSettings { options, has_size, keep } = &mut frame;
    for pair in pairs(settings) {
        let (name, value) = pair?;
        let method = &mut options.method;
        match name {
            "size" => {
                [options.width, options.height] = numbers(Setting::Size, value)?;
                *has_size = true;
            }
            "samples" => options.samples = number(Setting::Samples, value)?,
            "mode" => options.mode = value.parse()?,
            "depth" => options.depth = number(Setting::Depth, value)?,
            "method" => *method = value.parse()?,
            "block" => method.block = number(Setting::Block, value)?,
            "disableTest" => method.checks.tests = method.checks.tests.without(value.parse::<Test>()?),
            "tPos" => tolerance(method, Setting::TPos, value, |t| &mut t.t_pos)?,
            "tNorm" => tolerance(method, Setting::TNorm, value, |t| &mut t.t_norm)?,
            "tConv" => tolerance(method, Setting::TConv, value, |t| &mut t.t_conv)?,
            "tTex" => tolerance(method, Setting::TTex, value, |t| &mut t.t_tex)?,
            "tGcol" => tolerance(method, Setting::TGcol, value, |t| &mut t.t_gcol)?,
            "correction" if value == "off" => method.correction = Correction::Off,
            "correction" => method.correction = method.correction.comparing(value.parse::<Compared>()?),
            "keepLayer" => *keep = keep.and(value.parse::<Layer>()?.needs()),
            "counters" => keep.counters |= truth(name, value)?,
            _ => return Err(unknown(name)),
        }
    }
    Ok(frame)
}

/// Reads the settings of `OpenOptions`.
///
/// # Errors
/// As for [`frame`]; a profile that cannot be read.
pub fn device(settings: &[String]) -> Result<DeviceOptions> {
    let mut options = DeviceOptions::default();
    for pair in pairs(settings) {
        let (name, value) = pair?;
        match name {
            "device" => options.device = value.parse()?,
            "cacheFolder" => options.cache = CacheFolder::At(value.into()),
            "memoryBudgetBytes" => options.memory_budget_bytes = Some(number(Setting::MemoryBudget, value)?),
            "openclLibrary" => options.opencl_library = Some(value.into()),
            "retryCrashed" => options.retry_crashed = truth(name, value)?,
            "strict" => options.strict = truth(name, value)?,
            "profile" => options.profile = Some(Profile::named(value)?),
            _ => return Err(unknown(name)),
        }
    }
    Ok(options)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use rarefy::{DeviceChoice, Mode};

    fn list(text: &str) -> Vec<String> {
        text.split_whitespace().map(str::to_owned).collect()
    }

    #[test]
    fn frames_are_what_the_settings_say() {
        assert_eq!(frame(&[]).unwrap(), FrameSettings::default());
        let asked = frame(&list(
            "method fast size 33,21 samples 2 mode full depth 3 block 2 disableTest gc disableTest tx tPos 0.1,0.25 \
             tNorm 0.5,0.5 tConv 0,0 tTex 1,1 tGcol 0.125,0.5 correction object keepLayer depth counters true",
        ))
        .unwrap();
        let options = &asked.options;
        assert_eq!((options.width, options.height, options.samples, options.depth), (33, 21, 2, 3));
        assert_eq!((options.mode, options.method.block), (Mode::Full, 2));
        assert_eq!(options.method.checks.tests.to_string(), "g1,g2,g3,g4,sh");
        assert_eq!((options.method.checks.fine.t_pos, options.method.checks.coarse.t_pos), (0.1, 0.25));
        assert_eq!((options.method.checks.fine.t_gcol, options.method.checks.coarse.t_gcol), (0.125, 0.5));
        assert_eq!(options.method.correction.compared(), Some(Compared::Object));
        assert!(asked.has_size && asked.keep == Layer::Depth.needs().and(Keep::COUNTERS));
        assert_eq!(frame(&list("correction off")).unwrap().options.method.correction, Correction::Off);
        // A preset replaces what came before it.
        assert_eq!(frame(&list("block 4 method paper")).unwrap().options.method, Method::paper());
    }

    #[test]
    fn what_is_no_setting_is_refused() {
        for (text, part) in [
            ("colour red", "colour"),
            ("size 3", "size"),
            ("size 3,x", "`x`"),
            ("size -3,4", "`-3`"),
            ("mode half", "adaptive"),
            ("samples", "without a value"),
            ("counters yes", "`yes`"),
            ("keepLayer smell", "fail-mask"),
            ("tPos 0.1", "2 numbers"),
        ] {
            let error = frame(&list(text)).unwrap_err().to_string();
            assert!(error.contains(part), "{text}: {error}");
        }
        for text in ["device gpu", "memoryBudgetBytes much", "profile none-such", "size 3,4"] {
            assert!(device(&list(text)).is_err(), "{text}");
        }
    }

    #[test]
    fn devices_are_what_the_settings_say() {
        let options = device(&list(
            "device opencl:1 cacheFolder /a/b memoryBudgetBytes 5000000000 strict true profile adreno-420 \
             openclLibrary /b/libOpenCL.so retryCrashed true",
        ));
        let options = options.unwrap();
        assert_eq!(options.device, DeviceChoice::OpenCl(Some(1)));
        assert_eq!(options.cache, CacheFolder::At("/a/b".into()));
        assert_eq!(options.memory_budget_bytes, Some(5_000_000_000));
        assert!(options.strict && options.profile.is_some() && options.retry_crashed);
        assert_eq!(options.opencl_library.as_deref(), Some("/b/libOpenCL.so".as_ref()));
    }
}
