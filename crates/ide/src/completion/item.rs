//! A completion item: what it shows, inserts and replaces.

use pydslrep_analysis::FileId;
use pydslrep_syntax::{EntityKind, Span, TextEdit};

use super::snippets::plain_text;

/// A completion item.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Completion {
    /// The text shown in the list.
    pub label: String,
    /// Its kind.
    pub kind: CompletionKind,
    /// A short description next to the label.
    pub detail: String,
    /// The documentation shown for it.
    pub documentation: Documentation,
    /// The text it replaces: the word at the cursor.
    pub replace: Span,
    /// The text it inserts; with tab stops (`$1`, `${1:text}`, `$0`) if `is_snippet`.
    pub insert: String,
    /// True if `insert` has tab stops.
    pub is_snippet: bool,
    /// True if the word at the cursor begins with `^`: editors must then filter by `insert` rather than by `label`.
    pub is_escaped: bool,
    /// The file that it imports, for a name that is not visible yet.
    pub imports: Option<FileId>,
    /// The edit that adds the import.
    pub import_edit: Option<TextEdit>,
    /// The primary sort key; items of one rank keep their order.
    pub(crate) rank: Rank,
}

impl Completion {
    /// An item that inserts its label.
    pub(crate) fn new(label: &str, kind: CompletionKind, replace: Span) -> Self {
        Self {
            label: label.to_owned(),
            kind,
            detail: String::new(),
            documentation: Documentation::Text(String::new()),
            replace,
            insert: label.to_owned(),
            is_snippet: false,
            is_escaped: false,
            imports: None,
            import_edit: None,
            rank: Rank::Fitting,
        }
    }

    /// The inserted text without tab stops.
    pub fn plain(&self) -> String {
        if self.is_snippet { plain_text(&self.insert) } else { self.insert.clone() }
    }
}

/// The kind of a completion item.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CompletionKind {
    /// A keyword, possibly with the ones that must follow it.
    Keyword,
    /// A complete entity or action with placeholders.
    Snippet,
    /// A number or an address.
    Value,
    /// The path of a file.
    File,
    /// The name of an entity.
    Reference(EntityKind),
    /// A key or a table of a TOML file.
    Setting,
}

/// The documentation of a completion item.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Documentation {
    /// Markdown; may be empty.
    Text(String),
    /// A declaration in a file, documented by [`super::completion_documentation`] on request: it costs more, and users look at
    /// few items.
    Of(FileId, EntityKind),
}

/// Names first, then snippets, keywords, closing braces, and names that need an import.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Rank {
    Fitting,
    Snippet,
    Keyword,
    Closing,
    Elsewhere,
}
