//! The workspace: which files belong to it, whether or not they are open, and what they import.

use std::path::Path;

use pydslrep_analysis::Absence;
use pydslrep_files::{Unread, belongs, import_bound, without_mark};
use ropey::Rope;
use tower_lsp::ls_types::{InitializeParams, Uri};

use crate::documents::{Document, Sort, key};
use crate::state::State;

/// More programs than these are not looked at unless they are opened.
pub(crate) const MOST_PROGRAMS: usize = 5_000;

/// More files and folders than these are not walked in search of programs: somebody may have opened a whole disk.
pub(crate) const MOST_ENTRIES: usize = 100_000;

/// The folders a client has open, as prefixes of keys.
pub(crate) fn folders<'a>(uris: impl IntoIterator<Item = &'a Uri>) -> Vec<String> {
    uris.into_iter().map(|uri| format!("{}/", key(uri).trim_end_matches('/'))).collect()
}

/// The folders a client opens from the start.
pub(crate) fn folders_of(params: &InitializeParams) -> Vec<String> {
    match &params.workspace_folders {
        Some(open) => folders(open.iter().map(|folder| &folder.uri)),
        // Older clients know one folder only.
        #[allow(deprecated, reason = "it is all that they say")]
        None => folders(&params.root_uri),
    }
}

impl State {
    /// Whether a file is in a folder that is open in the client.
    pub(crate) fn is_in_workspace(&self, key: &str) -> bool {
        self.folders.iter().any(|folder| key.starts_with(folder.as_str()))
    }

    /// Takes in a file that was found on the disk, unless it is there already.
    pub(crate) fn add_found(&mut self, path: &Path, text: &str) {
        let Some(uri) = Uri::from_file_path(path) else { return };
        let key = key(&uri);
        if !self.documents.contains_key(&key) {
            self.insert_from_disk(key, uri, text);
            self.follow_scenes();
        }
    }

    /// A file was created, changed or deleted, by whomever.
    pub(crate) fn file_changed(&mut self, uri: &Uri) {
        let key = key(uri);
        match Sort::of(&key) {
            Sort::Settings => return self.reload_settings(),
            Sort::Scene => return self.scene_file_changed(&key, uri),
            Sort::Program => {}
        }
        // What the client has open is as the client says.
        if self.documents.get(&key).is_none_or(|document| document.version.is_none()) {
            self.remove(&key);
            if self.is_part_of_workspace(&key)
                && let Ok(text) = pydslrep_files::read(Path::new(&key))
            {
                self.insert_from_disk(key.clone(), uri.clone(), &text);
            }
        }
        self.follow_imports_of(&key);
        self.follow_scenes();
    }

    /// Whether a search in the folders that are open in the client would find a program.
    pub(crate) fn is_part_of_workspace(&self, key: &str) -> bool {
        let path = Path::new(key);
        let mut folders = self.folders.iter().filter(|folder| key.starts_with(folder.as_str()));
        folders.any(|folder| belongs(Path::new(folder), path))
    }

    /// The folders that are open in the client changed; what is left behind is forgotten.
    pub(crate) fn set_folders(&mut self, folders: Vec<String>) {
        self.folders = folders;
        // What was outside may be inside now, and the other way round.
        let all: Vec<String> = self.documents.keys().cloned().collect();
        for key in all {
            self.follow_imports(&key);
        }
        self.forget_unwanted();
        self.reload_settings();
        self.follow_scenes();
    }

    /// Reads what a document imports, where that has changed since it was last looked at.
    pub(crate) fn follow_changed_imports(&mut self, key: &str) {
        let Some(document) = self.documents.get(key) else { return };
        let imports = document.file.map_or(&[][..], |file| self.database.imports(file));
        if imports != document.imports {
            self.follow_imports(key);
            self.forget_unwanted();
        }
    }

    /// Looks again for a file wherever it is imported.
    pub(crate) fn follow_imports_of(&mut self, key: &str) {
        for importer in self.database.importing_files(key) {
            let importer = self.database.path(importer).to_owned();
            self.follow_imports(&importer);
        }
        self.forget_unwanted();
    }

