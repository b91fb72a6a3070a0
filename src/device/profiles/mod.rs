// SPDX-License-Identifier: MIT OR Apache-2.0
//! Device profiles: what a phone's OpenCL allows, as data, so that a desktop refuses what the phone would refuse.
//!
//! A profile holds one entry per OpenCL query (key: the query's name in lower case), each with its value, certainty and
//! source, plus facts about the hardware and the choices that suit it. a dump of a device (`rarefy devices`) has the same format,
//! so a dump of a phone is a profile. A query that is absent or `null` sets no limit.

mod choices;
mod file;

use std::ffi::OsStr;
use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::Value;

pub use choices::{Choices, MemoryPath, Traversal};

use crate::device::queries::{Kind, Query};
use crate::error::Setting;
use crate::{Error, Result, files};

/// How well a value is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Certainty {
    /// Seen on the hardware, or in source code written for it.
    #[serde(rename = "reported")]
    Reported,
    /// Stated by the vendor or by the standard for such a device.
    #[serde(rename = "vendor doc")]
    VendorDoc,
    /// Derived from neighbours, from a minimum of the standard, or by arithmetic.
    #[serde(rename = "inferred")]
    Inferred,
    /// No source was found.
    #[serde(rename = "not found")]
    NotFound,
}

/// One value of a profile with its evidence.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entry {
    /// The value, of the type that the key asks for; `null` if unknown.
    #[serde(deserialize_with = "file::present")]
    pub value: Value,
    /// How well it is known.
    pub certainty: Certainty,
    /// Where it comes from.
    pub source: String,
    /// A remark; may be empty.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub note: String,
}

/// Facts about the hardware that no OpenCL query tells.
const HARDWARE: &[(&str, Kind)] = &[
    ("register_file_vec4_per_thread", Kind::Size),
    ("register_cliff_vec4", Kind::Size),
    ("constant_ram_bytes", Kind::Size),
    ("max_waves_per_core", Kind::Size),
    ("wave_lanes", Kind::Size),
    ("gmem_bytes", Kind::Size),
    ("alu_lanes", Kind::Size),
    ("gpu_batch_timeout_ms", Kind::Size),
    ("recommended_max_enqueue_ms", Kind::Size),
    ("dram_bandwidth_bytes_per_s", Kind::Size),
    ("fp32_gflops_peak", Kind::Text),
    ("gpu_fault_throttle", Kind::Text),
    ("cpu_isa", Kind::Text),
];

const EMBEDDED: [(&str, &str); 4] = [
    ("adreno-420", include_str!("adreno-420.json")),
    ("adreno-530", include_str!("adreno-530.json")),
    ("mali-t880", include_str!("mali-t880.json")),
    ("embedded-floor", include_str!("embedded-floor.json")),
];

/// The longest profile that is read; a dump of 20 devices has a tenth of it.
const MAX_FILE_BYTES: u64 = 4 << 20;

