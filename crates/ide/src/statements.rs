//! Which statements of a movement a position is in, by its tokens alone: they need not be complete.

use pydslrep_syntax::{EntityKind, Token, TokenKind};

/// The statements that the last of some tokens belongs to.
#[derive(Debug, Default)]
pub(crate) struct Statements {
    /// One per open block, the movement's own first: the latest statement in it, without what is in its blocks. Names are
    /// [`TokenKind::Name`], also those that are keywords elsewhere.
    blocks: Vec<Vec<Token>>,
    /// True if the last token is in a list of names.
    in_list: bool,
}

impl Statements {
    /// Reads the beginning of an entity; `None` before the body of a movement.
    pub(crate) fn read(tokens: &[Token]) -> Option<Self> {
        if tokens.first()?.0.entity_kind() != Some(EntityKind::Movement) {
            return None;
        }
        let body = tokens.iter().position(|(token, _)| *token == TokenKind::OpenBrace)?;
        let mut statements = Self { blocks: vec![Vec::new()], in_list: false };
        let rest = &tokens[body + 1..];
        for (index, token) in rest.iter().enumerate() {
            statements.push(*token, rest.get(index + 1).map(|(next, _)| *next));
        }
        (!statements.blocks.is_empty()).then_some(statements)
    }

    /// Returns whether the last token is in a list of names.
    pub(crate) fn in_list(&self) -> bool {
        self.in_list
    }

    /// The latest statement in the innermost block; empty where none has begun.
    pub(crate) fn latest(&self) -> &[Token] {
        self.blocks.last().map_or(&[], Vec::as_slice)
    }

    /// The latest statement of each open block, the innermost first: all but the first continue after it.
    pub(crate) fn inside_out(&self) -> impl Iterator<Item = &[Token]> {
        self.blocks.iter().rev().map(Vec::as_slice).filter(|statement| !statement.is_empty())
    }

    fn push(&mut self, token: Token, next: Option<TokenKind>) {
        let Some(statement) = self.blocks.last_mut() else { return };
        let last = statement.last().map(|(last, _)| *last);
        let kind = token.0;
        let is_action = kind.is_action();
        // The brace of a list may be missing.
        self.in_list &=
            !(is_action && (!kind.is_name() || next.is_some_and(|next| kind.only_before().has(next))));
        match kind {
            _ if self.in_list => {
                self.in_list = kind != TokenKind::CloseBrace;
                statement.push(if kind.is_name() { (TokenKind::Name, token.1) } else { token });
            }
            TokenKind::OpenBrace => {
                statement.push(token);
                self.in_list = matches!(last, Some(TokenKind::Until | TokenKind::If));
                if !self.in_list {
                    self.blocks.push(Vec::new());
                }
            }
            TokenKind::CloseBrace => {
                self.blocks.pop();
                if let Some(around) = self.blocks.last_mut() {
                    around.push(token);
                }
            }
            _ if last == Some(TokenKind::Do) && is_name_after_do(kind, next) => {
                statement.push((TokenKind::Name, token.1));
            }
            _ if is_action => *statement = vec![token],
            _ => statement.push(token),
        }
    }
}

fn is_name_after_do(kind: TokenKind, next: Option<TokenKind>) -> bool {
    kind.is_name() && !next.is_some_and(|next| kind.only_before().has(next))
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};
    use pydslrep_syntax::lex;

    use super::*;

    fn check(body: &str, expected: &Expect) {
        let text = format!("movement m of r {{ {body}");
        let read = Statements::read(&lex(&text));
        let shown = read.map(|statements| {
            let words = |statement: &[Token]| {
                let words = statement.iter().map(|(kind, span)| match kind {
                    TokenKind::Name => format!("<{}>", span.text(&text)),
                    _ => span.text(&text).to_owned(),
                });
                words.collect::<Vec<_>>().join(" ") + "\n"
            };
            let mut shown: String = statements.inside_out().map(words).collect();
            if statements.in_list() {
                shown += "in a list\n";
            }
            shown
        });
        expected.assert_eq(&shown.unwrap_or_else(|| "outside".to_owned()));
    }

    #[test]
    fn the_statement_and_those_around_it() {
        check("slam move 1", &expect![["move 1\n"]]);
        check("", &expect![[""]]);
        check("slam }", &expect![["outside"]]);
        check(
            "repeat 2 times { if { a } clear { slam wait 2",
            &expect![[r#"
                wait 2
                if { <a> } clear {
                repeat 2 times {
            "#]],
        );
        check("repeat 2 times { slam }", &expect![["repeat 2 times { }\n"]]);
        check("if { a } clear { slam } else", &expect![["if { <a> } clear { } else\n"]]);
        // An `else if` is a statement of its own.
        check("if { a } clear { slam } else if { b", &expect![["if { <b>\nin a list\n"]]);
    }

    #[test]
    fn keywords_are_names_where_a_name_can_be() {
        check(
            "turn left until { wait clear } clear",
            &expect![["turn left until { <wait> <clear> } clear\n"]],
        );
        check("do wait", &expect![["do <wait>\n"]]);
        check("do if wait", &expect![["wait\n"]]);
        check("do wait 2", &expect![["wait 2\n"]]);
        check("turn left until { front repeat 2 times {", &expect![["repeat 2 times {\n"]]);
        check("turn left until { front move 2", &expect![["move 2\n"]]);
    }
}
