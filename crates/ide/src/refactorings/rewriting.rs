//! New text in an entity, in canonical layout.

use pydslrep_analysis::Edit;
use pydslrep_syntax::{Span, TextEdit, Token, apply_edits, format_edits, lex, offset, parse};

use super::Selection;

impl Selection<'_> {
    /// The edit that makes replacements, which are in the order of the text, and lays out what is new; `None` if the entity
    /// would not be understood any more.
    pub(super) fn rewrite(&self, replacements: &[(Span, String)]) -> Option<Edit> {
        let before = self.text(Span::new(0, self.entity.span.len()));
        let edits: Vec<TextEdit> =
            replacements.iter().map(|(span, text)| TextEdit { span: *span, text: text.clone() }).collect();
        let (first, last) = (edits.first()?.span, edits.last()?.span);
        let after = apply_edits(&before, &edits);
        let (from_end, new_end) = (Span::of(&before).end - last.end, Span::of(&after).end);
        let (changed, text) = laid_out(&after, Span::new(first.start, new_end - from_end))?;
        let whole = Span::new(changed.start, Span::of(&before).end - (new_end - changed.end));
        let (part, text) = difference(whole.text(&before), &text);
        Some(self.edit(part.shifted(whole.start), self.with_line_ends(text)))
    }

    /// A text with the line ending of the file: the entity alone may have no line break to infer it from.
    fn with_line_ends(&self, text: &str) -> String {
        let ending = self.database.line_ending(self.file);
        text.replace("\r\n", "\n").replace('\r', "\n").replace('\n', ending)
    }

    /// The comments in a range, in its order.
    pub(super) fn comments(&self, range: Span) -> impl Iterator<Item = Span> {
        let tokens = &self.entity.parse.tokens;
        let first = tokens.partition_point(|(_, span)| span.start < range.start);
        let inside = tokens.iter().skip(first).take_while(move |(_, span)| span.end <= range.end);
        inside.filter(|(token, _)| token.is_comment()).map(|(_, span)| *span)
    }

    /// The comments in a range, each on a line of its own.
    pub(super) fn comment_lines(&self, range: Span) -> String {
        self.comments(range).map(|comment| self.text(comment) + "\n").collect()
    }

    /// Returns the replacement of a range: `text`, after comments that are kept on lines of their own. A comment at its
    /// end must not swallow what follows.
    pub(super) fn in_place_of(&self, span: Span, comments: &str, text: &str) -> (Span, String) {
        let text = text.trim();
        let end = if lex(text).last().is_some_and(|(token, _)| token.ends_line()) { "\n" } else { "" };
        let begin = if comments.is_empty() || self.begins_line(span.start) { "" } else { "\n" };
        (span, format!("{begin}{comments}{text}{end}"))
    }

    fn begins_line(&self, offset: u32) -> bool {
        let tokens = &self.entity.parse.tokens;
        let before = tokens[..tokens.partition_point(|(_, span)| span.end <= offset)].last();
        let gap = Span::new(before.map_or(0, |(_, span)| span.end), offset);
        self.text(gap).contains(['\n', '\r'])
    }
}

/// The part of a text that another one changes, and what it is then. Line breaks are equal whatever their kind: those around
/// the change stay as they are.
fn difference<'a>(old: &str, new: &'a str) -> (Span, &'a str) {
    let (olds, news) = (characters(old), characters(new));
    let alike = |((_, old), (_, new)): &((Span, char), (Span, char))| old == new;
    let zipped = olds.iter().copied().zip(news.iter().copied());
    let head = zipped.take_while(alike).count();
    let rest = olds[head..].iter().copied().rev().zip(news[head..].iter().copied().rev());
    let tail = rest.take_while(alike).count();
    let part = |characters: &[(Span, char)], text: &str| {
        let inner = &characters[head..characters.len() - tail];
        let start = characters.get(head).map_or(Span::of(text).end, |(span, _)| span.start);
        Span::new(start, inner.last().map_or(start, |(span, _)| span.end))
    };
    (part(&olds, old), part(&news, new).text(new))
}

/// The characters of a text; a line break of any kind is one.
fn characters(text: &str) -> Vec<(Span, char)> {
    let mut found: Vec<(Span, char)> = Vec::new();
    let mut start = 0;
    for character in text.chars() {
        let end = start + offset(character.len_utf8());
        let follows_return = start > 0 && text.as_bytes().get(start as usize - 1) == Some(&b'\r');
        match found.last_mut() {
            Some((span, _)) if character == '\n' && follows_return => span.end = end,
            _ => found.push((Span::new(start, end), if character == '\r' { '\n' } else { character })),
        }
        start = end;
    }
    found
}

/// A part of an entity in canonical layout, with the white space and comments around it; `None` where the entity has errors.
fn laid_out(entity: &str, part: Span) -> Option<(Span, String)> {
    let pieces = parse(entity);
    let [(_, parsed)] = pieces.as_slice() else { return None };
    if !parsed.errors.is_empty() {
        return None;
    }
    let part = with_comments_around(&parsed.tokens, part);
    let mut layout = format_edits(entity, pieces.iter().map(|(span, parse)| (*span, parse)));
    layout.retain(|edit| edit.span.start <= part.end && part.start <= edit.span.end);
    let whole = layout.iter().fold(part, |whole, edit| whole.to(edit.span));
    for edit in &mut layout {
        edit.span = Span::new(edit.span.start - whole.start, edit.span.end - whole.start);
    }
    Some((whole, apply_edits(whole.text(entity), &layout)))
}

/// A part with the comments next to it, whose place depends on what it is.
fn with_comments_around(tokens: &[Token], part: Span) -> Span {
    let first = tokens.partition_point(|(_, span)| span.start < part.start);
    let end = tokens.partition_point(|(_, span)| span.start < part.end);
    let is_comment = |(token, _): &&Token| token.is_comment();
    let before = tokens.iter().take(first).rev().take_while(is_comment).last();
    let after = tokens.iter().skip(end).take_while(is_comment).last();
    let whole = before.map_or(part, |(_, span)| part.to(*span));
    after.map_or(whole, |(_, span)| whole.to(*span))
}

#[cfg(test)]
mod tests {
    use super::difference;

    #[test]
    fn only_what_is_different_is_written() {
        let cases = [
            ("a\r\nb\r\nc", "a\nB\nc", (3, 4, "B")),
            ("a\rb", "a\nb", (3, 3, "")),
            ("turn left\r\n", "turn left 90\n", (9, 9, " 90")),
            ("aa", "a", (1, 2, "")),
            ("", "é", (0, 0, "é")),
            ("\n\n", "\r\n", (1, 2, "")),
        ];
        for (old, new, expected) in cases {
            let (part, text) = difference(old, new);
            assert_eq!((part.start, part.end, text), expected, "{old:?} {new:?}");
        }
    }
}
