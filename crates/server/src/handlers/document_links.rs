//! `textDocument/documentLink`.

use pydslrep_ide as ide;
use tower_lsp::ls_types::{DocumentLink, DocumentLinkParams};

use crate::state::State;

/// The imports of a document that are found.
pub(crate) fn document_links(state: &State, params: &DocumentLinkParams) -> Option<Vec<DocumentLink>> {
    let (document, file) = state.analysed(&params.text_document.uri)?;
    let links = ide::document_links(state.database(), file).into_iter().filter_map(|link| {
        Some(DocumentLink {
            range: state.range(document, link.span),
            target: Some(state.document_of(link.file)?.uri()?),
            tooltip: state.client.link_tooltips.then_some(link.tooltip),
            data: None,
        })
    });
    Some(links.collect())
}
