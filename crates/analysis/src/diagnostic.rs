//! What is wrong with a program, for whoever shows it: the terminal and the editor get the same object.

use pydslrep_syntax::Span;

use crate::FileId;
use crate::diagnostics::Rule;

/// How bad it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// Unnecessary, or could be nicer.
    Hint,
    /// Worth knowing.
    Information,
    /// It runs, but is surely not meant.
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
    /// How bad it is.
    pub severity: Severity,
    /// The file it is in.
    pub file: FileId,
    /// The smallest text that has to change; empty where something is missing.
    pub span: Span,
    /// What is wrong, in one sentence.
    pub message: String,
    /// What to do.
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
    /// What is there.
    pub message: String,
}

/// Edits that fix a problem.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fix {
    /// What it does, as an order: "change to `wheelL`".
    pub title: String,
    /// Whether it can be applied without asking.
    pub safe: bool,
    /// In no particular order, never overlapping.
    pub edits: Vec<Edit>,
}

/// A replacement of text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Edit {
    /// The file it is in.
    pub file: FileId,
    /// What goes.
    pub span: Span,
    /// What comes.
    pub text: String,
}
