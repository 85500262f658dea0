//! The commands on the scene of a running `CoppeliaSim`: it is built from a program, checked against it, and removed.

use std::process::Command;

use serde::Deserialize;
use serde_json::Value;
use tower_lsp::jsonrpc::Result;
use tower_lsp::ls_types::request::ShowMessageRequest;
use tower_lsp::ls_types::{
    ExecuteCommandParams, LSPAny, MessageType, ProgressToken, ShowMessageRequestParams,
};

use super::child::{Ended, Tells, follow};
use super::{INTERRUPTED, copy, ended_badly, start};
use crate::chosen::ChosenEnvironment;
use crate::handlers::scripts::{cancelled, choice, failure};
use crate::server::Server;

/// Builds the scene of an environment.
pub(crate) const PUSH: &str = "pydslrep.pushScene";

/// Removes the objects that were built for an environment.
pub(crate) const REMOVE: &str = "pydslrep.removeScene";

/// Checks the scene against an environment.
pub(crate) const CHECK: &str = "pydslrep.checkScene";

/// The reason of a refusal that [`question`] is about, as `pydslrep scene push --json` gives it.
const BUILT_ALREADY: &str = "built-already";

/// The answers to [`question`].
const REPLACE: &str = "Replace Them";
const KEEP: &str = "Keep Them";

/// So many findings are in the message; all are in the answer.
const MAX_FINDINGS: usize = 3;

/// The argument of [`PUSH`].
#[derive(Debug, Deserialize)]
pub(crate) struct Push {
    #[serde(flatten)]
    which: ChosenEnvironment,
    /// True if an earlier build is replaced without asking.
    #[serde(default)]
    replace: bool,
}

/// The output of `pydslrep` with `--json`.
#[derive(Debug, Deserialize)]
#[serde(untagged)]
enum Printed<T> {
    Refusal { error: String, help: Option<String>, reason: Option<String> },
    Answer(T),
}

#[derive(Debug, Deserialize)]
struct Built {
    robots: usize,
    obstacles: usize,
    notes: Vec<String>,
}

#[derive(Debug, Deserialize)]
struct Removed {
    removed: usize,
    main_script: bool,
}

#[derive(Debug, Deserialize)]
struct Finding {
    severity: String,
    robot: Option<String>,
    message: String,
    help: String,
}

/// [`PUSH`]: builds the scene; asks before it replaces an earlier build.
///
/// # Errors
///
/// If the environment has errors, the simulator does not reply or refuses, or the user keeps what is there.
pub(crate) async fn push(server: Server, params: ExecuteCommandParams, push: Push) -> Result<Option<LSPAny>> {
    let Push { which, mut replace } = push;
    let mut token = params.work_done_progress_params.work_done_token;
    let title = format!("Building the scene of {}", which.environment);
    loop {
        let options: &[&str] = if replace { &["--replace"] } else { &[] };
        let child = Child { task: &["scene", "push"], options, has_program: true };
        let (place, ended) = child.run(&server, token.take(), &title, &which).await?;
        match serde_json::from_str(&ended.printed) {
            Ok(Printed::Refusal { error, reason, .. })
                if reason.as_deref() == Some(BUILT_ALREADY) && !replace =>
            {
                let asked = server.client.send_request::<ShowMessageRequest>(question(&place, &error)).await;
                // A client that cannot ask has not said yes.
                let answer = asked.map_err(|_| {
                    failure(format!(
                        "{error}; the command replaces them if its argument has `\"replace\": true`"
                    ))
                })?;
                if answer.is_none_or(|answer| answer.title != REPLACE) {
                    return Err(cancelled("the scene is kept as it is"));
                }
                replace = true;
            }
            Ok(Printed::Answer(Built { robots, obstacles, notes })) => {
                let (robots, obstacles) = (count(robots, "robot"), count(obstacles, "obstacle"));
                let built = format!("Built {robots} and {obstacles} in CoppeliaSim at {place}");
                let message = [built].into_iter().chain(notes).collect::<Vec<_>>().join("; ");
                server.outbox.tell(MessageType::INFO, message);
                return Ok(serde_json::from_str(&ended.printed).ok());
            }
            refused => return Err(unanswered(refused.ok(), &ended)),
        }
    }
}

/// [`REMOVE`].
///
/// # Errors
///
/// If the simulator does not reply.
pub(crate) async fn remove(
    server: Server,
    params: ExecuteCommandParams,
    which: ChosenEnvironment,
) -> Result<Option<LSPAny>> {
    let title = format!("Removing the scene of {}", which.environment);
    let token = params.work_done_progress_params.work_done_token;
    let child = Child { task: &["scene", "remove"], options: &[], has_program: false };
    let (place, ended) = child.run(&server, token, &title, &which).await?;
    match serde_json::from_str(&ended.printed) {
        Ok(Printed::Answer(Removed { removed, main_script })) => {
            let removed = count(removed, "object");
            let script = if main_script { " and the main script" } else { "" };
            let message = format!("Removed {removed}{script} from CoppeliaSim at {place}");
            server.outbox.tell(MessageType::INFO, message);
            Ok(serde_json::from_str(&ended.printed).ok())
        }
        refused => Err(unanswered(refused.ok(), &ended)),
    }
}

