//! `pydslrep/plannedPath`, a request of our own, and `pydslrep/plannedPathChanged`, the notification that goes with it.
//! Both are described in `docs/protocol.md`.

use pydslrep_analysis::MadeOf;
use pydslrep_ide as ide;
use serde::Serialize;
use serde_json::Value;
use tower_lsp::jsonrpc::Result;

use crate::chosen::{ChosenEnvironment, Watched};
use crate::handlers::scripts::{environment, failure};
use crate::message::Outbox;
use crate::state::State;

/// Name of the request.
pub(crate) const PLANNED_PATH: &str = "pydslrep/plannedPath";

/// Name of the notification.
const PLANNED_PATH_CHANGED: &str = "pydslrep/plannedPathChanged";

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Path {
    environment: String,
    duration: Option<f64>,
    robots: Vec<Robot>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Robot {
    name: String,
    poses: Vec<Pose>,
    unknown_after: Option<Action>,
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
struct Action {
    movement: String,
    index: usize,
    text: String,
}

/// The planned path of an environment. From now on the client is told when it changes.
pub(crate) fn planned_path(state: &mut State, which: &ChosenEnvironment) -> Result<Value> {
    let path = plan(state, which);
    state.watched.retain(|watched| watched.which != *which);
    let made_of = made_of(state, which);
    state.watched.push(Watched { which: which.clone(), made_of, path: path.as_ref().ok().cloned() });
    path
}

fn plan(state: &State, which: &ChosenEnvironment) -> Result<Value> {
    let path = ide::planned_path(&state.database, environment(state, which)?).map_err(failure)?;
    serde_json::to_value(convert(path)).map_err(|error| failure(error.to_string()))
}

fn made_of(state: &State, which: &ChosenEnvironment) -> Option<MadeOf> {
    state.database.made_of(environment(state, which).ok()?)
}

/// Tells the client which of the paths that it has are no longer right, each once; it asks again if it still wants them.
pub(crate) fn announce(state: &mut State, outbox: &Outbox) {
    let watched = std::mem::take(&mut state.watched);
    for mut watched in watched {
        let made_of = made_of(state, &watched.which);
        // Most of what is typed is none of its business: then nothing is planned again.
        let is_the_same = made_of.is_some() && made_of == watched.made_of;
        if is_the_same || plan(state, &watched.which).ok() == watched.path {
            watched.made_of = made_of;
            state.watched.push(watched);
        } else {
            outbox.notify(PLANNED_PATH_CHANGED, &watched.which);
        }
    }
}

fn convert(path: ide::PlannedPath) -> Path {
    let action =
        |ide::PlannedAction { movement, index, text }: ide::PlannedAction| Action { movement, index, text };
    let pose = |planned: ide::PlannedPose| Pose {
        t: planned.time,
        x: planned.pose.x,
        y: planned.pose.y,
        theta: planned.pose.theta,
        action: planned.action.map(action),
    };
    let robot = |robot: ide::PlannedRobot| Robot {
        name: robot.name,
        poses: robot.poses.into_iter().map(pose).collect(),
        unknown_after: robot.unknown_after.map(action),
    };
    Path {
        environment: path.environment,
        duration: path.duration,
        robots: path.robots.into_iter().map(robot).collect(),
    }
}
