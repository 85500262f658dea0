//! The summary of a check: the number of problems by severity.

use pydslrep_analysis::{Diagnostic, Severity};

use crate::inputs::Inputs;
use crate::inputs::scenes::{self, SceneProblem};
use crate::report::output::count;

/// "2 errors and 1 warning in 1 file".
pub(crate) fn summary(
    inputs: &Inputs,
    diagnostics: &[Diagnostic],
    scene_problems: &[SceneProblem],
) -> String {
    let found = diagnostics.iter().map(|diagnostic| (diagnostic.severity, inputs.shown(diagnostic.file)));
    let in_scenes = scene_problems.iter().map(|problem| (scenes::SEVERITY, problem.shown.as_str()));
    let found: Vec<(Severity, &str)> = found.chain(in_scenes).collect();
    let counts =
        [Severity::Error, Severity::Warning, Severity::Information, Severity::Hint].map(|severity| {
            let number = found.iter().filter(|(found, _)| *found == severity).count();
            (number > 0).then(|| match severity {
                // The word itself cannot be counted.
                Severity::Information => count(number, "information message"),
                _ => count(number, severity.word()),
            })
        });
    let mut files: Vec<&str> = found.into_iter().map(|(_, file)| file).collect();
    files.sort_unstable();
    files.dedup();
    let counts: Vec<String> = counts.into_iter().flatten().collect();
    format!("{} in {}", counts.join(", "), count(files.len(), "file"))
}
