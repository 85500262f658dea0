//! Formatting while typing: a closing brace formats its movement, list or action, and a new line is indented.
//!
//! Other entities never change, and entities with errors are only indented.

use pydslrep_analysis::{Database, EntityRef};
use pydslrep_syntax::ast::Entity;
use pydslrep_syntax::{EntityKind, Span, TextEdit, Token, TokenKind, format_edits};

use crate::FilePosition;
use crate::cursor::body;

/// The width of one indentation level, in spaces.
const INDENT: usize = 2;

/// The edits after a `}` was typed right before a position.
pub fn format_after_brace(database: &Database, position: FilePosition) -> Vec<TextEdit> {
    let Some(brace) = position.offset.checked_sub(1) else { return Vec::new() };
    let Some(entity) = database.entity_at(position.file, brace) else { return Vec::new() };
    let start = entity.span.start;
    let closes = |(token, span): &&Token| *token == TokenKind::CloseBrace && span.start + start == brace;
    if !entity.parse.tokens.iter().any(|token| closes(&token)) {
        // The brace is in a comment.
        return Vec::new();
    }
    if !entity.parse.errors.is_empty() {
        return format_after_line_break(database, FilePosition { offset: brace, ..position });
    }
    let part = match &entity.parse.entity {
        Some(Entity::Movement(movement)) => {
            let action = movement.actions.iter().map(|action| action.span.shifted(start));
            action.into_iter().find(|span| span.touches(position.offset)).unwrap_or_else(|| body(&entity))
        }
        _ => body(&entity),
    };
    let part = Span::new(part.start, part.end.min(position.offset));
    format_part(database, &entity, part)
}

/// The formatting edits within a part of an entity without errors.
fn format_part(database: &Database, entity: &EntityRef<'_>, part: Span) -> Vec<TextEdit> {
    let start = entity.span.start;
    let text = database.slice(entity.file, entity.span);
    let edits = format_edits(&text, [(Span::of(&text), entity.parse)]);
    let ending = database.line_ending(entity.file);
    edits
        .into_iter()
        .map(|edit| TextEdit {
            span: edit.span.shifted(start),
            // The entity alone may have no line break to infer the ending from.
            text: edit.text.replace("\r\n", "\n").replace('\n', ending),
        })
        .filter(|edit| part.start < edit.span.start && edit.span.end < part.end)
        .collect()
}

/// The edits after a line break was typed before a position: replaces the white space before it if it is not that of
/// the canonical layout.
pub fn format_after_line_break(database: &Database, position: FilePosition) -> Vec<TextEdit> {
    let Some(line) = Line::at(database, position) else { return Vec::new() };
    let Some(depth) = line.depth(database, position) else { return Vec::new() };
    let wanted = " ".repeat(depth * INDENT);
    if wanted == database.slice(position.file, line.blank) {
        return Vec::new();
    }
    vec![TextEdit { span: line.blank, text: wanted }]
}

/// The leading white space of a line.
struct Line {
    blank: Span,
}

impl Line {
    fn at(database: &Database, position: FilePosition) -> Option<Self> {
        let text = database.text(position.file)?;
        let offset = (position.offset as usize).min(text.len_bytes());
        let start = text.line_to_byte(text.byte_to_line(offset));
        let blank = text.byte_slice(start..).bytes().take_while(|byte| matches!(byte, b' ' | b'\t')).count();
        let to_u32 = |at: usize| u32::try_from(at).ok();
        Some(Self { blank: Span::new(to_u32(start)?, to_u32(start + blank)?) })
    }

    /// The indentation level of the line; `None` if unknown.
    fn depth(&self, database: &Database, position: FilePosition) -> Option<usize> {
        let before = self.blank.start.checked_sub(1)?;
        let entity = database.entity_at(position.file, before)?;
        let place = |(token, span): &Token| (*token, span.shifted(entity.span.start));
        let tokens = || entity.parse.tokens.iter().map(place);
        if tokens().any(|(_, span)| span.start < self.blank.start && self.blank.start < span.end) {
            // The layout of comments is left to the user.
            return None;
        }
        let is_sign = |(token, span): &Token| !token.is_comment() && span.end <= self.blank.start;
        let typed: Vec<TokenKind> = tokens().filter(is_sign).map(|(token, _)| token).collect();
        let open = typed.iter().fold(0_usize, |open, token| match token {
            TokenKind::OpenBrace => open + 1,
            TokenKind::CloseBrace => open.saturating_sub(1),
            _ => open,
        });
        let closes =
            tokens().any(|(token, span)| token == TokenKind::CloseBrace && span.start == self.blank.end);
        let is_movement = typed.first().and_then(|token| token.entity_kind()) == Some(EntityKind::Movement);
        match open {
            0 => self.ends(&entity).then_some(0),
            // Each line of a movement's body begins an action or continues one.
            1 if is_movement && !closes && continues(&typed) => Some(2),
            open => Some(open - usize::from(closes)),
        }
    }

