//! Problems that the next word of the statement being typed will settle: editors do not show them until its line is
//! left.

use std::cell::OnceCell;

use pydslrep_analysis::{Database, Diagnostic, EntityRef};
use pydslrep_syntax::ast::{Entity, References};
use pydslrep_syntax::{Expected, Span, Token, TokenKind, expected_after, offset};

use crate::FilePosition;
use crate::cursor::{body, is_word, tokens};

/// The statement being typed.
#[derive(Debug)]
pub struct TypedStatement<'a> {
    database: &'a Database,
    position: FilePosition,
    entity: EntityRef<'a>,
    /// The tokens of the entity, with their ranges in the file.
    tokens: Vec<Token>,
    /// From the end of the last complete word on the line to the cursor.
    gap: Span,
    /// True if a list opens before the cursor and does not close on the same line.
    is_list_open: bool,
    /// True if the last character may begin a comment or an escaped name.
    is_sign_begun: bool,
    /// The text after the cursor that is parsed as part of the statement, because that is not complete. Only some
    /// problems ask for it, and it costs as much as reading the entity again.
    taken: OnceCell<Option<Span>>,
    /// The same without the word at the cursor, which may not be the intended one.
    taken_without_word: OnceCell<Option<Span>>,
}

impl<'a> TypedStatement<'a> {
    /// The statement that the last typed character belongs to; `None` at the start of a file.
    pub fn at(database: &'a Database, position: FilePosition) -> Option<Self> {
        let place = position.offset;
        let entity = database.entity_at(position.file, place.checked_sub(1)?)?;
        let tokens: Vec<Token> = tokens(&entity).collect();
        let text = database.text(position.file)?;
        let line = text.byte_to_line((place as usize).min(text.len_bytes()));
        let begin = offset(text.line_to_byte(line));
        let end = offset(text.try_line_to_byte(line + 1).ok()?);
        let is_complete = |(token, span): &&Token| span.end < place || span.end == place && !is_word(*token);
        let before = tokens.iter().rfind(is_complete).map(|(_, span)| span.end);
        let gap = Span::new(before.unwrap_or(begin).max(begin), place);
        let braces = |token: TokenKind, part: Span| {
            let within =
                |(other, span): &&Token| *other == token && part.start <= span.start && span.end <= part.end;
            tokens.iter().filter(within).count()
        };
        let opened = braces(TokenKind::OpenBrace, Span::new(begin, place));
        let is_list_open = opened > braces(TokenKind::CloseBrace, Span::new(begin, end));
        let is_sign_begun =
            matches!(database.slice(position.file, Span::new(place - 1, place)).as_str(), "/" | "^");
        Some(Self {
            database,
            position,
            entity,
            tokens,
            gap,
            is_list_open,
            is_sign_begun,
            taken: OnceCell::new(),
            taken_without_word: OnceCell::new(),
        })
    }

    /// The offset of the cursor.
    pub fn offset(&self) -> u32 {
        self.position.offset
    }

    /// Returns whether the next word of the statement will settle a problem.
    pub fn settles(&self, problem: &Diagnostic) -> bool {
        if problem.file != self.position.file {
            return false;
        }
        self.is_typed(problem.span)
            || match problem.code() {
                "syntax-error" => self.is_caused(problem.span),
                "unresolved-reference" => self.takes(problem.span),
                // It comes after the sensors.
                "missing-condition-word" => self.gap.start == problem.span.end || self.takes(problem.span),
                "invalid-character" => self.is_sign_begun && problem.span.end == self.position.offset,
                "unterminated-comment" | "unterminated-string" => self.is_unterminated(problem.span),
                "idle-robot" => self.may_list_movements(problem.span),
                "single-parallel" => self.lists_movements(),
                _ => false,
            }
    }

    /// The environment being typed, as long as it lists no robots.
    pub fn begun_environment(&self) -> Option<&str> {
        match &self.entity.parse.entity {
            Some(Entity::Environment(environment)) if !self.has_list() => {
                environment.name.as_ref().map(|name| name.text.as_str())
            }
            _ => None,
        }
    }

    fn has_list(&self) -> bool {
        self.tokens.iter().any(|(token, _)| *token == TokenKind::OpenBrace)
    }

    /// Returns whether the cursor is inside a range, or at the end of a word.
    fn is_typed(&self, span: Span) -> bool {
        let place = self.position.offset;
        let ends_word = || self.tokens.iter().any(|(token, word)| word.end == place && is_word(*token));
        span.start < place && (place < span.end || place == span.end && ends_word())
    }

