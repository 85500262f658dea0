//! The whole surface of the server, one entry per message of the protocol; the requests about whole files and those that
//! follow every keystroke are in [`direct`](crate::direct).

mod indexing;
#[cfg(feature = "process")]
mod run;

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;

use futures::channel::oneshot;
use tower_lsp::jsonrpc::{Error, Result};
#[allow(clippy::wildcard_imports, reason = "this file names half of the protocol")]
use tower_lsp::ls_types::*;
use tower_lsp::{Client, LanguageServer, NotCancellable, OngoingProgress, Unbounded};

use crate::capabilities;
#[cfg(feature = "process")]
use crate::children::Children;
use crate::chosen::ChosenEnvironment;
use crate::client::ClientFeatures;
use crate::handlers::explain::{self, Explain, Explanation};
use crate::handlers::planned_action::{ActionOf, PlannedAt};
#[cfg(feature = "process")]
use crate::handlers::runs;
use crate::handlers::{
    self, call_hierarchy, code_actions, code_lenses, completion, diagnostics, document_links,
    file_operations, formatting, hover, navigation, planned_action, planned_path, references, rename,
    scripts, selection, signature, synchronization, workspace_symbols,
};
use crate::log::log;
use crate::message::Outbox;
use crate::running::Running;
use crate::state::State;
use crate::workspace;

/// The server's end of one session; clones share it.
///
/// Every method changes or reads the state before it awaits anything. That, and the order in which the session calls
/// them, is why an answer is always about the latest text the client sent before its question.
#[derive(Debug, Clone)]
pub(crate) struct Server {
    state: Arc<Mutex<State>>,
    client: Client,
    pub(crate) outbox: Outbox,
    /// Requests about whole files that are not answered yet.
    pub(crate) running: Running,
    /// What this session has started; apart from the state, so that it can be ended at any moment.
    #[cfg(feature = "process")]
    children: Arc<Mutex<Children>>,
}

impl Server {
    /// A session that talks to `client`; notifications of ours go to `outbox`, in order with the answers.
    pub(crate) fn new(client: Client, outbox: Outbox) -> Self {
        Self {
            state: Arc::default(),
            client,
            outbox,
            running: Running::default(),
            #[cfg(feature = "process")]
            children: Arc::default(),
        }
    }

