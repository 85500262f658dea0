//! Safe fixes: `check --fix`.

use std::collections::BTreeMap;
use std::path::Path;

use pydslrep_analysis::{FileId, Fixing};

use crate::failure::Failure;
use crate::inputs::Inputs;
use crate::inputs::rewrite;
use crate::report::output;

/// The result of applying fixes.
#[derive(Debug, Default)]
pub(crate) struct Fixed {
    /// The number of fixed problems, by file.
    pub(crate) problems: BTreeMap<FileId, usize>,
    /// The texts of the changed files before.
    before: BTreeMap<FileId, String>,
}

/// Applies safe fixes of the problems that are found until none is left. Only the given files are changed, and nothing
/// is written yet.
pub(crate) fn fix(inputs: &mut Inputs) -> Fixed {
    let mut fixing = Fixing::new(inputs.database(), inputs.files());
    loop {
        let problems = inputs.all_diagnostics();
        let goes_on = inputs.update(|database| fixing.round(database, &problems));
        if !goes_on {
            return Fixed { problems: fixing.problems().clone(), before: fixing.before().clone() };
        }
    }
}

impl Fixed {
    /// Writes the changed files; a program from standard input goes to standard output, changed or not. A file that
    /// cannot be written is in the database as it was.
    ///
    /// # Errors
    /// When standard output cannot be written.
    pub(crate) fn write(&mut self, inputs: &mut Inputs, failures: &mut Vec<Failure>) -> Result<(), Failure> {
        for file in inputs.files().to_vec() {
            let now = inputs.text(file);
            if inputs.place(file).is_none() {
                output::print_raw(&now)?;
                continue;
            }
            let Some(before) = self.before.get(&file) else { continue };
            if let Err(failure) = rewrite::replace(Path::new(inputs.shown(file)), before, &now) {
                failures.push(failure);
                self.problems.remove(&file);
                let path = inputs.database().path(file).to_owned();
                inputs.update(|database| database.open(&path, before));
            }
        }
        Ok(())
    }

    /// Returns the number of problems fixed.
    pub(crate) fn count(&self) -> usize {
        self.problems.values().sum()
    }
}
