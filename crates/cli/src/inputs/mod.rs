//! The input of the command: the named programs, in the workspace they belong to.

pub(crate) mod lines;
pub(crate) mod paths;
pub(crate) mod program;
pub(crate) mod read;
pub(crate) mod rewrite;
pub(crate) mod scenes;
pub(crate) mod watch;

use std::borrow::Cow;
use std::collections::{BTreeSet, HashMap};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use pydslrep_analysis::{Database, Diagnostic, FileId, Offers};
use pydslrep_config::{Config, Settings};
use pydslrep_files::Disk;
use pydslrep_text::file_names::PROGRAM_EXTENSION;
use pydslrep_workspace::{Workspace, key_of, path_of, without_byte_order_mark};
use ropey::Rope;

use self::paths::{absolute, near, shown};
use self::read::{Found, STDIN_SHOWN, read_failure, read_programs};
use crate::failure::Failure;
use crate::report::output::count;
use crate::report::render;

/// The settings of the current folder, for a command without a program.
///
/// # Errors
/// As [`Inputs::check_settings`].
pub(crate) fn settings_here() -> Result<Settings, Failure> {
    let mut inputs = Inputs::default();
    let key = key_of(&absolute(Path::new(STDIN_SHOWN))?);
    inputs.workspace.open_all(vec![(key.clone(), Rope::new())]);
    inputs.files.extend(inputs.database().file(&key));
    inputs.name_documents();
    inputs.check_settings()?;
    Ok(inputs.files.first().map_or_else(Settings::default, |file| inputs.settings(*file)))
}

/// The programs that were named, and the workspace around them.
#[derive(Debug)]
pub(crate) struct Inputs {
    workspace: Workspace,
    /// The programs that were named, or are in a folder that was, in the order of their paths.
    files: Vec<FileId>,
    /// The keys of all scenes in folders that were named.
    scenes: BTreeSet<String>,
    /// The names of documents in output, by key.
    names: HashMap<String, String>,
    /// Where each named program is on the disk; standard input is nowhere.
    places: HashMap<FileId, PathBuf>,
    /// A scene that was read in place of the one next to a program.
    other_scene: Option<PathBuf>,
}

impl Default for Inputs {
    fn default() -> Self {
        Self {
            workspace: Workspace::new(Arc::new(Disk)),
            files: Vec::new(),
            scenes: BTreeSet::new(),
            names: HashMap::new(),
            places: HashMap::new(),
            other_scene: None,
        }
    }
}

impl Inputs {
    /// Opens programs: files, folders with all programs in them, and `-` for standard input. `options` win over
    /// settings files. A file that cannot be read is among the failures, and does not keep others from being opened.
    pub(crate) fn open(paths: &[PathBuf], options: &Config) -> (Self, Vec<Failure>) {
        let Found { programs, scenes, folders, failures } = read_programs(paths);
        let mut inputs = Self::default();
        let folders = folders.iter().map(|folder| format!("{}/", key_of(folder).trim_end_matches('/')));
        inputs.workspace.set_folders(folders.collect());
        inputs.workspace.set_overrides(options.clone());
        let mut documents = Vec::new();
        let mut places = Vec::new();
        for program in programs {
            let path = program.place.clone().or_else(|| absolute(Path::new(STDIN_SHOWN)).ok());
            let Some(key) = path.map(|path| key_of(&path)) else { continue };
            documents.push((key.clone(), Rope::from_str(without_byte_order_mark(&program.text))));
            places.push((key.clone(), program.place));
            inputs.names.insert(key, program.shown);
        }
        inputs.workspace.open_all(documents);
        for (key, place) in places {
            let Some(file) = inputs.database().file(&key) else { continue };
            inputs.files.push(file);
            inputs.places.extend(place.map(|place| (file, place)));
        }
        inputs
            .files
            .sort_by(|a, b| inputs.workspace.database().path(*a).cmp(inputs.workspace.database().path(*b)));
        for (key, shown) in scenes.iter().map(|path| (key_of(path), shown(&near(path)))) {
            inputs.workspace.load_scene(&key);
            inputs.names.insert(key.clone(), shown);
            inputs.scenes.insert(key);
        }
        inputs.name_documents();
        (inputs, failures)
    }

    /// Opens one program.
    ///
    /// # Errors
    /// When it or its settings cannot be read, or the settings have mistakes.
    pub(crate) fn open_one(path: &Path, options: &Config) -> Result<(Self, FileId), Failure> {
        if path.is_dir() {
            return Err(Failure::new(format!("{} is a folder", path.display()))
                .help(format!("name one program: a file that ends in .{PROGRAM_EXTENSION}")));
        }
        let (inputs, failures) = Self::open(&[path.to_owned()], options);
        match (failures.into_iter().next(), inputs.files.first().copied()) {
            (None, Some(file)) => {
                inputs.check_settings()?;
                Ok((inputs, file))
            }
            (Some(failure), _) => Err(failure),
            (None, None) => Err(Failure::new(format!("cannot open {}", path.display()))),
        }
    }

