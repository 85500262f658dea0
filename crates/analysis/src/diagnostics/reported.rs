//! What is reported: the problems of entities without those that only follow from others, with absolute places.

use std::sync::Arc;

use pydslrep_syntax::Span;

use super::catalogue::CATALOGUE;
use super::consequences::Consequences;
use super::context::Context;
use super::edits::{self, absolute};
use super::planned_run::PlannedRun;
use super::problem::{Brace, EntityProblems, Problem};
use super::rule::Rule;
use super::syntax_error;
use crate::entity::{EntityId, FileId};
use crate::facts::Facts;
use crate::reads::Reads;
use crate::{Diagnostic, Related, Severity};

/// The problems of one entity, in the order of the text, and what was looked at to find them.
pub(crate) fn in_entity(facts: &Facts, id: EntityId) -> (Vec<Problem>, Reads) {
    let mut problems = Vec::new();
    let Some(mut context) = Context::new(facts, id) else { return (problems, Reads::default()) };
    context.rewrites = syntax_error::rewrites(&context);
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

/// Which diagnostics of a file are wanted, and how much of them. To find the places of fixes takes most of the time.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Extent {
    /// All, with their fixes.
    All,
    /// All, to be shown only: the fixes of entities are left out.
    WithoutFixes,
    /// Those that touch a range, with their fixes.
    Touching(Span),
}

impl Extent {
    fn includes(self, span: Span) -> bool {
        match self {
            Self::All | Self::WithoutFixes => true,
            Self::Touching(range) => span.start <= range.end && range.start <= span.end,
        }
    }
}

/// The problems of a file with absolute places: of its entities, which are in the order of the text, and of the planned
/// runs that it is part of.
pub(crate) fn in_file(
    facts: &Facts,
    file: FileId,
    entities: &[EntityProblems<'_>],
    runs: &[Arc<PlannedRun>],
    extent: Extent,
) -> Vec<Diagnostic> {
    let reported = reported(facts, file, entities).into_iter();
    let wanted = reported.filter(|found| extent.includes(found.problem.span.shifted(found.start)));
    let located = wanted.map(|Reported { start, problem, is_nested }| {
        let mut diagnostic = located(facts, file, start, problem, extent);
        if is_nested {
            syntax_error::nested(&mut diagnostic);
        }
        diagnostic
    });
    let mut diagnostics: Vec<Diagnostic> = located.collect();
    diagnostics.extend(beyond_entities(facts, file, runs).into_iter().filter(|it| extent.includes(it.span)));
    diagnostics.sort_by_key(|diagnostic| diagnostic.span.start);
    diagnostics
}

/// The problems of a file that no entity has alone: its own, and those of its actions in environments with scenes.
fn beyond_entities(facts: &Facts, file: FileId, runs: &[Arc<PlannedRun>]) -> Vec<Diagnostic> {
    let in_file = |check: fn(&Facts, FileId) -> Option<Diagnostic>| check(facts, file);
    let mut diagnostics: Vec<Diagnostic> =
        CATALOGUE.iter().filter_map(|rule| rule.checks.file.and_then(in_file)).collect();
    // Without scenes there are no runs.
    if !runs.is_empty() {
        let in_runs = CATALOGUE.iter().filter_map(|rule| rule.checks.runs);
        diagnostics.extend(in_runs.flat_map(|check| check(facts, file, runs)));
    }
    diagnostics
}

/// Calls `visit` with the rule, the severity and the start of all that [`in_file`] returns, in no order; their places and
/// fixes, which take much longer, are not looked for.
pub(crate) fn visit_in_file(
    facts: &Facts,
    file: FileId,
    entities: &[EntityProblems<'_>],
    runs: &[Arc<PlannedRun>],
    mut visit: impl FnMut(&'static Rule, Severity, u32),
) {
    for Reported { start, problem, .. } in reported(facts, file, entities) {
        visit(problem.rule, problem.severity, problem.span.shifted(start).start);
    }
    for diagnostic in beyond_entities(facts, file, runs) {
        visit(diagnostic.rule, diagnostic.severity, diagnostic.span.start);
    }
}

/// The problems of a file's entities without those that only follow from others, in the order of the text.
fn reported<'a>(facts: &Facts, file: FileId, entities: &[EntityProblems<'a>]) -> Vec<Reported<'a>> {
    let with_start = |found: &EntityProblems<'a>| {
        let start = found.entity.span.start;
        found.problems.iter().map(move |problem| (start, problem))
    };
    let problems: Vec<(u32, &Problem)> = entities.iter().flat_map(with_start).collect();
    let consequences = Consequences::new(facts, file, entities, &problems);
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
pub(crate) fn of_entities(facts: &Facts, entities: &[EntityProblems<'_>]) -> Vec<Diagnostic> {
    let located = |EntityProblems { entity, problems }: &EntityProblems<'_>| {
        let (file, start) = (entity.file, entity.span.start);
        problems
            .iter()
            .map(move |problem| located(facts, file, start, problem, Extent::All))
            .collect::<Vec<_>>()
    };
    entities.iter().flat_map(located).collect()
}

fn located(facts: &Facts, file: FileId, start: u32, problem: &Problem, extent: Extent) -> Diagnostic {
    let related = problem.related.iter().filter_map(|related| {
        let (file, span) = absolute(facts, related.entity, related.span)?;
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
        fixes: match extent {
            Extent::WithoutFixes => Vec::new(),
            _ => problem.fixes.iter().filter_map(|fix| edits::located(facts, fix)).collect(),
        },
    }
}