/// What a device allows and what suits it. Its JSON is the format of the files.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Profile {
    #[serde(skip)]
    name: String,
    device: String,
    #[serde(serialize_with = "file::as_object")]
    limits: Vec<(&'static str, Entry)>,
    #[serde(serialize_with = "file::as_object", skip_serializing_if = "Vec::is_empty")]
    hardware: Vec<(&'static str, Entry)>,
    choices: Choices,
}

impl Profile {
    /// An empty profile: no limits, default choices.
    pub(crate) fn empty(name: &str, device: &str) -> Self {
        Profile {
            name: name.to_string(),
            device: device.to_string(),
            limits: Vec::new(),
            hardware: Vec::new(),
            choices: Choices::default(),
        }
    }

    /// The names of the profiles that come with the library.
    pub fn names() -> Vec<&'static str> {
        EMBEDDED.iter().map(|(name, _)| *name).collect()
    }

    /// A profile that comes with the library. An unknown name is an error that lists the known ones.
    pub fn named(name: &str) -> Result<Self> {
        match EMBEDDED.iter().find(|(known, _)| *known == name) {
            Some((known, text)) => Self::from_json(known, text),
            None => {
                let allowed = format!("{}, or the path of a profile file", Self::names().join(", "));
                Err(Error::option(Setting::Profile, name, allowed))
            }
        }
    }

    /// Reads a profile file, or a dump of `rarefy devices` (its first device; another one with `#N` appended to
    /// the path, from 0).
    pub fn load(path: &Path) -> Result<Self> {
        let (path, index) = match path.to_str().and_then(|text| text.rsplit_once('#')) {
            Some((file, number)) if !path.exists() => match number.parse::<usize>() {
                Ok(index) => (Path::new(file), index),
                Err(_) => (path, 0),
            },
            _ => (path, 0),
        };
        let bytes = files::read(path, MAX_FILE_BYTES)?;
        let value: Value = serde_json::from_slice(&bytes).map_err(|error| Error::Syntax {
            path: path.to_path_buf(),
            line: error.line().max(1),
            message: format!("not a profile: {error}"),
        })?;
        let place = path.to_string_lossy();
        let value = match value.get("devices").and_then(Value::as_array) {
            None => &value,
            Some(devices) => devices.get(index).ok_or_else(|| {
                bad(&place, format!("holds {} devices, so there is no device #{index}", devices.len()))
            })?,
        };
        Self::from_value(&place, value)
    }

    /// What a user means by a profile: `none`, the name of one that comes with the library, or a file.
    pub fn find(name: &OsStr) -> Result<Option<Self>> {
        match name.to_str() {
            Some("none") => Ok(None),
            Some(text) if Self::names().contains(&text) => Self::named(text).map(Some),
            Some(text) if !text.contains(['/', '.', '#', '\\']) && !Path::new(text).exists() => {
                Self::named(text).map(Some)
            }
            _ => Self::load(Path::new(name)).map(Some),
        }
    }

    /// Parses a profile; `name` becomes its name and the place in error messages.
    pub fn from_json(name: &str, text: &str) -> Result<Self> {
        let value: Value = serde_json::from_str(text).map_err(|error| Error::Syntax {
            path: name.into(),
            line: error.line().max(1),
            message: format!("not a profile: {error}"),
        })?;
        Self::from_value(name, &value)
    }

    fn from_value(place: &str, value: &Value) -> Result<Self> {
        let file = file::parse(place, value)?;
        let mut profile = Profile::empty(place, file.device.as_deref().unwrap_or(place));
        for (key, entry) in file.limits {
            let at = format!("limits.{key}");
            let query = Query::find(&key).ok_or_else(|| unknown(place, &at))?;
            profile.limits.push((query.key, checked(place, &at, entry, |v| check_kind(query.kind, v))?));
        }
        for (key, entry) in file.hardware {
            let at = format!("hardware.{key}");
            let (key, kind) = HARDWARE.iter().find(|(known, _)| *known == key).ok_or_else(|| unknown(place, &at))?;
            profile.hardware.push((key, checked(place, &at, entry, |v| check_hardware(*kind, v))?));
        }
        profile.choices = Choices::of_file(place, file.choices)?;
        Ok(profile)
    }

    /// The profile's name: the embedded name, or the file.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The device that it describes, for people.
    pub fn device(&self) -> &str {
        &self.device
    }

    /// What suits the device.
    pub fn choices(&self) -> &Choices {
        &self.choices
    }

    /// All limits, in the file's order.
    pub fn limits(&self) -> impl Iterator<Item = (&'static str, &Entry)> {
        self.limits.iter().map(|(key, entry)| (*key, entry))
    }

    /// The entry of one query, if present.
    pub fn limit(&self, key: &str) -> Option<&Entry> {
        self.limits.iter().rev().find(|(known, _)| *known == key).map(|(_, entry)| entry)
    }

    /// A whole number of `limits`, if known.
    pub fn count(&self, key: &str) -> Option<u64> {
        self.limit(key)?.value.as_u64()
    }

    /// Three sizes of `limits`, if known.
    pub fn sizes(&self, key: &str) -> Option<[u64; 3]> {
        let list = self.limit(key)?.value.as_array()?;
        Some([list.first()?.as_u64()?, list.get(1)?.as_u64()?, list.get(2)?.as_u64()?])
    }

    /// A text of `limits`, if known.
    pub fn text(&self, key: &str) -> Option<&str> {
        self.limit(key)?.value.as_str()
    }

    /// A yes or no of `limits`, if known.
    pub fn flag(&self, key: &str) -> Option<bool> {
        self.limit(key)?.value.as_bool()
    }

    /// A set of names of `limits` (extensions, flags), if known.
    pub fn words(&self, key: &str) -> Option<Vec<String>> {
        match &self.limit(key)?.value {
            Value::Array(list) => Some(list.iter().filter_map(Value::as_str).map(str::to_string).collect()),
            Value::String(text) => Some(text.split_whitespace().map(str::to_string).collect()),
            Value::Number(_) => Some(Vec::new()),
            _ => None,
        }
    }

    /// A number of `hardware`, if known.
    pub fn hardware(&self, key: &str) -> Option<u64> {
        self.hardware.iter().find(|(known, _)| *known == key)?.1.value.as_u64()
    }

    pub(crate) fn set(&mut self, key: &'static str, entry: Entry) {
        self.limits.push((key, entry));
    }

    pub(crate) fn set_choices(&mut self, choices: Choices) {
        self.choices = choices;
    }

    pub(crate) fn set_device(&mut self, device: String) {
        self.device = device;
    }

    /// The profile as JSON, which [`Profile::load`] reads back.
    pub fn to_json(&self) -> Value {
        serde_json::to_value(self).expect("keys are texts, and values are JSON already")
    }
}

