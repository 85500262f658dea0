//! Obstacles that move: they push nothing and are stopped by nothing. Robots that they run into are struck.

use pydslrep_kinematics::Pose;
use pydslrep_scene::{Body, Scene, Space, Trajectory};

use super::contact::GAP;

/// An obstacle that comes nearer to a robot than this strikes it, metres: robots themselves keep a [`GAP`].
const STRIKE: f64 = GAP / 2.0;

/// An obstacle that has struck a robot can do so again once it was further away, metres.
const APART: f64 = 2.0 * GAP;

/// The tolerance for rounding when an obstacle moves along a robot, metres.
const TOLERANCE: f64 = 1e-9;

/// The maximum number of distances computed in a move; an obstacle that needs more glides along the robot.
const MAX_MOVES: u32 = 256;

/// An obstacle that has run into a robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Strike {
    /// Simulation time, seconds.
    pub time: f64,
    /// The index of the robot in the scene.
    pub robot: usize,
    /// Where the robot was.
    pub pose: Pose,
    /// The index of the obstacle in the scene.
    pub obstacle: usize,
    /// True if the robot's wheels were turning.
    pub was_driving: bool,
}

/// A robot as obstacles find it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bystander {
    pub(super) body: Body,
    pub(super) pose: Pose,
    pub(super) is_driving: bool,
}

/// An obstacle that moves.
#[derive(Debug, Clone)]
pub(super) struct Mover {
    /// Its index in the scene.
    obstacle: usize,
    trajectory: Trajectory,
    /// The obstacle alone.
    space: Space,
    /// For each robot, whether it was struck and is still near.
    contacts: Vec<Contact>,
}

/// The contact of an obstacle with a robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Contact {
    #[default]
    Apart,
    /// It has been struck.
    Near,
    /// The obstacle covers a part of it.
    Covered,
}

impl Mover {
    /// The moving obstacles of a scene, at its start.
    pub(super) fn all(scene: &Scene) -> Vec<Self> {
        let movers = scene.obstacles.iter().enumerate().filter_map(|(index, obstacle)| {
            Some(Self {
                obstacle: index,
                trajectory: obstacle.trajectory.clone()?,
                space: Space::of_one(scene, index),
                contacts: vec![Contact::Apart; scene.robots.len()],
            })
        });
        movers.collect()
    }

    /// Returns whether it covers a part of a robot, which cannot move then.
    pub(super) fn covers(&self, robot: usize) -> bool {
        self.contacts.get(robot) == Some(&Contact::Covered)
    }

    /// Forgets what it has struck.
    pub(super) fn forget(&mut self) {
        self.contacts.fill(Contact::Apart);
    }

    /// Moves from where it is at one time to where it is at another, and returns the robots that it strikes on the way. They
    /// do not move meanwhile.
    pub(super) fn advance(&mut self, from: f64, to: f64, robots: &[Bystander]) -> Vec<Strike> {
        let mut strikes = Vec::new();
        for (robot, bystander) in robots.iter().enumerate() {
            let Some(before) = self.contacts.get(robot).copied() else { continue };
            let struck = if before == Contact::Apart { self.meeting(bystander, from, to) } else { None };
            let (pose, obstacle, was_driving) = (bystander.pose, self.obstacle, bystander.is_driving);
            strikes.extend(struck.map(|time| Strike { time, robot, pose, obstacle, was_driving }));
            let distance = self.distance(bystander, to, APART);
            self.contacts[robot] = match distance {
                _ if before == Contact::Apart && struck.is_none() => Contact::Apart,
                Some(distance) if distance <= 0.0 => Contact::Covered,
                Some(_) => Contact::Near,
                None => Contact::Apart,
            };
        }
        strikes
    }

    /// When it runs into a robot between two times.
    ///
    /// Conservative advancement, as in [`super::contact`]: each step covers the distance that is left, so that it cannot pass
    /// through anything, however fast and thin it is.
    fn meeting(&mut self, robot: &Bystander, from: f64, to: f64) -> Option<f64> {
        if let Some(before) = self.distance(robot, from, STRIKE) {
            // Robots may start this near to something.
            let nearer = (before - TOLERANCE).max(f64::MIN_POSITIVE);
            return self.distance(robot, to, nearer).map(|_| to);
        }
        let mut time = from;
        for _ in 0..MAX_MOVES {
            if time >= to {
                return None;
            }
            let segment = self.trajectory.segment(time);
            let end = segment.until.min(to);
            time = match self.distance(robot, time, STRIKE + segment.speed * (end - time)) {
                None => end,
                Some(distance) if distance < STRIKE => return Some(time),
                Some(distance) => end.min(time + (distance - STRIKE / 2.0) / segment.speed),
            };
        }
        None
    }

