//! Diagnostics of all documents, pushed to the client or pulled by it.

use std::fmt::Write;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::str::FromStr;

use pydslrep_analysis as analysis;
use pydslrep_analysis::diagnostics::Tag;
use pydslrep_config::Problem;
use pydslrep_text::Span;
use pydslrep_workspace::Workspace;
use serde::Serialize;
use tower_lsp::jsonrpc::Result;
use tower_lsp::ls_types::notification::PublishDiagnostics;
use tower_lsp::ls_types::{
    CodeDescription, Diagnostic, DiagnosticOptions, DiagnosticRelatedInformation,
    DiagnosticServerCapabilities, DiagnosticSeverity, DiagnosticTag, DocumentDiagnosticParams,
    DocumentDiagnosticReport, DocumentDiagnosticReportResult, FullDocumentDiagnosticReport, NumberOrString,
    PublishDiagnosticsParams, RelatedFullDocumentDiagnosticReport, RelatedUnchangedDocumentDiagnosticReport,
    ServerCapabilities, UnchangedDocumentDiagnosticReport, Uri,
};

use crate::client::ClientFeatures;
use crate::documents::Document;
use crate::message::Outbox;
use crate::state::State;
use crate::view::View;

/// The source that editors show with a diagnostic.
const SOURCE: &str = "pydslrep";

/// Pushes what has changed since the last time, once per document, however many changes there were. Returns whether
/// anything has changed.
pub(crate) fn publish(state: &mut State, outbox: &Outbox) -> bool {
    let changes = state.take_changes();
    let closed = std::mem::take(&mut state.closed);
    let is_changed = !changes.is_empty() || !closed.is_empty();
    if changes.all {
        // Settings may say where an environment is.
        state.view.watched.forget_fingerprints();
    }
    if state.view.client.pull_diagnostics {
        if is_changed {
            // Wake all waiters; each re-checks. A cancelled one no longer listens.
            for waiting in state.waiting.drain(..) {
                let _ = waiting.send(());
            }
        }
        return is_changed;
    }
    for closed in closed {
        publish_one(closed, Vec::new(), None, outbox);
    }
    let mut keys = changes.documents;
    if changes.all {
        keys.extend(state.view.workspace.documents().map(|document| document.key.clone()));
    }
    for key in Workspace::in_order(keys.iter().map(String::as_str)) {
        publish_changed(state, key, outbox);
    }
    is_changed
}

fn publish_changed(state: &mut State, key: &str, outbox: &Outbox) {
    let State { view, published, .. } = state;
    let Some(document) = view.document_at(key) else {
        if let Some((uri, before)) = published.remove(key)
            && !before.is_empty()
        {
            publish_one(uri, Vec::new(), None, outbox);
        }
        return;
    };
    let diagnostics = of_document(view, document);
    let is_published = match published.get(key) {
        Some((_, before)) => *before == diagnostics,
        // A closed file without problems needs no notification.
        None => document.version().is_none() && diagnostics.is_empty(),
    };
    let (false, Some(uri)) = (is_published, document.uri()) else { return };
    publish_one(uri.clone(), diagnostics.clone(), document.version(), outbox);
    published.insert(key.to_owned(), (uri, diagnostics));
}

fn publish_one(uri: Uri, diagnostics: Vec<Diagnostic>, version: Option<i32>, outbox: &Outbox) {
    let params = PublishDiagnosticsParams::new(uri, diagnostics, version);
    outbox.send_notification::<PublishDiagnostics>(&params);
}

pub(crate) fn announce(server: &mut ServerCapabilities, client: &ClientFeatures) {
    server.diagnostic_provider = client.pull_diagnostics.then(|| {
        DiagnosticServerCapabilities::Options(DiagnosticOptions {
            identifier: Some("pydslrep".to_owned()),
            inter_file_dependencies: true,
            workspace_diagnostics: true,
            ..DiagnosticOptions::default()
        })
    });
}

/// Returns whether a document has so many problems that converting them takes longer than handing it to another thread.
pub(crate) fn has_many(view: &View, params: &DocumentDiagnosticParams) -> bool {
    /// Entities with problems; one takes a few microseconds.
    const MANY: usize = 500;
    let file = view.document(&params.text_document.uri).and_then(|document| document.file);
    file.is_some_and(|file| view.database().count_with_problems(file) > MANY)
}

/// `textDocument/diagnostic`. The result's id depends on the diagnostics and on when the document was opened, not on its
/// version, which may start again from the beginning.
#[expect(clippy::unnecessary_wraps, reason = "what answers without a null look like")]
pub(crate) fn pull(view: &View, params: &DocumentDiagnosticParams) -> Result<DocumentDiagnosticReportResult> {
    let document = view.document(&params.text_document.uri);
    let items = document.map(|document| of_document(view, document)).unwrap_or_default();
    let result_id = result_id(&items, document.map_or(0, Document::opening));
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
    Ok(report.into())
}

