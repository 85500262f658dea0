//! `invalid-within`: a distance after `within` that no sensor can see something at.

use pydslrep_syntax::EntityKind;
use pydslrep_syntax::ast::{Action, Condition, Entity, SensorKind, Within};

use super::context::Context;
use super::number_out_of_range::FARTHEST;
use super::problem::Problem;
use super::{Applicability, Page, Rule};
use crate::Severity;
use crate::signature::Signature;

pub(super) static RULE: Rule = Rule {
    code: "invalid-within",
    severity: Severity::Error,
    summary: "a distance after `within` that no sensor can see something at",
    tag: None,
    applicability: Applicability::Never,
    page: PAGE,
    check,
};

const PAGE: Page = Page {
    what: "The distance after `within` is zero or negative, or all sensors of the condition are bumpers, which \
        is a warning.",
    why: "`within` counts only what is nearer than that, and nothing is nearer than nothing. A bumper tells \
        that it touches something, but not how far away that is.",
    imports: &[],
    example: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
sensor front
robot rover with port 23000 has { wheelL wheelR } wheels with sensors { front }

movement trip of rover { move until { front } detect within 0 meters }

environment yard has { rover } robots with { trip } moves",
    fixed: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
sensor front
robot rover with port 23000 has { wheelL wheelR } wheels with sensors { front }

movement trip of rover { move until { front } detect within 40 centimeters }

environment yard has { rover } robots with { trip } moves",
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(Entity::Movement(movement)) = context.tree else { return };
    for condition in movement.all_actions().flat_map(Action::conditions) {
        let Some(within) = &condition.within else { continue };
        problems.extend(problem(context, condition, within));
    }
}

fn problem(context: &Context<'_>, condition: &Condition, within: &Within) -> Option<Problem> {
    let distance = within.distance.as_ref()?;
    let value = distance.value.filter(|value| value.is_finite())?;
    if value <= 0.0 {
        let written = context.short_text(distance.span);
        return Some(
            RULE.problem(distance.span, format!("nothing is nearer than {written}"))
                .help("write a distance above zero, or leave out `within`"),
        );
    }
    let far = value * within.unit.map_or(1.0, |(unit, _)| unit.in_metres()) > FARTHEST;
    (!far && are_bumpers(context, condition)).then(|| {
        RULE.problem(distance.span, "a bumper does not measure distances")
            .severity(Severity::Warning)
            .help("leave out `within`, or ask a distance sensor")
    })
}

/// Whether all its sensors are known to be bumpers.
fn are_bumpers(context: &Context<'_>, condition: &Condition) -> bool {
    let is_bumper = |name| {
        let id = context.resolve(EntityKind::Sensor, name).entity();
        let sensor = id.and_then(|id| context.signature(id)).and_then(Signature::sensor);
        sensor.is_some_and(|sensor| matches!(sensor.kind, Some((SensorKind::Bumper, _))))
    };
    let names = &condition.sensors.names;
    !names.is_empty() && !condition.sensors.broken && names.iter().all(is_bumper)
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean};

    const PARTS: &str = "wheel a with radius 4\nwheel b with radius 4\nsensor s\nsensor t : bumper\n\
        robot r with port 1 has { a b } wheels with sensors { s, t }\n";

    fn program(actions: &str) -> String {
        format!("{PARTS}movement m of r {{ {actions} }}")
    }

    #[test]
    fn something_can_be_nearer() {
        check(
            &program("move until { s } detect within -1 meters"),
            &expect![[r#"
            error[invalid-within] 6:50 "-1" nothing is nearer than -1
              help: write a distance above zero, or leave out `within`
        "#]],
        );
        check_clean(&program("move until { s } detect within 0.1 centimeters"));
    }

    #[test]
    fn bumpers_measure_nothing() {
        check(
            &program("move until { t } detect within 1 meters"),
            &expect![[r#"
            warning[invalid-within] 6:50 "1" a bumper does not measure distances
              help: leave out `within`, or ask a distance sensor
        "#]],
        );
        check_clean(&program("move until { s, t } detect within 1 meters"));
    }
}
