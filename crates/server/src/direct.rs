//! Requests that are answered around the router, which would build a JSON value of each answer first: those about whole
//! files, whose answers may be megabytes, and those that follow every keystroke.
//!
//! A long file is worked on beside the message loop, from a snapshot, so that typing goes on meanwhile; the work ends
//! early when the client takes the request back or changes the text.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use futures::FutureExt;
use futures::future::BoxFuture;
use serde::Deserialize;
use serde_json::Value;
use tower_lsp::jsonrpc::{ErrorCode, Id, Request};

use crate::handlers::{
    code_lenses, completion, diagnostics, document_symbols, folding, formatting, inlay_hints, references,
    semantic_tokens,
};
use crate::log::log;
use crate::message::{Outbox, WriteJson, encode_answer, refuse};
use crate::server::Server;
use crate::state::State;
use crate::work::Work;

/// A shorter text is done sooner than it is handed over.
const LONG: usize = 64 << 10;

/// The protocol's codes for answers that are not given.
const CANCELLED: ErrorCode = ErrorCode::ServerError(-32800);
const CONTENT_MODIFIED: ErrorCode = ErrorCode::ServerError(-32801);

/// What became of a request.
pub(crate) enum Direct {
    /// It is for the router: none of these, or one that something is wrong with.
    Other,
    /// It is answered.
    Answered,
    /// It will be answered by this.
    Later(BoxFuture<'static, ()>),
}

impl Server {
    /// Answers a request, now or later, if it is one of those that go around the router.
    pub(crate) fn answer_direct(&self, request: &Request) -> Direct {
        match request.method() {
            "textDocument/documentSymbol" => self.work_on(request, document_symbols::document_symbols),
            "textDocument/foldingRange" => self.work_on(request, folding::folding_ranges),
            "textDocument/formatting" => self.work_on(request, formatting::document),
            "textDocument/semanticTokens/full" => self.work_on(request, semantic_tokens::full),
            "textDocument/semanticTokens/full/delta" => self.work_on(request, semantic_tokens::delta),
            "textDocument/codeLens" => self.answer_and_keep(request, code_lenses::code_lenses),
            "textDocument/completion" => self.answer_now(request, completion::completion),
            "textDocument/diagnostic" => self.answer_now(request, diagnostics::pull),
            "textDocument/inlayHint" => self.answer_and_keep(request, inlay_hints::inlay_hints),
            "textDocument/references" => self.answer_now(request, references::references),
            "textDocument/semanticTokens/range" => self.answer_now(request, semantic_tokens::range),
            _ => Direct::Other,
        }
    }

    fn answer_now<P, R>(&self, request: &Request, handler: fn(&State, &P) -> R) -> Direct
    where
        P: for<'a> Deserialize<'a>,
        R: WriteJson,
    {
        let Some((id, params)) = read(request) else { return Direct::Other };
        let result = handler(&self.state(), &params);
        self.outbox.answer(&id, &result);
        Direct::Answered
    }

    /// As [`Self::answer_now`], where the state remembers what it was asked.
    fn answer_and_keep<P, R>(&self, request: &Request, handler: fn(&mut State, &P) -> R) -> Direct
    where
        P: for<'a> Deserialize<'a>,
        R: WriteJson,
    {
        let Some((id, params)) = read(request) else { return Direct::Other };
        let result = handler(&mut self.state(), &params);
        self.outbox.answer(&id, &result);
        Direct::Answered
    }

