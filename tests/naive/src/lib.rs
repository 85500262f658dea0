//! A second opinion on the language, for tests: programs at random, and a checker that reads like the language's
//! contract.
//!
//! Knows the contract alone. Must never know any crate of ours, or it would share their mistakes. Where one of them
//! and this one disagree about a program, one of the two has misread the contract.
//!
//! Everything here is as plain as can be: a program is read from its first to its last byte every time, and a question
//! about a name looks through all of it.

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

/// One thing the contract says about a place in a program.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Finding {
    /// First byte.
    pub start: usize,
    /// One behind the last byte.
    pub end: usize,
    /// A code of the catalogue.
    pub code: &'static str,
}

impl Finding {
    fn new(code: &'static str, at: &Range<usize>) -> Self {
        Self { start: at.start, end: at.end, code }
    }
}

/// What the contract says about a program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Verdict {
    /// Whether its tokens are all sound and follow the grammar.
    pub grammatical: bool,
    /// In the order of the text. Where the program is not grammatical, the lexical errors alone.
    ///
    /// Left out are the codes that need more than a program: `planned-collision` a scene, `unresolved-import` and
    /// `ambiguous-import` other files, `duplicate-port` the other target.
    pub findings: Vec<Finding>,
    /// True as well, but likely the other side of one of the findings: the declaration that nothing uses, where a
    /// misspelt reference may have meant it. It may be said or not.
    pub excused: Vec<Finding>,
}

impl Verdict {
    /// Whether nothing at all is wrong with the program, hints included.
    pub fn is_clean(&self) -> bool {
        self.grammatical && self.findings.is_empty()
    }
}

/// Reads a program and says all that is wrong with it.
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

/// The words and signs with which a text can go on so that it is still the beginning of a program; `None` where it is no
/// such beginning itself. The two older spellings are not among them.
pub fn continuations(beginning: &str) -> Option<BTreeSet<&'static str>> {
    let (tokens, lexical) = tokens::read(beginning);
    grammar::looked_for(&tokens, beginning.len()).filter(|_| lexical.is_empty())
}

/// An entity of a grammatical program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Declaration {
    /// `wheel` (also for `wheelH`), `sensor`, `ip`, `robot`, `movement` or `environment`.
    pub kind: &'static str,
    /// Its name without `^`.
    pub name: String,
    /// Where the name stands, with its `^`.
    pub name_range: Range<usize>,
    /// From the first byte of its first token to behind its last.
    pub range: Range<usize>,
}

/// All entities of a program in the order of the text; `None` where it is not grammatical.
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
