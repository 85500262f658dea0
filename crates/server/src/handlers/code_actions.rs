//! Code actions: quick fixes of diagnostics, then refactorings, then actions on the whole file, of which the last is
//! **Generate script** for every environment.

mod rewriting;

use pydslrep_analysis as analysis;
use pydslrep_analysis::FileId;
use pydslrep_ide as ide;
use pydslrep_output::WriteError;
use pydslrep_scene::ENDING;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use tower_lsp::jsonrpc::{Error, Result};
use tower_lsp::ls_types::{
    CodeAction, CodeActionDisabled, CodeActionKind, CodeActionOptions, CodeActionOrCommand, CodeActionParams,
    CodeActionResponse, CodeActionTriggerKind, Command, Diagnostic, ServerCapabilities,
    TextDocumentPositionParams, Uri, WorkspaceEdit,
};
#[cfg(feature = "process")]
use tower_lsp::ls_types::{
    CodeActionContext, Location, PartialResultParams, TextDocumentIdentifier, WorkDoneProgressParams,
};

use self::rewriting::FixAllOf;
use crate::chosen::ChosenEnvironment;
use crate::client::ClientFeatures;
use crate::documents::{Document, uri_of};
use crate::edits::{self, Edits};
use crate::handlers::diagnostics;
use crate::handlers::scripts::{self, Script};
use crate::state::State;
use crate::view::View;

/// The kind of actions that create a scene or add to one.
pub(crate) const SCENE_KIND: CodeActionKind = CodeActionKind::new("scene");

/// The kind of the action that generates a script; editors may run it on save.
pub(crate) const GENERATE_SCRIPT_KIND: CodeActionKind = CodeActionKind::new("source.generateScript");

/// The kind of the same action in a menu about the environment at the cursor: menus of some editors leave out what is
/// about the whole file.
const SCRIPT_HERE_KIND: CodeActionKind = CodeActionKind::new("script");

/// Its command, where the client cannot create files.
pub(crate) const GENERATE_SCRIPT: &str = "pydslrep.generateScript";

/// The command that writes the package that a script imports, where the client has created the script.
pub(crate) const WRITE_RUNTIME: &str = "pydslrep.writeRuntime";

/// The data of an action until it is chosen.
#[derive(Debug, Serialize, Deserialize)]
#[serde(tag = "edit", rename_all = "kebab-case")]
enum ActionData {
    FixAll(FixAllOf),
    /// Creates or replaces the script of an environment.
    Script(ChosenEnvironment),
}

impl ActionData {
    fn program(&self) -> &Uri {
        match self {
            Self::FixAll(which) => &which.uri,
            Self::Script(which) => &which.uri,
        }
    }

    fn encoded(&self) -> Option<Value> {
        serde_json::to_value(self).ok()
    }
}

pub(crate) fn announce(server: &mut ServerCapabilities, client: &ClientFeatures) {
    let kinds = vec![
        CodeActionKind::QUICKFIX,
        CodeActionKind::REFACTOR_EXTRACT,
        CodeActionKind::REFACTOR_INLINE,
        CodeActionKind::REFACTOR_REWRITE,
        SCENE_KIND,
        CodeActionKind::SOURCE_FIX_ALL,
        GENERATE_SCRIPT_KIND,
        SCRIPT_HERE_KIND,
    ];
    let options = CodeActionOptions {
        code_action_kinds: Some(kinds),
        resolve_provider: Some(client.resolve_edits),
        ..CodeActionOptions::default()
    };
    server.code_action_provider = Some(options.into());
}

/// Records the cursor: requests that the editor sends by itself are about the cursor's line.
pub(crate) fn note_cursor(state: &mut State, params: &CodeActionParams) {
    let cursor = TextDocumentPositionParams::new(params.text_document.clone(), params.range.end);
    state.note_cursor(&cursor);
    if params.context.trigger_kind == Some(CodeActionTriggerKind::AUTOMATIC) {
        state.cursor_is_at(&params.text_document.uri, params.range);
    }
}

/// `textDocument/codeAction`.
pub(crate) fn code_actions(view: &View, params: &CodeActionParams) -> Option<CodeActionResponse> {
    let wanted = |kind: &CodeActionKind| {
        params.context.only.as_ref().is_none_or(|only| only.iter().any(|wish| covers(wish, kind)))
    };
    if let Some((document, file, text)) = view.toml_text(&params.text_document.uri) {
        let is_wanted = wanted(&CodeActionKind::QUICKFIX) && view.client.action_literals;
        let fixes = || ide::toml_fixes(file, &text, view.span(document, params.range));
        return Some(if is_wanted { key_fixes(view, document, fixes(), params) } else { Vec::new() });
    }
    let (document, file) = view.analysed(&params.text_document.uri)?;
    let mut actions = Vec::new();
    if wanted(&CodeActionKind::QUICKFIX) && view.client.action_literals {
        actions.extend(quick_fixes(view, document, file, params));
        actions.extend(rewriting::fix_all_of_a_code(view, document, file, params));
    }
    if view.client.action_literals {
        actions.extend(rewriting::refactorings(view, document, file, params, wanted));
    }
    if wanted(&CodeActionKind::SOURCE_FIX_ALL) && view.client.action_literals {
        actions.extend(rewriting::fix_all(view, document, file));
    }
    if wanted(&GENERATE_SCRIPT_KIND) {
        actions.extend(script_actions(view, document, file, params));
    }
    if wanted(&SCENE_KIND) && view.client.action_literals {
        actions.extend(scene_actions(view, document, file, params));
    }
    Some(actions)
}

