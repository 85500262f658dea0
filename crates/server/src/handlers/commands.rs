//! `workspace/executeCommand`: everything that can be executed. `docs/protocol.md` has its table from here.

use futures::FutureExt;
use futures::channel::oneshot;
use futures::future::{BoxFuture, ready};
use pydslrep_output::Changed;
use serde::de::DeserializeOwned;
use tower_lsp::jsonrpc::{Error, Result};
use tower_lsp::ls_types::request::ShowMessageRequest;
use tower_lsp::ls_types::{ExecuteCommandOptions, ExecuteCommandParams, LSPAny, ServerCapabilities};

use crate::chosen::ChosenEnvironment;
use crate::client::ClientFeatures;
use crate::handlers::{code_actions, hover, scripts};
#[cfg(feature = "process")]
use crate::handlers::{
    preview,
    runs::{self, scenes},
};
use crate::server::Server;

/// A command, which takes one argument.
struct Command {
    name: &'static str,
    /// The fields of its argument.
    argument: &'static str,
    #[cfg_attr(not(test), expect(dead_code, reason = "for the page"))]
    does: &'static str,
    #[cfg_attr(not(test), expect(dead_code, reason = "for the page"))]
    returns: &'static str,
    run: fn(Server, ExecuteCommandParams) -> BoxFuture<'static, Result<Option<LSPAny>>>,
}

const COMMANDS: &[Command] = &[
    Command {
        name: code_actions::GENERATE_SCRIPT,
        argument: "{uri, environment}",
        does: "writes the script next to the program and the package that it imports, and shows the script; asks before \
               it replaces a script that was changed",
        returns: "nothing",
        run: |server, params| generate_script(server, params).boxed(),
    },
    Command {
        name: code_actions::WRITE_RUNTIME,
        argument: "{uri, environment}",
        does: "writes the package that the script imports next to it, unless it is installed",
        returns: "nothing",
        run: |server, params| write_runtime(server, params).boxed(),
    },
    #[cfg(feature = "process")]
    Command {
        name: runs::RUN,
        argument: "{uri, environment}",
        does: "runs the environment in the embedded simulator, draws the planned and the driven path",
        returns: "`{picture, replay, output, figures}`",
        run: |server, params| with_argument(server, params, runs::run).boxed(),
    },
    #[cfg(feature = "process")]
    Command {
        name: runs::PREVIEW_PATH,
        argument: "{uri, environment}",
        does: "draws the planned path",
        returns: "`{picture, replay, output}`",
        run: |server, params| with_argument(server, params, runs::run).boxed(),
    },
    #[cfg(feature = "process")]
    Command {
        name: preview::OPEN_PREVIEW,
        argument: "{uri?, environment?}",
        does: "starts the live preview and opens it in a browser, or says where it is",
        returns: "`{address}`",
        run: |server, params| open_preview(server, params).boxed(),
    },
    #[cfg(feature = "process")]
    Command {
        name: scenes::PUSH,
        argument: "{uri, environment, replace?}",
        does: "builds the environment's scene in a running CoppeliaSim; asks before it replaces what it built before",
        returns: "`{robots, obstacles, notes}`",
        run: |server, params| with_argument(server, params, scenes::push).boxed(),
    },
    #[cfg(feature = "process")]
    Command {
        name: scenes::CHECK,
        argument: "{uri, environment}",
        does: "checks the scene of a running CoppeliaSim against the environment, shows what is wrong and what to do",
        returns: "`{findings}`",
        run: |server, params| with_argument(server, params, scenes::check).boxed(),
    },
    #[cfg(feature = "process")]
    Command {
        name: scenes::REMOVE,
        argument: "{uri, environment}",
        does: "removes what was built for the environment from a running CoppeliaSim",
        returns: "`{removed, main_script}`",
        run: |server, params| with_argument(server, params, scenes::remove).boxed(),
    },
    Command {
        name: hover::SHOW_KINEMATICS,
        argument: "{uri, robot}",
        does: "nothing",
        returns: "Markdown: the robot's wheels and equations",
        run: |server, params| ready(show_kinematics(&server, &params)).boxed(),
    },
];

pub(crate) fn announce(server: &mut ServerCapabilities, _: &ClientFeatures) {
    let commands = COMMANDS.iter().map(|command| command.name.to_owned()).collect();
    let options = ExecuteCommandOptions { commands, ..ExecuteCommandOptions::default() };
    server.execute_command_provider = Some(options);
}

fn find(name: &str) -> Option<&'static Command> {
    COMMANDS.iter().find(|command| command.name == name)
}

