//! Runs, from their start to their picture: progress, cancellation, and the answer.

use std::collections::VecDeque;

use futures::StreamExt;
use tower_lsp::jsonrpc::Result;
use tower_lsp::ls_types::{
    ExecuteCommandParams, LSPAny, ProgressToken, ShowDocumentParams, Uri, WorkDoneProgressCreateParams,
    request,
};

use super::Server;
use crate::children::{Leash, News};
use crate::handlers::{runs, scripts};

/// Of what a run that failed has said, so many lines are told.
const MOST_LINES: usize = 50;

impl Server {
    /// Drives or plans an environment in a child process; answers with the picture's address and what was printed.
    pub(super) async fn run(&self, params: ExecuteCommandParams) -> Result<LSPAny> {
        let which = scripts::which(&params)?;
        let job = runs::prepare(&self.state(), &which, &params.command)?;
        let (running, mut news, picture) = job.start(&mut self.children())?;
        let _leash = Leash(running.clone());
        let token = self.run_token(params.work_done_progress_params.work_done_token).await;
        let progress = match &token {
            Some(token) => {
                self.children().name(&running, token);
                let title = format!(
                    "{} {}",
                    if params.command == runs::RUN { "Running" } else { "Planning" },
                    which.environment
                );
                Some(self.client.progress(token.clone(), title).with_cancel_button().begin().await)
            }
            None => None,
        };
        let mut said = VecDeque::new();
        let mut ended = (None, String::new());
        while let Some(news) = news.next().await {
            match news {
                News::Ended(code, printed) => ended = (code, printed),
                News::Line(line) => {
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
        self.children().remove(&running);
        if params.command == runs::RUN {
            // Also what was driven up to a failure is worth showing.
            self.state().driven.add(&which, &runs::trace(&picture), &runs::map(&picture), &self.outbox);
        }
        if let Some(progress) = progress {
            progress.finish().await;
        }
        let (code, printed) = ended;
        // A plan of one environment is drawn whatever is wrong with others; its exit code still tells of that.
        let is_drawn = || std::fs::metadata(&picture).is_ok_and(|file| file.len() > 0);
        let is_done = code == Some(0) || params.command == runs::PREVIEW_PATH && is_drawn();
        if !is_done {
            // Nothing was drawn.
            let _ = std::fs::remove_file(&picture);
            let _ = std::fs::remove_file(runs::replay(&picture));
            return Err(runs::ended_badly(code, said.make_contiguous()));
        }
        let replay = Uri::from_file_path(runs::replay(&picture));
        let picture = Uri::from_file_path(&picture);
        let shows_documents = self.state().client.show_document;
        if let (Some(uri), true) = (&picture, shows_documents) {
            let show = ShowDocumentParams {
                uri: uri.clone(),
                external: Some(true),
                take_focus: Some(false),
                selection: None,
            };
            // The picture is there, whether or not the client then shows it.
            let _ = self.client.show_document(show).await;
        }
        Ok(serde_json::json!({ "picture": picture, "replay": replay, "output": printed }))
    }

    /// Under which name a run shows its progress: the client's, else one of ours; `None` where it shows none.
    async fn run_token(&self, asked: Option<ProgressToken>) -> Option<ProgressToken> {
        if asked.is_some() || !self.state().client.progress {
            return asked;
        }
        let token = ProgressToken::String(format!("pydslrep run {}", self.children().count()));
        let params = WorkDoneProgressCreateParams { token: token.clone() };
        self.client.send_request::<request::WorkDoneProgressCreate>(params).await.ok()?;
        Some(token)
    }
}
