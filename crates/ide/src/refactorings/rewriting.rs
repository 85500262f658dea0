//! New text in an entity, in canonical layout.

use pydslrep_analysis::Edit;
use pydslrep_syntax::{Span, TextEdit, apply_edits, format_edits, parse};

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
        let pieces = parse(&after);
        let [(_, parsed)] = pieces.as_slice() else { return None };
        if !parsed.errors.is_empty() {
            return None;
        }
        let left = Span::of(&before).end - last.end;
        let mut changed = Span::new(first.start, Span::of(&after).end - left);
        let is_new = |edit: &TextEdit| edit.span.start <= changed.end && changed.start <= edit.span.end;
        let mut layout = format_edits(&after, pieces.iter().map(|(span, parse)| (*span, parse)));
        layout.retain(is_new);
        for edit in &layout {
            changed = changed.to(edit.span);
        }
        for edit in &mut layout {
            edit.span = Span::new(edit.span.start - changed.start, edit.span.end - changed.start);
        }
        let text = apply_edits(changed.text(&after), &layout);
        let left = Span::of(&after).end - changed.end;
        Some(self.edit(Span::new(changed.start, Span::of(&before).end - left), self.with_line_ends(&text)))
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

    /// What is to be in the place of some text: another one, after comments that are kept on lines of their own. A comment at
    /// its end must not swallow what follows.
    pub(super) fn in_place_of(&self, span: Span, comments: &str, text: &str) -> (Span, String) {
        let text = text.trim();
        let last = text.rsplit(['\n', '\r']).next().unwrap_or_default();
        let end = if last.contains("//") { "\n" } else { "" };
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
