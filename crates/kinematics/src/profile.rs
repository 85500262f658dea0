//! Speed over time of one action: up a ramp, along, down a ramp.

/// A trapezoid speed profile that starts and ends at rest; a triangle where the way is too short to reach
/// full speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpeedProfile {
    distance: f64,
    acceleration: f64,
    peak: f64,
}

impl SpeedProfile {
    /// The profile over `distance` metres at up to `speed` m/s with `acceleration` m/s². Signs are dropped; a
    /// speed or acceleration that is not above zero never gets there: its duration is infinite.
    pub fn new(distance: f64, speed: f64, acceleration: f64) -> Self {
        let (distance, acceleration) = (distance.abs(), acceleration.abs());
        Self { distance, acceleration, peak: speed.abs().min((distance * acceleration).sqrt()) }
    }

    /// The highest speed reached, metres per second.
    pub fn peak(&self) -> f64 {
        self.peak
    }

    /// Seconds from rest to rest.
    pub fn duration(&self) -> f64 {
        if self.distance == 0.0 {
            return 0.0;
        }
        if self.peak == 0.0 {
            return f64::INFINITY;
        }
        self.distance / self.peak + self.peak / self.acceleration
    }

    /// The way covered `seconds` after the start, metres; 0 before it, the whole distance after the end.
    pub fn distance_at(&self, seconds: f64) -> f64 {
        let (duration, ramp) = (self.duration(), self.peak / self.acceleration);
        if seconds <= 0.0 || self.peak == 0.0 {
            0.0
        } else if seconds >= duration {
            self.distance
        } else if seconds < ramp {
            self.acceleration * seconds * seconds / 2.0
        } else if seconds <= duration - ramp {
            self.peak * (seconds - ramp / 2.0)
        } else {
            let left = duration - seconds;
            self.distance - self.acceleration * left * left / 2.0
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn a_metre_at_the_default_speed() {
        let profile = SpeedProfile::new(-1.0, 0.09, 0.5);
        assert!((profile.duration() - (1.0 / 0.09 + 0.18)).abs() < 1e-12);
        assert!((profile.peak() - 0.09).abs() < 1e-15);
    }

    #[test]
    fn too_short_to_reach_full_speed() {
        let profile = SpeedProfile::new(0.08, 1.0, 0.5);
        assert!((profile.peak() - 0.2).abs() < 1e-15);
        assert!((profile.duration() - 0.8).abs() < 1e-15);
        assert!((profile.distance_at(0.4) - 0.04).abs() < 1e-15);
    }

    #[test]
    fn signs_are_dropped_and_without_speed_it_never_gets_there() {
        assert_eq!(SpeedProfile::new(-1.0, -0.09, -0.5), SpeedProfile::new(1.0, 0.09, 0.5));
        for stuck in [SpeedProfile::new(1.0, 0.0, 0.5), SpeedProfile::new(1.0, 0.09, 0.0)] {
            assert!(stuck.duration().is_infinite() && stuck.distance_at(1e9) == 0.0, "{stuck:?}");
        }
    }

    #[test]
    fn nothing_to_do_takes_no_time() {
        assert!(SpeedProfile::new(0.0, 0.09, 0.5).duration() == 0.0);
    }

    proptest! {
        #[test]
        fn never_too_fast_and_never_backwards(distance in 0.001..10.0, speed in 0.01..2.0, acceleration in 0.05..2.0) {
            let profile = SpeedProfile::new(distance, speed, acceleration);
            let steps = 500;
            let dt = profile.duration() / f64::from(steps);
            let mut last = 0.0;
            for i in 1..=steps {
                let here = profile.distance_at(f64::from(i) * dt);
                prop_assert!(here >= last - 1e-12);
                prop_assert!(here - last <= speed * dt + 1e-9);
                last = here;
            }
            prop_assert!((last - distance).abs() < 1e-9);
        }
    }
}
