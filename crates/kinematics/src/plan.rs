//! Planned paths: where and when robots will be after each action, without a simulator.

use std::collections::BTreeMap;
use std::fmt;

use crate::block::Block;
use crate::path::RobotPath;
use crate::walk::Walk;
use crate::{Model, MotionPrimitive, Movement, Pose, Step, Summary};

/// The maximum number of actions that a plan lists.
pub const MAX_ACTIONS: u64 = 100_000;

/// One movement of one robot within a schedule: actions without statements around them.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// Which robot.
    pub robot: usize,
    /// Its actions, in order.
    pub actions: Vec<MotionPrimitive>,
}

/// A robot before its first movement.
#[derive(Debug, Clone, PartialEq)]
pub struct RobotPlan {
    /// Its kinematic model.
    pub model: Model,
    /// Where it starts.
    pub start: Pose,
}

/// The planned paths of an environment.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// One per robot, in the order given.
    pub robots: Vec<RobotPath>,
    /// Seconds until the last movement ends; `None` when an action takes an unknown time.
    pub duration: Option<f64>,
}

impl Plan {
    /// Returns whether it has more actions than it lists.
    pub fn is_truncated(&self) -> bool {
        self.robots.iter().any(|path| path.truncated)
    }
}

/// Why there is no plan.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum PlanError {
    /// A run names a robot that is not there.
    NoSuchRobot {
        /// The index it names.
        robot: usize,
    },
    /// The schedule names a movement that is not there.
    NoSuchMovement {
        /// The index it names.
        movement: usize,
    },
}

impl fmt::Display for PlanError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoSuchRobot { robot } => {
                write!(f, "a run of the schedule names robot {robot}, which is not there")
            }
            Self::NoSuchMovement { movement } => {
                write!(f, "the schedule names movement {movement}, which is not there")
            }
        }
    }
}

impl std::error::Error for PlanError {}

/// The path of some actions alone: from `start` at time 0.
pub fn plan_movement(model: &Model, start: Pose, actions: &[MotionPrimitive]) -> RobotPath {
    plan_steps(model, start, &Step::flat(actions), &[])
}

/// The path of some steps alone: from `start` at time 0. They may call the movements of `called`, and each of those the
/// ones before it.
pub fn plan_steps(model: &Model, start: Pose, steps: &[Step], called: &[Vec<Step>]) -> RobotPath {
    let called: Vec<(usize, &[Step])> = called.iter().map(|steps| (0, steps.as_slice())).collect();
    let blocks = blocks(&called, &[model]);
    let block = Block::new(model, steps, &|other| blocks.get(other).map(|block| block.summary));
    let mut walk = Walk::new(&blocks, RobotPath::new(start), MAX_ACTIONS);
    walk.run(&block, 0, 0, Some(0.0));
    walk.into_path()
}

/// The path of one step alone: from `start` at time 0. A call in it is one leg; `called` is as for [`Summary::of`].
pub fn plan_step(
    model: &Model,
    start: Pose,
    step: Step,
    called: &dyn Fn(usize) -> Option<Summary>,
) -> RobotPath {
    let block = Block::new(model, &[step], called);
    let mut walk = Walk::new(&[], RobotPath::new(start), MAX_ACTIONS);
    walk.run(&block, 0, 0, Some(0.0));
    walk.into_path()
}

/// The paths of a whole environment of runs without statements that have others inside; see [`plan_schedule`].
///
/// # Errors
/// When a run names a robot that is not there.
pub fn plan(robots: &[RobotPlan], schedule: &[Vec<Run>]) -> Result<Plan, PlanError> {
    let runs = schedule.iter().flatten();
    let movements: Vec<Movement> =
        runs.map(|run| Movement { robot: run.robot, steps: Step::flat(&run.actions) }).collect();
    let mut numbers = 0..movements.len();
    let schedule: Vec<Vec<usize>> =
        schedule.iter().map(|group| numbers.by_ref().take(group.len()).collect()).collect();
    plan_schedule(robots, &movements, &schedule)
}

