//! The motion of a robot whose wheels are dragged over the floor.

use nalgebra::{Matrix3, SMatrix, Vector2, Vector3};
use pydslrep_robots::{Drive, MAX_WHEELS, WheelPlace};

use crate::{Geometry, Twist};

/// The relation between the rates of a robot's wheels and its motion when they are dragged across the floor.
/// [`crate::Model`] says how a robot should move; this says how it does.
///
/// Each wheel touches the floor in a point. What that point slips over the floor is resisted along the wheel and, by a
/// share of it, across: the lateral friction, 1 for a rubber tyre. Mecanum wheels resist along their rollers' axes and, as far as
/// rollers do not turn freely, across them. The robot moves so that the least is lost, which with resistance in
/// proportion to slip is a problem of least squares: minimise Σ (sₐ² + friction · s₀²) over the wheels. A skid-steered robot
/// then turns less than its wheels do, by 1 + friction · (wheelbase/track)²; that real ones do is described in Mandow et al.,
/// "Experimental kinematics for wheeled skid-steer mobile robots", 2007.
#[derive(Debug, Clone, PartialEq)]
pub struct Traction {
    /// vx, vy, ω (rows) for a unit of each wheel's rim speed (columns); those beyond the robot's wheels are 0.
    twist_per_rim: SMatrix<f64, 3, MAX_WHEELS>,
}

impl Traction {
    /// The traction of a robot whose wheels have this friction across the direction they drive in, as a share of that along
    /// it: from 0 for none, which makes it the ideal model, to 1.
    pub fn new(drive: Drive, geometry: Geometry, lateral_friction: f64) -> Self {
        let mut normal = Matrix3::zeros();
        let mut per_rim: SMatrix<f64, 3, MAX_WHEELS> = SMatrix::zeros();
        for (wheel, mut column) in drive.row().wheels.iter().zip(per_rim.column_iter_mut()) {
            let (x, y) = geometry.position(wheel);
            let along = direction_of_force(wheel);
            let across = Vector2::new(-along.y, along.x);
            for (direction, weight) in [(along, 1.0), (across, lateral_friction)] {
                // The speed of the point of contact in this direction is this times the twist.
                let speed = Vector3::new(direction.x, direction.y, direction.y * x - direction.x * y);
                normal += weight * speed * speed.transpose();
                column += weight * direction.x * speed;
            }
        }
        // Without lateral friction nothing keeps most robots from sideways motion, and nothing causes it: that is 0.
        let inverse = normal.pseudo_inverse(1e-12).unwrap_or_default();
        Self { twist_per_rim: inverse * per_rim }
    }

    /// The twist for rim speeds in m/s, in the order of the type; missing ones count as 0.
    pub fn twist(&self, rims: &[f64]) -> Twist {
        let parts = self.twist_per_rim.column_iter().zip(rims).map(|(column, rim)| column * *rim);
        let twist: Vector3<f64> = parts.sum();
        Twist { vx: twist.x, vy: twist.y, omega: twist.z }
    }
}

/// Returns the factor by which a skid-steered robot seems wider when it turns; 1 for others, whose wheels follow.
///
/// Plans and scripts take its track to be wider by this factor; scripts compute it from where they find the wheels, with
/// the friction of its type (`python/pydslrep_runtime/drives.py`).
pub fn scrub_factor(drive: Drive, geometry: Geometry, lateral_friction: f64) -> f64 {
    let row = drive.row();
    if !row.scrubs() {
        return 1.0;
    }
    let square = |of: fn(&WheelPlace) -> f64| row.wheels.iter().map(|wheel| of(wheel).powi(2)).sum::<f64>();
    let ahead = square(|wheel| wheel.ahead) / square(|wheel| wheel.left);
    1.0 + lateral_friction * ahead * (geometry.wheelbase / geometry.track).powi(2)
}

