// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a caller may ask of loading: budgets, and whether files may lie anywhere.

use std::path::Path;

use crate::{Error, Result};

/// How scenes are loaded. The defaults are for files of one's own.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LoadOptions {
    /// Materials and textures are read from the OBJ file's folder and those within it, wherever names and links lead: for
    /// files from people that are not trusted. Off by default. A [`crate::scene::FileSource`] is asked for nothing else in
    /// any case.
    pub confined: bool,
    /// Most bytes of texels, 4 bytes each, that a scene's textures may have together.
    pub max_texture_bytes: u64,
    /// Most corners of one face.
    pub max_face_corners: usize,
    /// Most names (of objects and groups, materials, textures and MTL files) in a scene's files together.
    pub max_names: usize,
}

impl Default for LoadOptions {
    fn default() -> Self {
        LoadOptions { confined: false, max_texture_bytes: 256 << 20, max_face_corners: 1_000_000, max_names: 1_000_000 }
    }
}

/// Makes room for `more` values, at least 1024, or says that memory does not suffice for what is at `place`.
pub(super) fn reserve<T>(values: &mut Vec<T>, more: usize, place: impl AsRef<Path>) -> Result<()> {
    values.try_reserve_exact(more.max(1024)).map_err(|_| no_memory(place.as_ref(), values.len() + more, size_of::<T>()))
}

/// `count` copies of a value, or says that memory does not suffice for what is at `place`.
pub(super) fn filled<T: Clone>(value: T, count: usize, place: impl AsRef<Path>) -> Result<Vec<T>> {
    let mut values = Vec::new();
    values.try_reserve_exact(count).map_err(|_| no_memory(place.as_ref(), count, size_of::<T>()))?;
    values.resize(count, value);
    Ok(values)
}

fn no_memory(place: &Path, count: usize, size: usize) -> Error {
    let mib = (count as u64).saturating_mul(size as u64) >> 20;
    Error::scene(place.display().to_string(), format!("not enough memory: {count} entries of a list take {mib} MiB"))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn memory_that_cannot_be_had_is_an_error() {
        assert_eq!(filled(7u8, 3, "x").unwrap(), [7; 3]);
        let message = filled(0u32, usize::MAX / 4, "a.obj").unwrap_err().to_string();
        assert!(message.starts_with("a.obj: not enough memory: "), "{message}");
        let mut values = vec![1u64];
        reserve(&mut values, 10, "x").unwrap();
        assert!(values.capacity() > 1000);
        assert!(reserve(&mut values, usize::MAX / 8, "a.obj").is_err());
        assert_eq!(values, [1]);
    }
}
