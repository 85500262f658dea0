//! Planned paths: where and when robots will be after each action, without a simulator.

use std::collections::BTreeMap;
use std::fmt;

use crate::{Model, PerWheel, Pose, SpeedProfile, Twist, motion};

/// What a robot is to do next, in numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Action {
    /// Straight ahead along the heading.
    Move {
        /// Metres; negative is backwards.
        distance: f64,
        /// Rim speed in metres per second, above zero.
        speed: f64,
    },
    /// As the robot turns ([`crate::Turning`]), at [`motion::RIM_SPEED`].
    Turn {
        /// Radians; positive is left (counter-clockwise).
        angle: f64,
    },
    /// Something whose end only the world decides (`turn … until`, `slam`).
    Unknown,
}

/// One movement of one robot within a schedule.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// Which robot.
    pub robot: usize,
    /// What it does, in order.
    pub actions: Vec<Action>,
}

/// A robot before its first movement.
#[derive(Debug, Clone, PartialEq)]
pub struct RobotPlan {
    /// Its kinematic model.
    pub model: Model,
    /// Where it starts.
    pub start: Pose,
}

/// The place of an action in a schedule.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ActionIndex {
    /// Which group of the schedule.
    pub group: usize,
    /// Which run of the group.
    pub run: usize,
    /// Which action of the run.
    pub action: usize,
}

/// The drive of one action, from rest to rest.
#[derive(Debug, Clone, PartialEq)]
pub struct Leg {
    /// Which action.
    pub index: ActionIndex,
    /// The pose it starts from.
    pub from: Pose,
    /// The pose it ends at.
    pub to: Pose,
    /// When it starts, seconds; `None` when some earlier action takes an unknown time.
    pub start: Option<f64>,
    /// How long it takes, seconds, with ramps and [`motion::REST`].
    pub duration: f64,
    /// Wheel rates at the highest speed it reaches, rad/s, in the order of the robot's wheels.
    pub rates: PerWheel,
    /// Rim speed over time.
    pub profile: SpeedProfile,
    /// Body motion per metre of rim travel; times whole rim travel it leads from `from` to `to`.
    twist_per_rim: Twist,
}

/// Where a robot is, and when.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimedPose {
    /// Seconds; `None` where that is not known.
    pub time: Option<f64>,
    /// Where it is.
    pub pose: Pose,
}

/// All that is known of one robot's drives.
#[derive(Debug, Clone, PartialEq)]
pub struct RobotPath {
    /// Where the robot starts.
    pub start: Pose,
    /// The drive of each action up to the first unknown one, in order.
    pub legs: Vec<Leg>,
    /// The action whose outcome is unknown and, with it, every later pose of this robot.
    pub unknown_after: Option<ActionIndex>,
}

/// The planned paths of an environment.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// One per robot, in the order given.
    pub robots: Vec<RobotPath>,
    /// Seconds until the last movement ends; `None` when an action takes an unknown time.
    pub duration: Option<f64>,
}

/// Why there is no plan.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum PlanError {
    /// A run names a robot that is not there.
    NoSuchRobot {
        /// The index it names.
        robot: usize,
    },
}

impl fmt::Display for PlanError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoSuchRobot { robot } => {
                write!(f, "a run of the schedule names robot {robot}, which is not there")
            }
        }
    }
}

impl std::error::Error for PlanError {}

impl Leg {
    /// When it ends, seconds; `None` when some earlier action takes an unknown time.
    pub fn end(&self) -> Option<f64> {
        Some(self.start? + self.duration)
    }

    /// The highest speed that any point within `reach` metres of the robot's middle may have, metres per second.
    pub fn top_speed(&self, reach: f64) -> f64 {
        let Twist { vx, vy, omega } = self.twist_per_rim;
        (vx.hypot(vy) + omega.abs() * reach) * self.profile.peak()
    }

    /// The pose `seconds` after the leg's start.
    pub fn pose_at(&self, seconds: f64) -> Pose {
        if seconds >= self.duration {
            return self.to;
        }
        self.from.advance(self.twist_per_rim, self.profile.distance_at(seconds))
    }
}

impl RobotPath {
    /// The last pose that is known.
    pub fn end(&self) -> Pose {
        self.legs.last().map_or(self.start, |leg| leg.to)
    }

    /// The known path, the start first, then `per_leg` poses (at least one) for each leg at equal intervals of time; the
    /// last of them is the leg's end.
    pub fn sample(&self, per_leg: u32) -> Vec<TimedPose> {
        let mut poses = vec![TimedPose { time: Some(0.0), pose: self.start }];
        for leg in &self.legs {
            let at = |seconds: f64| leg.start.map(|start| start + seconds);
            if poses.last().is_some_and(|last| last.time < leg.start) {
                // It waited for others.
                poses.push(TimedPose { time: leg.start, pose: leg.from });
            }
            let inner = (1..per_leg).map(|i| leg.duration * f64::from(i) / f64::from(per_leg));
            poses.extend(inner.map(|seconds| TimedPose { time: at(seconds), pose: leg.pose_at(seconds) }));
            poses.push(TimedPose { time: at(leg.duration), pose: leg.to });
        }
        poses
    }
}

/// The path of one movement alone: from `start` at time 0.
pub fn plan_movement(model: &Model, start: Pose, actions: &[Action]) -> RobotPath {
    let mut path = RobotPath { start, legs: Vec::new(), unknown_after: None };
    drive(&mut path, model, actions, ActionIndex { group: 0, run: 0, action: 0 }, Some(0.0));
    path
}

