//! What the server knows between two messages.

use crate::capabilities::ClientFeatures;
use crate::documents::{Document, Documents, key};
use tower_lsp::ls_types::Uri;

/// Documents, their analysis, and what the client can do.
#[derive(Debug, Default)]
pub(crate) struct State {
    /// What the client can do.
    pub(crate) client: ClientFeatures,
    /// The open documents.
    pub(crate) documents: Documents,
}

impl State {
    /// The open document at an address.
    pub(crate) fn document(&self, uri: &Uri) -> Option<&Document> {
        self.documents.get(&key(uri))
    }
}
