//! What is wrong with settings.

use pydslrep_text::Span;

/// One problem. What it is about does not hold; everything else that was set does, except where the text is no TOML.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    /// What sort of problem it is.
    pub kind: ProblemKind,
    /// The key it is about as it is written, with dots between its parts; empty for the whole.
    pub key: String,
    /// Where it is in the text, which is TOML; `None` for settings from an editor.
    pub span: Option<Span>,
    /// What is wrong, in one sentence; names the key.
    pub message: String,
    /// What to do.
    pub help: Option<String>,
    /// What should probably stand in place of the text at `span`.
    pub replacement: Option<String>,
}

/// Sorts of problems.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ProblemKind {
    /// The text is no TOML.
    InvalidToml,
    /// There is no such setting.
    UnknownKey,
    /// A setting cannot have this value.
    InvalidValue,
    /// A key is missing that others make no sense without.
    MissingKey,
    /// The program has nothing of this name.
    UnknownName,
}

impl ProblemKind {
    /// The stable name of the sort.
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
