//! From the motion of a body to what its robot has to set, and back.

use std::fmt;

use pydslrep_robots::{Drive, WheelPlace};

use crate::{PerWheel, Twist};

/// The distances between a robot's wheels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Geometry {
    /// Distance between left and right wheels (d of equations 1 to 6), metres.
    pub track: f64,
    /// Distance between front and rear wheels, metres; without meaning for two wheels.
    pub wheelbase: f64,
}

impl Geometry {
    /// Where the wheels are in the body's frame, (x, y) in metres, in the order of the type.
    pub fn wheel_positions(self, drive: Drive) -> impl ExactSizeIterator<Item = (f64, f64)> {
        drive.row().wheels.iter().map(move |wheel| self.position(wheel))
    }

    pub(crate) fn position(self, wheel: &WheelPlace) -> (f64, f64) {
        (wheel.ahead * self.wheelbase / 2.0, wheel.left * self.track / 2.0)
    }
}

/// The kinematic model of one robot: what it has to set for a twist, the twist for what is set, and how it turns.
///
/// Plans and the simulator ask a model, never a robot's type.
#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    drive: Drive,
    geometry: Geometry,
    radii: PerWheel,
    /// Rim speeds for a unit of vx, vy and ω.
    rim_per_twist: [PerWheel; 3],
    turning: Turning,
}

/// The rates and angles that are set on a robot, or measured: as many of each as its model says ([`Model::settable`]).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Setting {
    /// The rates of its wheels, rad/s, in the order of its type.
    pub rates: PerWheel,
    /// The angles of the wheels that steer, radians, counter-clockwise, in the same order.
    pub steering: PerWheel,
}

impl Setting {
    /// Of a robot none of whose wheels steers.
    pub fn of_rates(rates: &[f64]) -> Self {
        Self { rates: rates.iter().copied().collect(), steering: PerWheel::default() }
    }
}

/// The number of rates and of angles that a model can set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Settable {
    /// Rates of wheels.
    pub rates: usize,
    /// Angles of wheels that steer.
    pub steering: usize,
}

/// The way in which a robot turns if nothing but an angle is given.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Turning {
    /// About its own middle.
    InPlace,
    /// On a circle, ahead: it cannot turn otherwise.
    OnCircle {
        /// Metres, above zero.
        radius: f64,
    },
}

impl Turning {
    /// The twist that turns by a radian per second, to the left for a positive `side`.
    pub fn twist(self, side: f64) -> Twist {
        let vx = match self {
            Self::InPlace => 0.0,
            Self::OnCircle { radius } => radius,
        };
        Twist { vx, vy: 0.0, omega: side.signum() }
    }
}

/// Why there is no model for these figures.
#[derive(Debug, Clone, PartialEq)]
pub enum ModelError {
    /// The layout has another number of wheels than there are radii.
    WheelCount {
        /// The number of wheels of the layout.
        expected: usize,
        /// The number of radii given.
        found: usize,
    },
    /// A length or factor is not a finite number above zero.
    NotPositive {
        /// Which one.
        what: &'static str,
        /// The invalid value.
        value: f64,
    },
}

impl fmt::Display for ModelError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::WheelCount { expected, found } => {
                write!(f, "this layout has {expected} wheels, but {found} wheel radii are given")
            }
            Self::NotPositive { what, value } => write!(f, "the {what} must be above zero, it is {value}"),
        }
    }
}

impl std::error::Error for ModelError {}

impl Model {
    /// The ideal model of a robot with these wheel radii (metres, in the order of its type) and geometry: no wheel
    /// slips or scrubs.
    ///
    /// # Errors
    /// When the number of radii does not fit the type or a length is not above zero.
    pub fn new(drive: Drive, radii: &[f64], geometry: Geometry) -> Result<Self, ModelError> {
        if radii.len() != drive.wheel_count() {
            return Err(ModelError::WheelCount { expected: drive.wheel_count(), found: radii.len() });
        }
        for &radius in radii {
            require_positive("wheel radius", radius)?;
        }
        require_positive("track", geometry.track)?;
        if drive.row().has_wheelbase() {
            require_positive("wheelbase", geometry.wheelbase)?;
        }
        let radii = radii.iter().copied().collect();
        let rim_per_twist = rim_per_twist(drive, geometry, 1.0);
        Ok(Self { drive, geometry, radii, rim_per_twist, turning: Turning::InPlace })
    }

    /// The same robot with an effective track of `factor` times the geometric one. Only wheels that scrub
    /// ([`pydslrep_robots::RobotType::scrubs`]) widen it; for other types the model stays as it is.
    ///
    /// # Errors
    /// When the factor is not above zero.
    pub fn with_scrub_factor(mut self, factor: f64) -> Result<Self, ModelError> {
        require_positive("scrub factor", factor)?;
        if self.drive.row().scrubs() {
            self.rim_per_twist = rim_per_twist(self.drive, self.geometry, factor);
        }
        Ok(self)
    }

    /// The type of the robot.
    pub fn drive(&self) -> Drive {
        self.drive
    }

