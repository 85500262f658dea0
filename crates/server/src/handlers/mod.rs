//! Everything a client can send: the table of all methods, and one file per group of them with their handlers. A handler
//! is a plain function of the state and the parameters; what it returns is the answer.
//!
//! A new request is a handler in its file and a row here. The row's kind says where the handler runs and what it may do,
//! see [`dispatch`](crate::dispatch); `announced` adds the capability, where clients do not send the message anyway.

pub(crate) mod call_hierarchy;
pub(crate) mod code_actions;
pub(crate) mod code_lenses;
pub(crate) mod commands;
pub(crate) mod completion;
pub(crate) mod diagnostics;
pub(crate) mod document_links;
pub(crate) mod document_symbols;
pub(crate) mod driven_path;
pub(crate) mod explain;
pub(crate) mod file_operations;
pub(crate) mod folding;
pub(crate) mod formatting;
pub(crate) mod hover;
pub(crate) mod inlay_hints;
pub(crate) mod navigation;
pub(crate) mod planned_action;
pub(crate) mod planned_path;
#[cfg(feature = "process")]
pub(crate) mod preview;
pub(crate) mod provided_files;
pub(crate) mod references;
pub(crate) mod rename;
#[cfg(feature = "process")]
pub(crate) mod runs;
pub(crate) mod scripts;
pub(crate) mod selection;
pub(crate) mod semantic_tokens;
pub(crate) mod settings;
pub(crate) mod signature;
pub(crate) mod synchronization;
pub(crate) mod workspace;
pub(crate) mod workspace_diagnostics;
pub(crate) mod workspace_symbols;

use tower_lsp::ls_types::notification::{
    Cancel, DidChangeConfiguration, DidChangeTextDocument, DidChangeWatchedFiles, DidChangeWorkspaceFolders,
    DidCloseTextDocument, DidCreateFiles, DidDeleteFiles, DidOpenTextDocument, DidRenameFiles,
    DidSaveTextDocument, Exit, Initialized, SetTrace, WorkDoneProgressCancel,
};
use tower_lsp::ls_types::request::{
    CallHierarchyIncomingCalls, CallHierarchyOutgoingCalls, CallHierarchyPrepare, CodeActionRequest,
    CodeActionResolveRequest, CodeLensRequest, CodeLensResolve, Completion, DocumentDiagnosticRequest,
    DocumentHighlightRequest, DocumentLinkRequest, DocumentSymbolRequest, ExecuteCommand,
    FoldingRangeRequest, Formatting, GotoDeclaration, GotoDefinition, GotoTypeDefinition, HoverRequest,
    Initialize, InlayHintRequest, LinkedEditingRange, OnTypeFormatting, PrepareRenameRequest,
    RangeFormatting, References, Rename, ResolveCompletionItem, SelectionRangeRequest,
    SemanticTokensFullDeltaRequest, SemanticTokensFullRequest, SemanticTokensRangeRequest, Shutdown,
    SignatureHelpRequest, WillRenameFiles, WorkspaceDiagnosticRequest, WorkspaceSymbolRequest,
};
use tower_lsp::ls_types::{
    CodeLensOptions, DeclarationCapability, DocumentLinkOptions, LinkedEditingRangeServerCapabilities, OneOf,
    WorkDoneProgressOptions,
};

use self::driven_path::DrivenPath;
use self::explain::Explain;
use self::planned_action::{ActionLocation, PlannedAt};
use self::planned_path::PlannedPath;
use self::provided_files::ProvidedFiles;
use self::scripts::GeneratedScript;
use crate::dispatch::{
    Table, change, follow, framework_notification, framework_request, interrupt, read, read_file, run,
};
use crate::page::Audience;
use crate::server::{Server, Stage};
use crate::state::State;

/// All methods.
pub(crate) fn table() -> Table {
    let mut table = Table::default();
    sessions(&mut table);
    documents(&mut table);
    workspaces(&mut table);
    problems_and_actions(&mut table);
    typing(&mut table);
    reading(&mut table);
    navigation(&mut table);
    editing(&mut table);
    paths(&mut table);
    table
}

