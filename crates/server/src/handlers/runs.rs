//! The commands `pydslrep.run` and `pydslrep.previewPath`: the program `pydslrep` as a child process, which drives or
//! plans what the editor shows, saved or not, and draws a picture of it.
//!
//! What is open is written into a folder of its own together with what it imports, as it is in the editor at that
//! moment. The person's files stay as they are.

mod command;

pub(crate) use self::command::run;

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;

use futures::channel::mpsc::UnboundedReceiver;
use pydslrep_analysis::{FileId, Target};
use pydslrep_files::FILE_NAME;
use pydslrep_scene::ENDING;
use pydslrep_script::{VREP_CLIENT_PARTS, VREP_CLIENTS};
use tempfile::TempDir;
use tower_lsp::jsonrpc::{Error, ErrorCode, Result};

use crate::children::{ChildEvent, Children, Running};
use crate::chosen::ChosenEnvironment;
use crate::handlers::scripts::{blocked, environment, failure};
use crate::state::State;

/// Drives an environment.
pub(crate) const RUN: &str = "pydslrep.run";

/// Draws an environment's planned path.
pub(crate) const PREVIEW_PATH: &str = "pydslrep.previewPath";

/// What is to be started.
#[derive(Debug)]
pub(crate) struct Job {
    /// The program and what it imports; goes with the job.
    folder: TempDir,
    program: PathBuf,
    environment: String,
    subcommand: &'static str,
    /// What is drawn, in a word.
    what: &'static str,
}

/// Writes down what is to be run.
///
/// # Errors
///
/// If the environment is not there or has errors, or the files cannot be written.
pub(crate) fn prepare(state: &State, which: &ChosenEnvironment, command: &str) -> Result<Job> {
    let id = environment(state, which)?;
    state.database.environment(id).map_err(|errors| blocked(state, &errors))?;
    let (subcommand, what) = if command == RUN { ("run", "driven") } else { ("plan", "planned") };
    let unwritten = |error: io::Error| failure(format!("cannot write what is to be run: {error}"));
    let folder = tempfile::Builder::new().prefix("pydslrep-").tempdir().map_err(unwritten)?;
    let program = write_programs(state, which, folder.path())?;
    Ok(Job { folder, program, environment: which.environment.clone(), subcommand, what })
}

/// The open program and what it imports, in the places that they have to each other.
fn write_programs(state: &State, which: &ChosenEnvironment, folder: &Path) -> Result<PathBuf> {
    let unopened = || failure(format!("`{}` is not open in the editor", which.uri.as_str()));
    let (document, file) = state.analysed(&which.uri).ok_or_else(unopened)?;
    let database = &state.database;
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
            // What was never saved has an address and no path, and imports nothing.
            return folder.join("program.pyr");
        }
        // Not even the letter of a drive may lead out of the folder.
        let relative = path.strip_prefix(common).unwrap_or(path).replace(':', "_");
        folder.join(relative.trim_start_matches('/'))
    };
    for (path, text) in &files {
        write(&place(path), text)?;
    }
    // A program that is in no folder has no scene.
    let mut scenes = database.scenes();
    if let Some((.., text)) = scenes.find(|(home, name, _)| *home == file && *name == which.environment) {
        write(&place(own).with_file_name(format!("{}{ENDING}", which.environment)), text)?;
    }
    // Imports may go as far up as this file stands.
    let target = document.settings.target;
    write(&folder.join(FILE_NAME), &format!("target = \"{}\"\n", target.word()))?;
    let program = place(own);
    if target == Target::VRep && own.starts_with('/') {
        copy_client(Path::new(own), &program)?;
    }
    Ok(program)
}

/// Copies V-REP's client from beside the program, if it is there, to beside what is run.
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

/// What all paths begin with, up to a `/`.
fn common_folder<'a>(paths: &[&'a str]) -> &'a str {
    let Some(first) = paths.first() else { return "" };
    let shared = |path: &&str| first.bytes().zip(path.bytes()).take_while(|(a, b)| a == b).count();
    let length = paths.iter().map(shared).min().unwrap_or(0);
    first.get(..length).and_then(|common| common.rfind('/')).map_or("", |slash| &first[..=slash])
}

impl Job {
    /// Starts it; what it says comes out of the receiver. The path is that of the picture, once it is drawn.
    ///
    /// # Errors
    ///
    /// If there is no program `pydslrep`, or no place for a picture.
    pub(crate) fn start(
        self,
        children: &mut Children,
    ) -> Result<(Running, UnboundedReceiver<ChildEvent>, PathBuf)> {
        let picture = children
            .picture(&format!("{}-{}", self.environment, self.what))
            .map_err(|error| failure(format!("there is no place for a picture: {error}")))?;
        let program = executable();
        let mut command = Command::new(&program);
        command.arg(self.subcommand).arg(&self.program);
        command.args(["--environment", &self.environment, "--picture"]).arg(&picture);
        command.arg("--replay").arg(replay(&picture));
        if self.subcommand == "run" {
            command.arg("--trace").arg(trace(&picture)).arg("--map").arg(map(&picture));
            command.arg("--until-input-ends");
        }
        let (running, events) = children.start(&mut command, self.folder).map_err(|error| {
            let name = program.display();
            failure(format!(
                "cannot start {name}: {error}; put `pydslrep` beside `pydslrep-lsp` or on the PATH"
            ))
        })?;
        Ok((running, events, picture))
    }
}

/// Where a picture that moves is drawn: beside the other.
pub(crate) fn replay(picture: &Path) -> PathBuf {
    picture.with_extension("replay.svg")
}

/// Where a run writes every step: beside its picture.
pub(crate) fn trace(picture: &Path) -> PathBuf {
    picture.with_extension("jsonl")
}

/// Where a run writes the map of robots that explore: beside its picture.
pub(crate) fn map(picture: &Path) -> PathBuf {
    picture.with_extension("map.json")
}

/// The program `pydslrep`: beside this one, else wherever the system finds it.
fn executable() -> PathBuf {
    let name = format!("pydslrep{}", std::env::consts::EXE_SUFFIX);
    let beside = std::env::current_exe().ok().map(|own| own.with_file_name(&name));
    beside.filter(|path| path.is_file()).unwrap_or_else(|| name.into())
}

/// The error for a run that did not come to its end.
pub(crate) fn ended_badly(code: Option<i32>, said: &[String]) -> Error {
    if code == Some(130) {
        return Error {
            code: ErrorCode::RequestCancelled,
            message: "the run was cancelled".into(),
            data: None,
        };
    }
    // Where it wrote to is nothing that the person asked for, and what it began with is no reason.
    let others = ["picture: ", "replay: ", "trace: ", "map: ", "preparing Python "];
    let is_reason = |line: &&String| !others.iter().any(|other| line.starts_with(other));
    let words: Vec<&str> = said.iter().filter(is_reason).map(String::as_str).collect();
    if words.is_empty() {
        return failure("pydslrep exited without output".to_owned());
    }
    failure(words.join("\n"))
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
