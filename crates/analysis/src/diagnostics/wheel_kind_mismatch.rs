//! `wheel-kind-mismatch`: the wheels are not of the kind that the robot's type drives on.

use pydslrep_syntax::Span;
use pydslrep_syntax::ast::{Drive, Entity, Name, Robot};

use super::context::Context;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use super::wheel_count::{fitting, type_place};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "wheel-kind-mismatch",
    severity: Severity::Error,
    summary: "a robot's wheels do not suit its type: `tw` and `fw` drive on `wheel`, `fwh` on `wheelH`",
    tag: None,
    applicability: Applicability::Safe,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "A robot's wheels do not suit its type: `tw` and `fw` drive on `wheel`, and `fwh` drives on four \
        `wheelH`. If a robot of type `fw` has four `wheelH`, this is only a warning, and it is driven as \
        `fwh`.",
    why: "A `wheelH` has small rollers all around, so that a robot with four of them can also slide sideways; \
        a `wheel` only rolls straight on. The two are driven differently. With the wrong kind, or with some \
        of each, the robot would not go where you send it.",
    imports: &[],
    example: "\
wheel frontL with radius 5
wheel rearL with radius 5
wheel frontR with radius 5
wheel rearR with radius 5
robot rover type fwh with port 23000 has { frontL rearL frontR rearR } wheels",
    fixed: "\
wheel frontL with radius 5
wheel rearL with radius 5
wheel frontR with radius 5
wheel rearR with radius 5
robot rover type fw with port 23000 has { frontL rearL frontR rearR } wheels",
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(Entity::Robot(robot)) = context.tree else { return };
    let Some(list) = robot.wheels.as_ref().filter(|list| !list.broken) else { return };
    let drive = robot.drive.and_then(|clause| clause.word);
    let counts = match drive {
        Some(drive) => list.names.len() == drive.wheel_count(),
        None => robot.drive.is_none() && Drive::wheel_counts().contains(&list.names.len()),
    };
    if !counts {
        return;
    }
    // A wheel that is not known may be of any kind.
    let known = list.names.iter().filter_map(|name| Some((name, context.wheel(name)?.1.mecanum)));
    let known: Vec<(&Name, bool)> = known.collect();
    let count = list.names.len();
    let mecanum = known.iter().filter(|(_, mecanum)| *mecanum).count();
    let one_kind = mecanum == 0 || mecanum == known.len();
    // Without a type it follows from the wheels, if these are of one kind.
    let Some(wanted) = drive.or_else(|| Drive::inferred(count, || one_kind && mecanum > 0)) else { return };
    let Some((odd, _)) = known.iter().find(|(_, mecanum)| *mecanum != wanted.row().mecanum) else { return };
    let place = type_place(robot).unwrap_or(odd.span);
    let driven = drive.map(|drive| drive.driven(|| mecanum == count)).filter(|driven| Some(*driven) != drive);
    let problem = match driven {
        Some(driven) => all_mecanum(place, driven),
        None => mixed(context, place, drive, wanted, odd),
    };
    let problem =
        problem.note("a `wheel` rolls straight; a `wheelH` has rollers and lets a robot slide sideways");
    problems.push(with_type(context, robot, problem, fitting(context, list)));
}

fn all_mecanum(place: Span, driven: Drive) -> Problem {
    let (count, noun, word) = (driven.row().count, driven.row().noun, driven.word());
    RULE.problem(place, format!("{count} `wheelH` make {noun}, which is type `{word}`"))
        .severity(Severity::Warning)
        .help(format!("write `type {word}`; that is how it will be driven"))
}

fn mixed(context: &Context<'_>, place: Span, drive: Option<Drive>, wanted: Drive, odd: &Name) -> Problem {
    let row = wanted.row();
    let (wheel, other) = if row.mecanum { ("wheelH", "wheel") } else { ("wheel", "wheelH") };
    // The first type on wheels of the other kind, of those with as many wheels if there is one.
    let on_others = Drive::with_wheels(wanted.wheel_count())
        .chain(Drive::ALL)
        .map(Drive::row)
        .find(|other| other.mecanum != row.mecanum);
    let one_kind = on_others.is_none_or(|other| other.wheels.len() != row.wheels.len());
    let drives = match drive {
        Some(drive) => format!("a robot of type `{}` drives on `{wheel}`", drive.word()),
        None if one_kind => format!("a robot with {} wheels drives on `{wheel}`", row.count),
        None => format!("a robot's {} wheels must be of one kind", row.count),
    };
    let message = if drive.is_some() || one_kind {
        format!("{drives}, but `{}` is a `{other}`", odd.text)
    } else {
        format!("{drives}, but `{}` is a `{other}` and others are not", odd.text)
    };
    let help = match (drive, on_others) {
        (None, Some(others)) => format!("list {} `{wheel}`, or {} `{other}`", row.count, others.count),
        _ => format!("list only `{wheel}`, or change the robot's type"),
    };
    let problem = RULE.problem(place, message).help(help);
    match context.wheel(odd) {
        Some((id, wheel)) => problem.related(id, wheel.keyword, "declared here"),
        None => problem,
    }
}

