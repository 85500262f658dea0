//! `recursive-movement`: a movement does itself, perhaps by way of others.

use pydslrep_syntax::ast::{Entity, Name};

use super::calls::{self, Calls};
use super::context::Context;
use super::example::trip;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::{EntityId, Severity};

pub(super) static RULE: Rule = Rule {
    code: "recursive-movement",
    severity: Severity::Error,
    summary: "a movement does itself, perhaps by way of others",
    tag: None,
    applicability: Applicability::Never,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "A movement does itself: directly, or by way of the movements that it does.",
    why: "It would never end. To do something again and again, write `repeat 10000 times`.",
    imports: &[],
    example: trip!("{ move 1 meters do trip }"),
    fixed: trip!("{ repeat 100 times { move 1 meters } }"),
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let done = calls::of(context);
    problems.extend(done.filter_map(|(name, calls)| match calls {
        Calls::Back(way) => Some(problem(context, name, &way)),
        Calls::TooMany | Calls::Elsewhere => None,
    }));
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

    #[test]
    fn circles_lead_over_files() {
        let mut database = crate::Database::new();
        let importing = format!("import \"b.pyr\"\n{}\nmovement o of r {{ do m }}", program("do n"));
        let a = database.open("a.pyr", &importing);
        let b = database.open("b.pyr", "import \"a.pyr\"\nmovement n of r { turn left do m }");
        let mut reported = Vec::new();
        for file in [a, b] {
            let own = database.diagnostics(file).into_iter().filter(|found| found.code() == super::RULE.code);
            reported.extend(own.map(|found| {
                let way = found.related.iter().map(|step| (step.file, database.slice(step.file, step.span)));
                (file, database.slice(file, found.span), way.collect::<Vec<_>>())
            }));
        }
        let [n, m] = ["n", "m"].map(str::to_owned);
        // Nothing is reported for `o`, which only leads to it.
        assert_eq!(reported, [(a, n.clone(), vec![(b, n.clone())]), (b, m.clone(), vec![(a, m)])]);
    }
}
