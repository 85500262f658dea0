//! Quick fixes in a TOML file.

use pydslrep_analysis::{Database, Edit, EntityId};
use pydslrep_schema::{Names, Problem, ProblemKind, Span, as_key};
use pydslrep_syntax::ast::{Entity, References};
use pydslrep_syntax::{EntityKind, escape};

use super::TomlFile;
use super::scene_names::{Written, written_names};
use super::statements::statement;

/// A fix with its problem.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KeyFix {
    /// The problem that it fixes.
    pub problem: Problem,
    /// Its title.
    pub title: String,
    /// The edits of the TOML file, in the order of the text.
    pub edits: Vec<(Span, String)>,
    /// The edits of programs.
    pub program: Vec<Edit>,
}

/// More names than these are not offered in place of an unknown one.
const MAX_NAMES: usize = 3;

/// The fixes of all problems that touch a range.
pub fn toml_fixes(file: TomlFile<'_>, text: &str, range: Span) -> Vec<KeyFix> {
    let problems = file.problems(text);
    let touches = |problem: &&Problem| {
        problem.span.is_some_and(|span| span.start <= range.end && range.start <= span.end)
    };
    let fixes = problems.iter().filter(touches).flat_map(|problem| fixes_of(file, text, problem));
    let helps = |fix: &KeyFix| {
        !fix.program.is_empty() || file.problems(&with_edits(text, &fix.edits)).len() < problems.len()
    };
    fixes.filter(helps).collect()
}

fn fixes_of(file: TomlFile<'_>, text: &str, problem: &Problem) -> Vec<KeyFix> {
    let Some(span) = problem.span else { return Vec::new() };
    if problem.kind == ProblemKind::UnknownName {
        let names = written_names(text);
        if let Some(unknown) = names.iter().find(|written| written.span == span) {
            return UnknownName { file, text, problem, unknown, names: &names }.fixes();
        }
    }
    let replaced = problem.replacement.clone().map(|new| KeyFix {
        problem: problem.clone(),
        title: format!("change to `{}`", new.trim_matches('"')),
        edits: vec![(span, new)],
        program: Vec::new(),
    });
    replaced.into_iter().collect()
}

/// A name in a scene that its environment does not have.
struct UnknownName<'a> {
    file: TomlFile<'a>,
    text: &'a str,
    problem: &'a Problem,
    unknown: &'a Written,
    /// All names of the scene.
    names: &'a [Written],
}

impl UnknownName<'_> {
    fn fixes(&self) -> Vec<KeyFix> {
        let changed = self.better_names().into_iter().map(|name| self.change_to(&name));
        changed.chain(self.add_to_program()).chain([self.remove()]).collect()
    }

    /// The nearest name, else those that the scene does not have yet.
    fn better_names(&self) -> Vec<String> {
        if let Some(near) = &self.problem.replacement {
            return vec![near.trim_matches('"').to_owned()];
        }
        let names = self.file.names();
        let part = match self.unknown.kind {
            EntityKind::Robot => Some(&names),
            EntityKind::Sensor => names.get(&self.unknown.robot).and_then(|robot| robot.get("sensors")),
            _ => names.get(&self.unknown.robot).and_then(|robot| robot.get("wheels")),
        };
        let is_free =
            |name: &&String| !self.names.iter().any(|other| self.is_beside(other) && other.name == **name);
        let known = part.map_or(&[][..], |Names(names)| names).iter().map(|(name, _)| name);
        known.filter(is_free).take(MAX_NAMES).cloned().collect()
    }

    /// Returns whether a name of the scene is in the same table as the unknown one.
    fn is_beside(&self, other: &Written) -> bool {
        let is_robot = self.unknown.kind == EntityKind::Robot;
        other.kind == self.unknown.kind && (is_robot || other.robot == self.unknown.robot)
    }

    /// Where the scene has the unknown name.
    fn places(&self) -> impl Iterator<Item = Span> {
        let is_same = |other: &&Written| self.is_beside(other) && other.name == self.unknown.name;
        self.names.iter().filter(is_same).map(|other| other.span)
    }

    fn change_to(&self, name: &str) -> KeyFix {
        let edits = self.places().map(|span| (span, as_key(name))).collect();
        self.fix(format!("change to `{name}`"), edits, Vec::new())
    }

    /// Adds a declared robot to the environment, or a declared sensor to its robot.
    fn add_to_program(&self) -> Option<KeyFix> {
        let TomlFile::Scene(database, Some(environment)) = self.file else { return None };
        let Written { kind, name, robot, .. } = self.unknown;
        let home = database.file_of(environment)?;
        let (owner, title) = match kind {
            EntityKind::Robot => (environment, "the environment".to_owned()),
            _ => (database.resolve(home, EntityKind::Robot, robot).entity()?, format!("robot `{robot}`")),
        };
        let (list, separator) = match (database.tree(owner)?, kind) {
            (Entity::Environment(tree), EntityKind::Robot) => (tree.robots.as_ref()?, " "),
            (Entity::Robot(tree), EntityKind::Sensor) => (tree.sensors.as_ref()?, ", "),
            // A robot has as many wheels as its type needs.
            _ => return None,
        };
        database.resolve(database.file_of(owner)?, *kind, name).entity()?;
        let edit = append(database, owner, list, &escape(name), separator)?;
        Some(self.fix(format!("add `{name}` to {title}"), Vec::new(), vec![edit]))
    }

    fn remove(&self) -> KeyFix {
        let mut edits: Vec<(Span, String)> = Vec::new();
        for span in self.places().map(|span| statement(self.text, span)) {
            if edits.last().is_none_or(|(last, _)| last.end <= span.start) {
                edits.push((span, String::new()));
            }
        }
        self.fix(format!("remove what the scene says of `{}`", self.unknown.name), edits, Vec::new())
    }

    fn fix(&self, title: String, edits: Vec<(Span, String)>, program: Vec<Edit>) -> KeyFix {
        KeyFix { problem: self.problem.clone(), title, edits, program }
    }
}

