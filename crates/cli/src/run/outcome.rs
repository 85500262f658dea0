//! The result of a run: where each robot ended and how far that is off the plan.

use std::time::Duration;

use comfy_table::Table;
use pydslrep_kinematics::Pose;
use pydslrep_picture::Route;
use pydslrep_trace::Track;
use serde::Serialize;

use crate::report::numbers::{fixed, heading};
use crate::report::output;
use crate::run::driven::Driven;
use crate::run::planned::PlannedEnvironment;

/// A run that has ended.
pub(crate) struct Outcome<'a> {
    pub(crate) planned: &'a PlannedEnvironment,
    pub(crate) driven: &'a Driven,
    /// Wall time from the start of the script to its end; `None` for a run that was recorded some time.
    pub(crate) wall: Option<Duration>,
    /// True if every movement was completed.
    pub(crate) is_complete: bool,
}

/// The result of a run in metres, radians and seconds.
#[derive(Debug, Serialize)]
pub(crate) struct Figures<'a> {
    environment: &'a str,
    /// True if every movement was completed.
    complete: bool,
    /// Planned duration; `None` if it cannot be planned.
    planned: Option<f64>,
    /// Duration in simulation time.
    simulated: f64,
    /// Duration in wall time; `None` for a run that was recorded some time.
    wall: Option<f64>,
    robots: Vec<RobotFigures<'a>>,
}

/// Where a robot was to end, and where it ended.
#[derive(Debug, Serialize)]
struct RobotFigures<'a> {
    name: &'a str,
    /// `None` if it cannot be planned.
    planned: Option<End>,
    /// `None` if nothing was recorded.
    driven: Option<End>,
    /// The difference of the two; `None` if the run is not complete.
    off: Option<Offset>,
}

#[derive(Debug, Clone, Copy, Serialize)]
struct End {
    x: f64,
    y: f64,
    theta: f64,
}

#[derive(Debug, Serialize)]
struct Offset {
    distance: f64,
    angle: f64,
}

impl From<Pose> for End {
    fn from(Pose { x, y, theta }: Pose) -> Self {
        Self { x, y, theta }
    }
}

impl Outcome<'_> {
    /// The result in numbers.
    pub(crate) fn figures(&self) -> Figures<'_> {
        let paths = self.planned.plan.robots.iter().zip(self.driven.tracks());
        let robots = self.planned.scene.robots.iter().zip(paths).map(|(robot, (plan, driven))| {
            let planned = plan.unknown_after.is_none().then(|| plan.end());
            let driven = driven.end();
            // The end of a plan says nothing about a run that stopped before.
            let off = planned.zip(driven).filter(|_| self.is_complete).map(|(planned, driven)| {
                let off = planned.relative(&driven);
                Offset { distance: off.x.hypot(off.y), angle: off.theta.abs() }
            });
            RobotFigures {
                name: &robot.name,
                planned: planned.map(End::from),
                driven: driven.map(End::from),
                off,
            }
        });
        Figures {
            environment: &self.planned.environment.name,
            complete: self.is_complete,
            planned: self.planned.plan.duration,
            simulated: self.driven.time,
            wall: self.wall.map(|wall| wall.as_secs_f64()),
            robots: robots.collect(),
        }
    }

    /// The routes to draw.
    pub(crate) fn routes(&self) -> Vec<Route> {
        let routes = self.planned.routes().into_iter().zip(self.driven.tracks()).enumerate();
        let route = |(index, (route, path)): (usize, (Route, &Track))| {
            let seen = self.driven.seen(index);
            let map = self.driven.maps.get(index).cloned().unwrap_or_default();
            Route { driven: path.poses(), seen, map, ..route }
        };
        routes.map(route).collect()
    }
}

impl Figures<'_> {
    /// A table and a sentence about times.
    pub(crate) fn table(&self) -> String {
        let table = if self.complete { self.comparison() } else { self.ends() };
        format!("{}\n\n{}\n", table.trim_fmt(), output::wrapped(&self.times()))
    }

    fn comparison(&self) -> Table {
        let mut table = output::table(["robot", "", "x m", "y m", "heading °", "off mm", "off °"]);
        for robot in &self.robots {
            let [x, y, heading] = words(robot.planned);
            table.add_row([robot.name, "planned", &x, &y, &heading, "", ""]);
            let [x, y, heading] = words(robot.driven);
            let [off, turned] = robot.off.as_ref().map_or_else(Default::default, Offset::words);
            table.add_row(["", "driven", &x, &y, &heading, &off, &turned]);
        }
        output::align_right(&mut table, &[2, 3, 4, 5, 6]);
        table
    }

    fn ends(&self) -> Table {
        let mut table = output::table(["robot", "", "x m", "y m", "heading °"]);
        for robot in &self.robots {
            let [x, y, heading] = words(robot.driven);
            table.add_row([robot.name, "stopped", &x, &y, &heading]);
        }
        output::align_right(&mut table, &[2, 3, 4]);
        table
    }

    fn times(&self) -> String {
        let planned =
            self.planned.map_or_else(String::new, |seconds| format!(" (planned: {} s)", fixed(seconds, 1)));
        let (environment, seconds) = (self.environment, fixed(self.simulated, 1));
        let Some(wall) = self.wall else { return format!("{environment}: {seconds} s{planned} recorded") };
        let factor = if wall > 0.0 { self.simulated / wall } else { 0.0 };
        format!(
            "{environment}: {seconds} s{planned} simulated in {} s, {} times real time",
            fixed(wall, 1),
            fixed(factor, usize::from(factor < 10.0)),
        )
    }
}

impl Offset {
    /// Millimetres and degrees.
    fn words(&self) -> [String; 2] {
        [fixed(self.distance * 1000.0, 1), fixed(self.angle.to_degrees(), 2)]
    }
}

fn words(end: Option<End>) -> [String; 3] {
    end.map_or_else(
        || ["?", "?", "?"].map(str::to_owned),
        |end| [fixed(end.x, 3), fixed(end.y, 3), heading(end.theta)],
    )
}

#[cfg(test)]
mod tests {
    use expect_test::expect_file;

    use super::*;

    /// `tsc` holds the types of the extension against this value.
    #[test]
    fn editors_know_the_shape() {
        let end = |x| End { x, y: 0.0, theta: 0.5 };
        let figures = Figures {
            environment: "yard",
            complete: true,
            planned: Some(10.04),
            simulated: 10.06,
            wall: Some(0.55),
            robots: vec![
                RobotFigures {
                    name: "rover",
                    planned: Some(end(1.0)),
                    driven: Some(end(1.001)),
                    off: Some(Offset { distance: 0.001, angle: 0.0 }),
                },
                RobotFigures { name: "idle", planned: None, driven: None, off: None },
            ],
        };
        let json = serde_json::to_string_pretty(&figures).unwrap();
        expect_file!["../../../../editors/vscode/tests/figures.sample.ts"].assert_eq(&format!(
            "// Written by a test of crates/cli/src/run/outcome.rs.\n\
             import type {{ Figures }} from \"../src/figures\";\n\n\
             export const figures: Figures = {json};\n"
        ));
    }
}
