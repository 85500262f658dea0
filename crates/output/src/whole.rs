//! Files and folders that appear whole or not at all: written under a temporary name, then renamed.
//!
//! A writer holds a lock on its temporary files, which distinguishes them from those of killed processes.

use std::collections::HashSet;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{LazyLock, Mutex, PoisonError};

use tempfile::{Builder, NamedTempFile};

use crate::temporary::{TemporaryFolder, is_abandoned, remove_abandoned};

/// The prefix of temporary names, which hides them on most systems.
pub(crate) const PREFIX: &str = ".pydslrep-";

/// Writes a file, or replaces its content; permissions of and links to an existing one stay. At any moment it has the old
/// content or the new one.
///
/// # Errors
/// If it is read-only or cannot be written.
pub fn write_file(path: &Path, content: &[u8]) -> io::Result<()> {
    // The target of a link, not the link.
    let path = &fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let mut file = temporary_file(folder_of(path))?;
    if let Ok(existing) = fs::metadata(path) {
        let permissions = existing.permissions();
        if permissions.readonly() {
            return Err(io::Error::new(io::ErrorKind::PermissionDenied, "it is read-only"));
        }
        file.as_file().set_permissions(permissions)?;
    }
    file.write_all(content)?;
    file.as_file().sync_all()?;
    file.persist(path).map(drop).map_err(|error| error.error)
}

/// A locked temporary file in a folder.
fn temporary_file(folder: &Path) -> io::Result<NamedTempFile> {
    remove_leftovers(folder);
    let mut builder = Builder::new();
    builder.prefix(PREFIX);
    set_usual_permissions(&mut builder);
    loop {
        let file = builder.tempfile_in(folder)?;
        // A file system without locks has none to find either.
        let _ = file.as_file().lock();
        // Before it was locked, somebody may have taken it for a leftover.
        if file.path().exists() {
            return Ok(file);
        }
    }
}

/// Checks that a file can be created next to another.
pub(crate) fn try_folder(path: &Path) -> io::Result<()> {
    temporary_file(folder_of(path)).map(drop)
}

/// Removes the leftovers of killed processes in a folder; looks at each folder once.
fn remove_leftovers(folder: &Path) {
    static SEEN: LazyLock<Mutex<HashSet<PathBuf>>> = LazyLock::new(Mutex::default);
    let is_new = SEEN.lock().unwrap_or_else(PoisonError::into_inner).insert(folder.to_owned());
    let Some(entries) = is_new.then(|| fs::read_dir(folder)).and_then(Result::ok) else { return };
    for entry in entries.flatten() {
        if entry.file_name().to_string_lossy().starts_with(PREFIX) {
            remove_leftover(&entry.path());
        }
    }
}

/// Removes a temporary file or folder that nobody holds a lock on. After a failure the next process tries again.
fn remove_leftover(path: &Path) {
    if path.is_dir() {
        remove_abandoned(path);
        // Its owner was killed before the lock was made, or after it was removed. Only an empty folder is removed.
        let _ = fs::remove_dir(path);
    } else if let Some(_lock) = is_abandoned(path) {
        let _ = fs::remove_file(path);
    }
}

/// Temporary files are private; what becomes a user's file has the permissions of any new one.
#[cfg(unix)]
fn set_usual_permissions(builder: &mut Builder<'_, '_>) {
    use std::os::unix::fs::PermissionsExt;
    builder.permissions(fs::Permissions::from_mode(0o666));
}

#[cfg(not(unix))]
fn set_usual_permissions(_: &mut Builder<'_, '_>) {}

/// A folder that is being written, next to where it will be.
pub(crate) struct NewFolder {
    /// Removed with everything in it in the end.
    around: TemporaryFolder,
    path: PathBuf,
}