/// The edit that adds a name to a list of an entity.
fn append(database: &Database, id: EntityId, list: &References, name: &str, separator: &str) -> Option<Edit> {
    let entity = database.entity(id)?;
    let (offset, text) = match list.names.last() {
        Some(last) => (last.span.end, format!("{separator}{name}")),
        None => (list.span.start + 1, format!(" {name} ")),
    };
    Some(Edit { file: entity.file, span: Span::at(entity.span.start + offset), text })
}

/// A text after edits that do not overlap, in its order.
pub(super) fn with_edits(text: &str, edits: &[(Span, String)]) -> String {
    let mut text = text.to_owned();
    for (span, new) in edits.iter().rev() {
        text.replace_range(std::ops::Range::from(*span), new);
    }
    text
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};
    use pydslrep_analysis::Database;

    use super::super::tests::{at_cursor, program};
    use super::*;
    use crate::fixture::applied;

    /// Checks the problem, the titles of the fixes at the cursor, and the text after each, which has fewer problems.
    fn fixes(file: TomlFile<'_>, fixture: &str, expected: &Expect) {
        let (text, offset) = at_cursor(fixture);
        let before = file.problems(&text);
        let lines = before.iter().map(|problem| format!("{}\n", problem.message));
        let mut out: String = lines.collect();
        for fix in toml_fixes(file, &text, Span::at(offset)) {
            let mut fixed = with_edits(&text, &fix.edits);
            if fix.program.is_empty() {
                assert!(file.problems(&fixed).len() < before.len(), "{fixed}");
            } else {
                fixed = fixed_program(file, &text, &fix);
            }
            out += &format!("{}\n{fixed}\n", fix.title);
        }
        expected.assert_eq(&out);
    }

    /// The program after edits of it, with which the scene does not have the problem.
    fn fixed_program(scene: TomlFile<'_>, text: &str, fix: &KeyFix) -> String {
        let TomlFile::Scene(database, Some(environment)) = scene else { panic!("no scene") };
        let file = database.file_of(environment).unwrap();
        let fixed = applied(database, file, &fix.program);
        let mut database = Database::new();
        let file = database.open("a.pyr", &fixed);
        let fixed_scene = TomlFile::Scene(&database, Some(database.environments(file)[0].0));
        let left = fixed_scene.problems(text);
        assert!(left.iter().all(|problem| problem.message != fix.problem.message), "{fixed}");
        fixed
    }

    fn check(fixture: &str, expected: &Expect) {
        fixes(TomlFile::Settings, fixture, expected);
    }

    #[test]
    fn of_settings() {
        check(
            "[sevrity$0]\nwheel-count = \"off\"",
            &expect![[r#"
                there is no setting `sevrity`
                change to `severity`
                [severity]
                wheel-count = "off"
            "#]],
        );
        check(
            "target = \"v-rep$0\"",
            &expect![[r#"
                `target` cannot be `v-rep`
                change to `vrep`
                target = "vrep"
            "#]],
        );
        check(
            "generateonsave$0 = true\ntarget = \"x\"",
            &expect![[r#"
                there is no setting `generateonsave`
                `target` cannot be `x`
                change to `generate-on-save`
                generate-on-save = true
                target = "x"
            "#]],
        );
        check(
            "[severity]\nwheel-counts$0 = \"off\"",
            &expect![[r#"
                there is no diagnostic `wheel-counts`
                change to `wheel-count`
                [severity]
                wheel-count = "off"
            "#]],
        );
        check(
            "[severity]\nwheel-count = \"warn$0\"",
            &expect![[r#"
                `severity.wheel-count` cannot be `warn`
                change to `warning`
                [severity]
                wheel-count = "warning"
            "#]],
        );
        check(
            "targett = \"vrep\"\noutput = $0\"a\"",
            &expect![[r#"
            there is no setting `targett`
        "#]],
        );
    }

    #[test]
    fn of_scenes() {
        let (database, environment) = program();
        let scene = TomlFile::Scene(&database, environment);
        fixes(
            scene,
            "[wrold$0]\nseed = 2",
            &expect![[r#"
                there is no key `wrold`
                change to `world`
                [world]
                seed = 2
            "#]],
        );
        fixes(
            scene,
            "[robots.rovr$0]\nstart = [1, 2]",
            &expect![[r#"
                the environment has no robot `rovr`
                change to `rover`
                [robots.rover]
                start = [1, 2]
                remove what the scene says of `rovr`

            "#]],
        );
        fixes(
            scene,
            "[robots.rover.sensors.frnt$0]\nrange = 2",
            &expect![[r#"
                robot `rover` has no sensor `frnt`
                change to `front`
                [robots.rover.sensors.front]
                range = 2
                remove what the scene says of `frnt`

            "#]],
        );
        fixes(
            scene,
            "[[cylinder]]\nat = [1, 1]\nradus$0 = 0.1",
            &expect![[r#"
                `radius` is missing in this `cylinder`
                there is no key `cylinder.radus`
                change to `radius`
                [[cylinder]]
                at = [1, 1]
                radius = 0.1
            "#]],
        );
        fixes(
            scene,
            "[robots.\"größee$0\"]\nstart = [1, 2]",
            &expect![[r#"
                the environment has no robot `größee`
                change to `größe`
                [robots."größe"]
                start = [1, 2]
                remove what the scene says of `größee`

            "#]],
        );
        fixes(
            scene,
            "[world]\nsize = [1, 1]$0\nseed = -2",
            &expect![[r#"
            `world.seed` must be a whole number from 0
        "#]],
        );
    }

    #[test]
    fn of_a_robot_that_was_renamed() {
        let mut database = Database::new();
        let file = database.open(
            "a.pyr",
            "wheel a with radius 4 wheel b with radius 4 sensor front sensor back
robot guard with port 1 has { a b } wheels
robot rover with port 1 has { a b } wheels with sensors { front }
environment yard has { rover } robots",
        );
        let environment = database.environments(file)[0].0;
        let scene = TomlFile::Scene(&database, Some(environment));
        fixes(
            scene,
            "[robots.gua$0rd]\nstart = [\n  1, 2]\n\n[robots.guard.sensors.front]\nrange = 2\n# The floor.\n[world]\nseed = 2\n",
            &expect![[r#"
                the environment has no robot `guard`
                change to `rover`
                [robots.rover]
                start = [
                  1, 2]

                [robots.rover.sensors.front]
                range = 2
                # The floor.
                [world]
                seed = 2

                add `guard` to the environment
                wheel a with radius 4 wheel b with radius 4 sensor front sensor back
                robot guard with port 1 has { a b } wheels
                robot rover with port 1 has { a b } wheels with sensors { front }
                environment yard has { rover guard } robots
                remove what the scene says of `guard`

                # The floor.
                [world]
                seed = 2

            "#]],
        );
        fixes(
            scene,
            "[robots]\nrover.start = [0, 0]\nsco$0ut.start = [1, 2]\n",
            &expect![[r#"
            the environment has no robot `scout`
            remove what the scene says of `scout`
            [robots]
            rover.start = [0, 0]

        "#]],
        );
        fixes(
            scene,
            "[robots.rover.sensors.back$0]\nrange = 2\n[robots.rover.sensors.front]\n",
            &expect![[r#"
                robot `rover` has no sensor `back`
                add `back` to robot `rover`
                wheel a with radius 4 wheel b with radius 4 sensor front sensor back
                robot guard with port 1 has { a b } wheels
                robot rover with port 1 has { a b } wheels with sensors { front, back }
                environment yard has { rover } robots
                remove what the scene says of `back`
                [robots.rover.sensors.front]

            "#]],
        );
    }

    #[test]
    fn without_a_program_any_name_is_allowed() {
        let database = Database::new();
        let text = "[robots.rovr]\nstart = 2\n[robots.rovr.sensors.x]\nrnge = 1\n[wrold]";
        let found: Vec<String> =
            database.scene_problems(None, text).into_iter().map(|problem| problem.message).collect();
        expect![[r#"
            `robots.rovr.start` must be a pose `[x, y, heading]`, not a number
            there is no key `robots.rovr.sensors.x.rnge`
            there is no key `wrold`"#]]
        .assert_eq(&found.join("\n"));
    }
}