fn sessions(table: &mut Table) {
    table.add(framework_request::<Initialize>(&[Stage::Starting, Stage::Serving]));
    table.add(follow::<Initialized, _>(workspace::start));
    table.add(change::<SetTrace>(synchronization::set_trace));
    table.add(interrupt::<Cancel>(|server, params| server.pending.cancel(&params.id.clone().into())));
    table.add(interrupt::<WorkDoneProgressCancel>(Server::cancel_progress));
    table.add(framework_request::<Shutdown>(&[Stage::Serving]));
    table.add(framework_notification::<Exit>(&[Stage::Starting, Stage::Serving, Stage::ShutDown]));
}

fn documents(table: &mut Table) {
    table.add(change::<DidOpenTextDocument>(synchronization::open).announced(synchronization::announce));
    table.add(change::<DidChangeTextDocument>(synchronization::change));
    table.add(change::<DidSaveTextDocument>(synchronization::save));
    table.add(change::<DidCloseTextDocument>(synchronization::close));
}

fn workspaces(table: &mut Table) {
    table.add(
        follow::<DidChangeWorkspaceFolders, _>(workspace::folders_changed).announced(workspace::announce),
    );
    // These two are registered where the client takes registrations.
    table.add(follow::<DidChangeWatchedFiles, _>(workspace::files_changed));
    table.add(follow::<ProvidedFiles, _>(provided_files::provide));
    table.add(follow::<DidChangeConfiguration, _>(workspace::settings_changed));
    table.add(read::<WillRenameFiles, _>(file_operations::will_rename).announced(file_operations::announce));
    table.add(follow::<DidRenameFiles, _>(file_operations::did_rename));
    table.add(follow::<DidCreateFiles, _>(file_operations::did_create));
    table.add(follow::<DidDeleteFiles, _>(file_operations::did_delete));
}

fn problems_and_actions(table: &mut Table) {
    table.add(
        read::<DocumentDiagnosticRequest, _>(diagnostics::pull)
            .beside_if(diagnostics::has_many)
            .announced(diagnostics::announce),
    );
    table.add(run::<WorkspaceDiagnosticRequest, _>(workspace_diagnostics::pull_workspace));
    table.add(read::<Explain, _>(explain::explain));
    table.add(
        read::<CodeActionRequest, _>(code_actions::code_actions)
            .noting(code_actions::note_cursor)
            .beside_if(|view, params| view.is_long(&params.text_document.uri))
            .announced(code_actions::announce),
    );
    table.add(read::<CodeActionResolveRequest, _>(code_actions::resolve).beside_if(code_actions::is_long));
    table.add(run::<ExecuteCommand, _>(commands::execute).announced(commands::announce));
}

fn typing(table: &mut Table) {
    table.add(
        read::<Completion, _>(completion::completion)
            .noting(|state, params| state.note_completion(&params.text_document_position))
            .announced(completion::announce),
    );
    table.add(read::<ResolveCompletionItem, _>(completion::resolve));
    table.add(
        read::<SignatureHelpRequest, _>(signature::signature_help)
            .noting(|state, params| state.note_cursor(&params.text_document_position_params))
            .announced(signature::announce),
    );
    table.add(read::<OnTypeFormatting, _>(formatting::on_type).announced(formatting::announce_on_type));
    table.add(read::<LinkedEditingRange, _>(rename::linked_editing_ranges).announced(|server, _| {
        server.linked_editing_range_provider = Some(LinkedEditingRangeServerCapabilities::Simple(true));
    }));
}

fn reading(table: &mut Table) {
    table.add(
        read::<HoverRequest, _>(hover::hover)
            .noting(|state, params| state.note_cursor(&params.text_document_position_params))
            .announced(|server, _| server.hover_provider = Some(true.into())),
    );
    table.add(
        read::<InlayHintRequest, _>(inlay_hints::inlay_hints)
            .beside_if(|view, params| view.is_long(&params.text_document.uri))
            .announced(|server, _| server.inlay_hint_provider = Some(OneOf::Left(true))),
    );
    table.add(
        read::<CodeLensRequest, _>(code_lenses::code_lenses)
            .beside_if(|view, params| view.is_long(&params.text_document.uri))
            .announced(|server, _| {
                server.code_lens_provider = Some(CodeLensOptions { resolve_provider: Some(true) });
            }),
    );
    table.add(read::<CodeLensResolve, _>(code_lenses::resolve));
    table.add(
        read_file::<SemanticTokensFullRequest, _>(semantic_tokens::full).announced(semantic_tokens::announce),
    );
    table.add(read_file::<SemanticTokensFullDeltaRequest, _>(semantic_tokens::delta));
    table.add(
        read::<SemanticTokensRangeRequest, _>(semantic_tokens::range)
            .beside_if(|view, params| view.is_long(&params.text_document.uri)),
    );
    table.add(
        read_file::<DocumentSymbolRequest, _>(document_symbols::document_symbols)
            .announced(|server, _| server.document_symbol_provider = Some(OneOf::Left(true))),
    );
    table.add(
        read_file::<FoldingRangeRequest, _>(folding::folding_ranges)
            .announced(|server, _| server.folding_range_provider = Some(true.into())),
    );
    table.add(
        read::<SelectionRangeRequest, _>(selection::selection_ranges)
            .announced(|server, _| server.selection_range_provider = Some(true.into())),
    );
}