/// A name for diagnostics of a document, the same for the same diagnostics.
pub(crate) fn result_id(items: &[Diagnostic], opening: u64) -> String {
    let mut hasher = DefaultHasher::new();
    opening.hash(&mut hasher);
    for item in items {
        item.message.hash(&mut hasher);
        serde_json::to_string(item).unwrap_or_default().hash(&mut hasher);
    }
    format!("{:016x}", hasher.finish())
}

/// The data of a diagnostic that the next word of the statement being typed will settle. Clients that know it do not show
/// the diagnostic as long as the cursor is on that line.
#[derive(Debug, Serialize)]
#[serde(rename_all = "camelCase")]
struct Unsettled {
    /// The line being typed.
    typed_line: u32,
}

/// All diagnostics of a document, as this client can show them. Of the statement being typed, what its next word will
/// settle is marked where the client pulls, and otherwise left out.
pub(crate) fn of_document(view: &View, document: Document<'_>) -> Vec<Diagnostic> {
    let found = document.file.map(|file| view.database().shown_diagnostics(file)).unwrap_or_default();
    let statements = if found.is_empty() { Vec::new() } else { view.statements_being_typed(document) };
    let in_program = found.iter().filter_map(|diagnostic| {
        let Some(statement) = statements.iter().find(|statement| statement.settles(diagnostic)) else {
            return convert(view, document, diagnostic);
        };
        let converted = convert(view, document, diagnostic).filter(|_| view.client.pull_diagnostics)?;
        let typed_line = view.range(document, Span::at(statement.offset())).start.line;
        Some(Diagnostic { data: serde_json::to_value(Unsettled { typed_line }).ok(), ..converted })
    });
    let problems = view.workspace.problems(document.key).into_iter();
    in_program.chain(problems.map(|problem| convert_problem(view, document, problem))).collect()
}

/// One diagnostic, as this client can show it; `None` where it is switched off.
pub(crate) fn convert(
    view: &View,
    document: Document<'_>,
    diagnostic: &analysis::Diagnostic,
) -> Option<Diagnostic> {
    let client = &view.client;
    let chosen = document.settings.severities.severity(diagnostic.code(), diagnostic.severity)?;
    Some(Diagnostic {
        range: view.range(document, diagnostic.span),
        severity: Some(severity(chosen)),
        code: Some(NumberOrString::String(diagnostic.code().to_owned())),
        code_description: client.code_description.then(|| page(client, diagnostic.code())).flatten(),
        source: Some(SOURCE.to_owned()),
        message: message(view, diagnostic),
        related_information: related_information(view, diagnostic),
        tags: diagnostic
            .rule
            .tag
            .map(tag)
            .filter(|tag| client.diagnostic_tags.contains(tag))
            .map(|tag| vec![tag]),
        data: None,
    })
}

/// One problem of a `pydslrep.toml` or a scene.
pub(crate) fn convert_problem(view: &View, document: Document<'_>, problem: Problem) -> Diagnostic {
    Diagnostic {
        range: view.range(document, problem.span.unwrap_or(Span::at(0))),
        severity: Some(DiagnosticSeverity::ERROR),
        code: Some(NumberOrString::String(problem.kind.code().to_owned())),
        source: Some(SOURCE.to_owned()),
        message: match problem.help {
            Some(help) => format!("{}\nhelp: {help}", problem.message),
            None => problem.message,
        },
        ..Diagnostic::default()
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

/// The headline, then help and note; and the related locations, where the client cannot show them otherwise.
fn message(view: &View, diagnostic: &analysis::Diagnostic) -> String {
    let mut message = diagnostic.message.clone();
    // Writing to a string cannot fail.
    if let Some(help) = &diagnostic.help {
        let _ = write!(message, "\nhelp: {help}");
    }
    if let Some(note) = &diagnostic.note {
        let _ = write!(message, "\nnote: {note}");
    }
    if !view.client.related_information {
        for related in &diagnostic.related {
            if let Some(place) = view.location(related.file, related.span) {
                let _ = write!(message, "\nline {}: {}", place.range.start.line + 1, related.message);
            }
        }
    }
    message
}

fn related_information(
    view: &View,
    diagnostic: &analysis::Diagnostic,
) -> Option<Vec<DiagnosticRelatedInformation>> {
    if !view.client.related_information || diagnostic.related.is_empty() {
        return None;
    }
    let convert = |related: &analysis::Related| {
        let location = view.location(related.file, related.span)?;
        Some(DiagnosticRelatedInformation { location, message: related.message.clone() })
    };
    Some(diagnostic.related.iter().filter_map(convert).collect())
}

/// The page that explains a code: in the client, otherwise in the project's repository.
fn page(client: &ClientFeatures, code: &str) -> Option<CodeDescription> {
    if let Some(scheme) = &client.pages {
        return Some(CodeDescription { href: Uri::from_str(&format!("{scheme}:/{code}.md")).ok()? });
    }
    let repository = option_env!("CARGO_PKG_REPOSITORY").filter(|address| !address.is_empty())?;
    let href = Uri::from_str(&format!("{repository}/blob/main/docs/diagnostics/{code}.md")).ok()?;
    Some(CodeDescription { href })
}
