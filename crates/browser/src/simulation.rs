//! The simulation of an environment, as `pydslrep sim` has it.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Duration;

use pydslrep_analysis::{Blocked, Diagnostic};
use pydslrep_simulator::Session;
use pydslrep_workspace::{MemoryFiles, SceneError, Workspace};
use ropey::Rope;
use serde::Deserialize;

/// The input of a simulation.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
struct Input {
    /// Texts by absolute paths: the program and, as far as it needs them, what it imports, scenes and settings.
    files: BTreeMap<String, String>,
    /// The program's path.
    program: String,
    /// The environment; may be omitted where there is only one.
    environment: Option<String>,
    /// The seed of the scene's noise, in place of the scene's.
    seed: Option<u64>,
}

/// A simulation.
#[derive(Debug)]
pub(crate) struct Simulation {
    environment: String,
    pub(crate) session: Session,
}

impl Simulation {
    /// A stopped simulation; `input` is the JSON of an [`Input`].
    pub(crate) fn new(input: &str) -> Result<Self, String> {
        let Input { files, program, environment, seed } =
            serde_json::from_str(input).map_err(|error| error.to_string())?;
        let text = files.get(&program).ok_or_else(|| format!("{program} is not among the files"))?.clone();
        let memory = MemoryFiles::default();
        for (path, text) in files {
            memory.write(path, &text);
        }
        let mut workspace = Workspace::new(Arc::new(memory));
        workspace.open(&program, Rope::from_str(&text));
        let database = workspace.database();
        let file = database.file(&program).ok_or_else(|| format!("{program} is not a program"))?;
        let id = workspace
            .choose_environment(file, environment.as_deref())
            .map_err(|error| format!("{program}: {error}"))?;
        let environment = database.environment(id).map_err(|blocked| reason(&blocked))?;
        let mut scene = workspace.scene(file, &environment).map_err(|error| problem(&error))?;
        scene.seed = seed.unwrap_or(scene.seed);
        let mut session = Session::of_scene(scene).map_err(|error| error.to_string())?;
        session.record();
        Ok(Self { environment: environment.name, session })
    }

    pub(crate) fn environment(&self) -> &str {
        &self.environment
    }

    pub(crate) fn robots(&self) -> Vec<String> {
        self.session.world().scene().robots.iter().map(|robot| robot.name.clone()).collect()
    }

    /// x, y and theta of each robot.
    pub(crate) fn poses(&self) -> Vec<f64> {
        let world = self.session.world();
        let poses = (0..world.scene().robots.len()).map(|robot| world.pose(robot));
        poses.flat_map(|pose| [pose.x, pose.y, pose.theta]).collect()
    }

    /// The trace since the last call, as lines of JSON.
    pub(crate) fn take_trace(&mut self) -> Vec<u8> {
        pydslrep_trace::lines(&self.session.take_trace())
    }
}

/// A time from JavaScript, seconds.
pub(crate) fn duration(seconds: f64) -> Duration {
    Duration::try_from_secs_f64(seconds).unwrap_or_default()
}

fn reason(blocked: &Blocked) -> String {
    let errors = blocked.errors.iter().map(|Diagnostic { message, .. }| message.as_str());
    std::iter::once(blocked.reason().as_str()).chain(errors).collect::<Vec<_>>().join("\n")
}

fn problem(error: &SceneError) -> String {
    match error {
        SceneError::Unreadable { key, error } => format!("{key}: {error}"),
        SceneError::Invalid { key, problems } => {
            let problems = problems.iter().map(|problem| format!("{key}: {}", problem.message));
            problems.collect::<Vec<_>>().join("\n")
        }
    }
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;

    const PROGRAM: &str = "import \"parts.pyr\"\nmovement m of a { move 1 meters }\n\
        environment area has { a } robots with { m } moves\n";
    const PARTS: &str = "wheel l with radius 4.5\nwheel r with radius 4.5\n\
        robot a type tw with port 23000 has { l r } wheels\n";

    fn start(change: impl FnOnce(&mut Value)) -> Result<Simulation, String> {
        let mut input = json!({
            "program": "/w/a.pyr",
            "files": {
                "/w/a.pyr": PROGRAM,
                "/w/parts.pyr": PARTS,
                "/w/area.scene.toml": "[robots]\na = { start = [2, 1, 0] }\n",
            },
        });
        change(&mut input);
        Simulation::new(&input.to_string())
    }

    #[test]
    fn robots_are_where_the_scene_says() {
        let simulation = start(|_| {}).unwrap();
        assert_eq!((simulation.environment(), simulation.robots()), ("area", vec!["a".to_owned()]));
        assert_eq!(simulation.poses(), [2.0, 1.0, 0.0]);
    }

    #[test]
    fn what_cannot_be_simulated_is_refused_with_the_reason() {
        let reason = |change: fn(&mut Value)| start(change).unwrap_err();
        assert_eq!(reason(|input| input["program"] = "/b.pyr".into()), "/b.pyr is not among the files");
        let unknown = reason(|input| input["environment"] = "other".into());
        assert_eq!(unknown, "/w/a.pyr: there is no environment `other`");
        let scene = reason(|input| input["files"]["/w/area.scene.toml"] = "wrong = 1".into());
        assert!(scene.starts_with("/w/area.scene.toml: "), "{scene}");
        let errors = reason(|input| input["files"]["/w/parts.pyr"] = "".into());
        assert!(errors.contains("`a`"), "{errors}");
    }
}
