//! Problems for programs: the elements of `check --format json`.

use std::borrow::Cow;

use pydslrep_analysis::{Diagnostic, Edit, Fix, Related};
use serde::Serialize;

use crate::failure::Failure;
use crate::inputs::Inputs;
use crate::inputs::scenes::{self, SceneProblem};
use crate::report::output;
use crate::report::place::{self, PlaceRange};

#[derive(Debug, Serialize)]
struct Problem<'a> {
    file: &'a str,
    code: &'a str,
    severity: &'a str,
    message: &'a str,
    range: PlaceRange,
    related: Vec<SecondPlace<'a>>,
    fix: Option<FirstFix<'a>>,
}

#[derive(Debug, Serialize)]
struct SecondPlace<'a> {
    message: &'a str,
    file: &'a str,
    range: PlaceRange,
}

#[derive(Debug, Serialize)]
struct FirstFix<'a> {
    title: Cow<'a, str>,
    edits: Vec<Replacement<'a>>,
}

#[derive(Debug, Serialize)]
struct Replacement<'a> {
    range: PlaceRange,
    text: &'a str,
}

/// The problems as one array.
///
/// # Errors
/// Never, with the values passed here.
pub(crate) fn array(
    inputs: &Inputs,
    diagnostics: &[Diagnostic],
    scene_problems: &[SceneProblem],
) -> Result<String, Failure> {
    let problems = diagnostics.iter().map(|diagnostic| problem(inputs, diagnostic));
    let problems: Vec<Problem> = problems.chain(scene_problems.iter().map(in_scene)).collect();
    output::json(&problems)
}

fn problem<'a>(inputs: &'a Inputs, diagnostic: &'a Diagnostic) -> Problem<'a> {
    let file = diagnostic.file;
    // An edit has no file of its own here, so only fixes within the file are listed.
    let fix = diagnostic.fixes.iter().find(|fix| fix.edits.iter().all(|edit| edit.file == file));
    Problem {
        file: inputs.shown(file),
        code: diagnostic.code(),
        severity: diagnostic.severity.word(),
        message: &diagnostic.message,
        range: place::range(inputs.database(), file, diagnostic.span),
        related: diagnostic.related.iter().map(|related| second_place(inputs, related)).collect(),
        fix: fix.map(|fix| first_fix(inputs, fix)),
    }
}

fn in_scene(problem: &SceneProblem) -> Problem<'_> {
    let replacement = problem.problem.replacement.as_deref();
    let fix = replacement.map(|text| FirstFix {
        title: format!("change to `{}`", text.trim_matches('"')).into(),
        edits: vec![Replacement { range: problem.range, text }],
    });
    Problem {
        file: &problem.shown,
        code: problem.problem.kind.code(),
        severity: scenes::SEVERITY.word(),
        message: &problem.problem.message,
        range: problem.range,
        related: Vec::new(),
        fix,
    }
}

fn second_place<'a>(inputs: &'a Inputs, related: &'a Related) -> SecondPlace<'a> {
    SecondPlace {
        message: &related.message,
        file: inputs.shown(related.file),
        range: place::range(inputs.database(), related.file, related.span),
    }
}

fn first_fix<'a>(inputs: &Inputs, fix: &'a Fix) -> FirstFix<'a> {
    let replacement = |edit: &'a Edit| Replacement {
        range: place::range(inputs.database(), edit.file, edit.span),
        text: &edit.text,
    };
    FirstFix { title: Cow::from(&fix.title), edits: fix.edits.iter().map(replacement).collect() }
}
