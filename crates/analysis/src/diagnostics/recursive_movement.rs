//! `recursive-movement`: a movement does itself, perhaps by way of others.

use pydslrep_syntax::ast::{Action, Entity, Name};
use rustc_hash::FxHashMap;

use super::context::Context;
use super::problem::Problem;
use super::{Applicability, Page, Rule};
use crate::{EntityId, Severity};

pub(super) static RULE: Rule = Rule {
    code: "recursive-movement",
    severity: Severity::Error,
    summary: "a movement does itself, perhaps by way of others",
    tag: None,
    applicability: Applicability::Never,
    page: PAGE,
    check,
};

const PAGE: Page = Page {
    what: "A movement does itself: directly, or by way of the movements that it does.",
    why: "It would never end. To do something again and again, write `repeat 10000 times`.",
    imports: &[],
    example: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover with port 23000 has { wheelL wheelR } wheels

movement trip of rover { move 1 meters do trip }

environment yard has { rover } robots with { trip } moves",
    fixed: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover with port 23000 has { wheelL wheelR } wheels

movement trip of rover { repeat 100 times { move 1 meters } }

environment yard has { rover } robots with { trip } moves",
};

/// The longest way that is followed: far more movements than do each other in any program.
const LONGEST: usize = 200;

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(Entity::Movement(movement)) = context.tree else { return };
    let mut ways = FxHashMap::default();
    for done in movement.all_actions().filter_map(Action::done) {
        let Some((id, _)) = context.movement(done) else { continue };
        let way = ways.entry(id).or_insert_with(|| way_back(context, id));
        problems.extend(way.as_ref().map(|way| problem(context, done, way)));
    }
}

/// The shortest way of calls from a movement back to the one that is checked, both ends included.
fn way_back(context: &Context<'_>, from: EntityId) -> Option<Vec<EntityId>> {
    let mut before: FxHashMap<EntityId, EntityId> = FxHashMap::default();
    let mut row = vec![from];
    for _ in 0..LONGEST {
        if row.contains(&context.id) {
            let mut way = vec![context.id];
            while let Some(id) = way.last().filter(|id| **id != from).and_then(|id| before.get(id)) {
                way.push(*id);
            }
            way.reverse();
            return Some(way);
        }
        let mut next = Vec::new();
        for id in row {
            let does = context.summary(id).map(|summary| summary.does).unwrap_or_default();
            for other in does.iter().filter_map(|name| context.movement_of(id, name)) {
                if other != from && !before.contains_key(&other) {
                    before.insert(other, id);
                    next.push(other);
                }
            }
        }
        row = next;
    }
    None
}

fn problem(context: &Context<'_>, done: &Name, way: &[EntityId]) -> Problem {
    let own = context.tree.and_then(Entity::name).map_or("", |name| name.text.as_str());
    let message = match way {
        [_] => format!("`{own}` does itself, so it would never end"),
        _ => format!("`{}` leads back to `{own}`, so it would never end", done.text),
    };
    let mut problem = RULE
        .problem(done.span, message)
        .help("to do something again and again, write `repeat 10000 times { … }`");
    for (id, next) in way.iter().zip(way.iter().skip(1)) {
        if let (Some(name), Some(next)) = (context.name_of(*id), context.name_of(*next)) {
            problem = problem.related(*id, name.span, format!("`{}` does `{}`", name.text, next.text));
        }
    }
    problem
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean, program};

    #[test]
    fn nothing_does_itself() {
        check(
            &program("do m"),
            &expect![[r#"
            error[recursive-movement] 6:22 "m" `m` does itself, so it would never end
              help: to do something again and again, write `repeat 10000 times { … }`
        "#]],
        );
        check(
            &format!("{}\nmovement n of r {{ turn left do o }}\nmovement o of r {{ do m }}", program("do n")),
            &expect![[r#"
                error[recursive-movement] 6:22 "n" `n` leads back to `m`, so it would never end
                  see 7:10 "n" `n` does `o`
                  see 8:10 "o" `o` does `m`
                  help: to do something again and again, write `repeat 10000 times { … }`
                error[recursive-movement] 7:32 "o" `o` leads back to `n`, so it would never end
                  see 8:10 "o" `o` does `m`
                  see 6:10 "m" `m` does `n`
                  help: to do something again and again, write `repeat 10000 times { … }`
                error[recursive-movement] 8:22 "m" `m` leads back to `o`, so it would never end
                  see 6:10 "m" `m` does `n`
                  see 7:10 "n" `n` does `o`
                  help: to do something again and again, write `repeat 10000 times { … }`
            "#]],
        );
        check_clean(&format!("{}\nmovement n of r {{ turn left }}", program("do n do n")));
    }

    #[test]
    fn leading_to_a_circle_is_no_part_of_it() {
        let mut database = crate::Database::new();
        let file = database.open("a.pyr", &format!("{}\nmovement n of r {{ do n }}", program("do n")));
        let found = database.diagnostics(file);
        assert_eq!(found.iter().filter(|found| found.code() == "recursive-movement").count(), 1);
    }
}
