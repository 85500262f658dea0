//! The problems of a file.

use pydslrep_text::Span;

/// One problem. Its key has no effect; everything else in the file does, unless the text is not TOML.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    /// Its kind.
    pub kind: ProblemKind,
    /// The key as it is written, with dots between its parts; empty for the whole file.
    pub key: String,
    /// Where it is in the TOML text; `None` for settings from an editor.
    pub span: Option<Span>,
    /// The problem, in one sentence that names the key.
    pub message: String,
    /// The remedy.
    pub help: Option<String>,
    /// The text that probably belongs in place of that at `span`.
    pub replacement: Option<String>,
}

impl Problem {
    /// One without help or replacement.
    pub fn new(kind: ProblemKind, key: impl Into<String>, span: Option<Span>, message: String) -> Self {
        Self { kind, key: key.into(), span, message, help: None, replacement: None }
    }

    /// The same with help.
    pub fn help(self, help: impl Into<String>) -> Self {
        Self { help: Some(help.into()), ..self }
    }
}

/// Kinds of problems.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ProblemKind {
    /// The text is not TOML.
    InvalidToml,
    /// No such key.
    UnknownKey,
    /// The key cannot have this value.
    InvalidValue,
    /// A required key is missing.
    MissingKey,
    /// The program declares nothing of this name.
    UnknownName,
}

impl ProblemKind {
    /// Its stable name.
    pub fn code(self) -> &'static str {
        match self {
            Self::InvalidToml => "invalid-toml",
            Self::UnknownKey => "unknown-key",
            Self::InvalidValue => "invalid-value",
            Self::MissingKey => "missing-key",
            Self::UnknownName => "unknown-name",
        }
    }
}
