//! Program files: finds and reads them, and bounds their imports.
//!
//! Shared by the command and the server, so that they see the same workspace. Knows paths and bytes. Must never know the
//! content of programs.

mod read;
mod search;

use std::path::Path;

use pydslrep_text::file_names::SCENE_SUFFIX;
pub use pydslrep_text::file_names::{PROGRAM_EXTENSION as EXTENSION, SETTINGS_FILE as FILE_NAME};
pub use read::{MAX_BYTES, Unread, decode, read, without_mark};
pub use search::{Found, belongs, find};

/// Whether a path has the extension of programs.
pub fn is_program(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == EXTENSION)
}

/// Whether a path has the ending of scene files.
pub fn is_scene(path: &Path) -> bool {
    path.file_name().is_some_and(|name| name.to_string_lossy().ends_with(SCENE_SUFFIX))
}

/// The nearest folder above a file that contains a `pydslrep.toml`.
pub fn project_folder(file: &Path) -> Option<&Path> {
    let own = file.parent()?;
    own.ancestors().find(|folder| folder.join(FILE_NAME).is_file())
}

/// The folder that imports of a program may not leave: that of the nearest `pydslrep.toml`, or the program's own.
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
        std::fs::write(folder.path().join(FILE_NAME), "").unwrap();
        assert_eq!(import_bound(&program), folder.path());
        std::fs::write(folder.path().join("a").join(FILE_NAME), "").unwrap();
        assert_eq!(import_bound(&program), folder.path().join("a"));
    }
}
