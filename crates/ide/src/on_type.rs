//! Formatting while typing: a closing brace formats its movement, block, list or action, and a new line is indented.
//!
//! Other entities never change. Of an entity with errors, only the list that the brace closes is formatted.

use std::ops::Range;

use pydslrep_analysis::{Database, EntityRef};
use pydslrep_syntax::ast::Entity;
use pydslrep_syntax::{
    EntityKind, Expected, Span, TextEdit, Token, TokenKind, expected_after, format_edits, parse,
};

use crate::FilePosition;
use crate::cursor::{body, tokens};
use crate::statements::Statements;

/// The width of one indentation level, in spaces.
const INDENT: usize = 2;

/// The edits after a `}` was typed right before a position. A `}` after it that closes nothing, which the editor inserted
/// together with the `{`, is removed.
pub fn format_after_brace(database: &Database, position: FilePosition) -> Vec<TextEdit> {
    let Some(brace) = position.offset.checked_sub(1) else { return Vec::new() };
    let Some(entity) = database.entity_at(position.file, brace) else { return Vec::new() };
    let tokens = significant(&entity);
    let is_typed = |(token, span): &Token| *token == TokenKind::CloseBrace && span.start == brace;
    // Otherwise the brace is in a comment.
    let Some(typed) = tokens.iter().position(is_typed) else { return Vec::new() };
    let inserted = inserted_brace(database, &entity, &tokens, typed);
    let mut edits = closed_part(database, &entity, position.offset, inserted).unwrap_or_else(|| {
        let mut edits: Vec<TextEdit> = indentation(database, position, brace).into_iter().collect();
        edits.extend(format_list(database, &entity, &tokens, typed));
        edits
    });
    edits.extend(inserted.map(|span| TextEdit { span, text: String::new() }));
    edits
}

/// The tokens of an entity without comments, with their ranges in the file.
fn significant(entity: &EntityRef<'_>) -> Vec<Token> {
    tokens(entity).filter(|(token, _)| !token.is_comment()).collect()
}

/// The `}` after the typed one, and the white space before it, if the typed one leaves a brace too many.
fn inserted_brace(
    database: &Database,
    entity: &EntityRef<'_>,
    tokens: &[Token],
    typed: usize,
) -> Option<Span> {
    let brace = tokens[typed].1;
    let following = tokens[typed + 1..].iter().take_while(|(token, _)| *token == TokenKind::CloseBrace);
    let closed = typed + 1 + following.count();
    let mut open = 0_usize;
    for (token, _) in &tokens[..=typed] {
        match token {
            TokenKind::OpenBrace => open += 1,
            // It closes nothing, whatever follows.
            TokenKind::CloseBrace => open = open.checked_sub(1)?,
            _ => {}
        }
    }
    // Behind the inserted one may be an `else` with its block.
    let more = |token: TokenKind| tokens[typed + 1..].iter().filter(|(other, _)| *other == token).count();
    let surplus = more(TokenKind::CloseBrace).saturating_sub(more(TokenKind::OpenBrace));
    let is_surplus = closed - typed - 1 > open || surplus > open;
    let (_, next) = tokens[typed + 1..closed].first().filter(|_| is_surplus)?;
    let between = database.slice(entity.file, Span::new(brace.end, next.start));
    between.trim().is_empty().then(|| Span::new(brace.end, next.end))
}

/// The formatting edits within the part of an entity that the brace before an offset closes, without a brace that is
/// removed; `None` if the entity then has errors.
fn closed_part(
    database: &Database,
    entity: &EntityRef<'_>,
    offset: u32,
    removed: Option<Span>,
) -> Option<Vec<TextEdit>> {
    let start = entity.span.start;
    let mut text = database.slice(entity.file, entity.span);
    let pieces;
    let parse = match removed {
        None => entity.parse,
        Some(removed) => {
            text.replace_range(Range::from(Span::new(removed.start - start, removed.end - start)), "");
            pieces = parse(&text);
            &pieces.first()?.1
        }
    };
    if !parse.errors.is_empty() {
        return None;
    }
    let whole = || Span::new(start, offset.max(start));
    let part = match &parse.entity {
        Some(Entity::Movement(movement)) => {
            let actions = movement.all_actions().map(|action| action.span.shifted(start));
            // The innermost begins last.
            actions.filter(|span| span.start < offset && offset <= span.end).last().unwrap_or_else(whole)
        }
        _ => whole(),
    };
    let part = Span::new(part.start, part.end.min(offset));
    let ending = database.line_ending(entity.file);
    let edits = format_edits(&text, [(Span::of(&text), parse)]).into_iter().map(|edit| TextEdit {
        span: edit.span.shifted(start),
        // The entity alone may have no line break to infer the ending from.
        text: edit.text.replace("\r\n", "\n").replace('\n', ending),
    });
    Some(edits.filter(|edit| part.start < edit.span.start && edit.span.end < part.end).collect())
}