/// The edit of the quick fix with a title at a location.
#[cfg(feature = "process")]
pub(crate) fn quick_fix(view: &View, location: &Location, title: &str) -> Option<WorkspaceEdit> {
    let params = CodeActionParams {
        text_document: TextDocumentIdentifier { uri: location.uri.clone() },
        range: location.range,
        context: CodeActionContext {
            only: Some(vec![CodeActionKind::QUICKFIX]),
            ..CodeActionContext::default()
        },
        work_done_progress_params: WorkDoneProgressParams::default(),
        partial_result_params: PartialResultParams::default(),
    };
    let is_it = |action: CodeActionOrCommand| match action {
        CodeActionOrCommand::CodeAction(action) if action.title == title => action.edit,
        _ => None,
    };
    code_actions(view, &params)?.into_iter().find_map(is_it)
}

/// A title with a capital, as in editors: the crates below write them for the middle of a sentence, as in a terminal.
pub(crate) fn sentence(title: &str) -> String {
    let mut characters = title.chars();
    characters.next().map_or_else(String::new, |first| first.to_uppercase().chain(characters).collect())
}

/// Kinds are paths: `source` includes `source.generateScript`, and the empty kind includes everything.
fn covers(wish: &CodeActionKind, kind: &CodeActionKind) -> bool {
    let rest = kind.as_str().strip_prefix(wish.as_str());
    rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.') || wish.as_str().is_empty())
}

/// The fixes of every diagnostic that touches the range.
fn quick_fixes(
    view: &View,
    document: Document<'_>,
    file: FileId,
    params: &CodeActionParams,
) -> Vec<CodeActionOrCommand> {
    let range = view.span(document, params.range);
    let fixes = ide::quick_fixes(view.database(), file, range).into_iter().filter_map(|found| {
        let shown = diagnostics::convert(view, document, &found.diagnostic)?;
        Some(CodeActionOrCommand::CodeAction(CodeAction {
            title: sentence(&found.fix.title),
            kind: Some(CodeActionKind::QUICKFIX),
            diagnostics: Some(vec![as_the_client_has_it(&params.context.diagnostics, shown)]),
            edit: Some(workspace_edit(view, &found.fix.edits)),
            is_preferred: found.is_preferred.then_some(true),
            ..CodeAction::default()
        }))
    });
    fixes.collect()
}

/// The fixes of the problems of a settings file or a scene in the range.
fn key_fixes(
    view: &View,
    document: Document<'_>,
    found: Vec<ide::KeyFix>,
    params: &CodeActionParams,
) -> Vec<CodeActionOrCommand> {
    let action = |fix: ide::KeyFix| {
        let mut edits = Edits::of_programs(view, &fix.program);
        for (span, text) in fix.edits {
            edits.add(view, document, span, text);
        }
        let shown = diagnostics::convert_problem(view, document, fix.problem);
        CodeAction {
            title: sentence(&fix.title),
            kind: Some(CodeActionKind::QUICKFIX),
            diagnostics: Some(vec![as_the_client_has_it(&params.context.diagnostics, shown)]),
            edit: Some(edits.finish(view)),
            ..CodeAction::default()
        }
    };
    found.into_iter().map(|fix| action(fix).into()).collect()
}

/// Creates the scenes of the declaration at the cursor, or adds what they lack.
fn scene_actions(
    view: &View,
    document: Document<'_>,
    file: FileId,
    params: &CodeActionParams,
) -> Vec<CodeActionOrCommand> {
    let offset = view.offset(document, params.range.end);
    let offers = ide::scene_actions(view.database(), ide::FilePosition { file, offset });
    offers.into_iter().filter_map(|offer| scene_action(view, offer)).map(Into::into).collect()
}

/// `None` where there is no place for the scene, or this client cannot create it.
fn scene_action(view: &View, offer: ide::SceneAction) -> Option<CodeAction> {
    let ide::SceneAction { program, environment, added, span, text } = offer;
    let file_name = format!("{environment}{ENDING}");
    let (title, edit) = if let Some(span) = span {
        let mut edits = Edits::default();
        edits.add(view, view.scene_document(program, &environment)?, span, text);
        (format!("Add {} to {file_name}", added.join(", ")), edits.finish(view))
    } else {
        let key = view.workspace.scene_key(program, &environment)?;
        // A file that cannot be read is not replaced.
        if !view.client.create_files || view.workspace.is_file(&key) {
            return None;
        }
        (format!("Create scene {file_name}"), edits::new_file(uri_of(&key)?, text))
    };
    Some(CodeAction { title, kind: Some(SCENE_KIND), edit: Some(edit), ..CodeAction::default() })
}

