//! Checks that a batch of changes puts off.

use rustc_hash::FxHashSet;

use crate::entity::FileId;

/// Files to be checked again at the end of a batch.
#[derive(Debug, Clone, Default)]
pub(super) struct Postponed {
    /// These with all that import them, near or far.
    pub(super) with_importers: FxHashSet<FileId>,
    /// Only these.
    pub(super) alone: FxHashSet<FileId>,
}
