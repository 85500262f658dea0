//! `not-in-article`: what the article does not have, in a program of its edition.

use pydslrep_syntax::ast::{Action, ActionKind, Condition, Entity, Turn, Until};
use pydslrep_syntax::{Span, Token};

use super::context::Context;
use super::example::trip;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::{Edition, Severity};

pub(super) static RULE: Rule = Rule {
    code: "not-in-article",
    severity: Severity::Error,
    summary: "a statement or clause that the article does not have, where the edition is the article's",
    tag: None,
    applicability: Applicability::Never,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "The edition is `article`, by `--edition article` or by `edition = \"article\"` in `pydslrep.toml`, and the \
        program has a statement or a clause that the article of 2020 does not have.",
    why: "The edition is for programs that other tools for the article's language must understand, too. They know \
        moves, turns and `slam`, and nothing that came later.",
    imports: &[],
    example: trip!("{ repeat 2 times { move 1 meters turn left } }"),
    fixed: trip!("{ move 1 meters turn left move 1 meters turn left }"),
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    if context.edition() != Edition::Article {
        return;
    }
    let Some(tree) = context.tree else { return };
    problems.extend(beyond_article(tree, context.tokens).into_iter().map(|span| problem(context, span)));
}

/// Where an entity with these tokens has what the article does not have.
pub fn beyond_article(tree: &Entity, tokens: &[Token]) -> Vec<Span> {
    match tree {
        Entity::Import(_) => {
            let keyword = tokens.iter().find(|(token, _)| !token.is_comment());
            keyword.map(|(_, span)| *span).into_iter().collect()
        }
        Entity::Movement(movement) => {
            movement.all_actions().flat_map(|action| extensions(tokens, action)).collect()
        }
        _ => Vec::new(),
    }
}

fn problem(context: &Context<'_>, span: Span) -> Problem {
    let written = context.short_text(span);
    RULE.problem(span, format!("the article does not have `{written}`"))
        .help("write it with moves, turns and `slam`, or leave out `edition`")
}

/// Returns the extensions that an action uses; the actions in its blocks are not looked at.
fn extensions(tokens: &[Token], action: &Action) -> Vec<Span> {
    match &action.kind {
        ActionKind::Move(step) => step.until.iter().map(|until| until.span).collect(),
        ActionKind::Turn(turn) => in_turn(turn),
        // The words that came later stay usable as names.
        _ if action.keyword().is_keyword() => Vec::new(),
        _ => {
            let keyword = tokens.iter().find(|(_, span)| span.start == action.span.start);
            vec![keyword.map_or(action.span, |(_, span)| *span)]
        }
    }
}

/// An `until` is in the article if the turn has nothing else, except for the words after its condition's list of sensors.
fn in_turn(turn: &Turn) -> Vec<Span> {
    let circle = turn.circle.as_ref().map(|circle| circle.span);
    let clauses = circle.into_iter().chain(turn.speed.as_ref().map(|speed| speed.span)).chain(turn.reverse);
    let mut found: Vec<Span> = clauses.collect();
    let Some(Until { condition, span }) = &turn.until else { return found };
    if turn.angle.is_some() || !found.is_empty() {
        found.push(*span);
    } else {
        found.extend(after_sensors(condition));
    }
    found
}

/// The words after a condition's list of sensors, as one clause.
fn after_sensors(condition: &Condition) -> Option<Span> {
    let state = condition.state.map(|(_, span)| span);
    let within = condition.within.as_ref().map(|within| within.span);
    Some(Span { start: state.or(within)?.start, end: within.or(state)?.end })
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};

    use crate::{Database, Edition};

    fn check(program: &str, expected: &Expect) {
        let parts = "import \"x.pyr\"\nwheel a with radius 4\nwheel b with radius 4\nsensor s : bumper\n\
            robot r type tw with port 1 has { a b } wheels with sensors { s }\n";
        let program = format!("{parts}movement m of r {{ {program} }}");
        let mut database = Database::new();
        let file = database.open("test.pyr", &program);
        database.open("x.pyr", "");
        let reported = |database: &Database| {
            let all = database.diagnostics(file);
            let of_rule = all.into_iter().filter(|found| found.code() == "not-in-article");
            of_rule.map(|found| found.span.text(&program).to_owned() + "\n").collect::<String>()
        };
        assert_eq!(reported(&database), "");
        database.set_edition(file, Edition::Article);
        expected.assert_eq(&reported(&database));
        database.set_edition(file, Edition::Current);
        assert_eq!(reported(&database), "");
    }

    #[test]
    fn every_extension_is_told() {
        check(
            "repeat 2 times { wait 1 seconds } if { s } clear { do m } else if { s } detect { slam } \
             move 1 meters until { s } detect turn left 90 with radius 1 meters at 5 in reverse \
             turn left 90 until { s } clear turn left until { s } clear within 1 meters turn left at 4",
            &expect![[r#"
                import
                repeat
                wait
                if
                do
                until { s } detect
                with radius 1 meters
                at 5
                in reverse
                until { s } clear
                clear within 1 meters
                at 4
            "#]],
        );
    }

    #[test]
    fn what_the_article_has_is_allowed() {
        check(
            "move 1 meters at 5 move -1 centimeters turn left turn right 45 turn left until { s } slam",
            &expect![["import\n"]],
        );
    }
}
