//! Runs, from their start to their picture and the answer.

use tower_lsp::jsonrpc::Result;
use tower_lsp::ls_types::{ExecuteCommandParams, LSPAny, ShowDocumentParams, Uri};

use super::child::{Ended, Tells, follow};
use super::failed_run;
use crate::chosen::ChosenEnvironment;
use crate::handlers::{planned_path, runs};
use crate::server::Server;
use crate::state::State;

/// Runs or plans an environment in a child process; answers with the picture's URI, the result in numbers
/// and what was printed.
pub(crate) async fn run(
    server: Server,
    params: ExecuteCommandParams,
    which: ChosenEnvironment,
) -> Result<Option<LSPAny>> {
    let is_run = params.command == runs::RUN;
    let (job, planned) = {
        let view = &server.state().view;
        let planned = is_run.then(|| planned_path::as_json(view, &which)).flatten();
        (runs::prepare(view, &which, &params.command)?, planned)
    };
    let (running, events, picture) = job.start(&mut server.children())?;
    let title = format!("{} {}", if is_run { "Running" } else { "Planning" }, which.environment);
    let token = params.work_done_progress_params.work_done_token;
    let tells = if is_run { Tells::Events } else { Tells::Lines };
    let Ended { code, printed, stderr, report } =
        follow(&server, token, title, tells, (running, events)).await;
    if is_run {
        // The path up to a failure is worth showing too.
        let State { view, pages, .. } = &*server.state();
        let files = (&*runs::trace(&picture), &*runs::map(&picture));
        view.driven.add(&which, planned.as_ref(), files, &server.outbox, pages);
    }
    // The plan of one environment is drawn even if others have errors; the exit code reports those.
    let is_drawn = || std::fs::metadata(&picture).is_ok_and(|file| file.len() > 0);
    let is_done = code == Some(0) || !is_run && is_drawn();
    if !is_done {
        // Nothing was drawn.
        let _ = std::fs::remove_file(&picture);
        let _ = std::fs::remove_file(runs::replay(&picture));
        let error = match &report.failure {
            Some(failure) => failed_run::error(&server.state().view, &which, failure, &stderr),
            None => runs::ended_badly(code, &stderr),
        };
        return Err(error);
    }
    let output = if is_run { report.table } else { printed };
    let replay = Uri::from_file_path(runs::replay(&picture));
    let picture = Uri::from_file_path(&picture);
    let shows_documents = server.state().view.client.show_document;
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
    let result = serde_json::json!({ "picture": picture, "replay": replay, "output": output, "figures": report.figures });
    Ok(Some(result))
}
