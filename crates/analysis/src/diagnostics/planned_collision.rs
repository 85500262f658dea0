//! `planned-collision`: the planned path meets something.

use std::sync::Arc;

use pydslrep_kinematics::{ActionIndex, Place};
use pydslrep_scene::{Collision, ENDING, SceneObject};
use pydslrep_syntax::ast::Entity;

use super::example::trip;
use super::planned_run::PlannedRun;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::{Diagnostic, Facts, FileId, Related, Severity};

pub(super) static RULE: Rule = Rule {
    code: "planned-collision",
    severity: Severity::Warning,
    summary: "the planned path meets an obstacle of the scene, or another robot",
    tag: None,
    applicability: Applicability::Never,
    page: PAGE,
    checks: Checks::of_runs(in_runs),
};

const PAGE: Page = Page {
    what: "An environment has a scene file, and the planned path of a robot hits an obstacle of the scene, or another \
        robot that is there at the same time.",
    why: "Contact stops a robot: the action would fail after five seconds without progress, and everything after it \
        would not happen. The first obstacle on each robot's way is reported, and for each two robots the first time \
        they meet. An obstacle that moves is looked for where it is at the time of the action; after an action of unknown \
        duration, it is not looked for. What depends on the world is not predicted, nor is what comes after it: an action or \
        a `repeat` with `until`, an `if` whose branches end differently, and `slam`. Only the first 100 000 actions of a robot \
        are looked at, and of these as many as the search can follow in a bounded number of steps.",
    imports: &[("yard.scene.toml", "[[box]]\nname = \"crate\"\nat = [1.5, 0]\nsize = [0.4, 0.4]")],
    example: trip!("{\n  move 1 meters\n  move 1 meters\n  turn left\n}"),
    fixed: trip!("{\n  move 1 meters\n  turn left\n}"),
};

/// The problems of the actions of a file in the runs of its environments.
fn in_runs(facts: &Facts, file: FileId, runs: &[Arc<PlannedRun>]) -> Vec<Diagnostic> {
    let problems = runs.iter().flat_map(|run| {
        let located = Located { facts, run };
        run.collisions.iter().filter_map(move |collision| located.problem(collision))
    });
    problems.filter(|problem| problem.file == file).collect()
}

/// The same with the places as they are now.
#[derive(Clone, Copy)]
struct Located<'a> {
    facts: &'a Facts,
    run: &'a PlannedRun,
}

impl Located<'_> {
    fn problem(&self, collision: &Collision) -> Option<Diagnostic> {
        let place = self.place(collision.action, &collision.place, String::new())?;
        let robot = self.run.name(SceneObject::Robot(collision.robot));
        let with = self.run.name(collision.with);
        let when = collision.time.map_or_else(String::new, |time| format!(" after {time:.1} s"));
        // Adding zero makes a rounded -0 a 0.
        let centimetres = |metres: f64| (metres * 100.0).round() / 100.0 + 0.0;
        let (x, y) = (centimetres(collision.pose.x), centimetres(collision.pose.y));
        let other = collision.other_action;
        let related = other.and_then(|action| {
            self.place(action, &collision.other_place, format!("what `{with}` does then"))
        });
        let rounds = collision.place.rounds();
        let when = if rounds.is_empty() { when } else { format!(" in round {}{when}", in_words(rounds)) };
        let environment = &self.run.environment.name;
        Some(Diagnostic {
            rule: &RULE,
            severity: RULE.severity,
            file: place.file,
            span: place.span,
            message: format!("`{robot}` runs into `{with}` here{when}, at x {x} m, y {y} m"),
            help: Some(format!("drive around it, or change `{environment}{ENDING}`")),
            note: Some(format!("this is planned for the environment `{environment}` in its scene")),
            related: related.into_iter().collect(),
            fixes: Vec::new(),
        })
    }

    /// Where an action is.
    fn place(&self, index: ActionIndex, place: &Place, message: String) -> Option<Related> {
        let listed = *self.run.environment.schedule.get(index.group)?.get(index.run)?;
        let movement = place.calls().last().map_or(listed, |call| call.movement);
        let entity = self.facts.entity(*self.run.movements.get(movement)?)?;
        let Some(Entity::Movement(tree)) = &entity.parse.entity else { return None };
        let span = tree.statements().get(index.action)?.shifted(entity.span.start);
        Some(Related { file: entity.file, span, message })
    }
}