    /// The geometry the model was made from.
    pub fn geometry(&self) -> Geometry {
        self.geometry
    }

    /// Wheel radii in metres, in the order of the type.
    pub fn radii(&self) -> &[f64] {
        &self.radii
    }

    /// Returns the number of rates and of angles that it can set.
    pub fn settable(&self) -> Settable {
        Settable { rates: self.radii.len(), steering: 0 }
    }

    /// Returns the way in which it turns.
    pub fn turning(&self) -> Turning {
        self.turning
    }

    /// Returns the setting for a twist.
    ///
    /// Rim speeds are v ± ω d/2 (equations 1 to 6 of the article), for mecanum wheels lf = vx − vy − Kω,
    /// rf = vx + vy + Kω, lr = vx + vy − Kω, rr = vx − vy + Kω with K = (wheelbase + track)/2 (Lynch and Park,
    /// "Modern Robotics", 13.2); each is divided by that wheel's own radius. Robots that cannot move sideways
    /// ignore `vy`.
    pub fn inverse(&self, twist: Twist) -> Setting {
        let rates = self.rim_speeds(twist).zip(&self.radii).map(|(rim, radius)| rim / radius);
        Setting { rates: rates.collect(), steering: PerWheel::default() }
    }

    /// The twist for what is set; missing rates count as 0.
    ///
    /// v = (right + left)/2 and ω = (right − left)/d of the rim speeds (equations 1 to 6 of the article); with more
    /// wheels than degrees of freedom the least-squares solution.
    pub fn forward(&self, setting: &Setting) -> Twist {
        let rims = setting.rates.iter().zip(&self.radii).map(|(rate, radius)| rate * radius);
        let rims: PerWheel = rims.collect();
        // The columns are orthogonal, so the pseudo-inverse is a projection on each of them.
        let [vx, vy, omega] = self.rim_per_twist.map(|column| {
            let weight = dot(&column, &column);
            if weight == 0.0 { 0.0 } else { dot(&column, &rims) / weight }
        });
        Twist { vx, vy, omega }
    }

    /// Rim speed of the fastest wheel for a twist, in metres per second.
    pub fn fastest_rim(&self, twist: Twist) -> f64 {
        self.rim_speeds(twist).fold(0.0, |most: f64, rim| most.max(rim.abs()))
    }

    fn rim_speeds(&self, twist: Twist) -> impl Iterator<Item = f64> {
        let [vx, vy, omega] = &self.rim_per_twist;
        vx.iter()
            .zip(vy)
            .zip(omega)
            .map(move |((vx, vy), omega)| vx * twist.vx + vy * twist.vy + omega * twist.omega)
    }
}

/// The rim speeds of wheels at (x, y) are vx − ωy where wheels push along themselves. Where rollers make them push to the
/// side as much as ahead, they are vx ± vy + ω(±x − y), since the point of contact moves sideways by vy + ωx.
fn rim_per_twist(drive: Drive, geometry: Geometry, scrub: f64) -> [PerWheel; 3] {
    let wheels = drive.row().wheels;
    let turn = |wheel: &WheelPlace| {
        let (x, y) = geometry.position(wheel);
        wheel.push * x - y * scrub
    };
    [
        wheels.iter().map(|_| 1.0).collect(),
        wheels.iter().map(|wheel| wheel.push).collect(),
        wheels.iter().map(turn).collect(),
    ]
}

fn dot(a: &PerWheel, b: &PerWheel) -> f64 {
    a.iter().zip(b).fold(0.0, |sum, (a, b)| sum + a * b)
}

fn require_positive(what: &'static str, value: f64) -> Result<(), ModelError> {
    if value.is_finite() && value > 0.0 { Ok(()) } else { Err(ModelError::NotPositive { what, value }) }
}

#[cfg(test)]
pub(crate) mod tests {
    use proptest::prelude::*;
    use pydslrep_robots::MAX_WHEELS;

    use super::*;

    const GEOMETRY: Geometry = Geometry { track: 0.30, wheelbase: 0.25 };

    fn close(a: f64, b: f64) -> bool {
        (a - b).abs() <= 1e-12 * (1.0 + b.abs())
    }

    #[test]
    fn differential_by_hand() {
        let model = Model::new(Drive::TwoWheel, &[0.1, 0.1], GEOMETRY).unwrap();
        let rates = model.inverse(Twist { vx: 0.1, vy: 0.0, omega: 1.0 }).rates;
        assert!(close(rates[0], -0.5) && close(rates[1], 2.5), "{rates:?}");
        let twist = model.forward(&Setting::of_rates(&[1.0, 2.0]));
        assert!(close(twist.vx, 0.15) && twist.vy == 0.0 && close(twist.omega, 0.1 / 0.30), "{twist:?}");
    }

    #[test]
    fn unequal_wheels_turn_at_equal_rim_speed() {
        let model = Model::new(Drive::FourWheel, &[0.1, 0.05, 0.1, 0.05], GEOMETRY).unwrap();
        let rates = model.inverse(Twist { vx: 0.1, vy: 0.0, omega: 0.0 }).rates;
        assert!(rates.iter().zip([1.0, 2.0, 1.0, 2.0]).all(|(&a, b)| close(a, b)), "{rates:?}");
    }

