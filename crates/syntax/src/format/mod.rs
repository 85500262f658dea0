//! The canonical layout of a program.
//!
//! Only what is between tokens is ever changed: white space, the commas of lists, blank ends of comment lines.
//! The layout is therefore a list of small edits, and meaning cannot change. Entities with errors are left byte for
//! byte as they are, because what a person meant there is not known.

mod entity;
mod gap;
mod piece;
mod writer;

pub use self::entity::COLUMNS;
use self::entity::lay_out;
use self::gap::{Blank, Gap, GapContext};
use self::piece::{Item, items};
use self::writer::{BYTE_ORDER_MARK, Writer};
use crate::{Parse, Span, Token, TokenKind, parse};

/// A change of text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TextEdit {
    /// The text that is removed.
    pub span: Span,
    /// The text that is inserted.
    pub text: String,
}

/// `text` in canonical layout. Its line ending (that of its first line), its byte order mark and whatever could not
/// be parsed stay as they are.
pub fn format(text: &str) -> String {
    let pieces = parse(text);
    let edits = format_edits(text, pieces.iter().map(|(span, parse)| (*span, parse)));
    apply_edits(text, &edits)
}

/// `text` after edits that are in order and apart from each other.
pub fn apply_edits(text: &str, edits: &[TextEdit]) -> String {
    let mut changed = String::with_capacity(text.len());
    let mut at = 0;
    for edit in edits {
        changed.push_str(Span::new(at, edit.span.start).text(text));
        changed.push_str(&edit.text);
        at = edit.span.end;
    }
    changed.push_str(text.get(at as usize..).unwrap_or_default());
    changed
}

/// The edits that bring `text` into canonical layout, in order and apart from each other. `pieces` is what [`parse`]
/// makes of `text`. Each edit keeps the meaning by itself, so that any choice of them may be applied.
pub fn format_edits<'a>(text: &str, pieces: impl IntoIterator<Item = (Span, &'a Parse)>) -> Vec<TextEdit> {
    if u32::try_from(text.len()).is_err() {
        // Spans cannot reach the end.
        return Vec::new();
    }
    let (tokens, items) = items(text, pieces);
    let mut writer = Writer::new(text);
    let mut previous: Option<&Item> = None;
    for item in &items {
        separate(&mut writer, text, &tokens, previous, Some(item));
        if item.broken {
            writer.put(Span::new(tokens[item.first].1.start, tokens[item.last].1.end));
        } else {
            lay_out(&mut writer, text, &tokens, item);
        }
        previous = Some(item);
    }
    if previous.is_none_or(|item| tokens[item.last].0 != TokenKind::UnterminatedComment) {
        separate(&mut writer, text, &tokens, previous, None);
    }
    writer.finish()
}

/// Writes what is between two items: comments, and the right number of line ends.
fn separate(
    writer: &mut Writer<'_>,
    text: &str,
    tokens: &[Token],
    previous: Option<&Item>,
    next: Option<&Item>,
) {
    if previous.is_none() && next.is_some_and(|item| begins_with_mark(text, tokens, item)) {
        // At the very start it would be taken for the file's byte order mark.
        return writer.keep(tokens[0].1.start);
    }
    let from = previous.map(|item| item.last);
    let to = next.map_or(tokens.len(), |item| item.first);
    let gap = Gap::new(text, tokens, from, to);
    let kept_indent = next.filter(|item| item.broken).map(|item| gap::indent_of(text, tokens[item.first].1));
    let place = GapContext {
        indent: "",
        next_indent: kept_indent.unwrap_or_default(),
        opens: previous.is_none(),
        closes: next.is_none(),
        blank: blank_between(previous, next, &gap),
        hoisted: false,
    };
    gap.write_broken(writer, &place);
}

fn begins_with_mark(text: &str, tokens: &[Token], item: &Item) -> bool {
    item.first == 0 && tokens[0].1.text(text).starts_with(BYTE_ORDER_MARK)
}

/// Declarations of one line stay together, kind by kind; everything else is kept apart.
fn blank_between(previous: Option<&Item>, next: Option<&Item>, gap: &Gap<'_>) -> Blank {
    let (Some(previous), Some(next)) = (previous, next) else { return Blank::Kept };
    let (Some(above), Some(below)) = (previous.last_kind, next.first_kind) else { return Blank::Kept };
    let one_run = above == below && below.stands_in_runs();
    match (one_run, previous.broken || next.broken || gap.has_comments()) {
        (false, _) => Blank::One,
        (true, true) => Blank::Kept,
        (true, false) => Blank::Never,
    }
}