/// The edit that writes a list of names on one line as in the canonical layout; `closing` is the index of its `}`.
fn format_list(
    database: &Database,
    entity: &EntityRef<'_>,
    tokens: &[Token],
    closing: usize,
) -> Option<TextEdit> {
    let in_list = |(token, _): &&Token| token.is_name() || *token == TokenKind::Comma;
    let opening = closing.checked_sub(1 + tokens[..closing].iter().rev().take_while(in_list).count())?;
    if tokens[opening].0 != TokenKind::OpenBrace {
        return None;
    }
    let statements = Statements::read(&tokens[..closing]);
    // `{do side}` is a block.
    if statements.as_ref().is_some_and(|statements| !statements.in_list()) {
        return None;
    }
    let is_of_sensors = statements.is_some()
        || tokens.first()?.0.entity_kind() != Some(EntityKind::Environment)
            && tokens[opening.checked_sub(1)?].0 == TokenKind::Sensors;
    let inside = Span::new(tokens[opening].1.end, tokens[closing].1.start);
    let written = database.slice(entity.file, inside);
    if written.contains(['\n', '\r', '/']) {
        return None;
    }
    let names = tokens[opening + 1..closing].iter().filter(|(token, _)| token.is_name());
    let names: Vec<String> = names.map(|(_, span)| database.slice(entity.file, *span)).collect();
    let wanted = format!(" {} ", names.join(if is_of_sensors { ", " } else { " " }));
    (!names.is_empty() && wanted != written).then_some(TextEdit { span: inside, text: wanted })
}

/// The edits after a line break was typed before a position: indents the new line as in the canonical layout, whatever the
/// lines before look like, and formats a list that ends the line before.
pub fn format_after_line_break(database: &Database, position: FilePosition) -> Vec<TextEdit> {
    let mut edits: Vec<TextEdit> = list_on_line_before(database, position).into_iter().collect();
    edits.extend(indentation(database, position, position.offset));
    edits
}

fn list_on_line_before(database: &Database, position: FilePosition) -> Option<TextEdit> {
    let line = Line::at(database, position)?;
    let entity = database.entity_at(position.file, line.blank.start.checked_sub(1)?)?;
    let tokens = significant(&entity);
    let last = tokens.iter().rposition(|(_, span)| span.end <= line.blank.start)?;
    let (token, span) = tokens[last];
    let line_break = database.slice(entity.file, Span::new(span.end, line.blank.start));
    let ends_line = matches!(line_break.trim_matches([' ', '\t']), "\n" | "\r\n" | "\r");
    if token == TokenKind::CloseBrace && ends_line {
        format_list(database, &entity, &tokens, last)
    } else {
        None
    }
}

