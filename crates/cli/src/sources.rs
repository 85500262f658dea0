//! Programs and what they import: from files into the database.

use std::collections::{HashMap, HashSet};
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Component, Path, PathBuf};

use pydslrep_analysis::{Database, Diagnostic, FileId};

use crate::failure::Failure;
use crate::output::count;

/// The ending of programs.
pub(crate) const EXTENSION: &str = "pyr";

/// The file whose folder bounds where imports may lead.
const PROJECT_FILE: &str = "pydslrep.toml";

/// Larger files are no programs.
const MOST_BYTES: u64 = 64 << 20;

const BYTE_ORDER_MARK: char = '\u{feff}';

/// What standard input is called on the command line and in what is printed.
const STDIN: &str = "-";
const STDIN_SHOWN: &str = "<stdin>";

/// Open programs and files they import.
#[derive(Debug, Default)]
pub(crate) struct Sources {
    pub(crate) database: Database,
    /// What a file is called in what is printed.
    shown: HashMap<FileId, String>,
    /// Where each program is on the disk; standard input is nowhere.
    places: HashMap<FileId, PathBuf>,
    /// Imports that could not be opened, with who imports them: each is told once.
    missing: HashSet<(FileId, String)>,
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
        sources.follow_imports(&files, &mut failures);
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

    /// What is wrong with a program, in the order of the text.
    pub(crate) fn diagnostics(&self, file: FileId) -> Vec<Diagnostic> {
        let mut diagnostics = self.database.diagnostics(file);
        diagnostics.sort_by_key(|diagnostic| (diagnostic.span.start, diagnostic.span.end));
        diagnostics
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
        let text = read_file(path)?;
        let file = self.database.open(&key(&absolute), without_mark(&text));
        self.shown.insert(file, shown(path));
        self.places.insert(file, absolute);
        Ok(file)
    }

    /// Opens what programs import, and what that imports; also what they import only since they were changed.
    pub(crate) fn follow_imports(&mut self, files: &[FileId], failures: &mut Vec<Failure>) {
        for file in files {
            self.open_imports(*file, failures);
        }
    }

    fn open_imports(&mut self, program: FileId, failures: &mut Vec<Failure>) {
        let bound = bound(Path::new(self.database.path(program)));
        let mut waiting = vec![program];
        while let Some(importer) = waiting.pop() {
            for path in self.database.imports(importer).to_vec() {
                let import = (importer, path);
                if self.database.file(&import.1).is_some() || self.missing.contains(&import) {
                    continue;
                }
                match self.open_import(importer, Path::new(&import.1), &bound) {
                    Ok(file) => waiting.push(file),
                    Err(failure) => {
                        failures.push(failure);
                        self.missing.insert(import);
                    }
                }
            }
        }
    }

