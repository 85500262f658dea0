//! The points that sensors have detected, for pictures.

use std::collections::BTreeSet;

/// Points are rounded to this grid, metres.
const RESOLUTION: f64 = 0.005;

/// The maximum number of points; a picture could not show more.
const MAX_POINTS: usize = 100_000;

/// Points on the floor that sensor readings have reported.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Sightings {
    /// A robot, and a point in multiples of the resolution.
    points: BTreeSet<(usize, i64, i64)>,
}

impl Sightings {
    /// Adds a point in metres.
    pub fn add(&mut self, robot: usize, (x, y): (f64, f64)) {
        if self.points.len() < MAX_POINTS {
            #[allow(clippy::cast_possible_truncation)] // saturates far outside any picture
            let cell = |metres: f64| (metres / RESOLUTION).round() as i64;
            self.points.insert((robot, cell(x), cell(y)));
        }
    }

    /// The points of a robot by its index in the scene, metres.
    pub fn of(&self, robot: usize) -> Vec<(f64, f64)> {
        #[allow(clippy::cast_precision_loss)] // it was a float
        let metres = |cell: i64| cell as f64 * RESOLUTION;
        let of_robot = self.points.iter().filter(|(seer, _, _)| *seer == robot);
        of_robot.map(|&(_, x, y)| (metres(x), metres(y))).collect()
    }
}