    /// The state, for as long as one handler runs. Never keep it across an `.await`.
    pub(crate) fn state(&self) -> MutexGuard<'_, State> {
        // A handler that panicked has left it locked in name only; `recover` has mended what it may have broken.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The child processes, for as long as one of them is looked at.
    #[cfg(feature = "process")]
    pub(crate) fn children(&self) -> MutexGuard<'_, Children> {
        self.children.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl LanguageServer for Server {
    //// Life cycle ////

    async fn initialize(&self, params: InitializeParams) -> Result<InitializeResult> {
        let features = ClientFeatures::new(&params.capabilities);
        let result = capabilities::initialize_result(&features);
        let mut state = self.state();
        state.client = features;
        state.folders = workspace::folders_of(&params);
        state.trace = params.trace.unwrap_or_default();
        if let Some(settings) = &params.initialization_options {
            handlers::workspace::set(&mut state, settings, &self.outbox);
        }
        drop(state);
        #[cfg(all(target_os = "linux", feature = "process"))]
        if let Some(client) = params.process_id {
            let server = self.clone();
            crate::parent::leave_with(client, move || server.leave());
        }
        Ok(result)
    }

    async fn initialized(&self, _: InitializedParams) {
        let (registrations, folders) = {
            let state = self.state();
            (handlers::workspace::registrations(&state), state.folders.clone())
        };
        if !registrations.is_empty()
            && let Err(error) = self.client.register_capability(registrations).await
        {
            log(format_args!("the client does not tell when files or settings change: {error}"));
        }
        self.ask_for_settings().await;
        self.index(folders).await;
    }

    async fn shutdown(&self) -> Result<()> {
        self.leave();
        Ok(())
    }

    //// Documents ////

    async fn did_open(&self, params: DidOpenTextDocumentParams) {
        synchronization::open(&mut self.state(), params);
    }

    async fn did_change(&self, params: DidChangeTextDocumentParams) {
        let mut state = self.state();
        synchronization::change(&mut state, &params);
        synchronization::tell_costs(&mut state, &params, &self.outbox);
    }

    async fn did_save(&self, params: DidSaveTextDocumentParams) {
        let mut state = self.state();
        state.saved(&params.text_document.uri);
        scripts::save(&mut state, &params.text_document.uri, &self.outbox);
    }

    async fn did_close(&self, params: DidCloseTextDocumentParams) {
        synchronization::close(&mut self.state(), &params);
    }

    //// The workspace ////

    async fn did_change_watched_files(&self, params: DidChangeWatchedFilesParams) {
        handlers::workspace::files_changed(&mut self.state(), &params);
        self.refresh().await;
    }

    async fn did_change_workspace_folders(&self, params: DidChangeWorkspaceFoldersParams) {
        let added = handlers::workspace::folders_changed(&mut self.state(), &params);
        self.index(added).await;
    }

    async fn did_change_configuration(&self, params: DidChangeConfigurationParams) {
        // Clients that can be asked say nothing here, or not all.
        if self.state().client.settings {
            self.ask_for_settings().await;
        } else {
            handlers::workspace::set(&mut self.state(), &params.settings, &self.outbox);
        }
        self.refresh().await;
    }

    async fn will_rename_files(&self, params: RenameFilesParams) -> Result<Option<WorkspaceEdit>> {
        Ok(file_operations::will_rename(&self.state(), &params))
    }

    async fn did_rename_files(&self, params: RenameFilesParams) {
        let added = {
            let mut state = self.state();
            file_operations::gone(&mut state, params.files.iter().map(|file| file.old_uri.as_str()));
            file_operations::come(&mut state, params.files.iter().map(|file| file.new_uri.as_str()))
        };
        self.index(added).await;
        self.refresh().await;
    }

    async fn did_create_files(&self, params: CreateFilesParams) {
        let new = params.files.iter().map(|file| file.uri.as_str());
        let added = file_operations::come(&mut self.state(), new);
        self.index(added).await;
        self.refresh().await;
    }

    async fn did_delete_files(&self, params: DeleteFilesParams) {
        let gone = params.files.iter().map(|file| file.uri.as_str());
        file_operations::gone(&mut self.state(), gone);
        self.refresh().await;
    }

    //// What is wrong ////

    async fn workspace_diagnostic(
        &self,
        params: WorkspaceDiagnosticParams,
    ) -> Result<WorkspaceDiagnosticReportResult> {
        loop {
            let changed = {
                let mut state = self.state();
                if let Some(report) = diagnostics::pull_workspace(&state, &params) {
                    return Ok(report.into());
                }
                // A client that asks again and again would keep both sides busy with nothing.
                let (sender, changed) = oneshot::channel();
                state.waiting.push(sender);
                changed
            };
            if changed.await.is_err() {
                return Err(Error::internal_error());
            }
        }
    }

    async fn code_action(&self, params: CodeActionParams) -> Result<Option<CodeActionResponse>> {
        let mut state = self.state();
        // What the editor asks for on its own accord is about the line of the cursor.
        if params.context.trigger_kind == Some(CodeActionTriggerKind::AUTOMATIC) {
            state.cursor_is_at(&params.text_document.uri, params.range);
        }
        Ok(code_actions::code_actions(&state, &params))
    }

    async fn code_action_resolve(&self, action: CodeAction) -> Result<CodeAction> {
        code_actions::resolve(&self.state(), action)
    }

    async fn execute_command(&self, params: ExecuteCommandParams) -> Result<Option<LSPAny>> {
        match params.command.as_str() {
            code_actions::GENERATE_SCRIPT => {
                let written = scripts::execute(&self.state(), &params, &self.outbox)?;
                if self.state().client.show_document {
                    // The script is there, whether or not the client then shows it.
                    let _ = self.client.show_document(scripts::show(written)).await;
                }
                Ok(None)
            }
            hover::SHOW_KINEMATICS => Ok(Some(hover::kinematics(&self.state(), &params)?.into())),
            #[cfg(feature = "process")]
            runs::RUN | runs::PREVIEW_PATH => self.run(params).await.map(Some),
            other => Err(Error::invalid_params(format!("no command `{other}`"))),
        }
    }

    //// What is there ////

    async fn completion_resolve(&self, item: CompletionItem) -> Result<CompletionItem> {
        completion::resolve(&self.state(), item)
    }

    async fn hover(&self, params: HoverParams) -> Result<Option<Hover>> {
        Ok(hover::hover(&self.state(), &params))
    }

    async fn signature_help(&self, params: SignatureHelpParams) -> Result<Option<SignatureHelp>> {
        Ok(signature::signature_help(&self.state(), &params))
    }

    async fn goto_definition(&self, params: GotoDefinitionParams) -> Result<Option<GotoDefinitionResponse>> {
        Ok(navigation::definition(&self.state(), &params))
    }

    async fn goto_declaration(&self, params: GotoDefinitionParams) -> Result<Option<GotoDefinitionResponse>> {
        Ok(navigation::declaration(&self.state(), &params))
    }

    async fn goto_type_definition(
        &self,
        params: GotoDefinitionParams,
    ) -> Result<Option<GotoDefinitionResponse>> {
        Ok(navigation::type_definition(&self.state(), &params))
    }

    async fn document_highlight(
        &self,
        params: DocumentHighlightParams,
    ) -> Result<Option<Vec<DocumentHighlight>>> {
        let mut state = self.state();
        state.cursor_is(&params.text_document_position_params);
        Ok(references::highlights(&state, &params))
    }

    async fn symbol(&self, params: WorkspaceSymbolParams) -> Result<Option<WorkspaceSymbolResponse>> {
        Ok(Some(workspace_symbols::workspace_symbols(&self.state(), &params)))
    }

    async fn document_link(&self, params: DocumentLinkParams) -> Result<Option<Vec<DocumentLink>>> {
        Ok(document_links::document_links(&self.state(), &params))
    }

    async fn prepare_call_hierarchy(
        &self,
        params: CallHierarchyPrepareParams,
    ) -> Result<Option<Vec<CallHierarchyItem>>> {
        Ok(call_hierarchy::prepare(&self.state(), &params))
    }

    async fn incoming_calls(
        &self,
        params: CallHierarchyIncomingCallsParams,
    ) -> Result<Option<Vec<CallHierarchyIncomingCall>>> {
        Ok(call_hierarchy::incoming(&self.state(), &params))
    }

    async fn outgoing_calls(
        &self,
        params: CallHierarchyOutgoingCallsParams,
    ) -> Result<Option<Vec<CallHierarchyOutgoingCall>>> {
        Ok(call_hierarchy::outgoing(&self.state(), &params))
    }

    async fn prepare_rename(
        &self,
        params: TextDocumentPositionParams,
    ) -> Result<Option<PrepareRenameResponse>> {
        rename::prepare(&self.state(), &params)
    }

    async fn rename(&self, params: RenameParams) -> Result<Option<WorkspaceEdit>> {
        rename::rename(&self.state(), &params)
    }

    async fn linked_editing_range(
        &self,
        params: LinkedEditingRangeParams,
    ) -> Result<Option<LinkedEditingRanges>> {
        Ok(rename::linked_editing_ranges(&self.state(), &params))
    }

    async fn code_lens_resolve(&self, lens: CodeLens) -> Result<CodeLens> {
        code_lenses::resolve(&self.state(), lens)
    }

    async fn selection_range(&self, params: SelectionRangeParams) -> Result<Option<Vec<SelectionRange>>> {
        Ok(selection::selection_ranges(&self.state(), &params))
    }

    async fn range_formatting(&self, params: DocumentRangeFormattingParams) -> Result<Option<Vec<TextEdit>>> {
        Ok(formatting::range(&self.state(), &params))
    }

    async fn on_type_formatting(
        &self,
        params: DocumentOnTypeFormattingParams,
    ) -> Result<Option<Vec<TextEdit>>> {
        Ok(formatting::on_type(&self.state(), &params))
    }
}

/// What goes on beside the messages.
impl Server {
    async fn ask_for_settings(&self) {
        if !self.state().client.settings {
            return;
        }
        match self.client.configuration(handlers::workspace::wanted_settings()).await {
            Ok(settings) => {
                let settings = settings.first().cloned().unwrap_or_default();
                handlers::workspace::set(&mut self.state(), &settings, &self.outbox);
                self.settle();
            }
            Err(error) => log(format_args!("the client does not tell its settings: {error}")),
        }
    }