    fn open_import(&mut self, importer: FileId, path: &Path, bound: &Path) -> Result<FileId, Failure> {
        let importer = self.shown(importer).to_owned();
        let (near, folder) = (near(path), shown(bound));
        if !path.starts_with(bound) {
            return Err(Failure::new(format!(
                "{importer} imports {}, which is outside of {folder}",
                near.display()
            ))
            .help(format!("move the file, or put a {PROJECT_FILE} into the folder that holds both")));
        }
        self.open_file(&near).map_err(|failure| match failure {
            Failure::Told { message, help } => {
                Failure::Told { message: format!("cannot import into {importer}: {message}"), help }
            }
            Failure::Unheard => Failure::Unheard,
        })
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
    let mut found = Vec::new();
    collect(folder, &mut found, failures);
    if found.is_empty() {
        return Err(Failure::new(format!("there is no program in {}", folder.display()))
            .help(format!("programs are files that end in .{EXTENSION}; `pydslrep new NAME` starts one")));
    }
    Ok(found)
}

/// All programs in a folder and the folders in it, except hidden ones, by name.
fn collect(folder: &Path, found: &mut Vec<PathBuf>, failures: &mut Vec<Failure>) {
    let listed = fs::read_dir(folder).and_then(Iterator::collect::<io::Result<Vec<_>>>);
    let mut entries = match listed {
        Ok(entries) => entries,
        Err(error) => return failures.push(unread(&shown(folder), &error)),
    };
    entries.sort_by_key(fs::DirEntry::file_name);
    for entry in entries {
        let path = entry.path();
        // The entry's own type: links to folders may lead in circles.
        let is_folder = entry.file_type().is_ok_and(|sort| sort.is_dir());
        let is_hidden = entry.file_name().as_encoded_bytes().starts_with(b".");
        if is_folder && !is_hidden {
            collect(&path, found, failures);
        } else if !is_folder && path.extension().is_some_and(|extension| extension == EXTENSION) {
            found.push(path);
        }
    }
}

fn read_stdin() -> Result<String, Failure> {
    decode(STDIN_SHOWN, read(io::stdin().lock()).map_err(|error| unread(STDIN_SHOWN, &error))?)
}

fn read_file(path: &Path) -> Result<String, Failure> {
    let shown = shown(path);
    let bytes = File::open(path).and_then(read).map_err(|error| unread(&shown, &error))?;
    decode(&shown, bytes)
}

fn read(file: impl Read) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    file.take(MOST_BYTES + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

fn decode(shown: &str, bytes: Vec<u8>) -> Result<String, Failure> {
    if bytes.len() as u64 > MOST_BYTES {
        let message = format!("{shown} is larger than {} MiB", MOST_BYTES >> 20);
        return Err(Failure::new(message).help("is this a program?"));
    }
    String::from_utf8(bytes).map_err(|error| {
        let before = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = before.split(|byte| *byte == b'\n').count();
        Failure::new(format!("{shown} is no text in UTF-8: line {line} holds other bytes"))
            .help("save it in the encoding UTF-8")
    })
}

/// A byte order mark is not part of the text: editors hide it, and columns would be off by one.
pub(crate) fn without_mark(text: &str) -> &str {
    text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(text)
}

fn unread(shown: &str, error: &io::Error) -> Failure {
    match error.kind() {
        io::ErrorKind::NotFound => Failure::new(format!("{shown} does not exist")),
        _ => Failure::new(format!("cannot read {shown}: {error}")),
    }
}

/// The folder that imports of a program may not leave: that of the nearest project file, else the program's own.
fn bound(program: &Path) -> PathBuf {
    let own = program.parent().unwrap_or(program);
    let project = own.ancestors().find(|folder| folder.join(PROJECT_FILE).is_file());
    project.unwrap_or(own).to_owned()
}

/// The whole path, without `.` and `..`: the same file has the same one however it was named.
fn absolute(path: &Path) -> Result<PathBuf, Failure> {
    let whole = std::path::absolute(path)
        .map_err(|error| Failure::new(format!("cannot find {}: {error}", path.display())))?;
    let mut clean = PathBuf::new();
    for component in whole.components() {
        match component {
            Component::ParentDir => {
                clean.pop();
            }
            Component::CurDir => {}
            other => clean.push(other),
        }
    }
    Ok(clean)
}

/// The path as the database knows it.
fn key(absolute: &Path) -> String {
    let key = absolute.to_string_lossy();
    if cfg!(windows) { key.replace('\\', "/") } else { key.into_owned() }
}

/// The path from the current folder, where it is in it.
fn near(path: &Path) -> PathBuf {
    let here = std::env::current_dir().unwrap_or_default();
    match path.strip_prefix(&here) {
        Ok(near) if !near.as_os_str().is_empty() => near.to_owned(),
        _ => path.to_owned(),
    }
}

/// The path as it is printed.
fn shown(path: &Path) -> String {
    path.strip_prefix(".").unwrap_or(path).display().to_string()
}

/// "1 file", "2 files".
pub(crate) fn count_files(files: &[FileId]) -> String {
    count(files.len(), "file")
}
