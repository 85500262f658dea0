//! One client's session: messages in, answers out, without threads, streams or clocks.
//!
//! Every handler runs, in arrival order, up to its first `.await`, before the next message is handled; the rest of it is
//! handed to the caller to run. A panic answers its request with an error and has no other effect; input that is not a
//! message is answered too.

use std::any::Any;
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex};
use std::task::{Context, Poll, Waker};

use futures::future::BoxFuture;
use futures::{FutureExt, SinkExt, StreamExt};
use tower_layer::Layer;
use tower_lsp::LspService;
use tower_lsp::jsonrpc::{ErrorCode, Id, Request, Response};
use tower_service::Service;

use crate::dispatch::{Reply, Table, TableLayer, TableService};
use crate::handlers;
use crate::life_cycle::LifeCycle;
use crate::log::log;
use crate::message::{IGNORED, Incoming, Outbox, build, encode, parse, refuse};
#[cfg(feature = "process")]
use crate::pending::PendingRequests;
use crate::server::{Server, Stage};
use crate::state::State;

/// The way in which a session ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ending {
    /// `shutdown`, then `exit`.
    Orderly,
    /// `exit` without `shutdown`, or the end of the input.
    Abrupt,
}

/// Runs a future to its end, somewhere else.
type Spawn = Box<dyn Fn(BoxFuture<'static, ()>)>;

/// One client's session.
pub struct Session {
    service: TableService<LspService<LifeCycle>>,
    server: Server,
    responses: Box<dyn FnMut(Response)>,
    spawn: Spawn,
    outbox: Outbox,
}

impl fmt::Debug for Session {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Session").field("server", &self.server).finish_non_exhaustive()
    }
}

