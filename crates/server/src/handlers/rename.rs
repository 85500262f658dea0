//! `textDocument/prepareRename`, `textDocument/rename` and `textDocument/linkedEditingRange`.

use pydslrep_ide as ide;
use pydslrep_scene::ENDING;
use tower_lsp::jsonrpc::{Error, Result};
use tower_lsp::ls_types::{
    LinkedEditingRangeParams, LinkedEditingRanges, OneOf, PrepareRenameResponse, RenameOptions, RenameParams,
    ServerCapabilities, TextDocumentPositionParams, Uri, WorkDoneProgressOptions, WorkspaceEdit,
};

use crate::client::ClientFeatures;
use crate::documents::{Document, uri_of};
use crate::edits::Edits;
use crate::handlers::scripts;
use crate::view::{Named, View};

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
    view: &View,
    params: &TextDocumentPositionParams,
) -> Result<Option<PrepareRenameResponse>> {
    let Some(named) = renamed_at(view, params)? else { return Ok(None) };
    let target = ide::prepare_rename(view.database(), named.position).map_err(refused)?;
    Ok(Some(PrepareRenameResponse::RangeWithPlaceholder {
        range: view.range(named.document, named.span.unwrap_or(target.span)),
        placeholder: target.text,
    }))
}

/// The edits of a rename, in all documents, and the rename of the scene that an environment has.
///
/// # Errors
///
/// If it is refused; the message is the reason.
pub(crate) fn rename(view: &View, params: &RenameParams) -> Result<Option<WorkspaceEdit>> {
    let Some(named) = renamed_at(view, &params.text_document_position)? else { return Ok(None) };
    let (database, new) = (view.database(), &params.new_name);
    let edits = ide::rename(database, named.position, new).map_err(refused)?;
    let in_scenes = ide::rename_in_scenes(database, named.position, new).map_err(refused)?;
    let mut all = Edits::of_programs(view, &edits);
    for (place, text) in in_scenes.edits {
        if let Some(document) = view.scene_document(place.program, &place.environment) {
            all.add(view, document, place.span, text);
        }
    }
    if let Some((place, name)) = &in_scenes.renamed {
        all.renamed = moved_scene(view, place, name)?;
    }
    Ok(Some(all.finish(view)))
}

/// The name that is to be renamed. The table of robots in a scene stands for its environment, but has another name.
///
/// # Errors
///
/// In a scene, where there is no name of a program.
fn renamed_at<'a>(view: &'a View, at: &TextDocumentPositionParams) -> Result<Option<Named<'a>>> {
    let named = view.named(at);
    let is_scene = |document| view.environment_of_scene(document).is_some();
    if !view.document(&at.text_document.uri).is_some_and(is_scene) {
        return Ok(named);
    }
    let is_name =
        |named: &Named<'_>| named.span.is_some_and(|span| span.slice(named.document.text) != "robots");
    named
        .filter(is_name)
        .map(Some)
        .ok_or_else(|| scripts::failure("there is no name to rename here".to_owned()))
}

/// Where the scene of an environment goes when that gets another name; `None` if it stays, because another program has
/// it, too, and there is one of the new name.
///
/// # Errors
///
/// If it cannot go there.
fn moved_scene(view: &View, place: &ide::ScenePlace, name: &str) -> Result<Option<(Uri, Uri)>> {
    let workspace = &view.workspace;
    let keys =
        workspace.scene_key(place.program, &place.environment).zip(workspace.scene_key(place.program, name));
    let Some((old, new)) = keys else { return Ok(None) };
    let (old_name, new_name) = (format!("{}{ENDING}", place.environment), format!("{name}{ENDING}"));
    let is_taken = workspace.document(&new).is_some() || workspace.is_file(&new);
    if workspace.is_shared_scene(&old) {
        if is_taken {
            return Ok(None);
        }
        return Err(scripts::failure(format!(
            "`{old_name}` is the scene of another program, too: copy it to `{new_name}` first"
        )));
    }
    if is_taken {
        return Err(scripts::failure(format!("there is already a file `{new_name}`")));
    }
    if !view.client.rename_files {
        return Err(scripts::failure(format!(
            "this editor cannot rename the environment's scene with it: rename `{old_name}` to `{new_name}` first"
        )));
    }
    let old = view.document_at(&old).and_then(Document::uri);
    Ok(old.zip(uri_of(&new)))
}

/// The ranges that are edited together with the name at a position.
pub(crate) fn linked_editing_ranges(
    view: &View,
    params: &LinkedEditingRangeParams,
) -> Option<LinkedEditingRanges> {
    let place = view.place(&params.text_document_position_params)?;
    let spans = ide::linked_editing_ranges(view.database(), place.position());
    let ranges: Vec<_> = spans.into_iter().map(|span| view.range(place.document, span)).collect();
    let word_pattern = Some(NAME_PATTERN.to_owned());
    (!ranges.is_empty()).then_some(LinkedEditingRanges { ranges, word_pattern })
}

fn refused(refusal: ide::RenameError) -> Error {
    match refusal {
        ide::RenameError::Invalid(reason) => Error::invalid_params(reason),
        ide::RenameError::Impossible(reason) => scripts::failure(reason),
    }
}
