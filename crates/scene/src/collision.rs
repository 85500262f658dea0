//! Collisions of planned paths.

use pydslrep_kinematics::{ActionIndex, Leg, Plan, Pose, RobotPath};

use crate::{Body, Scene, Space, Thing, distance_between};

/// Bodies nearer to each other than this collide, metres: in a run, contact stops robots there.
const TOUCH: f64 = 0.001;

/// The most distances computed for one robot, or for two; collisions after them are not found. A path takes some for each
/// metre, and more only along something that it nearly touches.
const MOST_STEPS: u32 = 20_000;

/// A robot that would collide with something.
#[derive(Debug, Clone, PartialEq)]
pub struct Collision {
    /// Its index in the scene.
    pub robot: usize,
    /// What it is doing.
    pub action: ActionIndex,
    /// Seconds since the start of the run; `None` if the duration of an earlier action is unknown.
    pub time: Option<f64>,
    /// Where it is.
    pub pose: Pose,
    /// What it collides with.
    pub with: Thing,
    /// What the other robot is doing; `None` if it stands still, or if it is not a robot.
    pub other_action: Option<ActionIndex>,
}

/// Where the robots of a plan would collide with obstacles or each other: for each robot the first obstacle on its path,
/// and for each two robots their first collision. What follows from the first is not reported. In the order of robots;
/// none if the scene has collisions switched off.
pub fn collisions(scene: &Scene, plan: &Plan) -> Vec<Collision> {
    if !scene.collisions {
        return Vec::new();
    }
    let space = Space::of(scene);
    let robots: Vec<(Body, &RobotPath)> =
        scene.robots.iter().zip(&plan.robots).map(|(robot, path)| (robot.body, path)).collect();
    let mut found = Vec::new();
    for (index, &(body, path)) in robots.iter().enumerate() {
        found.extend(with_obstacle(&space, index, body, path));
        let others = robots.iter().enumerate().skip(index + 1);
        found.extend(others.filter_map(|(other, &at)| of_two((index, body, path), (other, at.0, at.1))));
    }
    found
}

/// The radius of a circle around a body.
fn reach(body: Body) -> f64 {
    body.length.hypot(body.width) / 2.0
}

