//! Statements written as in another language, such as `radius = 4.5`, `move(2)` or `robot r wheels { a b }`: one problem
//! for each, with the whole statement as its fix.
//!
//! The intention is read off the names, numbers and keywords that are there; where anything else is among them, nothing
//! is guessed.

mod actions;
mod entities;
mod statement;

use pydslrep_syntax::ast::Entity;

use super::{RULE, glued, repair};
use crate::diagnostics::context::Context;
use crate::diagnostics::problem::Problem;
use crate::diagnostics::rewritten::Rewrite;

/// The statements of an entity that are one problem each.
pub(crate) fn find(context: &Context<'_>) -> Vec<Rewrite> {
    let end = context.tokens.last().map_or(0, |(_, last)| last.end);
    if context.errors.is_empty() || end > repair::MAX_LENGTH {
        return Vec::new();
    }
    let mut found: Vec<Rewrite> = match context.tree {
        None | Some(Entity::Import(_)) => Vec::new(),
        Some(Entity::Movement(_)) => actions::find(context),
        Some(tree) => tree.kind().and_then(|kind| entities::find(context, kind)).into_iter().collect(),
    };
    if !found.is_empty() {
        let glued = glued::find(context);
        found.retain(|rewrite| !glued.iter().any(|glued| rewrite.reaches(glued.span())));
    }
    found
}

/// The problem that a statement is as a whole.
pub(super) fn problem(rewrite: &Rewrite, context: &Context<'_>) -> Option<Problem> {
    if rewrite.is_fallback {
        return None;
    }
    let problem = RULE.problem(rewrite.span, rewrite.message.clone()).help(rewrite.help.clone());
    Some(offer(rewrite, context, problem))
}

fn offer(rewrite: &Rewrite, context: &Context<'_>, problem: Problem) -> Problem {
    problem.suggestion(rewrite.title.clone(), [context.replace(rewrite.span, rewrite.text.clone())])
}

/// A problem that has no fix that helps with that of the statement it is in.
pub(super) fn with_fallback(context: &Context<'_>, problem: Problem) -> Problem {
    let Some(rewrite) =
        context.rewrites.iter().find(|rewrite| rewrite.is_fallback && rewrite.reaches(problem.span))
    else {
        return problem;
    };
    if problem.fixes.iter().any(|fix| fix.safe || repair::is_split(context, &fix.edits)) {
        return problem;
    }
    offer(rewrite, context, Problem { fixes: Vec::new(), ..problem })
}
