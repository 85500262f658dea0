//! The files that open documents import: read from the disk unless they are open themselves.

use std::fs;
use std::path::Path;

use ropey::Rope;
use rustc_hash::FxHashSet;
use tower_lsp::ls_types::Uri;

use crate::documents::{Document, key};
use crate::state::State;

impl State {
    /// Reads what open documents import and forgets what they import no longer; returns the addresses of the latter.
    /// An import may not lead out of the folders that are open, or, where none is, out of the importing file's own.
    pub(crate) fn follow_imports(&mut self) -> Vec<Uri> {
        let wanted = self.imported();
        let read: Vec<String> =
            wanted.iter().filter(|path| !self.documents.contains_key(*path)).cloned().collect();
        for path in read {
            self.read(&path);
        }
        let not_open = self.documents.iter().filter(|(_, document)| document.version.is_none());
        let left: Vec<String> =
            not_open.map(|(key, _)| key.clone()).filter(|key| !wanted.contains(key)).collect();
        let forgotten = left
            .iter()
            .filter_map(|key| self.documents.get(key))
            .map(|document| document.uri.clone())
            .collect();
        for key in left {
            self.remove(&key);
        }
        forgotten
    }

    /// The paths that open documents import, as far as they may.
    fn imported(&self) -> FxHashSet<String> {
        let open = self.documents.iter().filter(|(_, document)| document.version.is_some());
        let imports = open.flat_map(|(key, document)| {
            let paths = document.file.map_or(&[][..], |file| self.database.imports(file));
            paths.iter().filter(move |path| self.is_inside(key, path))
        });
        imports.cloned().collect()
    }

    fn is_inside(&self, importer: &str, path: &str) -> bool {
        let folder = importer.rfind('/').map_or("", |slash| &importer[..=slash]);
        let own = [folder.to_owned()];
        let folders = if self.folders.is_empty() { &own[..] } else { &self.folders };
        folders.iter().any(|folder| !folder.is_empty() && path.starts_with(folder.as_str()))
    }

    /// Takes in a file; one that cannot be read is missing, which whoever uses its names will be told.
    fn read(&mut self, path: &str) {
        let Ok(text) = fs::read_to_string(Path::new(path)) else { return };
        let Some(uri) = Uri::from_file_path(path) else { return };
        let file = Some(self.database.open(path, &text));
        let document =
            Document { text: Rope::from_str(&text), version: None, uri, file, opening: 0, published: None };
        self.documents.insert(path.to_owned(), document);
        self.changed = true;
    }
}

/// The folders a client has open, as prefixes of keys.
pub(crate) fn folders<'a>(uris: impl IntoIterator<Item = &'a Uri>) -> Vec<String> {
    uris.into_iter().map(|uri| format!("{}/", key(uri).trim_end_matches('/'))).collect()
}

#[cfg(test)]
mod tests {
    use tower_lsp::ls_types::TextDocumentItem;

    use super::*;

    struct Workspace {
        folder: tempfile::TempDir,
        state: State,
    }

    impl Workspace {
        fn new(files: &[(&str, &str)]) -> Self {
            let folder = tempfile::tempdir().unwrap();
            for (name, text) in files {
                let path = folder.path().join(name);
                fs::create_dir_all(path.parent().unwrap()).unwrap();
                fs::write(path, text).unwrap();
            }
            Self { folder, state: State::default() }
        }

        fn uri(&self, name: &str) -> Uri {
            Uri::from_file_path(self.folder.path().join(name)).unwrap()
        }

        fn open(&mut self, name: &str, text: &str) {
            let item = TextDocumentItem::new(self.uri(name), "pydslrep".to_owned(), 1, text.to_owned());
            self.state.open(item);
        }

        fn codes(&self, name: &str) -> Vec<&'static str> {
            let file = self.state.analysed(&self.uri(name)).unwrap().1;
            self.state.database.diagnostics(file).iter().map(pydslrep_analysis::Diagnostic::code).collect()
        }
    }

    const USER: &str = "import \"parts/wheels.pyr\"\nrobot r with port 1 has { a b } wheels";

    #[test]
    fn an_import_is_read_and_forgotten_with_its_importer() {
        let mut workspace = Workspace::new(&[("parts/wheels.pyr", "wheel a with radius 4")]);
        workspace.open("main.pyr", USER);
        assert_eq!(workspace.codes("main.pyr"), [""; 0], "nothing is known of the import yet");
        assert_eq!(workspace.state.follow_imports(), []);
        assert_eq!(workspace.codes("main.pyr"), ["unresolved-reference"], "there is no wheel `b`");
        let (main, parts) = (workspace.uri("main.pyr"), workspace.uri("parts/wheels.pyr"));
        assert!(workspace.state.close(&main));
        assert_eq!(workspace.state.follow_imports(), [parts]);
        assert!(workspace.state.documents.is_empty());
    }

    #[test]
    fn an_open_document_counts_more_than_its_file() {
        let mut workspace = Workspace::new(&[("parts/wheels.pyr", "wheel a with radius 4")]);
        workspace.open("main.pyr", USER);
        workspace.state.follow_imports();
        workspace.open("parts/wheels.pyr", "wheel a with radius 4 wheel b with radius 4");
        assert_eq!(workspace.codes("main.pyr"), [""; 0]);
        let parts = workspace.uri("parts/wheels.pyr");
        assert!(workspace.state.close(&parts));
        workspace.state.follow_imports();
        assert_eq!(workspace.codes("main.pyr"), ["unresolved-reference"], "it is read from the disk again");
    }

    #[test]
    fn imports_stay_inside() {
        let mut workspace = Workspace::new(&[("secret.pyr", "wheel a with radius 4")]);
        workspace.open("project/main.pyr", "import \"../secret.pyr\"");
        workspace.state.follow_imports();
        assert_eq!(workspace.state.documents.len(), 1);
        workspace.state.folders = folders([&workspace.uri("")]);
        workspace.state.follow_imports();
        assert_eq!(workspace.state.documents.len(), 2);
    }
}
