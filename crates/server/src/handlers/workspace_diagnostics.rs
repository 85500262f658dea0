//! `workspace/diagnostic`.

use pydslrep_workspace::Workspace;
use rustc_hash::FxHashMap;
use tower_lsp::jsonrpc::{Error, Result};
use tower_lsp::ls_types::{
    Diagnostic, FullDocumentDiagnosticReport, Uri, WorkspaceDiagnosticParams, WorkspaceDiagnosticReport,
    WorkspaceDiagnosticReportResult, WorkspaceDocumentDiagnosticReport,
    WorkspaceFullDocumentDiagnosticReport,
};

use crate::documents::{Document, key};
use crate::handlers::diagnostics::{of_document, result_id};
use crate::reader::Reader;
use crate::server::Server;
use crate::view::View;

/// Returns the diagnostics that have changed since the client last asked; waits until some have.
pub(crate) async fn pull_workspace(
    server: Server,
    params: WorkspaceDiagnosticParams,
) -> Result<WorkspaceDiagnosticReportResult> {
    let mut reader = Reader::new(server);
    let known: FxHashMap<String, &str> =
        params.previous_result_ids.iter().map(|known| (key(&known.uri), known.value.as_str())).collect();
    loop {
        let change = reader.diagnostics_change();
        let mut items = Vec::new();
        let keys: Vec<String> = {
            let view = &reader.state().view;
            let keys = view.workspace.documents().map(|document| document.key.as_str());
            Workspace::in_order(keys).into_iter().map(str::to_owned).collect()
        };
        for key in keys {
            let length = {
                let view = &reader.state().view;
                let Some(document) = view.document_at(&key) else { continue };
                items.extend(changed_report(view, document, known.get(&key).copied()));
                document.text.len_bytes()
            };
            reader.has_read(length).await;
        }
        {
            let view = &reader.state().view;
            let gone = params.previous_result_ids.iter().filter(|known| view.document(&known.uri).is_none());
            items.extend(gone.map(|known| full_report(known.uri.clone(), None, None, Vec::new())));
        }
        // After an empty answer clients send the request again at once.
        if !items.is_empty() || known.is_empty() {
            return Ok(WorkspaceDiagnosticReport { items }.into());
        }
        change.await.map_err(|_| Error::internal_error())?;
    }
}

fn changed_report(
    view: &View,
    document: Document<'_>,
    known: Option<&str>,
) -> Option<WorkspaceDocumentDiagnosticReport> {
    let found = of_document(view, document);
    let id = result_id(&found, document.opening());
    if known == Some(id.as_str()) {
        return None;
    }
    Some(full_report(document.uri()?, document.version(), Some(id), found))
}

fn full_report(
    uri: Uri,
    version: Option<i32>,
    result_id: Option<String>,
    items: Vec<Diagnostic>,
) -> WorkspaceDocumentDiagnosticReport {
    WorkspaceDocumentDiagnosticReport::Full(WorkspaceFullDocumentDiagnosticReport {
        uri,
        version: version.map(i64::from),
        full_document_diagnostic_report: FullDocumentDiagnosticReport { result_id, items },
    })
}
