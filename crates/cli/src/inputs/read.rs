//! Named programs as they are on the disk, and why some cannot be read.

use std::io;
use std::path::{Path, PathBuf};

use pydslrep_files::{Disk, decode, read};
use pydslrep_text::file_names::PROGRAM_EXTENSION;
use pydslrep_workspace::{FileSystem, ReadError};

use super::paths::{absolute, shown};
use crate::failure::Failure;

/// Standard input on the command line.
const STDIN: &str = "-";

/// The name of standard input in output.
pub(crate) const STDIN_SHOWN: &str = "<stdin>";

/// A program as it is on the disk, byte order mark and all.
#[derive(Debug)]
pub(crate) struct Source {
    /// Its name in output.
    pub(crate) shown: String,
    /// Where it is; `None` for standard input.
    pub(crate) place: Option<PathBuf>,
    pub(crate) text: String,
}

/// The inputs named on the command line.
#[derive(Debug, Default)]
pub(crate) struct Found {
    /// The programs, each once, sorted by name.
    pub(crate) programs: Vec<Source>,
    /// The absolute paths of all scenes in the folders.
    pub(crate) scenes: Vec<PathBuf>,
    /// The absolute paths of the folders.
    pub(crate) folders: Vec<PathBuf>,
    /// Why something could not be read.
    pub(crate) failures: Vec<Failure>,
}

/// Reads programs: files, folders with all programs in them, and `-` for standard input.
pub(crate) fn read_programs(paths: &[PathBuf]) -> Found {
    let mut found = Found::default();
    for path in paths {
        if let Err(failure) = found.add(path) {
            found.failures.push(failure);
        }
    }
    found.programs.sort_by(|a, b| (&a.place, &a.shown).cmp(&(&b.place, &b.shown)));
    found.programs.dedup_by(|a, b| a.place.is_some() && a.place == b.place);
    found.programs.sort_by(|a, b| a.shown.cmp(&b.shown));
    found
}

impl Found {
    fn add(&mut self, path: &Path) -> Result<(), Failure> {
        if path == Path::new(STDIN) {
            let text = decode(io::stdin().lock()).map_err(|error| read_failure(STDIN_SHOWN, &error))?;
            self.programs.push(Source { shown: STDIN_SHOWN.to_owned(), place: None, text });
            return Ok(());
        }
        if path.is_dir() {
            return self.add_folder(path);
        }
        self.programs.push(read_program(path)?);
        Ok(())
    }

    fn add_folder(&mut self, folder: &Path) -> Result<(), Failure> {
        let listing = Disk.list(folder, usize::MAX);
        let errors = listing.errors.into_iter();
        self.failures.extend(errors.map(|error| Failure::new(format!("cannot read the folder {error}"))));
        if listing.programs.is_empty() {
            return Err(Failure::new(format!("there is no program in {}", folder.display())).help(format!(
                "programs are files that end in .{PROGRAM_EXTENSION}; `pydslrep new NAME` starts one"
            )));
        }
        self.folders.push(absolute(folder)?);
        for scene in &listing.scenes {
            self.scenes.push(absolute(scene)?);
        }
        for program in &listing.programs {
            match read_program(program) {
                Ok(source) => self.programs.push(source),
                Err(failure) => self.failures.push(failure),
            }
        }
        Ok(())
    }
}

fn read_program(path: &Path) -> Result<Source, Failure> {
    Ok(Source { shown: shown(path), place: Some(absolute(path)?), text: read_file(path)? })
}

/// The text of a file.
///
/// # Errors
/// When it cannot be read.
pub(crate) fn read_file(path: &Path) -> Result<String, Failure> {
    read(path).map_err(|error| read_failure(&shown(path), &error))
}

/// Why a file, by its name in output, cannot be read.
pub(crate) fn read_failure(shown: &str, error: &ReadError) -> Failure {
    let failure = Failure::new(format!("cannot read {shown}: {error}"));
    match error {
        ReadError::Missing => Failure::new(format!("{shown} does not exist")),
        ReadError::TooLarge => failure.help("is this a program?"),
        ReadError::NotRegular => failure.help("`-` reads a program from standard input"),
        ReadError::NotText { .. } => failure.help("save it in the encoding UTF-8"),
        ReadError::Folder | ReadError::PermissionDenied | ReadError::Other(_) => failure,
    }
}
