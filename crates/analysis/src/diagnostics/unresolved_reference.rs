//! `unresolved-reference`: a name nothing of that kind bears.

use std::collections::BTreeSet;

use pydslrep_syntax::ast::{Entity, Name, Robot};
use pydslrep_syntax::{EntityKind, SyntaxError, SyntaxErrorKind, escape};
use pydslrep_text::closest_of_any_order;
use smol_str::SmolStr;

use super::context::Context;
use super::edits::ProblemEdit;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::{Resolution, Severity};

pub(super) static RULE: Rule = Rule {
    code: "unresolved-reference",
    severity: Severity::Error,
    summary: "a name that is not declared",
    tag: None,
    applicability: Applicability::Suggested,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "A name is used that no declaration of that kind has, neither in this file nor in the files that it imports. \
        Names are case-sensitive.",
    why: "The script would not know which wheel, sensor or robot is meant. Usually it is a typing mistake, and the \
        message suggests the closest name. Declarations may also come later in the file.",
    imports: &[],
    example: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover with port 23000 has { wheelL whelR } wheels",
    fixed: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover with port 23000 has { wheelL wheelR } wheels",
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(tree) = context.tree else { return };
    let references = &context.references;
    // A word that cannot be a name has been reported as that.
    let is_about = |error: &SyntaxError, name: &Name| match error.kind {
        SyntaxErrorKind::InvalidName { .. } => {
            name.span.start <= error.span.start && error.span.end <= name.span.end
        }
        _ => error.span == name.span,
    };
    let is_name = |name: &Name| !context.errors.iter().any(|error| is_about(error, name));
    for (kind, name) in references.iter().filter(|(_, name)| is_name(name)) {
        if context.resolve(*kind, name) == Resolution::Nothing {
            let alike = references.iter().filter(|(other, _)| other == kind);
            let taken: Vec<&str> = alike.map(|(_, other)| other.text.as_str()).collect();
            problems.push(problem(context, tree, *kind, name, &taken));
        }
    }
}

fn problem(context: &Context<'_>, tree: &Entity, kind: EntityKind, name: &Name, taken: &[&str]) -> Problem {
    let mut problem = RULE.problem(name.span, message(context, kind, name));
    problem.undeclared = Some((kind, name.text.clone()));
    if ["and", "then", "or"].contains(&name.text.as_str()) {
        return problem
            .help("list the names one after another, with or without commas")
            .suggestion(format!("remove `{}`", name.text), context.remove_item(name.span));
    }
    // A name that the list has already would only make another problem.
    if let Some(nearest) = nearest(context, kind, name, taken) {
        let edit = context.replace(name.span, escape(&nearest));
        problem = problem
            .help(format!("did you mean `{nearest}`?"))
            .suggestion(format!("change to `{nearest}`"), [edit])
            .about(kind, nearest);
    } else if let Some(known) = known(context, kind) {
        problem = problem.help(known);
    }
    match declaration(context, tree, kind, name) {
        Some(edit) => problem.suggestion(format!("declare the {} `{}`", kind.noun(), name.text), [edit]),
        None => problem,
    }
}

fn message(context: &Context<'_>, kind: EntityKind, name: &Name) -> String {
    let other = EntityKind::ALL
        .into_iter()
        .find(|other| *other != kind && context.resolve(*other, name).entity().is_some());
    match other {
        Some(other) => format!("`{}` is {}, not {}", name.text, other.a_noun(), kind.a_noun()),
        None => format!("there is no {} called `{}`", kind.noun(), name.text),
    }
}

/// The visible name of a kind that `name` is most likely a slip for: a near one, else the only one there is. None of
/// those `taken` already.
fn nearest(context: &Context<'_>, kind: EntityKind, name: &Name, taken: &[&str]) -> Option<SmolStr> {
    let names = || context.names_in_sight(kind);
    let free = names().map(SmolStr::as_str).filter(|other| !taken.contains(other));
    let near = closest_of_any_order(&name.text, free).map(SmolStr::new);
    near.or_else(|| {
        let first = names().next().filter(|first| !taken.contains(&first.as_str()))?;
        names().all(|other| other == first).then(|| first.clone())
    })
}

/// The few names there are, where there are few.
fn known(context: &Context<'_>, kind: EntityKind) -> Option<String> {
    const FEW: usize = 4;
    let mut names: BTreeSet<&str> = BTreeSet::new();
    for name in context.names_in_sight(kind) {
        names.insert(name);
        if names.len() > FEW {
            return None;
        }
    }
    let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    Some(match &quoted[..] {
        [] => format!("declare it: `{}`", kind.shape()),
        [only] => format!("the only {} is {only}", kind.noun()),
        few => format!("the {}s are {}", kind.noun(), few.join(", ")),
    })
}

