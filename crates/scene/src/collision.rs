//! Collisions of planned paths.

use pydslrep_kinematics::{ActionIndex, Leg, LegKind, Place, Plan, Pose, RobotPath};

use crate::{Body, Scene, SceneObject, Space, Trajectory, distance_between};

/// Bodies nearer to each other than this collide, metres: in a run, contact stops robots there.
const TOUCH: f64 = 0.001;

/// The maximum number of distances computed for one robot, or for a pair of moving bodies; later collisions are not found. A
/// path takes some for each metre, and more only along something that it nearly touches.
const MAX_STEPS: u32 = 20_000;

/// A robot that would collide with something.
#[derive(Debug, Clone, PartialEq)]
pub struct Collision {
    /// Its index in the scene.
    pub robot: usize,
    /// Its action at that time.
    pub action: ActionIndex,
    /// In which rounds and calls that is.
    pub place: Place,
    /// Seconds since the start of the run; `None` if the duration of an earlier action is unknown.
    pub time: Option<f64>,
    /// Where it is.
    pub pose: Pose,
    /// The robot or obstacle that it collides with.
    pub with: SceneObject,
    /// The other robot's action; `None` if it stands still, or if it is not a robot.
    pub other_action: Option<ActionIndex>,
    /// In which rounds and calls that is.
    pub other_place: Place,
}

/// Where the robots of a plan would collide with obstacles or each other: for each robot the first obstacle on its path,
/// and for each two robots their first collision. What follows from the first is not reported. In the order of robots;
/// none if the scene has collisions switched off.
///
/// Moving obstacles are where they are at the time of an action, if its start is known. Collisions with one while the robot
/// rests between two actions are not found.
pub fn collisions(scene: &Scene, plan: &Plan) -> Vec<Collision> {
    if !scene.collisions {
        return Vec::new();
    }
    let obstacles = Obstacles::of(scene);
    let robots: Vec<(Body, &RobotPath)> =
        scene.robots.iter().zip(&plan.robots).map(|(robot, path)| (robot.body, path)).collect();
    let mut found = Vec::new();
    for (index, &(body, path)) in robots.iter().enumerate() {
        found.extend(with_obstacle(&obstacles, index, body, path));
        let others = robots.iter().enumerate().skip(index + 1);
        found.extend(others.filter_map(|(other, &at)| of_two((index, body, path), (other, at.0, at.1))));
    }
    found
}

/// The obstacles of a scene.
struct Obstacles {
    fixed: Space,
    moving: Vec<Moving>,
}

/// An obstacle that moves.
#[derive(Clone)]
struct Moving {
    /// Its index in the scene.
    obstacle: usize,
    trajectory: Trajectory,
    /// The obstacle alone.
    space: Space,
    /// The number of distances to it that have been computed for the robot.
    steps: u32,
}

impl Obstacles {
    fn of(scene: &Scene) -> Self {
        let moving = scene.obstacles.iter().enumerate().filter_map(|(index, obstacle)| {
            let (trajectory, space) = (obstacle.trajectory.clone()?, Space::of_one(scene, index));
            Some(Moving { obstacle: index, trajectory, space, steps: 0 })
        });
        Self { fixed: Space::of_fixed(scene), moving: moving.collect() }
    }
}

/// The first obstacle on a robot's path.
fn with_obstacle(obstacles: &Obstacles, robot: usize, body: Body, path: &RobotPath) -> Option<Collision> {
    let mut steps = 0;
    let mut moving = obstacles.moving.clone();
    // Which way leads through the whole of an `if`, nobody knows.
    for leg in path.legs.iter().filter(|leg| leg.kind != LegKind::Whole) {
        let mut first = with_fixed(&obstacles.fixed, body, leg, &mut steps);
        if let Some(start) = leg.start {
            let way = BodyMotion {
                start,
                speed: leg.top_speed(body.reach()),
                pose: |seconds| leg.pose_at(seconds),
            };
            for other in &mut moving {
                let until = first.map_or(leg.duration, |(seconds, _)| seconds);
                first = other.meet(body, &way, until).map(|seconds| (seconds, other.obstacle)).or(first);
            }
        }
        if let Some((seconds, obstacle)) = first {
            let (with, time) = (SceneObject::Obstacle(obstacle), leg.start.map(|start| start + seconds));
            let (action, place, pose) = (leg.index, leg.place.clone(), leg.pose_at(seconds));
            let (other_action, other_place) = (None, Place::default());
            return Some(Collision { robot, action, place, time, pose, with, other_action, other_place });
        }
    }
    None
}

