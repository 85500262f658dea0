//! The kind of a document, by its name.

use std::path::Path;

use pydslrep_text::file_names::{PROGRAM_EXTENSION, SCENE_SUFFIX, SETTINGS_FILE};

/// The kind of a document. The order is the one in which diagnostics are reported.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum DocumentKind {
    /// A program.
    Program,
    /// The scene of an environment, `<environment>.scene.toml`.
    Scene,
    /// The settings of a folder, `pydslrep.toml`.
    Settings,
}

impl DocumentKind {
    /// The kind of a document that is open or imported: a program unless its name says otherwise.
    pub fn of_document(key: &str) -> Self {
        match key.rsplit('/').next().unwrap_or(key) {
            SETTINGS_FILE => Self::Settings,
            name if name.ends_with(SCENE_SUFFIX) => Self::Scene,
            _ => Self::Program,
        }
    }

    /// The kind of a file on a disk; `None` for a file that is not ours.
    pub fn of_file(path: &Path) -> Option<Self> {
        let is_program = || path.extension().is_some_and(|extension| extension == PROGRAM_EXTENSION);
        match Self::of_document(&path.file_name()?.to_string_lossy()) {
            Self::Program => is_program().then_some(Self::Program),
            kind => Some(kind),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_tell_kinds() {
        let kinds = |name: &str| (DocumentKind::of_document(name), DocumentKind::of_file(Path::new(name)));
        assert_eq!(kinds("/a/x.pyr"), (DocumentKind::Program, Some(DocumentKind::Program)));
        assert_eq!(kinds("/a/hall.scene.toml"), (DocumentKind::Scene, Some(DocumentKind::Scene)));
        assert_eq!(kinds("/a/pydslrep.toml"), (DocumentKind::Settings, Some(DocumentKind::Settings)));
        for other in ["/a/x.PYR", "/a/pyr", "/pydslrep.toml/x", "untitled:1"] {
            assert_eq!(kinds(other), (DocumentKind::Program, None), "{other}");
        }
    }
}