    /// Returns whether a syntax error is there because the statement is not complete: something is missing at the
    /// cursor, or the text after it is parsed as part of the statement.
    fn is_caused(&self, error: Span) -> bool {
        let is_missing = error.is_empty() && self.gap.touches(error.start);
        let is_in_list =
            self.is_list_open && self.position.offset <= error.start && error.end <= self.entity.span.end;
        is_missing || self.takes(error) || is_in_list || self.is_begun(error) || self.lacks_taken_brace(error)
    }

    /// Returns whether an error is a missing brace that the statement has taken for its own block or list.
    fn lacks_taken_brace(&self, error: Span) -> bool {
        let is_brace = |taken: Span| self.tokens.contains(&(TokenKind::CloseBrace, taken));
        let end = body(&self.entity).end;
        error == Span::at(end) && self.taken().or_else(|| self.taken_without_word()).is_some_and(is_brace)
    }

    fn takes(&self, span: Span) -> bool {
        self.taken().is_some_and(|taken| taken.start <= span.start && span.end <= taken.end)
    }

    fn taken(&self) -> Option<Span> {
        let place = self.position.offset;
        *self.taken.get_or_init(|| taken_by_statement(self.database, &self.entity, place, false))
    }

    fn taken_without_word(&self) -> Option<Span> {
        let place = self.position.offset;
        *self.taken_without_word.get_or_init(|| taken_by_statement(self.database, &self.entity, place, true))
    }

    /// Returns whether an error is at a keyword that begins a declaration, and the cursor at its next word.
    fn is_begun(&self, error: Span) -> bool {
        let begins = |(token, span): &Token| {
            let is_declaration = TokenKind::DECLARATIONS.contains(token);
            is_declaration && *span == error && self.gap.start == span.end
        };
        self.tokens.iter().any(begins)
    }

    fn is_unterminated(&self, span: Span) -> bool {
        let last = self.tokens.last();
        let unterminated = last.filter(|(token, _)| {
            matches!(token, TokenKind::UnterminatedComment | TokenKind::UnterminatedString)
        });
        unterminated
            .is_some_and(|(_, token)| token.touches(span.start) && token.touches(self.position.offset))
    }

    /// Returns whether the movements of the environment that lists a robot can still follow.
    fn may_list_movements(&self, robot: Span) -> bool {
        let place = self.position.offset;
        let is_own = self.entity.span.start <= robot.start && robot.end <= self.entity.span.end;
        let last = self.tokens.iter().rfind(|(token, span)| !token.is_comment() && span.end <= place);
        let has_names_after = self.tokens.iter().any(|(token, span)| token.is_name() && span.start >= place);
        is_own
            && robot.end <= place
            && !has_names_after
            && last.is_some_and(|(token, _)| *token != TokenKind::Moves)
    }

    /// Returns whether the cursor is in the list of an environment's movements.
    fn lists_movements(&self) -> bool {
        let Some(Entity::Environment(environment)) = &self.entity.parse.entity else { return false };
        let contains = |list: &References| {
            let list = list.span.shifted(self.entity.span.start);
            list.start < self.position.offset && self.position.offset < list.end
        };
        environment.movements.as_ref().is_some_and(contains)
    }
}

