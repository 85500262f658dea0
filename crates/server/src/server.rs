//! The server's end of one session: the state that its handlers share, and the tasks beside the messages.

mod indexing;

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;

use futures::channel::oneshot;
use tower_lsp::ls_types::{
    ProgressToken, WorkDoneProgressCancelParams, WorkDoneProgressCreateParams, request,
};
use tower_lsp::{Client, NotCancellable, OngoingProgress, Unbounded};

#[cfg(feature = "process")]
use crate::children::Children;
use crate::handlers::{diagnostics, planned_path, settings};
use crate::log::log;
use crate::message::Outbox;
use crate::pending::PendingRequests;
use crate::state::State;
#[cfg(feature = "process")]
use crate::web::WebServer;

/// The stage of a session, which decides which messages it takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Stage {
    /// Before `initialize`.
    Starting,
    /// In between.
    Serving,
    /// After `shutdown`.
    ShutDown,
}

/// The server's end of one session; clones share it.
///
/// Every handler changes or reads the state before it awaits anything. That, and the order in which the session calls
/// them, is why an answer is always about the latest text the client sent before its request.
#[derive(Debug, Clone)]
pub(crate) struct Server {
    stage: Arc<Mutex<Stage>>,
    state: Arc<Mutex<State>>,
    /// Sends requests to the client, and waits for its answers.
    pub(crate) client: Client,
    pub(crate) outbox: Outbox,
    /// Requests that are not answered yet.
    pub(crate) pending: PendingRequests,
    /// The child processes; not in the state, so that they can be stopped at any moment.
    #[cfg(feature = "process")]
    children: Arc<Mutex<Children>>,
    /// Serves the pages of the path preview.
    #[cfg(feature = "process")]
    web: Arc<Mutex<Option<WebServer>>>,
}

impl Server {
    /// A session that talks to `client`; notifications of ours go to `outbox`, in order with the answers.
    pub(crate) fn new(client: Client, outbox: Outbox, state: Arc<Mutex<State>>) -> Self {
        Self {
            stage: Arc::new(Mutex::new(Stage::Starting)),
            state,
            client,
            outbox,
            pending: PendingRequests::default(),
            #[cfg(feature = "process")]
            children: Arc::default(),
            #[cfg(feature = "process")]
            web: Arc::default(),
        }
    }

    /// Returns the stage of the session.
    pub(crate) fn stage(&self) -> Stage {
        *self.stage.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Begins another stage.
    pub(crate) fn advance(&self, stage: Stage) {
        *self.stage.lock().unwrap_or_else(PoisonError::into_inner) = stage;
    }

    /// The state, for as long as one handler runs. Never keep it across an `.await`.
    pub(crate) fn state(&self) -> MutexGuard<'_, State> {
        // After a panic `recover` has repaired what the handler may have left half changed.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The server of the path preview's pages, if it was started.
    #[cfg(feature = "process")]
    pub(crate) fn web(&self) -> MutexGuard<'_, Option<WebServer>> {
        self.web.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The child processes, for as long as one of them is looked at.
    #[cfg(feature = "process")]
    pub(crate) fn children(&self) -> MutexGuard<'_, Children> {
        self.children.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Tasks that handlers start and that continue while other messages are handled.
impl Server {
    /// Reads the client's settings, where the client can be asked.
    pub(crate) async fn ask_for_settings(&self) {
        if !self.state().view.client.settings {
            return;
        }
        match self.client.configuration(settings::wanted()).await {
            Ok(settings) => {
                let settings = settings.first().cloned().unwrap_or_default();
                settings::set(&mut self.state(), &settings, &self.outbox);
                self.flush_diagnostics();
            }
            Err(error) => log(format_args!("cannot read the client's settings: {error}")),
        }
    }

    /// Searches folders for programs, on a thread of its own.
    pub(crate) async fn index(&self, folders: Vec<String>) {
        if folders.is_empty() {
            return;
        }
        if self.state().view.provided.is_some() {
            // It is in memory, and there may be no threads.
            indexing::index(self, &folders);
            return self.refresh().await;
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

    /// `window/workDoneProgress/cancel`: somebody pressed the button next to a progress bar.
    #[cfg_attr(not(feature = "process"), expect(clippy::unused_self, reason = "nothing is started there"))]
    pub(crate) fn cancel_progress(&self, params: &WorkDoneProgressCancelParams) {
        #[cfg(feature = "process")]
        self.children().interrupt(&params.token);
        #[cfg(not(feature = "process"))]
        let _ = params;
    }

    async fn begin(&self, title: &str) -> Option<OngoingProgress<Unbounded, NotCancellable>> {
        let number = {
            let mut state = self.state();
            state.progresses += 1;
            state.progresses
        };
        let token = self.progress_token(format!("pydslrep: {title} ({number})")).await?;
        Some(self.client.progress(token, title).begin().await)
    }

    /// Begins a progress under a name that no other has; `None` where the client shows none.
    pub(crate) async fn progress_token(&self, name: String) -> Option<ProgressToken> {
        if !self.state().view.client.progress {
            return None;
        }
        let token = ProgressToken::String(name);
        let params = WorkDoneProgressCreateParams { token: token.clone() };
        self.client.send_request::<request::WorkDoneProgressCreate>(params).await.ok()?;
        Some(token)
    }

    /// Asks clients that pull diagnostics and hints to pull them again: other documents than theirs have changed.
    pub(crate) async fn refresh(&self) {
        if self.state().view.client.refreshes_diagnostics {
            let _ = self.client.workspace_diagnostic_refresh().await;
        }
        if self.state().view.client.refreshes_inlay_hints {
            let _ = self.client.inlay_hint_refresh().await;
        }
    }
}

/// Methods for the session.
impl Server {
    /// Sends the client the changes by the messages handled so far.
    pub(crate) fn flush_diagnostics(&self) {
        let mut state = self.state();
        if diagnostics::publish(&mut state, &self.outbox) {
            planned_path::announce(&state, &self.outbox);
        }
        state.tell_outdated(&self.outbox);
    }

    /// The session has ended, for whatever reason.
    #[cfg_attr(not(feature = "process"), expect(clippy::unused_self, reason = "nothing is started there"))]
    pub(crate) fn leave(&self) {
        #[cfg(feature = "process")]
        {
            self.children().leave();
            *self.web() = None;
        }
    }

    /// Rebuilds the analysis from the documents: a handler that panicked may have left it half changed.
    pub(crate) fn recover(&self) {
        self.state().workspace_mut().rebuild();
    }
}