/// Runs a command.
///
/// # Errors
///
/// If there is no such command, or it fails.
pub(crate) async fn execute(server: Server, params: ExecuteCommandParams) -> Result<Option<LSPAny>> {
    let Some(command) = find(&params.command) else {
        return Err(Error::invalid_params(format!("no command `{}`", params.command)));
    };
    (command.run)(server, params).await
}

async fn generate_script(server: Server, params: ExecuteCommandParams) -> Result<Option<LSPAny>> {
    let which: ChosenEnvironment = argument(&params)?;
    let question = scripts::question(&server.state().view, &which)?;
    let changed = match question {
        None => Changed::Keep,
        Some(question) => {
            // A client that cannot ask has not said yes.
            let answer = server.client.send_request::<ShowMessageRequest>(question).await.ok().flatten();
            if !scripts::allows(answer.as_ref()) {
                return Err(scripts::cancelled("the script is kept as it is"));
            }
            Changed::Replace
        }
    };
    if server.state().view.provided.is_some() {
        return apply_script(&server, &which).await;
    }
    let (written, runtime) = scripts::write_script(&server.state(), &which, changed, &server.outbox)?;
    finish(runtime).await;
    let shows_documents = server.state().view.client.show_document;
    if shows_documents {
        // The script exists, whether or not the client shows it.
        let _ = server.client.show_document(scripts::show(written)).await;
    }
    Ok(None)
}

/// Has the client create the script: there is no disk.
async fn apply_script(server: &Server, which: &ChosenEnvironment) -> Result<Option<LSPAny>> {
    let edit = scripts::edit(&scripts::generate(&server.state().view, which)?);
    let applied = server.client.apply_edit(edit).await?;
    if applied.applied {
        return Ok(None);
    }
    let reason = applied.failure_reason.unwrap_or_else(|| "the editor did not create the script".to_owned());
    Err(scripts::failure(reason))
}

async fn write_runtime(server: Server, params: ExecuteCommandParams) -> Result<Option<LSPAny>> {
    let runtime = scripts::write_runtime(&server.state(), &argument(&params)?, &server.outbox)?;
    finish(runtime).await;
    Ok(None)
}

/// Waits for a package that is being written.
async fn finish(runtime: Option<oneshot::Receiver<()>>) {
    if let Some(written) = runtime {
        // It may not have been begun, which is in the log.
        let _ = written.await;
    }
}

/// Runs a command with its argument.
#[cfg(feature = "process")]
async fn with_argument<T: DeserializeOwned, F: Future<Output = Result<Option<LSPAny>>>>(
    server: Server,
    params: ExecuteCommandParams,
    run: fn(Server, ExecuteCommandParams, T) -> F,
) -> Result<Option<LSPAny>> {
    let argument = argument(&params)?;
    run(server, params, argument).await
}

/// The argument may be missing: not all editors can send one.
#[cfg(feature = "process")]
async fn open_preview(server: Server, params: ExecuteCommandParams) -> Result<Option<LSPAny>> {
    let shown = if params.arguments.is_empty() { preview::Shown::default() } else { argument(&params)? };
    preview::open(server, shown).await
}

fn show_kinematics(server: &Server, params: &ExecuteCommandParams) -> Result<Option<LSPAny>> {
    hover::show_kinematics(&server.state().view, &argument(params)?)
}

/// The argument of a command.
///
/// # Errors
///
/// If it is not what the command takes.
fn argument<T: DeserializeOwned>(params: &ExecuteCommandParams) -> Result<T> {
    let argument = match params.arguments.as_slice() {
        [argument] => serde_json::from_value(argument.clone()).ok(),
        _ => None,
    };
    argument.ok_or_else(|| {
        let fields = find(&params.command).map_or("", |command| command.argument);
        Error::invalid_params(format!("`{}` takes one argument: {fields}", params.command))
    })
}

#[cfg(test)]
mod tests {
    use std::fmt::Write;
    use std::fs;
    use std::path::Path;

    use super::*;

    /// `UPDATE_EXPECT=1` writes the table.
    #[cfg(feature = "process")]
    #[test]
    fn the_protocol_page_lists_every_command() {
        let mut table = String::from("| command | argument | does | returns |\n|---|---|---|---|\n");
        for Command { name, argument, does, returns, .. } in COMMANDS {
            writeln!(table, "| `{name}` | `{argument}` | {does} | {returns} |").unwrap();
        }
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/protocol.md");
        let page = fs::read_to_string(&path).unwrap();
        let start = page.find("| command |").unwrap();
        let length = page[start..].find("\n\n").unwrap() + 1;
        let expected = format!("{}{table}{}", &page[..start], &page[start + length..]);
        if std::env::var_os("UPDATE_EXPECT").is_some() {
            fs::write(&path, &expected).unwrap();
        }
        assert!(fs::read_to_string(&path).unwrap() == expected, "run it with UPDATE_EXPECT=1");
    }
}