    /// The distance to a robot at a time, if it is less than `within` metres.
    fn distance(&mut self, robot: &Bystander, time: f64, within: f64) -> Option<f64> {
        self.space.move_to(time);
        self.space.nearest(robot.body, robot.pose, within).map(|near| near.distance)
    }
}

#[cfg(test)]
mod tests {
    use pydslrep_scene::{Obstacle, Shape, Waypoint};

    use super::*;

    /// A disc of 20 cm that moves, among `robots` robots.
    fn mover(rows: &[[f64; 3]], robots: usize) -> Mover {
        let points = rows.iter().map(|&[time, x, y]| Waypoint { time, x, y }).collect();
        let trajectory = Trajectory::new(points, false).unwrap();
        let disc = Obstacle::moving("disc", 0.0, Shape::Cylinder { radius: 0.2 }, trajectory);
        let scene = Scene { obstacles: vec![disc], ..Scene::default() };
        Mover { contacts: vec![Contact::Apart; robots], ..Mover::all(&scene).remove(0) }
    }

    fn at(x: f64, y: f64) -> Bystander {
        let body = Body { length: 0.3, width: 0.3 };
        Bystander { body, pose: Pose::new(x, y, 0.0), is_driving: false }
    }

    #[test]
    fn it_does_not_pass_through_a_robot_however_fast() {
        for seconds in [40.0, 0.4, 1e-3, 1e-9] {
            let mut mover = mover(&[[1.0, -2.0, 0.0], [1.0 + seconds, 2.0, 0.0]], 2);
            let strikes = mover.advance(0.0, 50.0, &[at(0.0, 0.1), at(0.0, 9.0)]);
            let [strike] = strikes.as_slice() else { panic!("{seconds}: {strikes:?}") };
            let part = (strike.time - 1.0) / seconds;
            assert!(strike.robot == 0 && (part - 1.65 / 4.0).abs() < 0.001, "{seconds}: {strike:?}");
            assert!(!mover.covers(0), "it is past it");
        }
    }

    #[test]
    fn it_strikes_a_robot_once_until_it_has_left() {
        let mut mover = mover(&[[0.0, 0.0, 0.0], [10.0, 1.0, 0.0], [20.0, 0.0, 0.0], [30.0, 1.0, 0.0]], 1);
        let robots = [at(1.0, 0.0)];
        let mut struck = Vec::new();
        let mut covered = Vec::new();
        for second in 0..30 {
            let time = f64::from(second);
            struck.extend(mover.advance(time, time + 1.0, &robots).iter().map(|strike| strike.time.round()));
            covered.push(mover.covers(0));
        }
        // Its edge is at the robot's after 6.5 s, and again after 26.5 s.
        assert_eq!(struck, [6.0, 26.0]);
        assert!(!covered[5] && covered[6] && covered[12] && !covered[13] && covered[27], "{covered:?}");
        mover.forget();
        assert!(!mover.covers(0));
    }

    #[test]
    fn passing_by_is_no_strike() {
        let gap = 0.15 + 0.2 + GAP;
        let mut mover = mover(&[[0.0, -1.0, gap], [10.0, 1.0, gap]], 1);
        assert_eq!(mover.advance(0.0, 10.0, &[at(0.0, 0.0)]), []);
        // As near as a robot may start to something: what moves along it or away from it does not strike it.
        let near = 0.35 + STRIKE / 3.0;
        for (goal, strikes) in [([0.2, near], 0), ([0.0, 1.0], 0), ([0.0, 0.2], 1)] {
            let mut mover = self::mover(&[[0.0, 0.0, near], [1.0, goal[0], goal[1]]], 1);
            assert_eq!(mover.advance(0.0, 0.1, &[at(0.0, 0.0)]).len(), strikes, "{goal:?}");
        }
    }
}