/// The first obstacle on a leg that does not move, and the seconds until it is met. Each step covers the distance to the
/// nearest one, since nothing can be hit earlier; so nothing is too thin to be found.
fn with_fixed(space: &Space, body: Body, leg: &Leg, steps: &mut u32) -> Option<(f64, usize)> {
    let speed = leg.top_speed(body.reach());
    let mut seconds = 0.0;
    while seconds < leg.duration && *steps < MAX_STEPS {
        *steps += 1;
        let left = speed * (leg.duration - seconds);
        let near = space.nearest(body, leg.pose_at(seconds), left + TOUCH)?;
        if near.distance < TOUCH {
            return Some((seconds, near.obstacle));
        }
        seconds += step(near.distance, speed);
    }
    None
}

/// The motion of a body for some time.
struct BodyMotion<P: Fn(f64) -> Pose> {
    /// Seconds since the start of the run.
    start: f64,
    /// The highest speed of any of its points.
    speed: f64,
    /// Where it is, by the seconds since the start of the way.
    pose: P,
}

impl Moving {
    /// The seconds of a way after which a body and the obstacle meet, if they do before `until`: the same search with the
    /// speeds of both, segment by segment of the obstacle's path. A body at rest is met, too.
    fn meet(&mut self, body: Body, way: &BodyMotion<impl Fn(f64) -> Pose>, until: f64) -> Option<f64> {
        let mut seconds = 0.0;
        while seconds < until && self.steps < MAX_STEPS {
            self.steps += 1;
            let segment = self.trajectory.segment(way.start + seconds);
            let (end, speed) = ((segment.until - way.start).min(until), way.speed + segment.speed);
            self.space.move_to(way.start + seconds);
            let reachable = speed * (end - seconds).max(0.0) + TOUCH;
            seconds = match self.space.nearest(body, (way.pose)(seconds), reachable) {
                Some(near) if near.distance < TOUCH => return Some(seconds),
                Some(near) => (seconds + step(near.distance, speed)).min(end),
                None => end,
            };
        }
        None
    }
}

/// The time before things at this distance can touch, and a little more so that the steps come to an end.
fn step(distance: f64, speed: f64) -> f64 {
    (distance - TOUCH / 2.0) / speed
}

/// The first collision of two robots, as far as the times of their actions are known.
fn of_two(a: (usize, Body, &RobotPath), b: (usize, Body, &RobotPath)) -> Option<Collision> {
    let (first, second) = (Timetable::of(a.2), Timetable::of(b.2));
    let horizon = first.known_until.min(second.known_until).min(first.end().max(second.end()));
    let mut time = 0.0;
    for _ in 0..MAX_STEPS {
        if time >= horizon {
            return None;
        }
        let (one, two) = (first.at(time), second.at(time));
        let speed = one.speed(a.1) + two.speed(b.1);
        let change = one.until.min(two.until);
        if speed <= 0.0 {
            time = change;
            continue;
        }
        let distance = distance_between((a.1, one.pose), (b.1, two.pose));
        if distance < TOUCH {
            // At least one of them moves; it collides with the other.
            let (robot, other, me, you) =
                if one.drives() { (a.0, b.0, one, two) } else { (b.0, a.0, two, one) };
            let leg = me.leg?;
            return Some(Collision {
                robot,
                action: leg.index,
                place: leg.place.clone(),
                time: Some(time),
                pose: me.pose,
                with: SceneObject::Robot(other),
                other_action: you.leg.map(|leg| leg.index),
                other_place: you.leg.map(|leg| leg.place.clone()).unwrap_or_default(),
            });
        }
        time = (time + step(distance, speed)).min(change);
    }
    None
}

