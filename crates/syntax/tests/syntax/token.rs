//! The lists of words and signs.

use pydslrep_syntax::ast::Drive;
use pydslrep_syntax::{KEYWORDS, Span, TokenKind, lex};

#[test]
fn every_keyword_is_lexed_as_itself() {
    for (token, word) in KEYWORDS {
        assert_eq!(lex(word), [(token, Span::of(word))], "{word}");
        let contextual = TokenKind::CONTEXTUAL.contains(&token);
        assert_eq!(token.is_keyword(), !contextual, "{word}");
        assert_eq!(token.is_name(), contextual, "{word}");
    }
}

#[test]
fn every_type_of_robot_has_its_keyword() {
    assert_eq!(TokenKind::DRIVES.map(TokenKind::drive), Drive::ALL.map(Some));
    for (token, word) in KEYWORDS {
        assert_eq!(token.drive().is_some(), TokenKind::DRIVES.contains(&token), "{word}");
    }
}

#[test]
fn the_list_is_complete() {
    let first = TokenKind::Wheel as u8;
    let listed: Vec<u8> = KEYWORDS.iter().map(|(token, _)| *token as u8).collect();
    let all: Vec<u8> = (first..TokenKind::Invalid as u8).collect();
    assert_eq!(listed, all);
    assert!((TokenKind::Cursor as u8) < 128, "a token set is one word");
}
