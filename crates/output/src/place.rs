//! The one rule about what an output may replace: nothing but what this program made, and nothing that the same command
//! reads.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use pydslrep_script::Origin;
use pydslrep_workspace::ReadError;

use crate::WriteError;
use crate::kind::Kind;
use crate::whole::{folder_of, try_folder};

/// The state of an output's location.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Found {
    /// Nothing, or a file that this program made.
    Free,
    /// A script that its user changed.
    Changed,
}

/// Returns the location of an output, which is not its path if that is a link, and the state of it.
///
/// # Errors
/// If a file is there that this program did not make, or the path is a link out of its folder.
pub(crate) fn look(path: &Path, kind: Kind) -> Result<(PathBuf, Found), WriteError> {
    let place = resolve(path)?;
    let unreadable = |reason: ReadError| WriteError::unwritten(path, io::Error::other(reason.to_string()));
    match kind.inspect(&place) {
        Ok(Origin::Generated) | Err(ReadError::Missing) => Ok((place, Found::Free)),
        Ok(Origin::Changed) => Ok((place, Found::Changed)),
        Ok(Origin::Foreign) | Err(ReadError::Folder | ReadError::NotRegular) => {
            Err(WriteError::Foreign(path.to_owned(), kind))
        }
        Err(reason) => Err(unreadable(reason)),
    }
}

/// As [`look`], for outputs that are not edited: a changed one is not ours any more.
pub(crate) fn free_place(path: &Path, kind: Kind) -> Result<PathBuf, WriteError> {
    match look(path, kind)? {
        (place, Found::Free) => Ok(place),
        (_, Found::Changed) => Err(WriteError::Changed(path.to_owned())),
    }
}

/// Follows a link, but not out of the folder that it is in: nobody expects a file elsewhere to change.
fn resolve(path: &Path) -> Result<PathBuf, WriteError> {
    if !fs::symlink_metadata(path).is_ok_and(|found| found.is_symlink()) {
        return Ok(path.to_owned());
    }
    let unwritten = |error| WriteError::unwritten(path, error);
    let folder = fs::canonicalize(folder_of(path)).map_err(unwritten)?;
    match fs::canonicalize(path) {
        Ok(target) if target.starts_with(&folder) => Ok(target),
        Ok(target) => Err(WriteError::Link { path: path.to_owned(), target }),
        // It leads nowhere; a file would appear where nobody looks for it.
        Err(_) => {
            Err(WriteError::Link { path: path.to_owned(), target: fs::read_link(path).map_err(unwritten)? })
        }
    }
}

