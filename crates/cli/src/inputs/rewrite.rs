//! Replaces the text of a file atomically.

use std::fs;
use std::path::Path;

use pydslrep_files::read;
use pydslrep_output::write_file;
use pydslrep_workspace::without_byte_order_mark as without_mark;

use crate::failure::Failure;

/// Replaces one text with another. At any moment the file holds one of the two; a byte order mark, permissions and links
/// to the file stay.
///
/// # Errors
/// If the file was changed meanwhile, is read-only, or cannot be written.
pub(crate) fn replace(path: &Path, before: &str, after: &str) -> Result<(), Failure> {
    let unwritten = |error: &dyn std::fmt::Display| Failure::unwritten(path, error);
    let target = fs::canonicalize(path).map_err(|error| unwritten(&error))?;
    let found = read(&target).map_err(|error| unwritten(&error))?;
    if without_mark(&found) != without_mark(before) {
        return Err(unwritten(&"it has changed in the meantime").help("run the command again"));
    }
    if fs::metadata(&target).is_ok_and(|found| found.permissions().readonly()) {
        return Err(unwritten(&"it is read-only").help("make it writable, or leave it out"));
    }
    let mark = &found[..found.len() - without_mark(&found).len()];
    let text = format!("{mark}{}", without_mark(after));
    write_file(&target, text.as_bytes()).map_err(|error| unwritten(&error))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_by_others_are_not_lost() {
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
