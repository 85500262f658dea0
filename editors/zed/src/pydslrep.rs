//! Starts the language server for Zed, found on the user's PATH.

use zed_extension_api::{self as zed, Command, LanguageServerId, Result, Worktree};

struct PyDslRep;

impl zed::Extension for PyDslRep {
    fn new() -> Self {
        Self
    }

    fn language_server_command(&mut self, _: &LanguageServerId, worktree: &Worktree) -> Result<Command> {
        let command = worktree.which("pydslrep-lsp").ok_or(
            "pydslrep-lsp is not on your PATH: run `cargo install --locked --path crates/server` in PyDSLRep",
        )?;
        Ok(Command { command, args: vec!["--stdio".to_owned()], env: worktree.shell_env() })
    }
}

zed::register_extension!(PyDslRep);