    /// Looks for programs in folders, on a thread of its own.
    async fn index(&self, folders: Vec<String>) {
        if folders.is_empty() {
            return;
        }
        let progress = self.begin("Looking for programs").await;
        let (done, found) = oneshot::channel();
        let server = self.clone();
        let work = move || done.send(indexing::index(&server, &folders));
        let started = thread::Builder::new().name("workspace".to_owned()).spawn(work);
        let summary = match started {
            Ok(_) => found.await.unwrap_or_default(),
            Err(error) => format!("no programs: {error}"),
        };
        if let Some(progress) = progress {
            progress.finish_with_message(summary).await;
        }
        self.refresh().await;
    }

    /// A request of ours: see [`planned_path`].
    #[allow(clippy::unused_async, reason = "what the router takes")]
    pub(crate) async fn planned_path(&self, which: ChosenEnvironment) -> Result<serde_json::Value> {
        planned_path::planned_path(&mut self.state(), &which)
    }

    /// A request of ours: see [`driven_path`](handlers::driven_path).
    #[allow(clippy::unused_async, reason = "what the router takes")]
    pub(crate) async fn driven_path(&self, which: ChosenEnvironment) -> Result<serde_json::Value> {
        Ok(self.state().driven.answer(&which))
    }

    /// A request of ours: see [`planned_action`].
    #[allow(clippy::unused_async, reason = "what the router takes")]
    pub(crate) async fn planned_at(&self, at: TextDocumentPositionParams) -> Result<Option<PlannedAt>> {
        let mut state = self.state();
        state.cursor_is(&at);
        Ok(planned_action::planned_at(&state, &at))
    }

