//! The layout of one entity without errors.

use super::gap::{Blank, Gap, Place};
use super::piece::{Item, ItemKind};
use super::writer::Writer;
use crate::{EntityKind, Token, TokenKind};

/// The longest line, in characters, that a list may be on.
pub const COLUMNS: usize = 100;

const SPACES: &str = "          ";

/// One step of indentation, in spaces.
const STEP: usize = 2;

/// A list of references that is being written.
#[derive(Debug, Clone, Copy)]
struct List {
    /// Whether its references are apart by commas.
    commas: bool,
    /// One reference per line.
    broken: bool,
    /// Of the line that it begins on.
    indent: usize,
}

/// Writes the entity that `item` is; what is around it is not touched.
pub(super) fn lay_out(writer: &mut Writer<'_>, text: &str, tokens: &[Token], item: &Item) {
    let is_movement = item.first_kind == Some(ItemKind::Declaration(EntityKind::Movement));
    let mut layout = Layout { text, tokens, item, is_movement, in_body: false, list: None };
    layout.write(writer);
}

struct Layout<'a> {
    text: &'a str,
    tokens: &'a [Token],
    item: &'a Item,
    is_movement: bool,
    in_body: bool,
    list: Option<List>,
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
            self.separate(writer, previous, index);
            writer.put(span);
            if self.list.is_some_and(|list| list.commas) {
                // A comma that moves over a comment comes and goes at once.
                writer.join_edits(edits);
            }
            match token {
                TokenKind::OpenBrace if self.is_movement && !self.in_body => self.in_body = true,
                TokenKind::OpenBrace => self.list = Some(self.begin_list(writer, previous, index)),
                TokenKind::CloseBrace => self.list = None,
                _ => {}
            }
            previous = index;
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
                let next_indent = if closes { spaces(list.indent) } else { indent };
                let place = Place { indent, next_indent, opens, closes, blank: Blank::Never };
                return gap.write_broken(writer, &place);
            }
        } else if self.begins_line(previous, index) && (!(opens && closes) || gap.has_comments()) {
            let next_indent = if closes { "" } else { spaces(STEP) };
            let place = Place { indent: spaces(STEP), next_indent, opens, closes, blank: Blank::Kept };
            return gap.write_broken(writer, &place);
        }
        let step = if self.in_body { 2 * STEP } else { STEP };
        let glue = if self.tokens[index].0 == TokenKind::Comma { "" } else { " " };
        gap.write_inline(writer, spaces(step), glue);
    }

    /// Whether a token outside lists begins a line: an action of a movement, or the end of its body.
    fn begins_line(&self, previous: usize, index: usize) -> bool {
        let (token, _) = self.tokens[index];
        let begins = token.is_action() || token == TokenKind::CloseBrace;
        self.in_body && (begins || self.tokens[previous].0 == TokenKind::OpenBrace)
    }

    /// The list that begins at the brace at `open`, which has been written already; `before` is the token before it.
    fn begin_list(&self, writer: &Writer<'_>, before: usize, open: usize) -> List {
        let commas = matches!(self.tokens[before].0, TokenKind::Sensors | TokenKind::Until);
        let broken = !self.fits(writer.column(), open, commas);
        List { commas, broken, indent: writer.line_indent() }
    }

    /// Whether a list can be on one line, together with what follows it up to the next place for a line break.
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
            if !in_list && (closes || token.is_action()) {
                break;
            }
            let gap = Gap::new(self.text, self.tokens, Some(previous), index);
            if in_list && gap.forces_break() {
                return false;
            }
            let (comments, ends) = gap.width();
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

fn spaces(count: usize) -> &'static str {
    &SPACES[..count.min(SPACES.len())]
}
