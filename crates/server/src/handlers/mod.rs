//! Everything a client can send: the table of all methods, and one file per group of them with their handlers. A handler
//! is a plain function of the state and the parameters; what it returns is the answer.
//!
//! A new request is a handler in its file and a row here. The row's method says where the handler runs and what it may
//! do, see [`Table`]; its last argument writes down the capability.

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
use crate::dispatch::{Announce, Table};
use crate::page::Audience;
use crate::server::{Server, Stage};
use crate::state::State;

/// For methods without a capability of their own: clients send them anyway, or with the row above.
const NOTHING: Announce = |_, _| {};

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
    table.framework_request::<Initialize>(&[Stage::Starting, Stage::Serving]);
    table.follow::<Initialized, _>(workspace::start, NOTHING);
    table.change::<SetTrace>(synchronization::set_trace, NOTHING);
    table.interrupt::<Cancel>(|server, params| server.pending.cancel(&params.id.clone().into()));
    table.interrupt::<WorkDoneProgressCancel>(Server::cancel_progress);
    table.framework_request::<Shutdown>(&[Stage::Serving]);
    table.framework_notification::<Exit>(&[Stage::Starting, Stage::Serving, Stage::ShutDown]);
}

fn documents(table: &mut Table) {
    table.change::<DidOpenTextDocument>(synchronization::open, synchronization::announce);
    table.change::<DidChangeTextDocument>(synchronization::change, NOTHING);
    table.change::<DidSaveTextDocument>(synchronization::save, NOTHING);
    table.change::<DidCloseTextDocument>(synchronization::close, NOTHING);
}

fn workspaces(table: &mut Table) {
    table.follow::<DidChangeWorkspaceFolders, _>(workspace::folders_changed, workspace::announce);
    // These two are registered where the client takes registrations.
    table.follow::<DidChangeWatchedFiles, _>(workspace::files_changed, NOTHING);
    table.follow::<ProvidedFiles, _>(provided_files::provide, NOTHING);
    table.follow::<DidChangeConfiguration, _>(workspace::settings_changed, NOTHING);
    table.read::<WillRenameFiles, _>(file_operations::will_rename, file_operations::announce);
    table.follow::<DidRenameFiles, _>(file_operations::did_rename, NOTHING);
    table.follow::<DidCreateFiles, _>(file_operations::did_create, NOTHING);
    table.follow::<DidDeleteFiles, _>(file_operations::did_delete, NOTHING);
}

fn problems_and_actions(table: &mut Table) {
    table.read_long::<DocumentDiagnosticRequest, _>(
        diagnostics::has_many,
        |_, _| {},
        diagnostics::pull,
        diagnostics::announce,
    );
    table.read_workspace::<WorkspaceDiagnosticRequest, _>(workspace_diagnostics::pull_workspace, NOTHING);
    table.read::<Explain, _>(explain::explain, NOTHING);
    table.read_long::<CodeActionRequest, _>(
        |state, params| state.if_long(&params.text_document.uri),
        code_actions::note_cursor,
        code_actions::code_actions,
        code_actions::announce,
    );
    table.read_long::<CodeActionResolveRequest, _>(
        code_actions::is_long,
        |_, _| {},
        code_actions::resolve,
        NOTHING,
    );
    table.run::<ExecuteCommand, _>(commands::execute, commands::announce);
}

fn typing(table: &mut Table) {
    table.read_and_note::<Completion, _>(completion::completion, completion::announce);
    table.read::<ResolveCompletionItem, _>(completion::resolve, NOTHING);
    table.read_and_note::<SignatureHelpRequest, _>(
        |state, params| {
            state.note_cursor(&params.text_document_position_params);
            signature::signature_help(state, params)
        },
        signature::announce,
    );
    table.read::<OnTypeFormatting, _>(formatting::on_type, formatting::announce_on_type);
    table.read::<LinkedEditingRange, _>(rename::linked_editing_ranges, |server, _| {
        server.linked_editing_range_provider = Some(LinkedEditingRangeServerCapabilities::Simple(true));
    });
}

