//! The planned run of an environment in its scene, which several rules look at.

use pydslrep_scene::{Collision, Robot, Scene, SceneObject, collisions};
use pydslrep_syntax::Span;
use pydslrep_syntax::ast::{Action, Condition, Entity, Name};

use crate::environment::Environment;
use crate::{EntityId, Facts, plan};

/// The planned run of an environment in its scene; it names no places, so that it holds as long as the environment
/// does.
#[derive(Debug)]
pub(crate) struct PlannedRun {
    pub(super) environment: Environment,
    scene: Scene,
    /// As in the environment.
    pub(super) movements: Vec<EntityId>,
    pub(super) collisions: Vec<Collision>,
    pub(super) out_of_range: Vec<OutOfRange>,
}

impl PlannedRun {
    /// The run of an environment without errors; `None` where the scene has some: those come first.
    pub(crate) fn new(facts: &Facts, id: EntityId) -> Option<Self> {
        let environment = facts.resolved_environment(id)?;
        let movements = facts.movements_of(id)?;
        let scene = facts.scene(id, &environment).ok()?;
        let plan = plan(&environment, &scene).ok()?;
        let collisions = collisions(&scene, &plan);
        let out_of_range = out_of_range(facts, &environment, &scene, &movements);
        Some(Self { environment, scene, movements, collisions, out_of_range })
    }

    /// Returns whether it has problems.
    pub(crate) fn has_problems(&self) -> bool {
        !self.collisions.is_empty() || !self.out_of_range.is_empty()
    }

    pub(super) fn name(&self, object: SceneObject) -> &str {
        match object {
            SceneObject::Robot(robot) => self.scene.robots.get(robot).map_or("", |robot| &robot.name),
            SceneObject::Obstacle(obstacle) => {
                self.scene.obstacles.get(obstacle).map_or("", |obstacle| &obstacle.name)
            }
        }
    }
}

/// A distance of a movement that is beyond what all sensors of its condition can see in a scene.
#[derive(Debug)]
pub(super) struct OutOfRange {
    /// The movement that it is in.
    pub(super) movement: EntityId,
    /// Where it is in that.
    pub(super) span: Span,
    /// The greatest range of the sensors, metres.
    pub(super) range: f64,
    /// The number of sensors.
    pub(super) count: usize,
}

/// The distances that are out of range in the movements of an environment, which has them in the same order.
fn out_of_range(
    facts: &Facts,
    environment: &Environment,
    scene: &Scene,
    movements: &[EntityId],
) -> Vec<OutOfRange> {
    let mut found = Vec::new();
    for (&movement, resolved) in movements.iter().zip(&environment.movements) {
        let (Some(Entity::Movement(tree)), Some(robot)) =
            (facts.tree(movement), scene.robots.get(resolved.robot))
        else {
            continue;
        };
        for condition in tree.all_actions().flat_map(Action::conditions) {
            if let Some((span, range)) = beyond_range(condition, robot) {
                found.push(OutOfRange { movement, span, range, count: condition.sensors.names.len() });
            }
        }
    }
    found
}

/// The distance of a condition that none of its sensors reaches, and how far they do reach. Bumpers alone are another
/// problem.
fn beyond_range(condition: &Condition, robot: &Robot) -> Option<(Span, f64)> {
    let within = condition.within.as_ref()?;
    let distance = within.distance.as_ref()?;
    let metres = distance.value? * within.unit?.0.in_metres();
    let sensor = |name: &Name| robot.sensors.iter().find(|sensor| sensor.name == name.text);
    let sensors: Vec<_> = condition.sensors.names.iter().map(sensor).collect::<Option<_>>()?;
    let measures = sensors.iter().any(|sensor| sensor.kind == pydslrep_scene::SensorKind::Distance);
    let range = sensors.iter().map(|sensor| sensor.mount.range).fold(0.0, f64::max);
    (measures && metres > range).then_some((distance.span, range))
}
