//! Problems of the open documents: pushed to clients that wait for them, answered to those that ask.

use std::fmt::Write;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::str::FromStr;

use pydslrep_analysis as analysis;
use pydslrep_analysis::diagnostics::Tag;
use tower_lsp::ls_types::{
    CodeDescription, Diagnostic, DiagnosticRelatedInformation, DiagnosticSeverity, DiagnosticTag,
    DocumentDiagnosticParams, DocumentDiagnosticReport, DocumentDiagnosticReportResult,
    FullDocumentDiagnosticReport, NumberOrString, PublishDiagnosticsParams,
    RelatedFullDocumentDiagnosticReport, RelatedUnchangedDocumentDiagnosticReport,
    UnchangedDocumentDiagnosticReport, Uri,
};

use crate::documents::Document;
use crate::message::Outbox;
use crate::state::State;

/// Tells the client what changed since it was last told; once per document, however many changes there were.
pub(crate) fn publish(state: &mut State, outbox: &Outbox) {
    if !std::mem::take(&mut state.changed) || state.client.pull_diagnostics {
        return;
    }
    let keys: Vec<String> = state.documents.keys().cloned().collect();
    for key in keys {
        let Some(document) = state.documents.get(&key) else { continue };
        let diagnostics = of_document(state, document);
        if document.published.as_ref() == Some(&diagnostics) {
            continue;
        }
        let (uri, version) = (document.uri.clone(), document.version);
        let params = PublishDiagnosticsParams::new(uri, diagnostics, version);
        outbox.notify("textDocument/publishDiagnostics", &params);
        if let Some(document) = state.documents.get_mut(&key) {
            document.published = Some(params.diagnostics);
        }
    }
}

/// A document that is no longer open has no diagnostics.
pub(crate) fn clear(uri: Uri, outbox: &Outbox) {
    let params = PublishDiagnosticsParams::new(uri, Vec::new(), None);
    outbox.notify("textDocument/publishDiagnostics", &params);
}

/// `textDocument/diagnostic`. The result's id depends on the diagnostics and on when the document was opened, not on its
/// version, which may start over.
pub(crate) fn pull(state: &State, params: &DocumentDiagnosticParams) -> DocumentDiagnosticReportResult {
    let document = state.document(&params.text_document.uri);
    let items = document.map(|document| of_document(state, document)).unwrap_or_default();
    let result_id = result_id(&items, document.map_or(0, |document| document.opening));
    let report = if params.previous_result_id.as_ref() == Some(&result_id) {
        DocumentDiagnosticReport::Unchanged(RelatedUnchangedDocumentDiagnosticReport {
            related_documents: None,
            unchanged_document_diagnostic_report: UnchangedDocumentDiagnosticReport { result_id },
        })
    } else {
        DocumentDiagnosticReport::Full(RelatedFullDocumentDiagnosticReport {
            related_documents: None,
            full_document_diagnostic_report: FullDocumentDiagnosticReport {
                result_id: Some(result_id),
                items,
            },
        })
    };
    report.into()
}

fn result_id(items: &[Diagnostic], opening: u64) -> String {
    let mut hasher = DefaultHasher::new();
    opening.hash(&mut hasher);
    for item in items {
        item.message.hash(&mut hasher);
        serde_json::to_string(item).unwrap_or_default().hash(&mut hasher);
    }
    format!("{:016x}", hasher.finish())
}

/// All diagnostics of a document, as this client can show them.
pub(crate) fn of_document(state: &State, document: &Document) -> Vec<Diagnostic> {
    let Some(file) = document.file else { return Vec::new() };
    let found = state.database.diagnostics(file);
    found.iter().map(|diagnostic| convert(state, document, diagnostic)).collect()
}

/// One diagnostic, as this client can show it.
pub(crate) fn convert(state: &State, document: &Document, diagnostic: &analysis::Diagnostic) -> Diagnostic {
    let client = &state.client;
    Diagnostic {
        range: state.range(document, diagnostic.span),
        severity: Some(severity(diagnostic.severity)),
        code: Some(NumberOrString::String(diagnostic.code().to_owned())),
        code_description: client.code_description.then(|| page(diagnostic.code())).flatten(),
        source: Some("pydslrep".to_owned()),
        message: message(state, diagnostic),
        related_information: related_information(state, diagnostic),
        tags: diagnostic
            .rule
            .tag
            .map(tag)
            .filter(|tag| client.diagnostic_tags.contains(tag))
            .map(|tag| vec![tag]),
        data: None,
    }
}

fn severity(severity: analysis::Severity) -> DiagnosticSeverity {
    match severity {
        analysis::Severity::Error => DiagnosticSeverity::ERROR,
        analysis::Severity::Warning => DiagnosticSeverity::WARNING,
        analysis::Severity::Information => DiagnosticSeverity::INFORMATION,
        analysis::Severity::Hint => DiagnosticSeverity::HINT,
    }
}

fn tag(tag: Tag) -> DiagnosticTag {
    match tag {
        Tag::Unnecessary => DiagnosticTag::UNNECESSARY,
        Tag::Deprecated => DiagnosticTag::DEPRECATED,
    }
}

/// The headline, then what to do and why; and the second places, where the client has no other place for them.
fn message(state: &State, diagnostic: &analysis::Diagnostic) -> String {
    let mut message = diagnostic.message.clone();
    // Writing to a string cannot fail.
    if let Some(help) = &diagnostic.help {
        let _ = write!(message, "\nhelp: {help}");
    }
    if let Some(note) = &diagnostic.note {
        let _ = write!(message, "\nnote: {note}");
    }
    if !state.client.related_information {
        for related in &diagnostic.related {
            if let Some(place) = state.location(related.file, related.span) {
                let _ = write!(message, "\nline {}: {}", place.range.start.line + 1, related.message);
            }
        }
    }
    message
}

fn related_information(
    state: &State,
    diagnostic: &analysis::Diagnostic,
) -> Option<Vec<DiagnosticRelatedInformation>> {
    if !state.client.related_information || diagnostic.related.is_empty() {
        return None;
    }
    let convert = |related: &analysis::Related| {
        let location = state.location(related.file, related.span)?;
        Some(DiagnosticRelatedInformation { location, message: related.message.clone() })
    };
    Some(diagnostic.related.iter().filter_map(convert).collect())
}

/// The page that explains a code, in the project's repository.
fn page(code: &str) -> Option<CodeDescription> {
    let repository = option_env!("CARGO_PKG_REPOSITORY").filter(|address| !address.is_empty())?;
    let href = Uri::from_str(&format!("{repository}/blob/main/docs/diagnostics/{code}.md")).ok()?;
    Some(CodeDescription { href })
}
