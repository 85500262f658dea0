//! Code actions of a program that create the scene of an environment, or add what is missing in it: the robots of the
//! environment at the cursor, the robot there, or the sensor.
//!
//! They write what already holds in an empty scene, so the robots drive as before until somebody changes it.

use pydslrep_analysis::{Database, EntityId, FileId, scene};
use pydslrep_kinematics::heading_degrees;
use pydslrep_scene::{Mount, Robot, Scene, Sensor};
use pydslrep_schema::{Span, as_key};
use pydslrep_syntax::EntityKind;
use pydslrep_syntax::ast::Entity;
use smol_str::SmolStr;

use super::fixes::with_edits;
use super::scene_names::written_names;
use crate::FilePosition;
use crate::cursor::{body, entities_at};

/// An edit of the scene of an environment.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SceneAction {
    /// The program.
    pub program: FileId,
    /// The environment in it.
    pub environment: SmolStr,
    /// The names of the added things, such as `rover`; empty if the scene is created.
    pub added: Vec<String>,
    /// Where in the text of the scene; `None` if there is no scene yet.
    pub span: Option<Span>,
    /// The text to insert.
    pub text: String,
}

/// Returns the edits that create or complete scenes of the declaration at a position, in the order of environments.
pub fn scene_actions(database: &Database, position: FilePosition) -> Vec<SceneAction> {
    let Some(at) =
        entities_at(database, position).into_iter().find(|entity| body(entity).touches(position.offset))
    else {
        return Vec::new();
    };
    let Some(tree) = &at.parse.entity else { return Vec::new() };
    let name = tree.name().map(|name| name.text.as_str());
    let action = match tree {
        Entity::Environment(_) => vec![action(database, at.id, |_, _| true)],
        Entity::Robot(_) => {
            let environments = users(database, at.id).into_iter();
            environments.map(|id| action(database, id, |robot, _| Some(robot) == name)).collect()
        }
        Entity::Sensor(_) => {
            let robots = users(database, at.id).into_iter();
            let environments = robots.flat_map(|robot| users(database, robot)).collect::<Vec<_>>();
            let is_it = |_: &str, sensor: Option<&str>| sensor.is_some() && sensor == name;
            environments.into_iter().map(|id| action(database, id, is_it)).collect()
        }
        _ => Vec::new(),
    };
    let mut actions: Vec<SceneAction> = action.into_iter().flatten().collect();
    actions.dedup();
    actions
}

/// The environments that list a robot, or the robots that carry a sensor.
fn users(database: &Database, id: EntityId) -> Vec<EntityId> {
    let (Some(home), Some(tree)) = (database.file_of(id), database.tree(id)) else { return Vec::new() };
    let (Some(kind), Some(name)) = (tree.kind(), tree.name().map(|name| &name.text)) else {
        return Vec::new();
    };
    let user_kind = if kind == EntityKind::Robot { EntityKind::Environment } else { EntityKind::Robot };
    let files = std::iter::once(home).chain(database.importing(home));
    let resolving = files.filter(|file| database.resolve(*file, kind, name).entity() == Some(id));
    let users = resolving.flat_map(|file| database.users(file, kind, name).iter().copied());
    users.filter(|id| database.tree(*id).and_then(Entity::kind) == Some(user_kind)).collect()
}

/// Creates the scene of an environment, or adds the robots and sensors that are wanted and missing.
fn action(
    database: &Database,
    id: EntityId,
    is_wanted: impl Fn(&str, Option<&str>) -> bool,
) -> Option<SceneAction> {
    let environment = database.environment(id).ok()?;
    let program = database.file_of(id)?;
    let name = SmolStr::from(environment.name.as_str());
    let floor = scene(&environment);
    let found = database.scenes().find(|(file, other, _)| *file == program && *other == name);
    let Some((.., text)) = found else {
        let text = new_scene(&name, &floor).replace('\n', database.line_ending(program));
        return Some(SceneAction { program, environment: name, added: Vec::new(), span: None, text });
    };
    let names = written_names(text);
    let has = |robot: &str, sensor: Option<&str>| {
        names.iter().any(|written| {
            let is_it = match sensor {
                None => written.kind == EntityKind::Robot,
                Some(sensor) => written.kind == EntityKind::Sensor && written.name == sensor,
            };
            is_it && written.robot == robot
        })
    };
    let (mut added, mut new) = (Vec::new(), String::new());
    for robot in &floor.robots {
        if is_wanted(&robot.name, None) && !has(&robot.name, None) {
            added.push(robot.name.clone());
            new += &robot_table(robot);
        }
        // With a robot its sensors are not added: most stay where they are.
        for sensor in &robot.sensors {
            let is_alone = !is_wanted(&robot.name, None);
            if is_alone && is_wanted(&robot.name, Some(&sensor.name)) && !has(&robot.name, Some(&sensor.name))
            {
                added.push(sensor.name.clone());
                new += &sensor_table(robot, sensor);
            }
        }
    }
    let eol = if text.contains("\r\n") { "\r\n" } else { "\n" };
    let gap = if text.is_empty() || text.ends_with('\n') { "" } else { "\n" };
    let text_added = format!("{gap}{new}").replace('\n', eol);
    let end = Span::at(Span::of(text).end);
    // Nothing can be added to a table in braces.
    let after = with_edits(text, &[(end, text_added.clone())]);
    let problems = |text: &str| database.scene_problems(Some(id), text).len();
    let is_possible = !added.is_empty() && problems(&after) <= problems(text);
    is_possible.then_some(SceneAction {
        program,
        environment: name,
        added,
        span: Some(end),
        text: text_added,
    })
}

