//! From what the rules report to one error per mistake.
//!
//! A mistake makes several slots complain: the one it is in, and those after it that find the same token. Only
//! the first complaint is kept unless some token was understood in between.

use smol_str::SmolStr;

use super::expectation::Expectation;
use super::pairs;
use super::slot::Fault;
use crate::{EntityKind, Expected, Found, Span, SyntaxError, SyntaxErrorKind, Token, TokenKind};

/// The errors that `faults` amount to. `significant` is what the parser saw, `tokens` everything that is in the text.
pub(super) fn of_faults(
    text: &str,
    inside: Option<EntityKind>,
    significant: &[Token],
    tokens: &[Token],
    faults: &[Fault],
) -> Vec<SyntaxError> {
    let source = EntitySource { text, inside, significant, tokens, faults };
    let mut errors: Vec<SyntaxError> =
        tokens.iter().filter_map(|token| source.lexical_error(*token)).collect();
    if let Some(error) = source.broken_path() {
        errors.retain(|other| other.span.start >= error.span.end);
        errors.insert(0, error);
        return errors;
    }
    errors.retain(|error| !source.is_passed_over(error));
    errors.extend(faults.iter().filter_map(|fault| source.plain_error(fault)));
    errors.extend(source.expectation_errors());
    errors.sort_by_key(|error| (error.span.start, error.span.end));
    pairs::join(errors, significant)
}

/// The names among the tokens that the parser skipped.
pub(super) fn skipped_names(text: &str, significant: &[Token], faults: &[Fault]) -> Vec<SmolStr> {
    let skipped = |span: Span| {
        faults.iter().any(
            |fault| matches!(fault, Fault::Skipped(all) if all.start <= span.start && span.end <= all.end),
        )
    };
    if !faults.iter().any(|fault| matches!(fault, Fault::Skipped(_))) {
        return Vec::new();
    }
    let names = significant.iter().filter(|(token, span)| token.is_name() && skipped(*span));
    names.map(|(_, span)| span.text(text).trim_start_matches('^').into()).collect()
}

/// A string's text without its quotes.
pub(super) fn unquoted(span: Span, text: &str) -> SmolStr {
    span.text(text).trim_matches('"').into()
}

struct EntitySource<'a> {
    text: &'a str,
    inside: Option<EntityKind>,
    significant: &'a [Token],
    tokens: &'a [Token],
    faults: &'a [Fault],
}

/// Complaints about one place.
struct Complaint {
    /// Index into the significant tokens; their number for the end.
    index: usize,
    expected: Expectation,
}

