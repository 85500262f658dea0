//! `pydslrep/plannedPath`, a request of our own, and `pydslrep/plannedPathChanged`, the notification that goes with it.
//! Both are described in `docs/protocol.md`.

use pydslrep_analysis::Fingerprint;
use pydslrep_ide as ide;
use pydslrep_scene::{self as scenery, Mount, Shape};
use serde::Serialize;
use serde_json::Value;
use tower_lsp::jsonrpc::Result;
use tower_lsp::ls_types::notification::Notification;
use tower_lsp::ls_types::request::Request;

use crate::chosen::{ChosenEnvironment, Watched};
use crate::handlers::scripts::{environment, failure};
use crate::message::Outbox;
use crate::state::State;

/// The request.
pub(crate) enum PlannedPath {}

impl Request for PlannedPath {
    type Params = ChosenEnvironment;
    type Result = Value;
    const METHOD: &'static str = "pydslrep/plannedPath";
}

/// The notification.
enum PlannedPathChanged {}

impl Notification for PlannedPathChanged {
    type Params = ChosenEnvironment;
    const METHOD: &'static str = "pydslrep/plannedPathChanged";
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Path {
    environment: String,
    duration: Option<f64>,
    robots: Vec<Robot>,
    obstacles: Vec<Obstacle>,
    collisions: Vec<Collision>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Robot {
    name: String,
    body: Body,
    sensors: Vec<Sensor>,
    poses: Vec<Pose>,
    legs: Vec<Leg>,
    unknown_after: Option<Action>,
}

#[derive(Serialize)]
struct Body {
    length: f64,
    width: f64,
}

#[derive(Serialize)]
struct Sensor {
    name: String,
    x: f64,
    y: f64,
    theta: f64,
    range: f64,
    cone: f64,
}

#[derive(Serialize)]
struct Pose {
    t: Option<f64>,
    x: f64,
    y: f64,
    theta: f64,
    action: Option<Action>,
}

#[derive(Serialize)]
struct Leg {
    action: Action,
    start: Option<f64>,
    duration: f64,
    last: usize,
}

#[derive(Serialize)]
struct Action {
    movement: String,
    index: usize,
    text: String,
}

#[derive(Serialize)]
#[serde(untagged)]
enum Obstacle {
    Round { name: String, centre: (f64, f64), radius: f64 },
    Angular { name: String, corners: Vec<(f64, f64)> },
}

#[derive(Serialize)]
struct Collision {
    robot: String,
    action: Option<Action>,
    t: Option<f64>,
    x: f64,
    y: f64,
    theta: f64,
    with: Met,
}

#[derive(Serialize)]
#[serde(rename_all = "lowercase")]
enum Met {
    Obstacle(String),
    Robot(String),
}

/// The planned path of an environment. From now on the client is notified when it changes.
pub(crate) fn planned_path(state: &mut State, which: &ChosenEnvironment) -> Result<Value> {
    let path = plan(state, which);
    state.watched.retain(|watched| watched.which != *which);
    let fingerprint = fingerprint(state, which);
    state.watched.push(Watched { which: which.clone(), fingerprint, path: path.as_ref().ok().cloned() });
    path
}

fn plan(state: &State, which: &ChosenEnvironment) -> Result<Value> {
    let path = ide::planned_path(&state.database, environment(state, which)?).map_err(failure)?;
    serde_json::to_value(convert(path)).map_err(|error| failure(error.to_string()))
}

fn fingerprint(state: &State, which: &ChosenEnvironment) -> Option<Fingerprint> {
    state.database.fingerprint(environment(state, which).ok()?)
}

/// Notifies the client which of its paths are outdated, each once; it requests them again if it still needs them.
pub(crate) fn announce(state: &mut State, outbox: &Outbox) {
    let watched = std::mem::take(&mut state.watched);
    for mut watched in watched {
        let fingerprint = fingerprint(state, &watched.which);
        // Most edits do not affect the path: then nothing is planned again.
        let is_the_same = fingerprint.is_some() && fingerprint == watched.fingerprint;
        if is_the_same || plan(state, &watched.which).ok() == watched.path {
            watched.fingerprint = fingerprint;
            state.watched.push(watched);
        } else {
            outbox.send_notification::<PlannedPathChanged>(&watched.which);
        }
    }
}

fn convert(path: ide::PlannedPath) -> Path {
    Path {
        environment: path.environment,
        duration: path.duration,
        robots: path.robots.into_iter().map(robot).collect(),
        obstacles: path.obstacles.into_iter().map(obstacle).collect(),
        collisions: path.collisions.into_iter().map(collision).collect(),
    }
}

fn robot(robot: ide::PlannedRobot) -> Robot {
    Robot {
        name: robot.name,
        body: Body { length: robot.body.length, width: robot.body.width },
        sensors: robot.sensors.into_iter().map(sensor).collect(),
        poses: robot.poses.into_iter().map(pose).collect(),
        legs: robot.legs.into_iter().map(leg).collect(),
        unknown_after: robot.unknown_after.map(action),
    }
}

fn sensor(sensor: scenery::Sensor) -> Sensor {
    let Mount { pose, range, cone } = sensor.mount;
    Sensor { name: sensor.name, x: pose.x, y: pose.y, theta: pose.theta, range, cone }
}

fn pose(planned: ide::PlannedPose) -> Pose {
    Pose {
        t: planned.time,
        x: planned.pose.x,
        y: planned.pose.y,
        theta: planned.pose.theta,
        action: planned.action.map(action),
    }
}

fn leg(leg: ide::PlannedLeg) -> Leg {
    Leg { action: action(leg.action), start: leg.start, duration: leg.duration, last: leg.last }
}

fn action(ide::PlannedAction { movement, index, text }: ide::PlannedAction) -> Action {
    Action { movement, index, text }
}

fn obstacle(obstacle: scenery::Obstacle) -> Obstacle {
    if let Shape::Cylinder { radius } = obstacle.shape {
        return Obstacle::Round { name: obstacle.name, centre: (obstacle.pose.x, obstacle.pose.y), radius };
    }
    // Every other shape has its own corners.
    let corners = obstacle.outline(0);
    Obstacle::Angular { name: obstacle.name, corners }
}

fn collision(found: ide::PlannedCollision) -> Collision {
    Collision {
        robot: found.robot,
        action: found.action.map(action),
        t: found.time,
        x: found.pose.x,
        y: found.pose.y,
        theta: found.pose.theta,
        with: match found.with {
            ide::Met::Obstacle(name) => Met::Obstacle(name),
            ide::Met::Robot(name) => Met::Robot(name),
        },
    }
}
