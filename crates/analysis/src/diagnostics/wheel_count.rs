//! `wheel-count`: a type of robot has a certain number of wheels.

use pydslrep_syntax::Span;
use pydslrep_syntax::ast::{Drive, Entity, References, Robot};

use super::context::Context;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "wheel-count",
    severity: Severity::Error,
    summary: "a robot does not have the 2 wheels of a `tw`, or the 4 of an `fw` or `fwh`",
    tag: None,
    applicability: Applicability::Suggested,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "A robot does not have as many wheels as its type needs: two for `tw`, four for `fw` and for `fwh`. A \
        robot without a type has two or four.",
    why: "The script steers the left and the right wheels separately and tells them apart by their order in the list: \
        left, right for two wheels; left front, left rear, right front, right rear for four. That takes the right \
        number.",
    imports: &[],
    example: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover type fw with port 23000 has { wheelL wheelR } wheels",
    fixed: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover type tw with port 23000 has { wheelL wheelR } wheels",
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(Entity::Robot(robot)) = context.tree else { return };
    let Some(list) = robot.wheels.as_ref().filter(|list| understood(context, list)) else { return };
    let drive = robot.drive.and_then(|clause| clause.word);
    if robot.drive.is_some() && drive.is_none() {
        return;
    }
    let count = list.names.len();
    if drive.map_or(!Drive::wheel_counts().contains(&count), |drive| count != drive.wheel_count()) {
        problems.push(problem(context, robot, list, drive));
    }
}

/// A list with a syntax error in or right around it says nothing about how many wheels were intended.
fn understood(context: &Context<'_>, list: &References) -> bool {
    let is_written = !list.names.is_empty() || context.errors.is_empty();
    is_written && !list.broken && !context.errors.iter().any(|error| list.span.touches(error.span.start))
}

fn problem(context: &Context<'_>, robot: &Robot, list: &References, drive: Option<Drive>) -> Problem {
    let count = list.names.len();
    let wanted = if let Some(drive) = drive {
        format!("{} (`{}`) has {} wheels", drive.row().noun, drive.word(), drive.wheel_count())
    } else {
        let counts = Drive::wheel_counts().iter().map(usize::to_string).collect::<Vec<_>>();
        format!("a robot has {} wheels", counts.join(" or "))
    };
    let lists = if count == 0 { "none".to_owned() } else { count.to_string() };
    let problem =
        RULE.problem(list.span, format!("{wanted}, but this list names {lists}")).help(wheel_orders());
    match (robot.drive, fitting(context, list)) {
        (Some(clause), Some(drive)) => {
            let edit = context.replace(clause.span, format!("type {}", drive.word()));
            problem.suggestion(format!("change the type to `{}`", drive.word()), [edit])
        }
        _ => problem,
    }
}

/// The type that these wheels make, if all are known and of one kind.
pub(super) fn fitting(context: &Context<'_>, list: &References) -> Option<Drive> {
    let kinds: Option<Vec<bool>> =
        list.names.iter().map(|name| context.wheel(name).map(|(_, wheel)| wheel.mecanum)).collect();
    Drive::from_wheels(&kinds?)
}

/// Returns the order in which to list wheels, by their number.
pub(super) fn wheel_orders() -> String {
    let types = Drive::wheel_counts().into_iter().filter_map(|count| Drive::with_wheels(count).next());
    let orders = types.enumerate().map(|(index, drive)| {
        let wheels = if index == 0 { " wheels" } else { "" };
        format!("{}{wheels} as {}", drive.row().count, drive.row().order())
    });
    format!("list {}", orders.collect::<Vec<_>>().join("; or "))
}

/// Where the type is written or could be.
pub(super) fn type_place(robot: &Robot) -> Option<Span> {
    robot.drive.map(|clause| clause.span).or(robot.name.as_ref().map(|name| name.span))
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean};

    const WHEELS: &str =
        "wheel a with radius 4\nwheel b with radius 4\nwheel c with radius 4\nwheel d with radius 4\n";

    #[test]
    fn each_type_has_its_number() {
        check(
            &format!("{WHEELS}robot r type tw with port 1 has {{ a b c d }} wheels"),
            &expect![[r#"
                error[wheel-count] 5:33 "{ a b c d }" a two-wheel robot (`tw`) has 2 wheels, but this list names 4
                  help: list two wheels as left, right; or four as left front, left rear, right front, right rear
                  suggestion: change the type to `fw` -> robot r type fw with port 1 has { a b c d } wheels
            "#]],
        );
        check(
            &format!("{WHEELS}robot r type fwh with port 1 has {{ a b }} wheels"),
            &expect![[r#"
                error[wheel-count] 5:34 "{ a b }" a mecanum robot (`fwh`) has 4 wheels, but this list names 2
                  help: list two wheels as left, right; or four as left front, left rear, right front, right rear
                  suggestion: change the type to `tw` -> robot r type tw with port 1 has { a b } wheels
            "#]],
        );
        check(
            &format!("{WHEELS}robot r type fw with port 1 has {{ }} wheels"),
            &expect![[r#"
                error[wheel-count] 5:33 "{ }" a four-wheel robot (`fw`) has 4 wheels, but this list names none
                  help: list two wheels as left, right; or four as left front, left rear, right front, right rear
            "#]],
        );
        check(
            &format!("{WHEELS}robot r with port 1 has {{ a b c }} wheels"),
            &expect![[r#"
                error[wheel-count] 5:25 "{ a b c }" a robot has 2 or 4 wheels, but this list names 3
                  help: list two wheels as left, right; or four as left front, left rear, right front, right rear
            "#]],
        );
    }

    #[test]
    fn the_right_number_is_fine() {
        check_clean(&format!("{WHEELS}robot r with port 1 has {{ a b c d }} wheels"));
        check_clean(&format!("{WHEELS}robot r type tw with port 1 has {{ a, b }} wheels"));
    }
}
