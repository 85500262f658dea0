//! Reproducible noise: the same seed gives the same run.

use pydslrep_scene::Noise;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};

/// The time constant of slip, seconds: floor and tyres vary slowly, not from step to step.
const SLIP_TIME: f64 = 1.0;

/// The part of a stream reserved for each reading; one uses a few words.
const WORDS_PER_READING: u128 = 256;

/// The first stream for wheels; sensors use those below.
const WHEELS: u64 = 1 << 48;

/// The generator of a wheel or sensor; all are independent.
fn generator(seed: u64, kind: u64, robot: usize, part: usize) -> ChaCha8Rng {
    let number = |index: usize| u64::try_from(index).unwrap_or(u64::MAX) & 0xff_ffff;
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    generator.set_stream(kind | number(robot) << 24 | number(part));
    generator
}

/// The slip of a wheel over time: an Ornstein-Uhlenbeck process with a given standard deviation and a correlation time
/// of about a second.
#[derive(Debug, Clone)]
pub(super) struct Slip {
    generator: ChaCha8Rng,
    deviation: f64,
    /// The relative gain of distance on the floor; negative for loss.
    pub(super) value: f64,
}

impl Slip {
    pub(super) fn new(noise: Option<Noise>, seed: u64, robot: usize, wheel: usize) -> Self {
        let deviation = noise.map_or(0.0, |noise| noise.wheel_slip);
        let mut slip = Self { generator: generator(seed, WHEELS, robot, wheel), deviation, value: 0.0 };
        slip.draw(1.0);
        slip
    }

    pub(super) fn advance(&mut self, seconds: f64) {
        let kept = (-seconds / SLIP_TIME).exp();
        self.value *= kept;
        self.draw((1.0 - kept * kept).sqrt());
    }

    fn draw(&mut self, share: f64) {
        if self.deviation > 0.0 {
            let drawn: f64 = StandardNormal.sample(&mut self.generator);
            // A wheel cannot lose more than the distance it rolls.
            self.value = (self.value + share * self.deviation * drawn).clamp(-1.0, 1.0);
        }
    }
}

/// The error of a sensor's reading after a number of steps, metres. Reading has no side effects.
pub(super) fn reading_error(noise: Option<Noise>, seed: u64, robot: usize, sensor: usize, steps: u64) -> f64 {
    let Some(noise) = noise.filter(|noise| noise.sensor > 0.0) else { return 0.0 };
    let mut generator = generator(seed, 0, robot, sensor);
    generator.set_word_pos(u128::from(steps) * WORDS_PER_READING);
    let drawn: f64 = StandardNormal.sample(&mut generator);
    drawn * noise.sensor
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOISE: Option<Noise> =
        Some(Noise { wheel_slip: 0.02, track_error: 0.0, radius_error: 0.0, sensor: 0.01 });

    #[allow(clippy::cast_precision_loss)]
    fn mean(values: &[f64]) -> f64 {
        values.iter().sum::<f64>() / values.len() as f64
    }

    fn deviation(values: &[f64]) -> f64 {
        mean(&values.iter().map(|value| value * value).collect::<Vec<_>>()).sqrt()
    }

    #[test]
    fn slip_has_its_deviation_and_changes_slowly() {
        let mut slip = Slip::new(NOISE, 1, 0, 0);
        let mut values = vec![slip.value];
        values.extend((0..200_000).map(|_| {
            slip.advance(0.05);
            slip.value
        }));
        assert!((deviation(&values) - 0.02).abs() < 0.0005, "{}", deviation(&values));
        // Of each value e^(−0.05) is left in the next; the rest is new, and independent.
        let kept = (-0.05_f64).exp();
        let new: Vec<f64> = values.windows(2).map(|pair| pair[1] - kept * pair[0]).collect();
        let expected = 0.02 * (1.0 - kept * kept).sqrt();
        assert!((deviation(&new) / expected - 1.0).abs() < 0.01, "{}", deviation(&new));
        assert!(mean(&new).abs() < 0.01 * expected, "{}", mean(&new));
        let together: Vec<f64> = new.iter().zip(&values).map(|(new, before)| new * before).collect();
        assert!(mean(&together).abs() < 0.01 * 0.02 * expected, "{}", mean(&together));
    }

    #[test]
    fn the_first_slip_has_its_deviation_too() {
        let first: Vec<f64> = (0..20_000).map(|seed| Slip::new(NOISE, seed, 0, 0).value).collect();
        assert!((deviation(&first) / 0.02 - 1.0).abs() < 0.015, "{}", deviation(&first));
    }

    #[test]
    fn readings_have_their_deviation_and_are_the_same_each_time() {
        let readings =
            |seed, count| (0..count).map(|steps| reading_error(NOISE, seed, 0, 0, steps)).collect::<Vec<_>>();
        let many = readings(1, 20_000);
        let (deviation, mean) = (deviation(&many), mean(&many));
        assert!((deviation / 0.01 - 1.0).abs() < 0.015 && mean.abs() < 0.015 * 0.01, "{deviation} {mean}");
        assert_eq!(readings(1, 9), readings(1, 9));
        assert_ne!(readings(1, 9), readings(2, 9));
        let of = |robot, sensor| reading_error(NOISE, 1, robot, sensor, 7);
        assert!((of(0, 0) - of(0, 1)).abs() > 1e-9 && (of(0, 0) - of(1, 0)).abs() > 1e-9);
    }

    #[test]
    fn without_noise_there_are_no_errors() {
        let mut slip = Slip::new(None, 1, 0, 0);
        slip.advance(1.0);
        assert!(slip.value == 0.0 && reading_error(None, 1, 0, 0, 3) == 0.0);
    }
}
