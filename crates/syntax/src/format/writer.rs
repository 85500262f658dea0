//! Walks over the text and notes where what is between tokens has to change.

use std::borrow::Cow;

use super::TextEdit;
use crate::{Span, TokenKind};

pub(super) const BYTE_ORDER_MARK: &str = "\u{feff}";

/// Where the layout has got to.
pub(super) struct Writer<'a> {
    text: &'a str,
    line_ending: &'static str,
    /// Everything before this byte is done.
    at: u32,
    /// The text to insert between `at` and the next token.
    gap: String,
    /// True once anything is written.
    started: bool,
    /// Characters on the current line so far, the gap not counted.
    column: usize,
    /// Characters of white space the current line begins with.
    line_indent: usize,
    edits: Vec<TextEdit>,
}

impl<'a> Writer<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        let body = text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(text);
        Self {
            text,
            line_ending: line_ending(body),
            at: Span::of(text).len() - Span::of(body).len(),
            gap: String::new(),
            started: false,
            column: 0,
            line_indent: 0,
            edits: Vec::new(),
        }
    }

    /// Characters on the current line up to the last token.
    pub(super) fn column(&self) -> usize {
        self.column
    }

    /// Characters of white space the current line begins with.
    pub(super) fn line_indent(&self) -> usize {
        self.line_indent
    }

    /// Adds to what is to be before the next token.
    pub(super) fn glue(&mut self, glue: &str) {
        self.gap.push_str(glue);
    }

    pub(super) fn space(&mut self) {
        self.glue(" ");
    }

    /// Ends the line; the next begins with `indent`.
    pub(super) fn line(&mut self, indent: &str) {
        self.lines(1, indent);
    }

    /// Ends the line `count` times over. At the start of a file there is no line to end.
    pub(super) fn lines(&mut self, count: usize, indent: &str) {
        for _ in 0..if self.started { count } else { 0 } {
            self.gap.push_str(self.line_ending);
        }
        self.gap.push_str(indent);
        self.line_indent = indent.len();
    }

    /// Lets what is before the next token, which begins at `until`, stay as it is.
    pub(super) fn keep(&mut self, until: u32) {
        self.glue(Span::new(self.at, until).text(self.text));
    }

    /// Writes a stretch of the text as it is.
    pub(super) fn put(&mut self, span: Span) {
        self.flush(span.start);
        self.advance(span, span.text(self.text));
    }

    /// Writes a comment. `indent` is given where it begins a line; a comment of several lines that all begin with
    /// `*` is then moved as a whole.
    pub(super) fn comment(&mut self, token: TokenKind, span: Span, indent: Option<&str>) {
        let written = span.text(self.text);
        let wanted = wanted_comment(token, written, self.line_ending, indent);
        self.flush(span.start);
        self.advance(span, &wanted);
        if wanted != written {
            self.edits.push(TextEdit { span, text: wanted.into_owned() });
        }
    }

    /// Writes a comment from an earlier place, on a line of its own.
    pub(super) fn glue_comment(&mut self, token: TokenKind, span: Span, indent: &str) {
        let wanted = wanted_comment(token, span.text(self.text), self.line_ending, Some(indent));
        self.gap.push_str(&wanted);
    }

    /// Makes one edit of those from number `first` on, because one alone would be wrong.
    pub(super) fn join_edits(&mut self, first: usize) {
        if self.edits.len() < first + 2 {
            return;
        }
        let parts = self.edits.split_off(first);
        let mut joined = TextEdit { span: parts[0].span, text: String::new() };
        for part in parts {
            // Between two edits is what is kept; before the first there is nothing.
            joined.text += Span::new(joined.span.end.min(part.span.start), part.span.start).text(self.text);
            joined.text += &part.text;
            joined.span.end = part.span.end;
        }
        self.edits.push(joined);
    }

    /// Returns the number of edits.
    pub(super) fn edits(&self) -> usize {
        self.edits.len()
    }

    /// The edits, the last of them up to the end of the text.
    pub(super) fn finish(mut self) -> Vec<TextEdit> {
        self.flush(Span::of(self.text).end);
        self.edits
    }

    fn flush(&mut self, until: u32) {
        self.column += self.gap.len();
        if let Some(end) = self.gap.rfind(LINE_ENDS) {
            self.column = self.gap.len() - end - 1;
        }
        let span = Span::new(self.at, until);
        if span.text(self.text) != self.gap {
            self.edits.push(TextEdit { span, text: self.gap.clone() });
        }
        self.gap.clear();
    }

    fn advance(&mut self, span: Span, written: &str) {
        let last_line = written.rsplit(LINE_ENDS).next().unwrap_or_default();
        if last_line.len() < written.len() {
            self.column = 0;
        }
        self.column += last_line.chars().count();
        self.at = span.end;
        self.started = true;
    }
}

/// White space within a line.
pub(super) const BLANKS: [char; 3] = [' ', '\t', '\x0c'];
/// `\r\n` is one line end of two.
pub(super) const LINE_ENDS: [char; 2] = ['\n', '\r'];

/// Returns the line ending of the first line that is not blank.
fn line_ending(text: &str) -> &'static str {
    let first = |text: &str| {
        let end = &text[text.find(LINE_ENDS)?..];
        let spellings = ["\r\n", "\r", "\n"];
        spellings.into_iter().find(|spelling| end.starts_with(spelling))
    };
    let written = text.trim_start_matches(|c| BLANKS.contains(&c) || LINE_ENDS.contains(&c));
    first(written).or_else(|| first(text)).unwrap_or("\n")
}

/// A comment as it should be; `indent` is given where it begins a line.
fn wanted_comment<'t>(
    token: TokenKind,
    written: &'t str,
    line_ending: &str,
    indent: Option<&str>,
) -> Cow<'t, str> {
    match token {
        TokenKind::LineComment => Cow::Borrowed(written.trim_end_matches(BLANKS)),
        // `/ ` without its blank would be a mistake of another kind.
        TokenKind::ForeignComment => Cow::Borrowed(written),
        _ => block_comment(written, line_ending, indent),
    }
}

/// A block comment with the file's line ending; where it begins a line and its further lines all begin with `*`,
/// those are below the `*` of the first.
fn block_comment<'t>(written: &'t str, line_ending: &str, indent: Option<&str>) -> Cow<'t, str> {
    if !written.contains(LINE_ENDS) {
        return Cow::Borrowed(written);
    }
    let unified = written.replace("\r\n", "\n");
    let lines: Vec<&str> = unified.split(LINE_ENDS).collect();
    let starred = lines.iter().skip(1).all(|line| line.trim_start_matches(BLANKS).starts_with('*'));
    let mut wanted = String::with_capacity(written.len());
    for (index, line) in lines.iter().enumerate() {
        if index > 0 {
            wanted.push_str(line_ending);
        }
        match indent {
            Some(indent) if starred && index > 0 => {
                wanted.push_str(indent);
                wanted.push(' ');
                wanted.push_str(line.trim_start_matches(BLANKS));
            }
            _ => wanted.push_str(line),
        }
    }
    Cow::Owned(wanted)
}
