//! Statements as words, and how the words of a correct one differ from them.

use pydslrep_syntax::{EntityKind, KEYWORDS, Span, SyntaxErrorKind, Token, TokenKind, lex, parse};
use pydslrep_text::is_similar;
use smol_str::SmolStr;

use crate::diagnostics::context::Context;
use crate::diagnostics::rewritten::Rewrite;
use crate::diagnostics::syntax_error::words;

/// Longer statements are not rewritten.
const MAX_TOKENS: usize = 64;

/// A token with its text; a number with a comma is one, and so is what is in quotes.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Word {
    pub(super) token: TokenKind,
    pub(super) span: Span,
    pub(super) text: SmolStr,
}

impl Word {
    pub(super) fn is_number(&self) -> bool {
        matches!(self.token, TokenKind::Integer | TokenKind::Float)
    }

    /// Signs that other languages put between or around values.
    pub(super) fn is_noise(&self) -> bool {
        match self.token {
            TokenKind::Colon | TokenKind::Comma => true,
            TokenKind::Invalid => self.text.chars().all(|c| "()[]=;.".contains(c)),
            _ => false,
        }
    }
}

/// The words among some tokens; `None` where a comment is among them, which would be lost.
pub(super) fn words_of(context: &Context<'_>, tokens: &[Token]) -> Option<Vec<Word>> {
    let is_word = |(token, _): &Token| !token.is_comment();
    let last = tokens.iter().rposition(is_word)?;
    let first = tokens.iter().position(is_word)?;
    let tokens = &tokens[first..=last];
    if tokens.len() > MAX_TOKENS || !tokens.iter().all(is_word) {
        return None;
    }
    let mut words: Vec<Word> = Vec::new();
    for &(token, span) in tokens {
        let text = SmolStr::new(context.text(span));
        match (token, &mut words[..]) {
            (TokenKind::Integer, [.., whole, comma])
                if whole.token == TokenKind::Integer
                    && comma.token == TokenKind::Comma
                    && whole.span.end == comma.span.start
                    && comma.span.end == span.start =>
            {
                whole.token = TokenKind::Float;
                whole.span = whole.span.to(span);
                whole.text = smol_str::format_smolstr!("{}.{text}", whole.text);
                words.pop();
            }
            (TokenKind::String, _) => {
                let text = SmolStr::new(text.trim_matches('"'));
                let token = lex(&text).first().map_or(TokenKind::String, |(token, _)| *token);
                words.push(Word { token, span, text });
            }
            _ => words.push(Word { token, span, text }),
        }
    }
    Some(words)
}

/// The statement `text` in place of these words.
pub(super) fn rewrite(words: &[Word], text: String, help: String, is_fallback: bool) -> Option<Rewrite> {
    let span = words.first()?.span.to(words.last()?.span);
    let difference = Difference::between(words, &text);
    if is_fallback && difference.only_removes_keywords() {
        // Somebody is about to write what follows them.
        return None;
    }
    let message = difference.message();
    let title = format!("write `{text}`");
    Some(Rewrite { span, text, message, title, help, is_fallback })
}

/// The differences between some words and a correct statement.
pub(super) struct Difference {
    /// Runs of words that are missing.
    pub(super) missing: Vec<String>,
    /// Words that do not belong there, each once.
    pub(super) extra: Vec<String>,
    /// Words that are nearly the right ones, with those.
    respelt: Vec<(String, String)>,
}

impl Difference {
    pub(super) fn between(words: &[Word], text: &str) -> Self {
        let mut left: Vec<&Word> = words.iter().collect();
        let mut runs: Vec<Vec<&str>> = vec![Vec::new()];
        for (_, span) in lex(text) {
            let word = span.text(text);
            if let Some(index) = left.iter().position(|other| other.text == word) {
                left.remove(index);
                runs.push(Vec::new());
            } else if let Some(run) = runs.last_mut() {
                run.push(word);
            }
        }
        runs.retain(|run| !run.is_empty());
        let mut respelt = Vec::new();
        left.retain(|word| {
            let is_expected = |keyword: &&str| is_similar(&word.text, keyword);
            let run = runs.iter_mut().find(|run| run.iter().any(&is_expected));
            let expected = run.and_then(|run| Some(run.remove(run.iter().position(is_expected)?)));
            respelt.extend(expected.map(|expected| (word.text.to_string(), expected.to_owned())));
            expected.is_none()
        });
        runs.retain(|run| !run.is_empty());
        // Commas between names may stay.
        let listed = text.contains('{');
        let mut extra: Vec<String> = Vec::new();
        for word in left.into_iter().filter(|word| !(listed && word.token == TokenKind::Comma)) {
            if !extra.iter().any(|other| *other == word.text) {
                extra.push(word.text.to_string());
            }
        }
        Self { missing: runs.iter().map(|run| run.join(" ")).collect(), extra, respelt }
    }

    fn only_removes_keywords(&self) -> bool {
        let is_keyword = |word: &String| KEYWORDS.iter().any(|(_, keyword)| keyword == word);
        self.missing.is_empty() && self.respelt.is_empty() && self.extra.iter().any(is_keyword)
    }

    /// Returns the message.
    fn message(&self) -> String {
        let (written, expected): (Vec<_>, Vec<_>) = self.respelt.iter().cloned().unzip();
        let clause = |words: &[String], one: &str, many: &str| match words.len() {
            0 => None,
            1 => Some(format!("{} {one}", quoted(words))),
            _ => Some(format!("{} {many}", quoted(words))),
        };
        let is =
            clause(&written, "is", "are").map(|written| format!("{written} written {}", quoted(&expected)));
        let missing = clause(&self.missing, "is missing", "are missing");
        let extra = clause(&self.extra, "does not belong here", "do not belong here");
        let clauses: Vec<String> = [is, missing, extra].into_iter().flatten().collect();
        match &clauses[..] {
            [] => "the words belong in another order".to_owned(),
            [_] if !self.missing.is_empty() => format!("missing {}", quoted(&self.missing)),
            [only] => only.clone(),
            [others @ .., last] => format!("{}, and {last}", others.join(", ")),
        }
    }
}

/// `a`, `b` and `c`
pub(super) fn quoted(words: &[String]) -> String {
    let quoted: Vec<String> = words.iter().map(|word| format!("`{word}`")).collect();
    match quoted.split_last() {
        Some((last, others)) if !others.is_empty() => format!("{} and {last}", others.join(", ")),
        _ => quoted.concat(),
    }
}

/// Returns whether each text is one entity without a mistake, invalid names aside.
pub(super) fn are_sound(texts: &[&str]) -> bool {
    let pieces = parse(&texts.join("\n"));
    let is_name = |kind: &SyntaxErrorKind| matches!(kind, SyntaxErrorKind::InvalidName { .. });
    pieces.len() == texts.len()
        && pieces.iter().all(|(_, parse)| parse.errors.iter().all(|error| is_name(&error.kind)))
}

pub(super) fn shape(context: &Context<'_>, kind: EntityKind) -> String {
    words::shape(context, Some(kind), &[]).unwrap_or_default()
}
