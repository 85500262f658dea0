//! What came of a run: where each robot ended and how far that is off the plan.

use std::time::Duration;

use comfy_table::Table;
use pydslrep_kinematics::Pose;
use pydslrep_picture::Route;
use pydslrep_trace::Track;

use crate::commands::plan::{Planned, fixed, heading};
use crate::driven::Driven;
use crate::output;

/// A finished run.
pub(crate) struct Outcome<'a> {
    pub(crate) planned: &'a Planned,
    pub(crate) driven: &'a Driven,
    /// From the start of the script to its end.
    pub(crate) wall: Duration,
    /// Whether the robots did all they should.
    pub(crate) is_complete: bool,
}

impl Outcome<'_> {
    /// Where each robot should be and is, and how long it took.
    pub(crate) fn table(&self) -> String {
        let table = if self.is_complete { self.comparison() } else { self.ends() };
        format!("{}\n\n{}\n", table.trim_fmt(), output::wrapped(&self.times()))
    }

    fn comparison(&self) -> Table {
        let mut table = output::table(["robot", "", "x m", "y m", "heading °", "off mm", "off °"]);
        let paths = self.planned.plan.robots.iter().zip(self.driven.tracks());
        for (robot, (plan, driven)) in self.planned.scene.robots.iter().zip(paths) {
            let planned = plan.unknown_after.is_none().then(|| plan.end());
            let [x, y, heading] = words(planned);
            table.add_row([
                robot.name.clone(),
                "planned".into(),
                x,
                y,
                heading,
                String::new(),
                String::new(),
            ]);
            let [x, y, heading] = words(driven.end());
            let [off, turned] = offset(planned, driven.end());
            table.add_row([String::new(), "driven".into(), x, y, heading, off, turned]);
        }
        output::align_right(&mut table, &[2, 3, 4, 5, 6]);
        table
    }

    /// A run that was broken off can only be compared with a plan that was broken off too.
    fn ends(&self) -> Table {
        let mut table = output::table(["robot", "", "x m", "y m", "heading °"]);
        for (robot, driven) in self.planned.scene.robots.iter().zip(self.driven.tracks()) {
            let [x, y, heading] = words(driven.end());
            table.add_row([robot.name.clone(), "stopped".into(), x, y, heading]);
        }
        output::align_right(&mut table, &[2, 3, 4]);
        table
    }

    /// What to draw.
    pub(crate) fn routes(&self) -> Vec<Route> {
        let routes = self.planned.routes().into_iter().zip(self.driven.tracks()).enumerate();
        let route = |(index, (route, path)): (usize, (Route, &Track))| {
            let seen = self.driven.seen.of(index);
            let map = self.driven.maps.get(index).cloned().unwrap_or_default();
            Route { driven: path.poses(), seen, map, ..route }
        };
        routes.map(route).collect()
    }

    fn times(&self) -> String {
        let (simulated, wall) = (self.driven.time, self.wall.as_secs_f64());
        let factor = if wall > 0.0 { simulated / wall } else { 0.0 };
        let planned = self
            .planned
            .plan
            .duration
            .map_or_else(String::new, |seconds| format!(" (planned: {} s)", fixed(seconds, 1)));
        format!(
            "{}: {} s{planned} simulated in {} s, {} times real time",
            self.planned.environment.name,
            fixed(simulated, 1),
            fixed(wall, 1),
            fixed(factor, usize::from(factor < 10.0)),
        )
    }
}

fn words(pose: Option<Pose>) -> [String; 3] {
    pose.map_or_else(
        || ["?", "?", "?"].map(str::to_owned),
        |pose| [fixed(pose.x, 3), fixed(pose.y, 3), heading(pose.theta)],
    )
}

/// How far apart two poses are: millimetres and degrees.
fn offset(planned: Option<Pose>, driven: Option<Pose>) -> [String; 2] {
    let (Some(planned), Some(driven)) = (planned, driven) else { return ["", ""].map(str::to_owned) };
    let off = planned.relative(&driven);
    [fixed(off.x.hypot(off.y) * 1000.0, 1), fixed(off.theta.to_degrees().abs(), 2)]
}
