//! Diagnostics of a program: the terminal and the editor show the same object.

use pydslrep_syntax::Span;

use crate::FileId;
use crate::diagnostics::Rule;

/// The severity of a diagnostic.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// Unnecessary, or could be nicer.
    Hint,
    /// Worth knowing.
    Information,
    /// It runs, but is almost certainly unintended.
    Warning,
    /// No script can be generated.
    Error,
}

impl Severity {
    /// The word people know it by.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Hint => "hint",
            Self::Information => "information",
            Self::Warning => "warning",
            Self::Error => "error",
        }
    }
}

/// One problem. All spans count from the start of their file.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagnostic {
    /// The row of the catalogue it belongs to; holds the code.
    pub rule: &'static Rule,
    /// Its severity.
    pub severity: Severity,
    /// The file it is in.
    pub file: FileId,
    /// The smallest text that has to change; empty where something is missing.
    pub span: Span,
    /// The problem, in one sentence.
    pub message: String,
    /// The remedy.
    pub help: Option<String>,
    /// Why it is so.
    pub note: Option<String>,
    /// Second places that matter.
    pub related: Vec<Related>,
    /// Edits that fix it, the likeliest first.
    pub fixes: Vec<Fix>,
}

impl Diagnostic {
    /// Its stable name.
    pub fn code(&self) -> &'static str {
        self.rule.code
    }
}

/// A second place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Related {
    /// The file it is in.
    pub file: FileId,
    /// Where.
    pub span: Span,
    /// A description of the text there.
    pub message: String,
}

/// Edits that fix a problem.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fix {
    /// The action in the imperative: "change to `wheelL`".
    pub title: String,
    /// True if it can be applied without asking.
    pub safe: bool,
    /// In no particular order, never overlapping.
    pub edits: Vec<Edit>,
}

/// A replacement of text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Edit {
    /// The file it is in.
    pub file: FileId,
    /// The text that is removed.
    pub span: Span,
    /// The text that is inserted.
    pub text: String,
}
