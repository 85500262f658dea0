//! `textDocument/completion`.

use pydslrep_ide as ide;
use pydslrep_syntax::EntityKind;
use tower_lsp::ls_types::{
    CompletionItem, CompletionItemKind, CompletionList, CompletionParams, CompletionResponse,
    CompletionTextEdit, Documentation, InsertTextFormat, MarkupContent, TextEdit,
};

use crate::documents::Document;
use crate::state::{Place, State};

/// No more are sent at once: a long answer freezes the client. It asks again when more is typed.
const MOST: usize = 500;

/// What the grammar allows at a position, and which names make sense there; in a settings file, which settings.
pub(crate) fn completion(state: &State, params: &CompletionParams) -> Option<CompletionResponse> {
    let at = &params.text_document_position;
    if let Some((document, text)) = state.settings_text(&at.text_document.uri) {
        let found = ide::settings_completions(&text, state.offset(document, at.position));
        return Some(list(state, document, found, false));
    }
    let place = state.place(at)?;
    let mut found =
        ide::completions(&state.database, place.position(), place.document.settings.default_speed);
    let is_incomplete = found.len() > MOST;
    if is_incomplete {
        keep_the_likeliest(&place, &mut found);
    }
    Some(list(state, place.document, found, is_incomplete))
}

fn list(
    state: &State,
    document: &Document,
    found: Vec<ide::Completion>,
    is_incomplete: bool,
) -> CompletionResponse {
    let items =
        found.into_iter().zip(0..).map(|(completion, at)| convert(state, document, completion, at)).collect();
    CompletionResponse::List(CompletionList { is_incomplete, items })
}

/// Those that begin as what is typed already, then the first in order.
fn keep_the_likeliest(place: &Place<'_>, found: &mut Vec<ide::Completion>) {
    let Some(first) = found.first() else { return };
    let start = first.replace.start as usize;
    let typed = place.document.text.get_byte_slice(start..(place.offset as usize).max(start));
    let typed = typed.map(|text| text.to_string().to_lowercase()).unwrap_or_default();
    found.sort_by_key(|completion| !completion.label.to_lowercase().starts_with(&typed));
    found.truncate(MOST);
}

/// `at` is its place in the list, which clients would otherwise order by label.
fn convert(state: &State, document: &Document, completion: ide::Completion, at: usize) -> CompletionItem {
    let is_snippet = completion.is_snippet && state.client.snippets;
    let new_text = if completion.is_snippet && !is_snippet {
        without_places(&completion.insert)
    } else {
        completion.insert
    };
    let range = state.range(document, completion.replace);
    let documentation = Some(completion.documentation).filter(|text| !text.is_empty());
    let documentation = documentation.map(|value| match state.client.completion_format.clone() {
        Some(kind) => Documentation::MarkupContent(MarkupContent { kind, value }),
        None => Documentation::String(value),
    });
    CompletionItem {
        label: completion.label,
        kind: Some(item_kind(completion.kind)),
        detail: Some(completion.detail).filter(|detail| !detail.is_empty()),
        documentation,
        sort_text: Some(format!("{at:04}")),
        insert_text_format: is_snippet.then_some(InsertTextFormat::SNIPPET),
        text_edit: Some(CompletionTextEdit::Edit(TextEdit { range, new_text })),
        ..CompletionItem::default()
    }
}

fn item_kind(kind: ide::CompletionKind) -> CompletionItemKind {
    match kind {
        ide::CompletionKind::Keyword => CompletionItemKind::KEYWORD,
        ide::CompletionKind::Snippet => CompletionItemKind::SNIPPET,
        ide::CompletionKind::Value => CompletionItemKind::VALUE,
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

/// A snippet as plain text: `${1:name}` becomes `name`, `$0` nothing.
fn without_places(snippet: &str) -> String {
    let mut plain = String::with_capacity(snippet.len());
    let mut depth = 0_u32;
    let mut characters = snippet.chars().peekable();
    while let Some(character) = characters.next() {
        match character {
            '\\' => plain.extend(characters.next()),
            '$' => {
                let braced = characters.next_if_eq(&'{').is_some();
                while characters.next_if(char::is_ascii_digit).is_some() {}
                if braced {
                    characters.next_if_eq(&':');
                    depth += 1;
                }
            }
            '}' if depth > 0 => depth -= 1,
            other => plain.push(other),
        }
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn snippets_become_plain_text() {
        assert_eq!(without_places("wheel ${1:name} with radius ${2:4.5}$0"), "wheel name with radius 4.5");
        assert_eq!(without_places("{ $1 } ${2:a ${3:b}} \\$ \\}"), "{  } a b $ }");
        assert_eq!(without_places("movement ${1} {\n  $0\n}"), "movement  {\n  \n}");
    }
}
