//! Reproducible noise: the same seed gives the same run.

use pydslrep_scene::Noise;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal, Uniform};

/// The time constant of slip, seconds: floor and tyres vary slowly, not from step to step.
const SLIP_TIME: f64 = 1.0;

/// The part of a stream reserved for each reading; one uses a few words.
const WORDS_PER_READING: u128 = 256;

/// The first stream for wheels; sensors use those below.
const WHEELS: u64 = 1 << 48;

/// The first stream for what an engine does to bodies.
const BODIES: u64 = 1 << 49;

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

/// Three numbers from −1 to 1 for a robot after a number of steps. Reading has no side effects.
pub(super) fn body_error(seed: u64, robot: usize, steps: u64) -> [f64; 3] {
    let mut generator = generator(seed, BODIES, robot, 0);
    generator.set_word_pos(u128::from(steps) * WORDS_PER_READING);
    let uniform = Uniform::new_inclusive(-1.0, 1.0);
    std::array::from_fn(|_| uniform.as_ref().map_or(0.0, |uniform| uniform.sample(&mut generator)))
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOISE: Option<Noise> = Some(Noise { wheel_slip: 0.02, sensor: 0.01 });

    fn deviation(values: &[f64]) -> f64 {
        #[allow(clippy::cast_precision_loss)]
        let count = values.len() as f64;
        (values.iter().map(|value| value * value).sum::<f64>() / count).sqrt()
    }

    #[test]
    fn slip_has_its_deviation_and_changes_slowly() {
        let mut slip = Slip::new(NOISE, 1, 0, 0);
        let values: Vec<f64> = (0..200_000)
            .map(|_| {
                slip.advance(0.05);
                slip.value
            })
            .collect();
        assert!((deviation(&values) - 0.02).abs() < 0.001, "{}", deviation(&values));
        let changes: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
        // √(2 (1 − e^(−0.05))) of the deviation.
        assert!((deviation(&changes) - 0.02 * 0.3123).abs() < 0.0005, "{}", deviation(&changes));
    }

    #[test]
    fn readings_have_their_deviation_and_are_the_same_each_time() {
        let readings =
            |seed| (0..5000).map(|steps| reading_error(NOISE, seed, 0, 0, steps)).collect::<Vec<_>>();
        assert!((deviation(&readings(1)) - 0.01).abs() < 0.0005, "{}", deviation(&readings(1)));
        assert_eq!(readings(1), readings(1));
        assert_ne!(readings(1), readings(2));
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
