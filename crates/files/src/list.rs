//! All programs and scenes of a folder.

use std::path::{Path, PathBuf};

use ignore::{DirEntry, WalkBuilder};
use pydslrep_workspace::{DocumentKind, Listing};

/// All programs and scenes in a folder and below it, except what is hidden or what a `.gitignore` excludes. Links to
/// folders are not followed: they may form cycles.
pub(crate) fn list(folder: &Path, max_entries: usize) -> Listing {
    let mut listing = Listing::default();
    if let Some(file) = folder.ancestors().find_map(unreadable_rules) {
        listing.errors.push(format!("{}: {} is not a regular file", folder.display(), file.display()));
        return listing;
    }
    for (count, entry) in walk(folder).build().enumerate() {
        if count >= max_entries {
            listing.is_truncated = true;
            break;
        }
        match entry {
            Ok(entry) if !entry.file_type().is_some_and(|kind| kind.is_dir()) => {
                let path = entry.into_path();
                match DocumentKind::of_file(&path) {
                    Some(DocumentKind::Program) => listing.programs.push(path),
                    Some(DocumentKind::Scene) => listing.scenes.push(path),
                    Some(DocumentKind::Settings) | None => {}
                }
            }
            Ok(_) => {}
            Err(error) => listing.errors.push(error.to_string()),
        }
    }
    listing
}

/// Returns whether [`list`] would find a file; visits only the folders on the way to it.
pub(crate) fn lists(folder: &Path, file: &Path) -> bool {
    let kind = DocumentKind::of_file(file);
    if !matches!(kind, Some(DocumentKind::Program | DocumentKind::Scene)) || !file.starts_with(folder) {
        return false;
    }
    // Looking for a file is cheaper than reading all that may exclude it.
    if file.symlink_metadata().is_err() {
        return false;
    }
    if folder.ancestors().any(|folder| unreadable_rules(folder).is_some()) {
        return false;
    }
    let wanted = file.to_owned();
    let mut on_the_way = walk(folder);
    on_the_way.filter_entry(move |entry| wanted.starts_with(entry.path()) && is_searchable(entry));
    on_the_way.build().any(|entry| entry.is_ok_and(|entry| entry.path() == file))
}

fn walk(folder: &Path) -> WalkBuilder {
    let mut walk = WalkBuilder::new(folder);
    walk.require_git(false).git_global(false).sort_by_file_name(Ord::cmp);
    walk.filter_entry(is_searchable);
    walk
}

/// Returns whether the search of a folder comes to an end.
fn is_searchable(entry: &DirEntry) -> bool {
    !entry.file_type().is_some_and(|kind| kind.is_dir()) || unreadable_rules(entry.path()).is_none()
}

/// The file in a folder that says what is ignored there, if it is a pipe or a device: the search would wait for it.
fn unreadable_rules(folder: &Path) -> Option<PathBuf> {
    let files = [".ignore", ".gitignore", ".git/info/exclude"].into_iter().map(|name| folder.join(name));
    files.into_iter().find(|file| file.metadata().is_ok_and(|found| !found.is_file() && !found.is_dir()))
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
        let found = list(folder.path(), most);
        assert_eq!(found.errors, [""; 0]);
        let name = |path: &PathBuf| path.strip_prefix(folder.path()).unwrap().display().to_string();
        (found.programs.iter().map(name).collect(), !found.is_truncated)
    }

    #[test]
    fn programs_are_listed_by_name() {
        let folder = folder(&["b/y.pyr", "a.pyr", "b/x.txt", ".git/z.pyr", "pyr", "c.PYR"]);
        assert_eq!(names(&folder, 100), (vec!["a.pyr".to_owned(), "b/y.pyr".to_owned()], true));
    }

    #[test]
    fn ignored_files_are_not_listed() {
        let folder = folder(&["target/x.pyr", "a.pyr", "old.pyr", "a.scene.toml", "old.scene.toml"]);
        fs::write(folder.path().join(".gitignore"), "/target/\nold*\n").unwrap();
        assert_eq!(names(&folder, 100), (vec!["a.pyr".to_owned()], true));
        let is_listed = |name: &str| super::lists(folder.path(), &folder.path().join(name));
        let scenes = list(folder.path(), 100).scenes;
        assert_eq!(scenes, [folder.path().join("a.scene.toml")]);
        assert!(is_listed("a.pyr") && is_listed("a.scene.toml"));
        for name in ["target/x.pyr", "old.pyr", "old.scene.toml", "gone.pyr", "a.txt", "../a.pyr"] {
            assert!(!is_listed(name), "{name}");
        }
    }

    #[test]
    fn a_search_has_an_end() {
        let folder = folder(&["a.pyr", "b.pyr", "c.pyr"]);
        assert_eq!(names(&folder, 2), (vec!["a.pyr".to_owned()], false), "the folder itself counts");
    }

    #[cfg(unix)]
    #[test]
    fn links_do_not_lead_in_circles() {
        let folder = folder(&["a.pyr"]);
        std::os::unix::fs::symlink(folder.path(), folder.path().join("again")).unwrap();
        std::os::unix::fs::symlink(folder.path().join("a.pyr"), folder.path().join("b.pyr")).unwrap();
        assert_eq!(names(&folder, 100).0, ["a.pyr", "b.pyr"]);
    }

    #[cfg(unix)]
    #[test]
    fn a_search_waits_for_nobody() {
        let folder = folder(&["a.pyr", "in/b.pyr", "in/deep/c.pyr"]);
        std::os::unix::fs::symlink("/dev/zero", folder.path().join("in/.gitignore")).unwrap();
        assert_eq!(names(&folder, 100).0, ["a.pyr"]);
        let inside = folder.path().join("in/deep");
        assert_eq!(list(&inside, 100).errors.len(), 1);
        assert!(!super::lists(&inside, &inside.join("c.pyr")));
    }

    #[test]
    fn a_missing_folder_is_an_error() {
        let folder = folder(&[]);
        assert_eq!(list(&folder.path().join("x"), 9).errors.len(), 1);
    }
}