impl NewFolder {
    /// Begins a folder that will be at `place`, whose parent folder must exist.
    pub(crate) fn begin(place: &Path) -> io::Result<Self> {
        remove_leftovers(folder_of(place));
        let around = TemporaryFolder::new_in(folder_of(place), PREFIX)?;
        let path = around.path().join("new");
        fs::create_dir(&path)?;
        Ok(Self { around, path })
    }

    /// Adds a file; `name` is its path in the folder, with `/` between its parts.
    pub(crate) fn add(&self, name: &str, content: &[u8]) -> io::Result<()> {
        let path = self.path.join(name);
        fs::create_dir_all(folder_of(&path))?;
        let mut file = File::create_new(path)?;
        file.write_all(content)?;
        file.sync_all()
    }

    /// Moves the folder to its place, where there must be nothing but an empty folder.
    pub(crate) fn finish(self, place: &Path) -> io::Result<()> {
        fs::rename(&self.path, place)
    }

    /// Moves the folder to its place, and removes what was there. If the new one cannot be moved, the old one stays.
    pub(crate) fn replace(mut self, place: &Path) -> io::Result<()> {
        let old = self.around.path().join("old");
        let had_one = match fs::rename(place, &old) {
            Ok(()) => true,
            Err(error) if error.kind() == io::ErrorKind::NotFound => false,
            Err(error) => return Err(error),
        };
        fs::rename(&self.path, place).inspect_err(|_| {
            // If somebody else has put a new one there meanwhile, the old one is replaced all the same.
            if had_one && fs::rename(&old, place).is_err() && !place.exists() {
                // Better under a strange name than lost.
                self.around.keep();
            }
        })
    }
}

/// Writes a folder with files where there is nothing.
///
/// # Errors
/// If there is something, or it cannot be written.
pub fn write_new_folder(place: &Path, files: &[(&str, &str)]) -> io::Result<()> {
    fs::create_dir_all(folder_of(place))?;
    let new = NewFolder::begin(place)?;
    for (name, content) in files {
        new.add(name, content.as_bytes())?;
    }
    if fs::symlink_metadata(place).is_ok() {
        return Err(io::ErrorKind::AlreadyExists.into());
    }
    // A folder that appears now stays, unless it is empty: only such a one is replaced.
    new.finish(place)
}

/// The folder that holds a file.
pub(crate) fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

#[cfg(test)]
mod tests {
    use pydslrep_files::open;

    use super::*;
    use crate::temporary::LOCK;

    #[test]
    fn leftovers_of_killed_processes_are_removed() {
        let folder = tempfile::tempdir().unwrap();
        let in_folder = |name: &str| folder.path().join(name);
        fs::write(in_folder(".pydslrep-killed"), "half").unwrap();
        fs::create_dir(in_folder(".pydslrep-folder")).unwrap();
        fs::write(in_folder(".pydslrep-folder").join(LOCK), "").unwrap();
        fs::create_dir(in_folder(".pydslrep-empty")).unwrap();
        fs::write(in_folder(".pydslrep-used"), "half").unwrap();
        let used = open(&in_folder(".pydslrep-used")).unwrap();
        used.lock().unwrap();
        write_file(&in_folder("a"), b"whole").unwrap();
        let names = || {
            let found = folder.path().read_dir().unwrap().map(|entry| entry.unwrap().file_name());
            let mut names: Vec<String> = found.map(|name| name.to_string_lossy().into_owned()).collect();
            names.sort();
            names
        };
        assert_eq!(names(), [".pydslrep-used", "a"]);
    }

    #[test]
    fn a_new_folder_replaces_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().join("a/b");
        write_new_folder(&place, &[("x", "1"), ("y", "2")]).unwrap();
        assert_eq!(fs::read_to_string(place.join("y")).unwrap(), "2");
        assert!(write_new_folder(&place, &[("x", "3")]).is_err());
        assert_eq!(fs::read_to_string(place.join("x")).unwrap(), "1");
        assert_eq!(folder.path().join("a").read_dir().unwrap().count(), 1);
    }
}
