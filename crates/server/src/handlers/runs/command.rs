//! Runs, from their start to their picture: progress, cancellation, and the answer.

use std::collections::VecDeque;

use futures::StreamExt;
use tower_lsp::jsonrpc::Result;
use tower_lsp::ls_types::{
    ExecuteCommandParams, LSPAny, ProgressToken, ShowDocumentParams, Uri, WorkDoneProgressCreateParams,
    request,
};

use crate::children::{ChildEvent, KillOnDrop};
use crate::chosen::ChosenEnvironment;
use crate::handlers::runs;
use crate::server::Server;

/// How many lines of a failed run's output are part of the error.
const MOST_LINES: usize = 50;

/// Runs or plans an environment in a child process; answers with the picture's URI, the result in numbers
/// and what was printed.
pub(crate) async fn run(
    server: Server,
    params: ExecuteCommandParams,
    which: ChosenEnvironment,
) -> Result<Option<LSPAny>> {
    let job = runs::prepare(&server.state(), &which, &params.command)?;
    let (running, mut events, picture) = job.start(&mut server.children())?;
    let _kill = KillOnDrop(running.clone());
    let token = run_token(&server, params.work_done_progress_params.work_done_token).await;
    let progress = match &token {
        Some(token) => {
            server.children().name(&running, token);
            let title = format!(
                "{} {}",
                if params.command == runs::RUN { "Running" } else { "Planning" },
                which.environment
            );
            Some(server.client.progress(token.clone(), title).with_cancel_button().begin().await)
        }
        None => None,
    };
    let mut said = VecDeque::new();
    let mut ended = (None, String::new());
    while let Some(event) = events.next().await {
        match event {
            ChildEvent::Ended(code, printed) => ended = (code, printed),
            ChildEvent::Line(line) => {
                if let Some(progress) = &progress {
                    progress.report_with_message(line.clone(), None).await;
                }
                said.push_back(line);
                if said.len() > MOST_LINES {
                    said.pop_front();
                }
            }
        }
    }
    server.children().remove(&running);
    if params.command == runs::RUN {
        // The path up to a failure is worth showing too.
        server.state().driven.add(&which, &runs::trace(&picture), &runs::map(&picture), &server.outbox);
    }
    if let Some(progress) = progress {
        progress.finish().await;
    }
    let (code, printed) = ended;
    // The plan of one environment is drawn even if others have errors; the exit code reports those.
    let is_drawn = || std::fs::metadata(&picture).is_ok_and(|file| file.len() > 0);
    let is_done = code == Some(0) || params.command == runs::PREVIEW_PATH && is_drawn();
    if !is_done {
        // Nothing was drawn.
        let _ = std::fs::remove_file(&picture);
        let _ = std::fs::remove_file(runs::replay(&picture));
        return Err(runs::ended_badly(code, said.make_contiguous()));
    }
    let figures = std::fs::read(runs::figures(&picture)).unwrap_or_default();
    // A plan has none.
    let figures: LSPAny = serde_json::from_slice(&figures).unwrap_or_default();
    let replay = Uri::from_file_path(runs::replay(&picture));
    let picture = Uri::from_file_path(&picture);
    let shows_documents = server.state().client.show_document;
    if let (Some(uri), true) = (&picture, shows_documents) {
        let show = ShowDocumentParams {
            uri: uri.clone(),
            external: Some(true),
            take_focus: Some(false),
            selection: None,
        };
        // The picture exists, whether or not the client shows it.
        let _ = server.client.show_document(show).await;
    }
    let result =
        serde_json::json!({ "picture": picture, "replay": replay, "output": printed, "figures": figures });
    Ok(Some(result))
}

/// The token of a run's progress: the client's, otherwise one of ours; `None` where the client shows none.
async fn run_token(server: &Server, asked: Option<ProgressToken>) -> Option<ProgressToken> {
    if asked.is_some() || !server.state().client.progress {
        return asked;
    }
    let token = ProgressToken::String(format!("pydslrep run {}", server.children().count()));
    let params = WorkDoneProgressCreateParams { token: token.clone() };
    server.client.send_request::<request::WorkDoneProgressCreate>(params).await.ok()?;
    Some(token)
}
