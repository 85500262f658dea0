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
mod project;
mod robot_types;
mod tokens;

#[cfg(test)]
mod tests;

use std::collections::BTreeSet;
use std::ops::Range;

use project::{File, Project, Scope};

pub use generate::{Recipe, Statements, mutated, program, programs};

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
    /// Excludes `planned-collision`, which needs a scene and geometry.
    pub findings: Vec<Finding>,
    /// Optional findings: an unused declaration that a misspelt reference may have meant, and `invalid-time` of loops where the
    /// measures of a robot or a condition decide whether the plan has more than 30 days.
    pub excused: Vec<Finding>,
}

impl Verdict {
    /// Whether there are no findings, not even hints.
    pub fn is_clean(&self) -> bool {
        self.grammatical && self.findings.is_empty()
    }
}

/// A file of a project.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Source {
    /// Relative to the folder of the project, with `/` between folders.
    pub path: &'static str,
    /// Its text.
    pub text: String,
    /// Whether its scripts are for V-REP, not for `CoppeliaSim`.
    pub for_vrep: bool,
}

/// Checks a program for `CoppeliaSim`. Its imports are not looked at: the names that it uses must be its own.
pub fn check(text: &str) -> Verdict {
    let (program, lexical) = read(text);
    let Some(mut program) = program else {
        return Verdict { grammatical: false, findings: lexical, excused: Vec::new() };
    };
    program.imports.clear();
    let project = Project { files: vec![File { path: String::new(), for_vrep: false, program }] };
    verdict(Scope::new(&project, 0))
}

/// Checks a program as [`check`] does, and finds what is not in the article.
pub fn check_as_article(text: &str) -> Verdict {
    let mut verdict = check(text);
    if verdict.grammatical {
        verdict.findings.extend(read(text).0.iter().flat_map(check::not_in_article));
        verdict.findings.sort();
    }
    verdict
}

/// Checks files that import each other; `None` if one of them is not grammatical. An import that leads to none of them leads
/// nowhere.
pub fn check_project(sources: &[Source]) -> Option<Vec<Verdict>> {
    let file = |source: &Source| {
        let program = read(&source.text).0?;
        Some(File { path: source.path.to_owned(), for_vrep: source.for_vrep, program })
    };
    let project = Project { files: sources.iter().map(file).collect::<Option<_>>()? };
    Some((0..sources.len()).map(|file| verdict(Scope::new(&project, file))).collect())
}

/// The program, if it is grammatical, and its lexical errors.
fn read(text: &str) -> (Option<program::Program>, Vec<Finding>) {
    let (tokens, mut lexical) = tokens::read(text);
    lexical.sort();
    let program = if lexical.is_empty() { grammar::read(&tokens, text.len()) } else { None };
    (program, lexical)
}

fn verdict(scope: Scope<'_>) -> Verdict {
    let mut findings = check::check(scope);
    findings.sort();
    let (mut excused, findings): (Vec<_>, _) =
        findings.into_iter().partition(|finding| check::is_excused(scope, finding));
    excused.extend(check::doubtful(scope));
    Verdict { grammatical: true, findings, excused }
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
