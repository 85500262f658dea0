//! The beginning and the end of a session, which the framework calls. All other methods are in the
//! [table](crate::handlers::table).

use std::sync::Arc;

use tower_lsp::LanguageServer;
use tower_lsp::jsonrpc::Result;
use tower_lsp::ls_types::{InitializeParams, InitializeResult, ServerInfo};

use crate::client::ClientFeatures;
use crate::dispatch::Table;
use crate::documents::folders_of;
use crate::handlers::settings;
use crate::server::{Server, Stage};

/// The framework's view of the server.
#[derive(Debug)]
pub(crate) struct LifeCycle {
    pub(crate) server: Server,
    pub(crate) table: Arc<Table>,
}

impl LanguageServer for LifeCycle {
    async fn initialize(&self, params: InitializeParams) -> Result<InitializeResult> {
        let server = &self.server;
        let mut features = ClientFeatures::new(&params.capabilities);
        if let Some(client) = &params.client_info {
            features.correct(&client.name);
        }
        let capabilities = self.table.capabilities(&features);
        let mut state = server.state();
        state.view.client = Arc::new(features);
        state.workspace_mut().set_folders(folders_of(&params));
        state.trace = params.trace.unwrap_or_default();
        if let Some(settings) = &params.initialization_options {
            settings::set(&mut state, settings, &server.outbox);
        }
        drop(state);
        #[cfg(all(target_os = "linux", feature = "process"))]
        if let Some(client) = params.process_id {
            let server = server.clone();
            crate::parent::leave_with(client, move || server.leave());
        }
        server.advance(Stage::Serving);
        let name = "pydslrep-lsp".to_owned();
        let version = Some(env!("CARGO_PKG_VERSION").to_owned());
        let server_info = Some(ServerInfo { name, version });
        Ok(InitializeResult { capabilities, server_info, ..InitializeResult::default() })
    }

    async fn shutdown(&self) -> Result<()> {
        self.server.leave();
        self.server.advance(Stage::ShutDown);
        self.server.outbox.only_answer();
        Ok(())
    }
}
