//! `textDocument/completion`.

use pydslrep_analysis::FileId;
use pydslrep_ide as ide;
use pydslrep_syntax::EntityKind;
use serde::{Deserialize, Serialize};
use tower_lsp::jsonrpc::{Error, Result};
use tower_lsp::ls_types::{
    CompletionItem, CompletionItemKind, CompletionList, CompletionOptions, CompletionParams,
    CompletionResponse, CompletionTextEdit, CompletionTriggerKind, Documentation, InsertTextFormat,
    MarkupContent, ServerCapabilities, TextEdit,
};

use crate::client::ClientFeatures;
use crate::documents::Document;
use crate::view::View;

/// The maximum number of items with documentation if the client does not resolve it: finding a declaration takes a while in a
/// long file, and nobody reads them all.
const MAX_DOCUMENTED: usize = 50;

/// The entity of a completion: its data until it is resolved.
#[derive(Debug, Serialize, Deserialize)]
struct CompletionOf {
    /// The key of the document that declares it.
    home: String,
    #[serde(with = "crate::noun")]
    kind: EntityKind,
    name: String,
}

pub(crate) fn announce(server: &mut ServerCapabilities, _: &ClientFeatures) {
    server.completion_provider = Some(CompletionOptions {
        // `[` is for settings files. Letters need not be listed: editors send requests after them anyway.
        trigger_characters: Some([" ", "[", "\"", "/", "^"].map(str::to_owned).to_vec()),
        resolve_provider: Some(true),
        ..CompletionOptions::default()
    });
}

/// Returns the completions at a position: in a program, what the grammar allows and the names that make sense there; in
/// a settings file or a scene, keys.
pub(crate) fn completion(view: &View, params: &CompletionParams) -> Option<CompletionResponse> {
    let trigger = trigger(view, params);
    let at = &params.text_document_position;
    if let Some((document, file, text)) = view.toml_text(&at.text_document.uri) {
        let offset = view.offset(document, at.position);
        return Some(list(view, document, ide::toml_completions(file, &text, offset, trigger)));
    }
    let place = view.place(at)?;
    let speed = place.document.settings.default_speed;
    let mut found = ide::completions(view.database(), place.position(), trigger, speed);
    found.retain(|item| {
        let path = |file: FileId| view.database().path(file);
        item.imports.is_none_or(|imported| view.workspace.may_import(path(place.file), path(imported)))
    });
    Some(list(view, place.document, found))
}

/// The protocol does not distinguish a letter from a request of the user. The first request after a letter, at that letter,
/// is the editor's own.
fn trigger(view: &View, params: &CompletionParams) -> ide::CompletionTrigger {
    let at = &params.text_document_position;
    let is_first_after_letter = view.is_first_completion_after_typing(at);
    let context = params.context.as_ref();
    let character = context.and_then(|context| context.trigger_character.as_ref()?.chars().next());
    match (context.map(|context| context.trigger_kind), character) {
        (Some(CompletionTriggerKind::TRIGGER_CHARACTER), Some(character)) => {
            ide::CompletionTrigger::Character(character)
        }
        (Some(CompletionTriggerKind::TRIGGER_FOR_INCOMPLETE_COMPLETIONS), _) => {
            ide::CompletionTrigger::Letter
        }
        _ if is_first_after_letter => ide::CompletionTrigger::Letter,
        _ => ide::CompletionTrigger::Invoked,
    }
}

/// The list is incomplete, so that editors request it again after each character. A list that they filter themselves
/// would still show a word that is complete, and Enter would accept it instead of starting a new line.
fn list(view: &View, document: Document<'_>, found: Vec<ide::Completion>) -> CompletionResponse {
    let items = found.into_iter().zip(0..);
    let items = items.map(|(completion, at)| convert(view, document, completion, at)).collect();
    CompletionResponse::List(CompletionList { is_incomplete: true, items })
}

