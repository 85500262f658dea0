//! What a change did to the facts.

use std::sync::Arc;

use pydslrep_syntax::Parse;

use crate::entity::EntityId;

/// What a change did to a file. Where as many entities come as go, they keep their ids.
#[derive(Debug, Default)]
pub(crate) struct Edited {
    /// The entities that went, as they were, in the order of the text.
    pub(crate) before: Vec<(EntityId, Arc<Parse>)>,
    /// The entities that came. The id of one that went may be that of another now.
    pub(crate) after: Vec<EntityId>,
    /// Returns whether each entity that went is there again, read anew.
    pub(crate) is_update: bool,
    /// The paths that the file imported; `None` where no import statement came or went.
    pub(crate) imports_before: Option<Vec<String>>,
    /// True where the file had an environment.
    pub(crate) had_environments: bool,
    /// Tokens read again.
    pub(crate) relexed: usize,
    /// Entities read again, those included that turned out as before.
    pub(crate) reparsed: usize,
}