    /// Reads what a document imports, and what that imports, and says of the rest why it is not there.
    pub(crate) fn follow_imports(&mut self, key: &str) {
        let mut waiting = vec![key.to_owned()];
        while let Some(importer) = waiting.pop() {
            let Some(document) = self.documents.get_mut(&importer) else { continue };
            let Some(file) = document.file else { continue };
            let imports = self.database.imports(file).to_vec();
            document.imports.clone_from(&imports);
            for path in imports {
                let known = self.documents.contains_key(&path);
                let absence = self.find_import(&importer, &path).err();
                self.database.set_absence(file, &path, absence);
                if !known && self.documents.contains_key(&path) {
                    waiting.push(path);
                }
            }
        }
    }

    /// Takes in a file that is imported, unless it is there already.
    fn find_import(&mut self, importer: &str, path: &str) -> Result<(), Absence> {
        // What is on no disk has nothing beside it that it could import.
        if !importer.starts_with('/') {
            return Ok(());
        }
        if !self.may_import(importer, path) {
            return Err(Absence::Outside);
        }
        if self.documents.contains_key(path) {
            return Ok(());
        }
        match pydslrep_files::read(Path::new(path)) {
            Ok(text) => {
                if let Some(uri) = Uri::from_file_path(path) {
                    self.insert_from_disk(path.to_owned(), uri, &text);
                }
                Ok(())
            }
            Err(Unread::Missing) => Err(Absence::Missing),
            Err(unread) => Err(Absence::Unreadable(unread.to_string())),
        }
    }

    /// Imports stay inside the folders that are open; those of a file outside of all of them near that file.
    pub(crate) fn may_import(&self, importer: &str, path: &str) -> bool {
        if self.is_in_workspace(importer) {
            return self.is_in_workspace(path);
        }
        Path::new(path).starts_with(import_bound(Path::new(importer)))
    }

    pub(crate) fn insert_from_disk(&mut self, key: String, uri: Uri, text: &str) {
        let text = without_mark(text);
        let mut document = Document::new(uri, Rope::from_str(text), None);
        if !document.is_program() {
            self.stale.documents.insert(key.clone());
            self.documents.insert(key, document);
            return;
        }
        document.file = Some(self.database.open(&key, text));
        self.documents.insert(key.clone(), document);
        self.apply_settings(&key);
        self.follow_imports(&key);
    }

