//! `workspace/executeCommand`: everything that can be executed. `docs/protocol.md` has its table from here.

use futures::FutureExt;
use futures::future::{BoxFuture, ready};
use serde::de::DeserializeOwned;
use tower_lsp::jsonrpc::{Error, Result};
use tower_lsp::ls_types::{ExecuteCommandOptions, ExecuteCommandParams, LSPAny, ServerCapabilities};

use crate::client::ClientFeatures;
#[cfg(feature = "process")]
use crate::handlers::runs;
use crate::handlers::{code_actions, hover, scripts};
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
        does: "writes the script next to the program, and shows it",
        returns: "nothing",
        run: |server, params| generate_script(server, params).boxed(),
    },
    #[cfg(feature = "process")]
    Command {
        name: runs::RUN,
        argument: "{uri, environment}",
        does: "runs the environment in the embedded simulator, draws the planned and the driven path",
        returns: "`{picture, replay, output, figures}`",
        run: |server, params| run(server, params).boxed(),
    },
    #[cfg(feature = "process")]
    Command {
        name: runs::PREVIEW_PATH,
        argument: "{uri, environment}",
        does: "draws the planned path",
        returns: "`{picture, replay, output}`",
        run: |server, params| run(server, params).boxed(),
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
    let written = scripts::write_script(&server.state(), &argument(&params)?, &server.outbox)?;
    let shows_documents = server.state().client.show_document;
    if shows_documents {
        // The script exists, whether or not the client shows it.
        let _ = server.client.show_document(scripts::show(written)).await;
    }
    Ok(None)
}

#[cfg(feature = "process")]
async fn run(server: Server, params: ExecuteCommandParams) -> Result<Option<LSPAny>> {
    let which = argument(&params)?;
    runs::run(server, params, which).await
}

fn show_kinematics(server: &Server, params: &ExecuteCommandParams) -> Result<Option<LSPAny>> {
    hover::show_kinematics(&server.state(), &argument(params)?)
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
