//! `textDocument/documentLink`.

use pydslrep_ide as ide;
use tower_lsp::ls_types::{DocumentLink, DocumentLinkParams};

use crate::view::View;

/// The imports of a document that are found.
pub(crate) fn document_links(view: &View, params: &DocumentLinkParams) -> Option<Vec<DocumentLink>> {
    let (document, file) = view.analysed(&params.text_document.uri)?;
    let links = ide::document_links(view.database(), file).into_iter().filter_map(|link| {
        Some(DocumentLink {
            range: view.range(document, link.span),
            target: Some(view.document_of(link.file)?.uri()?),
            tooltip: view.client.link_tooltips.then_some(link.tooltip),
            data: None,
        })
    });
    Some(links.collect())
}
