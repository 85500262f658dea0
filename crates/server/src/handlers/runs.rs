//! The commands that start `pydslrep` as a child process, on what the editor shows, saved or not. Those of this file are
//! `pydslrep.run` and `pydslrep.previewPath`, which run or plan it and draw a picture of it.
//!
//! The program and its imports are written to a temporary folder, as they are in the editor. The user's own files are
//! not changed.

mod child;
mod command;
mod failed_run;
pub(crate) mod scenes;

pub(crate) use self::command::run;

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;

use futures::channel::mpsc::UnboundedReceiver;
use pydslrep_analysis::{FileId, Target};
use pydslrep_config::FILE_NAME;
use pydslrep_output::TemporaryFolder;
use pydslrep_scene::ENDING;
use pydslrep_script::{VREP_CLIENT_PARTS, VREP_CLIENTS};
use pydslrep_workspace::path_of;
use tower_lsp::jsonrpc::{Error, Result};

use crate::children::{ChildEvent, Children, Running};
use crate::chosen::ChosenEnvironment;
use crate::handlers::scripts::{blocked, cancelled, environment, failure, opened};
use crate::view::View;

/// Runs an environment.
pub(crate) const RUN: &str = "pydslrep.run";

/// Plots an environment's planned path.
pub(crate) const PREVIEW_PATH: &str = "pydslrep.previewPath";

/// A program and its imports as they are in the editor.
#[derive(Debug)]
struct ProgramCopy {
    /// Deleted with the child that reads it.
    folder: TemporaryFolder,
    program: PathBuf,
}

/// The prefix of a printed error.
const ERROR: &str = "error: ";

/// The exit code of a child that was interrupted.
const INTERRUPTED: i32 = 130;

/// A command to start.
#[derive(Debug)]
pub(crate) struct Job {
    copy: ProgramCopy,
    environment: String,
    subcommand: &'static str,
    /// The drawing that it makes, as part of the picture's name.
    what: &'static str,
}

/// Prepares a run or a plan.
///
/// # Errors
///
/// As [`copy`].
pub(crate) fn prepare(view: &View, which: &ChosenEnvironment, command: &str) -> Result<Job> {
    let (subcommand, what) = if command == RUN { ("run", "driven") } else { ("plan", "planned") };
    Ok(Job { copy: copy(view, which)?, environment: which.environment.clone(), subcommand, what })
}

/// Writes the program and its imports.
///
/// # Errors
///
/// If the environment does not exist or has errors, or the files cannot be written.
fn copy(view: &View, which: &ChosenEnvironment) -> Result<ProgramCopy> {
    let id = environment(view, which)?;
    view.database().environment(id).map_err(|errors| blocked(view, &errors))?;
    let unwritten = |error: io::Error| failure(format!("cannot write the program to run: {error}"));
    let folder = TemporaryFolder::new("job-").map_err(unwritten)?;
    let program = write_programs(view, which, folder.path())?;
    Ok(ProgramCopy { folder, program })
}

/// The open program and its imports, with the same relative paths.
fn write_programs(view: &View, which: &ChosenEnvironment, folder: &Path) -> Result<PathBuf> {
    let (document, file) = opened(view, &which.uri)?;
    let database = view.database();
    let own = database.path(file);
    let mut needed = vec![file];
    let mut next = 0;
    while let Some(importer) = needed.get(next).copied() {
        let imported = database.imported_files(importer);
        let new: Vec<FileId> = imported.filter(|file| !needed.contains(file)).collect();
        needed.extend(new);
        next += 1;
    }
    let files: Vec<(&str, String)> = needed
        .into_iter()
        .filter_map(|file| Some((database.path(file), database.text(file)?.to_string())))
        .collect();
    let common = common_folder(&files.iter().map(|(path, _)| *path).collect::<Vec<_>>());
    let place = |path: &str| {
        if !path.starts_with('/') {
            // A document that was never saved has a URI without a path, and imports nothing.
            return folder.join("program.pyr");
        }
        // A drive letter must not lead out of the folder.
        let relative = path.strip_prefix(common).unwrap_or(path).replace(':', "_");
        folder.join(relative.trim_start_matches('/'))
    };
    for (path, text) in &files {
        write(&place(path), text)?;
    }
    // A program without a folder has no scene.
    let mut scenes = database.scenes();
    if let Some((.., text)) = scenes.find(|(home, name, _)| *home == file && *name == which.environment) {
        write(&place(own).with_file_name(format!("{}{ENDING}", which.environment)), text)?;
    }
    // Imports may go up to the folder of this file.
    let target = document.settings.target;
    write(&folder.join(FILE_NAME), &format!("target = \"{}\"\n", target.word()))?;
    let program = place(own);
    if target == Target::VRep && own.starts_with('/') {
        copy_client(&path_of(own), &program)?;
    }
    Ok(program)
}