/// The declaration of a part, before the entity that wants it. Robots and movements are more than a line and
/// are left to the person.
fn declaration(context: &Context<'_>, tree: &Entity, kind: EntityKind, name: &Name) -> Option<ProblemEdit> {
    let name = escape(&name.text);
    let line = match (kind, tree) {
        (EntityKind::Wheel, Entity::Robot(robot)) => wheel(context, robot, &name),
        (EntityKind::Sensor, _) => format!("sensor {name}"),
        (EntityKind::Ip, _) => format!("ip {name} 127.0.0.1"),
        _ => return None,
    };
    Some(context.declare(format!("{line}\n")))
}

/// A wheel like the robot's other wheels.
fn wheel(context: &Context<'_>, robot: &Robot, name: &str) -> String {
    let others = robot.wheels.iter().flat_map(|list| &list.names).filter_map(|other| context.wheel(other));
    let others: Vec<_> = others.map(|(_, wheel)| wheel).collect();
    let drive = robot.drive.and_then(|clause| clause.word);
    let by_type = drive.is_some_and(|drive| drive.row().mecanum);
    let mecanum = others.first().map_or(by_type, |wheel| wheel.mecanum);
    let radius = others
        .iter()
        .filter_map(|wheel| wheel.radius.as_ref()?.value)
        .find(|radius| *radius > 0.0 && radius.is_finite());
    format!("{} {name} with radius {}", if mecanum { "wheelH" } else { "wheel" }, radius.unwrap_or(4.5))
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean};

    #[test]
    fn the_nearest_name_is_offered() {
        check(
            "wheel wheelL with radius 5\nwheel wheelR with radius 5\nrobot r with port 1 has { wheelL whelR } wheels",
            &expect![[r#"
                error[unresolved-reference] 3:34 "whelR" there is no wheel called `whelR`
                  help: did you mean `wheelR`?
                  suggestion: change to `wheelR` -> robot r with port 1 has { wheelL wheelR } wheels
                  suggestion: declare the wheel `whelR` -> wheel whelR with radius 5
            "#]],
        );
    }

    #[test]
    fn another_kind_is_recognised() {
        check(
            "wheel a with radius 4\nsensor left\nrobot r with port 1 has { a left } wheels",
            &expect![[r#"
                error[syntax-error] 2:8 "left" `left` is a keyword, so a sensor cannot be called that
                  help: write `^left` to use it as a name, or choose another name
                  suggestion: rename it to `left_sensor` -> sensor left_sensor
                  fix: write `^left` -> sensor ^left
                error[syntax-error] 3:29 "left" expected the name of a wheel, found `left`
                  help: `left` is a keyword; only a name can stand here
            "#]],
        );
    }

    #[test]
    fn robots_and_movements_are_named() {
        check(
            "movement m of r { turn left }\nenvironment e with ip i has { q } robots with { n } moves",
            &expect![[r#"
                error[unresolved-reference] 1:15 "r" there is no robot called `r`
                  help: declare it: `robot NAME type tw with port 23000 has { WHEELS } wheels`
                error[unresolved-reference] 2:23 "i" there is no ip called `i`
                  help: declare it: `ip NAME 127.0.0.1`
                  suggestion: declare the ip `i` -> ip i 127.0.0.1
                error[unresolved-reference] 2:31 "q" there is no robot called `q`
                  help: declare it: `robot NAME type tw with port 23000 has { WHEELS } wheels`
                error[unresolved-reference] 2:49 "n" there is no movement called `n`
                  help: did you mean `m`?
                  suggestion: change to `m` -> environment e with ip i has { q } robots with { m } moves
            "#]],
        );
    }

    #[test]
    fn text_that_was_not_understood_may_declare_the_name() {
        check(
            "wheel a with radius 4\nweel b with radius 4\nrobot r with port 1 has { a b } wheels",
            &expect![[r#"
                error[syntax-error] 2:1 "weel" `weel` is not a keyword; did you mean `wheel`?
                  fix: change to `wheel` -> wheel b with radius 4
            "#]],
        );
    }

    #[test]
    fn order_and_kind_do_not_matter() {
        check_clean("robot a with port 1 has { a b } wheels\nwheel a with radius 4\nwheel b with radius 4");
    }
}