fn reading(table: &mut Table) {
    table.read_and_note::<HoverRequest, _>(
        |state, params| {
            state.note_cursor(&params.text_document_position_params);
            hover::hover(state, params)
        },
        |server, _| server.hover_provider = Some(true.into()),
    );
    table.read_long::<InlayHintRequest, _>(
        |state, params| state.if_long(&params.text_document.uri),
        |_, _| {},
        inlay_hints::inlay_hints,
        |server, _| server.inlay_hint_provider = Some(OneOf::Left(true)),
    );
    table.read_long::<CodeLensRequest, _>(
        |state, params| state.if_long(&params.text_document.uri),
        |_, _| {},
        code_lenses::code_lenses,
        |server, _| server.code_lens_provider = Some(CodeLensOptions { resolve_provider: Some(true) }),
    );
    table.read::<CodeLensResolve, _>(code_lenses::resolve, NOTHING);
    table.read_file::<SemanticTokensFullRequest, _>(semantic_tokens::full, semantic_tokens::announce);
    table.read_file::<SemanticTokensFullDeltaRequest, _>(semantic_tokens::delta, NOTHING);
    table.read_long::<SemanticTokensRangeRequest, _>(
        |state, params| state.if_long(&params.text_document.uri),
        |_, _| {},
        semantic_tokens::range,
        NOTHING,
    );
    table.read_file::<DocumentSymbolRequest, _>(document_symbols::document_symbols, |server, _| {
        server.document_symbol_provider = Some(OneOf::Left(true));
    });
    table.read_file::<FoldingRangeRequest, _>(folding::folding_ranges, |server, _| {
        server.folding_range_provider = Some(true.into());
    });
    table.read::<SelectionRangeRequest, _>(selection::selection_ranges, |server, _| {
        server.selection_range_provider = Some(true.into());
    });
}

fn navigation(table: &mut Table) {
    table.read::<GotoDefinition, _>(navigation::definition, |server, _| {
        server.definition_provider = Some(OneOf::Left(true));
    });
    table.read::<GotoDeclaration, _>(navigation::declaration, |server, _| {
        server.declaration_provider = Some(DeclarationCapability::Simple(true));
    });
    table.read::<GotoTypeDefinition, _>(navigation::type_definition, |server, _| {
        server.type_definition_provider = Some(true.into());
    });
    table.read_long::<References, _>(
        |state, params| references::has_many(state, &params.text_document_position),
        |_, _| {},
        references::references,
        |server, _| server.references_provider = Some(OneOf::Left(true)),
    );
    table.read_long::<DocumentHighlightRequest, _>(
        |state, params| references::has_many(state, &params.text_document_position_params),
        |state, params| state.cursor_is(&params.text_document_position_params),
        references::highlights,
        |server, _| server.document_highlight_provider = Some(OneOf::Left(true)),
    );
    table.read_workspace::<WorkspaceSymbolRequest, _>(workspace_symbols::workspace_symbols, |server, _| {
        server.workspace_symbol_provider = Some(OneOf::Left(true));
    });
    table.read::<CallHierarchyPrepare, _>(call_hierarchy::prepare, |server, _| {
        server.call_hierarchy_provider = Some(true.into());
    });
    table.read::<CallHierarchyIncomingCalls, _>(call_hierarchy::incoming, NOTHING);
    table.read::<CallHierarchyOutgoingCalls, _>(call_hierarchy::outgoing, NOTHING);
    table.read::<DocumentLinkRequest, _>(document_links::document_links, |server, _| {
        server.document_link_provider = Some(DocumentLinkOptions {
            resolve_provider: None,
            work_done_progress_options: WorkDoneProgressOptions::default(),
        });
    });
}

fn editing(table: &mut Table) {
    table.read::<PrepareRenameRequest, _>(rename::prepare, rename::announce);
    table.read_long::<Rename, _>(
        |state, params| references::has_many(state, &params.text_document_position),
        |_, _| {},
        rename::rename,
        NOTHING,
    );
    table.read_file::<Formatting, _>(formatting::document, |server, _| {
        server.document_formatting_provider = Some(OneOf::Left(true));
    });
    table.read_file::<RangeFormatting, _>(formatting::range, |server, _| {
        server.document_range_formatting_provider = Some(OneOf::Left(true));
    });
}

/// The methods that `docs/protocol.md` adds to the protocol, for previews.
fn paths(table: &mut Table) {
    table.read_long::<PlannedPath, _>(
        |state, which| state.if_long(&which.uri),
        |state, which| planned_path::watch(state, which, Audience::Client),
        |state, which| planned_path::planned_path(state, which, Audience::Client),
        NOTHING,
    );
    table.read_and_note::<DrivenPath, _>(|state, which| state.driven.watch(which, Audience::Client), NOTHING);
    table.read_long::<PlannedAt, _>(
        |state, at| state.if_long(&at.text_document.uri),
        State::cursor_is,
        planned_action::planned_at,
        NOTHING,
    );
    table.read::<GeneratedScript, _>(scripts::script, NOTHING);
    table.read::<ActionLocation, _>(planned_action::action_location, NOTHING);
}
