//! The reference checker (test oracle) of the language, and a generator of random programs.
//!
//! Knows only the language specification. Must never know our other crates, or it would share their bugs. If it disagrees
//! with one of them about a program, one of the two violates the specification.
//!
//! It is as simple as possible: every check reads the complete program, and every name lookup is a linear search.

mod check;
mod generate;
mod grammar;
mod program;
mod tokens;

#[cfg(test)]
mod tests;

use std::collections::BTreeSet;
use std::ops::Range;

pub use generate::{Recipe, program, programs};

/// A diagnostic required by the specification.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Finding {
    /// First byte.
    pub start: usize,
    /// The offset after the last byte.
    pub end: usize,
    /// The diagnostic code.
    pub code: &'static str,
}

impl Finding {
    fn new(code: &'static str, at: &Range<usize>) -> Self {
        Self { start: at.start, end: at.end, code }
    }
}

/// The result of checking a program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Verdict {
    /// Whether its tokens are valid and follow the grammar.
    pub grammatical: bool,
    /// In text order; only lexical errors if the program is not grammatical.
    ///
    /// Excludes the codes that need more than one program: `planned-collision` needs a scene, `unresolved-import` and
    /// `ambiguous-import` other files, `duplicate-port` the other target.
    pub findings: Vec<Finding>,
    /// Optional findings, likely caused by others: an unused declaration that a misspelt reference may have meant.
    pub excused: Vec<Finding>,
}

impl Verdict {
    /// Whether there are no findings, not even hints.
    pub fn is_clean(&self) -> bool {
        self.grammatical && self.findings.is_empty()
    }
}

/// Checks a program.
pub fn check(text: &str) -> Verdict {
    let (tokens, lexical) = tokens::read(text);
    let mut findings = lexical;
    let lexically_sound = findings.is_empty();
    let program = if lexically_sound { grammar::read(&tokens, text.len()) } else { None };
    if let Some(program) = &program {
        findings.extend(check::check(program));
    }
    findings.sort();
    let excused =
        |finding: &Finding| program.as_ref().is_some_and(|program| check::is_excused(program, finding));
    let (excused, findings) = findings.into_iter().partition(excused);
    Verdict { grammatical: program.is_some(), findings, excused }
}

/// The keywords and punctuation that can follow the beginning of a program; `None` if the text is not the beginning of a
/// program. Excludes the two deprecated spellings.
pub fn continuations(beginning: &str) -> Option<BTreeSet<&'static str>> {
    let (tokens, lexical) = tokens::read(beginning);
    grammar::expected(&tokens, beginning.len()).filter(|_| lexical.is_empty())
}

/// An entity of a grammatical program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Declaration {
    /// `wheel` (also for `wheelH`), `sensor`, `ip`, `robot`, `movement` or `environment`.
    pub kind: &'static str,
    /// Its name without `^`.
    pub name: String,
    /// The range of the name, including `^`.
    pub name_range: Range<usize>,
    /// From the start of its first token to the end of its last.
    pub range: Range<usize>,
}

/// All entities of a program in text order; `None` if it is not grammatical.
pub fn declarations(text: &str) -> Option<Vec<Declaration>> {
    let (tokens, lexical) = tokens::read(text);
    let program = grammar::read(&tokens, text.len()).filter(|_| lexical.is_empty())?;
    let declaration = |entity: program::Entity| Declaration {
        kind: entity.kind(),
        name: entity.name.text,
        name_range: entity.name.range,
        range: entity.range,
    };
    Some(program.entities.into_iter().map(declaration).collect())
}