/// The direction in which a wheel pushes the robot: along it, or along the axis of a mecanum wheel's rollers, which form
/// an X seen from above.
fn direction_of_force(wheel: &WheelPlace) -> Vector2<f64> {
    if wheel.push == 0.0 {
        return Vector2::new(1.0, 0.0);
    }
    let half = std::f64::consts::FRAC_1_SQRT_2;
    Vector2::new(half, wheel.push * half)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::{Model, Setting};

    const GEOMETRY: Geometry = Geometry { track: 0.30, wheelbase: 0.25 };

    fn close(a: Twist, b: Twist, tolerance: f64) -> bool {
        [a.vx - b.vx, a.vy - b.vy, a.omega - b.omega].iter().all(|off| off.abs() <= tolerance)
    }

    #[test]
    fn a_skid_steered_robot_turns_less_than_its_wheels() {
        for drive in Drive::ALL.into_iter().filter(|drive| drive.row().scrubs()) {
            let rims: Vec<f64> = drive.row().wheels.iter().map(|wheel| -0.15 * wheel.left).collect();
            for lateral_friction in [0.0, 0.3, 1.0] {
                let turn = Traction::new(drive, GEOMETRY, lateral_friction).twist(&rims).omega;
                let factor = scrub_factor(drive, GEOMETRY, lateral_friction);
                assert!((turn - 1.0 / factor).abs() < 1e-12, "{drive:?}: {turn}");
            }
        }
        assert!((scrub_factor(Drive::FourWheel, GEOMETRY, 0.0) - 1.0).abs() < 1e-12);
        assert!((scrub_factor(Drive::FourWheel, GEOMETRY, 1.0) - 1.694).abs() < 1e-3);
    }

    #[test]
    fn rollers_that_drag_cost_sideways_motion() {
        let sideways = |lateral_friction| {
            Traction::new(Drive::Mecanum, GEOMETRY, lateral_friction).twist(&[-0.1, 0.1, 0.1, -0.1])
        };
        assert!((sideways(0.0).vy - 0.1).abs() < 1e-12);
        assert!((sideways(0.05).vy - 0.1 * 0.95 / 1.05).abs() < 1e-12);
        let ahead = Traction::new(Drive::Mecanum, GEOMETRY, 0.05).twist(&[0.1; 4]);
        assert!(
            close(ahead, Twist { vx: 0.1, ..Twist::default() }, 1e-12),
            "no roller turns, straight on: {ahead:?}"
        );
    }

    #[test]
    fn two_wheels_on_an_axle_do_not_scrub() {
        for lateral_friction in [0.0, 1.0] {
            let twist = Traction::new(Drive::TwoWheel, GEOMETRY, lateral_friction).twist(&[0.1, 0.2]);
            assert!(close(twist, Twist { vx: 0.15, vy: 0.0, omega: 0.1 / 0.30 }, 1e-12), "{twist:?}");
        }
    }

    proptest! {
        #[test]
        fn without_grip_it_is_the_ideal_model(
            drive in prop::sample::select(Drive::ALL.to_vec()),
            rates in prop::collection::vec(-5.0..5.0, MAX_WHEELS), track in 0.1..1.0, wheelbase in 0.1..1.0,
        ) {
            let geometry = Geometry { track, wheelbase };
            let rates = &rates[..drive.wheel_count()];
            let model = Model::new(drive, &[1.0; MAX_WHEELS][..drive.wheel_count()], geometry).unwrap();
            let twist = Traction::new(drive, geometry, 0.0).twist(rates);
            prop_assert!(close(twist, model.forward(&Setting::of_rates(rates)), 1e-9), "{:?}", twist);
        }

        #[test]
        fn nothing_is_gained_by_slipping(
            drive in prop::sample::select(Drive::ALL.to_vec()),
            rims in prop::collection::vec(-1.0..1.0, MAX_WHEELS), lateral_friction in 0.0..1.0,
        ) {
            let rims = &rims[..drive.wheel_count()];
            let twist = Traction::new(drive, GEOMETRY, lateral_friction).twist(rims);
            let most = rims.iter().fold(0.0, |most: f64, rim| most.max(rim.abs()));
            prop_assert!(twist.vx.abs() <= most + 1e-12 && twist.vy.abs() <= most + 1e-12);
            prop_assert!(twist.omega.abs() <= most / 0.15 + 1e-9);
        }
    }
}