pub(crate) fn bad(place: &str, message: impl std::fmt::Display) -> Error {
    Error::profile(place, message)
}

fn unknown(place: &str, key: &str) -> Error {
    bad(place, format!("unknown key `{key}`"))
}

/// The entry at `key`, unless its value is not what it must be: `check` says what.
fn checked<M: std::fmt::Display>(
    place: &str,
    key: &str,
    entry: Entry,
    check: impl Fn(&Value) -> std::result::Result<(), M>,
) -> Result<Entry> {
    let value = &entry.value;
    if !value.is_null() {
        check(value).map_err(|must| bad(place, format!("`{key}` is {value}, but must be {must}")))?;
    }
    Ok(entry)
}

/// Whether a value has the type of its query; else what it must be.
fn check_kind(kind: Kind, value: &Value) -> std::result::Result<(), &'static str> {
    let size = |value: &Value| value.as_u64().is_some_and(|number| number > 0);
    let named = |names: &[(&str, u64)], value: &Value| {
        value.as_str().is_some_and(|text| names.iter().any(|(name, _)| *name == text))
    };
    let (good, must) = match kind {
        Kind::Text => (value.is_string(), "a text"),
        Kind::Count => (value.is_u64(), "a whole number from 0"),
        Kind::Size => (size(value), "a whole number from 1"),
        Kind::Flag => (value.is_boolean(), "true or false"),
        Kind::Sizes3 => (
            value.as_array().is_some_and(|list| list.len() == 3 && list.iter().all(size)),
            "a list of three whole numbers from 1",
        ),
        Kind::Words => (
            value.is_string() || value.as_array().is_some_and(|list| list.iter().all(Value::is_string)),
            "a list of names",
        ),
        Kind::Bits(names) => (
            value.as_u64() == Some(0)
                || value.as_array().is_some_and(|list| list.iter().all(|value| named(names, value))),
            "a list of flag names of the OpenCL headers, or 0",
        ),
        Kind::Choice(names) => (named(names, value), "one of this query's names in the OpenCL headers"),
    };
    if good { Ok(()) } else { Err(must) }
}

