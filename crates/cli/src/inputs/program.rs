//! One program and the environments in it.

use std::collections::HashSet;
use std::sync::Arc;

use pydslrep_analysis::environment::Environment;
use pydslrep_analysis::{Diagnostic, EntityId, FileId, Severity};
use pydslrep_workspace::NoEnvironment;

use crate::failure::Failure;
use crate::inputs::Inputs;
use crate::report::output::{count, say};
use crate::report::render;
use crate::report::summary::summary;

/// The environments of a program: all, or those with a name.
pub(crate) fn environments(inputs: &Inputs, file: FileId, name: Option<&str>) -> Vec<EntityId> {
    let all = inputs.database().environments(file).into_iter();
    all.filter(|(_, other)| name.is_none_or(|name| other.text == name)).map(|(id, _)| id).collect()
}

/// The one environment to work on.
///
/// # Errors
/// If there is none, or several and none was chosen.
pub(crate) fn environment(inputs: &Inputs, file: FileId, name: Option<&str>) -> Result<EntityId, Failure> {
    let shown = inputs.shown(file);
    inputs.choose_environment(file, name).map_err(|error| match error {
        NoEnvironment::None => {
            Failure::new(format!("{shown} has no environment")).help(known(inputs, &[file]))
        }
        NoEnvironment::Several(several) => {
            Failure::new(format!("{shown} has {}", count(several, "environment")))
                .help(format!("choose one with --environment NAME; {}", known(inputs, &[file])))
        }
        NoEnvironment::Unknown(name) => no_environment(inputs, &[file], &name),
    })
}

/// The failure for a name that no environment has.
pub(crate) fn no_environment(inputs: &Inputs, files: &[FileId], name: &str) -> Failure {
    let shown: Vec<&str> = files.iter().map(|file| inputs.shown(*file)).collect();
    Failure::new(format!("there is no environment `{name}` in {}", shown.join(", ")))
        .help(known(inputs, files))
}

/// The names of the environments, for a help text.
fn known(inputs: &Inputs, files: &[FileId]) -> String {
    let environments = files.iter().flat_map(|file| inputs.database().environments(*file));
    let names: Vec<String> = environments.map(|(_, name)| format!("`{}`", name.text)).collect();
    match names.as_slice() {
        [] => "add one: `environment NAME has { ROBOTS } robots with { MOVEMENTS } moves`".to_owned(),
        [one] => format!("the only one is {one}"),
        several => format!("there are {}", several.join(", ")),
    }
}

/// Environments without errors.
pub(crate) struct Prepared {
    /// In the order asked for.
    pub(crate) environments: Vec<Environment>,
    /// True if an environment was skipped, or the program has other errors.
    pub(crate) has_errors: bool,
}

/// Resolves environments of a program. Prints the program's problems, except hints, and the errors in other files that
/// block an environment.
pub(crate) fn prepare(inputs: &Inputs, file: FileId, ids: &[EntityId]) -> Prepared {
    let (mut prepared, mut stuck, mut reasons) = (Vec::new(), Vec::new(), Vec::new());
    let mut known = HashSet::new();
    for environment in inputs.database().ready_environments(ids.iter().copied()) {
        match environment {
            Ok(environment) => prepared.push(environment),
            Err(blocked) => {
                // Those of many environments may be the same ones.
                if known.insert(Arc::as_ptr(&blocked.errors)) {
                    reasons.push(blocked.errors);
                }
                stuck.push(blocked.environment);
            }
        }
    }
    let mut errors = Vec::new();
    add(&mut errors, reasons.iter().flat_map(|errors| errors.iter()));
    let mut problems = problems(inputs, file, &errors);
    problems.retain(|problem| problem.severity > Severity::Hint);
    show(inputs, &problems);
    for name in &stuck {
        say(&format!("environment `{name}` is skipped because of these errors\n"));
    }
    let is_error = |problem: &Diagnostic| problem.severity == Severity::Error;
    Prepared { environments: prepared, has_errors: !stuck.is_empty() || problems.iter().any(is_error) }
}

/// The problems of a program with their severities, and errors in other files. An error that blocks an environment stays
/// an error, whatever its severity is set to.
fn problems(inputs: &Inputs, file: FileId, errors: &[Diagnostic]) -> Vec<Diagnostic> {
    let severities = inputs.settings(file).severities;
    let blocking: HashSet<ProblemKey<'_>> = errors.iter().map(place).collect();
    let as_shown = |problem: Diagnostic| {
        if blocking.contains(&place(&problem)) {
            return Some(problem);
        }
        let severity = severities.severity(problem.code(), problem.severity)?;
        Some(Diagnostic { severity, ..problem })
    };
    let mut problems: Vec<Diagnostic> =
        inputs.database().diagnostics(file).into_iter().filter_map(as_shown).collect();
    add(&mut problems, errors);
    problems
}

/// The identity of a problem.
type ProblemKey<'a> = (FileId, u32, u32, &'static str, &'a str);

fn place(problem: &Diagnostic) -> ProblemKey<'_> {
    let Diagnostic { file, span, message, .. } = problem;
    (*file, span.start, span.end, problem.code(), message)
}

/// Adds those that are not there yet.
fn add<'a>(problems: &mut Vec<Diagnostic>, more: impl IntoIterator<Item = &'a Diagnostic>) {
    let missing: Vec<Diagnostic> = {
        let mut known: HashSet<ProblemKey<'_>> = problems.iter().map(place).collect();
        more.into_iter().filter(|problem| known.insert(place(problem))).cloned().collect()
    };
    problems.extend(missing);
}

fn show(inputs: &Inputs, problems: &[Diagnostic]) {
    if !problems.is_empty() {
        let mut problems = problems.to_vec();
        inputs.retain_offered(&mut problems);
        say(&format!("{}{}.\n", render::diagnostics(inputs, &problems), summary(inputs, &problems, &[])));
    }
}
