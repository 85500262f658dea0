//! `textDocument/prepareRename`, `textDocument/rename` and `textDocument/linkedEditingRange`.

use pydslrep_ide as ide;
use tower_lsp::jsonrpc::{Error, Result};
use tower_lsp::ls_types::{
    LinkedEditingRangeParams, LinkedEditingRanges, OneOf, PrepareRenameResponse, RenameOptions, RenameParams,
    ServerCapabilities, TextDocumentPositionParams, WorkDoneProgressOptions, WorkspaceEdit,
};

use crate::client::ClientFeatures;
use crate::handlers::{code_actions, scripts};
use crate::state::State;

/// The pattern of names: editors stop linked editing when the text no longer matches.
const NAME_PATTERN: &str = r"\^?[A-Za-z_][A-Za-z0-9_]*";

pub(crate) fn announce(server: &mut ServerCapabilities, client: &ClientFeatures) {
    let options = RenameOptions {
        prepare_provider: Some(true),
        work_done_progress_options: WorkDoneProgressOptions::default(),
    };
    server.rename_provider =
        Some(if client.prepare_rename { OneOf::Right(options) } else { OneOf::Left(true) });
}

/// The name that a rename would change.
///
/// # Errors
///
/// If there is none, or it cannot be renamed; the message is the reason.
pub(crate) fn prepare(
    state: &State,
    params: &TextDocumentPositionParams,
) -> Result<Option<PrepareRenameResponse>> {
    let Some(place) = state.place(params) else { return Ok(None) };
    let target = ide::prepare_rename(state.database(), place.position()).map_err(refused)?;
    Ok(Some(PrepareRenameResponse::RangeWithPlaceholder {
        range: state.range(place.document, target.span),
        placeholder: target.text,
    }))
}

/// The edits of a rename, in all documents.
///
/// # Errors
///
/// If it is refused; the message is the reason.
pub(crate) fn rename(state: &mut State, params: &RenameParams) -> Result<Option<WorkspaceEdit>> {
    let state = &*state;
    let Some(place) = state.place(&params.text_document_position) else { return Ok(None) };
    let edits = ide::rename(state.database(), place.position(), &params.new_name).map_err(refused)?;
    Ok(Some(code_actions::workspace_edit(state, &edits)))
}

/// The ranges that are edited together with the name at a position.
pub(crate) fn linked_editing_ranges(
    state: &State,
    params: &LinkedEditingRangeParams,
) -> Option<LinkedEditingRanges> {
    let place = state.place(&params.text_document_position_params)?;
    let spans = ide::linked_editing_ranges(state.database(), place.position());
    let ranges: Vec<_> = spans.into_iter().map(|span| state.range(place.document, span)).collect();
    let word_pattern = Some(NAME_PATTERN.to_owned());
    (!ranges.is_empty()).then_some(LinkedEditingRanges { ranges, word_pattern })
}

fn refused(refusal: ide::RenameError) -> Error {
    match refusal {
        ide::RenameError::Invalid(reason) => Error::invalid_params(reason),
        ide::RenameError::Impossible(reason) => scripts::failure(reason),
    }
}
