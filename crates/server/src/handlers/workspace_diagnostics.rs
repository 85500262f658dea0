//! `workspace/diagnostic`.

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
use crate::state::State;

/// What has changed since the client last asked; waits until something has.
pub(crate) async fn pull_workspace(
    mut reader: Reader,
    params: WorkspaceDiagnosticParams,
) -> Result<WorkspaceDiagnosticReportResult> {
    let known: FxHashMap<String, &str> =
        params.previous_result_ids.iter().map(|known| (key(&known.uri), known.value.as_str())).collect();
    loop {
        let change = reader.diagnostics_change();
        let mut items = Vec::new();
        let mut keys: Vec<String> = reader.state().documents.keys().cloned().collect();
        keys.sort_unstable();
        for key in keys {
            let length = {
                let state = reader.state();
                let Some(document) = state.documents.get(&key) else { continue };
                items.extend(changed_report(&state, document, known.get(&key).copied()));
                document.text.len_bytes()
            };
            reader.has_read(length).await;
        }
        {
            let state = reader.state();
            let gone = params.previous_result_ids.iter().filter(|known| state.document(&known.uri).is_none());
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
    state: &State,
    document: &Document,
    known: Option<&str>,
) -> Option<WorkspaceDocumentDiagnosticReport> {
    let found = of_document(state, document);
    let id = result_id(&found, document.opening);
    (known != Some(id.as_str())).then(|| full_report(document.uri.clone(), document.version, Some(id), found))
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
