//! Finds programs and scenes in folders.

use std::path::{Path, PathBuf};

use ignore::WalkBuilder;

use crate::{is_program, is_scene};

/// The result of a search.
#[derive(Debug, Default)]
pub struct Found {
    /// The programs, by name.
    pub programs: Vec<PathBuf>,
    /// The scenes, by name.
    pub scenes: Vec<PathBuf>,
    /// The errors for folders that could not be read.
    pub failures: Vec<String>,
    /// Whether the search was completed.
    pub complete: bool,
}

/// Finds all programs and scenes in a folder and its subfolders, except for hidden and ignored (`.gitignore`) ones. Visits
/// at most `most` files and folders. Does not follow links to folders, which may be cyclic.
pub fn find(folder: &Path, most: usize) -> Found {
    let mut found = Found { complete: true, ..Found::default() };
    for (count, entry) in walk(folder).build().enumerate() {
        if count >= most {
            found.complete = false;
            break;
        }
        match entry {
            Ok(entry) if !entry.file_type().is_some_and(|kind| kind.is_dir()) => {
                let path = entry.into_path();
                if is_program(&path) {
                    found.programs.push(path);
                } else if is_scene(&path) {
                    found.scenes.push(path);
                }
            }
            Ok(_) => {}
            Err(error) => found.failures.push(error.to_string()),
        }
    }
    found
}

/// Whether a search in a folder would find a program or a scene; visits only the folders on its path.
pub fn belongs(folder: &Path, file: &Path) -> bool {
    if !(is_program(file) || is_scene(file)) || !file.starts_with(folder) {
        return false;
    }
    let wanted = file.to_owned();
    let mut way = walk(folder).filter_entry(move |entry| wanted.starts_with(entry.path())).build();
    way.any(|entry| entry.is_ok_and(|entry| entry.path() == file))
}

fn walk(folder: &Path) -> WalkBuilder {
    let mut walk = WalkBuilder::new(folder);
    walk.require_git(false).git_global(false).sort_by_file_name(Ord::cmp);
    walk
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn folder(files: &[&str]) -> tempfile::TempDir {
        let folder = tempfile::Builder::new().prefix("files").tempdir().unwrap();
        for name in files {
            let path = folder.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, "").unwrap();
        }
        folder
    }

    fn names(folder: &tempfile::TempDir, most: usize) -> (Vec<String>, bool) {
        let found = find(folder.path(), most);
        assert_eq!(found.failures, [""; 0]);
        let name = |path: &PathBuf| path.strip_prefix(folder.path()).unwrap().display().to_string();
        (found.programs.iter().map(name).collect(), found.complete)
    }

    #[test]
    fn programs_are_found_by_name() {
        let folder = folder(&["b/y.pyr", "a.pyr", "b/x.txt", ".git/z.pyr", "pyr", "c.PYR"]);
        assert_eq!(names(&folder, 100), (vec!["a.pyr".to_owned(), "b/y.pyr".to_owned()], true));
    }

    #[test]
    fn ignored_files_are_not_part_of_the_workspace() {
        let folder = folder(&["target/x.pyr", "a.pyr", "old.pyr", "a.scene.toml", "old.scene.toml"]);
        fs::write(folder.path().join(".gitignore"), "/target/\nold*\n").unwrap();
        assert_eq!(names(&folder, 100), (vec!["a.pyr".to_owned()], true));
        let belongs = |name: &str| super::belongs(folder.path(), &folder.path().join(name));
        let scenes = find(folder.path(), 100).scenes;
        assert_eq!(scenes, [folder.path().join("a.scene.toml")]);
        assert!(belongs("a.pyr") && belongs("a.scene.toml"));
        for name in ["target/x.pyr", "old.pyr", "old.scene.toml", "gone.pyr", "a.txt", "../a.pyr"] {
            assert!(!belongs(name), "{name}");
        }
    }

    #[test]
    fn searches_are_limited() {
        let folder = folder(&["a.pyr", "b.pyr", "c.pyr"]);
        assert_eq!(names(&folder, 2), (vec!["a.pyr".to_owned()], false), "the folder itself counts");
    }

    #[cfg(unix)]
    #[test]
    fn links_to_folders_are_not_followed() {
        let folder = folder(&["a.pyr"]);
        std::os::unix::fs::symlink(folder.path(), folder.path().join("again")).unwrap();
        std::os::unix::fs::symlink(folder.path().join("a.pyr"), folder.path().join("b.pyr")).unwrap();
        assert_eq!(names(&folder, 100).0, ["a.pyr", "b.pyr"]);
    }

    #[test]
    fn a_missing_folder_is_reported() {
        let folder = folder(&[]);
        assert_eq!(find(&folder.path().join("x"), 9).failures.len(), 1);
    }
}
