//! What is asked of a type of robot, and which type wheels make.

use crate::Drive;

impl Drive {
    /// As programs spell it.
    pub const fn word(self) -> &'static str {
        self.row().word
    }

    /// The type that programs spell so.
    pub fn from_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|drive| drive.word() == word)
    }

    /// Returns the number of its driven wheels.
    pub const fn wheel_count(self) -> usize {
        self.row().wheels.len()
    }

    /// The type that wheels make by their number and kind: of each, whether it is a mecanum wheel.
    pub fn from_wheels(mecanum: &[bool]) -> Option<Self> {
        Self::with_wheels(mecanum.len())
            .find(|drive| mecanum.iter().all(|&mecanum| mecanum == drive.row().mecanum))
    }

    /// The type that a robot without one is driven as. Wheels of several kinds are driven as the first type with as many.
    /// `all_mecanum` is asked only if it matters.
    pub fn inferred(wheels: usize, all_mecanum: impl FnOnce() -> bool) -> Option<Self> {
        let mut fitting = Self::with_wheels(wheels);
        let first = fitting.next()?;
        if fitting.next().is_none() {
            return Some(first);
        }
        let mecanum = all_mecanum();
        Some(Self::with_wheels(wheels).find(|drive| drive.row().mecanum == mecanum).unwrap_or(first))
    }

    /// The type that a robot of this one is driven as: another if it lists mecanum wheels only, as in the article.
    /// `all_mecanum` is asked only if it matters.
    #[must_use]
    pub fn driven(self, all_mecanum: impl FnOnce() -> bool) -> Self {
        self.row().on_mecanum.filter(|_| all_mecanum()).unwrap_or(self)
    }

    /// The types with so many wheels.
    pub fn with_wheels(count: usize) -> impl Iterator<Item = Self> {
        Self::ALL.into_iter().filter(move |drive| drive.wheel_count() == count)
    }

    /// The numbers of wheels that robots can have, ascending.
    pub fn wheel_counts() -> Vec<usize> {
        let mut counts = Self::ALL.map(Self::wheel_count).to_vec();
        counts.sort_unstable();
        counts.dedup();
        counts
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_tell_types_apart() {
        for drive in Drive::ALL {
            assert_eq!(Drive::from_word(drive.word()), Some(drive));
            assert_eq!(drive.row().drive, drive, "each has a row of its own");
        }
        assert_eq!(Drive::from_word("hexapod"), None);
    }

    #[test]
    fn wheels_make_a_type() {
        for drive in Drive::ALL {
            assert_eq!(Drive::from_wheels(&vec![drive.row().mecanum; drive.wheel_count()]), Some(drive));
            assert!(Drive::wheel_counts().contains(&drive.wheel_count()));
        }
        assert!(Drive::wheel_counts().is_sorted());
        assert_eq!(Drive::from_wheels(&[true; 2]), None);
        assert_eq!(Drive::from_wheels(&[true, false, false, false]), None);
        assert_eq!(Drive::from_wheels(&[]), None);
    }

    #[test]
    fn what_is_listed_decides_how_it_is_driven() {
        let unasked = || unreachable!("there is no other type");
        assert_eq!(Drive::inferred(2, unasked), Some(Drive::TwoWheel));
        assert_eq!(Drive::inferred(4, || false), Some(Drive::FourWheel));
        assert_eq!(Drive::inferred(4, || true), Some(Drive::Mecanum));
        assert_eq!(Drive::inferred(3, unasked), None);
        assert_eq!(Drive::FourWheel.driven(|| true), Drive::Mecanum);
        assert_eq!(Drive::FourWheel.driven(|| false), Drive::FourWheel);
        assert_eq!(Drive::TwoWheel.driven(unasked), Drive::TwoWheel);
    }
}