/// The text of a scene that means the same as an empty one.
fn new_scene(environment: &str, floor: &Scene) -> String {
    let mut text = format!(
        "# The world that `{environment}` drives in. Lengths are in metres, angles in degrees, counter-clockwise.\n\n\
         [world]\n# size = [8, 8] # a floor with walls around it\n"
    );
    for robot in &floor.robots {
        text += &robot_table(robot);
        for sensor in &robot.sensors {
            text += &sensor_table(robot, sensor);
        }
    }
    text + "\n# [[box]]\n# name = \"crate\"\n# at = [2, 1]\n# size = [0.5, 0.5]\n"
}

fn robot_table(robot: &Robot) -> String {
    let (name, start) = (as_key(&robot.name), &robot.start);
    let (x, y, heading) = (decimal(start.x), decimal(start.y), heading_degrees(start.theta, 4));
    format!("\n[robots.{name}]\nstart = [{x}, {y}, {heading}]\n")
}

fn sensor_table(robot: &Robot, sensor: &Sensor) -> String {
    let (robot, name) = (as_key(&robot.name), as_key(&sensor.name));
    let Mount { pose, range, .. } = &sensor.mount;
    let (x, y, range) = (decimal(pose.x), decimal(pose.y), decimal(*range));
    let bearing = heading_degrees(pose.theta, 4);
    format!("\n[robots.{robot}.sensors.{name}]\nat = [{x}, {y}]\nbearing = {bearing}\nrange = {range}\n")
}

/// A number with at most four decimals.
fn decimal(value: f64) -> String {
    let rounded = (value * 1e4).round() / 1e4;
    // Not −0.
    format!("{}", rounded + 0.0)
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};

    use super::*;
    use crate::fixture::{PARTS, at_cursor};

    const YARD: &str = "environment yard has { scout rover } robots with { } moves\n";
    const SCOUT: &str = "robot scout with port 23001 has { wheelL wheelR } wheels\n";

    /// The actions at `$0`, each with the scene after it, which says the same as before.
    fn check(fixture: &str, scene: Option<&str>, expected: &Expect) {
        let (mut database, position) = at_cursor(fixture);
        database.set_scene(position.file, "yard", scene);
        let mut out = String::new();
        for action in scene_actions(&database, position) {
            let after = match action.span {
                Some(span) => with_edits(scene.unwrap(), &[(span, action.text.clone())]),
                None => action.text.clone(),
            };
            let id = database.environments(position.file)[0].0;
            let environment = database.environment(id).unwrap();
            let mut before = database.clone();
            before.set_scene(position.file, "yard", Some(scene.unwrap_or_default()));
            let before = before.scene(id, &environment);
            let mut changed = database.clone();
            changed.set_scene(position.file, "yard", Some(&after));
            assert_eq!(format!("{:.4?}", changed.scene(id, &environment)), format!("{before:.4?}"));
            out += &format!("{} {:?}\n{}", action.environment, action.added, action.text);
        }
        expected.assert_eq(&out);
    }

    #[test]
    fn an_environment_gets_a_scene_that_says_what_holds_anyway() {
        check(
            &format!("{PARTS}{SCOUT}{}", YARD.replace("has", "h$0as")),
            None,
            &expect![[r#"
            yard []
            # The world that `yard` drives in. Lengths are in metres, angles in degrees, counter-clockwise.

            [world]
            # size = [8, 8] # a floor with walls around it

            [robots.scout]
            start = [0, 0, 0]

            [robots.rover]
            start = [0, -1, 0]

            [robots.rover.sensors.front]
            at = [0.15, 0]
            bearing = 0
            range = 1

            # [[box]]
            # name = "crate"
            # at = [2, 1]
            # size = [0.5, 0.5]
        "#]],
        );
        check(&format!("{PARTS}{SCOUT}{}", YARD.replace("has", "h$0as with")), None, &expect![[""]]);
    }

    #[test]
    fn what_is_missing_in_a_scene_is_added() {
        let scene = Some("[robots.rover]\nstart = [1, 2]");
        check(
            &format!("{PARTS}{SCOUT}{}", YARD.replace("has", "h$0as")),
            scene,
            &expect![[r#"
            yard ["scout"]


            [robots.scout]
            start = [0, 0, 0]
        "#]],
        );
        check(
            &format!("{}{SCOUT}{YARD}", PARTS.replace("robot rover", "ro$0bot rover")),
            scene,
            &expect![[""]],
        );
        check(
            &format!("{PARTS}{}{YARD}", SCOUT.replace("port", "p$0ort")),
            scene,
            &expect![[r#"
            yard ["scout"]


            [robots.scout]
            start = [0, 0, 0]
        "#]],
        );
        check(
            &format!("{}{SCOUT}{YARD}", PARTS.replace("sensor front", "sensor fr$0ont")),
            scene,
            &expect![[r#"
                yard ["front"]


                [robots.rover.sensors.front]
                at = [0.15, 0]
                bearing = 0
                range = 1
            "#]],
        );
        check(
            &format!("{}{SCOUT}{YARD}", PARTS.replace("sensor back", "sensor ba$0ck")),
            scene,
            &expect![[""]],
        );
        let braces = Some("robots = { rover = { start = [1, 2] } }\n");
        check(
            &format!("{}{SCOUT}{YARD}", PARTS.replace("sensor front", "sensor fr$0ont")),
            braces,
            &expect![[""]],
        );
    }
}
