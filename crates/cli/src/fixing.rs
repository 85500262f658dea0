//! Safe fixes: `check --fix`.

use std::collections::hash_map::DefaultHasher;
use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::hash::{Hash, Hasher};
use std::path::Path;

use pydslrep_analysis::{Database, Diagnostic, Edit, FileId, Fix};

use crate::failure::Failure;
use crate::sources::Sources;
use crate::{output, rewrite};

/// Fixes that bring ever new problems come to an end here. Fixes for the same place take a round each.
const MOST_ROUNDS: usize = 1000;

/// What was fixed.
#[derive(Debug, Default)]
pub(crate) struct Fixed {
    /// How many problems, in the files where there were any.
    pub(crate) problems: BTreeMap<FileId, usize>,
    /// What the changed files were like before.
    before: BTreeMap<FileId, String>,
}

/// Applies safe fixes of the problems that are found until none is left. Only the given files are changed, and nothing
/// is written yet. Where fixes undo each other, it ends with a text that was not there before.
pub(crate) fn fix(
    sources: &mut Sources,
    files: &[FileId],
    find: impl Fn(&Sources) -> Vec<Diagnostic>,
) -> Fixed {
    let mut fixed = Fixed::default();
    let mut seen = HashSet::from([fingerprint(&sources.database, files)]);
    for _ in 0..MOST_ROUNDS {
        let problems = find(sources);
        let chosen = choose(&sources.database, files, &problems);
        let texts = texts(&sources.database, &chosen);
        apply(&mut sources.database, &texts, &chosen);
        // Also where nothing was chosen.
        if !seen.insert(fingerprint(&sources.database, files)) {
            restore(&mut sources.database, &texts);
            break;
        }
        for (problem, _) in chosen {
            *fixed.problems.entry(problem.file).or_default() += 1;
        }
        for (file, text) in texts {
            fixed.before.entry(file).or_insert(text);
        }
        sources.follow_imports(files);
    }
    fixed
}

/// Fixes that can be applied at once: the first safe one of each problem, if nothing chosen before touches it.
fn choose<'a>(
    database: &Database,
    files: &[FileId],
    problems: &'a [Diagnostic],
) -> Vec<(&'a Diagnostic, &'a Fix)> {
    let mut chosen: Vec<(&Diagnostic, &Fix)> = Vec::new();
    for problem in problems {
        let fits = |fix: &&Fix| {
            let is_ours = fix.edits.iter().all(|edit| files.contains(&edit.file));
            let changes = fix.edits.iter().any(|edit| database.slice(edit.file, edit.span) != edit.text);
            fix.safe && is_ours && changes && !chosen.iter().any(|(_, other)| touch(fix, other))
        };
        if let Some(fix) = problem.fixes.iter().find(fits) {
            chosen.push((problem, fix));
        }
    }
    chosen
}

/// Whether two fixes change the same text, or text side by side, where the order would matter.
fn touch(a: &Fix, b: &Fix) -> bool {
    let touch =
        |a: &Edit, b: &Edit| a.file == b.file && a.span.start <= b.span.end && b.span.start <= a.span.end;
    a.edits.iter().any(|a| b.edits.iter().any(|b| touch(a, b)))
}

fn apply(database: &mut Database, texts: &BTreeMap<FileId, String>, chosen: &[(&Diagnostic, &Fix)]) {
    let mut edits: Vec<&Edit> = chosen.iter().flat_map(|(_, fix)| &fix.edits).collect();
    edits.sort_by_key(|edit| (edit.span.start, edit.span.end));
    for (file, text) in texts {
        let edits = edits.iter().filter(|edit| edit.file == *file);
        let path = database.path(*file).to_owned();
        // At once: thousands of edits would each be followed by a look at what they change.
        database.open(&path, &edited(text, edits.copied()));
    }
}

/// A text with edits, which are in its order.
fn edited<'a>(text: &str, edits: impl Iterator<Item = &'a Edit>) -> String {
    let (mut out, mut done) = (String::with_capacity(text.len()), 0);
    for edit in edits {
        out += text.get(done..edit.span.start as usize).unwrap_or_default();
        out += &edit.text;
        done = edit.span.end as usize;
    }
    out + text.get(done..).unwrap_or_default()
}

/// The texts that fixes will change.
fn texts(database: &Database, chosen: &[(&Diagnostic, &Fix)]) -> BTreeMap<FileId, String> {
    let files: BTreeSet<FileId> =
        chosen.iter().flat_map(|(_, fix)| &fix.edits).map(|edit| edit.file).collect();
    files.into_iter().map(|file| (file, text(database, file))).collect()
}

