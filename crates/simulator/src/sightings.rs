//! What sensors saw, as it is drawn.

use std::collections::BTreeSet;

/// Points nearer to each other than this are one, metres.
const FINENESS: f64 = 0.005;

/// More points are not kept: a picture would show no more.
const MOST: usize = 100_000;

/// Points on the floor that clients were told to be seen by a robot's sensors.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Sightings {
    /// A robot, and a point in multiples of the fineness.
    points: BTreeSet<(usize, i64, i64)>,
}

impl Sightings {
    /// Adds a point in metres.
    pub(crate) fn add(&mut self, robot: usize, (x, y): (f64, f64)) {
        if self.points.len() < MOST {
            #[allow(clippy::cast_possible_truncation)] // saturates where nothing is drawn any more
            let cell = |metres: f64| (metres / FINENESS).round() as i64;
            self.points.insert((robot, cell(x), cell(y)));
        }
    }

    /// The points of a robot by its index in the scene, metres.
    pub fn of(&self, robot: usize) -> Vec<(f64, f64)> {
        #[allow(clippy::cast_precision_loss)] // it was a float
        let metres = |cell: i64| cell as f64 * FINENESS;
        let of_robot = self.points.iter().filter(|(seer, _, _)| *seer == robot);
        of_robot.map(|&(_, x, y)| (metres(x), metres(y))).collect()
    }
}