    #[test]
    fn mecanum_drives_sideways() {
        let model = Model::new(Drive::Mecanum, &[0.1; 4], GEOMETRY).unwrap();
        let rates = model.inverse(Twist { vx: 0.0, vy: 0.1, omega: 0.0 }).rates;
        assert!(rates.iter().zip([-1.0, 1.0, 1.0, -1.0]).all(|(&a, b)| close(a, b)), "{rates:?}");
        let twist = model.forward(&Setting::of_rates(&[1.0, 0.0, 0.0, 0.0]));
        assert!(close(twist.vx, 0.025) && close(twist.vy, -0.025), "{twist:?}");
        assert!(close(twist.omega, -0.025 / 0.275), "{twist:?}");
    }

    #[test]
    fn scrubbing_widens_only_skid_steer() {
        let turn = Twist { vx: 0.0, vy: 0.0, omega: 1.0 };
        let plain = Model::new(Drive::FourWheel, &[0.1; 4], GEOMETRY).unwrap();
        let scrubbed = plain.clone().with_scrub_factor(1.5).unwrap();
        assert!(close(scrubbed.fastest_rim(turn), 1.5 * plain.fastest_rim(turn)));
        let mecanum = Model::new(Drive::Mecanum, &[0.1; 4], GEOMETRY).unwrap();
        assert_eq!(mecanum.clone().with_scrub_factor(1.5).unwrap(), mecanum);
    }

    #[test]
    fn says_how_it_turns_and_what_it_sets() {
        for drive in Drive::ALL {
            let radii = vec![0.1; drive.wheel_count()];
            let model = Model::new(drive, &radii, GEOMETRY).unwrap();
            assert_eq!(model.turning(), Turning::InPlace);
            let set = model.inverse(model.turning().twist(-1.0));
            let Settable { rates, steering } = model.settable();
            assert_eq!((set.rates.len(), set.steering.len()), (rates, steering), "{drive:?}");
            let twist = model.forward(&set);
            assert!(close(twist.omega, -1.0) && twist.vx.abs() < 1e-12, "{drive:?}: {twist:?}");
        }
        let wide = Turning::OnCircle { radius: 0.8 }.twist(2.0);
        assert_eq!((wide.turning_radius(), wide.omega), (Some(0.8), 1.0));
    }

    #[test]
    fn says_what_is_wrong_with_the_figures() {
        let error = Model::new(Drive::TwoWheel, &[0.1; 4], GEOMETRY).unwrap_err();
        assert_eq!(error.to_string(), "this layout has 2 wheels, but 4 wheel radii are given");
        let error = Model::new(Drive::TwoWheel, &[0.1, 0.0], GEOMETRY).unwrap_err();
        assert_eq!(error.to_string(), "the wheel radius must be above zero, it is 0");
        let flat = Geometry { track: f64::NAN, wheelbase: 0.2 };
        assert!(Model::new(Drive::TwoWheel, &[0.1, 0.1], flat).is_err());
    }

    /// A robot that drives as a car turns, for the tests of plans.
    pub(crate) fn turning_on_a_circle(model: &Model, radius: f64) -> Model {
        Model { turning: Turning::OnCircle { radius }, ..model.clone() }
    }

    proptest! {
        #[test]
        fn forward_undoes_inverse(
            drive in prop::sample::select(Drive::ALL.to_vec()),
            radii in prop::collection::vec(0.01..0.5, MAX_WHEELS),
            track in 0.05..2.0, wheelbase in 0.05..2.0, scrub in 0.5..2.0,
            vx in -2.0..2.0, vy in -2.0..2.0, omega in -5.0..5.0,
        ) {
            let model = Model::new(drive, &radii[..drive.wheel_count()], Geometry { track, wheelbase }).unwrap();
            let model = model.with_scrub_factor(scrub).unwrap();
            let vy = if drive.row().mecanum { vy } else { 0.0 };
            let twist = model.forward(&model.inverse(Twist { vx, vy, omega }));
            prop_assert!(close(twist.vx, vx) && close(twist.vy, vy) && close(twist.omega, omega), "{twist:?}");
        }

        #[test]
        fn forward_is_the_least_squares_solution(rates in prop::collection::vec(-10.0..10.0, 4)) {
            let model = Model::new(Drive::Mecanum, &[0.04; 4], GEOMETRY).unwrap();
            let best = model.forward(&Setting::of_rates(&rates));
            let residual = |twist: Twist| -> f64 {
                model.inverse(twist).rates.iter().zip(&rates).map(|(a, b)| (a - b).powi(2)).sum()
            };
            for step in [-1e-3, 1e-3] {
                let vx = residual(Twist { vx: best.vx + step, ..best });
                prop_assert!(residual(best) <= vx);
                let vy = residual(Twist { vy: best.vy + step, ..best });
                prop_assert!(residual(best) <= vy);
                let omega = residual(Twist { omega: best.omega + step, ..best });
                prop_assert!(residual(best) <= omega);
            }
        }
    }
}
