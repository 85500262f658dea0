//! `single-parallel`: a parallel movement that never runs beside another.

use pydslrep_syntax::ast::{Entity, Environment, Name};

use super::context::Context;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule, Tag};
use crate::signature::Signature;
use crate::{EntityId, Severity};

pub(super) static RULE: Rule = Rule {
    code: "single-parallel",
    severity: Severity::Hint,
    summary: "a `parallel` movement that never runs beside another",
    tag: Some(Tag::Unnecessary),
    applicability: Applicability::Suggested,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "A movement is `parallel`, but in no environment is another `parallel` movement next to it.",
    why: "Only `parallel` movements that are next to each other in the list run at the same time. Alone, such a \
        movement runs like any other. Perhaps the other movement should be `parallel`, too, or the order in the list \
        is wrong.",
    imports: &[],
    example: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover with port 23000 has { wheelL wheelR } wheels
robot scout with port 23001 has { wheelL wheelR } wheels

movement go of rover { move 1 meters }
parallel movement follow of scout { move 1 meters }

environment yard has { rover scout } robots with { go follow } moves",
    fixed: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover with port 23000 has { wheelL wheelR } wheels
robot scout with port 23001 has { wheelL wheelR } wheels

parallel movement go of rover { move 1 meters }
parallel movement follow of scout { move 1 meters }

environment yard has { rover scout } robots with { go follow } moves",
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(Entity::Movement(movement)) = context.tree else { return };
    let (Some(parallel), Some(name)) = (movement.parallel, &movement.name) else { return };
    // A movement that another one does runs as a part of that one: only the lists of environments count.
    let listed = |user: &&EntityId| context.signature(**user).is_none_or(|user| user.movement().is_none());
    let users: Vec<_> = context.users_of_own().iter().filter(listed).collect();
    if !context.errors.is_empty() || users.is_empty() || context.is_imported() {
        return;
    }
    let beside = users.iter().any(|user| {
        let signature = context.signature(**user).filter(|user| user.is_sound());
        // With errors in it, the movement may run beside any other.
        let environment = signature.and_then(Signature::environment);
        environment.is_none_or(|environment| runs_beside_another(context, environment, name))
    });
    if !beside {
        problems.push(
            RULE.problem(parallel, format!("`{}` never runs beside another movement", name.text))
                .note(
                    "only parallel movements that are next to each other in an environment's list start together",
                )
                .suggestion(
                    "remove `parallel`",
                    [context.replace(parallel.to(after(context, parallel)), "")],
                ),
        );
    }
}

fn runs_beside_another(context: &Context<'_>, environment: &Environment, name: &Name) -> bool {
    let names = environment.movements.as_ref().map_or(&[][..], |list| &list.names);
    let parallel = |index: Option<usize>| {
        let neighbour = index.and_then(|index| names.get(index));
        neighbour.is_some_and(|name| may_be_parallel(context, name))
    };
    let mut places =
        names.iter().enumerate().filter(|(_, other)| other.text == name.text).map(|(index, _)| index);
    places.any(|index| parallel(index.checked_sub(1)) || parallel(Some(index + 1)))
}

/// Also one that is not known.
fn may_be_parallel(context: &Context<'_>, name: &Name) -> bool {
    context.movement(name).is_none_or(|(_, movement)| movement.parallel.is_some())
}

/// The start of the token after a place.
fn after(context: &Context<'_>, place: pydslrep_syntax::Span) -> pydslrep_syntax::Span {
    let next = context.tokens.iter().find(|(_, span)| span.start >= place.end);
    pydslrep_syntax::Span::at(next.map_or(place.end, |(_, span)| span.start))
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean};

    const PARTS: &str = "wheel a with radius 4\nwheel b with radius 4\nrobot r with port 1 has { a b } wheels\n\
                         robot q with port 1 has { a b } wheels\nparallel movement m of r { turn left }\n";

    #[test]
    fn parallel_takes_two() {
        check(
            &format!(
                "{PARTS}movement n of q {{ turn left }}\nenvironment e has {{ r q }} robots with {{ m n m }} moves"
            ),
            &expect![[r#"
                hint[single-parallel] 5:1 "parallel" `m` never runs beside another movement
                  note: only parallel movements that are next to each other in an environment's list start together
                  suggestion: remove `parallel` -> movement m of r { turn left }
            "#]],
        );
        check_clean(&format!(
            "{PARTS}parallel movement n of q {{ turn left }}\nenvironment e has {{ r q }} robots with {{ m n }} moves"
        ));
        // A movement that another one does is no part of a list.
        check_clean(&format!(
            "{PARTS}movement n of r {{ do m }}\nenvironment e has {{ r }} robots with {{ n }} moves"
        ));
    }
}