/// The paths of a whole environment.
///
/// `schedule` is groups one after the other; the runs of a group start together and the next group starts when
/// all of them have ended. An [`Action::Unknown`] makes all later poses of its robot unknown, and the start
/// times of every later group. Two runs of one robot in the same group follow one another.
///
/// # Errors
/// When a run names a robot that is not there.
pub fn plan(robots: &[RobotPlan], schedule: &[Vec<Run>]) -> Result<Plan, PlanError> {
    let mut paths: Vec<RobotPath> = robots
        .iter()
        .map(|robot| RobotPath { start: robot.start, legs: Vec::new(), unknown_after: None })
        .collect();
    let mut clock = Some(0.0);
    for (group, runs) in schedule.iter().enumerate() {
        let mut free_at: BTreeMap<usize, Option<f64>> = BTreeMap::new();
        for (run, Run { robot, actions }) in runs.iter().enumerate() {
            let (Some(path), Some(plan)) = (paths.get_mut(*robot), robots.get(*robot)) else {
                return Err(PlanError::NoSuchRobot { robot: *robot });
            };
            let index = ActionIndex { group, run, action: 0 };
            let free = free_at.entry(*robot).or_insert(clock);
            *free = drive(path, &plan.model, actions, index, *free);
        }
        let all_free =
            |from: f64| free_at.into_values().try_fold(from, |latest, time| Some(latest.max(time?)));
        clock = clock.and_then(all_free);
    }
    Ok(Plan { robots: paths, duration: clock })
}

/// Drives `actions` from the end of `path`; returns when they end.
fn drive(
    path: &mut RobotPath,
    model: &Model,
    actions: &[Action],
    first: ActionIndex,
    mut clock: Option<f64>,
) -> Option<f64> {
    for (number, &action) in actions.iter().enumerate() {
        let index = ActionIndex { action: number, ..first };
        // Once the pose is lost the legs would start from nowhere, but how long they take is still plain.
        if let Some(leg) = leg(model, action, index, path.end(), clock) {
            clock = leg.end();
            if path.unknown_after.is_none() {
                path.legs.push(leg);
            }
        } else {
            clock = None;
            path.unknown_after.get_or_insert(index);
        }
    }
    clock
}

fn leg(model: &Model, action: Action, index: ActionIndex, from: Pose, start: Option<f64>) -> Option<Leg> {
    let (unit, amount, speed) = match action {
        Action::Move { distance, speed } => {
            (Twist { vx: distance.signum(), ..Twist::default() }, distance, speed)
        }
        Action::Turn { angle } => (model.turning().twist(angle), angle, motion::RIM_SPEED),
        Action::Unknown => return None,
    };
    let rim_per_unit = model.fastest_rim(unit);
    let profile = SpeedProfile::new(amount.abs() * rim_per_unit, speed, motion::RIM_ACCELERATION);
    let twist_per_rim = Twist { vx: unit.vx / rim_per_unit, vy: 0.0, omega: unit.omega / rim_per_unit };
    let peak =
        Twist { vx: twist_per_rim.vx * profile.peak(), vy: 0.0, omega: twist_per_rim.omega * profile.peak() };
    let rest = if amount == 0.0 { 0.0 } else { motion::REST };
    Some(Leg {
        index,
        from,
        to: from.advance(unit, amount.abs()),
        start,
        duration: profile.duration() + rest,
        rates: model.inverse(peak).rates,
        profile,
        twist_per_rim,
    })
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::*;
    use crate::model::tests::turning_on_a_circle;
    use crate::{Drive, Geometry};

    fn robot(start: Pose) -> RobotPlan {
        let geometry = Geometry { track: 0.30, wheelbase: 0.25 };
        RobotPlan { model: Model::new(Drive::TwoWheel, &[0.035, 0.035], geometry).unwrap(), start }
    }

    fn forward(distance: f64) -> Action {
        Action::Move { distance, speed: 0.09 }
    }

    const METRE: f64 = 1.0 / 0.09 + 0.18 + motion::REST;
    const QUARTER: f64 = FRAC_PI_2 * 0.15 / 0.09 + 0.18 + motion::REST;

    fn close(a: Option<f64>, b: f64) -> bool {
        a.is_some_and(|a| (a - b).abs() < 1e-9)
    }

    #[test]
    fn a_square_comes_home() {
        let side = [forward(1.0), Action::Turn { angle: FRAC_PI_2 }];
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
        let actions = [forward(-1.0), Action::Turn { angle: -FRAC_PI_2 }, forward(2.0)];
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
            let path = plan_movement(&model, start, &[Action::Turn { angle }]);
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
        let lost = Run { robot: 0, actions: vec![forward(1.0), Action::Unknown, forward(1.0)] };
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
        let plan = plan(&robots, &[run(Action::Unknown), run(forward(1.0))]).unwrap();
        assert_eq!((plan.duration, plan.robots[0].legs.len()), (None, 0));
    }

    #[test]
    fn samples_follow_the_profile() {
        let actions = [forward(0.5), Action::Turn { angle: PI }];
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
        let nothing = [forward(0.0), Action::Turn { angle: 0.0 }, forward(1.0)];
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
        let actions =
            [forward(-1.0), Action::Turn { angle: -PI }, Action::Move { distance: 0.2, speed: 0.4 }];
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
