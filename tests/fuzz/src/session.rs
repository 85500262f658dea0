//! Lines as messages of a client: a session answers each request, and no handler panics.

use std::cell::RefCell;
use std::rc::Rc;
use std::sync::mpsc;
use std::task::{Context, Waker};

use futures::future::BoxFuture;
use pydslrep_server::{Outbox, Session};
use serde_json::{Value, json};

const PROGRAM: &str = "wheel a with radius 4.5\nwheel b with radius 4.5\n\
    robot r with port 23000 has { a b } wheels\nmovement m of r { move 2 meters turn left }\n\
    environment e has { r } robots with { m } moves\n";

/// The code of answers to requests whose handler has panicked.
const INTERNAL_ERROR: i64 = -32603;

const MAX_LINES: usize = 64;

type Running = Rc<RefCell<Vec<BoxFuture<'static, ()>>>>;

/// Sends each line as one message, after those that open a program.
pub(crate) fn run(data: &[u8]) {
    let (sender, receiver) = mpsc::channel();
    let running = Running::default();
    let spawned = Rc::clone(&running);
    let mut session = Session::new(Outbox::new(sender), move |future| spawned.borrow_mut().push(future));
    let document =
        json!({"uri": "file:///fuzz/main.pyr", "languageId": "pydslrep", "version": 1, "text": PROGRAM});
    let opening = [
        json!({"jsonrpc": "2.0", "id": 0, "method": "initialize", "params": {"capabilities": {}}}),
        json!({"jsonrpc": "2.0", "method": "initialized", "params": {}}),
        json!({"jsonrpc": "2.0", "method": "textDocument/didOpen", "params": {"textDocument": document}}),
    ];
    for message in opening {
        session.handle(message.to_string().as_bytes());
        poll(&running);
    }
    for line in data.split(|&byte| byte == b'\n').take(MAX_LINES) {
        if session.handle(line).is_some() {
            return;
        }
        session.flush_diagnostics();
        poll(&running);
        check(&receiver);
    }
}

/// Runs everything that is under way as far as it goes.
fn poll(running: &Running) {
    // New work may begin while this runs.
    let mut futures = std::mem::take(&mut *running.borrow_mut());
    let mut context = Context::from_waker(Waker::noop());
    futures.retain_mut(|future| future.as_mut().poll(&mut context).is_pending());
    running.borrow_mut().append(&mut futures);
}

fn check(receiver: &mpsc::Receiver<Option<Vec<u8>>>) {
    for body in receiver.try_iter().flatten() {
        let message: Option<Value> = serde_json::from_slice(&body).ok();
        assert!(message.is_some(), "not JSON: {}", String::from_utf8_lossy(&body));
        assert!(message.is_none_or(|message| message["error"]["code"] != INTERNAL_ERROR), "a panic");
    }
}
