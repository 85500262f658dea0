//! Rows of actions: the body of a movement, or a block in it. Text on the line of an action or on the lines before it belongs
//! to the action.

use pydslrep_analysis::MAX_BLOCK_DEPTH;
use pydslrep_syntax::Span;
use pydslrep_syntax::ast::{Action, Movement};

use super::Selection;

/// The actions between two braces.
#[derive(Clone, Copy)]
pub(super) struct Row<'a> {
    pub(super) selection: Selection<'a>,
    pub(super) movement: &'a Movement,
    /// From brace to brace.
    pub(super) braces: Span,
    pub(super) actions: &'a [Action],
    /// The number of blocks around it.
    pub(super) depth: usize,
}

impl<'a> Selection<'a> {
    /// The rows around the selection, the outermost first.
    pub(super) fn rows(&self) -> Vec<Row<'a>> {
        let Some((movement, braces)) = self.movement().and_then(|movement| Some((movement, movement.body?)))
        else {
            return Vec::new();
        };
        let mut rows = vec![Row { selection: *self, movement, braces, actions: &movement.actions, depth: 0 }];
        while let Some(inner) = rows.last().and_then(Row::inner) {
            rows.push(inner);
        }
        rows
    }

    /// The action with the cursor in its own words or at a brace of its blocks, or the only selected one, and its row.
    pub(super) fn action(&self) -> Option<(Row<'a>, &'a Action)> {
        let mut rows = self.rows().into_iter().rev();
        rows.find_map(|row| match row.touched() {
            [action] if !row.is_inside_block_of(action) => Some((row, action)),
            _ => None,
        })
    }
}

impl<'a> Row<'a> {
    /// The row of the block in this one that contains the selection.
    fn inner(&self) -> Option<Self> {
        let range = self.selection.range;
        let contains = |block: Span| block.start < range.start && range.end < block.end;
        let mut blocks = self.touched().iter().flat_map(Action::blocks);
        let block = blocks.find(|block| contains(block.span))?;
        Some(Self { braces: block.span, actions: &block.actions, depth: self.depth + 1, ..*self })
    }

    /// The actions that the selection touches; a cursor between two touches both.
    pub(super) fn touched(&self) -> &'a [Action] {
        let range = self.selection.range;
        let first = self.actions.partition_point(|action| action.span.end < range.start);
        let end = self.actions.partition_point(|action| action.span.start <= range.end);
        self.actions.get(first..end).unwrap_or_default()
    }

    fn is_inside_block_of(&self, action: &Action) -> bool {
        let range = self.selection.range;
        action.blocks().any(|block| block.span.start + 1 < range.start && range.end + 1 < block.span.end)
    }

    /// The offset that separates an action from the one before it; the number of actions is the end of the last.
    pub(super) fn bound(&self, index: usize) -> u32 {
        let gap = self.gap(index);
        self.line_end(gap).unwrap_or_else(|| self.after_comments(gap))
    }

    /// Returns the gap between an action, or the opening brace, and the next action.
    pub(super) fn gap(&self, index: usize) -> Span {
        let before = index.checked_sub(1).and_then(|before| self.actions.get(before));
        let start = before.map_or(self.braces.start + 1, |action| action.span.end);
        let closing = self.braces.end.saturating_sub(1);
        Span::new(start, self.actions.get(index).map_or(closing, |action| action.span.start))
    }

    /// The first line break in a gap that is not inside a comment.
    pub(super) fn line_end(&self, gap: Span) -> Option<u32> {
        let text = self.selection.text(gap);
        let ends = (gap.start..).zip(text.bytes()).filter(|(_, byte)| matches!(byte, b'\n' | b'\r'));
        let mut ends = ends.map(|(at, _)| at);
        let comments = || self.selection.comments(gap);
        ends.find(|at| !comments().any(|comment| comment.start <= *at && *at < comment.end))
    }

    pub(super) fn after_comments(&self, gap: Span) -> u32 {
        self.selection.comments(gap).last().map_or(gap.start, |comment| comment.end)
    }

    /// Returns whether actions can be nested `more` blocks deeper than the row is.
    pub(super) fn has_room(&self, actions: &[Action], more: usize) -> bool {
        self.depth + more + height(actions) <= MAX_BLOCK_DEPTH
    }
}

/// Returns the depth of nested blocks.
fn height(actions: &[Action]) -> usize {
    let inner = |action: &Action| action.blocks().map(|block| 1 + height(&block.actions)).max();
    actions.iter().filter_map(inner).max().unwrap_or(0)
}