/// The first obstacle on a robot's path. Each step covers the distance to the nearest thing, since nothing can be hit
/// earlier; so nothing is too thin to be found.
fn with_obstacle(space: &Space, robot: usize, body: Body, path: &RobotPath) -> Option<Collision> {
    let mut steps = 0;
    for leg in &path.legs {
        let speed = leg.top_speed(reach(body));
        let mut seconds = 0.0;
        while seconds < leg.duration && steps < MOST_STEPS {
            steps += 1;
            let pose = leg.pose_at(seconds);
            let left = speed * (leg.duration - seconds);
            let Some(near) = space.nearest(body, pose, left + TOUCH) else { break };
            if near.distance < TOUCH {
                let (with, time) = (Thing::Obstacle(near.obstacle), leg.start.map(|start| start + seconds));
                return Some(Collision { robot, action: leg.index, time, pose, with, other_action: None });
            }
            seconds += step(near.distance, speed);
        }
    }
    None
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
    for _ in 0..MOST_STEPS {
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
            let index = |moment: &Moment<'_>| moment.leg.map(|leg| leg.index);
            let (robot, other, me, you) =
                if one.leg.is_some() { (a.0, b.0, one, two) } else { (b.0, a.0, two, one) };
            let (action, with) = (index(&me)?, Thing::Robot(other));
            return Some(Collision {
                robot,
                action,
                time: Some(time),
                pose: me.pose,
                with,
                other_action: index(&you),
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
        let timed = path.legs.iter().map_while(|leg| Some((leg.start?, leg)));
        let legs: Vec<(f64, &Leg)> = timed.collect();
        let is_whole = legs.len() == path.legs.len() && path.unknown_after.is_none();
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
        self.leg.map_or(0.0, |leg| leg.top_speed(reach(body)))
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::f64::consts::FRAC_PI_2;

    use proptest::prelude::*;
    use pydslrep_kinematics::{Action, Drive, RobotPlan, Run, motion, plan};

    use super::*;
    use crate::{Obstacle, Robot, Shape, Wheel};

    const AHEAD: Action = Action::Move { distance: 2.0, speed: 0.1 };
    const LEFT: Action = Action::Turn { angle: FRAC_PI_2 };

    fn scene(starts: &[Pose], obstacles: Vec<Obstacle>) -> Scene {
        let robot = |(index, start): (usize, &Pose)| {
            let wheels = vec![Wheel::new("l", 0.05), Wheel::new("r", 0.05)];
            Robot { start: *start, ..Robot::new(format!("r{index}"), Drive::TwoWheel, wheels, vec![]) }
        };
        Scene { robots: starts.iter().enumerate().map(robot).collect(), obstacles, ..Scene::default() }
    }

    /// Groups of runs: each a robot with its actions.
    fn found(scene: &Scene, schedule: &[&[(usize, &[Action])]]) -> Vec<Collision> {
        let robots: Vec<_> = scene
            .robots
            .iter()
            .map(|robot| RobotPlan { model: robot.model().unwrap(), start: robot.start })
            .collect();
        let group = |group: &&[(usize, &[Action])]| {
            group.iter().map(|&(robot, actions)| Run { robot, actions: actions.to_vec() }).collect()
        };
        let schedule: Vec<Vec<Run>> = schedule.iter().map(group).collect();
        collisions(scene, &plan(&robots, &schedule).unwrap())
    }

    #[test]
    fn a_wall_is_hit_when_and_where_the_body_touches_it() {
        let wall = Obstacle::wall("w", (-1.0, 1.2), (1.0, 1.2), 1e-6);
        let scene = scene(&[Pose::default()], vec![wall]);
        let met = found(&scene, &[&[(0, &[AHEAD, LEFT])], &[(0, &[AHEAD])]]);
        assert_eq!(met, [], "it passes the end of the wall");
        let scene = Scene {
            robots: scene.robots,
            obstacles: vec![Obstacle::wall("w", (1.0, 1.2), (3.0, 1.2), 1e-6)],
            ..Scene::default()
        };
        let met = found(&scene, &[&[(0, &[AHEAD, LEFT])], &[(0, &[AHEAD, AHEAD])]]);
        let [met] = met.as_slice() else { panic!("{met:?}") };
        assert_eq!((met.robot, met.with), (0, Thing::Obstacle(0)));
        assert_eq!(met.action, ActionIndex { group: 1, run: 0, action: 0 });
        assert!((met.pose.y - 1.05).abs() < 0.001 && (met.pose.x - 2.0).abs() < 1e-9, "{met:?}");
        let before = 2.0 / 0.1 + 0.2 + FRAC_PI_2 * 0.15 / 0.09 + 0.18 + 2.0 * motion::REST;
        let after = 1.05 / 0.1 + 0.1;
        assert!(met.time.is_some_and(|time| (time - before - after).abs() < 0.02), "{met:?}");
    }

    #[test]
    fn a_corner_that_turns_into_something_hits_it() {
        let mut scene = scene(&[Pose::default()], vec![Obstacle::wall("w", (-1.0, 0.21), (1.0, 0.21), 0.1)]);
        scene.robots[0].body = Body { length: 0.5, width: 0.3 };
        let met = found(&scene, &[&[(0, &[LEFT])]]);
        assert!(met.len() == 1 && met[0].pose.theta > 0.0 && met[0].pose.theta < 0.3, "{met:?}");
        scene.collisions = false;
        assert_eq!(found(&scene, &[&[(0, &[LEFT])]]), []);
    }

    #[test]
    fn robots_collide_only_if_both_are_there_at_the_same_time() {
        let scene = scene(&[Pose::new(-1.0, 0.0, 0.0), Pose::new(0.0, -1.0, FRAC_PI_2)], vec![]);
        let met = found(&scene, &[&[(0, &[AHEAD]), (1, &[AHEAD])]]);
        let [met] = met.as_slice() else { panic!("{met:?}") };
        assert!(met.robot == 0 && met.with == Thing::Robot(1) && met.other_action.is_some());
        let time = met.time.unwrap();
        assert!((met.pose.x + 0.3).abs() < 0.002 && (time - 7.1).abs() < 0.05, "{met:?}");
        assert_eq!(found(&scene, &[&[(0, &[AHEAD])], &[(1, &[AHEAD])]]), []);
    }

    #[test]
    fn a_robot_that_stands_still_is_hit_too() {
        let scene = scene(&[Pose::new(1.0, 0.0, 0.0), Pose::default()], vec![]);
        let met = found(&scene, &[&[(1, &[AHEAD])]]);
        let [met] = met.as_slice() else { panic!("{met:?}") };
        assert!(met.robot == 1 && met.with == Thing::Robot(0) && met.other_action.is_none(), "{met:?}");
        assert!((met.pose.x - 0.7).abs() < 0.002, "{met:?}");
    }

    /// Two robots whose paths cross at the origin, 1 m ahead of each.
    fn crossing() -> Scene {
        scene(&[Pose::new(-1.0, 0.0, 0.0), Pose::new(0.0, -1.0, FRAC_PI_2)], vec![])
    }

    #[test]
    fn robots_do_not_collide_after_an_action_of_unknown_duration() {
        // Where each robot is once the unknown action begins is not known, nor when others start after it.
        for schedule in [
            [&[(0, &[Action::Unknown, AHEAD][..]), (1, &[AHEAD])][..], &[]],
            [&[(0, &[AHEAD]), (1, &[Action::Unknown, AHEAD])], &[]],
            [&[(0, &[Action::Unknown])], &[(0, &[AHEAD]), (1, &[AHEAD])]],
            [&[(0, &[Action::Unknown])], &[(1, &[AHEAD])]],
        ] {
            assert_eq!(found(&crossing(), &schedule), [], "{schedule:?}");
        }
        // A third robot's unknown action leaves the two where they are, but not when.
        let mut scene = crossing();
        scene.robots.push(Robot { start: Pose::new(5.0, 5.0, 0.0), ..scene.robots[0].clone() });
        let before: &[(usize, &[Action])] = &[(2, &[Action::Unknown])];
        assert_eq!(found(&scene, &[before, &[(0, &[AHEAD]), (1, &[AHEAD])]]), []);
        let met = found(&scene, &[&[(0, &[AHEAD]), (1, &[AHEAD]), (2, &[Action::Unknown])]]);
        assert!(met.len() == 1 && met[0].time.is_some(), "it delays nobody in its own group: {met:?}");
    }

    #[test]
    fn robots_collide_before_an_action_of_unknown_duration() {
        let met = found(&crossing(), &[&[(0, &[AHEAD, Action::Unknown]), (1, &[AHEAD])]]);
        let [met] = met.as_slice() else { panic!("{met:?}") };
        assert!(met.robot == 0 && met.with == Thing::Robot(1), "{met:?}");
        assert!(met.time.is_some_and(|time| (time - 7.1).abs() < 0.05), "{met:?}");
        // One that turns on the spot or explores from there may be anywhere when the other comes by.
        let to_the_middle = Action::Move { distance: 1.0, speed: 0.1 };
        let later = Action::Move { distance: 2.0, speed: 0.01 };
        assert_eq!(found(&crossing(), &[&[(0, &[to_the_middle, Action::Unknown]), (1, &[later])]]), []);
        assert_eq!(found(&crossing(), &[&[(0, &[to_the_middle]), (1, &[later])]]).len(), 1);
    }

    #[test]
    fn an_obstacle_on_a_known_path_is_hit_at_an_unknown_time() {
        let wall = Obstacle::wall("w", (1.0, -1.0), (1.0, 1.0), 0.1);
        let scene = scene(&[Pose::default(), Pose::new(-5.0, -1.0, FRAC_PI_2)], vec![wall]);
        let met = found(&scene, &[&[(1, &[Action::Unknown])], &[(0, &[AHEAD])]]);
        assert!(met.len() == 1 && met[0].time.is_none() && met[0].with == Thing::Obstacle(0), "{met:?}");
        assert!((met[0].pose.x - 0.8).abs() < 0.001, "{met:?}");
        assert_eq!(found(&scene, &[&[(0, &[Action::Unknown, AHEAD])]]), [], "nor is its path");
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
            let bay =
                Obstacle { name: "u".to_owned(), pose: Pose::default(), shape: Shape::Polygon(corners) };
            let scene = scene(&[Pose::default()], vec![bay]);
            let met = found(&scene, &[&[(0, &[AHEAD])]]);
            assert!(met.len() == 1 && (met[0].pose.x - 1.65).abs() < 0.001, "{met:?}");
            let shorter = Action::Move { distance: 1.6, speed: 0.1 };
            assert_eq!(found(&scene, &[&[(0, &[shorter])]]), []);
            let across = Action::Move { distance: 1.0, speed: 0.1 };
            let met = found(&scene, &[&[(0, &[across, LEFT, across])]]);
            assert!(met.len() == 1 && (met[0].pose.y - 0.25).abs() < 0.001, "the arm: {met:?}");
        }
    }

    prop_compose! {
        fn actions()(moves in prop::collection::vec((0..3, -2.0..2.0, 0.05..0.5), 1..5)) -> Vec<Action> {
            let action = |&(which, amount, speed): &(i32, f64, f64)| match which {
                0 => Action::Turn { angle: amount },
                _ => Action::Move { distance: amount, speed },
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
            x in -1.0..1.0, y in -1.0..1.0, theta in -3.0..3.0,
        ) {
            let corners = [(0.0, 0.0), (0.6, 0.0), (0.6, 0.5), (0.5, 0.5), (0.5, 0.1), (0.0, 0.1)];
            let hook = Obstacle {
                name: "hook".to_owned(),
                pose: Pose::new(0.6, 0.7, theta),
                shape: Shape::Polygon(corners.to_vec()),
            };
            let wall = Obstacle::wall("w", (-1.0, -0.9), (0.5, -1.2), 0.02);
            let scene = scene(&[Pose::default(), Pose::new(x, y, theta)], vec![hook, wall]);
            prop_assume!(scene.overlaps().is_empty());
            let groups: Vec<Vec<(usize, &[Action])>> = if together {
                vec![vec![(0, &first), (1, &second)]]
            } else {
                vec![vec![(0, &first)], vec![(1, &second)]]
            };
            let schedule: Vec<&[(usize, &[Action])]> = groups.iter().map(Vec::as_slice).collect();
            let found = found(&scene, &schedule);

            let robots: Vec<_> =
                scene.robots.iter().map(|robot| RobotPlan { model: robot.model().unwrap(), start: robot.start }).collect();
            let runs = |group: &Vec<(usize, &[Action])>| {
                group.iter().map(|&(robot, actions)| Run { robot, actions: actions.to_vec() }).collect()
            };
            let plan = plan(&robots, &groups.iter().map(runs).collect::<Vec<Vec<Run>>>()).unwrap();
            let (space, end, step) = (Space::of(&scene), plan.duration.unwrap(), 0.004);
            // What is nearer than it moves in two steps may be met between them.
            let doubt = 2.0 * step * 0.6;
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
                    let (nearest, met) = looked.entry(what).or_insert((f64::INFINITY, f64::INFINITY));
                    *nearest = nearest.min(distance);
                    if distance < TOUCH + doubt {
                        *met = met.min(time);
                    }
                };
                for (robot, &(body, pose)) in bodies.iter().enumerate() {
                    see((robot, 9), space.nearest(body, pose, 9.0).map_or(9.0, |near| near.distance));
                }
                see((0, 1), distance_between(bodies[0], bodies[1]));
                time += step;
            }
            for (what, (nearest, met)) in looked {
                let collision = found.iter().find(|collision| match collision.with {
                    Thing::Obstacle(_) => what == (collision.robot, 9),
                    Thing::Robot(_) => what.1 == 1,
                });
                match collision {
                    None => prop_assert!(nearest >= TOUCH - 1e-9, "{what:?} meet at {nearest}, not found"),
                    Some(collision) => {
                        prop_assert!(nearest < TOUCH + doubt, "{what:?} are {nearest} apart: {collision:?}");
                        let time = collision.time.unwrap();
                        prop_assert!(time >= met - step, "{what:?} at {met}, not {time}");
                    }
                }
            }
        }
    }

    /// The pose of a robot at a time, looked up leg by leg.
    fn pose_at(path: &RobotPath, time: f64) -> Pose {
        let mut begun = path.legs.iter().filter(|leg| leg.start.is_some_and(|start| start <= time));
        begun.next_back().map_or(path.start, |leg| leg.pose_at(time - leg.start.unwrap()))
    }
}
