//! From the motion of a body to the rates of its wheels and back.

use std::fmt;

use nalgebra::{DVector, MatrixXx3, Vector3};

use crate::{Drive, Twist};

/// How far apart a robot's wheels are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Geometry {
    /// Distance between left and right wheels (d of equations 1 to 6), metres.
    pub track: f64,
    /// Distance between front and rear wheels, metres; without meaning for two wheels.
    pub wheelbase: f64,
}

impl Geometry {
    /// Where the wheels are in the body's frame, (x, y) in metres, in the order of [`Drive`].
    pub fn wheel_positions(&self, drive: Drive) -> Vec<(f64, f64)> {
        let (lx, ly) = (self.wheelbase / 2.0, self.track / 2.0);
        match drive {
            Drive::TwoWheel => vec![(0.0, ly), (0.0, -ly)],
            Drive::FourWheel | Drive::FourMecanum => vec![(lx, ly), (-lx, ly), (lx, -ly), (-lx, -ly)],
        }
    }
}

/// The kinematic model of one robot: linear maps between its twist and its wheel rates.
#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    drive: Drive,
    geometry: Geometry,
    radii: Vec<f64>,
    /// Rim speed of each wheel (rows) for a unit of vx, vy, ω (columns).
    rim_per_twist: MatrixXx3<f64>,
}

