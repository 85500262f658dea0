//! Mistakes in the scene files of programs: told beside what is wrong with the programs themselves.

use std::path::Path;

use pydslrep_analysis::FileId;
use pydslrep_config::Problem;
use pydslrep_files::{Unread, without_mark};

use crate::failure::Failure;
use crate::paths::{near, shown};
use crate::place::{self, PlaceRange};
use crate::render;
use crate::sources::Sources;
use crate::texts::read_file;

/// How bad they all are: nothing is driven in such a scene.
pub(crate) const SEVERITY: pydslrep_analysis::Severity = pydslrep_analysis::Severity::Error;

/// A mistake in a scene file.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Mistake {
    /// What the file is called in what is printed.
    pub(crate) shown: String,
    /// Where it is in the file.
    pub(crate) range: PlaceRange,
    /// What it is.
    pub(crate) problem: Problem,
    /// It for people, with its line.
    rendered: String,
}

/// The mistakes in the scenes of all environments of programs, and why some scenes could not be read.
pub(crate) fn find(sources: &Sources, files: &[FileId]) -> (Vec<Mistake>, Vec<Failure>) {
    let (mut mistakes, mut failures) = (Vec::new(), Vec::new());
    for file in files {
        let environments = sources.database.environments(*file).into_iter();
        for ((id, _), (_, path)) in environments.zip(sources.scene_paths(*file)) {
            let text = match pydslrep_files::read(&path) {
                Ok(text) => text,
                Err(Unread::Missing) => continue,
                Err(_) => {
                    failures.extend(read_file(&near(&path)).err());
                    continue;
                }
            };
            let text = without_mark(&text);
            let problems = sources.database.scene_problems(Some(id), text);
            for mistake in problems.into_iter().map(|problem| mistake(&path, text, problem)) {
                // Programs of one folder may share a scene.
                if !mistakes.contains(&mistake) {
                    mistakes.push(mistake);
                }
            }
        }
    }
    (mistakes, failures)
}

fn mistake(path: &Path, text: &str, problem: Problem) -> Mistake {
    let shown = shown(&near(path));
    let range = place::range_in(text, problem.span.unwrap_or_default());
    let rendered = render::problem(&shown, text, &problem);
    Mistake { shown, range, problem, rendered }
}

/// For people, with source lines.
pub(crate) fn render(mistakes: &[Mistake]) -> String {
    mistakes.iter().map(|mistake| mistake.rendered.as_str()).collect()
}
