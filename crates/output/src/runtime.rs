//! The folder `pydslrep_runtime`: the package that scripts import, next to them or in a cache.

use std::fmt;
use std::fs;
use std::io;
use std::path::{MAIN_SEPARATOR, Path, PathBuf};

use pydslrep_files::read_bytes;
use pydslrep_script::runtime::{NAME, VERSION, files};
use pydslrep_script::sha256;
use walkdir::WalkDir;

use crate::WriteError;
use crate::package::{RECORD, Record};
use crate::whole::NewFolder;

/// A larger file is not one of the package, and not kept with it, bytes.
const MAX_BYTES: u64 = 64 << 20;

/// A folder with more files is not our package.
const MAX_FILES: usize = 10_000;

/// More processes than this rarely write the same package at the same moment.
const MAX_ATTEMPTS: usize = 16;

/// The folders of Python's caches in packages.
const CACHES: &str = "__pycache__";

/// The result for the package's folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum RuntimeFolder {
    /// It was missing and is written.
    Written(PathBuf),
    /// It was as another version had written it, and is replaced.
    Replaced {
        /// The folder.
        path: PathBuf,
        /// The version that was there.
        before: String,
    },
    /// It is as this version writes it.
    Current(PathBuf),
    /// It is missing, and not needed: the user's Python has the package installed.
    Installed,
    /// It is left as it is.
    Kept(Kept),
}

/// A folder that is not replaced, because something in it is not ours.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Kept {
    /// The folder.
    path: PathBuf,
    /// The changed file, as a path in the folder; `None` if there is no record of what was written.
    changed: Option<String>,
}

impl fmt::Display for Kept {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let path = self.path.display();
        match &self.changed {
            Some(file) => write!(f, "{path} is not replaced: {file} in it was changed"),
            None => write!(f, "{path} is not replaced: PyDSLRep did not write it"),
        }
    }
}

impl Kept {
    /// Returns advice.
    pub fn help(&self) -> String {
        format!(
            "delete it to have version {VERSION} written, or set `write-runtime = false` in pydslrep.toml to keep it"
        )
    }
}

impl fmt::Display for RuntimeFolder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Written(path) => write!(f, "{} written (version {VERSION})", path.display()),
            Self::Replaced { path, before } if before == VERSION => {
                write!(f, "{} written again (version {VERSION})", path.display())
            }
            Self::Replaced { path, before } => {
                write!(f, "{} updated from version {before} to {VERSION}", path.display())
            }
            Self::Current(path) => write!(f, "{} is up to date (version {VERSION})", path.display()),
            Self::Installed => write!(f, "{NAME} is installed in your Python, so no folder is written"),
            Self::Kept(kept) => kept.fmt(f),
        }
    }
}

/// Writes the package into `folder`, where scripts are, unless it is there or `is_installed`, which is asked only if it
/// is not there. A copy that somebody changed stays; files that somebody added stay in a copy that is replaced.
///
/// # Errors
/// If it cannot be written.
pub fn write_runtime(
    folder: &Path,
    is_installed: impl FnOnce() -> bool,
) -> Result<RuntimeFolder, WriteError> {
    let path = folder.join(NAME);
    let current = Record::current();
    let mut is_installed = Some(is_installed);
    let write = || match inspect(&path, &current)? {
        Found::Nothing if is_installed.take().is_some_and(|is_installed| is_installed()) => {
            Ok(RuntimeFolder::Installed)
        }
        Found::Nothing => {
            fs::create_dir_all(folder)?;
            put(&path, &current, None)?;
            Ok(RuntimeFolder::Written(path.clone()))
        }
        Found::Current => Ok(RuntimeFolder::Current(path.clone())),
        Found::Ours { version, added } => {
            put(&path, &current, Some(&added))?;
            Ok(RuntimeFolder::Replaced { path: path.clone(), before: version })
        }
        Found::Changed(changed) => Ok(RuntimeFolder::Kept(Kept { path: path.clone(), changed })),
    };
    beside_others(write).map_err(|error| WriteError::unwritten(&path, error))
}

