//! One document of the workspace.

use std::sync::Arc;

use pydslrep_analysis::FileId;
use pydslrep_config::Settings;
use pydslrep_text::Span;
use ropey::Rope;

use crate::DocumentKind;

/// A document that a caller has open, or a file that matters.
#[derive(Debug, Clone)]
pub struct Document {
    /// The name it is known by.
    pub key: String,
    /// Its kind.
    pub kind: DocumentKind,
    /// The text, without a byte order mark. The database holds the same rope, not a copy of it.
    pub text: Rope,
    /// True if a caller has it open; then the text is the caller's, whatever is on the disk.
    pub is_open: bool,
    /// A program's number in the database; `None` if it could not be analysed.
    pub file: Option<FileId>,
    /// A program's settings.
    pub settings: Arc<Settings>,
    /// The paths it imported when they were last followed.
    pub(crate) imports: Vec<String>,
}

impl Document {
    pub(crate) fn new(key: &str, text: Rope, is_open: bool, settings: Arc<Settings>) -> Self {
        Self {
            key: key.to_owned(),
            kind: DocumentKind::of_document(key),
            text,
            is_open,
            file: None,
            settings,
            imports: Vec::new(),
        }
    }

    /// Returns whether it is a program.
    pub fn is_program(&self) -> bool {
        self.kind == DocumentKind::Program
    }
}

/// One change of an open document.
#[derive(Debug, Clone)]
pub struct TextChange {
    /// The bytes it replaces in the text before it; `None` if it replaces the whole text.
    pub span: Option<Span>,
    /// The whole text after it.
    pub after: Rope,
}