/// The paths of a whole environment.
///
/// `schedule` is groups one after the other, each of movements by their indices; those of a group start together and the
/// next group starts when all of them have ended. A step whose end is unknown makes all later poses of its robot unknown, and
/// the start times of every later group. Two movements of one robot in the same group follow one another. A movement that
/// others call is listed before them.
///
/// It takes as long as the movements and what is listed of them are, however often they are repeated: at most
/// [`MAX_ACTIONS`] legs, all robots together. Poses and times at the end are right nevertheless.
///
/// # Errors
/// When the schedule names a movement that is not there, or one of a robot that is not there.
pub fn plan_schedule(
    robots: &[RobotPlan],
    movements: &[Movement],
    schedule: &[Vec<usize>],
) -> Result<Plan, PlanError> {
    for &movement in schedule.iter().flatten() {
        let robot = movements.get(movement).ok_or(PlanError::NoSuchMovement { movement })?.robot;
        robots.get(robot).ok_or(PlanError::NoSuchRobot { robot })?;
    }
    let models: Vec<&Model> = robots.iter().map(|robot| &robot.model).collect();
    let steps: Vec<(usize, &[Step])> =
        movements.iter().map(|movement| (movement.robot, movement.steps.as_slice())).collect();
    let blocks = blocks(&steps, &models);
    let mut wanted = vec![0_u64; robots.len()];
    for &movement in schedule.iter().flatten() {
        let want = &mut wanted[movements[movement].robot];
        *want = want.saturating_add(blocks[movement].summary.entries);
    }
    let mut walks: Vec<Walk> = robots
        .iter()
        .zip(shares(&wanted))
        .map(|(robot, max_legs)| Walk::new(&blocks, RobotPath::new(robot.start), max_legs))
        .collect();
    let mut clock = Some(0.0);
    for (group, runs) in schedule.iter().enumerate() {
        let mut free_at: BTreeMap<usize, Option<f64>> = BTreeMap::new();
        for (run, &movement) in runs.iter().enumerate() {
            let robot = movements[movement].robot;
            let free = free_at.entry(robot).or_insert(clock);
            *free = walks[robot].run(&blocks[movement], group, run, *free);
        }
        let all_free =
            |from: f64| free_at.into_values().try_fold(from, |latest, time| Some(latest.max(time?)));
        clock = clock.and_then(all_free);
    }
    Ok(Plan { robots: walks.into_iter().map(Walk::into_path).collect(), duration: clock })
}

/// Returns the block of each movement, given as a robot and its steps. That of a robot without a model is empty.
fn blocks(movements: &[(usize, &[Step])], models: &[&Model]) -> Vec<Block> {
    let mut blocks: Vec<Block> = Vec::with_capacity(movements.len());
    for (robot, steps) in movements {
        let called = |other: usize| {
            let (block, (of, _)) = (blocks.get(other)?, movements.get(other)?);
            (of == robot).then_some(block.summary)
        };
        let block = models.get(*robot).map(|model| Block::new(model, steps, &called));
        blocks.push(block.unwrap_or_default());
    }
    blocks
}

