//! `mixed-radii`: wheels of one robot differ in radius.

use pydslrep_syntax::ast::{Entity, Name, Wheel};

use crate::EntityId;

use super::context::Context;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "mixed-radii",
    severity: Severity::Warning,
    summary: "the wheels of a robot differ in radius",
    tag: None,
    applicability: Applicability::Never,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "The wheels of one robot do not all have the same radius.",
    why: "Most robots have wheels of one size, so this is probably a typing mistake. If the robot is built like this, \
        all is well: the script turns smaller wheels faster. But with a wrong radius the robot pulls to one side, \
        and the script has to correct it all the way.",
    imports: &[],
    example: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 5.4

robot rover with port 23000 has { wheelL wheelR } wheels",
    fixed: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5

robot rover with port 23000 has { wheelL wheelR } wheels",
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(Entity::Robot(robot)) = context.tree else { return };
    let Some(list) = &robot.wheels else { return };
    let mut known = list.names.iter().filter_map(|name| radius(context, name));
    let Some(first) = known.next() else { return };
    #[expect(clippy::float_cmp, reason = "radii are compared as they are written")]
    let Some(other) = known.find(|(.., radius)| *radius != first.3) else { return };
    let (name, id, wheel, radius) = other;
    let Some(place) = &wheel.radius else { return };
    problems.push(
        RULE.problem(
            name.span,
            format!(
                "the wheels of this robot differ: `{}` has a radius of {} cm, and `{}` one of {radius} cm",
                first.0.text, first.3, name.text
            ),
        )
        .related(id, place.span, format!("the radius of `{}`", name.text))
        .note("a smaller wheel will be turned faster, so that all of them cover the same ground"),
    );
}

fn radius<'a>(context: &Context<'a>, name: &'a Name) -> Option<(&'a Name, EntityId, &'a Wheel, f64)> {
    // Where there is a syntax error, another radius may be intended.
    let (id, wheel) = context.wheel(name).filter(|(id, _)| context.is_sound(*id))?;
    // One that is beyond all numbers has been reported as that.
    let radius = wheel.radius.as_ref()?.value.filter(|radius| radius.is_finite())?;
    Some((name, id, wheel, radius))
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean};

    #[test]
    fn of_two_radii_either_may_be_meant() {
        let mut database = crate::Database::new();
        let file = database.open(
            "a.pyr",
            "wheel a with radius 4 wheel b with radius 7 4 robot r with port 1 has { a b } wheels",
        );
        let codes: Vec<_> = database.diagnostics(file).iter().map(crate::Diagnostic::code).collect();
        assert_eq!(codes, ["syntax-error"]);
    }

    #[test]
    fn radii_are_alike() {
        let program = |radius: &str| {
            format!(
                "wheel a with radius 4\nwheel b with radius {radius}\nrobot r with port 1 has {{ a b }} wheels"
            )
        };
        check(
            &program("4.5"),
            &expect![[r#"
                warning[mixed-radii] 3:29 "b" the wheels of this robot differ: `a` has a radius of 4 cm, and `b` one of 4.5 cm
                  see 2:21 "4.5" the radius of `b`
                  note: a smaller wheel will be turned faster, so that all of them cover the same ground
            "#]],
        );
        check_clean(&program("4.0"));
    }

    #[test]
    fn what_is_no_number_differs_from_nothing() {
        check(
            &format!(
                "wheel a with radius 4\nwheel b with radius {}\nrobot r with port 1 has {{ a b }} wheels",
                "9".repeat(309)
            ),
            &expect![[r#"
                error[number-out-of-range] 2:21 "999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999" this number is too large to compute with
                  help: write fewer digits
            "#]],
        );
    }
}