fn navigation(table: &mut Table) {
    table.add(
        read::<GotoDefinition, _>(navigation::definition)
            .announced(|server, _| server.definition_provider = Some(OneOf::Left(true))),
    );
    table.add(read::<GotoDeclaration, _>(navigation::declaration).announced(|server, _| {
        server.declaration_provider = Some(DeclarationCapability::Simple(true));
    }));
    table.add(
        read::<GotoTypeDefinition, _>(navigation::type_definition)
            .announced(|server, _| server.type_definition_provider = Some(true.into())),
    );
    table.add(
        read::<References, _>(references::references)
            .beside_if(|view, params| references::has_many(view, &params.text_document_position))
            .announced(|server, _| server.references_provider = Some(OneOf::Left(true))),
    );
    table.add(
        read::<DocumentHighlightRequest, _>(references::highlights)
            .noting(|state, params| state.cursor_is(&params.text_document_position_params))
            .beside_if(|view, params| references::has_many(view, &params.text_document_position_params))
            .announced(|server, _| server.document_highlight_provider = Some(OneOf::Left(true))),
    );
    table.add(
        run::<WorkspaceSymbolRequest, _>(workspace_symbols::workspace_symbols)
            .announced(|server, _| server.workspace_symbol_provider = Some(OneOf::Left(true))),
    );
    table.add(
        read::<CallHierarchyPrepare, _>(call_hierarchy::prepare)
            .announced(|server, _| server.call_hierarchy_provider = Some(true.into())),
    );
    table.add(read::<CallHierarchyIncomingCalls, _>(call_hierarchy::incoming));
    table.add(read::<CallHierarchyOutgoingCalls, _>(call_hierarchy::outgoing));
    table.add(read::<DocumentLinkRequest, _>(document_links::document_links).announced(|server, _| {
        server.document_link_provider = Some(DocumentLinkOptions {
            resolve_provider: None,
            work_done_progress_options: WorkDoneProgressOptions::default(),
        });
    }));
}

fn editing(table: &mut Table) {
    table.add(read::<PrepareRenameRequest, _>(rename::prepare).announced(rename::announce));
    table.add(
        read::<Rename, _>(rename::rename)
            .beside_if(|view, params| references::has_many(view, &params.text_document_position)),
    );
    table.add(
        read_file::<Formatting, _>(formatting::document)
            .announced(|server, _| server.document_formatting_provider = Some(OneOf::Left(true))),
    );
    table.add(
        read_file::<RangeFormatting, _>(formatting::range)
            .announced(|server, _| server.document_range_formatting_provider = Some(OneOf::Left(true))),
    );
}

/// The methods that `docs/protocol.md` adds to the protocol, for previews.
fn paths(table: &mut Table) {
    table.add(
        read::<PlannedPath, _>(|view, which| planned_path::planned_path(view, which, Audience::Client))
            .noting(|state, which| state.view.watched.watch(which, Audience::Client))
            .beside_if(|view, which| view.is_long(&which.uri)),
    );
    table.add(read::<DrivenPath, _>(|view, which| view.driven.watch(which, Audience::Client)));
    table.add(
        read::<PlannedAt, _>(planned_action::planned_at)
            .noting(State::cursor_is)
            .beside_if(|view, at| view.is_long(&at.text_document.uri)),
    );
    table.add(read::<GeneratedScript, _>(scripts::script));
    table.add(read::<ActionLocation, _>(planned_action::action_location));
}
