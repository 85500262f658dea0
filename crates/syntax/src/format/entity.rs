//! The layout of one entity without errors.

use super::gap::{Blank, Gap, GapContext};
use super::piece::{Item, ItemKind};
use super::writer::Writer;
use crate::{EntityKind, Token, TokenKind};

/// The longest line, in characters, that a list may be on.
pub const COLUMNS: usize = 100;

/// One step of indentation, in spaces.
const STEP: usize = 2;

/// Blocks that are deeper than this are no farther to the right.
const MAX_STEPS: usize = 40;

/// A list of references that is being written.
#[derive(Debug, Clone, Copy)]
struct List {
    /// True if its references are separated by commas.
    commas: bool,
    /// One reference per line.
    broken: bool,
    /// Of the line that it begins on.
    indent: usize,
}

/// Writes the entity that `item` is; what is around it is not touched.
pub(super) fn lay_out(writer: &mut Writer<'_>, text: &str, tokens: &[Token], item: &Item) {
    let is_movement = item.first_kind == Some(ItemKind::Declaration(EntityKind::Movement));
    let hoisted = Hoisted { comments: Vec::new(), edits: 0 };
    Layout { text, tokens, item, is_movement, depth: 0, list: None, hoisted }.write(writer);
}

struct Layout<'a> {
    text: &'a str,
    tokens: &'a [Token],
    item: &'a Item,
    is_movement: bool,
    /// The number of open blocks of actions.
    depth: usize,
    list: Option<List>,
    hoisted: Hoisted,
}

/// Comments between `}`, `else` and `{`, which become the first lines of the block.
struct Hoisted {
    comments: Vec<Token>,
    /// The number of edits before the first of them.
    edits: usize,
}

