//! Bodies that stop before they touch something.

use pydslrep_kinematics::{Pose, Twist};
use pydslrep_scene::{Body, Space, distance_between};

/// Bodies stop this far from each other, metres.
const PLAY: f64 = 0.001;

/// How much nearer a body may come in one little move along something, metres: what rounding makes of nothing.
const ROUNDING: f64 = 1e-9;

/// A body makes no more little moves than this at once; it is slower along a wall than in the open if it would take
/// more.
const MOST_MOVES: u32 = 256;

/// What a body can run into.
pub(super) struct Surroundings<'a> {
    pub(super) space: &'a Space,
    /// Other robots where they are now.
    pub(super) others: &'a [(Body, Pose)],
}

impl Surroundings<'_> {
    /// How far the nearest thing is; `within` where everything is at least so far.
    fn clearance(&self, body: Body, pose: Pose, within: f64) -> f64 {
        let obstacle = self.space.nearest(body, pose, within).map_or(within, |near| near.distance);
        let radius = |body: Body| body.length.hypot(body.width) / 2.0;
        self.others.iter().fold(obstacle, |nearest, &(other, at)| {
            if pose.distance(&at) - radius(body) - radius(other) > nearest {
                return nearest;
            }
            nearest.min(distance_between((body, pose), (other, at)))
        })
    }

    /// Where a body comes in `seconds` of a constant twist, and whether something stopped it on the way.
    ///
    /// Conservative advancement: no point of the body is faster than v + |ω|r, so as long as the nearest thing is further
    /// than that times the time of a move, nothing can be passed through, however thin it is. What touches something can
    /// still move along it and away from it.
    pub(super) fn advance(&self, body: Body, from: Pose, twist: Twist, seconds: f64) -> (Pose, bool) {
        let reach = body.length.hypot(body.width) / 2.0;
        let speed = twist.vx.hypot(twist.vy) + twist.omega.abs() * reach;
        if speed * seconds <= 0.0 {
            return (from, false);
        }
        let (mut here, mut left) = (from, seconds);
        let mut clearance = self.clearance(body, here, PLAY + speed * left);
        for _ in 0..MOST_MOVES {
            if clearance >= PLAY + speed * left {
                return (here.advance(twist, left), false);
            }
            let is_touching = clearance < 2.0 * PLAY;
            let way = if is_touching { PLAY / 2.0 } else { clearance - PLAY };
            let time = (way / speed).min(left);
            let next = here.advance(twist, time);
            left -= time;
            let after = self.clearance(body, next, PLAY + speed * left.max(time));
            if is_touching && after < PLAY && after < clearance - ROUNDING {
                return (here, true);
            }
            (here, clearance) = (next, after);
            if left <= 0.0 {
                return (here, false);
            }
        }
        (here, false)
    }
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
            let (pose, stopped) = around.advance(BODY, Pose::default(), forward(speed), 60.0);
            let gap = 1.0 - thickness / 2.0 - 0.15 - pose.x;
            assert!(stopped && gap > 0.0 && gap < 2.0 * PLAY, "{speed}: {pose:?}");
            let (back, stopped) = around.advance(BODY, pose, forward(-speed), 1.0);
            assert!(!stopped && (pose.x - back.x - speed).abs() < 1e-6, "{speed}: {back:?}");
        }
    }

    #[test]
    fn a_long_way_along_a_wall_is_no_collision() {
        let space = space(vec![Obstacle::wall("w", (-1.0, 0.2015), (9.0, 0.2015), 0.1)]);
        let around = Surroundings { space: &space, others: &[] };
        let mut pose = Pose::default();
        for _ in 0..200 {
            let (next, stopped) = around.advance(BODY, pose, forward(0.5), 0.005);
            assert!(!stopped);
            pose = next;
        }
        assert!((pose.x - 0.5).abs() < 1e-9, "{pose:?}");
        let turn = Twist { omega: 1.0, ..Twist::default() };
        assert!(around.advance(BODY, pose, turn, 0.5).1, "its corner would go into the wall");
    }

    #[test]
    fn robots_stop_each_other() {
        let others = [(BODY, Pose::new(1.0, 0.1, 0.5))];
        let around = Surroundings { space: &Space::default(), others: &others };
        let (pose, stopped) = around.advance(BODY, Pose::default(), forward(2.0), 5.0);
        let gap = distance_between((BODY, pose), others[0]);
        assert!(stopped && gap > 0.0 && gap < 2.0 * PLAY, "{pose:?}");
    }

    proptest! {
        #[test]
        fn nothing_is_ever_inside_of_something(
            x in -1.5..1.5, y in -1.5..1.5, theta in -3.0..3.0,
            vx in -20.0..20.0, vy in -20.0..20.0, omega in -20.0..20.0,
        ) {
            let corners = vec![(0.0, 0.0), (0.9, 0.1), (0.3, 0.3), (0.2, 0.9)];
            let star = Obstacle { name: String::new(), pose: Pose::default(), shape: pydslrep_scene::Shape::Polygon(corners) };
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