/// Checks that the last folders of a path, `depth` of them, do not lead out of the one that they are in: a project's settings
/// name folders of the project, and a link in it could lead anywhere.
///
/// # Errors
/// If they do.
pub fn check_inside(folder: &Path, depth: usize) -> Result<(), WriteError> {
    let root =
        folder.ancestors().nth(depth).filter(|root| !root.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let Ok(root) = fs::canonicalize(root) else { return Ok(()) };
    // Folders that are missing are created as folders.
    let existing = folder.ancestors().take(depth).find_map(|folder| fs::canonicalize(folder).ok());
    match existing {
        Some(target) if !target.starts_with(&root) => {
            Err(WriteError::Link { path: folder.to_owned(), target })
        }
        _ => Ok(()),
    }
}

/// Checks the files that a command is to write, before it does anything: each may be written, none is there already
/// unless this program made it, and none is another one or among the files that the command reads.
///
/// # Errors
/// With the first that may not be written.
pub fn check_outputs(outputs: &[(&Path, Kind)], inputs: &[impl AsRef<Path>]) -> Result<(), WriteError> {
    let inputs: Vec<PathBuf> = inputs.iter().map(|path| identity(path.as_ref())).collect();
    for (index, (path, kind)) in outputs.iter().enumerate() {
        let own = identity(path);
        if inputs.contains(&own) {
            return Err(WriteError::Input((*path).to_owned()));
        }
        if outputs[..index].iter().any(|(other, _)| identity(other) == own) {
            return Err(WriteError::Twice((*path).to_owned()));
        }
        let place = free_place(path, *kind)?;
        try_folder(&place).map_err(|error| WriteError::unwritten(path, error))?;
    }
    Ok(())
}

/// The same for all names of a file.
fn identity(path: &Path) -> PathBuf {
    fs::canonicalize(path).unwrap_or_else(|_| {
        let name = path.file_name().unwrap_or_default();
        fs::canonicalize(folder_of(path)).map_or_else(|_| path.to_owned(), |folder| folder.join(name))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(outputs: &[(&Path, Kind)], inputs: &[&Path]) -> String {
        check_outputs(outputs, inputs).map_or_else(|error| format!("{error:?}"), |()| "fine".to_owned())
    }

    #[test]
    fn what_others_made_is_not_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let program = folder.path().join("p.pyr");
        fs::write(&program, "wheel a with radius 4\n").unwrap();
        for kind in [Kind::Trace, Kind::Map, Kind::Figures, Kind::Picture] {
            assert!(check(&[(&program, kind)], &[]).starts_with("Foreign"), "{kind:?}");
            assert!(check(&[(folder.path(), kind)], &[]).starts_with("Foreign"), "{kind:?}");
        }
        let missing = folder.path().join("gone").join("a.svg");
        assert!(check(&[(&missing, Kind::Picture)], &[]).starts_with("Unwritten"));
        assert_eq!(check(&[(&folder.path().join("a.svg"), Kind::Picture)], &[&program]), "fine");
        assert_eq!(folder.path().read_dir().unwrap().count(), 1, "nothing is left of the check");
    }

    #[test]
    fn inputs_and_other_outputs_are_not_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let [input, output] = ["in", "out"].map(|name| folder.path().join(name));
        fs::write(&input, "").unwrap();
        let same = folder.path().join(".").join("in");
        assert!(check(&[(&same, Kind::Trace)], &[&input]).starts_with("Input"), "an empty one neither");
        let other = folder.path().join(".").join("out");
        assert!(check(&[(&output, Kind::Trace), (&other, Kind::Map)], &[]).starts_with("Twice"));
    }

    #[cfg(unix)]
    #[test]
    fn folders_of_a_project_do_not_lead_out_of_it() {
        use std::os::unix::fs::symlink;
        let (project, elsewhere) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        let folder = |name: &str| project.path().join(name);
        symlink(elsewhere.path(), folder("out")).unwrap();
        fs::create_dir(folder("real")).unwrap();
        symlink("real", folder("in")).unwrap();
        for (name, depth, is_inside) in [
            ("out", 1, false),
            ("out/new/deep", 3, false),
            ("in", 1, true),
            ("in/new", 2, true),
            ("new", 1, true),
            // A user who names the folder on the command line may mean one that is elsewhere.
            ("out", 0, true),
        ] {
            assert_eq!(check_inside(&folder(name), depth).is_ok(), is_inside, "{name}");
        }
    }

    #[cfg(unix)]
    #[test]
    fn links_and_devices_are_not_followed_silently() {
        use std::os::unix::fs::symlink;
        let (folder, elsewhere) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        let target = elsewhere.path().join("a.svg");
        let [link, dangling, device, inside] = ["l", "d", "n", "i"].map(|name| folder.path().join(name));
        fs::write(&target, "").unwrap();
        symlink(&target, &link).unwrap();
        symlink(elsewhere.path().join("none"), &dangling).unwrap();
        symlink("/dev/null", &device).unwrap();
        for path in [&link, &dangling, &device] {
            assert!(check(&[(path, Kind::Picture)], &[]).starts_with("Link"), "{}", path.display());
        }
        assert!(check(&[(Path::new("/dev/null"), Kind::Picture)], &[]).starts_with("Foreign"));
        fs::write(folder.path().join("real"), "").unwrap();
        symlink("real", &inside).unwrap();
        assert_eq!(check(&[(&inside, Kind::Picture)], &[]), "fine");
    }
}