fn text(database: &Database, file: FileId) -> String {
    database.text(file).map(ToString::to_string).unwrap_or_default()
}

fn restore(database: &mut Database, texts: &BTreeMap<FileId, String>) {
    for (file, text) in texts {
        let path = database.path(*file).to_owned();
        database.open(&path, text);
    }
}

/// Tells texts apart that were there before.
fn fingerprint(database: &Database, files: &[FileId]) -> u64 {
    let mut hasher = DefaultHasher::new();
    for file in files {
        text(database, *file).hash(&mut hasher);
    }
    hasher.finish()
}

impl Fixed {
    /// Writes the changed files; a program from standard input goes to standard output, changed or not. A file that
    /// cannot be written is in the database as it was.
    ///
    /// # Errors
    /// When standard output cannot be written.
    pub(crate) fn write(
        &mut self,
        sources: &mut Sources,
        files: &[FileId],
        failures: &mut Vec<Failure>,
    ) -> Result<(), Failure> {
        for &file in files {
            let now = text(&sources.database, file);
            if sources.place(file).is_none() {
                output::pass_on(&now)?;
                continue;
            }
            let Some(before) = self.before.get(&file) else { continue };
            if let Err(failure) = rewrite::replace(Path::new(sources.shown(file)), before, &now) {
                failures.push(failure);
                self.problems.remove(&file);
                restore(&mut sources.database, &BTreeMap::from([(file, before.clone())]));
            }
        }
        Ok(())
    }

    /// How many problems were fixed.
    pub(crate) fn count(&self) -> usize {
        self.problems.values().sum()
    }
}

#[cfg(test)]
mod tests {
    use pydslrep_analysis::Severity;
    use pydslrep_analysis::diagnostics::rule;
    use pydslrep_syntax::Span;

    use super::*;

    /// A problem whose fixes each replace a text by another one.
    fn problem(file: FileId, fixes: &[(bool, Span, &str)]) -> Diagnostic {
        let fixes = fixes.iter().map(|(safe, span, text)| Fix {
            title: String::new(),
            safe: *safe,
            edits: vec![Edit { file, span: *span, text: (*text).to_owned() }],
        });
        Diagnostic {
            rule: rule("zero-distance").unwrap(),
            severity: Severity::Warning,
            file,
            span: Span::new(0, 0),
            message: String::new(),
            help: None,
            note: None,
            related: Vec::new(),
            fixes: fixes.collect(),
        }
    }

    fn fixed(text: &str, find: impl Fn(&str, FileId) -> Vec<Diagnostic>) -> (String, usize) {
        let mut sources = Sources::default();
        let file = sources.database.open("x.pyr", text);
        let find = |sources: &Sources| find(&super::text(&sources.database, file), file);
        let count = fix(&mut sources, &[file], find).count();
        (super::text(&sources.database, file), count)
    }

    #[test]
    fn fixes_at_the_same_place_take_turns() {
        let find = |text: &str, file| {
            let span = |word: &str| text.find(word).and_then(|at| u32::try_from(at).ok());
            let words = ["ab", "bc", "x"].into_iter().filter_map(|word| Some((word, span(word)?)));
            let problems = words.map(|(word, start)| {
                let end = start + u32::try_from(word.len()).unwrap();
                problem(file, &[(false, Span::new(start, end), "!"), (true, Span::new(start, end), "")])
            });
            problems.collect()
        };
        assert_eq!(fixed("abc x bcd", find), ("c  d".to_owned(), 3));
    }

    #[test]
    fn fixes_that_undo_each_other_end() {
        let flip = |text: &str, file| {
            let other = if text == "a" { "b" } else { "a" };
            vec![problem(file, &[(true, Span::new(0, 1), other)])]
        };
        assert_eq!(fixed("a", flip), ("b".to_owned(), 1));
    }

    #[test]
    fn fixes_that_change_nothing_or_never_end_do_not_loop() {
        let same = |_: &str, file| vec![problem(file, &[(true, Span::new(0, 1), "a")])];
        assert_eq!(fixed("a", same), ("a".to_owned(), 0));
        let grow = |_: &str, file| vec![problem(file, &[(true, Span::new(0, 0), "a")])];
        assert_eq!(fixed("", grow).1, MOST_ROUNDS);
    }

    #[test]
    fn files_that_were_not_named_stay() {
        let mut sources = Sources::default();
        let [named, other] = ["x.pyr", "y.pyr"].map(|path| sources.database.open(path, "a"));
        let find = |_: &Sources| vec![problem(other, &[(true, Span::new(0, 1), "b")])];
        assert_eq!(fix(&mut sources, &[named], find).count(), 0);
        assert_eq!(text(&sources.database, other), "a");
    }
}
