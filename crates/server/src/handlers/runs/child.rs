//! A child process from its start to its end: progress and cancellation.

use std::collections::VecDeque;

use futures::StreamExt;
use futures::channel::mpsc::UnboundedReceiver;
use pydslrep_trace::{RunEvent, RunFailure};
use tower_lsp::ls_types::ProgressToken;

use crate::children::{ChildEvent, KillOnDrop, Running};
use crate::server::Server;

/// The maximum number of lines of a failed child's output that are part of the error.
const MAX_LINES: usize = 50;

/// A child that has ended.
#[derive(Debug, Default)]
pub(super) struct Ended {
    /// Its exit code, if it has one.
    pub(super) code: Option<i32>,
    /// Its whole standard output.
    pub(super) printed: String,
    /// The last lines of its standard error.
    pub(super) stderr: Vec<String>,
    /// The report of a run.
    pub(super) report: Report,
}

/// The events of a run that matter at its end.
#[derive(Debug, Default)]
pub(super) struct Report {
    /// The result in numbers.
    pub(super) figures: serde_json::Value,
    /// The same for people.
    pub(super) table: String,
    /// Why it failed.
    pub(super) failure: Option<RunFailure>,
}

impl Report {
    /// Reads a line of standard output. Returns the text to show while the run continues, if any.
    fn read(&mut self, line: &str) -> Option<String> {
        match RunEvent::parse(line)? {
            // Of the preparations: while robots drive, nothing moves but they.
            RunEvent::Progress { text, robot: None, .. } => Some(text),
            RunEvent::Note { text } => Some(format!("note: {text}")),
            RunEvent::Warning { text, .. } => Some(format!("warning: {text}")),
            RunEvent::Figures { figures, table } => {
                (self.figures, self.table) = (figures, table);
                None
            }
            RunEvent::Failed(failure) => {
                self.failure = Some(failure);
                None
            }
            RunEvent::Progress { .. }
            | RunEvent::Started { .. }
            | RunEvent::ActionBegun(_)
            | RunEvent::ActionEnded(_)
            | RunEvent::Contact(_)
            | RunEvent::File { .. } => None,
        }
    }
}

/// The form in which a child reports progress.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Tells {
    /// Lines on standard error.
    Lines,
    /// Events on standard output (`docs/run-events.md`).
    Events,
}

/// Waits for the end of a child, and reports its progress under a title. The child ends with the request.
pub(super) async fn follow(
    server: &Server,
    asked: Option<ProgressToken>,
    title: String,
    tells: Tells,
    (running, mut events): (Running, UnboundedReceiver<ChildEvent>),
) -> Ended {
    let _kill = KillOnDrop(running.clone());
    let name = format!("pydslrep run {}", server.children().count());
    // The client's, otherwise one of ours.
    let token = if asked.is_some() { asked } else { server.progress_token(name).await };
    let progress = match token {
        Some(token) => {
            server.children().name(&running, &token);
            Some(server.client.progress(token, title).with_cancel_button().begin().await)
        }
        None => None,
    };
    let mut stderr = VecDeque::new();
    let mut ended = Ended::default();
    while let Some(event) = events.next().await {
        match event {
            ChildEvent::Ended(code) => ended.code = code,
            ChildEvent::Printed(line) if tells == Tells::Events => {
                if let (Some(text), Some(progress)) = (ended.report.read(&line), &progress) {
                    progress.report_with_message(text, None).await;
                }
            }
            ChildEvent::Printed(line) => ended.printed += &line,
            ChildEvent::Line(line) => {
                if let (Some(progress), Tells::Lines) = (&progress, tells) {
                    progress.report_with_message(line.clone(), None).await;
                }
                stderr.push_back(line);
                if stderr.len() > MAX_LINES {
                    stderr.pop_front();
                }
            }
        }
    }
    server.children().remove(&running);
    if let Some(progress) = progress {
        progress.finish().await;
    }
    Ended { stderr: stderr.into(), ..ended }
}
