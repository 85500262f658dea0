//! Cutting a file's tokens into entities, before any of them is parsed.
//!
//! Entities tile the file: each begins at its keyword and reaches to the next one's; what stands before the first is
//! a piece of its own. A mistake inside an entity, such as a brace that is never closed, therefore never reaches the
//! next one.
//!
//! Whether a token begins an entity depends on the entity it stands in, the token before it and the token behind it
//! and on nothing else. That bound is what incremental analysis relies on; widen it only together with
//! `pydslrep-analysis`'s rule for growing the window of an edit.

use crate::{EntityKind, Lexeme, Token};

/// The indices into `lexemes` at which entities (and imports) begin.
pub fn cut(lexemes: &[Lexeme]) -> Vec<usize> {
    let mut starts = Vec::new();
    let mut inside = None;
    let mut previous = None;
    for (index, &(token, _)) in lexemes.iter().enumerate() {
        if token.is_comment() {
            continue;
        }
        if could_begin(token) {
            let next = lexemes[index + 1..].iter().map(|(token, _)| *token).find(|token| !token.is_comment());
            if begins_entity(token, previous, next, inside) {
                starts.push(index);
                inside = token.entity_kind();
            }
        }
        previous = Some(token);
    }
    starts
}

fn could_begin(token: Token) -> bool {
    token == Token::Import || token.entity_kind().is_some()
}

fn begins_entity(
    token: Token,
    previous: Option<Token>,
    next: Option<Token>,
    inside: Option<EntityKind>,
) -> bool {
    match token {
        Token::Import => next.is_some_and(is_string) || previous.is_none_or(is_string),
        _ if is_taken_for_name(previous, next) => false,
        Token::Ip => previous != Some(Token::With),
        Token::Movement | Token::Parallel if previous == Some(Token::Parallel) => false,
        // `with { parallel m }`: it is said where the movement is declared.
        Token::Parallel if inside == Some(EntityKind::Environment) => !is_listed(previous, next),
        // `movement parallel m`; before `parallel movement` somebody is about to write another one.
        Token::Parallel if previous == Some(Token::Movement) => next == Some(Token::Movement),
        // `} wheel`, `with sensor {`, `} robot with` and `} movement` are slips for the plural, not entities.
        Token::Wheel if inside == Some(EntityKind::Robot) => !closes_list(previous, next),
        Token::Robot | Token::Movement if inside == Some(EntityKind::Environment) => {
            !closes_list(previous, next)
        }
        Token::Sensor if inside == Some(EntityKind::Robot) => previous != Some(Token::With),
        _ => true,
    }
}

/// `wheel robot with …`, `movement m of robot { … }`: a keyword where only a name can be meant. (`wheel` right before
/// `robot r` is a wheel that somebody is about to write.)
fn is_taken_for_name(previous: Option<Token>, next: Option<Token>) -> bool {
    let (Some(previous), Some(next)) = (previous, next) else { return false };
    match previous {
        Token::Of => next == Token::OpenBrace,
        Token::Parallel => false,
        _ => {
            previous.entity_kind().is_some()
                && matches!(next, Token::With | Token::Of | Token::Has | Token::Colon | Token::Ipv4)
        }
    }
}

fn is_listed(previous: Option<Token>, next: Option<Token>) -> bool {
    let in_list = |token: Token| matches!(token, Token::OpenBrace | Token::Comma) || token.is_name();
    previous.is_some_and(in_list) && next.is_some_and(Token::is_name)
}

fn is_string(token: Token) -> bool {
    matches!(token, Token::String | Token::UnterminatedString)
}

fn closes_list(previous: Option<Token>, next: Option<Token>) -> bool {
    previous == Some(Token::CloseBrace) && !next.is_some_and(Token::is_name)
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};

    use super::*;
    use crate::lex;

    fn check(text: &str, expected: &Expect) {
        let lexemes = lex(text);
        let mut ends: Vec<usize> = cut(&lexemes).into_iter().map(|i| lexemes[i].1.start as usize).collect();
        ends.push(text.len());
        let pieces: Vec<&str> = ends.windows(2).map(|pair| text[pair[0]..pair[1]].trim()).collect();
        expected.assert_eq(&pieces.join("\n"));
    }

    #[test]
    fn entities_begin_at_their_keywords() {
        check(
            "import \"a.pyr\" import \"b.pyr\" wheel a wheelH b // c\n ip i parallel movement m movement n robot r",
            &expect![[r#"
                import "a.pyr"
                import "b.pyr"
                wheel a
                wheelH b // c
                ip i
                parallel movement m
                movement n
                robot r"#]],
        );
    }

    #[test]
    fn references_and_names_do_not_cut() {
        check(
            "environment e with /* */ ip i has { r } robots wheel import with radius 3",
            &expect![[r"
                environment e with /* */ ip i has { r } robots
                wheel import with radius 3"]],
        );
    }

    #[test]
    fn an_entity_called_import_is_one() {
        check(
            "robot r with port 1 has { a b } wheels with sensors { s } wheel import with radius 3",
            &expect![[r"
                robot r with port 1 has { a b } wheels with sensors { s }
                wheel import with radius 3"]],
        );
    }

    #[test]
    fn a_singular_for_the_plural_does_not_cut() {
        check(
            "robot r has { a } wheel with sensor { s } movement m of r { } wheel environment e has { r } robot with { m } moves",
            &expect![[r"
                robot r has { a } wheel with sensor { s }
                movement m of r { }
                wheel
                environment e has { r } robot with { m } moves"]],
        );
    }

    #[test]
    fn a_keyword_for_a_name_does_not_cut() {
        check(
            "wheel robot with radius 3 movement parallel m of robot { } parallel parallel movement n of r { }
environment e has { r } robots with { parallel m } movement wheel robot r",
            &expect![[r"
                wheel robot with radius 3
                movement parallel m of robot { }
                parallel parallel movement n of r { }
                environment e has { r } robots with { parallel m } movement
                wheel
                robot r"]],
        );
    }
}
