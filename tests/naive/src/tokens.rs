//! "Lexical structure" of the specification.

use std::ops::Range;

use crate::{Finding, robot_types};

/// The keywords, which need `^` to be names; so do the types of robots.
const KEYWORDS: [&str; 27] = [
    "wheel",
    "wheelH",
    "with",
    "radius",
    "sensor",
    "ip",
    "robot",
    "type",
    "port",
    "has",
    "wheels",
    "sensors",
    "parallel",
    "movement",
    "of",
    "move",
    "meters",
    "centimeters",
    "at",
    "turn",
    "left",
    "right",
    "until",
    "slam",
    "environment",
    "robots",
    "moves",
];

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Keyword,
    Name,
    Number,
    Malformed,
    Ipv4,
    Text,
    Sign,
}

#[derive(Debug, Clone)]
pub(crate) struct Token {
    pub(crate) kind: Kind,
    /// As written; a name without its `^`.
    pub(crate) text: String,
    /// As written; a name with its `^`.
    pub(crate) range: Range<usize>,
}

/// All tokens, and the lexical errors.
pub(crate) fn read(text: &str) -> (Vec<Token>, Vec<Finding>) {
    let mut reader = Reader { text, at: 0, tokens: Vec::new(), findings: Vec::new() };
    reader.skip("\u{feff}");
    while reader.at < text.len() {
        reader.read_one();
    }
    (reader.tokens, reader.findings)
}

struct Reader<'a> {
    text: &'a str,
    at: usize,
    tokens: Vec<Token>,
    findings: Vec<Finding>,
}

impl Reader<'_> {
    fn rest(&self) -> &str {
        &self.text[self.at..]
    }

    fn skip(&mut self, what: &str) -> bool {
        let found = self.rest().starts_with(what);
        if found {
            self.at += what.len();
        }
        found
    }

    /// The number of following bytes whose characters satisfy a predicate.
    fn length_while(&self, belongs: impl Fn(char) -> bool) -> usize {
        self.rest().find(|character| !belongs(character)).unwrap_or(self.rest().len())
    }

    fn read_one(&mut self) {
        let start = self.at;
        let blank = self.length_while(|character| " \t\r\n\u{c}".contains(character));
        if blank > 0 {
            self.at += blank;
        } else if self.skip("//") {
            self.at += self.length_while(|character| character != '\n' && character != '\r');
        } else if self.skip("/*") {
            self.skip_block_comment(start);
        } else if self.skip("\"") {
            self.read_string(start);
        } else if let Some(length) = name_length(self.rest()) {
            self.read_name(length);
        } else if let Some(length) = number_length(self.rest()) {
            let kind = kind_of_number(&self.rest()[..length]);
            self.push(kind, length);
        } else if self.rest().starts_with(['{', '}', ':', ',']) {
            self.push(Kind::Sign, 1);
        } else {
            self.read_invalid();
        }
    }

    fn push(&mut self, kind: Kind, length: usize) {
        let range = self.at..self.at + length;
        self.tokens.push(Token { kind, text: self.text[range.clone()].to_owned(), range });
        self.at += length;
    }

    /// Block comments do not nest; an unclosed one is one error, at its start.
    fn skip_block_comment(&mut self, start: usize) {
        if let Some(length) = self.rest().find("*/") {
            self.at += length + 2;
        } else {
            self.findings.push(Finding::new("unterminated-comment", &(start..start + 2)));
            self.at = self.text.len();
        }
    }

    /// `"…"` on one line, no escapes.
    fn read_string(&mut self, start: usize) {
        let length = self.length_while(|character| !"\"\r\n".contains(character));
        self.at += length;
        if !self.skip("\"") {
            self.findings.push(Finding::new("unterminated-string", &(start..self.at)));
        }
        let range = start..self.at;
        self.tokens.push(Token { kind: Kind::Text, text: self.text[range.clone()].to_owned(), range });
    }

    /// A leading `^` escapes a keyword and is not part of the name.
    fn read_name(&mut self, length: usize) {
        let written = &self.rest()[..length];
        let is_keyword = KEYWORDS.contains(&written) || robot_types::words().contains(&written);
        let kind = if is_keyword { Kind::Keyword } else { Kind::Name };
        let text = written.trim_start_matches('^').to_owned();
        self.tokens.push(Token { kind, text, range: self.at..self.at + length });
        self.at += length;
    }

    /// Characters that start no token; adjacent ones are one finding.
    fn read_invalid(&mut self) {
        let start = self.at;
        while self.at < self.text.len() && !starts_something(self.rest()) {
            self.at += self.rest().chars().next().map_or(0, char::len_utf8);
        }
        self.findings.push(Finding::new("invalid-character", &(start..self.at)));
    }
}

fn starts_something(rest: &str) -> bool {
    rest.starts_with([' ', '\t', '\r', '\n', '\u{c}', '{', '}', ':', ',', '"'])
        || rest.starts_with("//")
        || rest.starts_with("/*")
        || name_length(rest).is_some()
        || number_length(rest).is_some()
}

/// `[A-Za-z_][A-Za-z0-9_]*`, optionally after `^`.
fn name_length(rest: &str) -> Option<usize> {
    let letters = rest.strip_prefix('^').unwrap_or(rest);
    if !letters.starts_with(|character: char| character.is_ascii_alphabetic() || character == '_') {
        return None;
    }
    let belongs = |character: char| character.is_ascii_alphanumeric() || character == '_';
    let length = letters.find(|character| !belongs(character)).unwrap_or(letters.len());
    Some(rest.len() - letters.len() + length)
}

/// A run of digits and dots, optionally after `-`. It begins with a digit, or with a dot and a digit.
fn number_length(rest: &str) -> Option<usize> {
    let digits = rest.strip_prefix('-').unwrap_or(rest);
    let after_dot = digits.strip_prefix('.').unwrap_or(digits);
    if !after_dot.starts_with(|character: char| character.is_ascii_digit()) {
        return None;
    }
    let belongs = |character: char| character.is_ascii_digit() || character == '.';
    let length = digits.find(|character| !belongs(character)).unwrap_or(digits.len());
    Some(rest.len() - digits.len() + length)
}

fn kind_of_number(written: &str) -> Kind {
    let parts: Vec<&str> = written.trim_start_matches('-').split('.').collect();
    let negative = written.starts_with('-');
    if parts.iter().any(|part| part.is_empty()) {
        return Kind::Malformed;
    }
    match parts.len() {
        1 | 2 => Kind::Number,
        4 if !negative => Kind::Ipv4,
        _ => Kind::Malformed,
    }
}
