//! Refactorings, and fixing many problems at once.

use pydslrep_analysis::{Database, Diagnostic, Edit, FileId};
use pydslrep_ide as ide;
use serde::{Deserialize, Serialize};
use tower_lsp::ls_types::{
    CodeAction, CodeActionDisabled, CodeActionKind, CodeActionOrCommand, CodeActionParams, Uri,
};

use super::{ActionData, sentence, workspace_edit};
use crate::documents::Document;
use crate::view::View;

/// The problems to fix.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct FixAllOf {
    /// The program.
    pub(crate) uri: Uri,
    /// The code of the problems; all codes where it is `None`.
    code: Option<String>,
}

/// Every refactoring that applies to the selection; if the client shows them, also those that cannot be done, with the
/// reason.
pub(super) fn refactorings(
    view: &View,
    document: Document<'_>,
    file: FileId,
    params: &CodeActionParams,
    wanted: impl Fn(&CodeActionKind) -> bool,
) -> Vec<CodeActionOrCommand> {
    let offers = ide::refactorings(view.database(), file, view.span(document, params.range));
    let action = |offer: ide::Refactoring| {
        let kind = kind(offer.kind);
        if !wanted(&kind) {
            return None;
        }
        let action = CodeAction { title: sentence(&offer.title), kind: Some(kind), ..CodeAction::default() };
        Some(match offer.edits {
            Ok(edits) => CodeAction { edit: Some(workspace_edit(view, &edits)), ..action },
            Err(reason) if view.client.disabled_actions => {
                CodeAction { disabled: Some(CodeActionDisabled { reason }), ..action }
            }
            Err(_) => return None,
        })
    };
    offers.into_iter().filter_map(action).map(Into::into).collect()
}

fn kind(kind: ide::RefactoringKind) -> CodeActionKind {
    match kind {
        ide::RefactoringKind::Extract => CodeActionKind::REFACTOR_EXTRACT,
        ide::RefactoringKind::Inline => CodeActionKind::REFACTOR_INLINE,
        ide::RefactoringKind::Rewrite => CodeActionKind::REFACTOR_REWRITE,
    }
}

/// "Fix all … problems" for each code in the range that occurs more than once.
pub(super) fn fix_all_of_a_code(
    view: &View,
    document: Document<'_>,
    file: FileId,
    params: &CodeActionParams,
) -> Vec<CodeActionOrCommand> {
    let range = view.span(document, params.range);
    let mut shown = shown(view.database(), document, file);
    shown.retain(|problem| problem.span.start <= range.end && range.start <= problem.span.end);
    let codes = ide::codes_to_fix_all(view.database(), file, &shown).into_iter();
    let action = |code: &str| {
        let title = format!("Fix all `{code}` problems");
        offer(view, document, title, CodeActionKind::QUICKFIX, Some(code))
    };
    codes.filter_map(action).collect()
}

/// `source.fixAll`, where there is anything to fix.
pub(super) fn fix_all(view: &View, document: Document<'_>, file: FileId) -> Option<CodeActionOrCommand> {
    let any = shown(view.database(), document, file).iter().any(ide::has_safe_fix);
    let title = "Apply all safe fixes".to_owned();
    any.then(|| offer(view, document, title, CodeActionKind::SOURCE_FIX_ALL, None))?
}

/// The problems that are not switched off.
fn shown(database: &Database, document: Document<'_>, file: FileId) -> Vec<Diagnostic> {
    let mut problems = database.diagnostics(file);
    problems.retain(|problem| is_shown(document, problem));
    problems
}

fn is_shown(document: Document<'_>, problem: &Diagnostic) -> bool {
    document.settings.severities.severity(problem.code(), problem.severity).is_some()
}

fn offer(
    view: &View,
    document: Document<'_>,
    title: String,
    kind: CodeActionKind,
    code: Option<&str>,
) -> Option<CodeActionOrCommand> {
    let action = CodeAction { title, kind: Some(kind), ..CodeAction::default() };
    let which = FixAllOf { uri: document.uri()?, code: code.map(str::to_owned) };
    if view.client.resolve_edits {
        // Computing the edits means trying them.
        return Some(CodeAction { data: ActionData::FixAll(which).encoded(), ..action }.into());
    }
    Some(CodeAction { edit: Some(workspace_edit(view, &edits(view, &which))), ..action }.into())
}

/// The edits of these fixes, in the current text.
pub(super) fn edits(view: &View, which: &FixAllOf) -> Vec<Edit> {
    let Some((document, file)) = view.analysed(&which.uri) else { return Vec::new() };
    let is_meant = |problem: &Diagnostic| {
        is_shown(document, problem) && which.code.as_ref().is_none_or(|code| code == problem.code())
    };
    ide::fix_all(view.database(), file, is_meant)
}