/// `completionItem/resolve`: adds the documentation.
pub(crate) fn resolve(view: &View, item: &CompletionItem) -> Result<CompletionItem> {
    let item = item.clone();
    let Some(data) = &item.data else { return Ok(item) };
    let of: CompletionOf = serde_json::from_value(data.clone())
        .map_err(|error| Error::invalid_params(format!("not a completion of this server: {error}")))?;
    // The entity may be gone.
    let text = view.database().file(&of.home).and_then(|home| {
        ide::completion_documentation(view.database(), home, of.kind, &of.name.as_str().into())
    });
    Ok(CompletionItem { documentation: text.and_then(|text| documentation(view, text)), ..item })
}

/// `at` is its index in the list, which clients would otherwise sort by label.
fn convert(view: &View, document: Document<'_>, completion: ide::Completion, at: usize) -> CompletionItem {
    let is_snippet = completion.is_snippet && view.client.snippets;
    let new_text = if is_snippet { completion.insert.clone() } else { completion.plain() };
    let range = view.range(document, completion.replace);
    let import = completion
        .import_edit
        .map(|edit| vec![TextEdit { range: view.range(document, edit.span), new_text: edit.text }]);
    let mut item = CompletionItem {
        label: completion.label,
        kind: Some(item_kind(completion.kind)),
        detail: Some(completion.detail).filter(|detail| !detail.is_empty()),
        sort_text: Some(format!("{at:04}")),
        filter_text: completion.is_escaped.then(|| format!("^{}", new_text.trim_start_matches('^'))),
        insert_text_format: is_snippet.then_some(InsertTextFormat::SNIPPET),
        text_edit: Some(CompletionTextEdit::Edit(TextEdit { range, new_text })),
        additional_text_edits: import,
        ..CompletionItem::default()
    };
    match completion.documentation {
        ide::Documentation::Text(text) => item.documentation = documentation(view, text),
        ide::Documentation::Of(home, kind) if view.client.resolve_completions => {
            let home = view.database().path(home).to_owned();
            let of = CompletionOf { home, kind, name: item.label.clone() };
            item.data = serde_json::to_value(of).ok();
        }
        ide::Documentation::Of(home, kind) if at < MAX_DOCUMENTED => {
            let name = item.label.as_str().into();
            let text = ide::completion_documentation(view.database(), home, kind, &name);
            item.documentation = text.and_then(|text| documentation(view, text));
        }
        ide::Documentation::Of(..) => {}
    }
    item
}

fn documentation(view: &View, text: String) -> Option<Documentation> {
    if text.is_empty() {
        return None;
    }
    Some(match view.client.completion_format.clone() {
        Some(kind) => Documentation::MarkupContent(MarkupContent { kind, value: text }),
        None => Documentation::String(text),
    })
}

fn item_kind(kind: ide::CompletionKind) -> CompletionItemKind {
    match kind {
        ide::CompletionKind::Keyword => CompletionItemKind::KEYWORD,
        ide::CompletionKind::Snippet => CompletionItemKind::SNIPPET,
        ide::CompletionKind::Value => CompletionItemKind::VALUE,
        ide::CompletionKind::File => CompletionItemKind::FILE,
        ide::CompletionKind::Reference(EntityKind::Wheel) => CompletionItemKind::VARIABLE,
        ide::CompletionKind::Reference(EntityKind::Sensor) | ide::CompletionKind::Setting => {
            CompletionItemKind::PROPERTY
        }
        ide::CompletionKind::Reference(EntityKind::Ip) => CompletionItemKind::CONSTANT,
        ide::CompletionKind::Reference(EntityKind::Robot) => CompletionItemKind::CLASS,
        ide::CompletionKind::Reference(EntityKind::Movement) => CompletionItemKind::FUNCTION,
        ide::CompletionKind::Reference(EntityKind::Environment) => CompletionItemKind::MODULE,
    }
}
