//! A condition: what its sensors are, what they see from where, and where the robot stands that they stop.

use std::f64::consts::PI;

use pydslrep_analysis::environment::{Environment, ResolvedActionKind, Robot};
use pydslrep_analysis::{Database, Driver, EntityId, EntityRef, FileId, scene};
use pydslrep_kinematics::{Model, Pose, Turning, Twist, motion};
use pydslrep_scene::{Sensor, SensorKind, defaults};
use pydslrep_syntax::ast::{Action, Condition, SensorState};

use super::format::number;
use crate::users::environments_using;

/// The details of a condition of an action; `None` where a sensor or the robot is broken.
pub(super) fn describe(
    database: &Database,
    entity: &EntityRef<'_>,
    action: &Action,
    condition: &Condition,
) -> Option<String> {
    let robot = database.robot_of(entity.id)?;
    let mounted = Mounted::find(database, entity.id, &robot);
    let sensors = mounted.sensors(condition)?;
    let within = match &condition.within {
        Some(within) => Some(within.distance.as_ref()?.value? * within.unit?.0.in_metres()),
        None => None,
    };
    let is_detect = condition.state.is_some_and(|(state, _)| state == SensorState::Detect);
    let kind = database.known_statements(entity.id, Some(&robot)).and_then(|known| known.kind(action));
    let then = kind.and_then(|kind| {
        let stop = Stop::of(Driver::new(&robot).ok()?.model(), &kind)?;
        Some(stop.describe(if is_detect { &sensors } else { &[] }, within))
    });
    let text = database.action_text(entity, condition.span);
    let parts = [
        Some(format!("```pydslrep\n{text}\n```\n{}", holds(&sensors, is_detect, within))),
        Some(mounted.table(&sensors)),
        then.or_else(|| when_asked(action).map(str::to_owned)),
    ];
    Some(parts.into_iter().flatten().collect::<Vec<_>>().join("\n\n"))
}

/// When the condition holds.
fn holds(sensors: &[&Sensor], is_detect: bool, within: Option<f64>) -> String {
    let nearer = within.map_or_else(String::new, |metres| format!(" nearer than {} m", number(metres, 3)));
    match (sensors, is_detect) {
        ([sensor], true) => format!("Holds while `{}` detects something{nearer}.", sensor.name),
        ([sensor], false) => format!("Holds while `{}` detects nothing{nearer}.", sensor.name),
        (_, true) => format!("Holds while at least one of its sensors detects something{nearer}."),
        (_, false) => format!("Holds while none of its sensors detects anything{nearer}."),
    }
}

/// When a condition is asked that stops no drive.
fn when_asked(action: &Action) -> Option<&'static str> {
    use pydslrep_syntax::ast::ActionKind as Statement;
    match action.kind {
        Statement::If(_) => Some("It is asked once, of the latest step, which takes no time."),
        Statement::Repeat(_) => {
            Some("It is asked before each round, of the latest step, which takes no time.")
        }
        _ => None,
    }
}

/// A robot with its sensors where they are in a scene.
struct Mounted {
    robot: pydslrep_scene::Robot,
    /// The environment whose scene it is.
    environment: Option<String>,
}

impl Mounted {
    /// In the first environment that uses its movement and can run; else in a scene that says nothing of it.
    fn find(database: &Database, movement: EntityId, robot: &Robot) -> Self {
        let home = database.file_of(movement);
        let files: Vec<FileId> =
            home.into_iter().chain(home.into_iter().flat_map(|home| database.importing(home))).collect();
        let environments = environments_using(database, movement, &files);
        let found = environments.into_iter().find_map(|id| Self::in_scene(database, id, &robot.name));
        found.unwrap_or_else(|| {
            let wheels =
                robot.wheels.iter().map(|wheel| pydslrep_scene::Wheel::new(&wheel.name, wheel.radius));
            let sensors = robot.sensors.iter().map(|sensor| (sensor.name.clone(), sensor.kind)).collect();
            let robot = pydslrep_scene::Robot::new(&robot.name, robot.drive, wheels.collect(), sensors);
            Self { robot, environment: None }
        })
    }

    fn in_scene(database: &Database, id: EntityId, robot: &str) -> Option<Self> {
        let environment: Environment = database.environment(id).ok()?;
        let scene = database.scene(id, &environment).unwrap_or_else(|_| scene(&environment));
        let robot = scene.robots.into_iter().find(|other| other.name == robot)?;
        Some(Self { robot, environment: Some(environment.name) })
    }

    /// The sensors that a condition names.
    fn sensors(&self, condition: &Condition) -> Option<Vec<&Sensor>> {
        let names = condition.sensors.names.iter();
        let sensors: Option<Vec<&Sensor>> =
            names.map(|name| self.robot.sensors.iter().find(|sensor| sensor.name == name.text)).collect();
        sensors.filter(|sensors| !sensors.is_empty())
    }

    fn table(&self, sensors: &[&Sensor]) -> String {
        let rows: String = sensors.iter().map(|sensor| row(sensor)).collect();
        let scene = self.environment.as_ref().map_or_else(
            || "Unless a scene says otherwise.".to_owned(),
            |environment| format!("In the scene of `{environment}`."),
        );
        format!("| sensor | mounted | sees |\n|---|---|---|\n{rows}\n{scene}")
    }
}

