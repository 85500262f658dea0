//! Scripts: one file each.

use std::fs;
use std::path::{Path, PathBuf};

use pydslrep_files::read_bytes;

use crate::WriteError;
use crate::kind::Kind;
use crate::place::{Found, look};
use crate::whole::{folder_of, write_file};

/// The treatment of a script that its user changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Changed {
    /// It stays.
    Keep,
    /// It is replaced: the user said so.
    Replace,
}

/// Checks that a path is free for a script, or holds one that may be replaced; returns where it goes.
///
/// # Errors
/// If it holds anything else.
pub fn check_script(path: &Path, changed: Changed) -> Result<PathBuf, WriteError> {
    match look(path, Kind::Script)? {
        (_, Found::Changed) if changed == Changed::Keep => Err(WriteError::Changed(path.to_owned())),
        (place, _) => Ok(place),
    }
}

/// Writes a script, and its folder if that is missing. A file that already has this text stays as it is.
///
/// # Errors
/// If the path holds anything that may not be replaced, or cannot be written.
pub fn write_script(path: &Path, text: &str, changed: Changed) -> Result<(), WriteError> {
    let place = check_script(path, changed)?;
    if read_bytes(&place, text.len() as u64).is_ok_and(|content| content == text.as_bytes()) {
        return Ok(());
    }
    let folder = folder_of(&place);
    fs::create_dir_all(folder).map_err(|error| WriteError::unwritten(folder, error))?;
    write_file(&place, text.as_bytes()).map_err(|error| WriteError::unwritten(path, error))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Scripts as they are generated.
    const OURS: &str = include_str!("../../script/snapshots/area_1.py");
    const LONGER: &str = include_str!("../../script/snapshots/factory.py");

    fn write(path: &Path, text: &str) -> Result<(), WriteError> {
        write_script(path, text, Changed::Keep)
    }

    #[test]
    fn only_generated_scripts_are_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("new/a.py");
        write(&path, OURS).unwrap();
        write(&path, LONGER).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), LONGER);
        fs::write(&path, "print('mine')").unwrap();
        assert!(matches!(write(&path, OURS), Err(WriteError::Foreign(..))));
        assert!(matches!(write_script(&path, OURS, Changed::Replace), Err(WriteError::Foreign(..))));
        assert_eq!(fs::read_to_string(&path).unwrap(), "print('mine')");
        let is_folder = folder.path().join("b.py");
        fs::create_dir(&is_folder).unwrap();
        assert!(matches!(check_script(&is_folder, Changed::Keep), Err(WriteError::Foreign(..))));
        assert_eq!(folder.path().join("new").read_dir().unwrap().count(), 1, "nothing is left beside it");
    }

    #[test]
    fn a_changed_script_is_its_users() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.py");
        let changed = format!("{OURS}# mine\n");
        fs::write(&path, &changed).unwrap();
        for text in [OURS, LONGER] {
            assert!(matches!(write(&path, text), Err(WriteError::Changed(_))));
            assert_eq!(fs::read_to_string(&path).unwrap(), changed);
        }
        write_script(&path, OURS, Changed::Replace).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), OURS);
    }

    #[cfg(unix)]
    #[test]
    fn permissions_and_links_stay() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().unwrap();
        let (path, usual, link) =
            (folder.path().join("a.py"), folder.path().join("usual"), folder.path().join("l.py"));
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
        write(&path, OURS).unwrap();
        fs::write(&usual, "").unwrap();
        assert_eq!(mode(&path), mode(&usual), "a new script is like any new file");
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
        symlink(&path, &link).unwrap();
        write(&link, LONGER).unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!((fs::read_to_string(&path).unwrap(), mode(&path)), (LONGER.to_owned(), 0o755));
    }

    #[cfg(unix)]
    #[test]
    fn a_link_to_elsewhere_is_not_followed() {
        let (folder, elsewhere) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        let (path, target) = (folder.path().join("a.py"), elsewhere.path().join("a.py"));
        fs::write(&target, OURS).unwrap();
        std::os::unix::fs::symlink(&target, &path).unwrap();
        assert!(matches!(write_script(&path, LONGER, Changed::Replace), Err(WriteError::Link { .. })));
        assert_eq!(fs::read_to_string(&target).unwrap(), OURS);
    }
}