/// [`CHECK`]: shows the problems of the scene, with advice.
///
/// # Errors
///
/// If the environment has errors, or Python cannot be started.
pub(crate) async fn check(
    server: Server,
    params: ExecuteCommandParams,
    which: ChosenEnvironment,
) -> Result<Option<LSPAny>> {
    let title = format!("Checking the scene of {}", which.environment);
    let token = params.work_done_progress_params.work_done_token;
    // Whatever the scripts of the folder are for.
    let options = &["--target", "coppeliasim"];
    let child = Child { task: &["doctor"], options, has_program: true };
    let (place, ended) = child.run(&server, token, &title, &which).await?;
    let Ok(findings) = serde_json::from_str::<Vec<Finding>>(&ended.printed) else {
        return Err(unanswered::<Value>(None, &ended));
    };
    let (kind, message) = report(&findings, &place);
    server.outbox.tell(kind, message);
    let findings: Value = serde_json::from_str(&ended.printed).unwrap_or_default();
    Ok(Some(serde_json::json!({ "findings": findings })))
}

/// A command to start.
#[derive(Debug, Clone, Copy)]
struct Child<'a> {
    task: &'a [&'a str],
    options: &'a [&'a str],
    /// True if it is about a program, not only about an environment's name.
    has_program: bool,
}

impl Child<'_> {
    /// Runs it to its end; also returns the address of the simulator.
    async fn run(
        self,
        server: &Server,
        token: Option<ProgressToken>,
        title: &str,
        which: &ChosenEnvironment,
    ) -> Result<(String, Ended)> {
        let (copy, address) = {
            let state = server.state();
            let copy = copy(&state.view, which)?;
            let settings = state.view.document(&which.uri).map(|document| document.settings.clone());
            (copy, settings.unwrap_or_default().coppeliasim.clone())
        };
        let started = {
            let mut children = server.children();
            let mut command = Command::new(&children.command);
            command.args(self.task).args(self.options);
            if self.has_program {
                command.arg(&copy.program);
            }
            command.args(["--json", "--environment", &which.environment]);
            command.arg(format!("--host={}", address.host)).arg(format!("--port={}", address.port));
            start(&mut children, &mut command, copy.folder)?
        };
        let ended = follow(server, token, title.to_owned(), Tells::Lines, started).await;
        Ok((format!("{}:{}", address.host, address.port), ended))
    }
}

/// Asks whether to replace an earlier build.
fn question(place: &str, error: &str) -> ShowMessageRequestParams {
    choice(format!("CoppeliaSim at {place}: {error}. Replace them?"), [REPLACE, KEEP])
}

/// The error where there is no answer.
fn unanswered<T>(refusal: Option<Printed<T>>, ended: &Ended) -> tower_lsp::jsonrpc::Error {
    match refusal {
        _ if ended.code == Some(INTERRUPTED) => cancelled("the command was cancelled"),
        Some(Printed::Refusal { error, help: Some(help), .. }) => failure(format!("{error}; {help}")),
        Some(Printed::Refusal { error, .. }) => failure(error),
        _ => ended_badly(ended.code, &ended.stderr),
    }
}

/// The findings as one message.
fn report(findings: &[Finding], place: &str) -> (MessageType, String) {
    if findings.is_empty() {
        return (MessageType::INFO, format!("The scene at {place} fits the program"));
    }
    let kind = |word: &str| match word {
        "error" => MessageType::ERROR,
        "warning" => MessageType::WARNING,
        _ => MessageType::INFO,
    };
    let worst =
        ["error", "warning"].iter().find(|word| findings.iter().any(|found| found.severity == **word));
    let mut lines: Vec<String> = findings.iter().take(MAX_FINDINGS).map(Finding::line).collect();
    if findings.len() > MAX_FINDINGS {
        let more = findings.len() - MAX_FINDINGS;
        lines.push(format!("{more} more: `pydslrep doctor` lists all"));
    }
    (kind(worst.copied().unwrap_or_default()), lines.join("\n"))
}

impl Finding {
    fn line(&self) -> String {
        let robot = self.robot.as_ref().map(|robot| format!("robot {robot}: ")).unwrap_or_default();
        format!("{robot}{}; {}", self.message, self.help)
    }
}

fn count(number: usize, noun: &str) -> String {
    format!("{number} {noun}{}", if number == 1 { "" } else { "s" })
}
