//! Contacts: bodies stop just before an obstacle or slide along it.

use pydslrep_kinematics::{Pose, Twist};
use pydslrep_scene::{Body, Space, distance_between};

/// The gap at which bodies stop, metres.
pub(super) const GAP: f64 = 0.001;

/// The tolerance for rounding when a body moves along something, metres.
const TOLERANCE: f64 = 1e-9;

/// The maximum number of moves per call; a body that needs more is slowed down along the wall.
const MAX_MOVES: u32 = 256;

/// The coefficient of Coulomb friction between a body and an obstacle.
const FRICTION: f64 = 0.3;

/// The resistance of wheels to lateral motion, relative to rolling.
const LATERAL_RESISTANCE: f64 = 3.0;

/// The step for the numerical gradient of the clearance, metres and radians.
const GRADIENT_STEP: f64 = 1e-4;

/// The obstacles and robots around a body.
pub(super) struct Surroundings<'a> {
    pub(super) space: &'a Space,
    /// The other robots at their current poses.
    pub(super) others: &'a [(Body, Pose)],
}

impl Surroundings<'_> {
    /// The distance to the nearest obstacle or robot, at most `within`.
    fn clearance(&self, body: Body, pose: Pose, within: f64) -> f64 {
        let obstacle = self.space.nearest(body, pose, within).map_or(within, |near| near.distance);
        self.others.iter().fold(obstacle, |nearest, &(other, at)| {
            if pose.distance(&at) - body.reach() - other.reach() > nearest {
                return nearest;
            }
            nearest.min(distance_between((body, pose), (other, at)))
        })
    }

    /// The pose of a body after driving with a twist for `seconds`, and its final twist if a contact changed it.
    ///
    /// Conservative advancement: no point of the body is faster than v + |ω|r. If the clearance exceeds that times the
    /// duration of a move, the body cannot tunnel through anything, however thin. In contact it can still move along the
    /// obstacle and away from it.
    pub(super) fn advance(
        &self,
        body: Body,
        from: Pose,
        wanted: Twist,
        seconds: f64,
    ) -> (Pose, Option<Twist>) {
        let (mut here, mut left, mut changed) = (from, seconds, None);
        for attempt in [Attempt::Freely, Attempt::Sliding, Attempt::SlidingStraight] {
            let twist = match attempt {
                Attempt::Freely => wanted,
                Attempt::Sliding => self.slide(body, here, wanted, body_inertia(body)),
                Attempt::SlidingStraight => self.slide(body, here, wanted, f64::INFINITY),
            };
            if attempt != Attempt::Freely {
                changed = Some(twist);
            }
            (here, left) = self.move_freely(body, here, twist, left);
            if left <= 0.0 {
                return (here, changed);
            }
        }
        (here, Some(Twist::default()))
    }

    /// The pose of a body moving with a constant twist until a contact, and the remaining time.
    fn move_freely(&self, body: Body, from: Pose, twist: Twist, seconds: f64) -> (Pose, f64) {
        let speed = twist.vx.hypot(twist.vy) + twist.omega.abs() * body.reach();
        if speed * seconds <= 0.0 {
            return (from, 0.0);
        }
        let (mut here, mut left) = (from, seconds);
        let mut clearance = self.clearance(body, here, GAP + speed * left);
        for _ in 0..MAX_MOVES {
            if clearance >= GAP + speed * left {
                return (here.advance(twist, left), 0.0);
            }
            let is_touching = clearance < 2.0 * GAP;
            let way = if is_touching { GAP / 2.0 } else { clearance - GAP };
            let time = (way / speed).min(left);
            let next = here.advance(twist, time);
            let after = self.clearance(body, next, GAP + speed * left.max(time));
            if is_touching && after < GAP && after < clearance - TOLERANCE {
                return (here, left);
            }
            left -= time;
            (here, clearance) = (next, after);
            if left <= 0.0 {
                return (here, 0.0);
            }
        }
        (here, 0.0)
    }

    /// The twist closest to the wanted one that does not reduce the clearance, minus friction.
    ///
    /// Closest in the metric M of the effort to push the body: 1 for motion ahead, [`LATERAL_RESISTANCE`] across the wheels,
    /// and `inertia`, the square of a radius, for turning. With the gradient g of the clearance, the twist is
    /// v − M⁻¹g (g·v) / (g·M⁻¹g). Friction uses the same metric.
    fn slide(&self, body: Body, here: Pose, wanted: Twist, inertia: f64) -> Twist {
        let compliance = [1.0, 1.0 / LATERAL_RESISTANCE, 1.0 / inertia];
        let gradient = self.gradient(body, here);
        let wanted = [wanted.vx, wanted.vy, if inertia.is_finite() { wanted.omega } else { 0.0 }];
        let nearing: f64 = gradient.iter().zip(wanted).map(|(slope, part)| slope * part).sum();
        let stiffness: f64 =
            gradient.iter().zip(compliance).map(|(slope, compliance)| slope * slope * compliance).sum();
        if nearing >= 0.0 || stiffness <= 0.0 {
            return Twist { vx: wanted[0], vy: wanted[1], omega: wanted[2] };
        }
        let push: Vec<f64> = gradient
            .iter()
            .zip(compliance)
            .map(|(slope, compliance)| -compliance * slope * nearing / stiffness)
            .collect();
        let sliding: Vec<f64> = wanted.iter().zip(&push).map(|(part, push)| part + push).collect();
        let size = |twist: &[f64]| {
            let squares = twist.iter().zip(compliance).filter(|(_, compliance)| *compliance > 0.0);
            squares.map(|(part, compliance)| part * part / compliance).sum::<f64>().sqrt()
        };
        let kept = (1.0 - FRICTION * size(&push) / size(&sliding).max(f64::MIN_POSITIVE)).max(0.0);
        Twist { vx: kept * sliding[0], vy: kept * sliding[1], omega: kept * sliding[2] }
    }

    /// The gradient of the clearance for motion ahead, to the left, and for turning left.
    fn gradient(&self, body: Body, here: Pose) -> [f64; 3] {
        let slope = |vx: f64, vy: f64, omega: f64| {
            let at = |way: f64| here.advance(Twist { vx, vy, omega }, way);
            let clearance = |way: f64| self.clearance(body, at(way), 3.0 * GAP);
            (clearance(GRADIENT_STEP) - clearance(-GRADIENT_STEP)) / (2.0 * GRADIENT_STEP)
        };
        [slope(1.0, 0.0, 0.0), slope(0.0, 1.0, 0.0), slope(0.0, 0.0, 1.0)]
    }
}

