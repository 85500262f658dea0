//! `sensor-not-on-robot`: a condition asks a sensor that its robot does not carry.

use pydslrep_syntax::ast::{Entity, Name, Robot};
use pydslrep_syntax::{EntityKind, Span, escape};

use super::context::Context;
use super::edits::{ProblemEdit, append};
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::{EntityId, Severity};

pub(super) static RULE: Rule = Rule {
    code: "sensor-not-on-robot",
    severity: Severity::Error,
    summary: "a condition names a sensor that the robot does not carry",
    tag: None,
    applicability: Applicability::Suggested,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "A condition, such as that of `turn … until`, names a sensor that the movement's robot does not have.",
    why: "Conditions ask sensors of the robot that acts. A sensor that is not on the robot detects nothing for it.",
    imports: &[],
    example: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
sensor front
sensor back

robot rover with port 23000 has { wheelL wheelR } wheels with sensors { front }

movement trip of rover { turn left until { back } }

environment yard has { rover } robots with { trip } moves",
    fixed: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
sensor front
sensor back

robot rover with port 23000 has { wheelL wheelR } wheels with sensors { front, back }

movement trip of rover { turn left until { back } }

environment yard has { rover } robots with { trip } moves",
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(Entity::Movement(movement)) = context.tree else { return };
    let Some((id, robot)) = movement.robot.as_ref().and_then(|name| context.robot(name)) else { return };
    // Its list may be in what was not understood.
    if !context.is_sound(id) {
        return;
    }
    for action in context.actions() {
        let names = action.conditions().flat_map(|condition| &condition.sensors.names);
        let carried = |name: &Name| {
            robot.sensors.iter().flat_map(|list| &list.names).any(|other| other.text == name.text)
        };
        let declared = |name: &Name| context.resolve(EntityKind::Sensor, name).entity().is_some();
        problems.extend(
            names
                .filter(|name| declared(name) && !carried(name))
                .map(|name| problem(context, id, robot, name)),
        );
    }
}

fn problem(context: &Context<'_>, id: EntityId, robot: &Robot, sensor: &Name) -> Problem {
    let Some(name) = &robot.name else {
        return RULE.problem(sensor.span, "the robot does not carry this sensor");
    };
    let carries = robot.sensors.as_ref().map(|list| list.names.iter().map(|name| format!("`{}`", name.text)));
    let carries = carries.map_or_else(
        || format!("`{}` has no sensors", name.text),
        |names| format!("`{}` carries {}", name.text, names.collect::<Vec<_>>().join(", ")),
    );
    let problem = RULE
        .problem(sensor.span, format!("`{}` does not carry the sensor `{}`", name.text, sensor.text))
        .help(format!("add it to the sensors of `{}`, or name one that it carries", name.text))
        .related(id, name.span, carries);
    match added(context, id, robot, &sensor.text) {
        Some(edit) => problem.suggestion(format!("add `{}` to `{}`", sensor.text, name.text), [edit]),
        None => problem,
    }
}

fn added(context: &Context<'_>, id: EntityId, robot: &Robot, sensor: &str) -> Option<ProblemEdit> {
    if let Some(list) = &robot.sensors {
        return Some(append(id, list, sensor, ", "));
    }
    let end = context.signature(id)?.end()?;
    Some(ProblemEdit::new(id, Span::at(end), format!(" with sensors {{ {} }}", escape(sensor))))
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean};

    const PARTS: &str = "wheel a with radius 4\nwheel b with radius 4\nsensor s\nsensor t\n";

    #[test]
    fn what_was_not_understood_may_hold_it() {
        let mut database = crate::Database::new();
        let program = format!(
            "{PARTS}robot r with port 1 has {{ a b }} wheels wiht sensors {{ s t }}\nmovement m of r {{ turn left until {{ s, t }} }}"
        );
        let file = database.open("a.pyr", &program);
        let codes: Vec<_> = database.diagnostics(file).iter().map(crate::Diagnostic::code).collect();
        assert_eq!(codes, ["syntax-error"]);
    }

    #[test]
    fn the_sensor_is_added_to_the_robot() {
        check(
            &format!(
                "{PARTS}robot r with port 1 has {{ a b }} wheels with sensors {{ s }}\nmovement m of r {{ turn left until {{ s, t }} }}"
            ),
            &expect![[r#"
                error[sensor-not-on-robot] 6:40 "t" `r` does not carry the sensor `t`
                  see 5:7 "r" `r` carries `s`
                  help: add it to the sensors of `r`, or name one that it carries
                  suggestion: add `t` to `r` -> robot r with port 1 has { a b } wheels with sensors { s, t }
            "#]],
        );
        check(
            &format!(
                "{PARTS}robot r with port 1 has {{ a b }}\n  wheels\nmovement m of r {{ turn left until {{ s }} }}"
            ),
            &expect![[r#"
                error[sensor-not-on-robot] 7:37 "s" `r` does not carry the sensor `s`
                  see 5:7 "r" `r` has no sensors
                  help: add it to the sensors of `r`, or name one that it carries
                  suggestion: add `s` to `r` ->   wheels with sensors { s }
            "#]],
        );
    }

    #[test]
    fn a_carried_sensor_is_fine() {
        check_clean(&format!(
            "{PARTS}robot r with port 1 has {{ a b }} wheels with sensors {{ s }}\nmovement m of r {{ turn left until {{ s }} }}"
        ));
    }
}