/// Copies V-REP's client, if it is next to the program, next to its copy.
fn copy_client(program: &Path, copy: &Path) -> Result<()> {
    for name in VREP_CLIENTS.iter().chain(&VREP_CLIENT_PARTS) {
        let (from, to) = (program.with_file_name(name), copy.with_file_name(name));
        if from.is_file() {
            let unwritten = |error| failure(format!("cannot write {}: {error}", to.display()));
            fs::copy(&from, &to).map_err(unwritten)?;
        }
    }
    Ok(())
}

fn write(path: &Path, text: &str) -> Result<()> {
    let written = path.parent().map_or(Ok(()), fs::create_dir_all).and_then(|()| fs::write(path, text));
    written.map_err(|error| failure(format!("cannot write {}: {error}", path.display())))
}

/// The folder that all paths are in, with a `/` at its end.
fn common_folder<'a>(paths: &[&'a str]) -> &'a str {
    let Some(first) = paths.first() else { return "" };
    let shared = |path: &&str| first.bytes().zip(path.bytes()).take_while(|(a, b)| a == b).count();
    let length = paths.iter().map(shared).min().unwrap_or(0);
    first.get(..length).and_then(|common| common.rfind('/')).map_or("", |slash| &first[..=slash])
}

impl Job {
    /// Starts it; its output comes out of the receiver. The path is where the picture will be.
    ///
    /// # Errors
    ///
    /// If there is no program `pydslrep`, or no folder for pictures.
    pub(crate) fn start(
        self,
        children: &mut Children,
    ) -> Result<(Running, UnboundedReceiver<ChildEvent>, PathBuf)> {
        let picture = children
            .picture(&format!("{}-{}", self.environment, self.what))
            .map_err(|error| failure(format!("cannot create a folder for pictures: {error}")))?;
        let mut command = Command::new(&children.command);
        command.arg(self.subcommand).arg(&self.copy.program);
        command.args(["--environment", &self.environment, "--picture"]).arg(&picture);
        command.arg("--replay").arg(replay(&picture));
        if self.subcommand == "run" {
            command.arg("--trace").arg(trace(&picture)).arg("--map").arg(map(&picture));
            command.args(["--events", "-", "--until-input-ends"]);
        }
        let (running, events) = start(children, &mut command, self.copy.folder)?;
        Ok((running, events, picture))
    }
}

/// Starts a child.
///
/// # Errors
///
/// If there is no program `pydslrep`.
fn start(
    children: &mut Children,
    command: &mut Command,
    folder: TemporaryFolder,
) -> Result<(Running, UnboundedReceiver<ChildEvent>)> {
    children.start(command, folder).map_err(|error| {
        let name = children.command.display();
        failure(format!("cannot start {name}: {error}; put `pydslrep` next to `pydslrep-lsp` or on the PATH"))
    })
}

/// The animated picture's path, next to the other.
pub(crate) fn replay(picture: &Path) -> PathBuf {
    picture.with_extension("replay.svg")
}

/// The trace's path, next to the picture.
pub(crate) fn trace(picture: &Path) -> PathBuf {
    picture.with_extension("jsonl")
}

/// The path of the map of robots that explore, next to the picture.
pub(crate) fn map(picture: &Path) -> PathBuf {
    picture.with_extension("map.json")
}

/// The error for a child that failed or was interrupted.
pub(crate) fn ended_badly(code: Option<i32>, stderr: &[String]) -> Error {
    if code == Some(INTERRUPTED) {
        return cancelled("the run was cancelled");
    }
    // Warnings about the program come before the error that ended it, and an editor shows those anyway.
    let first = stderr.iter().position(|line| line.starts_with(ERROR)).unwrap_or(0);
    if stderr.is_empty() {
        return failure("pydslrep exited without output".to_owned());
    }
    failure(stderr[first..].join("\n"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn programs_keep_their_places_to_each_other() {
        assert_eq!(common_folder(&["/a/b/c.pyr", "/a/bc/d.pyr"]), "/a/");
        assert_eq!(common_folder(&["/a/b/c.pyr"]), "/a/b/");
        assert_eq!(common_folder(&["untitled:1"]), "");
    }
}