/// The edit that indents the line of an offset.
fn indentation(database: &Database, position: FilePosition, offset: u32) -> Option<TextEdit> {
    let position = FilePosition { offset, ..position };
    let line = Line::at(database, position)?;
    let wanted = " ".repeat(line.depth(database, position)? * INDENT);
    (wanted != database.slice(position.file, line.blank))
        .then_some(TextEdit { span: line.blank, text: wanted })
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
        Some(Self { blank: (start..start + blank).into() })
    }

    /// The indentation level of the line; `None` if unknown.
    fn depth(&self, database: &Database, position: FilePosition) -> Option<usize> {
        let before = self.blank.start.checked_sub(1)?;
        let entity = database.entity_at(position.file, before)?;
        let tokens = || tokens(&entity);
        if tokens().any(|(_, span)| span.start < self.blank.start && self.blank.start < span.end) {
            // The layout of comments is left to the user.
            return None;
        }
        let is_sign = |(token, span): &Token| !token.is_comment() && span.end <= self.blank.start;
        let typed: Vec<Token> = tokens().filter(is_sign).collect();
        let open = typed.iter().fold(0_usize, |open, (token, _)| match token {
            TokenKind::OpenBrace => open + 1,
            TokenKind::CloseBrace => open.saturating_sub(1),
            _ => open,
        });
        let begins = |brace| tokens().any(|(token, span)| token == brace && span.start == self.blank.end);
        let closes = begins(TokenKind::CloseBrace);
        match open {
            0 if self.continues_entity(&entity, &typed) => None,
            0 => Some(0),
            // Each line of a block begins an action or continues one; a brace alone on its line opens the block of one.
            open if !closes && !begins(TokenKind::OpenBrace) && continues(database, &entity, &typed) => {
                Some(open + 1)
            }
            open => Some(open - usize::from(closes)),
        }
    }

    /// Returns whether the line continues an entity that is not complete before it: its clauses belong on one line.
    fn continues_entity(&self, entity: &EntityRef<'_>, typed: &[Token]) -> bool {
        let is_complete = entity.parse.entity.is_some()
            && entity.parse.errors.is_empty()
            && body(entity).end <= self.blank.start;
        let mut tokens = entity.parse.tokens.iter();
        let has_more = tokens.any(|(_, span)| span.start + entity.span.start == self.blank.end);
        !typed.is_empty() && has_more && !is_complete
    }
}

