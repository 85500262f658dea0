//! `pydslrep lsp` and `pydslrep completions`.

use crate::process::Place;

#[test]
fn an_editor_is_served_on_standard_input() {
    let messages = [
        r#"{"jsonrpc":"2.0","id":1,"method":"initialize","params":{"capabilities":{}}}"#,
        r#"{"jsonrpc":"2.0","method":"initialized","params":{}}"#,
        r#"{"jsonrpc":"2.0","id":2,"method":"shutdown"}"#,
        r#"{"jsonrpc":"2.0","method":"exit"}"#,
    ];
    let framed = messages.map(|message| format!("Content-Length: {}\r\n\r\n{message}", message.len()));
    let input = framed.concat();
    for arguments in [&["lsp"][..], &["lsp", "--stdio"]] {
        let done = Place::new().run_with(arguments, input.as_bytes());
        assert_eq!(done.code, Some(0));
        assert!(done.out.contains("\"capabilities\""), "{}", done.out);
    }
}

#[test]
fn an_editor_that_does_not_listen_is_an_outside_failure() {
    // Bound and let go: nobody listens there.
    let listener = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let port = listener.local_addr().unwrap().port().to_string();
    drop(listener);
    let done = Place::new().run(&["lsp", "--socket", &port]);
    assert_eq!(done.code, Some(2));
    assert!(done.err.contains(&port), "{}", done.err);
}

#[test]
fn shells_can_complete() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let done = Place::new().run(&["completions", shell]);
        assert_eq!(done.code, Some(0));
        assert!(done.out.contains("pydslrep") && done.out.contains("check"), "{shell}");
    }
}

#[test]
fn an_editor_is_served_in_an_edition() {
    let messages = [
        r#"{"jsonrpc":"2.0","id":1,"method":"initialize","params":{"capabilities":{"textDocument":{"diagnostic":{}}}}}"#,
        r#"{"jsonrpc":"2.0","method":"initialized","params":{}}"#,
        r#"{"jsonrpc":"2.0","method":"textDocument/didOpen","params":{"textDocument":{"uri":"file:///x.pyr","languageId":"pydslrep","version":1,"text":"movement m of r { wait 1 seconds }"}}}"#,
        r#"{"jsonrpc":"2.0","id":2,"method":"textDocument/diagnostic","params":{"textDocument":{"uri":"file:///x.pyr"}}}"#,
        r#"{"jsonrpc":"2.0","id":3,"method":"shutdown"}"#,
        r#"{"jsonrpc":"2.0","method":"exit"}"#,
    ];
    let framed = messages.map(|message| format!("Content-Length: {}\r\n\r\n{message}", message.len()));
    for (arguments, is_told) in [(&["lsp"][..], false), (&["lsp", "--edition", "article"], true)] {
        let done = Place::new().run_with(arguments, framed.concat().as_bytes());
        assert_eq!((done.code, done.out.contains("not-in-article")), (Some(0), is_told), "{}", done.out);
    }
}
