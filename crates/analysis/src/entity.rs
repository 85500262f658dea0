//! Files and entities: their ids and places.

use pydslrep_syntax::{Parse, Span};

/// A file of the database; the same for the same path, also after closing and opening it again.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FileId(u32);

/// An entity of the database; it keeps its id while edits leave its kind and place alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct EntityId(u32);

impl FileId {
    pub(crate) fn new(index: usize) -> Self {
        Self(u32::try_from(index).unwrap_or(u32::MAX))
    }

    pub(crate) fn index(self) -> usize {
        self.0 as usize
    }
}

impl EntityId {
    pub(crate) fn new(index: usize) -> Self {
        Self(u32::try_from(index).unwrap_or(u32::MAX))
    }

    pub(crate) fn index(self) -> usize {
        self.0 as usize
    }
}

/// The result of looking a name up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Resolution {
    /// This entity; the first of several that bear the name.
    To(EntityId),
    /// Not known: the name is in invalid text, or an imported file is missing.
    Unknown,
    /// Nothing.
    Nothing,
}

impl Resolution {
    /// The entity, if there is one.
    pub fn entity(self) -> Option<EntityId> {
        match self {
            Self::To(entity) => Some(entity),
            Self::Unknown | Self::Nothing => None,
        }
    }
}

/// An entity with its place.
#[derive(Debug, Clone, Copy)]
pub struct EntityRef<'a> {
    /// Its id.
    pub id: EntityId,
    /// Its file.
    pub file: FileId,
    /// From its first byte to where the next entity starts.
    pub span: Span,
    /// The tree (`None` for the text before the first entity), tokens and errors; their spans count from
    /// `span.start`.
    pub parse: &'a Parse,
}

/// A range of text in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FileSpan {
    /// Which file.
    pub file: FileId,
    /// From the start of the file.
    pub span: Span,
}