/// Returns whether the last action before a line is incomplete.
fn continues(database: &Database, entity: &EntityRef<'_>, typed: &[Token]) -> bool {
    let start = entity.span.start;
    let own: Vec<Token> =
        typed.iter().map(|(token, span)| (*token, Span::new(span.start - start, span.end - start))).collect();
    let Some(statements) = Statements::read(&own).filter(|statements| !statements.in_list()) else {
        return false;
    };
    let text = database.slice(entity.file, entity.span);
    !statements.latest().is_empty() && !expected_after(&text, &own).contains(&Expected::Action)
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
        line_break("\n   $0wheel a with radius 3", "\nwheel a with radius 3");
    }

    #[test]
    fn a_line_is_indented_whatever_the_lines_before_look_like() {
        let robot = "robot r with port 1 has {\n      a\n   b } wheels";
        line_break(&format!("{robot}\n   $0"), &format!("{robot}\n"));
        // Its `wheels` is still missing.
        line_break("robot r with port 1 has {\n  b }\n  $0", "robot r with port 1 has {\n  b }\n");
        let movement =
            |line: &str| format!("{robot}\n\n   movement m of r {{\n      slam\n{line}turn left }}");
        line_break(&movement("    $0"), &movement("  "));
        line_break("  robot r with port 1\n  $0", "  robot r with port 1\n");
    }

    #[test]
    fn a_list_is_formatted_every_time_even_before_its_movement_is_closed() {
        let begun = "movement m of r {\n  turn left until { s }\n  move 1 meters\n";
        for rest in ["", "\n}"] {
            brace(
                &format!("{begun}  turn left until {{s,t}}$0{rest}"),
                &format!("{begun}  turn left until {{ s, t }}{rest}"),
            );
            line_break(
                &format!("{begun}  turn left until {{s,t}}\n$0{rest}"),
                &format!("{begun}  turn left until {{ s, t }}\n  {rest}"),
            );
        }
        brace("robot r with port has {a,  b}$0", "robot r with port has { a b }");
        brace(
            "robot r with port has { } wheels with sensors {a b}$0",
            "robot r with port has { } wheels with sensors { a, b }",
        );
        brace("robot r with port has {/*a*/b}$0", "robot r with port has {/*a*/b}");
        brace("robot r with port has {}$0", "robot r with port has {}");
    }

    #[test]
    fn a_brace_that_was_typed_over_an_inserted_one_leaves_no_second() {
        brace(
            "movement m of r {\n  move 1  meters\n  slam }$0\n}\n\nsensor s",
            "movement m of r {\n  move 1 meters\n  slam\n}\n\nsensor s",
        );
        brace("movement m of r {\n  slam\n  }$0\n\n}", "movement m of r {\n  slam\n}");
        brace("robot r with port 1 has {a b}$0 } wheels", "robot r with port 1 has { a b } wheels");
        brace("robot r has {a b}$0}", "robot r has { a b }");
        brace(
            "movement m of r {\n  turn left until {s}$0 }\n}",
            "movement m of r {\n  turn left until { s }\n}",
        );
    }

    #[test]
    fn a_brace_that_closes_something_else_stays() {
        brace(
            "movement m of r {\n  turn left until { s }$0\n}",
            "movement m of r {\n  turn left until { s }\n}",
        );
        brace("movement m of r { slam }$0 // }\n}", "movement m of r { slam } // }\n}");
        brace("movement m of r { slam } }$0 }", "movement m of r { slam } } }");
    }

    #[test]
    fn other_lines_are_left_alone() {
        line_break("robot r with port 1\n   $0has", "robot r with port 1\n   has");
        line_break("movement m of r { /*\n   $0*/", "movement m of r { /*\n   */");
        line_break("   $0wheel", "   wheel");
    }

    /// Text in two blocks of a movement.
    fn nested(inside: &str) -> String {
        format!("movement m of r {{\n  repeat 2 times {{\n    if {{ s }} clear {{\n{inside}")
    }

    #[test]
    fn a_line_is_indented_by_the_blocks_around_it() {
        for (line, expected) in [
            ("$0", "      "),
            ("  $0slam", "      slam"),
            ("$0}", "    }"),
            ("      slam\n    }\n$0", "      slam\n    }\n    "),
            ("      slam\n    }\n  $0else {", "      slam\n    }\n    else {"),
            ("    } else {\n$0", "    } else {\n      "),
            ("    } else {\n    }\n  }\n$0", "    } else {\n    }\n  }\n  "),
            ("      wait 2\n$0", "      wait 2\n        "),
            ("      wait 2 seconds\n$0", "      wait 2 seconds\n      "),
            ("      move until { s }\n$0", "      move until { s }\n      "),
            ("      repeat 2 times\n$0", "      repeat 2 times\n        "),
            ("      repeat 2 times\n$0{", "      repeat 2 times\n      {"),
            ("      do\n$0", "      do\n        "),
            ("      do wait\n$0", "      do wait\n      "),
            ("      wait until {\n$0", "      wait until {\n        "),
            ("      wait until {s,t}\n$0", "      wait until { s, t }\n      "),
        ] {
            line_break(&nested(line), &nested(expected));
        }
    }

    #[test]
    fn a_brace_formats_the_statement_whose_block_it_closes() {
        let around = |inside: &str| format!("movement m of r {{\n  slam   slam\n{inside}\n  slam   slam\n}}");
        brace(
            &around("  repeat  2 times {slam   turn  left\n  }$0"),
            &around("  repeat 2 times {\n    slam\n    turn left\n  }"),
        );
        brace(
            &around("  repeat  2 times {\n    if {s,t}  clear {slam}$0 else  {\n}\n  }"),
            &around("  repeat  2 times {\n    if { s, t } clear {\n      slam\n    } else  {\n}\n  }"),
        );
        brace(
            &around("  repeat  2 times {\n  wait  until {s,t}$0 clear\n  }"),
            &around("  repeat  2 times {\n  wait until { s, t } clear\n  }"),
        );
        // Not a list.
        brace("movement m of {\n  repeat 2 times {do a}$0", "movement m of {\n  repeat 2 times {do a}");
    }

    #[test]
    fn a_brace_typed_over_an_inserted_one_leaves_one_in_blocks() {
        brace(
            "movement m of r {\n  repeat 2 times {\n    slam\n  }$0\n  }\n}",
            "movement m of r {\n  repeat 2 times {\n    slam\n  }\n}",
        );
        brace(
            "movement m of r {\n  if { s } clear {\n    slam\n  }$0 } else {\n    slam\n  }\n}",
            "movement m of r {\n  if { s } clear {\n    slam\n  } else {\n    slam\n  }\n}",
        );
        brace(
            "movement m of r {\n  repeat 2 times {\n    slam\n  }$0\n}",
            "movement m of r {\n  repeat 2 times {\n    slam\n  }\n}",
        );
    }
}