impl Layout<'_> {
    fn write(&mut self, writer: &mut Writer<'_>) {
        let mut previous = self.item.first;
        writer.put(self.tokens[previous].1);
        for index in self.item.first + 1..=self.item.last {
            let (token, span) = self.tokens[index];
            if token.is_comment() || token == TokenKind::Comma && self.list.is_some() {
                continue;
            }
            let edits = writer.edits();
            if self.hoists(previous, index) {
                self.hoist(writer, previous, index);
                writer.put(span);
            } else {
                self.separate(writer, previous, index);
                writer.put(span);
                self.join_hoisted(writer, previous);
            }
            if self.list.is_some_and(|list| list.commas) {
                // A comma that moves over a comment comes and goes at once.
                writer.join_edits(edits);
            }
            match token {
                TokenKind::OpenBrace if self.is_movement && !self.opens_condition(previous) => {
                    self.depth += 1;
                }
                TokenKind::OpenBrace => self.list = Some(self.begin_list(writer, previous, index)),
                TokenKind::CloseBrace if self.list.take().is_none() => {
                    self.depth = self.depth.saturating_sub(1);
                }
                _ => {}
            }
            previous = index;
        }
    }

    /// Returns whether comments between two neighbouring tokens become the first lines of the next block.
    fn hoists(&self, previous: usize, index: usize) -> bool {
        let is_else = |index: usize| self.tokens[index].0 == TokenKind::Else;
        let opens = self.tokens[index].0 == TokenKind::OpenBrace && !self.opens_condition(previous);
        self.depth > 0 && self.list.is_none() && (is_else(index) || is_else(previous) || opens)
    }

    fn hoist(&mut self, writer: &mut Writer<'_>, previous: usize, index: usize) {
        if self.hoisted.comments.is_empty() {
            self.hoisted.edits = writer.edits();
        }
        let between = &self.tokens[previous + 1..index];
        self.hoisted.comments.extend(between.iter().filter(|(token, _)| token.is_comment()));
        writer.space();
    }

    /// Makes one edit of a comment's way into the block, once what follows the brace at `previous` is written.
    fn join_hoisted(&mut self, writer: &mut Writer<'_>, previous: usize) {
        let opened = self.tokens[previous].0 == TokenKind::OpenBrace && self.list.is_none();
        if opened && !self.hoisted.comments.is_empty() {
            self.hoisted.comments.clear();
            writer.join_edits(self.hoisted.edits);
        }
    }

    /// Writes what is between two neighbouring tokens.
    fn separate(&self, writer: &mut Writer<'_>, previous: usize, index: usize) {
        let gap = Gap::new(self.text, self.tokens, Some(previous), index);
        let opens = self.tokens[previous].0 == TokenKind::OpenBrace;
        let closes = self.tokens[index].0 == TokenKind::CloseBrace;
        if let Some(list) = self.list {
            if list.commas && !opens && !closes {
                writer.glue(",");
            }
            if list.broken {
                let indent = spaces(list.indent + STEP);
                let next_indent = if closes { spaces(list.indent) } else { indent.clone() };
                let (indent, next_indent) = (indent.as_str(), next_indent.as_str());
                let place =
                    GapContext { indent, next_indent, opens, closes, blank: Blank::Never, hoisted: false };
                return gap.write_broken(writer, &place);
            }
        } else if self.begins_line(previous, index)
            && (!(opens && closes) || gap.has_comments() || !self.hoisted.comments.is_empty())
        {
            let inner = indent(self.depth);
            let hoisted = opens && !self.hoisted.comments.is_empty();
            for (token, span) in self.hoisted.comments.iter().filter(|_| hoisted) {
                writer.line(&inner);
                writer.glue_comment(*token, *span, &inner);
            }
            let outer = indent(self.depth.saturating_sub(1));
            let next_indent = if closes { outer.as_str() } else { inner.as_str() };
            let place =
                GapContext { indent: &inner, next_indent, opens, closes, blank: Blank::Kept, hoisted };
            return gap.write_broken(writer, &place);
        }
        let glue = if self.tokens[index].0 == TokenKind::Comma { "" } else { " " };
        gap.write_inline(writer, &indent(self.depth + 1), glue);
    }

    /// Returns whether a token outside lists begins a line: an action, or the end of a block.
    fn begins_line(&self, previous: usize, index: usize) -> bool {
        let begins = self.begins_action(previous, index) || self.tokens[index].0 == TokenKind::CloseBrace;
        self.depth > 0 && (begins || self.tokens[previous].0 == TokenKind::OpenBrace)
    }

    /// Returns whether a token outside lists begins an action. A word after `do` is a name, and an `if` after `else`
    /// continues.
    fn begins_action(&self, previous: usize, index: usize) -> bool {
        let continues = match self.tokens[previous].0 {
            TokenKind::Do => !self.is_done(previous),
            TokenKind::Else => true,
            _ => false,
        };
        self.tokens[index].0.is_action() && !continues
    }

    /// Returns whether the `do` at `index` is the name of a movement that is done, not the keyword.
    fn is_done(&self, index: usize) -> bool {
        let earlier =
            self.tokens[self.item.first..index].iter().rev().filter(|(token, _)| !token.is_comment());
        let row = earlier.take_while(|(token, _)| *token == TokenKind::Do).count();
        row % 2 == 1
    }

    /// Returns whether a brace after the token at `previous` opens the list of a condition, not a block.
    fn opens_condition(&self, previous: usize) -> bool {
        self.depth > 0 && matches!(self.tokens[previous].0, TokenKind::Until | TokenKind::If)
    }

    /// The list that begins at the brace at `open`, which has been written already; `before` is the token before it.
    fn begin_list(&self, writer: &Writer<'_>, before: usize, open: usize) -> List {
        let commas = matches!(self.tokens[before].0, TokenKind::Sensors | TokenKind::Until | TokenKind::If);
        let broken = !self.fits(writer.column(), open, commas);
        List { commas, broken, indent: writer.line_indent() }
    }

    /// Returns whether a list fits on one line, together with the text after it up to the next place for a line break.
    fn fits(&self, column: usize, open: usize, commas: bool) -> bool {
        let mut column = column;
        let mut previous = open;
        let mut in_list = true;
        let mut names = 0;
        for index in open + 1..=self.item.last {
            let (token, span) = self.tokens[index];
            if token.is_comment() || token == TokenKind::Comma && in_list {
                continue;
            }
            let closes = token == TokenKind::CloseBrace;
            if !in_list && (closes || self.begins_action(previous, index)) {
                break;
            }
            let gap = Gap::new(self.text, self.tokens, Some(previous), index);
            if in_list && gap.forces_break() {
                return false;
            }
            let hoisted = !in_list && self.hoists(previous, index);
            let (comments, ends) = if hoisted { (0, false) } else { gap.width() };
            column += comments;
            if ends {
                break;
            }
            column += usize::from(token != TokenKind::Comma) + span.len() as usize;
            if in_list && !closes {
                column += usize::from(commas && names > 0);
                names += 1;
            }
            in_list = in_list && !closes;
            if column > COLUMNS && names > 0 {
                return false;
            }
            if token == TokenKind::OpenBrace {
                break;
            }
            previous = index;
        }
        column <= COLUMNS || names == 0
    }
}

/// The indentation of actions in so many blocks.
fn indent(depth: usize) -> String {
    spaces(depth.min(MAX_STEPS) * STEP)
}

fn spaces(count: usize) -> String {
    " ".repeat(count)
}
