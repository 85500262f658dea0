//! Semantic tokens: the kind of every token of a file, for highlighting.

use pydslrep_analysis::{EntityRef, Snapshot};
use pydslrep_syntax::ast::Entity;
use pydslrep_syntax::{EntityKind, Span, Token, TokenKind};

/// A highlighted token; never contains a line break.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SemanticToken {
    /// Its range.
    pub span: Span,
    /// Its kind.
    pub kind: HighlightKind,
    /// Its modifiers.
    pub modifiers: Vec<Modifier>,
}

/// The kind of a token.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum HighlightKind {
    /// A keyword.
    Keyword,
    /// A number or an address.
    Number,
    /// A path in quotes.
    String,
    /// A comment.
    Comment,
    /// The name of an entity.
    Name(EntityKind),
}

/// A modifier of a token.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Modifier {
    /// The name in a declaration.
    Declaration,
    /// The name of a wheel, sensor or ip, which never changes at run time.
    Readonly,
    /// A deprecated spelling.
    Deprecated,
}

/// The tokens of a file, or those that overlap a range, in text order.
pub fn semantic_tokens(snapshot: &Snapshot, range: Option<Span>) -> Vec<SemanticToken> {
    let mut tokens = Vec::new();
    for entity in snapshot.entities() {
        entity_tokens(snapshot, &entity, &mut tokens);
    }
    if let Some(range) = range {
        tokens.retain(|token| token.span.start < range.end && range.start < token.span.end);
    }
    tokens
}

/// Adds the tokens of one entity, which depend only on its own text.
pub fn entity_tokens(snapshot: &Snapshot, entity: &EntityRef<'_>, tokens: &mut Vec<SemanticToken>) {
    let names = Names::of(entity.parse.entity.as_ref());
    for token in &entity.parse.tokens {
        if let Some((kind, modifiers)) = names.classify(*token) {
            let span = token.1.shifted(entity.span.start);
            push_lines(snapshot, SemanticToken { span, kind, modifiers }, tokens);
        }
    }
}

/// Splits block comments at line breaks: editors require tokens within a line.
fn push_lines(snapshot: &Snapshot, token: SemanticToken, tokens: &mut Vec<SemanticToken>) {
    if token.kind != HighlightKind::Comment {
        tokens.push(token);
        return;
    }
    let mut start = token.span.start;
    for line in snapshot.slice(token.span).split(['\n', '\r']) {
        let end = start + Span::of(line).end;
        if end > start {
            tokens.push(SemanticToken { span: Span::new(start, end), ..token.clone() });
        }
        start = end + 1;
    }
}

/// The names of an entity in text order.
struct Names<'a> {
    tree: Option<&'a Entity>,
    all: Vec<(Span, EntityKind, bool)>,
    deprecated: Option<Span>,
}

impl<'a> Names<'a> {
    fn of(tree: Option<&'a Entity>) -> Self {
        let mut all = Vec::new();
        if let Some(tree) = tree {
            all.extend(tree.kind().zip(tree.name()).map(|(kind, name)| (name.span, kind, true)));
            all.extend(tree.references().into_iter().map(|(kind, name)| (name.span, kind, false)));
        }
        all.sort_unstable_by_key(|(span, ..)| span.start);
        let deprecated = match tree {
            Some(Entity::Robot(robot)) => {
                robot.drive.filter(|clause| clause.before_name).map(|clause| clause.span)
            }
            _ => None,
        };
        Self { tree, all, deprecated }
    }

    fn classify(&self, (token, span): Token) -> Option<(HighlightKind, Vec<Modifier>)> {
        if let Ok(index) = self.all.binary_search_by_key(&span.start, |(span, ..)| span.start) {
            let (_, kind, declares) = self.all[index];
            let readonly = matches!(kind, EntityKind::Wheel | EntityKind::Sensor | EntityKind::Ip);
            let modifiers = [(declares, Modifier::Declaration), (readonly, Modifier::Readonly)];
            let modifiers = modifiers.into_iter().filter(|(holds, _)| *holds).map(|(_, modifier)| modifier);
            return Some((HighlightKind::Name(kind), modifiers.collect()));
        }
        let kind = match token {
            TokenKind::String | TokenKind::UnterminatedString => HighlightKind::String,
            TokenKind::Import if matches!(self.tree, Some(Entity::Import(_))) => HighlightKind::Keyword,
            TokenKind::Distance | TokenKind::Bumper if matches!(self.tree, Some(Entity::Sensor(_))) => {
                HighlightKind::Keyword
            }
            token if is_of_statements(token) && matches!(self.tree, Some(Entity::Movement(_))) => {
                HighlightKind::Keyword
            }
            token if token.is_comment() => HighlightKind::Comment,
            token if token.is_number() => HighlightKind::Number,
            token if token.is_keyword() => HighlightKind::Keyword,
            _ => return None,
        };
        let old = self.deprecated.is_some_and(|old| old.start <= span.start && span.end <= old.end);
        Some((kind, if old { vec![Modifier::Deprecated] } else { Vec::new() }))
    }
}