    /// A request of ours: see [`explain`].
    #[allow(clippy::unused_async, reason = "what the router takes")]
    pub(crate) async fn explain(&self, of: Explain) -> Result<Explanation> {
        explain::explain(&of)
    }

    /// A request of ours: see [`planned_action`].
    #[allow(clippy::unused_async, reason = "what the router takes")]
    pub(crate) async fn action_location(&self, of: ActionOf) -> Result<Option<Location>> {
        planned_action::action_location(&self.state(), &of)
    }

    /// The client wants to know more, or less, of what the server does.
    #[allow(clippy::unused_async, reason = "what the router takes")]
    pub(crate) async fn set_trace(&self, params: SetTraceParams) {
        synchronization::set_trace(&mut self.state(), &params);
    }

    /// The person pressed the button beside a progress.
    #[allow(clippy::unused_async, reason = "what the router takes")]
    pub(crate) async fn cancel_progress(&self, params: WorkDoneProgressCancelParams) {
        #[cfg(feature = "process")]
        self.children().interrupt(&params.token);
        #[cfg(not(feature = "process"))]
        drop(params);
    }

    async fn begin(&self, title: &str) -> Option<OngoingProgress<Unbounded, NotCancellable>> {
        if !self.state().client.progress {
            return None;
        }
        let number = {
            let mut state = self.state();
            state.progresses += 1;
            state.progresses
        };
        let token = ProgressToken::String(format!("pydslrep: {title} ({number})"));
        self.client
            .send_request::<request::WorkDoneProgressCreate>(WorkDoneProgressCreateParams {
                token: token.clone(),
            })
            .await
            .ok()?;
        Some(self.client.progress(token, title).begin().await)
    }

    /// Asks clients that ask for diagnostics and hints to ask again: what changed is not what they changed.
    async fn refresh(&self) {
        if self.state().client.refreshes_diagnostics {
            let _ = self.client.workspace_diagnostic_refresh().await;
        }
        if self.state().client.refreshes_inlay_hints {
            let _ = self.client.inlay_hint_refresh().await;
        }
    }
}

/// What the session calls besides the handlers.
impl Server {
    /// All messages that had arrived are handled: time to tell the client what they changed.
    pub(crate) fn settle(&self) {
        let mut state = self.state();
        if diagnostics::publish(&mut state, &self.outbox) {
            planned_path::announce(&mut state, &self.outbox);
        }
        state.tell_outdated(&self.outbox);
    }

    /// The session is over, in whatever way.
    pub(crate) fn leave(&self) {
        #[cfg(feature = "process")]
        self.children().leave();
    }

    /// A handler panicked and may have left the analysis half changed: it is made anew from the documents.
    pub(crate) fn recover(&self) {
        self.state().rebuild();
    }
}