/// The ways in which a body tries to move.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Attempt {
    Freely,
    Sliding,
    /// Without turning: flush with a wall, turning either way collides.
    SlidingStraight,
}

/// The moment of inertia of a rectangle per mass: the square of its radius of gyration.
fn body_inertia(body: Body) -> f64 {
    (body.length * body.length + body.width * body.width) / 12.0
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use pydslrep_scene::{Obstacle, Scene};

    use super::*;

    const BODY: Body = Body { length: 0.3, width: 0.3 };

    fn space(obstacles: Vec<Obstacle>) -> Space {
        Space::of(&Scene { obstacles, ..Scene::default() })
    }

    fn forward(vx: f64) -> Twist {
        Twist { vx, ..Twist::default() }
    }

    #[test]
    fn stops_before_a_wall_however_fast_and_thin() {
        for (speed, thickness) in [(0.09, 0.1), (3.0, 0.001), (5000.0, 1e-6)] {
            let space = space(vec![Obstacle::wall("w", (1.0, -1.0), (1.0, 1.0), thickness)]);
            let around = Surroundings { space: &space, others: &[] };
            let (pose, changed) = around.advance(BODY, Pose::default(), forward(speed), 60.0);
            let gap = 1.0 - thickness / 2.0 - 0.15 - pose.x;
            let stopped = changed.is_some_and(|twist| twist.vx.hypot(twist.vy) < 1e-3);
            assert!(stopped && gap > 0.0 && gap < 2.0 * GAP, "{speed}: {pose:?}");
            let (back, changed) = around.advance(BODY, pose, forward(-speed), 1.0);
            assert!(changed.is_none() && (pose.x - back.x - speed).abs() < 1e-6, "{speed}: {back:?}");
        }
    }

    #[test]
    fn driving_along_a_wall_is_no_collision() {
        let space = space(vec![Obstacle::wall("w", (-1.0, 0.2015), (9.0, 0.2015), 0.1)]);
        let around = Surroundings { space: &space, others: &[] };
        let mut pose = Pose::default();
        for _ in 0..200 {
            let (next, changed) = around.advance(BODY, pose, forward(0.5), 0.005);
            assert!(changed.is_none());
            pose = next;
        }
        assert!((pose.x - 0.5).abs() < 1e-9, "{pose:?}");
        let turn = Twist { omega: 1.0, ..Twist::default() };
        let (turned, changed) = around.advance(BODY, pose, turn, 0.5);
        assert!(changed.is_some() && turned.theta < 0.25, "its corner would hit the wall: {turned:?}");
    }

    #[test]
    fn robots_stop_each_other() {
        let others = [(BODY, Pose::new(1.0, 0.1, 0.5))];
        let around = Surroundings { space: &Space::default(), others: &others };
        let mut pose = Pose::default();
        for _ in 0..400 {
            pose = around.advance(BODY, pose, forward(2.0), 0.005).0;
            assert!(distance_between((BODY, pose), others[0]) > 0.0, "{pose:?}");
        }
        let (_, changed) = around.advance(BODY, Pose::new(0.65, 0.1, 0.5), forward(2.0), 0.4);
        assert_eq!(changed.map(|twist| twist.vx.abs() < 0.01), Some(true), "flush, it stops");
    }

    /// The pose of a body after driving for some seconds, in the world's integration steps.
    fn after(around: &Surroundings, start: Pose, wanted: Twist, seconds: f64) -> Pose {
        let mut pose = start;
        let mut time = 0.0;
        while time < seconds {
            pose = around.advance(BODY, pose, wanted, 0.005).0;
            time += 0.005;
        }
        pose
    }

    #[test]
    fn slides_along_a_slanting_wall_and_loses_some_of_its_speed() {
        let space = space(vec![Obstacle::wall("w", (-1.0, 0.5), (9.0, 0.5), 0.1)]);
        let around = Surroundings { space: &space, others: &[] };
        for degrees in [10.0_f64, 20.0, 35.0] {
            let start = Pose::new(0.0, 0.0, degrees.to_radians());
            let end = after(&around, start, forward(0.1), 20.0);
            let gap = space.nearest(BODY, end, 1.0).unwrap().distance;
            assert!(gap > 0.0 && gap < 2.0 * GAP, "{degrees}: {end:?}");
            assert!(end.x > 0.8 && end.x < 1.98, "{degrees}: {end:?}");
            assert!(end.theta.abs() < 0.02, "the wall turns it: {degrees}: {end:?}");
        }
    }

    #[test]
    fn friction_is_a_share_of_the_push() {
        // Flush with a wall on its left, a body that wants to go ahead and into the wall is pushed back across its wheels,
        // which costs 0.3 · √3 of the speed that it is pushed by.
        let space = space(vec![Obstacle::wall("w", (-9.0, 0.2015), (9.0, 0.2015), 0.1)]);
        let around = Surroundings { space: &space, others: &[] };
        for left in [0.0, 0.02, 0.05, 0.1, 0.3] {
            let end = after(&around, Pose::default(), Twist { vx: 0.1, vy: left, omega: 0.0 }, 4.0);
            let speed = (0.1 - 0.3 * 3.0_f64.sqrt() * left).max(0.0);
            assert!((end.x - 4.0 * speed).abs() < 0.003, "{left}: {end:?}, not {}", 4.0 * speed);
        }
    }

    #[test]
    fn does_not_slide_when_driving_straight_into_a_wall() {
        let wall = Obstacle::wall("w", (1.0, -3.0), (1.0, 3.0), 0.1);
        let corner = Obstacle::wall("c", (-3.0, 0.5), (3.0, 0.5), 0.1);
        let space = space(vec![wall, corner]);
        let around = Surroundings { space: &space, others: &[] };
        for (start, seconds) in [(Pose::default(), 20.0), (Pose::new(0.0, 0.0, 0.5), 60.0)] {
            let there = after(&around, start, forward(0.1), seconds);
            let later = after(&around, there, forward(0.1), 5.0);
            assert!(there.distance(&later) < 0.001, "{there:?} {later:?}");
            assert!(there.x > 0.75, "it drives as far as possible: {there:?}");
        }
    }

    proptest! {
        #[test]
        fn bodies_never_overlap(
            x in -1.5..1.5, y in -1.5..1.5, theta in -3.0..3.0,
            vx in -20.0..20.0, vy in -20.0..20.0, omega in -20.0..20.0,
        ) {
            let corners = vec![(0.0, 0.0), (0.9, 0.1), (0.3, 0.3), (0.2, 0.9)];
            let star = Obstacle::fixed("", Pose::default(), pydslrep_scene::Shape::Polygon(corners));
            let space = space(vec![star, Obstacle::wall("w", (-1.0, -1.0), (1.0, -0.7), 0.01)]);
            let around = Surroundings { space: &space, others: &[] };
            let start = Pose::new(x, y, theta);
            prop_assume!(space.nearest(BODY, start, 0.002).is_none());
            let mut pose = start;
            for _ in 0..20 {
                pose = around.advance(BODY, pose, Twist { vx, vy, omega }, 0.005).0;
                prop_assert!(space.nearest(BODY, pose, 1e-9).is_none(), "{:?}", pose);
            }
        }
    }
}