    /// Forgets files that are neither open, nor in the workspace, nor imported by any that is there.
    pub(crate) fn forget_unwanted(&mut self) {
        loop {
            let is_imported = |key: &String, document: &Document| {
                self.database.importing_files(key).into_iter().any(|importer| {
                    Some(importer) != document.file
                        && self.database.absence(importer, key) != Some(&Absence::Outside)
                })
            };
            let is_wanted = |key: &String, document: &Document| {
                document.version.is_some()
                    || self.is_in_workspace(key)
                    || document.sort() == Sort::Settings
                    || self.scenes.is_wanted(key)
                    || is_imported(key, document)
            };
            let unwanted = self.documents.iter().filter(|(key, document)| !is_wanted(key, document));
            let unwanted: Vec<String> = unwanted.map(|(key, _)| key.clone()).collect();
            if unwanted.is_empty() {
                return;
            }
            for key in unwanted {
                self.remove(&key);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use tower_lsp::ls_types::{
        DidChangeTextDocumentParams, TextDocumentContentChangeEvent, TextDocumentItem,
        VersionedTextDocumentIdentifier,
    };

    use super::*;

    struct Workspace {
        folder: tempfile::TempDir,
        state: State,
    }

    impl Workspace {
        fn new(files: &[(&str, &str)]) -> Self {
            let folder = tempfile::Builder::new().prefix("workspace").tempdir().unwrap();
            let workspace = Self { folder, state: State::default() };
            for (name, text) in files {
                workspace.write(name, text);
            }
            workspace
        }

        fn write(&self, name: &str, text: &str) {
            let path = self.folder.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        }

        fn uri(&self, name: &str) -> Uri {
            Uri::from_file_path(self.folder.path().join(name)).unwrap()
        }

        fn open(&mut self, name: &str, text: &str) {
            let item = TextDocumentItem::new(self.uri(name), "pydslrep".to_owned(), 1, text.to_owned());
            self.state.open(&item);
        }

        fn change(&mut self, name: &str, text: &str) {
            let change =
                TextDocumentContentChangeEvent { range: None, range_length: None, text: text.to_owned() };
            let text_document = VersionedTextDocumentIdentifier::new(self.uri(name), 2);
            let content_changes = vec![change];
            assert!(self.state.change(&DidChangeTextDocumentParams { text_document, content_changes }));
        }

        /// The client says that a file changed on the disk.
        fn tell(&mut self, name: &str) {
            let uri = self.uri(name);
            self.state.file_changed(&uri);
        }

        fn codes(&self, name: &str) -> Vec<&'static str> {
            let file = self.state.analysed(&self.uri(name)).unwrap().1;
            self.state.database.diagnostics(file).iter().map(pydslrep_analysis::Diagnostic::code).collect()
        }

        fn known(&self) -> Vec<String> {
            let folder = key(&Uri::from_file_path(self.folder.path()).unwrap());
            let near = |key: &String| key.strip_prefix(&folder).unwrap().trim_start_matches('/').to_owned();
            let mut known: Vec<String> = self.state.documents.keys().map(near).collect();
            known.sort();
            known
        }
    }

    const WHEEL: &str = "wheel a with radius 4";
    const USER: &str = "import \"parts/wheels.pyr\"\nrobot r with port 1 has { a b } wheels";

    #[test]
    fn an_import_is_read_and_forgotten_with_its_importer() {
        let mut workspace = Workspace::new(&[("parts/wheels.pyr", WHEEL)]);
        workspace.open("main.pyr", USER);
        assert_eq!(workspace.codes("main.pyr"), ["unresolved-reference"], "there is no wheel `b`");
        assert_eq!(workspace.known(), ["main.pyr", "parts/wheels.pyr"]);
        workspace.change("main.pyr", "");
        assert_eq!(workspace.known(), ["main.pyr"]);
        workspace.change("main.pyr", USER);
        let main = workspace.uri("main.pyr");
        assert!(workspace.state.close(&main));
        assert_eq!(workspace.known(), [""; 0]);
    }

    #[test]
    fn imports_of_imports_matter_too() {
        let movement = "import \"robots.pyr\"\nmovement m of r { turn left }";
        let robots = "wheel a with radius 4 wheel b with radius 4 robot r with port 1 has { a b } wheels";
        let mut workspace = Workspace::new(&[("moves.pyr", movement), ("robots.pyr", robots)]);
        workspace.open(
            "main.pyr",
            "import \"moves.pyr\" import \"robots.pyr\" environment e has { r } robots with { m } moves",
        );
        assert_eq!(workspace.known(), ["main.pyr", "moves.pyr", "robots.pyr"]);
        assert_eq!(workspace.codes("main.pyr"), [""; 0]);
        workspace.open("moves.pyr", "movement m of r { turn left }");
        assert_eq!(workspace.codes("moves.pyr"), ["unresolved-reference"]);
    }

    #[test]
    fn an_open_document_counts_more_than_its_file() {
        let mut workspace = Workspace::new(&[("parts/wheels.pyr", WHEEL)]);
        workspace.open("main.pyr", USER);
        workspace.open("parts/wheels.pyr", "wheel a with radius 4 wheel b with radius 4");
        assert_eq!(workspace.codes("main.pyr"), [""; 0]);
        workspace.tell("parts/wheels.pyr");
        assert_eq!(workspace.codes("main.pyr"), [""; 0]);
        let parts = workspace.uri("parts/wheels.pyr");
        assert!(workspace.state.close(&parts));
        assert_eq!(workspace.codes("main.pyr"), ["unresolved-reference"], "it is read from the disk again");
    }

    #[test]
    fn files_come_change_and_go() {
        let mut workspace = Workspace::new(&[]);
        workspace.open("main.pyr", USER);
        assert_eq!(workspace.codes("main.pyr"), ["unresolved-import"]);
        workspace.write("parts/wheels.pyr", "wheel a with radius 4 wheel b with radius 4");
        workspace.tell("parts/wheels.pyr");
        assert_eq!(workspace.codes("main.pyr"), [""; 0]);
        workspace.write("parts/wheels.pyr", "wheel a with radius 4 wheel b with radius 5");
        workspace.tell("parts/wheels.pyr");
        assert_eq!(workspace.codes("main.pyr"), ["mixed-radii"]);
        fs::remove_file(workspace.folder.path().join("parts/wheels.pyr")).unwrap();
        workspace.tell("parts/wheels.pyr");
        assert_eq!(workspace.codes("main.pyr"), ["unresolved-import"]);
        assert_eq!(workspace.known(), ["main.pyr"]);
    }

    #[test]
    fn imports_stay_inside() {
        let mut workspace = Workspace::new(&[("wheel.pyr", WHEEL), ("project/b.pyr", WHEEL)]);
        workspace.open("project/main.pyr", "import \"../wheel.pyr\"");
        assert_eq!(workspace.codes("project/main.pyr"), ["unresolved-import"]);
        assert_eq!(workspace.known(), ["project/main.pyr"]);
        let inner = folders([&workspace.uri("project")]);
        workspace.state.set_folders(inner);
        assert_eq!(workspace.codes("project/main.pyr"), ["unresolved-import"]);
        let outer = folders([&workspace.uri("")]);
        workspace.state.set_folders(outer);
        assert_eq!(workspace.codes("project/main.pyr"), [""; 0]);
        workspace.state.set_folders(Vec::new());
        assert_eq!(workspace.known(), ["project/main.pyr"]);
        workspace.write("pydslrep.toml", "");
        workspace.tell("pydslrep.toml");
        workspace.change("project/main.pyr", "");
        workspace.change("project/main.pyr", "import \"../wheel.pyr\"");
        assert_eq!(workspace.codes("project/main.pyr"), [""; 0]);
    }

    #[test]
    fn a_buffer_without_a_file_imports_nothing_and_is_not_told_so() {
        let mut workspace = Workspace::new(&[]);
        let uri: Uri = "untitled:Untitled-1".parse().unwrap();
        workspace.state.open(&TextDocumentItem::new(uri.clone(), "pydslrep".to_owned(), 1, USER.to_owned()));
        let file = workspace.state.analysed(&uri).unwrap().1;
        assert_eq!(workspace.state.database.diagnostics(file), []);
    }

    #[test]
    fn closed_files_of_the_workspace_stay() {
        let mut workspace = Workspace::new(&[("a.pyr", WHEEL), (".gitignore", "old"), ("old/b.pyr", WHEEL)]);
        let open = folders([&workspace.uri("")]);
        workspace.state.set_folders(open);
        for name in ["a.pyr", "old/b.pyr"] {
            workspace.open(name, "");
            let uri = workspace.uri(name);
            assert!(workspace.state.close(&uri));
        }
        assert_eq!(workspace.known(), ["a.pyr"], "what is ignored is no part of the workspace");
    }

    #[test]
    fn the_nearest_settings_hold_and_follow_their_file() {
        let mut workspace =
            Workspace::new(&[("pydslrep.toml", "default-speed = 20"), ("a/pydslrep.toml", "")]);
        let speed = |workspace: &Workspace, name: &str| {
            workspace.state.document(&workspace.uri(name)).unwrap().settings.default_speed
        };
        workspace.open("main.pyr", "");
        workspace.open("a/main.pyr", "");
        assert!((speed(&workspace, "main.pyr") - 20.0).abs() < 1e-9);
        let usual = speed(&workspace, "a/main.pyr");
        workspace.write("a/pydslrep.toml", "default-speed = 30");
        assert!((speed(&workspace, "a/main.pyr") - usual).abs() < 1e-9, "nobody said that it changed");
        workspace.tell("a/pydslrep.toml");
        assert!((speed(&workspace, "a/main.pyr") - 30.0).abs() < 1e-9);
        workspace.open("a/pydslrep.toml", "default-speed = 40");
        assert!((speed(&workspace, "a/main.pyr") - 40.0).abs() < 1e-9, "as it is in the editor");
        workspace.change("a/pydslrep.toml", "default-speed = 50");
        assert!((speed(&workspace, "a/main.pyr") - 50.0).abs() < 1e-9);
        workspace.state.set_client_settings(&serde_json::json!({ "defaultSpeed": 60 }));
        assert!((speed(&workspace, "a/main.pyr") - 60.0).abs() < 1e-9, "the client counts most");
        let toml = workspace.uri("a/pydslrep.toml");
        assert!(workspace.state.close(&toml));
        workspace.state.set_client_settings(&serde_json::Value::Null);
        assert!((speed(&workspace, "a/main.pyr") - 30.0).abs() < 1e-9);
        assert!((speed(&workspace, "main.pyr") - 20.0).abs() < 1e-9);
    }
}