    /// Whether a complete entity ends before the line.
    fn ends(&self, entity: &EntityRef<'_>) -> bool {
        entity.parse.entity.is_some()
            && entity.parse.errors.is_empty()
            && body(entity).end <= self.blank.start
    }
}

/// Whether the last action is incomplete.
fn continues(typed: &[TokenKind]) -> bool {
    let last = typed.last().copied();
    matches!(last, Some(TokenKind::Move | TokenKind::Turn | TokenKind::At | TokenKind::Until))
        || matches!(typed, [.., TokenKind::Move, number] if number.is_number())
}

#[cfg(test)]
mod tests {
    use pydslrep_syntax::apply_edits;

    use super::*;
    use crate::fixture::at_cursor;

    fn after(fixture: &str, edit: fn(&Database, FilePosition) -> Vec<TextEdit>) -> String {
        let (database, position) = at_cursor(fixture);
        let text = database.text(position.file).unwrap().to_string();
        apply_edits(&text, &edit(&database, position))
    }

    fn brace(fixture: &str, expected: &str) {
        assert_eq!(after(fixture, format_after_brace), expected, "{fixture}");
    }

    fn line_break(fixture: &str, expected: &str) {
        assert_eq!(after(fixture, format_after_line_break), expected, "{fixture}");
    }

    #[test]
    fn a_brace_formats_the_movement_it_closes_and_nothing_else() {
        brace(
            "wheel  a with radius 3\nmovement  m of r {move 1  meters\n    }$0\n\n\nwheel  b with radius 3",
            "wheel  a with radius 3\nmovement m of r {\n  move 1 meters\n}\n\n\nwheel  b with radius 3",
        );
        brace("sensor s\r\nmovement m of r {slam}$0", "sensor s\r\nmovement m of r {\r\n  slam\r\n}");
    }

    #[test]
    fn the_brace_of_a_list_formats_its_action_or_clause() {
        brace(
            "movement  m of r {\n  slam   slam\n  turn  left until {s,t}$0 slam\n}",
            "movement  m of r {\n  slam   slam\n  turn left until { s, t } slam\n}",
        );
        brace("robot  r with port 1 has {a,b}$0  wheels", "robot r with port 1 has { a b }  wheels");
    }

    #[test]
    fn a_brace_of_an_entity_with_errors_is_only_indented() {
        brace("movement  m of {\n  slam\n    }$0", "movement  m of {\n  slam\n}");
        brace("movement m of r { // }$0", "movement m of r { // }");
        brace("}$0", "}");
    }

    #[test]
    fn a_line_is_indented_by_its_depth() {
        line_break("movement m of r {\n$0}", "movement m of r {\n}");
        line_break("movement m of r {\n$0\n}", "movement m of r {\n  \n}");
        line_break("movement m of r {\n  slam\n\t\t$0turn left", "movement m of r {\n  slam\n  turn left");
        line_break("movement m of r {\n  move\n$0", "movement m of r {\n  move\n    ");
        line_break(
            "movement m of r {\n  turn left until {\n  $0s",
            "movement m of r {\n  turn left until {\n    s",
        );
        line_break("robot r with port 1 has {\n$0", "robot r with port 1 has {\n  ");
        line_break("robot r with port 1 has {\r\n  a\r\n  $0}", "robot r with port 1 has {\r\n  a\r\n}");
        line_break("wheel a with radius 3\n    $0", "wheel a with radius 3\n");
    }

    #[test]
    fn other_lines_are_left_alone() {
        line_break("robot r with port 1\n   $0has", "robot r with port 1\n   has");
        line_break("movement m of r { /*\n   $0*/", "movement m of r { /*\n   */");
        line_break("   $0wheel", "   wheel");
        line_break("\n   $0wheel a with radius 3", "\n   wheel a with radius 3");
    }
}
