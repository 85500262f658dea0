//! Comments between two tokens, and how they stay where they are.
//!
//! Comments that share a line are a group. A group is after the token before it (at the end of its line), before
//! the token after it (at the start of its line), or on a line of its own; that is what the layout keeps.

use std::ops::Range;

use super::writer::{BLANKS, BYTE_ORDER_MARK, LINE_ENDS, Writer};
use crate::{Span, Token};

/// The text between two neighbouring tokens that are not comments.
pub(super) struct Gap<'a> {
    text: &'a str,
    tokens: &'a [Token],
    groups: Vec<Group>,
    /// Line ends before the second token.
    next_lines: usize,
}

/// Comments on one line. In lists a comma may be among them.
struct Group {
    /// Indices into the tokens.
    range: Range<usize>,
    /// Line ends before it.
    lines: usize,
}

/// The treatment of blank lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Blank {
    /// They go.
    Never,
    /// One stays where there are any.
    Kept,
    /// Like `Kept`, and there is at least one.
    One,
}

/// Where a gap with a line break is.
pub(super) struct GapContext<'a> {
    /// Before comments on lines of their own.
    pub(super) indent: &'a str,
    /// Before the second token.
    pub(super) next_indent: &'a str,
    /// True if the first token opens something; a blank line after it is removed.
    pub(super) opens: bool,
    /// True if the second token closes something; a blank line before it is removed.
    pub(super) closes: bool,
    pub(super) blank: Blank,
    /// True if comments on lines of their own have been written before it.
    pub(super) hoisted: bool,
}

impl<'a> Gap<'a> {
    /// The gap between the token at index `from` and that at `to`; `None` is the start of the file, the number of
    /// tokens its end.
    pub(super) fn new(text: &'a str, tokens: &'a [Token], from: Option<usize>, to: usize) -> Self {
        let mut at = from.map_or(0, |index| tokens[index].1.end);
        let first = from.map_or(0, |index| index + 1);
        let mut groups: Vec<Group> = Vec::new();
        for (index, &(token, span)) in (first..to).zip(&tokens[first..to]) {
            if !token.is_comment() {
                continue;
            }
            // The start of a file is the start of a line.
            let lines = line_ends(text, at, span.start).max(usize::from(at == 0));
            match groups.last_mut() {
                Some(group) if lines == 0 => group.range.end = index + 1,
                _ => groups.push(Group { range: index..index + 1, lines }),
            }
            at = span.end;
        }
        let end = tokens.get(to).map_or(Span::of(text).end, |(_, span)| span.start);
        Self { text, tokens, groups, next_lines: line_ends(text, at, end) }
    }

    pub(super) fn has_comments(&self) -> bool {
        !self.groups.is_empty()
    }

    fn comments(&self, group: &Group) -> impl Iterator<Item = Token> + use<'a> {
        self.tokens[group.range.clone()].iter().copied().filter(|(token, _)| token.is_comment())
    }

    /// Line ends after a group.
    fn lines_after(&self, index: usize) -> usize {
        self.groups.get(index + 1).map_or(self.next_lines, |group| group.lines)
    }

    fn stands_alone(&self, index: usize) -> bool {
        self.groups[index].lines > 0 && self.lines_after(index) > 0
    }

    /// The first of the comments that are right above the second token.
    pub(super) fn first_attached(&self) -> Option<usize> {
        let attached = |index: &usize| self.groups[*index].lines > 0 && self.lines_after(*index) < 2;
        (0..self.groups.len()).rev().take_while(attached).last().map(|index| self.groups[index].range.start)
    }

    /// Returns whether the two tokens cannot share a line.
    pub(super) fn forces_break(&self) -> bool {
        self.groups.iter().enumerate().any(|(index, group)| {
            self.stands_alone(index)
                || self
                    .comments(group)
                    .any(|(token, span)| token.ends_line() || span.text(self.text).contains(['\n', '\r']))
        })
    }

    /// The columns that the comments take up to the first line break among them, and whether there is one.
    pub(super) fn width(&self) -> (usize, bool) {
        let mut width = 0;
        for (index, group) in self.groups.iter().enumerate() {
            if self.stands_alone(index) {
                return (width, true);
            }
            for (token, span) in self.comments(group) {
                if token.ends_line() {
                    return (width, true);
                }
                let text = span.text(self.text);
                let first = text.split(['\n', '\r']).next().unwrap_or_default();
                width += 1 + first.chars().count();
                if first.len() < text.len() {
                    return (width, true);
                }
            }
        }
        (width, false)
    }

    /// Writes the gap between two tokens of one line. Where a comment breaks the line, it goes on at `indent`.
    pub(super) fn write_inline(&self, writer: &mut Writer<'_>, indent: &str, glue: &str) {
        let mut broken = false;
        for (index, group) in self.groups.iter().enumerate() {
            let alone = self.stands_alone(index);
            if alone || broken {
                writer.line(indent);
            } else {
                writer.space();
            }
            self.write_group(writer, group, (alone || broken).then_some(indent));
            let ends_line = self.comments(group).last().is_some_and(|(token, _)| token.ends_line());
            broken = alone || ends_line;
        }
        if broken {
            writer.line(indent);
        } else {
            writer.glue(glue);
        }
    }

    /// Writes the gap between two tokens on different lines.
    pub(super) fn write_broken(&self, writer: &mut Writer<'_>, place: &GapContext<'_>) {
        let missing_blank = place.blank == Blank::One
            && self.next_lines < 2
            && self.groups.iter().all(|group| group.lines < 2);
        let mut first_line = !place.hoisted;
        let mut leads = false;
        let mut break_line = |writer: &mut Writer<'_>, lines: usize, indent: &str, closes: bool| {
            let kept = lines > 1 && place.blank != Blank::Never;
            let blank = (kept || missing_blank && first_line) && !(first_line && place.opens) && !closes;
            first_line = false;
            writer.lines(if blank { 2 } else { 1 }, indent);
        };
        for (index, group) in self.groups.iter().enumerate() {
            let before_next = self.lines_after(index) == 0;
            let shares_line = group.lines == 0 && !(before_next && place.opens);
            if shares_line && !(place.hoisted && index == 0) {
                writer.space();
                self.write_group(writer, group, None);
            } else {
                break_line(writer, group.lines, place.indent, false);
                self.write_group(writer, group, Some(place.indent));
                leads = before_next && !place.closes;
            }
        }
        if leads {
            writer.space();
        } else {
            break_line(writer, self.next_lines, place.next_indent, place.closes);
        }
    }

    /// `indent` is given where the group begins a line.
    fn write_group(&self, writer: &mut Writer<'_>, group: &Group, indent: Option<&str>) {
        for (index, (token, span)) in self.comments(group).enumerate() {
            if index > 0 {
                writer.space();
            }
            writer.comment(token, span, indent.filter(|_| index == 0));
        }
    }
}

/// Line ends in a range; `\r\n` is one.
fn line_ends(text: &str, from: u32, to: u32) -> usize {
    let text = Span::new(from, to).text(text);
    text.matches(LINE_ENDS).count() - text.matches("\r\n").count()
}

/// The white space before a token that begins its line.
pub(super) fn indent_of(text: &str, span: Span) -> &str {
    let before = Span::new(0, span.start).text(text);
    let before = before.strip_prefix(BYTE_ORDER_MARK).unwrap_or(before);
    // Never the whole line: it may be long.
    let rest = before.trim_end_matches(BLANKS);
    if rest.is_empty() || rest.ends_with(LINE_ENDS) { &before[rest.len()..] } else { "" }
}