/// `2`, or `2 of round 1` where one repetition is in another.
fn in_words(rounds: &[u32]) -> String {
    let words: Vec<String> = rounds.iter().rev().map(u32::to_string).collect();
    words.join(" of round ")
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};
    use pydslrep_syntax::Span;

    use crate::Database;

    const PARTS: &str = "wheel a with radius 4 wheel b with radius 4\n\
        robot r with port 1 has { a b } wheels robot q with port 2 has { a b } wheels\n";

    fn reported(database: &Database, path: &str) -> String {
        let file = database.file(path).unwrap();
        let mut out = String::new();
        for found in database.diagnostics(file).iter().filter(|found| found.code() == "planned-collision") {
            out += &format!("{}: {}\n", database.slice(file, found.span), found.message);
            for related in &found.related {
                out += &format!("  {}: {}\n", database.slice(related.file, related.span), related.message);
            }
        }
        out
    }

    #[track_caller]
    fn check(program: &str, scene: &str, expected: &Expect) {
        let mut database = Database::new();
        let file = database.open("test.pyr", &format!("{PARTS}{program}"));
        assert_eq!(reported(&database, "test.pyr"), "", "without a scene nothing is in the way");
        database.set_scene(file, "e", Some(scene));
        expected.assert_eq(&reported(&database, "test.pyr"));
        database.set_scene(file, "e", None);
        assert_eq!(reported(&database, "test.pyr"), "");
    }

    const CRATE: &str = "[[box]]\nname = \"crate\"\nat = [1, 0]\nsize = [0.4, 0.4]\n";

    #[test]
    fn an_obstacle_on_the_way() {
        let program = "movement m of r { move 50 centimeters move 2 meters at 30 }\n\
            environment e has { r } robots with { m } moves environment f has { r } robots with { m } moves";
        check(
            program,
            CRATE,
            &expect![[r#"
            move 2 meters at 30: `r` runs into `crate` here after 6.7 s, at x 0.65 m, y 0 m
        "#]],
        );
        check(program, "[[box]]\nat = [1, 2]\nsize = [0.4, 0.4]", &expect![[""]]);
        check(program, "[[bxo]]", &expect![[""]]);
    }

    #[test]
    fn an_obstacle_that_moves() {
        let program = "movement m of r { move 1 meters move 1 meters turn left move 1 meters }\n\
            environment e has { r } robots with { m } moves";
        let person = |path: &str| format!("[[cylinder]]\nname = \"person\"\nradius = 0.2\npath = {path}");
        check(program, &person("[[0, 1.5, 0], [5, 1.5, 0], [7, 1.5, -2]]"), &expect![[""]]);
        check(
            program,
            &person("[[0, 1.5, 0], [15, 1.5, 0], [17, 1.5, -2]]"),
            &expect![[r#"
            move 1 meters: `r` runs into `person` here after 13.2 s, at x 1.15 m, y 0 m
        "#]],
        );
        check(
            program,
            &person("[[0, 2, 3], [30, 2, 1]]"),
            &expect![[r#"
            move 1 meters: `r` runs into `person` here after 33.1 s, at x 2 m, y 0.65 m
        "#]],
        );
    }

    #[test]
    fn an_obstacle_that_comes_to_a_robot_that_waits() {
        check(
            "movement m of r { wait 20 seconds }\nenvironment e has { r } robots with { m } moves",
            "[[cylinder]]\nname = \"person\"\nradius = 0.2\npath = [[0, 3, 0], [10, 0, 0]]",
            &expect![[r#"
            wait 20 seconds: `r` runs into `person` here after 8.8 s, at x 0 m, y 0 m
        "#]],
        );
    }

    #[test]
    fn nothing_is_told_where_sensors_decide() {
        for actions in [
            "move 20 centimeters move 2 meters until { s } detect",
            "move 20 centimeters if { s } clear { move 2 meters } else { turn left }",
            "repeat until { s } detect { move 1 meters }",
        ] {
            let program = format!(
                "sensor s robot c with port 3 has {{ a b }} wheels with sensors {{ s }}\n\
                 movement m of c {{ {actions} }}\nenvironment e has {{ c }} robots with {{ m }} moves"
            );
            check(&program, CRATE, &expect![[""]]);
        }
    }

    #[test]
    fn robots_that_meet() {
        let program = "parallel movement m of r { move 2 meters } parallel movement n of q { turn left move 2 meters }\n\
            environment e has { r q } robots with { m n } moves";
        check(
            program,
            "[robots.q]\nstart = [0.5, -0.4, 0]",
            &expect![[r#"
            move 2 meters: `r` runs into `q` here after 4.1 s, at x 0.36 m, y 0 m
              move 2 meters: what `q` does then
        "#]],
        );
        check(program, "[world]\ncollisions = false\n[robots.q]\nstart = [0.5, -0.4, 0]", &expect![[""]]);
    }

    #[test]
    fn in_the_file_where_the_action_is_and_after_every_edit() {
        let mut database = Database::new();
        database.open("parts.pyr", &format!("{PARTS}movement m of r {{ move 2 meters }}"));
        let main = "import \"parts.pyr\"\nenvironment e has { r } robots with { m } moves";
        let file = database.open("main.pyr", main);
        database.set_scene(file, "e", Some(CRATE));
        assert_eq!(reported(&database, "main.pyr"), "");
        assert!(reported(&database, "parts.pyr").starts_with("move 2 meters: `r` runs into `crate` here"));
        database.take_touched();
        // Nothing in the other file changes, but what there is to say of it does.
        let parts = database.file("parts.pyr").unwrap();
        let at = u32::try_from(main.find("m }").unwrap()).unwrap();
        database.edit(file, Span::new(at, at + 1), "");
        assert_eq!(database.take_touched(), [parts, file]);
        assert_eq!(reported(&database, "parts.pyr"), "");
        database.edit(file, Span::at(at), "m");
        assert!(reported(&database, "parts.pyr").contains("crate"));
        let radius = u32::try_from(PARTS.find("4 wheel b").unwrap()).unwrap();
        database.edit(parts, Span::new(radius, radius + 1), "x");
        assert_eq!(reported(&database, "parts.pyr"), "", "what has errors is not planned");
    }

    #[test]
    fn the_page_says_what_is_not_looked_at() {
        let why = super::PAGE.why;
        let digits = why.replace(' ', "");
        assert!(digits.contains(&format!("{}actions", pydslrep_kinematics::MAX_ACTIONS)), "{why}");
        // The bound of the search is `MAX_STEPS` in `pydslrep_scene`.
        for words in ["the search", "`until`", "`if`", "`slam`"] {
            assert!(why.contains(words), "{words}: {why}");
        }
    }
}