/// Returns the number of actions to list of each robot, given how many it has: all of them if there is room; otherwise
/// robots with few may list them, and the others get equal shares.
fn shares(wanted: &[u64]) -> Vec<u64> {
    let mut order: Vec<usize> = (0..wanted.len()).collect();
    order.sort_by_key(|&robot| wanted[robot]);
    let (mut shares, mut left) = (vec![0; wanted.len()], MAX_ACTIONS);
    for (robot, robots) in order.into_iter().zip((1..=wanted.len() as u64).rev()) {
        shares[robot] = wanted[robot].min(left / robots);
        left -= shares[robot];
    }
    shares
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::*;
    use crate::model::tests::turning_on_a_circle;
    use crate::{ActionIndex, Drive, Geometry, TimedPose, motion};

    fn robot(start: Pose) -> RobotPlan {
        let geometry = Geometry { track: 0.30, wheelbase: 0.25 };
        RobotPlan { model: Model::new(Drive::TwoWheel, &[0.035, 0.035], geometry).unwrap(), start }
    }

    fn forward(distance: f64) -> MotionPrimitive {
        MotionPrimitive::Move { distance, speed: 0.09 }
    }

    fn turn(angle: f64) -> MotionPrimitive {
        MotionPrimitive::Turn { angle, speed: motion::RIM_SPEED }
    }

    const METRE: f64 = 1.0 / 0.09 + 0.18 + motion::REST;
    const QUARTER: f64 = FRAC_PI_2 * 0.15 / 0.09 + 0.18 + motion::REST;

    fn close(a: Option<f64>, b: f64) -> bool {
        a.is_some_and(|a| (a - b).abs() < 1e-9)
    }

    #[test]
    fn a_square_comes_home() {
        let side = [forward(1.0), turn(FRAC_PI_2)];
        let path = plan_movement(&robot(Pose::default()).model, Pose::default(), &side.repeat(4));
        assert_eq!(path.legs.len(), 8);
        assert!(path.end().distance(&Pose::default()) < 1e-12 && path.end().theta.abs() < 1e-12);
        assert!(close(path.legs[7].end(), 4.0 * (METRE + QUARTER)), "{:?}", path.legs[7].end());
        assert!((path.legs[0].rates[0] - 0.09 / 0.035).abs() < 1e-12);
        assert!((path.legs[1].rates[0] + 0.09 / 0.035).abs() < 1e-12);
        assert!((path.legs[1].rates[1] - 0.09 / 0.035).abs() < 1e-12);
    }

    #[test]
    fn backwards_and_right() {
        let actions = [forward(-1.0), turn(-FRAC_PI_2), forward(2.0)];
        let path = plan_movement(&robot(Pose::default()).model, Pose::default(), &actions);
        let end = path.end();
        assert!(end.distance(&Pose::new(-1.0, -2.0, 0.0)) < 1e-12 && (end.theta + FRAC_PI_2).abs() < 1e-12);
        assert!(path.legs[0].rates.iter().all(|&rate| rate < 0.0));
    }

    #[test]
    fn who_cannot_turn_in_place_turns_on_a_circle() {
        let RobotPlan { model, start } = robot(Pose::default());
        let model = turning_on_a_circle(&model, 1.0);
        for (angle, side) in [(PI, 2.0), (-PI, -2.0)] {
            let path = plan_movement(&model, start, &[turn(angle)]);
            let leg = &path.legs[0];
            assert!(leg.to.distance(&Pose::new(0.0, side, 0.0)) < 1e-12, "{leg:?}");
            assert!(close(leg.end(), PI * (1.0 + 0.15) / 0.09 + 0.18 + motion::REST), "{leg:?}");
            let driving = leg.duration - motion::REST;
            assert!(leg.pose_at(driving / 2.0).distance(&Pose::new(1.0, side / 2.0, 0.0)) < 1e-12);
        }
    }

    #[test]
    fn groups_wait_for_their_slowest_run() {
        let robots = [robot(Pose::default()), robot(Pose::new(0.0, -1.0, 0.0))];
        let run = |robot, distance| Run { robot, actions: vec![forward(distance)] };
        let plan = plan(&robots, &[vec![run(0, 1.0), run(1, 2.0)], vec![run(0, 1.0)]]).unwrap();
        let slow = 2.0 / 0.09 + 0.18 + motion::REST;
        assert!(close(plan.robots[0].legs[1].start, slow));
        assert!(close(plan.duration, slow + METRE));
        assert_eq!(plan.robots[0].legs[1].index, ActionIndex { group: 1, run: 0, action: 0 });
        assert!(plan.robots[1].end().distance(&Pose::new(2.0, -1.0, 0.0)) < 1e-12);
    }

    #[test]
    fn unknown_spoils_own_poses_and_everybodys_later_times() {
        let robots = [robot(Pose::default()), robot(Pose::default())];
        let lost = Run {
            robot: 0,
            actions: vec![forward(1.0), MotionPrimitive::Unknown { reach: 0.0 }, forward(1.0)],
        };
        let fine = Run { robot: 1, actions: vec![forward(1.0), forward(1.0)] };
        let again = Run { robot: 0, actions: vec![forward(1.0)] };
        let plan = plan(&robots, &[vec![lost, fine.clone()], vec![again, fine]]).unwrap();
        assert_eq!(plan.robots[0].legs.len(), 1);
        assert_eq!(plan.robots[0].unknown_after, Some(ActionIndex { group: 0, run: 0, action: 1 }));
        let times: Vec<bool> = plan.robots[1].legs.iter().map(|leg| leg.start.is_some()).collect();
        assert_eq!(times, [true, true, false, false]);
        assert!(plan.robots[1].end().distance(&Pose::new(4.0, 0.0, 0.0)) < 1e-12);
        assert_eq!((plan.duration, plan.robots[1].unknown_after), (None, None));
    }

    #[test]
    fn an_unknown_first_group_is_never_forgotten() {
        let robots = [robot(Pose::default())];
        let run = |action| vec![Run { robot: 0, actions: vec![action] }];
        let plan = plan(&robots, &[run(MotionPrimitive::Unknown { reach: 0.0 }), run(forward(1.0))]).unwrap();
        assert_eq!((plan.duration, plan.robots[0].legs.len()), (None, 0));
    }

    #[test]
    fn samples_follow_the_profile() {
        let actions = [forward(0.5), turn(PI)];
        let path = plan_movement(&robot(Pose::default()).model, Pose::default(), &actions);
        let poses = path.sample(100);
        let most = 0.09 * path.legs[0].duration / 100.0 + 1e-12;
        assert!(poses.windows(2).all(|pair| pair[0].pose.distance(&pair[1].pose) <= most));
        assert!(poses.windows(2).all(|pair| pair[0].time < pair[1].time));
        assert_eq!(poses.len(), 201);
        assert_eq!(poses.first(), Some(&TimedPose { time: Some(0.0), pose: Pose::default() }));
        assert_eq!(poses.last(), Some(&TimedPose { time: path.legs[1].end(), pose: path.end() }));
        let driving = path.legs[1].duration - motion::REST;
        assert!((path.legs[1].pose_at(driving / 2.0).theta - FRAC_PI_2).abs() < 1e-12);
        assert_eq!(path.legs[1].pose_at(driving), path.legs[1].to, "then it rests");
    }

    #[test]
    fn samples_show_how_long_a_robot_waits() {
        let robots = [robot(Pose::default()), robot(Pose::default())];
        let run = |robot, distance| vec![Run { robot, actions: vec![forward(distance)] }];
        let plan = plan(&robots, &[run(0, 1.0), run(1, 2.0), run(0, 1.0)]).unwrap();
        let times: Vec<Option<f64>> = plan.robots[0].sample(1).iter().map(|pose| pose.time).collect();
        let again = plan.robots[0].legs[1].start;
        assert_eq!(times, [Some(0.0), plan.robots[0].legs[0].end(), again, plan.duration]);
    }

    #[test]
    fn an_action_of_nothing_takes_no_time() {
        let nothing = [forward(0.0), turn(0.0), forward(1.0)];
        let path = plan_movement(&robot(Pose::default()).model, Pose::default(), &nothing);
        assert!(close(path.legs[2].start, 0.0) && close(path.legs[2].end(), METRE), "{path:?}");
        assert_eq!((path.legs[0].to, path.legs[1].to), (Pose::default(), Pose::default()));
    }

    #[test]
    fn runs_of_one_robot_in_a_group_follow_one_another() {
        // The language refuses such programs (`parallel-conflict`), but no robot can do two things at once.
        let robots = [robot(Pose::default()), robot(Pose::default())];
        let run = |robot, distance| Run { robot, actions: vec![forward(distance)] };
        let plan = plan(&robots, &[vec![run(0, 1.0), run(1, 1.0), run(0, -1.0)]]).unwrap();
        let starts: Vec<Option<f64>> = plan.robots[0].legs.iter().map(|leg| leg.start).collect();
        assert!(close(starts[0], 0.0) && close(starts[1], METRE), "{starts:?}");
        assert!(close(plan.robots[1].legs[0].start, 0.0) && close(plan.duration, 2.0 * METRE));
        assert!(plan.robots[0].end().distance(&Pose::default()) < 1e-12);
    }

    #[test]
    fn no_point_of_a_robot_is_faster_than_its_top_speed_and_some_are_as_fast() {
        let actions = [forward(-1.0), turn(-PI), MotionPrimitive::Move { distance: 0.2, speed: 0.4 }];
        let path = plan_movement(&robot(Pose::default()).model, Pose::default(), &actions);
        for leg in &path.legs {
            let (mut fastest, count) = (0.0_f64, 4_000);
            for step in 0..count {
                let seconds = leg.duration / f64::from(count);
                let [before, after] = [step, step + 1].map(|step| leg.pose_at(f64::from(step) * seconds));
                for (x, y) in [(0.2, 0.0), (-0.2, 0.0), (0.0, 0.2), (0.0, -0.2)] {
                    let [before, after] = [before, after].map(|pose| pose.compose(&Pose::new(x, y, 0.0)));
                    fastest = fastest.max(before.distance(&after) / seconds);
                }
            }
            let top = leg.top_speed(0.2);
            assert!(fastest <= top + 1e-9 && fastest > 0.99 * top, "{fastest} of {top}: {leg:?}");
        }
    }

    #[test]
    fn refuses_a_robot_that_is_not_there() {
        let schedule = [vec![Run { robot: 1, actions: vec![] }]];
        assert_eq!(plan(&[robot(Pose::default())], &schedule), Err(PlanError::NoSuchRobot { robot: 1 }));
    }
}