impl EntitySource<'_> {
    fn written(&self, span: Span) -> SmolStr {
        span.text(self.text).into()
    }

    fn lexical_error(&self, (token, span): Token) -> Option<SyntaxError> {
        let (span, kind) = match token {
            TokenKind::Invalid => (span, SyntaxErrorKind::InvalidCharacter { written: self.written(span) }),
            TokenKind::UnterminatedComment => {
                (Span::new(span.start, span.start + 2), SyntaxErrorKind::UnterminatedComment)
            }
            TokenKind::UnterminatedString => (span, SyntaxErrorKind::UnterminatedString),
            TokenKind::MalformedName => {
                (self.foreign_part(span), SyntaxErrorKind::InvalidName { written: self.written(span) })
            }
            TokenKind::ForeignComment => {
                let marker =
                    span.text(self.text).find([' ', '\t']).filter(|_| !span.text(self.text).starts_with('#'));
                let marker = u32::try_from(marker.unwrap_or(1)).unwrap_or(1);
                let span = Span::new(span.start, span.start + marker);
                (span, SyntaxErrorKind::ForeignComment { written: self.written(span) })
            }
            _ => return None,
        };
        Some(SyntaxError { span, kind })
    }

    /// The characters of a name that names cannot have, from the first to the last of them.
    fn foreign_part(&self, span: Span) -> Span {
        let written = span.text(self.text);
        let foreign = |c: char| !c.is_ascii_alphanumeric() && c != '_';
        let skipped = usize::from(written.starts_with('^'));
        let start = written[skipped..].find(foreign).unwrap_or_default() + skipped;
        let end = written
            .rfind(foreign)
            .map_or(written.len(), |last| last + written[last..].chars().next().map_or(0, char::len_utf8));
        Span::from(start..end).shifted(span.start)
    }

    /// Returns whether characters are inside text that was passed over: that is reported where it begins.
    fn is_passed_over(&self, error: &SyntaxError) -> bool {
        let minor = matches!(
            error.kind,
            SyntaxErrorKind::InvalidCharacter { .. } | SyntaxErrorKind::InvalidName { .. }
        );
        let inside = |fault: &Fault| match fault {
            Fault::Skipped(span) => {
                let next = self.significant.iter().find(|(_, token)| token.start >= span.end);
                let end = next.map_or(u32::MAX, |(_, token)| token.start);
                span.start < error.span.start && error.span.end <= end
            }
            _ => false,
        };
        minor && self.faults.iter().any(inside)
    }

    /// An import whose path is not in quotes: all that is on its line is one mistake.
    fn broken_path(&self) -> Option<SyntaxError> {
        let (&(first, import), rest) = self.tokens.split_first()?;
        let next = rest.iter().find(|(token, _)| !token.is_comment())?;
        if first != TokenKind::Import || matches!(next.0, TokenKind::String | TokenKind::UnterminatedString) {
            return None;
        }
        let same_line =
            |(_, span): &&Token| !Span::new(import.end, span.start).text(self.text).contains(['\n', '\r']);
        let path = rest.iter().take_while(same_line).filter(|(token, _)| !token.is_comment());
        let span = path.map(|(_, span)| *span).reduce(Span::to)?;
        let found = Found::Text(self.written(span));
        let kind = SyntaxErrorKind::Unexpected { expected: vec![Expected::Path], found, inside: None };
        Some(SyntaxError { span, kind })
    }

    /// Faults that are an error by themselves.
    fn plain_error(&self, fault: &Fault) -> Option<SyntaxError> {
        let (span, kind) = match *fault {
            Fault::TakenForKeyword(span, keyword) => {
                (span, SyntaxErrorKind::Misspelt { written: self.written(span), keyword })
            }
            Fault::TakenForName(span, of) => {
                (span, SyntaxErrorKind::KeywordAsName { written: self.written(span), of })
            }
            Fault::MalformedNumber(span) => {
                (span, SyntaxErrorKind::MalformedNumber { written: self.written(span) })
            }
            Fault::PortNotWhole(span) => {
                (span, SyntaxErrorKind::PortNotWhole { written: self.written(span) })
            }
            Fault::EmptyList(span, of) => (span, SyntaxErrorKind::EmptyList { of }),
            Fault::Expected { .. } | Fault::Skipped(_) => return None,
        };
        Some(SyntaxError { span, kind })
    }

    fn expectation_errors(&self) -> Vec<SyntaxError> {
        let mut errors = Vec::new();
        let mut resumed = None;
        for complaint in self.complaints() {
            let repeated = resumed.is_some_and(|resumed| complaint.index <= resumed);
            let skipped_to = self.skipped_from(complaint.index);
            let understood = complaint.index;
            resumed = Some(resumed.unwrap_or(0).max(skipped_to.unwrap_or(understood)));
            if !repeated && !self.is_consequence(complaint.index) {
                errors.push(self.expectation_error(&complaint, skipped_to.is_some()));
            }
        }
        errors
    }

    fn complaints(&self) -> Vec<Complaint> {
        let mut complaints: Vec<Complaint> = self
            .faults
            .iter()
            .filter_map(|fault| match fault {
                // A rule that only looked ahead expects nothing.
                Fault::Expected { at, expected } if !expected.is_empty() => {
                    let index = self.significant.partition_point(|(_, span)| span.start < at.start);
                    Some(Complaint { index, expected: *expected })
                }
                _ => None,
            })
            .collect();
        complaints.sort_by_key(|complaint| complaint.index);
        complaints
    }

    /// Where reading went on if the token at `index` was passed over.
    fn skipped_from(&self, index: usize) -> Option<usize> {
        let start = self.significant.get(index)?.1.start;
        self.faults.iter().find_map(|fault| match fault {
            Fault::Skipped(span) if span.start <= start && start < span.end => {
                Some(self.significant.partition_point(|(_, token)| token.start < span.end))
            }
            _ => None,
        })
    }

    /// Returns whether the mistake at `index` has been reported otherwise: the token was taken for something, or
    /// something that is no token is right before it.
    fn is_consequence(&self, index: usize) -> bool {
        let here = self.significant.get(index).map(|(_, span)| *span);
        let taken = self.faults.iter().any(|fault| {
            matches!(fault, Fault::TakenForKeyword(span, _) | Fault::TakenForName(span, _) if Some(*span) == here)
        });
        let before = index.checked_sub(1).map_or(0, |previous| self.significant[previous].1.end);
        let until = here.map_or(Span::of(self.text).end, |span| span.start);
        let lexical = |token: TokenKind| {
            matches!(
                token,
                TokenKind::Invalid | TokenKind::UnterminatedComment | TokenKind::UnterminatedString
            )
        };
        let no_token = |(token, span): &Token| lexical(*token) && before <= span.start && span.start <= until;
        let after_string = index > 0 && self.significant[index - 1].0 == TokenKind::UnterminatedString;
        taken || after_string || self.tokens.iter().any(no_token)
    }

    fn expectation_error(&self, complaint: &Complaint, skipped: bool) -> SyntaxError {
        let expected = complaint.expected.to_vec();
        let Some(&(token, span)) = self.significant.get(complaint.index) else {
            return self.missing(complaint.index, expected, Found::End);
        };
        let written = self.written(span);
        if !skipped {
            return self.missing(complaint.index, expected, Found::Text(written));
        }
        // `with sensors` after a robot is no other declaration.
        let clause = token == TokenKind::Sensors && self.inside == Some(EntityKind::Robot);
        if let Some(keyword) = misspelt_keyword(token, &written, &expected).filter(|_| !clause) {
            return SyntaxError { span, kind: SyntaxErrorKind::Misspelt { written, keyword } };
        }
        let kind = SyntaxErrorKind::Unexpected { expected, found: Found::Text(written), inside: self.inside };
        SyntaxError { span, kind }
    }

    fn missing(&self, index: usize, expected: Vec<Expected>, found: Found) -> SyntaxError {
        let end = index.checked_sub(1).map_or(0, |previous| self.significant[previous].1.end);
        let kind = SyntaxErrorKind::Missing { expected, found, inside: self.inside };
        SyntaxError { span: Span::at(end), kind }
    }
}

/// Returns the expected keyword that `written` is a misspelling of.
fn misspelt_keyword(token: TokenKind, written: &str, expected: &[Expected]) -> Option<TokenKind> {
    if !token.is_name() && !token.is_keyword() {
        return None;
    }
    let words = expected.iter().flat_map(|expected| match expected {
        Expected::Word(word) => vec![*word],
        Expected::Action => TokenKind::ACTIONS.to_vec(),
        Expected::Declaration => TokenKind::DECLARATIONS.to_vec(),
        _ => Vec::new(),
    });
    TokenKind::closest(written, words)
}