/// As [`check_kind`]; texts of `hardware` are never computed with and may be anything.
fn check_hardware(kind: Kind, value: &Value) -> std::result::Result<(), &'static str> {
    if kind == Kind::Text { Ok(()) } else { check_kind(kind, value) }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn with_limit(key: &str, value: &str) -> Result<Profile> {
        let text = format!(r#"{{"limits":{{"{key}":{{"value":{value},"certainty":"inferred","source":"test"}}}}}}"#);
        Profile::from_json("test.json", &text)
    }

    #[test]
    fn every_embedded_profile_loads_and_gives_evidence() {
        for name in Profile::names() {
            let profile = Profile::named(name).unwrap();
            assert_eq!(profile.name(), name);
            let all = profile.limits().chain(profile.hardware.iter().map(|(key, entry)| (*key, entry)));
            for (key, entry) in all.chain(profile.choices().entries()) {
                let unknown = entry.certainty == Certainty::NotFound;
                assert!(unknown || entry.source.len() > 3, "{name}: {key} has no source");
                assert_eq!(entry.value.is_null(), unknown, "{name}: {key}");
            }
            for key in ["cl_device_max_work_group_size", "cl_device_max_mem_alloc_size", "cl_device_local_mem_size"] {
                assert!(profile.count(key).is_some(), "{name}: {key}");
            }
            assert!(profile.choices().slice_ms().is_some(), "{name}");
            let area = profile.choices().work_group("step1").map(|n| n as u64).iter().product::<u64>();
            assert!(area <= profile.count("cl_device_max_work_group_size").unwrap(), "{name}");
            let again = Profile::from_json(name, &profile.to_json().to_string()).unwrap();
            assert_eq!(again, profile);
        }
    }

    #[test]
    fn the_reference_phone_is_as_documented() {
        let phone = Profile::named("adreno-420").unwrap();
        assert_eq!(phone.choices().work_group("step1"), [8, 8]);
        assert_eq!(phone.count("cl_kernel_work_group_size"), Some(256));
        assert_eq!(phone.sizes("cl_device_max_work_item_sizes"), Some([1024; 3]));
        assert_eq!(phone.hardware("gpu_batch_timeout_ms"), Some(2000));
        assert!(phone.words("cl_device_extensions").unwrap().contains(&"cl_khr_fp16".to_string()));
        assert_eq!(phone.words("cl_device_double_fp_config"), Some(vec![]));
    }

    #[test]
    fn wrong_values_are_refused_with_their_key() {
        for (key, value, must) in [
            ("cl_device_max_mem_alloc_size", "-1", "whole number"),
            ("cl_device_max_mem_alloc_size", "0", "from 1"),
            ("cl_device_max_mem_alloc_size", "1.5", "whole number"),
            ("cl_device_max_mem_alloc_size", "\"much\"", "whole number"),
            ("cl_device_max_work_item_sizes", "[1,2]", "three"),
            ("cl_device_max_work_item_sizes", "[1,2,-3]", "three"),
            ("cl_device_image_support", "1", "true or false"),
            ("cl_device_extensions", "[1]", "names"),
            ("cl_device_type", "\"PHONE\"", "names"),
            ("cl_device_single_fp_config", "[\"CL_FP_MAGIC\"]", "flag names"),
        ] {
            let message = with_limit(key, value).unwrap_err().to_string();
            assert!(message.starts_with("test.json: "), "{message}");
            assert!(message.contains(key) && message.contains(must), "{message}");
        }
        assert!(with_limit("cl_device_max_mem_alloc_size", "1").is_ok());
        assert!(with_limit("cl_device_max_mem_alloc_size", "null").is_ok());
    }

    #[test]
    fn wrong_structure_is_refused() {
        for (text, says) in [
            ("", "not a profile"),
            ("[]", "not a JSON object"),
            ("{}", "missing field `limits`"),
            (r#"{"limits":[]}"#, "p: limits: invalid type: sequence, expected an object"),
            (r#"{"limits":{},"device":1}"#, "p: device: invalid type"),
            (r#"{"limits":{},"colour":1}"#, "unknown field `colour`"),
            (
                r#"{"limits":{"cl_device_nonsense":{"value":1,"certainty":"inferred","source":"-"}}}"#,
                "unknown key `limits.cl_device_nonsense`",
            ),
            (
                r#"{"limits":{"cl_device_name":{"value":"x","certainty":"sure","source":"-"}}}"#,
                "p: limits.cl_device_name.certainty: unknown variant `sure`, expected one of `reported`",
            ),
            (
                r#"{"limits":{"cl_device_name":{"value":"x","certainty":"inferred"}}}"#,
                "p: limits.cl_device_name: missing field `source`",
            ),
            (
                r#"{"limits":{"cl_device_name":{"certainty":"inferred","source":"-"}}}"#,
                "p: limits.cl_device_name: missing field `value`",
            ),
            (
                r#"{"limits":{"cl_device_name":{"value":"x","certainty":"inferred","source":"-","x":1}}}"#,
                "unknown field `x`",
            ),
        ] {
            let message = Profile::from_json("p", text).unwrap_err().to_string();
            assert!(message.contains(says), "{text}: {message}");
        }
        let message = Profile::named("adreno-42").unwrap_err().to_string();
        assert!(message.contains("adreno-420, adreno-530, mali-t880, embedded-floor"), "{message}");
        assert!(Profile::find("none".as_ref()).unwrap().is_none());
    }
}
