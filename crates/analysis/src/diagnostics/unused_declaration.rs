//! `unused-declaration`: a part that nothing uses.

use pydslrep_syntax::EntityKind;

use super::context::Context;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule, Tag};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "unused-declaration",
    severity: Severity::Hint,
    summary: "a wheel, sensor, ip, robot or movement that nothing uses",
    tag: Some(Tag::Unnecessary),
    applicability: Applicability::Suggested,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "A wheel, sensor, ip, robot or movement is declared, but nothing uses it. Files without an environment are \
        not checked for this, and neither are files that others import, since their declarations may be used there.",
    why: "It does no harm, but it changes nothing either. Maybe you forgot to add it somewhere, such as a \
        sensor to its robot or a movement to the environment. Otherwise the program is easier to read \
        without it.",
    imports: &[],
    example: "\
sensor front
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover with port 23000 has { wheelL wheelR } wheels

movement trip of rover { move 1 meters }

environment yard has { rover } robots with { trip } moves",
    fixed: "\
sensor front
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover with port 23000 has { wheelL wheelR } wheels with sensors { front }

movement trip of rover { move 1 meters }

environment yard has { rover } robots with { trip } moves",
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some((kind, name)) = context.declared() else { return };
    let Some(place) = place_of(kind) else { return };
    let asked = context.has_environments() && !context.is_imported();
    // A name in text that was not understood may well be a use of it.
    if !asked || context.is_skipped(kind, name) || !context.users_of_own().is_empty() {
        return;
    }
    let mut problem = RULE
        .problem(name.span, format!("nothing uses the {} `{}`", kind.noun(), name.text))
        .help(format!("{place}, or leave it out"))
        .about(kind, name.text.clone());
    problem.users = users_of(kind);
    problems.push(match context.whole() {
        Some(whole) if context.errors.is_empty() && leaves_nothing_unused(context) => {
            problem.suggestion("remove it", [whole])
        }
        _ => problem,
    });
}

/// Returns how to use an entity of a kind; `None` for environments, which nothing uses.
fn place_of(kind: EntityKind) -> Option<&'static str> {
    match kind {
        EntityKind::Wheel => Some("list it among the wheels of a robot"),
        EntityKind::Sensor => Some("add it to a robot: `with sensors { … }`"),
        EntityKind::Ip => Some("add it to an environment: `with ip …`"),
        EntityKind::Robot => Some("list it among the robots of an environment"),
        EntityKind::Movement => {
            Some("list it among the moves of an environment, or do it in another movement")
        }
        EntityKind::Environment => None,
    }
}

/// Returns the kinds of entities that use a kind.
fn users_of(kind: EntityKind) -> &'static [EntityKind] {
    match kind {
        EntityKind::Wheel => &[EntityKind::Robot],
        EntityKind::Sensor => &[EntityKind::Robot, EntityKind::Movement],
        EntityKind::Robot => &[EntityKind::Movement, EntityKind::Environment],
        EntityKind::Ip => &[EntityKind::Environment],
        EntityKind::Movement => &[EntityKind::Environment, EntityKind::Movement],
        EntityKind::Environment => &[],
    }
}

/// Returns whether all that it uses is used elsewhere, too; otherwise removing it would only move the problem.
fn leaves_nothing_unused(context: &Context<'_>) -> bool {
    context.references.iter().all(|(kind, name)| context.shares_use(*kind, name))
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check_whole, check_whole_clean};

    const PARTS: &str = "wheel a with radius 4\nwheel b with radius 4\nrobot r with port 1 has { a b } wheels\nmovement m of r { turn left }\n";

    #[test]
    fn what_nothing_uses_is_reported() {
        check_whole(
            &format!(
                "{PARTS}sensor s\n// a note\nip i 127.0.0.1\nenvironment e has {{ r }} robots with {{ m }} moves\nwheel c with radius 5"
            ),
            &expect![[r#"
                hint[unused-declaration] 5:8 "s" nothing uses the sensor `s`
                  help: add it to a robot: `with sensors { … }`, or leave it out
                  suggestion: remove it -> 
                hint[unused-declaration] 7:4 "i" nothing uses the ip `i`
                  help: add it to an environment: `with ip …`, or leave it out
                  suggestion: remove it -> 
                hint[unused-declaration] 9:7 "c" nothing uses the wheel `c`
                  help: list it among the wheels of a robot, or leave it out
                  suggestion: remove it -> 
            "#]],
        );
        check_whole_clean(&format!("{PARTS}environment e has {{ r }} robots with {{ m }} moves"));
    }

    #[test]
    fn what_stands_on_the_same_line_stays_there() {
        let removed = |text: &str| {
            let mut database = crate::Database::new();
            let file = database.open("a.pyr", text);
            let unused = database.diagnostics(file).remove(0);
            assert_eq!(unused.code(), "unused-declaration");
            crate::diagnostics::testing::apply(text, file, &unused.fixes[0].edits)
        };
        let used = format!("{PARTS}environment e has {{ r }} robots with {{ m }} moves");
        for (before, after) in [
            (format!("sensor s wheel c with radius 4\r\n{used}"), format!("wheel c with radius 4\r\n{used}")),
            (format!("{used} \t sensor s\n\n// end\n"), format!("{used}\n\n// end\n")),
            (format!("{used}\n\nsensor s\n"), format!("{used}\n\n")),
            (format!("{used} sensor s // why\n"), format!("{used} // why\n")),
        ] {
            assert_eq!(removed(&before), after);
        }
    }

    #[test]
    fn a_slip_of_the_only_use_is_one_problem() {
        let codes = |users: &str| {
            let mut database = crate::Database::new();
            let file = database.open("a.pyr", &format!("{PARTS}{users}"));
            database.diagnostics(file).iter().map(crate::Diagnostic::code).collect::<Vec<_>>()
        };
        assert_eq!(codes("environment e has { r } robots with { mm } moves"), ["unresolved-reference"]);
        assert_eq!(codes("environment e has { r } robots wiht { m } moves"), ["syntax-error"]);
        assert_eq!(codes("environment e has { r } robots /* with { m } moves"), ["unterminated-comment"]);
    }

    #[test]
    fn a_slip_for_a_robot_excuses_no_movement() {
        check_whole(
            "wheel a with radius 4\nwheel b with radius 4\nrobot rover with port 1 has { a b } wheels\n\
             movement rover of rovr { turn left }\nenvironment e has { rover } robots",
            &expect![[r#"
                hint[unused-declaration] 4:10 "rover" nothing uses the movement `rover`
                  help: list it among the moves of an environment, or do it in another movement, or leave it out
                error[unresolved-reference] 4:19 "rovr" there is no robot called `rovr`
                  help: did you mean `rover`?
                  suggestion: change to `rover` -> movement rover of rover { turn left }
                hint[idle-robot] 5:21 "rover" no movement of this environment drives `rover`
                  help: list one of its movements, or leave the robot out
            "#]],
        );
    }

    #[test]
    fn parts_for_others_are_not_unused() {
        check_whole_clean("wheel a with radius 4");
    }
}