fn with_type(context: &Context<'_>, robot: &Robot, problem: Problem, fitting: Option<Drive>) -> Problem {
    let (Some(clause), Some(drive)) = (robot.drive, fitting) else { return problem };
    let spelling = drive.word();
    problem.fix(
        format!("change the type to `{spelling}`"),
        [context.replace(clause.span, format!("type {spelling}"))],
    )
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean};

    const WHEELS: &str = "wheel a with radius 4\nwheel b with radius 4\nwheel c with radius 4\nwheel d with radius 4\n\
                          wheelH e with radius 4\nwheelH f with radius 4\nwheelH g with radius 4\nwheelH h with radius 4\n";

    #[test]
    fn four_mecanum_wheels_are_fwh() {
        check(
            &format!("{WHEELS}robot r type fw with port 1 has {{ e f g h }} wheels"),
            &expect![[r#"
                warning[wheel-kind-mismatch] 9:9 "type fw" four `wheelH` make a mecanum robot, which is type `fwh`
                  help: write `type fwh`; that is how it will be driven
                  note: a `wheel` rolls straight; a `wheelH` has rollers and lets a robot slide sideways
                  fix: change the type to `fwh` -> robot r type fwh with port 1 has { e f g h } wheels
            "#]],
        );
    }

    #[test]
    fn kinds_do_not_mix() {
        check(
            &format!("{WHEELS}robot r type fwh with port 1 has {{ a b c d }} wheels"),
            &expect![[r#"
            error[wheel-kind-mismatch] 9:9 "type fwh" a robot of type `fwh` drives on `wheelH`, but `a` is a `wheel`
              see 1:1 "wheel" declared here
              help: list only `wheelH`, or change the robot's type
              note: a `wheel` rolls straight; a `wheelH` has rollers and lets a robot slide sideways
              fix: change the type to `fw` -> robot r type fw with port 1 has { a b c d } wheels
        "#]],
        );
        check(
            &format!("{WHEELS}robot r type fw with port 1 has {{ a b c h }} wheels"),
            &expect![[r#"
            error[wheel-kind-mismatch] 9:9 "type fw" a robot of type `fw` drives on `wheel`, but `h` is a `wheelH`
              see 8:1 "wheelH" declared here
              help: list only `wheel`, or change the robot's type
              note: a `wheel` rolls straight; a `wheelH` has rollers and lets a robot slide sideways
        "#]],
        );
        check(
            &format!("{WHEELS}robot r type tw with port 1 has {{ e f }} wheels"),
            &expect![[r#"
            error[wheel-kind-mismatch] 9:9 "type tw" a robot of type `tw` drives on `wheel`, but `e` is a `wheelH`
              see 5:1 "wheelH" declared here
              help: list only `wheel`, or change the robot's type
              note: a `wheel` rolls straight; a `wheelH` has rollers and lets a robot slide sideways
        "#]],
        );
        check(
            &format!("{WHEELS}robot r with port 1 has {{ a f }} wheels"),
            &expect![[r#"
                error[wheel-kind-mismatch] 9:7 "r" a robot with two wheels drives on `wheel`, but `f` is a `wheelH`
                  see 6:1 "wheelH" declared here
                  help: list two `wheel`, or four `wheelH`
                  note: a `wheel` rolls straight; a `wheelH` has rollers and lets a robot slide sideways
            "#]],
        );
    }

    #[test]
    fn four_wheels_without_a_type_are_of_one_kind() {
        check(
            &format!("{WHEELS}robot r with port 1 has {{ a b c h }} wheels"),
            &expect![[r#"
            error[wheel-kind-mismatch] 9:7 "r" a robot's four wheels must be of one kind, but `h` is a `wheelH` and others are not
              see 8:1 "wheelH" declared here
              help: list four `wheel`, or four `wheelH`
              note: a `wheel` rolls straight; a `wheelH` has rollers and lets a robot slide sideways
        "#]],
        );
    }

    #[test]
    fn what_is_known_must_suit() {
        check(
            &format!("{WHEELS}robot r type fwh with port 1 has {{ a nobody f g }} wheels"),
            &expect![[r#"
                error[wheel-kind-mismatch] 9:9 "type fwh" a robot of type `fwh` drives on `wheelH`, but `a` is a `wheel`
                  see 1:1 "wheel" declared here
                  help: list only `wheelH`, or change the robot's type
                  note: a `wheel` rolls straight; a `wheelH` has rollers and lets a robot slide sideways
                error[unresolved-reference] 9:38 "nobody" there is no wheel called `nobody`
                  suggestion: declare the wheel `nobody` -> wheel nobody with radius 4
            "#]],
        );
        check(
            &format!("{WHEELS}robot r type fw with port 1 has {{ nobody e f g }} wheels"),
            &expect![[r#"
                error[wheel-kind-mismatch] 9:9 "type fw" a robot of type `fw` drives on `wheel`, but `e` is a `wheelH`
                  see 5:1 "wheelH" declared here
                  help: list only `wheel`, or change the robot's type
                  note: a `wheel` rolls straight; a `wheelH` has rollers and lets a robot slide sideways
                error[unresolved-reference] 9:35 "nobody" there is no wheel called `nobody`
                  suggestion: declare the wheel `nobody` -> wheelH nobody with radius 4
            "#]],
        );
        check(
            &format!("{WHEELS}robot r with port 1 has {{ nobody e f g }} wheels"),
            &expect![[r#"
            error[unresolved-reference] 9:27 "nobody" there is no wheel called `nobody`
              suggestion: declare the wheel `nobody` -> wheelH nobody with radius 4
        "#]],
        );
    }

    #[test]
    fn one_kind_that_fits_is_fine() {
        check_clean(&format!("{WHEELS}robot r with port 1 has {{ e f g h }} wheels"));
        check_clean(&format!("{WHEELS}robot r type fw with port 1 has {{ a b c d }} wheels"));
    }
}