/// The poses of a robot over time.
struct Timetable<'a> {
    start: Pose,
    /// With their start times.
    legs: Vec<(f64, &'a Leg)>,
    known_until: f64,
}

/// The state of a robot at a time.
struct Moment<'a> {
    pose: Pose,
    leg: Option<&'a Leg>,
    /// When its next action begins.
    until: f64,
}

impl<'a> Timetable<'a> {
    fn of(path: &'a RobotPath) -> Self {
        let known = path.legs.iter().take_while(|leg| leg.kind != LegKind::Whole);
        let timed = known.map_while(|leg| Some((leg.start?, leg)));
        let legs: Vec<(f64, &Leg)> = timed.collect();
        let is_whole = legs.len() == path.legs.len() && path.unknown_after.is_none() && !path.truncated;
        let end = legs.last().map_or(0.0, |(start, leg)| start + leg.duration);
        Self { start: path.start, legs, known_until: if is_whole { f64::INFINITY } else { end } }
    }

    fn end(&self) -> f64 {
        self.legs.last().map_or(0.0, |(start, leg)| start + leg.duration)
    }

    fn at(&self, time: f64) -> Moment<'a> {
        let begun = self.legs.partition_point(|(start, _)| *start <= time);
        let next = self.legs.get(begun).map_or(f64::INFINITY, |(start, _)| *start);
        match begun.checked_sub(1).map(|last| self.legs[last]) {
            None => Moment { pose: self.start, leg: None, until: next },
            Some((start, leg)) if time < start + leg.duration => {
                Moment { pose: leg.pose_at(time - start), leg: Some(leg), until: start + leg.duration }
            }
            Some((_, leg)) => Moment { pose: leg.to, leg: None, until: next },
        }
    }
}

