// SPDX-License-Identifier: MIT OR Apache-2.0
//! What suits a device: shapes and variants that the pipeline would otherwise have to guess.

use serde::Serialize;
use serde_json::Value;

use super::file::{self, Entries};
use super::{Certainty, Entry, bad, checked};
use crate::Result;
pub use crate::layout::Traversal;
use crate::names::named;
use crate::settings::list;

/// Where nodes and triangles lie in device memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum MemoryPath {
    /// In buffers.
    #[default]
    Buffers,
    /// In images, which many phones cache closer to the arithmetic.
    Images,
}

named!(MemoryPath of MemoryPath { Buffers = "buffers", Images = "images" });

/// The choices of a profile.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
#[serde(transparent)]
pub struct Choices {
    #[serde(serialize_with = "file::as_object")]
    entries: Vec<(&'static str, Entry)>,
}

const KEYS: [&str; 5] = ["work_group", "memory_path", "traversal", "lanes", "slice_ms"];

impl Choices {
    /// The shape of a stage's work-groups, width then height, in work-items: 8x8 where the profile says nothing.
    pub fn work_group(&self, stage: &str) -> [usize; 2] {
        let shapes = self.value("work_group");
        let shape = shapes.and_then(|shapes| shapes.get(stage).or_else(|| shapes.get("default")));
        let side = |axis: usize| shape.and_then(|shape| usize::try_from(shape.get(axis)?.as_u64()?).ok());
        match (side(0), side(1)) {
            (Some(width), Some(height)) => [width, height],
            _ => [8, 8],
        }
    }

    /// Where nodes and triangles lie.
    pub fn memory_path(&self) -> MemoryPath {
        self.word("memory_path")
    }

    /// How kernels walk the kd-tree.
    pub fn traversal(&self) -> Traversal {
        self.word("traversal")
    }

    /// Rays per work-item: 1 where the profile says nothing.
    pub fn lanes(&self) -> u32 {
        self.value("lanes").and_then(Value::as_u64).and_then(|lanes| u32::try_from(lanes).ok()).unwrap_or(1)
    }

    /// The longest that one enqueue should take, in milliseconds.
    pub fn slice_ms(&self) -> Option<f64> {
        self.value("slice_ms").and_then(Value::as_f64)
    }

    /// All entries with their evidence, in the file's order.
    pub fn entries(&self) -> impl Iterator<Item = (&'static str, &Entry)> {
        self.entries.iter().map(|(key, entry)| (*key, entry))
    }

    fn value(&self, key: &str) -> Option<&Value> {
        self.entries.iter().find(|(known, _)| *known == key).map(|(_, entry)| &entry.value)
    }

    fn word<T: std::str::FromStr + Default>(&self, key: &str) -> T {
        let word = self.value(key).and_then(Value::as_str);
        word.and_then(|word| word.parse().ok()).unwrap_or_default()
    }

    /// The choices for a device that no profile describes.
    pub(crate) fn for_device(gpu: bool, slice_ms: Option<f64>) -> Self {
        let make = |value: Value| Entry {
            value,
            certainty: Certainty::Inferred,
            source: "default for this type of device".into(),
            note: String::new(),
        };
        let mut entries = vec![
            ("work_group", make(serde_json::json!({ "default": [8, 8] }))),
            ("memory_path", make("buffers".into())),
            ("traversal", make(if gpu { "short-stack" } else { "private-stack" }.into())),
        ];
        if let Some(ms) = slice_ms {
            entries.push(("slice_ms", make(ms.into())));
        }
        Choices { entries }
    }

    pub(super) fn of_file(place: &str, file: Entries) -> Result<Self> {
        let mut entries = Vec::new();
        for (key, entry) in file {
            let known = KEYS.into_iter().find(|known| *known == key);
            let known = known
                .ok_or_else(|| bad(place, format!("unknown key `choices.{key}`; there are {}", KEYS.join(", "))))?;
            entries.push((known, checked(place, &format!("choices.{key}"), entry, |value| check(known, value))?));
        }
        Ok(Choices { entries })
    }
}

fn check(key: &str, value: &Value) -> std::result::Result<(), String> {
    // In lower case, as they are written.
    let word = |names: &[&str]| match value.as_str() {
        Some(text) if names.contains(&text) => Ok(()),
        _ => Err(list(names)),
    };
    let shape = |value: &Value| {
        let side = |value: &Value| value.as_u64().is_some_and(|side| (1..=4096).contains(&side));
        value.as_array().is_some_and(|sides| sides.len() == 2 && sides.iter().all(side))
    };
    let (good, must) = match key {
        "work_group" => (
            value.as_object().is_some_and(|map| {
                map.iter().all(|(stage, value)| (stage == "default" || stage.starts_with("step")) && shape(value))
            }),
            "an object of `default` and stages such as `step1`, each [width, height] from 1 to 4096",
        ),
        "memory_path" => return word(&MemoryPath::NAMES),
        "traversal" => return word(&Traversal::NAMES),
        "lanes" => (value.as_u64().is_some_and(|lanes| [1, 4, 8, 16].contains(&lanes)), "1, 4, 8 or 16"),
        _ => (
            value.as_f64().is_some_and(|ms| (0.1..=10_000.0).contains(&ms)),
            "a number of milliseconds from 0.1 to 10000",
        ),
    };
    if good { Ok(()) } else { Err(must.to_owned()) }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::device::profiles::Profile;

    fn with_choice(key: &str, value: &str) -> Result<Profile> {
        let text = format!(
            r#"{{"limits":{{}},"choices":{{"{key}":{{"value":{value},"certainty":"inferred","source":"-"}}}}}}"#
        );
        Profile::from_json("p", &text)
    }

    #[test]
    fn choices_are_read_per_stage() {
        let profile = with_choice("work_group", r#"{"default":[8,8],"step2a":[64,1]}"#).unwrap();
        assert_eq!(profile.choices().work_group("step1"), [8, 8]);
        assert_eq!(profile.choices().work_group("step2a"), [64, 1]);
        assert_eq!(with_choice("traversal", "\"stackless\"").unwrap().choices().traversal(), Traversal::Stackless);
        assert_eq!(with_choice("memory_path", "\"images\"").unwrap().choices().memory_path(), MemoryPath::Images);
    }

    #[test]
    fn wrong_choices_are_refused() {
        for (key, value) in [
            ("work_group", r#"{"default":[8,0]}"#),
            ("work_group", r#"{"stage1":[8,8]}"#),
            ("work_group", "[8,8]"),
            ("memory_path", "\"cloud\""),
            ("traversal", "1"),
            ("lanes", "3"),
            ("slice_ms", "-5"),
            ("slice_ms", "1e9"),
            ("slicems", "5"),
        ] {
            let message = with_choice(key, value).unwrap_err().to_string();
            assert!(message.contains(&format!("choices.{key}")), "{message}");
        }
    }
}