fn row(sensor: &Sensor) -> String {
    let mount = &sensor.mount;
    let range = number(mount.range, 3);
    let sees = match sensor.kind {
        SensorKind::Distance => format!("{range} m, in a cone of {}°", number(mount.cone.to_degrees(), 1)),
        SensorKind::Bumper => format!("what it touches: {range} m"),
    };
    format!("| `{}` | {} | {sees} |\n", sensor.name, place(&mount.pose))
}

/// Where a sensor is on its robot and which way it faces.
fn place(pose: &Pose) -> String {
    let side = |metres: f64, ahead: &str, behind: &str| {
        let size = number(metres.abs(), 3);
        (size != "0").then(|| format!("{size} m {}", if metres > 0.0 { ahead } else { behind }))
    };
    let (along, across) = (side(pose.x, "ahead", "behind"), side(pose.y, "to the left", "to the right"));
    let at: Vec<String> = along.into_iter().chain(across).collect();
    let at = if at.is_empty() { "in the middle".to_owned() } else { at.join(" and ") };
    format!("{at}, facing {}", facing(pose.theta))
}

fn facing(theta: f64) -> String {
    match number(theta.to_degrees(), 1).as_str() {
        "0" => "ahead".to_owned(),
        "90" => "left".to_owned(),
        "-90" => "right".to_owned(),
        "180" | "-180" => "back".to_owned(),
        degrees => {
            let side = if degrees.starts_with('-') { "right" } else { "left" };
            format!("{}° to the {side}", degrees.trim_start_matches('-'))
        }
    }
}

/// The braking of a robot at its highest speed, once a condition stops it.
struct Stop {
    twist: Twist,
    /// Rim speed, metres per second.
    speed: f64,
    /// The distance that the fastest rim moves per metre, or per radian, of the robot.
    rim: f64,
}

impl Stop {
    /// That of an action; `None` where nothing moves while the condition is asked.
    fn of(model: &Model, kind: &ResolvedActionKind) -> Option<Self> {
        let (twist, speed) = match kind {
            ResolvedActionKind::Move { distance, speed, until: Some(_) } => {
                let ahead = distance.map_or(1.0, f64::signum);
                (Twist { vx: ahead, ..Twist::default() }, *speed)
            }
            ResolvedActionKind::Turn { circle, speed, until: Some(_), .. } => {
                let turning = circle.map_or(model.turning(), |circle| Turning::OnCircle {
                    radius: if circle.reverse { -circle.radius } else { circle.radius },
                });
                (turning.twist(1.0), *speed)
            }
            ResolvedActionKind::TurnUntil { .. } => (model.turning().twist(1.0), motion::RIM_SPEED),
            _ => return None,
        };
        Some(Self { twist, speed, rim: model.fastest_rim(twist) })
    }

    /// Describes how far the robot continues; `sensors` are those that detect something then, at most at the distance
    /// `within`.
    fn describe(&self, sensors: &[&Sensor], within: Option<f64>) -> String {
        let (ramp, step) = self.rim_way();
        let speed = number(self.speed * 100.0, 3);
        let way = self.way(ramp + step);
        format!(
            "When it holds, the robot brakes. From {speed} cm/s it stands {way} farther on: v²/2a = {} cm and a step of {} cm at the \
             fastest rim.{}",
            number(ramp * 100.0, 1),
            number(step * 100.0, 1),
            self.clearance(sensors, within, (ramp + step) / self.rim),
        )
    }

    /// Returns the distances that the fastest rim moves while braking, and in the step before, in metres.
    fn rim_way(&self) -> (f64, f64) {
        (self.speed * self.speed / (2.0 * motion::RIM_ACCELERATION), self.speed * motion::STEP)
    }

    fn way(&self, rim: f64) -> String {
        let amount = rim / self.rim;
        let centimetres = |metres: f64| format!("{} cm", number(metres * 100.0, 1));
        if self.twist.omega == 0.0 {
            return centimetres(amount);
        }
        let degrees = number(amount.to_degrees(), 1);
        if self.twist.vx == 0.0 {
            return format!("{degrees}°");
        }
        format!("{degrees}° or {}", centimetres(amount * self.twist.vx.abs()))
    }

    /// Describes the remaining distance to an obstacle that the robot drove straight towards.
    fn clearance(&self, sensors: &[&Sensor], within: Option<f64>, way: f64) -> String {
        if self.twist.omega != 0.0 {
            return String::new();
        }
        let ahead = if self.twist.vx > 0.0 { 0.0 } else { PI };
        let sentence = |sensor: &&&Sensor| {
            let seen = within.map_or(sensor.mount.range, |within| within.min(sensor.mount.range));
            let (name, left) = (&sensor.name, seen - way);
            if left > 0.0 {
                let left = number(left * 100.0, 1);
                format!(" What `{name}` detects straight ahead is then {left} cm away.")
            } else {
                format!(" That is too late for what `{name}` detects straight ahead.")
            }
        };
        let faces = |sensor: &&&Sensor| (sensor.mount.pose.theta.abs() - ahead).abs() < defaults::CONE / 2.0;
        sensors.iter().filter(faces).map(|sensor| sentence(&sensor)).collect()
    }
}
