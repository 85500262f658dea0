//! Programs, what they import and their scenes: from files into the database.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use pydslrep_analysis::{Absence, Database, Diagnostic, EntityId, FileId, Offers};
use pydslrep_files::{EXTENSION, Found, Unread, find, import_bound, read, without_mark};

use crate::failure::Failure;
use crate::output::count;
use crate::paths::{absolute, key, near, scene_path, shown};
use crate::texts::{STDIN_SHOWN, read_file, read_stdin};

/// What standard input is called on the command line.
const STDIN: &str = "-";

/// Open programs and files they import.
#[derive(Debug, Default)]
pub(crate) struct Sources {
    pub(crate) database: Database,
    /// What a file is called in what is printed.
    shown: HashMap<FileId, String>,
    /// Where each program is on the disk; standard input is nowhere.
    places: HashMap<FileId, PathBuf>,
}

impl Sources {
    /// Opens programs: files, folders with all programs in them, and `-` for standard input. The files are in the
    /// order of their names, each once; what could not be opened is told by the failures, and does not keep the
    /// others from being opened.
    pub(crate) fn open(paths: &[PathBuf]) -> (Self, Vec<FileId>, Vec<Failure>) {
        let (mut sources, mut files, mut failures) = (Self::default(), Vec::new(), Vec::new());
        for path in paths {
            match sources.open_path(path, &mut failures) {
                Ok(opened) => files.extend(opened),
                Err(failure) => failures.push(failure),
            }
        }
        files.sort_by(|a, b| sources.shown[a].cmp(&sources.shown[b]));
        files.dedup();
        sources.follow_imports(&files);
        sources.tell_scenes(&files);
        (sources, files, failures)
    }

    /// Opens one program.
    ///
    /// # Errors
    /// When it or a file it imports cannot be opened.
    pub(crate) fn open_one(path: &Path) -> Result<(Self, FileId), Failure> {
        if path.is_dir() {
            return Err(Failure::new(format!("{} is a folder", path.display()))
                .help(format!("name one program: a file that ends in .{EXTENSION}")));
        }
        let (sources, files, failures) = Self::open(&[path.to_owned()]);
        match (failures.into_iter().next(), files.first()) {
            (None, Some(file)) => Ok((sources, *file)),
            (Some(failure), _) => Err(failure),
            (None, None) => Err(Failure::new(format!("{} could not be opened", path.display()))),
        }
    }

    /// What a file is called in what is printed.
    pub(crate) fn shown(&self, file: FileId) -> &str {
        self.shown.get(&file).map_or("", String::as_str)
    }

    /// Where a program is on the disk; `None` for standard input.
    pub(crate) fn place(&self, file: FileId) -> Option<&Path> {
        self.places.get(&file).map(PathBuf::as_path)
    }

    /// Everything that was read, what imports could lead to, and where scenes could be: the paths of all of it.
    pub(crate) fn paths(&self) -> Vec<PathBuf> {
        let imports = self.places.keys().flat_map(|file| self.database.imports(*file)).map(PathBuf::from);
        let scenes = self.places.keys().flat_map(|file| self.scene_paths(*file)).map(|(_, path)| path);
        self.places.values().cloned().chain(imports).chain(scenes).collect()
    }

    /// Where the scenes of all environments of a program would be, with the environments' names.
    pub(crate) fn scene_paths(&self, file: FileId) -> Vec<(String, PathBuf)> {
        let Some(program) = self.place(file) else { return Vec::new() };
        let environments = self.database.environments(file).into_iter();
        environments.map(|(_, name)| (name.text.to_string(), scene_path(program, &name.text))).collect()
    }

    /// Everything that was read, in the order of the paths.
    pub(crate) fn texts(&self) -> Vec<(&Path, String)> {
        let text = |file: &FileId| self.database.text(*file).map(ToString::to_string).unwrap_or_default();
        let mut texts: Vec<_> = self.places.iter().map(|(file, path)| (path.as_path(), text(file))).collect();
        texts.sort_unstable();
        texts
    }

    /// What is wrong with a program, in the order of the text.
    pub(crate) fn diagnostics(&self, file: FileId) -> Vec<Diagnostic> {
        let mut diagnostics = self.database.diagnostics(file);
        diagnostics.sort_by_key(|diagnostic| (diagnostic.span.start, diagnostic.span.end));
        diagnostics
    }

    /// Leaves of each problem only the fixes that an editor offers, too.
    pub(crate) fn retain_offered(&self, diagnostics: &mut [Diagnostic]) {
        /// Nobody reads more, and each takes as long as looking for all problems of a file.
        const MOST_SUGGESTIONS: usize = 1000;
        Offers::new(&self.database, MOST_SUGGESTIONS).retain(diagnostics);
    }

    /// Tells the database of the scene that was named for one environment. One that cannot be read is told of later.
    pub(crate) fn tell_scene(&mut self, file: FileId, environment: EntityId, named: Option<&Path>) {
        let name = self.database.tree(environment).and_then(|tree| tree.name()).map(|name| name.text.clone());
        if let (Some(name), Some(Ok(text))) = (name, named.map(read)) {
            self.database.set_scene(file, &name, Some(without_mark(&text)));
        }
    }