/// Writes the package into a folder of its own in a cache, unless it is there; returns the folder to import it from.
/// Nobody is to change anything there: a damaged copy is replaced.
///
/// # Errors
/// If it cannot be written.
pub fn provide_runtime(cache: &Path) -> Result<PathBuf, WriteError> {
    let current = Record::current();
    let fingerprint = current.fingerprint();
    let folder = cache.join(format!("runtime-{VERSION}-{}", &fingerprint[..16]));
    let path = folder.join(NAME);
    let provide = || {
        let kept: Option<&[String]> = match inspect(&path, &current)? {
            Found::Current => return Ok(()),
            Found::Nothing => None,
            Found::Ours { .. } | Found::Changed(_) => Some(&[]),
        };
        fs::create_dir_all(&folder)?;
        put(&path, &current, kept)
    };
    beside_others(provide).map_err(|error| WriteError::unwritten(&path, error))?;
    Ok(folder)
}

/// The state of the package's folder.
enum Found {
    Nothing,
    /// This version, unchanged.
    Current,
    /// Files by some version of ours, perhaps with others, and perhaps not all of them.
    Ours {
        version: String,
        /// Files that somebody added.
        added: Vec<String>,
    },
    /// Something that is not only ours; the file that shows it.
    Changed(Option<String>),
}

fn inspect(path: &Path, current: &Record) -> io::Result<Found> {
    match fs::symlink_metadata(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Found::Nothing),
        Ok(found) if !found.is_dir() => return Ok(Found::Changed(None)),
        found => found?,
    };
    let found = list(path)?;
    if found.len() > MAX_FILES {
        return Ok(Found::Changed(None));
    }
    let Some(record) = Record::parse(&read(path, RECORD).unwrap_or_default()) else {
        // A copy from elsewhere, perhaps of our own repository.
        let is_complete = current.files.iter().all(|(name, hash)| has(path, name, hash));
        return Ok(if is_complete { Found::Current } else { Found::Changed(None) });
    };
    let mut added = Vec::new();
    for file in found {
        match (record.files.get(&file.name), current.files.contains_key(&file.name)) {
            (Some(hash), _) if file.is_regular && has(path, &file.name, hash) => {}
            // A link cannot be kept as what it is everywhere, and a name that this version uses cannot be kept at all.
            (None, false) if file.is_regular => added.push(file.name),
            _ => return Ok(Found::Changed(Some(file.name))),
        }
    }
    let is_complete = record.files.keys().all(|name| path.join(name).exists());
    if is_complete && record == *current {
        return Ok(Found::Current);
    }
    Ok(Found::Ours { version: record.version, added })
}

/// Returns whether a file has the content with this hash.
fn has(path: &Path, name: &str, hash: &str) -> bool {
    read(path, name).is_ok_and(|content| sha256(&content) == *hash)
}

fn read(path: &Path, name: &str) -> io::Result<Vec<u8>> {
    read_bytes(&path.join(name), MAX_BYTES).map_err(io::Error::other)
}

struct Entry {
    /// The path in the package, with `/` between its parts.
    name: String,
    is_regular: bool,
}

/// All files in a folder and below it, but the record and what Python caches.
fn list(path: &Path) -> io::Result<Vec<Entry>> {
    let mut files = Vec::new();
    for entry in WalkDir::new(path).into_iter().filter_entry(|entry| entry.file_name() != CACHES) {
        let entry = entry?;
        let inside = entry.path().strip_prefix(path).map_err(io::Error::other)?;
        let name = inside.to_string_lossy().replace(MAIN_SEPARATOR, "/");
        if !entry.file_type().is_dir() && name != RECORD {
            files.push(Entry { is_regular: entry.file_type().is_file(), name });
        }
        if files.len() > MAX_FILES {
            break;
        }
    }
    files.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(files)
}

/// Puts the package into its place. If there is a copy to replace, the files in it that a user has added are kept.
fn put(path: &Path, current: &Record, added: Option<&[String]>) -> io::Result<()> {
    let new = NewFolder::begin(path)?;
    for file in files() {
        new.add(&file.path, &file.content)?;
    }
    new.add(RECORD, current.to_json().as_bytes())?;
    let Some(added) = added else { return new.finish(path) };
    for name in added {
        new.add(name, &read(path, name)?)?;
    }
    new.replace(path)
}

/// Repeats an attempt that failed because another process wrote the same package: each time, one of them completes.
fn beside_others<T>(mut attempt: impl FnMut() -> io::Result<T>) -> io::Result<T> {
    use io::ErrorKind::{AlreadyExists, DirectoryNotEmpty, NotFound};
    for _ in 1..MAX_ATTEMPTS {
        match attempt() {
            Err(error) if matches!(error.kind(), AlreadyExists | DirectoryNotEmpty | NotFound) => {}
            done => return done,
        }
    }
    attempt()
}

#[cfg(test)]
mod tests;