/// Why there is no model for these figures.
#[derive(Debug, Clone, PartialEq)]
pub enum ModelError {
    /// The layout has another number of wheels than there are radii.
    WheelCount {
        /// How many the layout has.
        expected: usize,
        /// How many radii were given.
        found: usize,
    },
    /// A length or factor is not a finite number above zero.
    NotPositive {
        /// Which one.
        what: &'static str,
        /// What it was.
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
    /// The ideal model of a robot with these wheel radii (metres, in the order of [`Drive`]) and geometry: no wheel
    /// slips or scrubs.
    ///
    /// # Errors
    /// When the number of radii does not fit the layout or a length is not above zero.
    pub fn new(drive: Drive, radii: &[f64], geometry: Geometry) -> Result<Self, ModelError> {
        if radii.len() != drive.wheel_count() {
            return Err(ModelError::WheelCount { expected: drive.wheel_count(), found: radii.len() });
        }
        for &radius in radii {
            require_positive("wheel radius", radius)?;
        }
        require_positive("track", geometry.track)?;
        if drive != Drive::TwoWheel {
            require_positive("wheelbase", geometry.wheelbase)?;
        }
        let rim_per_twist = rim_per_twist(drive, geometry, 1.0);
        Ok(Self { drive, geometry, radii: radii.to_vec(), rim_per_twist })
    }

    /// The same robot with an effective track of `factor` times the geometric one. Only skid-steer
    /// ([`Drive::FourWheel`]) scrubs; for other layouts the model stays as it is.
    ///
    /// # Errors
    /// When the factor is not above zero.
    pub fn with_scrub_factor(mut self, factor: f64) -> Result<Self, ModelError> {
        require_positive("scrub factor", factor)?;
        self.rim_per_twist = rim_per_twist(self.drive, self.geometry, factor);
        Ok(self)
    }

    /// The wheel layout.
    pub fn drive(&self) -> Drive {
        self.drive
    }

    /// The geometry the model was made from.
    pub fn geometry(&self) -> Geometry {
        self.geometry
    }

    /// Wheel radii in metres, in the order of [`Drive`].
    pub fn radii(&self) -> &[f64] {
        &self.radii
    }

    /// Wheel rates (rad/s, in the order of [`Drive`]) for a twist.
    ///
    /// Rim speeds are v ± ω d/2 (equations 1 to 6 of the article), for mecanum wheels lf = vx − vy − Kω,
    /// rf = vx + vy + Kω, lr = vx + vy − Kω, rr = vx − vy + Kω with K = (wheelbase + track)/2 (Lynch and Park,
    /// "Modern Robotics", 13.2); each is divided by that wheel's own radius. Layouts that cannot move sideways
    /// ignore `vy`.
    pub fn inverse(&self, twist: Twist) -> Vec<f64> {
        self.rim_speeds(twist).iter().zip(&self.radii).map(|(rim, radius)| rim / radius).collect()
    }

    /// The twist for wheel rates (rad/s, in the order of [`Drive`]; missing ones count as 0).
    ///
    /// v = (right + left)/2 and ω = (right − left)/d of the rim speeds (equations 1 to 6 of the article); with more
    /// wheels than degrees of freedom the least-squares solution.
    pub fn forward(&self, rates: &[f64]) -> Twist {
        let rim = DVector::from_fn(self.radii.len(), |i, _| rates.get(i).unwrap_or(&0.0) * self.radii[i]);
        // The columns are orthogonal, so the pseudo-inverse is a projection on each of them.
        let part = |column: usize| {
            let column = self.rim_per_twist.column(column);
            let weight = column.norm_squared();
            if weight == 0.0 { 0.0 } else { column.dot(&rim) / weight }
        };
        Twist { vx: part(0), vy: part(1), omega: part(2) }
    }

    /// Rim speed of the fastest wheel for a twist, in metres per second.
    pub fn fastest_rim(&self, twist: Twist) -> f64 {
        self.rim_speeds(twist).amax()
    }

    fn rim_speeds(&self, twist: Twist) -> DVector<f64> {
        &self.rim_per_twist * Vector3::new(twist.vx, twist.vy, twist.omega)
    }
}

fn rim_per_twist(drive: Drive, geometry: Geometry, scrub: f64) -> MatrixXx3<f64> {
    let half = geometry.track / 2.0;
    match drive {
        Drive::TwoWheel => MatrixXx3::from_row_slice(&[1.0, 0.0, -half, 1.0, 0.0, half]),
        Drive::FourWheel => {
            let half = half * scrub;
            let (left, right) = ([1.0, 0.0, -half], [1.0, 0.0, half]);
            MatrixXx3::from_row_slice(&[left, left, right, right].concat())
        }
        Drive::FourMecanum => {
            let k = geometry.wheelbase / 2.0 + half;
            MatrixXx3::from_row_slice(
                &[[1.0, -1.0, -k], [1.0, 1.0, -k], [1.0, 1.0, k], [1.0, -1.0, k]].concat(),
            )
        }
    }
}

fn require_positive(what: &'static str, value: f64) -> Result<(), ModelError> {
    if value.is_finite() && value > 0.0 { Ok(()) } else { Err(ModelError::NotPositive { what, value }) }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const GEOMETRY: Geometry = Geometry { track: 0.30, wheelbase: 0.25 };

    fn close(a: f64, b: f64) -> bool {
        (a - b).abs() <= 1e-12 * (1.0 + b.abs())
    }

    #[test]
    fn differential_by_hand() {
        let model = Model::new(Drive::TwoWheel, &[0.1, 0.1], GEOMETRY).unwrap();
        let rates = model.inverse(Twist { vx: 0.1, vy: 0.0, omega: 1.0 });
        assert!(close(rates[0], -0.5) && close(rates[1], 2.5), "{rates:?}");
        let twist = model.forward(&[1.0, 2.0]);
        assert!(close(twist.vx, 0.15) && twist.vy == 0.0 && close(twist.omega, 0.1 / 0.30), "{twist:?}");
    }

    #[test]
    fn unequal_wheels_turn_at_equal_rim_speed() {
        let model = Model::new(Drive::FourWheel, &[0.1, 0.05, 0.1, 0.05], GEOMETRY).unwrap();
        let rates = model.inverse(Twist { vx: 0.1, vy: 0.0, omega: 0.0 });
        assert!(rates.iter().zip([1.0, 2.0, 1.0, 2.0]).all(|(&a, b)| close(a, b)), "{rates:?}");
    }

    #[test]
    fn mecanum_drives_sideways() {
        let model = Model::new(Drive::FourMecanum, &[0.1; 4], GEOMETRY).unwrap();
        let rates = model.inverse(Twist { vx: 0.0, vy: 0.1, omega: 0.0 });
        assert!(rates.iter().zip([-1.0, 1.0, 1.0, -1.0]).all(|(&a, b)| close(a, b)), "{rates:?}");
        let twist = model.forward(&[1.0, 0.0, 0.0, 0.0]);
        assert!(close(twist.vx, 0.025) && close(twist.vy, -0.025), "{twist:?}");
        assert!(close(twist.omega, -0.025 / 0.275), "{twist:?}");
    }

    #[test]
    fn scrubbing_widens_only_skid_steer() {
        let turn = Twist { vx: 0.0, vy: 0.0, omega: 1.0 };
        let plain = Model::new(Drive::FourWheel, &[0.1; 4], GEOMETRY).unwrap();
        let scrubbed = plain.clone().with_scrub_factor(1.5).unwrap();
        assert!(close(scrubbed.fastest_rim(turn), 1.5 * plain.fastest_rim(turn)));
        let mecanum = Model::new(Drive::FourMecanum, &[0.1; 4], GEOMETRY).unwrap();
        assert_eq!(mecanum.clone().with_scrub_factor(1.5).unwrap(), mecanum);
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

    proptest! {
        #[test]
        fn forward_undoes_inverse(
            drive in prop::sample::select(vec![Drive::TwoWheel, Drive::FourWheel, Drive::FourMecanum]),
            radii in prop::collection::vec(0.01..0.5, 4),
            track in 0.05..2.0, wheelbase in 0.05..2.0, scrub in 0.5..2.0,
            vx in -2.0..2.0, vy in -2.0..2.0, omega in -5.0..5.0,
        ) {
            let model = Model::new(drive, &radii[..drive.wheel_count()], Geometry { track, wheelbase }).unwrap();
            let model = model.with_scrub_factor(scrub).unwrap();
            let vy = if drive == Drive::FourMecanum { vy } else { 0.0 };
            let twist = model.forward(&model.inverse(Twist { vx, vy, omega }));
            prop_assert!(close(twist.vx, vx) && close(twist.vy, vy) && close(twist.omega, omega), "{twist:?}");
        }

        #[test]
        fn forward_is_the_least_squares_solution(rates in prop::collection::vec(-10.0..10.0, 4)) {
            let model = Model::new(Drive::FourMecanum, &[0.04; 4], GEOMETRY).unwrap();
            let best = model.forward(&rates);
            let residual = |twist: Twist| -> f64 {
                model.inverse(twist).iter().zip(&rates).map(|(a, b)| (a - b).powi(2)).sum()
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