/// Returns the text after the cursor that is parsed as part of the statement being typed; `None` if the statement may
/// be complete. In a movement that is one token, for actions begin anew.
fn taken_by_statement(
    database: &Database,
    entity: &EntityRef<'_>,
    place: u32,
    without_word: bool,
) -> Option<Span> {
    let start = entity.span.start;
    let is_left_out = |(token, span): &Token| without_word && span.end + start == place && is_word(*token);
    let significant = entity.parse.tokens.iter().filter(|(token, _)| !token.is_comment());
    let significant = significant.filter(|token| !is_left_out(token));
    let (before, after): (Vec<Token>, Vec<Token>) =
        significant.partition(|(_, span)| span.end + start <= place);
    let next = after.first()?.1.shifted(start);
    let expected = expected_after(&database.slice(entity.file, entity.span), &before);
    let may_end =
        expected.iter().any(|expected| matches!(expected, Expected::Action | Expected::Declaration));
    let is_action = matches!(entity.parse.entity, Some(Entity::Movement(_)));
    let end = if is_action { next.end } else { entity.span.end };
    (!may_end).then(|| Span::new(next.start, end))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{PARTS, at_cursor};

    /// The codes of the problems that are shown while the text is typed up to the cursor, and of those that are not.
    fn codes(fixture: &str) -> (Vec<&'static str>, Vec<&'static str>) {
        let (database, position) = at_cursor(&format!("{PARTS}{fixture}"));
        let statement = TypedStatement::at(&database, position).unwrap();
        let (held, shown): (Vec<_>, Vec<_>) =
            database.diagnostics(position.file).into_iter().partition(|found| statement.settles(found));
        let codes = |found: Vec<Diagnostic>| {
            let codes = found.iter().map(Diagnostic::code);
            // The parts of the fixture are not all used.
            codes.filter(|code| !matches!(*code, "unused-declaration" | "no-environment")).collect()
        };
        (codes(shown), codes(held))
    }

    fn held(fixture: &str, code: &str) {
        let (shown, held) = codes(fixture);
        assert!(shown.is_empty() && held.contains(&code), "{fixture}: shown {shown:?}, held {held:?}");
    }

    fn shown(fixture: &str, code: &str) {
        let (shown, held) = codes(fixture);
        assert!(shown.contains(&code), "{fixture}: shown {shown:?}, held {held:?}");
    }

    /// Fails if any problem is shown after one of the keys.
    fn quiet(before: &str, typed: &str, after: &str) {
        for (at, character) in typed.char_indices() {
            let begun = &typed[..at + character.len_utf8()];
            let (shown, held) = codes(&format!("{before}{begun}$0{after}"));
            assert!(shown.is_empty(), "{before}{begun}: shown {shown:?}, held {held:?}");
        }
    }

    #[test]
    fn a_movement_is_not_empty_while_its_first_action_is_typed() {
        held("movement m of rover {$0}", "empty-movement");
        held("movement m of rover {\n  $0\n}", "empty-movement");
        shown("movement m of rover { }$0", "empty-movement");
        shown("movement n of rover { }\nmovement m of rover {\n  $0\n}", "empty-movement");
    }

    #[test]
    fn what_is_missing_at_the_cursor_is_not_shown() {
        for action in [
            "m$0",
            "mo$0",
            "move$0",
            "move $0",
            "move 2$0",
            "move 2 $0",
            "move 2 me$0",
            "turn lef$0",
            "turn left until $0",
        ] {
            held(&format!("movement m of rover {{\n  {action}\n  turn left\n}}"), "syntax-error");
        }
        held("movement m of rover {\n  turn left until { $0 }\n}", "syntax-error");
        held("movement m of rov$0 {\n  turn left\n}", "unresolved-reference");
        held("wheel a with radius 0$0", "invalid-radius");
        held("robot r type fw with port 1 has { wheelL $0 } wheels", "wheel-count");
    }

    #[test]
    fn what_the_next_word_does_not_settle_is_shown() {
        shown("movement m of rover {\n  move 1 parsecs $0\n}", "syntax-error");
        shown("movement m of rovr $0{\n  turn left\n}", "unresolved-reference");
        shown("wheel a radius 4.5$0", "syntax-error");
        shown("wheel a with radius 0 $0", "invalid-radius");
        shown("movement m of rover {\n  move 2\n  turn left$0\n}", "syntax-error");
        shown("robot r type fw with port 1 has { wheelL }$0 wheels", "wheel-count");
    }

    #[test]
    fn nothing_is_shown_while_programs_are_typed() {
        quiet("", "wheel a with radius 4.5", "\nsensor s");
        quiet("", "sensor s : bumper", "");
        quiet("", "ip lab 127.0.0.1", "\nsensor s");
        quiet(
            "",
            "robot r type tw with port 23000 has { wheelL wheelR } wheels with sensors { front }",
            "\nsensor s",
        );
        quiet("movement m of rover {\n  ", "move 2.5 meters at 9", "\n}");
        quiet("movement m of rover {\n  ", "turn left until { front }", "\n  turn left\n}");
        quiet("", "movement m of rover { turn left }", "\nsensor s");
        for action in [
            "move 2 meters at 9 until { front } detect within 40 centimeters",
            "move until { front } clear",
            "turn left 90 with radius 1.5 meters at 5 in reverse",
            "wait 2 seconds until { front } clear",
            "wait until { front } clear within 1 meters",
            "repeat 4 times { slam }",
            "repeat until { front } detect { wait 1 seconds }",
            "if { front } detect { slam } else if { front } clear { turn left } else { wait 1 seconds }",
            "do n",
        ] {
            let robot = "sensor a sensor b sensor c sensor d\n\
                         robot q type tw with port 1 has { wheelL wheelR } wheels with sensors { front a b c d }\n\
                         movement n of q { slam }\n";
            quiet(&format!("{robot}movement m of q {{\n  "), action, "\n}");
            quiet(&format!("{robot}movement m of q {{\n  repeat 2 times {{\n    "), action, "\n  }\n}");
        }
        quiet(
            "parallel movement m of rover { turn left }\nparallel movement n of rover { turn left }\n",
            "environment e has { rover } robots with { m",
            "",
        );
        quiet(
            "movement m of rover { turn left }\n",
            "environment e has { rover } robots with { m } moves",
            "",
        );
        quiet("", "// a comment", "");
        quiet("", "/* a comment */", "");
    }
}
