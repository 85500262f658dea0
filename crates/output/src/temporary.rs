//! Temporary folders that a killed process does not leave for good: the next one removes them.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Once;
use std::{env, fmt};

use pydslrep_files::open;
use tempfile::{Builder, TempDir};

/// The file in a temporary folder that its owner holds a lock on.
pub(crate) const LOCK: &str = ".pydslrep-lock";

/// The prefix of our names in the system's temporary folder.
const PREFIX: &str = "pydslrep-";

/// A folder that is deleted in the end; if this process is killed, by the next one.
pub struct TemporaryFolder {
    /// Locked as long as this exists. It is closed before the folder is deleted: Windows keeps open files.
    _lock: File,
    folder: TempDir,
    is_kept: bool,
}

impl fmt::Debug for TemporaryFolder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("TemporaryFolder").field(&self.path()).finish()
    }
}

impl TemporaryFolder {
    /// A folder in the system's one for temporary files; its name begins with `pydslrep-` and `what`.
    ///
    /// # Errors
    /// If it cannot be created.
    pub fn new(what: &str) -> io::Result<Self> {
        static REMOVED: Once = Once::new();
        REMOVED.call_once(|| remove_leftovers(&env::temp_dir()));
        Self::new_in(&env::temp_dir(), &format!("{PREFIX}{what}"))
    }

    pub(crate) fn new_in(parent: &Path, prefix: &str) -> io::Result<Self> {
        loop {
            let folder = Builder::new().prefix(prefix).tempdir_in(parent)?;
            let path = folder.path().join(LOCK);
            let lock = match File::create_new(&path) {
                // Somebody took it for a leftover.
                Err(error) if error.kind() == io::ErrorKind::NotFound => continue,
                lock => lock?,
            };
            // A file system without locks has none to find either.
            let _ = lock.lock();
            if path.exists() {
                return Ok(Self { _lock: lock, folder, is_kept: false });
            }
        }
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Does not delete it, nor does any later process.
    pub(crate) fn keep(&mut self) {
        self.is_kept = true;
        self.folder.disable_cleanup(true);
        // Without it, nobody takes the folder for a leftover. If it stays, so does the lock on it, for now.
        let _ = fs::remove_file(self.path().join(LOCK));
    }
}

impl Drop for TemporaryFolder {
    fn drop(&mut self) {
        if !self.is_kept {
            // Files that cannot be removed now are tried once more with the folder.
            let _ = remove_content(self.path());
        }
    }
}

/// Removes everything in a folder but its lock file, by which the next process knows it, should this one be killed.
fn remove_content(folder: &Path) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        if entry.file_type()?.is_dir() {
            fs::remove_dir_all(entry.path())?;
        } else if entry.file_name() != LOCK {
            fs::remove_file(entry.path())?;
        }
    }
    Ok(())
}

/// Removes a temporary folder that nobody holds a lock on. After a failure the next process tries again.
pub(crate) fn remove_abandoned(folder: &Path) {
    let lock = folder.join(LOCK);
    if let Some(_held) = is_abandoned(&lock) {
        let _ = remove_content(folder)
            .and_then(|()| fs::remove_file(&lock))
            .and_then(|()| fs::remove_dir(folder));
    }
}

/// Removes the folders of killed processes; folders of other programs have no lock file of ours.
fn remove_leftovers(parent: &Path) {
    let Ok(entries) = fs::read_dir(parent) else { return };
    let ours = entries.flatten().filter(|entry| entry.file_name().to_string_lossy().starts_with(PREFIX));
    for path in ours.map(|entry| entry.path()).collect::<Vec<PathBuf>>() {
        remove_abandoned(&path);
    }
}

/// The lock on a file that no process holds; `None` if one does, or there is no such file.
pub(crate) fn is_abandoned(path: &Path) -> Option<File> {
    let file = open(path).ok()?;
    file.try_lock().ok()?;
    Some(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_folders_without_an_owner_are_removed() {
        let parent = tempfile::tempdir().unwrap();
        let used = TemporaryFolder::new_in(parent.path(), "pydslrep-").unwrap();
        let [killed, strange] = ["pydslrep-killed", "pydslrep-mine"].map(|name| parent.path().join(name));
        for folder in [&killed, &strange] {
            fs::create_dir_all(folder.join("b/c")).unwrap();
            fs::write(folder.join("a"), "").unwrap();
        }
        fs::write(killed.join(LOCK), "").unwrap();
        remove_leftovers(parent.path());
        assert!(used.path().exists() && strange.exists() && !killed.exists());
        let path = used.path().to_owned();
        drop(used);
        assert!(!path.exists());
    }

    #[test]
    fn the_lock_file_goes_last() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["a", LOCK, "z"] {
            fs::write(folder.path().join(name), "").unwrap();
        }
        fs::create_dir_all(folder.path().join("b/c")).unwrap();
        remove_content(folder.path()).unwrap();
        let names = folder.path().read_dir().unwrap().map(|entry| entry.unwrap().file_name());
        assert_eq!(names.collect::<Vec<_>>(), [LOCK]);
    }

    #[test]
    fn what_is_kept_is_no_leftover() {
        let parent = tempfile::tempdir().unwrap();
        let mut folder = TemporaryFolder::new_in(parent.path(), "pydslrep-").unwrap();
        let path = folder.path().join("a");
        fs::write(&path, "").unwrap();
        folder.keep();
        drop(folder);
        remove_leftovers(parent.path());
        assert!(path.exists());
    }
}
