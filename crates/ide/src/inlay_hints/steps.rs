//! The body of a movement as steps: its actions, and invalid code between them.

use std::sync::Arc;

use pydslrep_analysis::environment::ResolvedActionKind;
use pydslrep_analysis::{Database, EntityRef, KnownStatements};
use pydslrep_syntax::Span;
use pydslrep_syntax::ast;

use super::is_in;

/// A part of a body.
pub(super) struct Step<'a> {
    pub(super) kind: Arc<StepKind>,
    /// `None` for invalid code between actions.
    pub(super) action: Option<&'a ast::Action>,
    /// The steps of its blocks, if they are in sight.
    pub(super) blocks: Vec<Vec<Step<'a>>>,
}

/// The content of a step, without its place.
#[derive(Debug)]
pub(super) enum StepKind {
    /// A valid action.
    Action(ResolvedActionKind),
    /// A valid action that does other movements. The numbers of those change with other edits, so it is recognised by its
    /// text.
    Calling(ResolvedActionKind, String),
    /// Invalid code, also in the blocks of an action.
    Broken,
}

impl StepKind {
    /// The action, if it is valid.
    pub(super) fn action(&self) -> Option<&ResolvedActionKind> {
        match self {
            Self::Action(kind) | Self::Calling(kind, _) => Some(kind),
            Self::Broken => None,
        }
    }
}

impl PartialEq for StepKind {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Action(kind), Self::Action(other)) => kind == other,
            (Self::Calling(_, text), Self::Calling(_, other)) => text == other,
            (Self::Broken, Self::Broken) => true,
            _ => false,
        }
    }
}

/// The source of a movement's steps.
pub(super) struct Body<'a> {
    pub(super) database: &'a Database,
    pub(super) entity: EntityRef<'a>,
    pub(super) known: KnownStatements<'a>,
    /// The part in sight: only what touches it has the steps of its blocks. It counts from the entity's start.
    pub(super) sight: Span,
}

impl<'a> Body<'a> {
    /// The steps of the actions between two braces.
    pub(super) fn steps(&self, braces: Span, actions: &'a [ast::Action]) -> Vec<Step<'a>> {
        let mut errors = self.errors(braces).peekable();
        let mut steps = Vec::with_capacity(actions.len());
        for action in actions {
            let mut is_broken = false;
            while let Some(span) = errors.next_if(|span| span.start < action.span.end) {
                is_broken |= span.end <= action.span.start;
            }
            if is_broken {
                steps.push(Step { kind: Arc::new(StepKind::Broken), action: None, blocks: Vec::new() });
            }
            steps.push(self.step(action));
        }
        steps
    }

    fn step(&self, action: &'a ast::Action) -> Step<'a> {
        let kind = match self.known.kind(action) {
            Some(_) if self.has_errors_in_blocks(action) => StepKind::Broken,
            Some(kind) if calls(action) => {
                StepKind::Calling(kind, self.database.action_text(&self.entity, action.span))
            }
            Some(kind) => StepKind::Action(kind),
            None => StepKind::Broken,
        };
        let blocks = action.blocks().filter(|_| is_in(action.span, self.sight));
        let blocks = blocks.map(|block| self.steps(block.span, &block.actions)).collect();
        Step { kind: Arc::new(kind), action: Some(action), blocks }
    }

    /// The syntax errors in a part of the entity.
    fn errors(&self, part: Span) -> impl Iterator<Item = Span> + use<'a> {
        let errors = self.entity.parse.errors.iter().map(|error| error.span);
        errors.filter(move |span| part.start <= span.start && span.start <= part.end)
    }

    /// Returns whether the blocks of an action, or the words before a block, contain code that could not be parsed.
    fn has_errors_in_blocks(&self, action: &ast::Action) -> bool {
        let mut errors = action.blocks().flat_map(|block| self.errors(block.span));
        errors.any(|error| {
            let mut inside = ast::nested(std::slice::from_ref(action));
            !inside.any(|inner| inner.blocks().next().is_none() && covers(inner.span, error))
        })
    }
}

fn covers(whole: Span, part: Span) -> bool {
    whole.touches(part.start) && whole.touches(part.end)
}

/// Returns whether an action, or one in its blocks, does another movement.
pub(super) fn calls(action: &ast::Action) -> bool {
    matches!(action.kind, ast::ActionKind::Do(_))
        || action.blocks().any(|block| block.actions.iter().any(calls))
}
