//! A number for each wheel, without an allocation.

use std::ops::Deref;

use pydslrep_robots::MAX_WHEELS;

/// A number for each wheel of a robot, in the order of its type. It is a slice that is kept where it is used.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PerWheel {
    numbers: [f64; MAX_WHEELS],
    count: usize,
}

impl Deref for PerWheel {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        self.numbers.get(..self.count).unwrap_or_default()
    }
}

impl FromIterator<f64> for PerWheel {
    fn from_iter<T: IntoIterator<Item = f64>>(numbers: T) -> Self {
        let mut all = Self::default();
        all.extend(numbers);
        all
    }
}

impl Extend<f64> for PerWheel {
    /// Numbers beyond [`MAX_WHEELS`] are left out: no robot has as many wheels.
    fn extend<T: IntoIterator<Item = f64>>(&mut self, numbers: T) {
        for (place, number) in self.numbers.iter_mut().skip(self.count).zip(numbers) {
            *place = number;
            self.count += 1;
        }
    }
}

impl<'a> IntoIterator for &'a PerWheel {
    type Item = &'a f64;
    type IntoIter = std::slice::Iter<'a, f64>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn has_as_many_numbers_as_it_was_given() {
        let of = |count: u8| (0..count).map(f64::from).collect::<PerWheel>();
        assert_eq!(of(0).to_vec(), []);
        assert_eq!(of(2).to_vec(), [0.0, 1.0]);
        assert_eq!(of(9).len(), MAX_WHEELS);
        assert_ne!(of(1), of(0), "0 is a number");
    }
}