    /// Checks the settings files of the programs.
    ///
    /// # Errors
    /// With every mistake in them: a misspelt setting could change what the command does, so it does nothing.
    pub(crate) fn check_settings(&self) -> Result<(), Failure> {
        let of_file = |file: &FileId| self.workspace.settings_file(self.database().path(*file));
        let keys: BTreeSet<&str> = self.files.iter().filter_map(of_file).collect();
        let mut problems = String::new();
        for key in keys {
            if let Some(error) = self.workspace.read_error(key) {
                return Err(read_failure(&self.name(key), error));
            }
            problems += &self.render_problems(key, &self.workspace.problems(key));
        }
        if problems.is_empty() { Ok(()) } else { Err(Failure::Rendered(problems)) }
    }

    /// The programs that were named, in the order of their paths.
    pub(crate) fn files(&self) -> &[FileId] {
        &self.files
    }

    /// The analysis of all programs.
    pub(crate) fn database(&self) -> &Database {
        self.workspace.database()
    }

    /// The text of a program.
    pub(crate) fn text(&self, file: FileId) -> String {
        self.database().text(file).map(ToString::to_string).unwrap_or_default()
    }

    /// Returns the name of a program in output.
    pub(crate) fn shown(&self, file: FileId) -> &str {
        self.names.get(self.database().path(file)).map_or("", String::as_str)
    }

    /// Where a program is on the disk; `None` for standard input.
    pub(crate) fn place(&self, file: FileId) -> Option<&Path> {
        self.places.get(&file).map(PathBuf::as_path)
    }

    /// The name of a program's file; empty for standard input.
    pub(crate) fn file_name(&self, file: FileId) -> String {
        let name = self.place(file).and_then(Path::file_name);
        name.map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
    }

    /// The settings of a program.
    pub(crate) fn settings(&self, file: FileId) -> Settings {
        self.workspace
            .document_of(file)
            .map_or_else(Settings::default, |document| (*document.settings).clone())
    }

    /// Where the scripts of a program go: to the folder that its settings name, else beside it. `None` for a program
    /// from standard input without such a setting.
    pub(crate) fn script_folder(&self, file: FileId) -> Option<PathBuf> {
        let named = self.workspace.output_folder(self.database().path(file));
        let beside = || {
            self.place(file)?;
            Some(Path::new(self.shown(file)).parent().unwrap_or(Path::new("")).to_owned())
        };
        named.map(|folder| near(&path_of(&folder))).or_else(beside)
    }

    /// Returns the problems of all named programs, with the severities that are set for each.
    pub(crate) fn all_diagnostics(&self) -> Vec<Diagnostic> {
        let of_file =
            |file: &FileId| self.settings(*file).severities.applied(self.database().diagnostics(*file));
        self.files.iter().flat_map(of_file).collect()
    }

    /// Keeps only the fixes that an editor offers, too.
    pub(crate) fn retain_offered(&self, diagnostics: &mut [Diagnostic]) {
        /// Nobody reads more, and each takes as long as finding all problems of a file.
        const MAX_SUGGESTIONS: usize = 1000;
        Offers::new(self.database(), MAX_SUGGESTIONS).retain(diagnostics);
    }

    /// Changes programs in the database; what they import then is read.
    pub(crate) fn update<R>(&mut self, change: impl FnOnce(&mut Database) -> R) -> R {
        let result = self.workspace.update(change);
        self.name_documents();
        result
    }

    /// Everything that was read, what imports could lead to, and where scenes could be.
    pub(crate) fn paths(&self) -> BTreeSet<PathBuf> {
        let mut paths: BTreeSet<PathBuf> = self.places.values().cloned().collect();
        for document in self.workspace.documents() {
            paths.insert(path_of(&document.key).into_owned());
            let Some(file) = document.file else { continue };
            let imported = self.database().imports(file).iter();
            paths.extend(imported.map(|key| path_of(key).into_owned()));
            let scenes = self.workspace.scene_keys(file).into_iter();
            paths.extend(scenes.map(|(_, key)| path_of(&key).into_owned()));
        }
        paths
    }

    /// The files that were read, which no output may replace.
    pub(crate) fn read_paths(&self) -> Vec<Cow<'_, Path>> {
        let named = self.places.values().chain(&self.other_scene).map(|path| Cow::Borrowed(path.as_path()));
        named.chain(self.workspace.documents().map(|document| path_of(&document.key))).collect()
    }

    /// The text of everything that was read, in the order of the keys.
    pub(crate) fn texts(&self) -> Vec<(&str, String)> {
        let documents = self.workspace.documents();
        let mut texts: Vec<_> =
            documents.map(|document| (document.key.as_str(), document.text.to_string())).collect();
        texts.sort_unstable();
        texts
    }

    /// Returns the name of a document in output, by its key.
    fn name(&self, key: &str) -> String {
        self.names.get(key).cloned().unwrap_or_else(|| shown(&near(&path_of(key))))
    }

    /// Names the documents that were read besides the named ones.
    fn name_documents(&mut self) {
        for document in self.workspace.documents() {
            let name = || shown(&near(&path_of(&document.key)));
            self.names.entry(document.key.clone()).or_insert_with(name);
        }
    }

    fn render_problems(&self, key: &str, problems: &[pydslrep_config::Problem]) -> String {
        let text = self.workspace.document(key).map(|document| document.text.to_string()).unwrap_or_default();
        problems.iter().map(|problem| render::problem(&self.name(key), &text, problem)).collect()
    }
}

/// "1 file", "2 files".
pub(crate) fn count_files(files: &[FileId]) -> String {
    count(files.len(), "file")
}
