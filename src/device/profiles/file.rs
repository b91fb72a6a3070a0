// SPDX-License-Identifier: MIT OR Apache-2.0
//! The form of a profile's file, before keys and values are checked against the queries that there are.

use serde::de::{Deserialize, Deserializer, IgnoredAny, MapAccess, Visitor};
use serde::ser::Serializer;
use serde_json::Value;

use super::Entry;
use crate::{Error, Result};

/// A profile as its file has it.
#[derive(Debug, serde::Deserialize)]
#[serde(deny_unknown_fields, expecting = "a JSON object")]
pub(super) struct ProfileFile {
    pub device: Option<String>,
    /// For people.
    #[serde(rename = "status")]
    _status: Option<String>,
    /// For people.
    #[serde(rename = "compiled")]
    _compiled: Option<String>,
    /// Documents the words; the words themselves are fixed.
    #[serde(rename = "certainty_values")]
    _certainty_values: Option<IgnoredAny>,
    #[serde(deserialize_with = "in_order")]
    pub limits: Entries,
    #[serde(default, deserialize_with = "in_order")]
    pub hardware: Entries,
    #[serde(default, deserialize_with = "in_order")]
    pub choices: Entries,
}

/// Entries by key, in the file's order.
pub(super) type Entries = Vec<(String, Entry)>;

/// The profile in `value`; `place` is named in errors, before the path of what is wrong.
pub(super) fn parse(place: &str, value: &Value) -> Result<ProfileFile> {
    if !value.is_object() {
        return Err(super::bad(place, "not a JSON object"));
    }
    serde_path_to_error::deserialize(value).map_err(|error| {
        let path = error.path().to_string();
        let why = error.into_inner();
        let place = if path == "." { place.to_owned() } else { format!("{place}: {path}") };
        Error::profile(place, why.to_string())
    })
}

fn in_order<'de, D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Entries, D::Error> {
    struct InOrder;
    impl<'de> Visitor<'de> for InOrder {
        type Value = Entries;

        fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
            f.write_str("an object of entries, each with `value`, `certainty` and `source`")
        }

        fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> std::result::Result<Entries, A::Error> {
            let mut entries = Vec::new();
            while let Some(entry) = map.next_entry()? {
                entries.push(entry);
            }
            Ok(entries)
        }
    }
    deserializer.deserialize_map(InOrder)
}

/// A value that may be `null`, but not absent.
pub(super) fn present<'de, D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Value, D::Error> {
    Value::deserialize(deserializer)
}

/// Writes entries as an object.
pub(super) fn as_object<S: Serializer>(
    entries: &[(&'static str, Entry)],
    serializer: S,
) -> std::result::Result<S::Ok, S::Error> {
    serializer.collect_map(entries.iter().map(|(key, entry)| (key, entry)))
}
