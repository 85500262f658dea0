//! Safe fixes: `check --fix`.

use std::collections::BTreeMap;
use std::path::Path;

use pydslrep_analysis::{Database, Diagnostic, FileId, Fixing};

use crate::failure::Failure;
use crate::sources::Sources;
use crate::{output, rewrite};

/// What was fixed.
#[derive(Debug, Default)]
pub(crate) struct Fixed {
    /// How many problems, in the files where there were any.
    pub(crate) problems: BTreeMap<FileId, usize>,
    /// What the changed files were like before.
    before: BTreeMap<FileId, String>,
}

/// Applies safe fixes of the problems that are found until none is left. Only the given files are changed, and nothing
/// is written yet.
pub(crate) fn fix(
    sources: &mut Sources,
    files: &[FileId],
    find: impl Fn(&Sources) -> Vec<Diagnostic>,
) -> Fixed {
    let mut fixing = Fixing::new(&sources.database, files);
    loop {
        let problems = find(sources);
        let goes_on = fixing.round(&mut sources.database, &problems);
        sources.follow_imports(files);
        if !goes_on {
            return Fixed { problems: fixing.problems().clone(), before: fixing.before().clone() };
        }
    }
}

fn text(database: &Database, file: FileId) -> String {
    database.text(file).map(ToString::to_string).unwrap_or_default()
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
                output::print_raw(&now)?;
                continue;
            }
            let Some(before) = self.before.get(&file) else { continue };
            if let Err(failure) = rewrite::replace(Path::new(sources.shown(file)), before, &now) {
                failures.push(failure);
                self.problems.remove(&file);
                let path = sources.database.path(file).to_owned();
                sources.database.open(&path, before);
            }
        }
        Ok(())
    }

    /// How many problems were fixed.
    pub(crate) fn count(&self) -> usize {
        self.problems.values().sum()
    }
}