/// Clients find the diagnostic an action belongs to by comparing: their own copy is the one that matches.
fn as_the_client_has_it(theirs: &[Diagnostic], ours: Diagnostic) -> Diagnostic {
    let same = |their: &&Diagnostic| their.range == ours.range && their.code == ours.code;
    theirs.iter().find(same).cloned().unwrap_or(ours)
}

/// Edits of programs, in the best form that this client supports.
pub(crate) fn workspace_edit(view: &View, edits: &[analysis::Edit]) -> WorkspaceEdit {
    Edits::of_programs(view, edits).finish(view)
}

/// **Generate script** for every environment of the document.
fn script_actions(
    view: &View,
    document: Document<'_>,
    file: FileId,
    params: &CodeActionParams,
) -> Vec<CodeActionOrCommand> {
    let Some(uri) = document.uri() else { return Vec::new() };
    let environments = view.database().environments(file);
    let scripts = scripts::of_environments(view, &uri, environments.iter().map(|(id, _)| *id));
    let cursor = view.database().entity_at(file, view.offset(document, params.range.end));
    let named = environments.iter().zip(scripts);
    let actions = named.filter_map(|((id, name), script)| {
        let is_here = cursor.is_some_and(|cursor| cursor.id == *id);
        let kind =
            if is_here && params.context.only.is_none() { SCRIPT_HERE_KIND } else { GENERATE_SCRIPT_KIND };
        script_action(view, &uri, &name.text, script, kind)
    });
    actions.collect()
}

fn script_action(
    view: &View,
    uri: &Uri,
    name: &str,
    script: Result<Script>,
    kind: CodeActionKind,
) -> Option<CodeActionOrCommand> {
    let script = match script {
        Ok(script) => script,
        Err(error) => return disabled(view, name, error.message.into_owned(), kind),
    };
    let title = format!("Generate script {}", script.file_name());
    let which = ChosenEnvironment { uri: uri.clone(), environment: name.to_owned() };
    let argument = serde_json::to_value(&which).ok()?;
    let client = &view.client;
    if !client.action_literals {
        return Some(Command::new(title, GENERATE_SCRIPT.to_owned(), Some(vec![argument])).into());
    }
    let obstacle = script.obstacle();
    // The command asks; an edit would just replace it.
    let must_ask = matches!(obstacle, Some(WriteError::Changed(_)));
    if let (Some(error), false) = (&obstacle, must_ask) {
        return disabled(view, name, scripts::reason(error), kind);
    }
    let mut action = CodeAction { title, kind: Some(kind), ..CodeAction::default() };
    if must_ask || !client.create_files {
        let title = action.title.clone();
        action.command = Some(Command::new(title, GENERATE_SCRIPT.to_owned(), Some(vec![argument])));
        return Some(action.into());
    }
    if script.runtime_folder().is_some() {
        // Clients execute it after the edit.
        let title = "Write the package that scripts import".to_owned();
        action.command = Some(Command::new(title, WRITE_RUNTIME.to_owned(), Some(vec![argument.clone()])));
    }
    if client.resolve_edits {
        action.data = ActionData::Script(which).encoded();
    } else {
        action.edit = Some(scripts::edit(&script));
    }
    Some(action.into())
}

/// A disabled action with the reason why there is no script; nothing where the client does not show those.
fn disabled(view: &View, name: &str, reason: String, kind: CodeActionKind) -> Option<CodeActionOrCommand> {
    view.client.disabled_actions.then(|| {
        let (title, disabled) = (format!("Generate script of {name}"), Some(CodeActionDisabled { reason }));
        CodeAction { title, kind: Some(kind), disabled, ..CodeAction::default() }.into()
    })
}

/// Returns whether finding the edit of an action may take long.
pub(crate) fn is_long(view: &View, action: &CodeAction) -> bool {
    let data = action.data.as_ref().and_then(|data| ActionData::deserialize(data).ok());
    data.is_some_and(|data| view.is_long(data.program()))
}

/// `codeAction/resolve`: finds the edit of an action that was chosen.
pub(crate) fn resolve(view: &View, action: &CodeAction) -> Result<CodeAction> {
    let action = action.clone();
    let Some(data) = &action.data else { return Ok(action) };
    let data = ActionData::deserialize(data)
        .map_err(|error| Error::invalid_params(format!("not an action of this server: {error}")))?;
    let edit = match data {
        ActionData::FixAll(which) => workspace_edit(view, &rewriting::edits(view, &which)),
        ActionData::Script(which) => {
            let script = scripts::generate(view, &which)?;
            if let Some(error) = script.obstacle() {
                return Err(scripts::failure(scripts::reason(&error)));
            }
            scripts::edit(&script)
        }
    };
    Ok(CodeAction { edit: Some(edit), ..action })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_cover_what_is_below_them() {
        let covers = |wish: &'static str| covers(&CodeActionKind::new(wish), &GENERATE_SCRIPT_KIND);
        assert!(covers("") && covers("source") && covers("source.generateScript"));
        assert!(!covers("sour") && !covers("source.generate") && !covers("quickfix"));
        assert!(!covers("source.generateScript.more"));
    }
}
