//! An environment with its plan, which `plan` shows and `run` compares with what was driven.

use pydslrep_analysis::environment::Environment;
use pydslrep_kinematics::{ActionIndex, Place, Plan};
use pydslrep_picture::{Picture, Route};
use pydslrep_scene::{Scene, collisions};
use pydslrep_trace::Map;

use crate::failure::Failure;
use crate::run::driven::Driven;
use crate::run::pictures::Pictures;

/// Points of a planned leg in a picture.
const POINTS_PER_LEG: u32 = 24;

/// An environment with its plan.
pub(crate) struct PlannedEnvironment {
    pub(crate) environment: Environment,
    pub(crate) scene: Scene,
    pub(crate) plan: Plan,
}

impl PlannedEnvironment {
    /// Plans an environment in a scene.
    ///
    /// # Errors
    /// If a robot cannot drive.
    pub(crate) fn new(environment: Environment, scene: Scene) -> Result<Self, Failure> {
        let plan = plan(&environment, &scene)?;
        Ok(Self { environment, scene, plan })
    }

    /// Plans again from where robots really started, for a scene in another simulator.
    ///
    /// # Errors
    /// If a robot cannot drive.
    pub(crate) fn start_from(&mut self, driven: &Driven) -> Result<(), Failure> {
        for (robot, path) in self.scene.robots.iter_mut().zip(driven.tracks()) {
            robot.start = path.start().unwrap_or(robot.start);
        }
        self.plan = plan(&self.environment, &self.scene)?;
        Ok(())
    }

    /// The planned route of each robot.
    pub(crate) fn routes(&self) -> Vec<Route> {
        let robots = self.scene.robots.iter().zip(&self.plan.robots);
        let routes = robots.map(|(robot, path)| Route {
            name: robot.name.clone(),
            body: robot.body,
            planned: path.sample(POINTS_PER_LEG),
            unknown_after: path.unknown_after.is_some(),
            possible: path.sample_possible(POINTS_PER_LEG),
            driven: Vec::new(),
            seen: Vec::new(),
            map: Map::default(),
        });
        routes.collect()
    }

    /// Draws routes in the scene, with the collisions of the plan.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub(crate) fn draw(&self, pictures: &Pictures, title: &str, routes: &[Route]) -> Result<(), Failure> {
        let found = collisions(&self.scene, &self.plan);
        let collisions: Vec<(f64, f64)> = found.iter().map(|found| (found.pose.x, found.pose.y)).collect();
        let title = &format!("{}: {title}", self.environment.name);
        let obstacles = &self.scene.obstacles;
        pictures.draw(&Picture { title, routes, obstacles, collisions: &collisions })
    }

    /// The names of an action's listed movement and of the action, as the program writes them.
    pub(crate) fn words(&self, index: ActionIndex, place: &Place) -> (String, String) {
        let found = self.environment.place(index, place);
        found.map_or_else(Default::default, |found| (found.movement.to_owned(), found.text.to_owned()))
    }
}

/// Plans an environment; the error is in words.
fn plan(environment: &Environment, scene: &Scene) -> Result<Plan, Failure> {
    pydslrep_analysis::plan(environment, scene)
        .map_err(|error| Failure::new(format!("`{}` cannot be planned: {error}", environment.name)))
}