impl Session {
    /// A session whose messages to the client go to `outbox`. `spawn` runs tasks that outlast the message that began them.
    pub fn new(outbox: Outbox, spawn: impl Fn(BoxFuture<'static, ()>) + 'static) -> Self {
        Self::with_state(handlers::table(), State::default(), outbox, Box::new(spawn))
    }

    /// A session without a disk: of the files that are not open, it knows those that the client provides
    /// (`pydslrep/files`).
    pub fn in_memory(outbox: Outbox, spawn: impl Fn(BoxFuture<'static, ()>) + 'static) -> Self {
        Self::with_state(handlers::table(), State::in_memory(), outbox, Box::new(spawn))
    }

    /// A session that handles the messages of a table.
    pub(crate) fn with_state(table: Table, state: State, outbox: Outbox, spawn: Spawn) -> Self {
        let (table, state) = (Arc::new(table), Arc::new(Mutex::new(state)));
        let (service, socket) = LspService::new(|client| LifeCycle {
            server: Server::new(client, outbox.clone(), Arc::clone(&state)),
            table: Arc::clone(&table),
        });
        let server = service.inner().server.clone();
        let service = TableLayer { table, server: server.clone() }.layer(service);
        let (requests, mut responses) = socket.split();
        let forward = outbox.clone();
        let forwarding = requests.for_each(move |request| {
            forward.send_server_message(&without_null(request));
            std::future::ready(())
        });
        spawn(forwarding.boxed());
        let responses = Box::new(move |response| {
            let _ = responses.send(response).now_or_never();
        });
        Self { service, server, responses, spawn, outbox }
    }

    /// Applies the parameters of the program that starts it.
    #[cfg(feature = "process")]
    pub(crate) fn launch(&self, launch: crate::launch::Launch) {
        self.server.children().command = launch.command;
        self.server.state().set_options(launch.options);
    }

    /// Returns the server that the session's handlers share.
    #[cfg(feature = "process")]
    pub(crate) fn server(&self) -> &Server {
        &self.server
    }

    /// Handles one message, the bytes of a frame; returns how the session ended, if it did.
    pub fn handle(&mut self, body: &[u8]) -> Option<Ending> {
        match parse(body) {
            Ok(Incoming::Request(request)) => self.call(request),
            Ok(Incoming::Response(response)) => self.pass_on(response),
            Err(refusal) => self.outbox.send_answer(encode(&refusal)),
        }
        // The framework takes no calls after `exit`.
        match self.service.poll_ready(&mut Context::from_waker(Waker::noop())) {
            Poll::Ready(Err(_)) if self.server.stage() == Stage::ShutDown => Some(Ending::Orderly),
            Poll::Ready(Err(_)) => Some(Ending::Abrupt),
            Poll::Ready(Ok(())) | Poll::Pending => None,
        }
    }

    /// The requests that are not answered yet.
    #[cfg(feature = "process")]
    pub(crate) fn pending(&self) -> PendingRequests {
        self.server.pending.clone()
    }

    /// Answers input that is not a message.
    pub fn refuse(&self, reason: &str) {
        self.outbox.send_answer(encode(&refuse(Id::Null, ErrorCode::ParseError, reason.to_owned())));
    }

    /// To be called when all messages that had arrived are handled: sends what they changed to the client.
    pub fn flush_diagnostics(&self) {
        if let Err(panic) = catch_unwind(AssertUnwindSafe(|| self.server.flush_diagnostics())) {
            report_panic(&self.server, &self.outbox, "diagnostics", None, panic.as_ref());
        }
    }

    /// To be called when the session has ended, for whatever reason: stops what it started.
    pub fn leave(&self) {
        self.server.leave();
    }

    /// Runs a handler up to its first `.await`; hands over the rest.
    fn call(&mut self, request: Request) {
        let id = request.id().cloned();
        let method = request.method().to_owned();
        let started = catch_unwind(AssertUnwindSafe(|| {
            let mut reply = self.service.call(request);
            // The executor of the rest polls it again, with a waker.
            match reply.poll_unpin(&mut Context::from_waker(Waker::noop())) {
                Poll::Ready(outcome) => Ok(outcome),
                Poll::Pending => Err(reply),
            }
        }));
        match started {
            Ok(Ok(Ok(Some(body)))) => self.outbox.send_answer(body),
            Ok(Ok(_)) => {}
            Ok(Err(reply)) => self.finish_elsewhere(reply, method, id),
            Err(panic) => report_panic(&self.server, &self.outbox, &method, id, panic.as_ref()),
        }
    }

    fn finish_elsewhere(&self, reply: Reply, method: String, id: Option<Id>) {
        let (server, outbox) = (self.server.clone(), self.outbox.clone());
        let finish = async move {
            match AssertUnwindSafe(reply).catch_unwind().await {
                Ok(Ok(Some(body))) => outbox.send_answer(body),
                Ok(_) => {}
                Err(panic) => report_panic(&server, &outbox, &method, id, panic.as_ref()),
            }
        };
        (self.spawn)(finish.boxed());
    }

    fn pass_on(&mut self, response: Response) {
        if matches!(response.id(), Id::String(id) if id.starts_with(IGNORED)) {
            return;
        }
        if catch_unwind(AssertUnwindSafe(|| (self.responses)(response))).is_err() {
            log(format_args!("the client answered a request that was not sent"));
        }
    }
}

/// The library writes `params: null` into requests that have no parameters, which JSON-RPC does not allow.
fn without_null(request: Request) -> Request {
    let (method, id, params) = request.into_parts();
    build(method, id, params.filter(|params| !params.is_null()))
}

/// The panic's message and location are on standard error already.
fn report_panic(server: &Server, outbox: &Outbox, method: &str, id: Option<Id>, panic: &(dyn Any + Send)) {
    let reason = panic
        .downcast_ref::<&str>()
        .copied()
        .or_else(|| panic.downcast_ref::<String>().map(String::as_str))
        .unwrap_or("no message");
    let message = format!("internal error in {method}: {reason}; the session continues");
    log(format_args!("{message}"));
    if let Some(id) = id {
        outbox.send_answer(encode(&refuse(id, ErrorCode::InternalError, message)));
    }
    if catch_unwind(AssertUnwindSafe(|| server.recover())).is_err() {
        log(format_args!("internal error: recovery failed too"));
    }
}
