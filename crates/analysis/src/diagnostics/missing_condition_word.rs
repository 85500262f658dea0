//! `missing-condition-word`: a condition does not say what it asks of its sensors.

use pydslrep_syntax::ast::{Action, ActionKind, Condition};

use super::context::Context;
use super::example::sensing_trip;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "missing-condition-word",
    severity: Severity::Error,
    summary: "a condition does not say what it asks of its sensors",
    tag: None,
    applicability: Applicability::Suggested,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "A condition names sensors, but says neither `clear` nor `detect` after them.",
    why: "`clear` holds when none of the sensors detects anything, `detect` when at least one does. Only the \
        form `turn left until { front }` can do without: there it has always been `clear`.",
    imports: &[],
    example: sensing_trip!("{ move 1 meters until { front } }"),
    fixed: sensing_trip!("{ move 1 meters until { front } detect }"),
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    for action in context.actions().filter(|action| !may_do_without(action)) {
        let missing = action.conditions().filter(|condition| condition.state.is_none());
        let sound = missing.filter(|condition| is_understood(context, condition));
        problems.extend(sound.map(|condition| problem(context, condition)));
    }
}

/// Returns whether it is the article's `turn left until { … }`.
fn may_do_without(action: &Action) -> bool {
    matches!(&action.kind, ActionKind::Turn(turn) if turn.is_of_article())
}

/// Returns whether its list, and the text after it that may be the word, were read without a mistake.
fn is_understood(context: &Context<'_>, condition: &Condition) -> bool {
    let around = |at: u32| condition.span.start <= at && at <= condition.span.end + 1;
    let is_list = !condition.sensors.broken && !condition.sensors.names.is_empty();
    is_list && !context.errors.iter().any(|error| around(error.span.start))
}

fn problem(context: &Context<'_>, condition: &Condition) -> Problem {
    let list = condition.sensors.span;
    let insert = |word: &str| [context.replace(pydslrep_syntax::Span::at(list.end), format!(" {word}"))];
    RULE.problem(
        list,
        "this condition does not say whether its sensors are to be clear or to detect something",
    )
    .help("write `clear` or `detect` after the sensors")
    .suggestion("add `detect`", insert("detect"))
    .suggestion("add `clear`", insert("clear"))
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{PARTS, check, check_clean, program};

    #[test]
    fn either_word_is_offered() {
        check(
            &program("if { s } { slam } turn left at 9 until { t } within 1 meters"),
            &expect![[r#"
            error[missing-condition-word] 6:22 "{ s }" this condition does not say whether its sensors are to be clear or to detect something
              help: write `clear` or `detect` after the sensors
              suggestion: add `detect` -> movement m of r { if { s } detect { slam } turn left at 9 until { t } within 1 meters }
              suggestion: add `clear` -> movement m of r { if { s } clear { slam } turn left at 9 until { t } within 1 meters }
            error[slam-sensors] 6:30 "slam" `slam` needs 5 distance sensors, and `r` has only 1
              see 5:7 "r" `r` is declared here
              help: declare more sensors, and add them to the robot: `with sensors { … }`
              note: each sensor counts once, and a `bumper` does not count
            error[missing-condition-word] 6:58 "{ t }" this condition does not say whether its sensors are to be clear or to detect something
              help: write `clear` or `detect` after the sensors
              suggestion: add `detect` -> movement m of r { if { s } { slam } turn left at 9 until { t } detect within 1 meters }
              suggestion: add `clear` -> movement m of r { if { s } { slam } turn left at 9 until { t } clear within 1 meters }
            warning[invalid-within] 6:71 "1" a bumper does not measure distances
              help: leave out `within`, or ask a distance sensor
        "#]],
        );
    }

    #[test]
    fn the_form_of_the_article_has_none() {
        check_clean(&program(
            "turn left until { s } move until { s } clear repeat until { t } detect { turn left }",
        ));
    }

    #[test]
    fn a_condition_that_is_not_there_is_one_mistake() {
        check(
            &format!("{PARTS}movement m of r {{ move 1 meters until\n\nsensor q"),
            &expect![[r#"
                error[syntax-error] 6:38 "" missing `{` after `until`
                  help: a condition is written `{ SENSORS } clear` or `{ SENSORS } detect`
            "#]],
        );
    }
}
