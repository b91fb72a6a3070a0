// SPDX-License-Identifier: MIT OR Apache-2.0
//! Memory whose size comes from files or options: where it cannot be had, that is an error and not the end of the process.

use crate::{Error, Result};

/// An empty vector with room for `count` values, for `what`.
///
/// # Errors
/// [`Error::OutOfMemory`].
pub(crate) fn with_room<T>(what: &str, count: usize) -> Result<Vec<T>> {
    let mut values = Vec::new();
    make_room(what, &mut values, count)?;
    Ok(values)
}

/// A vector of `count` times `value`, for `what`.
///
/// # Errors
/// [`Error::OutOfMemory`].
pub(crate) fn filled<T: Clone>(what: &str, count: usize, value: T) -> Result<Vec<T>> {
    let mut values = with_room(what, count)?;
    values.resize(count, value);
    Ok(values)
}

/// The values of an iterator that says how many they are, for `what`.
///
/// # Errors
/// [`Error::OutOfMemory`].
pub(crate) fn collected<T>(what: &str, values: impl ExactSizeIterator<Item = T>) -> Result<Vec<T>> {
    let mut all = with_room(what, values.len())?;
    all.extend(values);
    Ok(all)
}

/// Makes room for `count` more values in a vector, for `what`.
///
/// # Errors
/// [`Error::OutOfMemory`].
pub(crate) fn make_room<T>(what: &str, values: &mut Vec<T>, count: usize) -> Result<()> {
    values.try_reserve_exact(count).map_err(|_| out_of_memory::<T>(what, count))
}

/// The error of `count` values that there is no memory for.
pub(crate) fn out_of_memory<T>(what: &str, count: usize) -> Error {
    Error::OutOfMemory { what: what.to_owned(), bytes: (count as u64).saturating_mul(size_of::<T>() as u64) }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn what_fits_is_there_and_what_does_not_is_an_error_with_its_size() {
        assert_eq!(filled("ones", 3, 1u8).unwrap(), [1, 1, 1]);
        assert_eq!(collected("squares", (0..4).map(|x| x * x)).unwrap(), [0, 1, 4, 9]);
        assert!(with_room::<u32>("words", 5).unwrap().capacity() >= 5);
        // No allocation is larger than half of the address space, however wide addresses are.
        let most = usize::MAX / 4;
        let message = with_room::<u32>("the planes", most).unwrap_err().to_string();
        assert_eq!(message, format!("not enough memory for the planes: {} bytes", 4 * most as u64));
        assert!(matches!(filled("words", usize::MAX, 0u32), Err(Error::OutOfMemory { .. })));
        let mut words = vec![1u32];
        assert!(make_room("words", &mut words, usize::MAX).is_err());
        assert_eq!(words, [1]);
    }
}
