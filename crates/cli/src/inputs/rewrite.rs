//! Files with a new text: whole, or as they were.

use std::fs;
use std::io::Write;
use std::path::Path;

use pydslrep_workspace::without_byte_order_mark as without_mark;
use tempfile::Builder;

use crate::failure::Failure;

/// Puts a text in place of another one. Whatever happens meanwhile, the file holds one of the two; a byte order mark,
/// permissions and links to the file stay.
///
/// # Errors
/// When the file holds something else by now, is read-only, or cannot be written.
pub(crate) fn replace(path: &Path, before: &str, after: &str) -> Result<(), Failure> {
    let unwritten = |error: &dyn std::fmt::Display| Failure::unwritten(path, error);
    let target = fs::canonicalize(path).map_err(|error| unwritten(&error))?;
    let bytes = fs::read(&target).map_err(|error| unwritten(&error))?;
    let found = std::str::from_utf8(&bytes).ok().filter(|text| without_mark(text) == without_mark(before));
    let Some(found) = found else {
        return Err(unwritten(&"it was changed meanwhile").help("run the command again"));
    };
    let permissions = fs::metadata(&target).map_err(|error| unwritten(&error))?.permissions();
    if permissions.readonly() {
        return Err(unwritten(&"it is read-only").help("allow writing to it, or leave it out"));
    }
    let mark = &found[..found.len() - without_mark(found).len()];
    let folder = target.parent().unwrap_or(Path::new("."));
    let write = || {
        // Renaming within a folder leaves no moment with half a file.
        let mut whole = Builder::new().prefix(".pydslrep-").tempfile_in(folder)?;
        whole.write_all(mark.as_bytes())?;
        whole.write_all(without_mark(after).as_bytes())?;
        whole.as_file().set_permissions(permissions)?;
        whole.as_file().sync_all()?;
        whole.persist(&target).map_err(|error| error.error)
    };
    write().map(drop).map_err(|error| unwritten(&error))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_changed_meanwhile_is_not_lost() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("x.pyr");
        fs::write(&path, "\u{feff}mine").unwrap();
        assert!(replace(&path, "yours", "ours").is_err());
        assert_eq!(fs::read_to_string(&path).unwrap(), "\u{feff}mine");
        replace(&path, "mine", "ours").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "\u{feff}ours");
        assert_eq!(folder.path().read_dir().unwrap().count(), 1, "nothing is left beside it");
    }
}