    /// Tells the database which scenes there are, so that it can tell what is in the way. A scene that cannot be read, or
    /// that is wrong, is a matter of those who drive in it.
    fn tell_scenes(&mut self, files: &[FileId]) {
        for file in files {
            for (environment, path) in self.scene_paths(*file) {
                let text = read(&path).ok();
                self.database.set_scene(*file, &environment, text.as_deref().map(without_mark));
            }
        }
    }

    fn open_path(&mut self, path: &Path, failures: &mut Vec<Failure>) -> Result<Vec<FileId>, Failure> {
        if path == Path::new(STDIN) {
            let text = read_stdin()?;
            let file = self.database.open(&key(&absolute(Path::new(STDIN_SHOWN))?), without_mark(&text));
            self.shown.insert(file, STDIN_SHOWN.to_owned());
            return Ok(vec![file]);
        }
        if !path.is_dir() {
            return Ok(vec![self.open_file(path)?]);
        }
        let mut files = Vec::new();
        for path in programs_in(path, failures)? {
            match self.open_file(&path) {
                Ok(file) => files.push(file),
                Err(failure) => failures.push(failure),
            }
        }
        Ok(files)
    }

    fn open_file(&mut self, path: &Path) -> Result<FileId, Failure> {
        let absolute = absolute(path)?;
        if let Some(open) = self.database.file(&key(&absolute)) {
            return Ok(open);
        }
        Ok(self.take(path, absolute, &read_file(path)?))
    }

    fn take(&mut self, path: &Path, absolute: PathBuf, text: &str) -> FileId {
        let file = self.database.open(&key(&absolute), without_mark(text));
        self.shown.insert(file, shown(path));
        self.places.insert(file, absolute);
        file
    }

    /// Opens what programs import, and what that imports; also what they import only since they were changed. What
    /// cannot be opened is a problem of the program that imports it.
    pub(crate) fn follow_imports(&mut self, files: &[FileId]) {
        for file in files {
            self.open_imports(*file);
        }
    }

    fn open_imports(&mut self, program: FileId) {
        let bound = import_bound(Path::new(self.database.path(program))).to_owned();
        let (mut waiting, mut seen) = (vec![program], HashSet::from([program]));
        while let Some(importer) = waiting.pop() {
            for path in self.database.imports(importer).to_vec() {
                let imported = self.open_import(Path::new(&path), &bound);
                match imported {
                    Ok(file) if seen.insert(file) => waiting.push(file),
                    Ok(_) => {}
                    Err(absence) => self.database.set_absence(importer, &path, Some(absence)),
                }
            }
        }
    }

    fn open_import(&mut self, path: &Path, bound: &Path) -> Result<FileId, Absence> {
        if !path.starts_with(bound) {
            return Err(Absence::Outside);
        }
        if let Some(open) = self.database.file(&key(path)) {
            return Ok(open);
        }
        match read(path) {
            Ok(text) => Ok(self.take(&near(path), path.to_owned(), &text)),
            Err(Unread::Missing) => Err(Absence::Missing),
            Err(unread) => Err(Absence::Unreadable(unread.to_string())),
        }
    }
}

/// A program as it is on the disk, byte order mark and all.
#[derive(Debug)]
pub(crate) struct Source {
    /// What it is called in what is printed.
    pub(crate) shown: String,
    /// Where it is; `None` for standard input.
    pub(crate) place: Option<PathBuf>,
    pub(crate) text: String,
}

/// Reads programs, named as for [`Sources::open`], without what they import.
pub(crate) fn read_programs(paths: &[PathBuf]) -> (Vec<Source>, Vec<Failure>) {
    let (mut programs, mut failures): (Vec<Source>, Vec<Failure>) = (Vec::new(), Vec::new());
    for path in paths {
        if path == Path::new(STDIN) {
            match read_stdin() {
                Ok(text) => programs.push(Source { shown: STDIN_SHOWN.to_owned(), place: None, text }),
                Err(failure) => failures.push(failure),
            }
            continue;
        }
        let found = if path.is_dir() { programs_in(path, &mut failures) } else { Ok(vec![path.clone()]) };
        match found {
            Ok(found) => programs.extend(found.iter().filter_map(|path| read_program(path, &mut failures))),
            Err(failure) => failures.push(failure),
        }
    }
    programs.sort_by(|a, b| (&a.place, &a.shown).cmp(&(&b.place, &b.shown)));
    programs.dedup_by(|a, b| a.place.is_some() && a.place == b.place);
    programs.sort_by(|a, b| a.shown.cmp(&b.shown));
    (programs, failures)
}

fn read_program(path: &Path, failures: &mut Vec<Failure>) -> Option<Source> {
    let program = absolute(path)
        .and_then(|place| Ok(Source { shown: shown(path), place: Some(place), text: read_file(path)? }));
    program.map_err(|failure| failures.push(failure)).ok()
}

/// All programs in a folder.
fn programs_in(folder: &Path, failures: &mut Vec<Failure>) -> Result<Vec<PathBuf>, Failure> {
    let Found { programs: found, failures: unread, .. } = find(folder, usize::MAX);
    failures.extend(unread.into_iter().map(|unread| Failure::new(format!("cannot look into {unread}"))));
    if found.is_empty() {
        return Err(Failure::new(format!("there is no program in {}", folder.display()))
            .help(format!("programs are files that end in .{EXTENSION}; `pydslrep new NAME` starts one")));
    }
    Ok(found)
}

/// "1 file", "2 files".
pub(crate) fn count_files(files: &[FileId]) -> String {
    count(files.len(), "file")
}
