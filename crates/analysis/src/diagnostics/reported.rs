//! What is reported: the problems of entities without those that only follow from others, with absolute places.

use super::catalogue::CATALOGUE;
use super::consequences::Consequences;
use super::context::Context;
use super::edits::{self, absolute};
use super::problem::{Brace, Problem};
use super::rule::Rule;
use super::syntax_error;
use crate::reads::Reads;
use crate::{Database, Diagnostic, EntityId, FileId, Related, Severity};

/// The problems of one entity, in the order of the text, and what was looked at to find them.
pub(crate) fn in_entity(database: &Database, id: EntityId) -> (Vec<Problem>, Reads) {
    let mut problems = Vec::new();
    let Some(context) = Context::new(database, id) else { return (problems, Reads::default()) };
    for check in CATALOGUE.iter().filter_map(|rule| rule.checks.entity) {
        check(&context, &mut problems);
    }
    problems.sort_by_key(|problem| (problem.span.start, problem.span.end));
    (problems, context.into_reads())
}

/// A problem of a file that is reported.
struct Reported<'a> {
    /// Where its entity starts.
    start: u32,
    problem: &'a Problem,
    /// True for an open brace that is closed after declarations that do not belong within it.
    is_nested: bool,
}

/// The problems of a file with absolute places.
pub(crate) fn in_file(database: &Database, file: FileId) -> Vec<Diagnostic> {
    let located = reported(database, file).into_iter().map(|Reported { start, problem, is_nested }| {
        let mut diagnostic = located(database, file, start, problem);
        if is_nested {
            syntax_error::nested(&mut diagnostic);
        }
        diagnostic
    });
    let mut diagnostics: Vec<Diagnostic> = located.collect();
    diagnostics.extend(beyond_entities(database, file));
    diagnostics.sort_by_key(|diagnostic| diagnostic.span.start);
    diagnostics
}

/// The problems of a file that no entity has alone: its own, and those of its actions in environments with scenes.
fn beyond_entities(database: &Database, file: FileId) -> Vec<Diagnostic> {
    let runs = database.planned_runs(file);
    let in_file = |check: fn(&Database, FileId) -> Option<Diagnostic>| check(database, file);
    let mut diagnostics: Vec<Diagnostic> =
        CATALOGUE.iter().filter_map(|rule| rule.checks.file.and_then(in_file)).collect();
    // Without scenes there are no runs.
    if !runs.is_empty() {
        let in_runs = CATALOGUE.iter().filter_map(|rule| rule.checks.runs);
        diagnostics.extend(in_runs.flat_map(|check| check(database, file, &runs)));
    }
    diagnostics
}

/// Calls `visit` with the rule, the severity and the start of all that [`in_file`] returns, in no order; their places and
/// fixes, which take much longer, are not looked for.
pub(crate) fn visit_in_file(
    database: &Database,
    file: FileId,
    mut visit: impl FnMut(&'static Rule, Severity, u32),
) {
    for Reported { start, problem, .. } in reported(database, file) {
        visit(problem.rule, problem.severity, problem.span.shifted(start).start);
    }
    for diagnostic in beyond_entities(database, file) {
        visit(diagnostic.rule, diagnostic.severity, diagnostic.span.start);
    }
}

/// The problems of a file's entities without those that only follow from others, in the order of the text.
fn reported(database: &Database, file: FileId) -> Vec<Reported<'_>> {
    let entities = database.entities_with_problems(file);
    let ids: Vec<EntityId> = entities.iter().map(|entity| entity.id).collect();
    let problems: Vec<(u32, &Problem)> = entities
        .into_iter()
        .flat_map(|entity| {
            database.problems(entity.id).iter().map(move |problem| (entity.span.start, problem))
        })
        .collect();
    let consequences = Consequences::new(database, file, &ids, &problems);
    let mut reported: Vec<Reported<'_>> = Vec::with_capacity(problems.len());
    let mut open = None;
    for (start, problem) in problems.into_iter().filter(|(_, problem)| !consequences.include(problem)) {
        match problem.brace {
            Some(Brace::Unclosed) => open = Some(reported.len()),
            // It closes what was left open before the declarations in between.
            Some(Brace::Stray) if let Some(unclosed) = open.take() => {
                reported[unclosed].is_nested = true;
                continue;
            }
            _ => {}
        }
        reported.push(Reported { start, problem, is_nested: false });
    }
    reported
}

/// The problems of some entities, wherever they are, with absolute places.
pub(crate) fn of_entities(database: &Database, ids: &[EntityId]) -> Vec<Diagnostic> {
    let mut diagnostics = Vec::new();
    for entity in ids.iter().filter_map(|id| database.entity(*id)) {
        for problem in database.problems(entity.id) {
            diagnostics.push(located(database, entity.file, entity.span.start, problem));
        }
    }
    diagnostics
}

fn located(database: &Database, file: FileId, start: u32, problem: &Problem) -> Diagnostic {
    let related = problem.related.iter().filter_map(|related| {
        let (file, span) = absolute(database, related.entity, related.span)?;
        Some(Related { file, span, message: related.message.clone() })
    });
    Diagnostic {
        rule: problem.rule,
        severity: problem.severity,
        file,
        span: problem.span.shifted(start),
        message: problem.message.clone(),
        help: problem.help.clone(),
        note: problem.note.clone(),
        related: related.collect(),
        fixes: problem.fixes.iter().filter_map(|fix| edits::located(database, fix)).collect(),
    }
}