impl Moment<'_> {
    fn speed(&self, body: Body) -> f64 {
        self.leg.map_or(0.0, |leg| leg.top_speed(body.reach()))
    }

    fn drives(&self) -> bool {
        self.leg.is_some_and(|leg| leg.kind == LegKind::Drive)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::f64::consts::FRAC_PI_2;

    use proptest::prelude::*;
    use pydslrep_kinematics::{Drive, MotionPrimitive, RobotPlan, Run, motion, plan};

    use super::*;
    use crate::{Obstacle, Robot, Shape, Waypoint, Wheel};

    const AHEAD: MotionPrimitive = MotionPrimitive::Move { distance: 2.0, speed: 0.1 };
    const LEFT: MotionPrimitive = MotionPrimitive::Turn { angle: FRAC_PI_2, speed: motion::RIM_SPEED };

    fn scene(starts: &[Pose], obstacles: Vec<Obstacle>) -> Scene {
        let robot = |(index, start): (usize, &Pose)| {
            let wheels = vec![Wheel::new("l", 0.05), Wheel::new("r", 0.05)];
            Robot { start: *start, ..Robot::new(format!("r{index}"), Drive::TwoWheel, wheels, vec![]) }
        };
        Scene { robots: starts.iter().enumerate().map(robot).collect(), obstacles, ..Scene::default() }
    }

    /// Groups of runs: each a robot with its actions.
    fn found(scene: &Scene, schedule: &[&[(usize, &[MotionPrimitive])]]) -> Vec<Collision> {
        let robots: Vec<_> = scene
            .robots
            .iter()
            .map(|robot| RobotPlan { model: robot.model().unwrap(), start: robot.start })
            .collect();
        let group = |group: &&[(usize, &[MotionPrimitive])]| {
            group.iter().map(|&(robot, actions)| Run { robot, actions: actions.to_vec() }).collect()
        };
        let schedule: Vec<Vec<Run>> = schedule.iter().map(group).collect();
        collisions(scene, &plan(&robots, &schedule).unwrap())
    }

    #[test]
    fn a_wall_is_hit_when_and_where_the_body_touches_it() {
        let wall = Obstacle::wall("w", (-1.0, 1.2), (1.0, 1.2), 1e-6);
        let scene = scene(&[Pose::default()], vec![wall]);
        let collisions = found(&scene, &[&[(0, &[AHEAD, LEFT])], &[(0, &[AHEAD])]]);
        assert_eq!(collisions, [], "it passes the end of the wall");
        let scene = Scene {
            robots: scene.robots,
            obstacles: vec![Obstacle::wall("w", (1.0, 1.2), (3.0, 1.2), 1e-6)],
            ..Scene::default()
        };
        let collisions = found(&scene, &[&[(0, &[AHEAD, LEFT])], &[(0, &[AHEAD, AHEAD])]]);
        let [collision] = collisions.as_slice() else { panic!("{collisions:?}") };
        assert_eq!((collision.robot, collision.with), (0, SceneObject::Obstacle(0)));
        assert_eq!(collision.action, ActionIndex { group: 1, run: 0, action: 0 });
        assert!(
            (collision.pose.y - 1.05).abs() < 0.001 && (collision.pose.x - 2.0).abs() < 1e-9,
            "{collision:?}"
        );
        let before = 2.0 / 0.1 + 0.2 + FRAC_PI_2 * 0.15 / 0.09 + 0.18 + 2.0 * motion::REST;
        let after = 1.05 / 0.1 + 0.1;
        assert!(collision.time.is_some_and(|time| (time - before - after).abs() < 0.02), "{collision:?}");
    }

    #[test]
    fn a_corner_that_turns_into_something_hits_it() {
        let mut scene = scene(&[Pose::default()], vec![Obstacle::wall("w", (-1.0, 0.21), (1.0, 0.21), 0.1)]);
        scene.robots[0].body = Body { length: 0.5, width: 0.3 };
        let collisions = found(&scene, &[&[(0, &[LEFT])]]);
        assert!(
            collisions.len() == 1 && collisions[0].pose.theta > 0.0 && collisions[0].pose.theta < 0.3,
            "{collisions:?}"
        );
        scene.collisions = false;
        assert_eq!(found(&scene, &[&[(0, &[LEFT])]]), []);
    }

    #[test]
    fn robots_collide_only_if_both_are_there_at_the_same_time() {
        let scene = scene(&[Pose::new(-1.0, 0.0, 0.0), Pose::new(0.0, -1.0, FRAC_PI_2)], vec![]);
        let collisions = found(&scene, &[&[(0, &[AHEAD]), (1, &[AHEAD])]]);
        let [collision] = collisions.as_slice() else { panic!("{collisions:?}") };
        assert!(
            collision.robot == 0
                && collision.with == SceneObject::Robot(1)
                && collision.other_action.is_some()
        );
        let time = collision.time.unwrap();
        assert!((collision.pose.x + 0.3).abs() < 0.002 && (time - 7.1).abs() < 0.05, "{collision:?}");
        assert_eq!(found(&scene, &[&[(0, &[AHEAD])], &[(1, &[AHEAD])]]), []);
    }

    #[test]
    fn a_robot_that_stands_still_is_hit_too() {
        let scene = scene(&[Pose::new(1.0, 0.0, 0.0), Pose::default()], vec![]);
        let collisions = found(&scene, &[&[(1, &[AHEAD])]]);
        let [collision] = collisions.as_slice() else { panic!("{collisions:?}") };
        assert!(
            collision.robot == 1
                && collision.with == SceneObject::Robot(0)
                && collision.other_action.is_none(),
            "{collision:?}"
        );
        assert!((collision.pose.x - 0.7).abs() < 0.002, "{collision:?}");
    }

    /// Two robots whose paths cross at the origin, 1 m ahead of each.
    fn crossing() -> Scene {
        scene(&[Pose::new(-1.0, 0.0, 0.0), Pose::new(0.0, -1.0, FRAC_PI_2)], vec![])
    }

    #[test]
    fn robots_do_not_collide_after_an_action_of_unknown_duration() {
        // Where each robot is once the unknown action begins is not known, nor when others start after it.
        for schedule in [
            [&[(0, &[MotionPrimitive::Unknown { reach: 0.0 }, AHEAD][..]), (1, &[AHEAD])][..], &[]],
            [&[(0, &[AHEAD]), (1, &[MotionPrimitive::Unknown { reach: 0.0 }, AHEAD])], &[]],
            [&[(0, &[MotionPrimitive::Unknown { reach: 0.0 }])], &[(0, &[AHEAD]), (1, &[AHEAD])]],
            [&[(0, &[MotionPrimitive::Unknown { reach: 0.0 }])], &[(1, &[AHEAD])]],
        ] {
            assert_eq!(found(&crossing(), &schedule), [], "{schedule:?}");
        }
        // A third robot's unknown action leaves the two where they are, but not when.
        let mut scene = crossing();
        scene.robots.push(Robot { start: Pose::new(5.0, 5.0, 0.0), ..scene.robots[0].clone() });
        let before: &[(usize, &[MotionPrimitive])] = &[(2, &[MotionPrimitive::Unknown { reach: 0.0 }])];
        assert_eq!(found(&scene, &[before, &[(0, &[AHEAD]), (1, &[AHEAD])]]), []);
        let collisions = found(
            &scene,
            &[&[(0, &[AHEAD]), (1, &[AHEAD]), (2, &[MotionPrimitive::Unknown { reach: 0.0 }])]],
        );
        assert!(
            collisions.len() == 1 && collisions[0].time.is_some(),
            "it delays nobody in its own group: {collisions:?}"
        );
    }

    #[test]
    fn robots_collide_before_an_action_of_unknown_duration() {
        let collisions =
            found(&crossing(), &[&[(0, &[AHEAD, MotionPrimitive::Unknown { reach: 0.0 }]), (1, &[AHEAD])]]);
        let [collision] = collisions.as_slice() else { panic!("{collisions:?}") };
        assert!(collision.robot == 0 && collision.with == SceneObject::Robot(1), "{collision:?}");
        assert!(collision.time.is_some_and(|time| (time - 7.1).abs() < 0.05), "{collision:?}");
        // One that turns on the spot or explores from there may be anywhere when the other comes by.
        let to_the_middle = MotionPrimitive::Move { distance: 1.0, speed: 0.1 };
        let later = MotionPrimitive::Move { distance: 2.0, speed: 0.01 };
        assert_eq!(
            found(
                &crossing(),
                &[&[(0, &[to_the_middle, MotionPrimitive::Unknown { reach: 0.0 }]), (1, &[later])]]
            ),
            []
        );
        assert_eq!(found(&crossing(), &[&[(0, &[to_the_middle]), (1, &[later])]]).len(), 1);
    }

    #[test]
    fn an_obstacle_on_a_known_path_is_hit_at_an_unknown_time() {
        let wall = Obstacle::wall("w", (1.0, -1.0), (1.0, 1.0), 0.1);
        let scene = scene(&[Pose::default(), Pose::new(-5.0, -1.0, FRAC_PI_2)], vec![wall]);
        let collisions =
            found(&scene, &[&[(1, &[MotionPrimitive::Unknown { reach: 0.0 }])], &[(0, &[AHEAD])]]);
        assert!(
            collisions.len() == 1
                && collisions[0].time.is_none()
                && collisions[0].with == SceneObject::Obstacle(0),
            "{collisions:?}"
        );
        assert!((collisions[0].pose.x - 0.8).abs() < 0.001, "{collisions:?}");
        assert_eq!(
            found(&scene, &[&[(0, &[MotionPrimitive::Unknown { reach: 0.0 }, AHEAD])]]),
            [],
            "nor is its path"
        );
    }

    /// A post of 10 cm that moves.
    fn post(rows: &[[f64; 3]], repeats: bool) -> Obstacle {
        let points = rows.iter().map(|&[time, x, y]| Waypoint { time, x, y }).collect();
        let shape = Shape::Cylinder { radius: 0.1 };
        Obstacle::moving("post", 0.0, shape, Trajectory::new(points, repeats).unwrap())
    }

    #[test]
    fn an_obstacle_that_moves_is_met_where_it_is_at_that_time() {
        let found_in = |rows: &[[f64; 3]], repeats| {
            let scene = scene(&[Pose::default()], vec![post(rows, repeats)]);
            found(&scene, &[&[(0, &[AHEAD, AHEAD])]])
        };
        // It steps aside before the robot, which is there after 7.6 s, or after that.
        assert_eq!(found_in(&[[0.0, 1.0, 0.0], [4.0, 1.0, 0.0], [6.0, 1.0, 1.0]], false), []);
        let found = found_in(&[[0.0, 1.0, 0.0], [9.0, 1.0, 0.0], [11.0, 1.0, 1.0]], false);
        let [collision] = found.as_slice() else { panic!("{found:?}") };
        assert!((collision.pose.x - 0.75).abs() < 0.002, "{collision:?}");
        assert!(collision.time.is_some_and(|time| (time - 7.6).abs() < 0.02), "{collision:?}");
        // It comes back into the way of the second move, which ends at 4 m.
        let aside = [[0.0, 3.0, 0.0], [5.0, 3.0, 1.0]];
        assert_eq!(found_in(&aside, false), []);
        let found = found_in(&aside, true);
        assert!(found.len() == 1 && found[0].action.action == 1, "{found:?}");
        // It meets the robot from the front: their speeds add up.
        let found = found_in(&[[0.0, 2.1, 0.0], [10.0, 0.1, 0.0]], false);
        let [collision] = found.as_slice() else { panic!("{found:?}") };
        assert!(
            collision.time.is_some_and(|time| (time - (1.85 + 0.01) / 0.3).abs() < 0.03),
            "{collision:?}"
        );
        // However fast, it does not pass through.
        let found = found_in(&[[0.0, 0.5, 50.0], [5.0, 0.5, 50.0], [5.001, 0.5, -50.0]], false);
        assert!(
            found.len() == 1 && found[0].time.is_some_and(|time| (5.0..5.001).contains(&time)),
            "{found:?}"
        );
    }

    #[test]
    fn the_nearer_obstacle_is_met_first_whether_it_moves_or_not() {
        let wall = |x| Obstacle::wall("w", (x, -1.0), (x, 1.0), 0.1);
        for (x, first) in [(0.9, 0), (1.5, 1)] {
            let scene = scene(&[Pose::default()], vec![wall(x), post(&[[0.0, 1.2, 0.0]], false)]);
            let collisions = found(&scene, &[&[(0, &[AHEAD])]]);
            assert!(
                collisions.len() == 1 && collisions[0].with == SceneObject::Obstacle(first),
                "{x}: {collisions:?}"
            );
        }
    }

    #[test]
    fn where_a_moving_obstacle_is_at_an_unknown_time_is_not_known() {
        let scene = scene(
            &[Pose::default(), Pose::new(-5.0, -1.0, FRAC_PI_2)],
            vec![post(&[[0.0, 1.0, 0.0], [9e5, 1.0, 0.0]], true)],
        );
        assert_eq!(
            found(&scene, &[&[(1, &[MotionPrimitive::Unknown { reach: 0.0 }])], &[(0, &[AHEAD])]]),
            []
        );
        assert_eq!(found(&scene, &[&[(0, &[AHEAD])]]).len(), 1);
    }

    #[test]
    fn collisions_after_the_end_of_a_truncated_list_are_not_reported() {
        let wall = Obstacle::wall("w", (3.0, -1.0), (3.0, 1.0), 0.1);
        let scene = scene(&[Pose::default(), Pose::new(2.0, -2.0, FRAC_PI_2)], vec![wall]);
        let robots: Vec<_> = scene
            .robots
            .iter()
            .map(|robot| RobotPlan { model: robot.model().unwrap(), start: robot.start })
            .collect();
        // It comes to where the other one is after its first move, which has gone on by then.
        let slowly = MotionPrimitive::Move { distance: 2.0, speed: 0.05 };
        let runs =
            vec![Run { robot: 0, actions: vec![AHEAD, AHEAD] }, Run { robot: 1, actions: vec![slowly] }];
        let mut plan = plan(&robots, &[runs]).unwrap();
        let found = collisions(&scene, &plan);
        assert!(found.len() == 1 && found[0].with == SceneObject::Obstacle(0), "{found:?}");
        plan.robots[0].legs.truncate(1);
        plan.robots[0].truncated = true;
        assert_eq!(collisions(&scene, &plan), [], "nor does it stay where the list ends");
    }

    #[test]
    fn the_search_has_a_bound() {
        // Along a wall that is half a millimetre from a touch, each step is a millimetre.
        let found_in = |x: f64| {
            let beside = Obstacle::wall("beside", (-1.0, 0.2015), (40.0, 0.2015), 0.1);
            let ahead = Obstacle::wall("ahead", (x, -1.0), (x, 0.0), 0.1);
            let scene = scene(&[Pose::default()], vec![beside, ahead]);
            found(&scene, &[&[(0, &[MotionPrimitive::Move { distance: 30.0, speed: 0.1 }])]]).len()
        };
        assert_eq!((found_in(15.0), found_in(25.0)), (1, 0));
    }

    #[test]
    fn a_body_at_rest_is_met_by_an_obstacle_that_comes() {
        let scene = scene(&[], vec![post(&[[0.0, 3.0, 0.0], [10.0, 3.0, 0.0], [40.0, 0.0, 0.0]], false)]);
        let mut obstacles = Obstacles::of(&scene);
        let body = Body { length: 0.3, width: 0.3 };
        let way = |start| BodyMotion { start, speed: 0.0, pose: |_: f64| Pose::default() };
        let seconds = obstacles.moving[0].meet(body, &way(5.0), 90.0).unwrap();
        assert!((seconds - (5.0 + 27.5)).abs() < 0.02, "{seconds}");
        assert_eq!(obstacles.moving[0].meet(body, &way(5.0), 30.0), None);
        assert_eq!(obstacles.moving[0].meet(body, &way(50.0), 1.0), Some(0.0), "it has come before");
    }

    #[test]
    fn a_bay_is_free_up_to_its_bottom() {
        // A U that opens to the left, with 0.8 m between its arms: narrower than the hull of its corners is long.
        let corners = [
            (0.5, -0.6),
            (2.0, -0.6),
            (2.0, 0.6),
            (0.5, 0.6),
            (0.5, 0.4),
            (1.8, 0.4),
            (1.8, -0.4),
            (0.5, -0.4),
        ];
        for corners in [corners.to_vec(), corners.into_iter().rev().collect()] {
            let bay = Obstacle::fixed("u", Pose::default(), Shape::Polygon(corners));
            let scene = scene(&[Pose::default()], vec![bay]);
            let collisions = found(&scene, &[&[(0, &[AHEAD])]]);
            assert!(collisions.len() == 1 && (collisions[0].pose.x - 1.65).abs() < 0.001, "{collisions:?}");
            let shorter = MotionPrimitive::Move { distance: 1.6, speed: 0.1 };
            assert_eq!(found(&scene, &[&[(0, &[shorter])]]), []);
            let across = MotionPrimitive::Move { distance: 1.0, speed: 0.1 };
            let collisions = found(&scene, &[&[(0, &[across, LEFT, across])]]);
            assert!(
                collisions.len() == 1 && (collisions[0].pose.y - 0.25).abs() < 0.001,
                "the arm: {collisions:?}"
            );
        }
    }

    prop_compose! {
        fn actions()(moves in prop::collection::vec((0..3, -2.0..2.0, 0.05..0.5), 1..5)) -> Vec<MotionPrimitive> {
            let action = |&(which, amount, speed): &(i32, f64, f64)| match which {
                0 => MotionPrimitive::Turn { angle: amount, speed: motion::RIM_SPEED },
                _ => MotionPrimitive::Move { distance: amount, speed },
            };
            moves.iter().map(action).collect()
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]

        /// Against a look at the robots every few milliseconds: the same things are met, at the same time.
        #[test]
        fn collisions_are_those_that_a_close_look_finds(
            first in actions(), second in actions(), together: bool,
            x in -1.0..1.0, y in -1.0..1.0, theta in -3.0..3.0, goal in (-1.0..1.0, -1.0..1.0), repeats: bool,
        ) {
            let corners = [(0.0, 0.0), (0.6, 0.0), (0.6, 0.5), (0.5, 0.5), (0.5, 0.1), (0.0, 0.1)];
            let hook = Obstacle::fixed("hook", Pose::new(0.6, 0.7, theta), Shape::Polygon(corners.to_vec()));
            let wall = Obstacle::wall("w", (-1.0, -0.9), (0.5, -1.2), 0.02);
            let way = [[2.0, 1.5, -1.5], [9.0, goal.0, goal.1], [14.0, -1.5, 1.0]];
            let scene =
                scene(&[Pose::default(), Pose::new(x, y, theta)], vec![hook, wall, post(&way, repeats)]);
            prop_assume!(scene.overlaps().is_empty());
            let groups: Vec<Vec<(usize, &[MotionPrimitive])>> = if together {
                vec![vec![(0, &first), (1, &second)]]
            } else {
                vec![vec![(0, &first)], vec![(1, &second)]]
            };
            let schedule: Vec<&[(usize, &[MotionPrimitive])]> = groups.iter().map(Vec::as_slice).collect();
            let found = found(&scene, &schedule);

            let robots: Vec<_> =
                scene.robots.iter().map(|robot| RobotPlan { model: robot.model().unwrap(), start: robot.start }).collect();
            let runs = |group: &Vec<(usize, &[MotionPrimitive])>| {
                group.iter().map(|&(robot, actions)| Run { robot, actions: actions.to_vec() }).collect()
            };
            let plan = plan(&robots, &groups.iter().map(runs).collect::<Vec<Vec<Run>>>()).unwrap();
            let (mut space, end, step) = (Space::of(&scene), plan.duration.unwrap(), 0.004);
            // Things nearer than the robot moves in two steps may be met between them.
            let doubt = 2.0 * step * 1.3;
            let mut looked: BTreeMap<(usize, usize), (f64, f64)> = BTreeMap::new();
            let mut time = 0.0;
            while time < end + step {
                let bodies: Vec<(Body, Pose)> = scene
                    .robots
                    .iter()
                    .zip(&plan.robots)
                    .map(|(robot, path)| (robot.body, pose_at(path, time)))
                    .collect();
                let mut see = |what: (usize, usize), distance: f64| {
                    let (nearest, contact) = looked.entry(what).or_insert((f64::INFINITY, f64::INFINITY));
                    *nearest = nearest.min(distance);
                    if distance < TOUCH + doubt {
                        *contact = contact.min(time);
                    }
                };
                space.move_to(time);
                for (robot, &(body, pose)) in bodies.iter().enumerate() {
                    // Things that come to a robot between its actions are not looked for.
                    if !acts(&plan.robots[robot], time) {
                        continue;
                    }
                    see((robot, 9), space.nearest(body, pose, 9.0).map_or(9.0, |near| near.distance));
                }
                see((0, 1), distance_between(bodies[0], bodies[1]));
                time += step;
            }
            for (what, (nearest, contact)) in looked {
                let collision = found.iter().find(|collision| match collision.with {
                    SceneObject::Obstacle(_) => what == (collision.robot, 9),
                    SceneObject::Robot(_) => what.1 == 1,
                });
                match collision {
                    None => prop_assert!(nearest >= TOUCH - 1e-9, "{what:?} meet at {nearest}, not found"),
                    Some(collision) => {
                        prop_assert!(nearest < TOUCH + doubt, "{what:?} are {nearest} apart: {collision:?}");
                        let time = collision.time.unwrap();
                        prop_assert!(time >= contact - step, "{what:?} at {contact}, not {time}");
                    }
                }
            }
        }
    }

    fn acts(path: &RobotPath, time: f64) -> bool {
        path.legs.iter().any(|leg| {
            let start = leg.start.unwrap();
            (start..start + leg.duration).contains(&time)
        })
    }

    /// The pose of a robot at a time, looked up leg by leg.
    fn pose_at(path: &RobotPath, time: f64) -> Pose {
        let mut begun = path.legs.iter().filter(|leg| leg.start.is_some_and(|start| start <= time));
        begun.next_back().map_or(path.start, |leg| leg.pose_at(time - leg.start.unwrap()))
    }
}