    fn work_on<P, R>(&self, request: &Request, prepare: fn(&mut State, &P) -> Option<Work<R>>) -> Direct
    where
        P: for<'a> Deserialize<'a>,
        R: WriteJson + 'static,
    {
        let Some((id, params)) = read(request) else { return Direct::Other };
        let Some(work) = prepare(&mut self.state(), &params) else {
            self.outbox.answer(&id, &Value::Null);
            return Direct::Answered;
        };
        if work.snapshot.text().len_bytes() < LONG {
            self.outbox.answer(&id, &(work.run)(work.snapshot));
            return Direct::Answered;
        }
        let cancelled = self.running.add(id.clone());
        let (outbox, running) = (self.outbox.clone(), self.running.clone());
        Direct::Later(
            async move {
                finish(work, &id, &cancelled, &outbox);
                running.remove(&id);
            }
            .boxed(),
        )
    }
}

fn read<P: for<'a> Deserialize<'a>>(request: &Request) -> Option<(Id, P)> {
    Some((request.id()?.clone(), P::deserialize(request.params()?).ok()?))
}

fn finish<R: WriteJson>(work: Work<R>, id: &Id, cancelled: &Arc<AtomicBool>, outbox: &Outbox) {
    let Work { snapshot, outdated, run } = work;
    let snapshot = snapshot.stop_on(Arc::clone(&outdated)).stop_on(Arc::clone(cancelled));
    let answer = catch_unwind(AssertUnwindSafe(|| encode_answer(id, &run(snapshot))));
    if cancelled.load(Ordering::Relaxed) {
        return outbox.send(&refuse(id.clone(), CANCELLED, "taken back".to_owned()));
    }
    if outdated.load(Ordering::Relaxed) {
        return outbox.send(&refuse(id.clone(), CONTENT_MODIFIED, "the text was changed".to_owned()));
    }
    let Ok(answer) = answer else {
        // The panic itself is on standard error already; the state had no part in it.
        let message = "a defect of the server; the session goes on".to_owned();
        log(format_args!("{message}"));
        return outbox.send(&refuse(id.clone(), ErrorCode::InternalError, message));
    };
    outbox.send_encoded(answer);
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc;

    use serde_json::json;

    use super::*;
    use crate::session::Session;

    /// A session whose long work waits until it is told to go on.
    struct Held {
        session: Session,
        work: mpsc::Receiver<BoxFuture<'static, ()>>,
        sent: mpsc::Receiver<Option<Vec<u8>>>,
    }

    impl Held {
        fn new() -> Self {
            let (outbox, sent) = mpsc::channel();
            let (later, work) = mpsc::channel();
            let session = Session::new(Outbox::new(outbox), move |future| {
                let _ = later.send(future);
            });
            let mut held = Self { session, work, sent };
            // What forwards the server's own requests never ends.
            held.work.try_iter().for_each(drop);
            held.send(&json!({ "id": 0, "method": "initialize", "params": { "capabilities": {} } }));
            held.send(&json!({ "method": "initialized", "params": {} }));
            let text = "wheel a with radius 4\n".repeat(LONG / 10);
            let document = json!({ "uri": "file:///a.pyr", "languageId": "x", "version": 1, "text": text });
            held.send(&json!({ "method": "textDocument/didOpen", "params": { "textDocument": document } }));
            held.answers();
            held
        }

        fn send(&mut self, message: &Value) {
            let mut message = message.clone();
            message["jsonrpc"] = "2.0".into();
            self.session.handle(message.to_string().as_bytes());
        }

        fn ask(&mut self, id: i32) {
            let params = json!({ "textDocument": { "uri": "file:///a.pyr" } });
            self.send(&json!({ "id": id, "method": "textDocument/documentSymbol", "params": params }));
        }

        fn work(&self) {
            self.work.try_iter().for_each(|work| work.now_or_never().unwrap());
        }

        fn answers(&self) -> Vec<(Value, Option<i64>)> {
            let messages = self.sent.try_iter().flatten().map(|body| serde_json::from_slice(&body).unwrap());
            let answers = messages.filter(|message: &Value| message.get("id").is_some());
            answers.map(|answer| (answer["id"].clone(), answer["error"]["code"].as_i64())).collect()
        }
    }

    #[test]
    fn long_work_does_not_keep_others_waiting() {
        let mut held = Held::new();
        held.ask(1);
        let params =
            json!({ "textDocument": { "uri": "file:///a.pyr" }, "position": { "line": 0, "character": 1 } });
        held.send(&json!({ "id": 2, "method": "textDocument/hover", "params": params }));
        assert_eq!(held.answers(), [(json!(2), None)]);
        held.work();
        assert_eq!(held.answers(), [(json!(1), None)]);
    }

    #[test]
    fn work_on_a_text_that_is_no_more_is_not_answered() {
        let mut held = Held::new();
        held.ask(1);
        let document = json!({ "uri": "file:///a.pyr", "version": 2 });
        let changes = json!([{ "text": "wheel" }]);
        let params = json!({ "textDocument": document, "contentChanges": changes });
        held.send(&json!({ "method": "textDocument/didChange", "params": params }));
        held.work();
        assert_eq!(held.answers(), [(json!(1), Some(-32801))]);
        held.ask(2);
        assert_eq!(held.answers(), [(json!(2), None)], "what is short is answered at once");
    }

    #[test]
    fn work_that_is_taken_back_is_not_done() {
        let mut held = Held::new();
        held.ask(1);
        held.ask(2);
        held.send(&json!({ "method": "$/cancelRequest", "params": { "id": 1 } }));
        held.work();
        assert_eq!(held.answers(), [(json!(1), Some(-32800)), (json!(2), None)]);
        held.send(&json!({ "method": "$/cancelRequest", "params": { "id": 2 } }));
        held.work();
        assert_eq!(held.answers(), [], "it was answered already");
    }
}
