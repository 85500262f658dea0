//! Programs on a disk: which files are some, what they hold, and how far what belongs together reaches.
//!
//! The command and the server both start here, so that they see the same workspace. Knows paths and bytes. Must never
//! know what stands in a program.

mod read;
mod search;

use std::path::Path;

pub use read::{MOST_BYTES, Unread, decode, read};
pub use search::{Found, find};

/// The ending of programs.
pub const EXTENSION: &str = "pyr";

/// The file with the settings of all programs in its folder and below; its folder bounds where imports may lead.
pub const PROJECT_FILE: &str = "pydslrep.toml";

/// Whether a path is named like a program.
pub fn is_program(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == EXTENSION)
}

/// The nearest folder upwards from a file that holds a [`PROJECT_FILE`].
pub fn project_folder(file: &Path) -> Option<&Path> {
    let own = file.parent()?;
    own.ancestors().find(|folder| folder.join(PROJECT_FILE).is_file())
}

/// The folder that imports of a program may not leave: that of the nearest [`PROJECT_FILE`], else the program's own.
pub fn import_bound(program: &Path) -> &Path {
    project_folder(program).or_else(|| program.parent()).unwrap_or(program)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_project_file_bounds_imports() {
        let folder = tempfile::tempdir().unwrap();
        let below = folder.path().join("a/b");
        std::fs::create_dir_all(&below).unwrap();
        let program = below.join("x.pyr");
        assert_eq!(import_bound(&program), below);
        std::fs::write(folder.path().join(PROJECT_FILE), "").unwrap();
        assert_eq!(import_bound(&program), folder.path());
        std::fs::write(folder.path().join("a").join(PROJECT_FILE), "").unwrap();
        assert_eq!(import_bound(&program), folder.path().join("a"));
    }
}
