//! A session with its executor, and the messages that it has for the client.

use std::fmt;
use std::sync::mpsc::{self, Receiver};

use pydslrep_server::{Outbox, Session};

use crate::executor::Executor;

/// A session of the language server.
pub(crate) struct Conversation {
    session: Session,
    executor: Executor,
    messages: Receiver<Option<Vec<u8>>>,
}

impl fmt::Debug for Conversation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Conversation").field("session", &self.session).finish_non_exhaustive()
    }
}

impl Default for Conversation {
    fn default() -> Self {
        let executor = Executor::default();
        let (sender, messages) = mpsc::channel();
        let arrivals = executor.arrivals();
        let session = Session::in_memory(Outbox::new(sender), move |future| arrivals.add(future));
        Self { session, executor, messages }
    }
}

impl Conversation {
    /// Handles one message.
    pub(crate) fn handle(&mut self, message: &str) {
        if self.session.handle(message.as_bytes()).is_some() {
            self.session.leave();
        }
    }

    /// See [`LanguageServer::proceed`](crate::LanguageServer::proceed).
    pub(crate) fn proceed(&mut self) -> bool {
        self.session.flush_diagnostics();
        self.executor.turn()
    }

    /// The messages to the client since the last call.
    pub(crate) fn take_messages(&mut self) -> Vec<String> {
        let bodies = self.messages.try_iter().flatten();
        bodies.filter_map(|body| String::from_utf8(body).ok()).collect()
    }
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;

    const PROGRAM: &str = "wheel l with radius 4.5\nwheel r with radius 4.5\n\
        robot a type tw with port 23000 has { l r } wheels\nmovement m of a { move 1 meters }\n\
        environment area has { a } robots with { m } moves\n";

    #[derive(Default)]
    struct Client {
        conversation: Conversation,
        received: Vec<Value>,
    }

    impl Client {
        /// One that has begun a session in the folder `/w`.
        fn new() -> Self {
            let mut client = Self::default();
            let folder = json!([{ "uri": "file:///w", "name": "w" }]);
            let parameters = json!({ "processId": null, "capabilities": {}, "workspaceFolders": folder });
            client.request("initialize", &parameters);
            client.notify("initialized", &json!({}));
            client
        }

        fn send(&mut self, message: &Value) {
            self.conversation.handle(&message.to_string());
            while self.conversation.proceed() {}
            let messages = self.conversation.take_messages();
            self.received.extend(messages.iter().map(|message| serde_json::from_str(message).unwrap()));
        }

        fn notify(&mut self, method: &str, params: &Value) {
            self.send(&json!({ "jsonrpc": "2.0", "method": method, "params": params }));
        }

        fn request(&mut self, method: &str, params: &Value) -> Value {
            self.received.clear();
            self.send(&json!({ "jsonrpc": "2.0", "id": 1, "method": method, "params": params }));
            let answer = self.received.iter().find(|message| message["id"] == 1);
            answer.expect("an answer").clone()
        }

        fn provide(&mut self, uri: &str, text: Option<&str>) {
            self.received.clear();
            self.notify("pydslrep/files", &json!({ "files": [{ "uri": uri, "text": text }] }));
        }

        fn open(&mut self, uri: &str, text: &str) {
            self.received.clear();
            let document = json!({ "uri": uri, "languageId": "pydslrep", "version": 1, "text": text });
            self.notify("textDocument/didOpen", &json!({ "textDocument": document }));
        }

        /// The messages of the diagnostics that were last published about a document.
        fn problems(&self, uri: &str) -> Vec<&str> {
            let published = self.received.iter().rev().find(|message| {
                message["method"] == "textDocument/publishDiagnostics" && message["params"]["uri"] == uri
            });
            let diagnostics = published.and_then(|message| message["params"]["diagnostics"].as_array());
            let texts = diagnostics.into_iter().flatten().filter_map(|problem| problem["message"].as_str());
            texts.map(|text| text.lines().next().unwrap_or_default()).collect()
        }
    }

    #[test]
    fn what_is_not_open_is_provided() {
        let mut client = Client::new();
        let (program, scene) = ("file:///w/a.pyr", "file:///w/area.scene.toml");
        client.open(program, "import \"b.pyr\"\nmovement m2 of a { move 1 meters }\n");
        assert_eq!(client.problems(program).len(), 1, "{:?}", client.received);
        client.provide("file:///w/b.pyr", Some(PROGRAM));
        assert_eq!(client.problems(program), Vec::<&str>::new(), "{:?}", client.received);
        client.provide(scene, Some("nonsense = 1\n"));
        assert_eq!(client.problems(scene).len(), 1, "{:?}", client.received);
        client.provide(scene, None);
        assert_eq!(client.problems(scene), Vec::<&str>::new());
    }

    #[test]
    fn scripts_are_returned_as_text() {
        let mut client = Client::new();
        client.open("file:///w/a.pyr", PROGRAM);
        let which = json!({ "uri": "file:///w/a.pyr", "environment": "area" });
        let answer = client.request("pydslrep/script", &which);
        assert_eq!(answer["result"]["uri"], "file:///w/area.py");
        let text = answer["result"]["text"].as_str().unwrap();
        assert!(text.contains("await a.move(1.0)"), "{text}");
    }

    #[test]
    fn a_script_of_the_user_is_kept() {
        let capabilities = json!({
            "textDocument": { "codeAction": { "codeActionLiteralSupport": { "codeActionKind": { "valueSet": [] } } } },
            "workspace": { "workspaceEdit": { "documentChanges": true, "resourceOperations": ["create"] } },
        });
        let mut client = Client::default();
        client.request("initialize", &json!({ "processId": null, "capabilities": capabilities }));
        client.open("file:///w/a.pyr", PROGRAM);
        let range = json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 0, "character": 0 } });
        let parameters = json!({
            "textDocument": { "uri": "file:///w/a.pyr" }, "range": range,
            "context": { "diagnostics": [], "only": ["source.generateScript"] },
        });
        let answer = client.request("textDocument/codeAction", &parameters);
        let create = &answer["result"][0]["edit"]["documentChanges"][0];
        assert_eq!((&create["kind"], &create["uri"]), (&json!("create"), &json!("file:///w/area.py")));
        client.provide("file:///w/area.py", Some("print('mine')\n"));
        let answer = client.request("textDocument/codeAction", &parameters);
        assert_eq!(answer["result"], json!([]), "it is not a generated script");
    }
}