/// Returns whether a token is a keyword in the actions of a movement, where it cannot be a name.
fn is_of_statements(token: TokenKind) -> bool {
    let elsewhere = [TokenKind::Import, TokenKind::Distance, TokenKind::Bumper];
    TokenKind::CONTEXTUAL.contains(&token) && !elsewhere.contains(&token)
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};

    use super::*;

    fn check(text: &str, range: Option<Span>, expected: &Expect) {
        let mut database = pydslrep_analysis::Database::new();
        let file = database.open("a.pyr", text);
        let rendered = semantic_tokens(&database.snapshot(file, range).unwrap(), range)
            .into_iter()
            .map(|token| format!("{:?} {:?} {:?}\n", token.span.text(text), token.kind, token.modifiers));
        expected.assert_eq(&rendered.collect::<String>());
    }

    #[test]
    fn every_token_has_its_kind() {
        check(
            "import \"a.pyr\" /* two\r\nlines */ wheel distance with radius 4.5\nsensor s : distance\nrobot type tw r with port 1 has { distance, } wheels with sensors { s }",
            None,
            &expect![[r#"
                "import" Keyword []
                "\"a.pyr\"" String []
                "/* two" Comment []
                "lines */" Comment []
                "wheel" Keyword []
                "distance" Name(Wheel) [Declaration, Readonly]
                "with" Keyword []
                "radius" Keyword []
                "4.5" Number []
                "sensor" Keyword []
                "s" Name(Sensor) [Declaration, Readonly]
                "distance" Keyword []
                "robot" Keyword []
                "type" Keyword [Deprecated]
                "tw" Keyword [Deprecated]
                "r" Name(Robot) [Declaration]
                "with" Keyword []
                "port" Keyword []
                "1" Number []
                "has" Keyword []
                "distance" Name(Wheel) [Readonly]
                "wheels" Keyword []
                "with" Keyword []
                "sensors" Keyword []
                "s" Name(Sensor) [Readonly]
            "#]],
        );
    }

    #[test]
    fn words_of_actions_are_keywords_where_they_are_no_names() {
        check(
            "sensor wait\nmovement if of do { do do wait 1 seconds until { wait } clear }",
            Some(Span::new(12, 80)),
            &expect![[r#"
                "movement" Keyword []
                "if" Name(Movement) [Declaration]
                "of" Keyword []
                "do" Name(Robot) []
                "do" Keyword []
                "do" Name(Movement) []
                "wait" Keyword []
                "1" Number []
                "seconds" Keyword []
                "until" Keyword []
                "wait" Name(Sensor) [Readonly]
                "clear" Keyword []
            "#]],
        );
    }

    #[test]
    fn a_range_has_only_its_own_tokens() {
        check(
            "wheel a with radius 4\nwheel b with radius 5\n",
            Some(Span::new(23, 29)),
            &expect![[r#"
            "wheel" Keyword []
            "b" Name(Wheel) [Declaration, Readonly]
        "#]],
        );
    }

    #[test]
    fn the_words_of_statements_are_keywords_where_they_are_no_names() {
        check(
            "movement do of wait { do do repeat 2 times { wait until { clear, times } clear } do if if { in",
            None,
            &expect![[r#"
                "movement" Keyword []
                "do" Name(Movement) [Declaration]
                "of" Keyword []
                "wait" Name(Robot) []
                "do" Keyword []
                "do" Name(Movement) []
                "repeat" Keyword []
                "2" Number []
                "times" Keyword []
                "wait" Keyword []
                "until" Keyword []
                "clear" Name(Sensor) [Readonly]
                "times" Name(Sensor) [Readonly]
                "clear" Keyword []
                "do" Keyword []
                "if" Name(Movement) []
                "if" Keyword []
                "in" Name(Sensor) [Readonly]
            "#]],
        );
    }
}
